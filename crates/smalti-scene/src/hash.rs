//! The name of a world: what light and cameras can see of it, in a fixed order, as XXH3-128.

use glam::DVec3;
use smalti_core::scene::contact::Pair;
use smalti_core::scene::world::{Material, Rgb};
use smalti_core::scene::{Origin, World};
use xxhash_rust::xxh3::Xxh3;

/// Bytes that are hashed at a time.
const CHUNK: usize = 1 << 16;

/// The hash of `world`, whose faces meet in these `pairs`: 32 lower-case hex digits.
///
/// Hashed are, little-endian, with -0 as +0: for each list its length as u64 and its items (polygons, spheres, meshes,
/// point lights, environment, cameras). Lengths of inner lists and indices are u64 and u32, all numbers f64; an option
/// is a byte 0 or 1 and its value; a surface's material is a byte for the kind (lambert 0, mirror 1, dielectric 2, one
/// that absorbs 3) and its numbers. Which of two coinciding surfaces was written first is hashed where that is not the one
/// that is listed first.
pub fn of(world: &World, pairs: &[Pair]) -> String {
    let mut sink = Sink { hasher: Xxh3::new(), buffer: Vec::with_capacity(2 * CHUNK) };
    sink.surfaces(world);
    sink.count(world.point_lights.len());
    for light in &world.point_lights {
        sink.point(light.position);
        sink.rgb(light.intensity);
    }
    sink.maybe(world.environment);
    sink.count(world.cameras.len());
    for camera in &world.cameras {
        sink.points(&[camera.eye, camera.look_at, camera.up]);
        sink.number(camera.fov);
    }
    sink.order(world, pairs);
    sink.finish()
}

struct Sink {
    hasher: Xxh3,
    buffer: Vec<u8>,
}

impl Sink {
    fn surfaces(&mut self, world: &World) {
        self.count(world.polygons.len());
        for polygon in &world.polygons {
            self.points(&polygon.vertices);
            self.skin(world.materials[polygon.material], polygon.radiance);
        }
        self.count(world.spheres.len());
        for sphere in &world.spheres {
            self.point(sphere.centre);
            self.number(sphere.radius);
            self.skin(world.materials[sphere.material], sphere.radiance);
        }
        self.count(world.meshes.len());
        for mesh in &world.meshes {
            self.points(&mesh.vertices);
            self.count(mesh.faces.len());
            mesh.faces.as_flattened().iter().for_each(|index| self.bytes(&index.to_le_bytes()));
            self.skin(world.materials[mesh.material], mesh.radiance);
        }
    }

    /// Of `pairs` those that coincide and of which the second in the world's lists was written first.
    fn order(&mut self, world: &World, pairs: &[Pair]) {
        let is_turned = |[first, second]: [Origin; 2]| world.place(second) < world.place(first);
        let turned = pairs.iter().filter(|pair| pair.coincides()).map(|pair| pair.of).filter(|of| is_turned(*of));
        for surface in turned.flatten() {
            let (kind, index, triangle) = match surface {
                Origin::Polygon(index) => (0, index, 0),
                Origin::Mesh(index, triangle) => (1, index, triangle),
                Origin::Sphere(index) => (2, index, 0),
            };
            self.bytes(&[kind]);
            self.bytes(&index.to_le_bytes());
            self.bytes(&triangle.to_le_bytes());
        }
    }

    fn skin(&mut self, material: Material, radiance: Option<Rgb>) {
        match material {
            Material::Lambert { albedo } => {
                self.bytes(&[0]);
                self.rgb(albedo);
            }
            Material::Mirror { reflectance } => {
                self.bytes(&[1]);
                self.rgb(reflectance);
            }
            Material::Dielectric { ior, absorption } => {
                self.bytes(&[if material.absorbs() { 3 } else { 2 }]);
                self.number(ior);
                if material.absorbs() {
                    self.rgb(absorption);
                }
            }
        }
        self.maybe(radiance);
    }

    fn maybe(&mut self, rgb: Option<Rgb>) {
        self.bytes(&[u8::from(rgb.is_some())]);
        rgb.into_iter().for_each(|rgb| self.rgb(rgb));
    }

    fn points(&mut self, points: &[DVec3]) {
        self.count(points.len());
        points.iter().for_each(|point| self.point(*point));
    }

    fn point(&mut self, point: DVec3) {
        self.rgb(point.to_array());
    }

    fn rgb(&mut self, rgb: Rgb) {
        rgb.into_iter().for_each(|number| self.number(number));
    }

    fn number(&mut self, number: f64) {
        self.bytes(&(number + 0.0).to_le_bytes());
    }

    fn count(&mut self, count: usize) {
        self.bytes(&(count as u64).to_le_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= CHUNK {
            self.hasher.update(&self.buffer);
            self.buffer.clear();
        }
    }

    fn finish(mut self) -> String {
        self.hasher.update(&self.buffer);
        format!("{:032x}", self.hasher.digest128())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use smalti_core::scene::world::Sphere;

    fn world(materials: Vec<Material>, material: usize, x: f64) -> World {
        let sphere = Sphere { centre: DVec3::new(x, 0.0, 0.0), radius: 1.0, material, radiance: None };
        World { materials, spheres: vec![sphere], ..World::default() }
    }

    #[test]
    fn only_what_can_be_seen_changes_the_hash() {
        let glass = Material::clear(1.5);
        let white = Material::Lambert { albedo: [0.8; 3] };
        let plain = of(&world(vec![glass], 0, 0.0), &[]);
        assert_eq!(plain.len(), 32);
        assert_eq!(plain, of(&world(vec![white, glass], 1, -0.0), &[]), "unused materials and the sign of zero");
        assert_ne!(plain, of(&world(vec![white, glass], 0, 0.0), &[]), "another material");
        assert_ne!(plain, of(&world(vec![glass], 0, f64::MIN_POSITIVE), &[]), "another place");
    }
}
