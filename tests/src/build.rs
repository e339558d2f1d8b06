//! Worlds put together in a few lines: what acceptance tests render.

use core::f64::consts::{PI, TAU};

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::{Camera, Material, Mesh, PointLight, Polygon, Sphere};

/// A point or direction from components.
pub fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A diffuse grey.
pub fn grey(albedo: f64) -> Material {
    Material::Lambert { albedo: [albedo; 3] }
}

/// A mirror that reflects the same of every channel.
pub fn mirror(reflectance: f64) -> Material {
    Material::Mirror { reflectance: [reflectance; 3] }
}

/// Adds a material; the result names it.
pub fn material(world: &mut World, material: Material) -> usize {
    world.materials.push(material);
    world.materials.len() - 1
}

/// Adds a polygon; it emits the same in every channel, or nothing.
pub fn polygon(world: &mut World, vertices: &[DVec3], material: usize, radiance: Option<f64>) {
    world.polygons.push(Polygon { vertices: vertices.to_vec(), material, radiance: radiance.map(|x| [x; 3]) });
}

/// Adds a parallelogram about `centre` that spans ±`e1` ± `e2`; its normal is along e1 × e2.
pub fn quad(world: &mut World, centre: DVec3, (e1, e2): (DVec3, DVec3), material: usize, radiance: Option<f64>) {
    let corners = [centre - e1 - e2, centre + e1 - e2, centre + e1 + e2, centre - e1 + e2];
    polygon(world, &corners, material, radiance);
}

/// Adds a sphere.
pub fn sphere(world: &mut World, centre: DVec3, radius: f64, material: usize, radiance: Option<f64>) {
    world.spheres.push(Sphere { centre, radius, material, radiance: radiance.map(|x| [x; 3]) });
}

/// Adds a point light that is the same in every channel.
pub fn point_light(world: &mut World, position: DVec3, intensity: f64) {
    world.point_lights.push(PointLight { position, intensity: [intensity; 3] });
}

/// Adds the six faces of a box; they look inward.
pub fn closed_box(world: &mut World, centre: DVec3, half: DVec3, material: usize, radiance: Option<f64>) {
    let axes = [at(half.x, 0.0, 0.0), at(0.0, half.y, 0.0), at(0.0, 0.0, half.z)];
    for k in 0..3 {
        let (out, e1, e2) = (axes[k], axes[(k + 1) % 3], axes[(k + 2) % 3]);
        // e1 × e2 is along +out: the face on the far side must turn round.
        quad(world, centre - out, (e1, e2), material, radiance);
        quad(world, centre + out, (e2, e1), material, radiance);
    }
}

/// Adds a hexagonal room of circumradius and half height 1 about the origin: 8 convex polygons that look inward.
pub fn hexagon_room(world: &mut World, material: usize, radiance: Option<f64>) {
    let ring = |z: f64| -> Vec<DVec3> {
        (0..6).map(|k| f64::from(k) * TAU / 6.0).map(|a| at(libm::cos(a), libm::sin(a), z)).collect()
    };
    let (floor, mut ceiling) = (ring(-1.0), ring(1.0));
    for k in 0..6 {
        let next = (k + 1) % 6;
        polygon(world, &[floor[next], floor[k], ceiling[k], ceiling[next]], material, radiance);
    }
    polygon(world, &floor, material, radiance);
    ceiling.reverse();
    polygon(world, &ceiling, material, radiance);
}

/// Adds a camera with a vertical field of view in radians.
pub fn camera(world: &mut World, eye: DVec3, look_at: DVec3, fov: f64) {
    let forward = (look_at - eye).normalize();
    let up = if forward.z.abs() > 0.9 { DVec3::Y } else { DVec3::Z };
    world.cameras.push(Camera { name: String::new(), eye, look_at, up, fov });
}

/// A closed surface about the origin with outward winding: poles, and `rows` − 1 rings of `columns` corners at the
/// distances that `radius` gives from (row, column).
pub fn globe(columns: u32, rows: u32, mut radius: impl FnMut(u32, u32) -> f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut vertices = vec![at(0.0, 0.0, radius(0, 0)), at(0.0, 0.0, -radius(rows, 0))];
    for row in 1..rows {
        let inclination = PI * f64::from(row) / f64::from(rows);
        for column in 0..columns {
            let azimuth = TAU * f64::from(column) / f64::from(columns);
            let s = libm::sin(inclination);
            let direction = at(s * libm::cos(azimuth), s * libm::sin(azimuth), libm::cos(inclination));
            vertices.push(direction * radius(row, column));
        }
    }
    let ring = |row: u32, column: u32| 2 + (row - 1) * columns + column % columns;
    let mut faces = Vec::new();
    for column in 0..columns {
        faces.push([0, ring(1, column), ring(1, column + 1)]);
        faces.push([1, ring(rows - 1, column + 1), ring(rows - 1, column)]);
        for row in 1..rows - 1 {
            let (a, b) = (ring(row, column), ring(row, column + 1));
            let (c, d) = (ring(row + 1, column + 1), ring(row + 1, column));
            faces.extend([[a, d, c], [a, c, b]]);
        }
    }
    (vertices, faces)
}

/// Adds a mesh that emits the same in every channel, or nothing.
pub fn mesh(world: &mut World, (vertices, faces): (Vec<DVec3>, Vec<[u32; 3]>), material: usize, radiance: Option<f64>) {
    world.meshes.push(Mesh { vertices, faces, material, radiance: radiance.map(|x| [x; 3]) });
}

/// `world` with all that it emits × `factor`.
pub fn brighter(world: &World, factor: f64) -> World {
    let mut brighter = world.clone();
    let emissions = brighter.polygons.iter_mut().map(|p| &mut p.radiance);
    let emissions = emissions.chain(brighter.spheres.iter_mut().map(|s| &mut s.radiance));
    let emissions = emissions.chain(brighter.meshes.iter_mut().map(|m| &mut m.radiance));
    let emissions = emissions.chain([&mut brighter.environment]).flatten();
    for rgb in emissions.chain(brighter.point_lights.iter_mut().map(|light| &mut light.intensity)) {
        *rgb = rgb.map(|x| x * factor);
    }
    brighter
}
