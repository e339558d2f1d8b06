//! From the world to the scene: recentre, prepare in f64, round to f32, and lay out as the kernels read it.

use std::collections::HashMap;

use glam::DVec3;

use super::contact::settle;
use super::frame::Frame;
use super::media::Media;
use super::world::{Camera, Material, Rgb, World};
use super::{Class, Face, Origin, Scene, Shade, View};
use crate::light::table::LightTable;

/// Builds up the scene, one primitive after the other.
struct Compiler<'w> {
    world: &'w World,
    scene: Scene,
    vertex_ids: HashMap<[u32; 3], u32>,
    plane_ids: HashMap<[u32; 4], u32>,
}

/// Compiles a world. Degenerate polygons and triangles (no area in f64) are dropped. With `sampled_sky` the environment
/// is also a light that shadow rays are sent to.
pub fn compile(world: &World, sampled_sky: bool) -> Scene {
    let scene = Scene { frame: Frame::of(world), ..Scene::default() };
    let mut compiler = Compiler { world, scene, vertex_ids: HashMap::new(), plane_ids: HashMap::new() };
    compiler.faces(true);
    compiler.faces(false);
    compiler.finish(sampled_sky)
}

impl Compiler<'_> {
    fn finish(mut self, sampled_sky: bool) -> Scene {
        self.scene.planes = self.plane_ids.len() as u32;
        self.spheres();
        let world = self.world;
        let scale = self.scene.frame.scale;
        for light in &world.point_lights {
            let position = self.scene.frame.point(light.position).as_vec3().to_array();
            self.scene.lights.point(position, light.intensity.map(|i| i * scale * scale));
        }
        self.scene.environment = world.environment.map(round);
        if let Some(radiance) = world.environment.filter(|_| sampled_sky) {
            self.scene.lights.sky(radiance);
        }
        self.scene.lights.finish();
        self.scene.views = world.cameras.iter().map(|camera| view(&self.scene.frame, camera)).collect();
        settle(&mut self.scene, world);
        self.scene.media = Media::of(world, &self.scene);
        self.scene
    }

    /// The faces that emit, or the others. Those that emit come first: of two in one place the first is seen, and a lamp in
    /// a ceiling must be, as shadow rays find it too.
    fn faces(&mut self, emit: bool) {
        let world = self.world;
        let of_these = |radiance: &Option<Rgb>| radiance.is_some() == emit;
        for (index, polygon) in world.polygons.iter().enumerate().filter(|item| of_these(&item.1.radiance)) {
            let corners: Vec<DVec3> = polygon.vertices.iter().map(|&v| self.scene.frame.point(v)).collect();
            self.face(&corners, polygon.material, polygon.radiance, Origin::Polygon(index as u32));
        }
        for (index, mesh) in world.meshes.iter().enumerate().filter(|item| of_these(&item.1.radiance)) {
            let vertices: Vec<DVec3> = mesh.vertices.iter().map(|&v| self.scene.frame.point(v)).collect();
            for (triangle, face) in mesh.faces.iter().enumerate() {
                let corners = face.map(|i| vertices[i as usize]);
                self.face(&corners, mesh.material, mesh.radiance, Origin::Mesh(index as u32, triangle as u32));
            }
        }
    }

    fn face(&mut self, corners: &[DVec3], material: usize, radiance: Option<Rgb>, origin: Origin) {
        let area = newell(corners);
        let normal = area.normalize_or_zero();
        if normal == DVec3::ZERO {
            self.scene.dropped += 1;
            return;
        }
        let distance = corners.iter().map(|v| normal.dot(*v)).sum::<f64>() / corners.len() as f64;
        let plane = [normal.x as f32, normal.y as f32, normal.z as f32, distance as f32];
        let surface = self.plane_id(plane);
        let prim = self.scene.shades.len() as u32;
        let first = self.scene.corners.len() as u32;
        for corner in corners {
            let id = self.vertex_id(corner.as_vec3().to_array());
            self.scene.corners.push(id);
        }
        self.scene.faces.push(Face { first, count: corners.len() as u32, plane, surface });
        let light = radiance.map(|radiance| {
            let corners: Vec<_> = corners.iter().map(|v| v.as_vec3().to_array()).collect();
            self.scene.lights.polygon(&corners, area.length() / 2.0, plane, radiance, surface)
        });
        self.push(prim, plane, surface, material, light, origin);
    }

    fn spheres(&mut self) {
        for (index, sphere) in self.world.spheres.iter().enumerate() {
            let centre = self.scene.frame.point(sphere.centre);
            let radius = (sphere.radius * self.scene.frame.scale) as f32;
            let geometry = [centre.x as f32, centre.y as f32, centre.z as f32, radius];
            // Smaller than the smallest f32 in the frame: below 1e-38 of the scene.
            if radius <= 0.0 {
                self.scene.dropped += 1;
                continue;
            }
            let surface = self.scene.planes + self.scene.spheres.len() as u32;
            self.scene.spheres.push(geometry);
            let light = sphere.radiance.map(|radiance| self.scene.lights.sphere(geometry, radiance, surface));
            let prim = self.scene.shades.len() as u32;
            self.push(prim, geometry, surface, sphere.material, light, Origin::Sphere(index as u32));
        }
    }

    fn push(
        &mut self,
        prim: u32,
        geometry: [f32; 4],
        surface: u32,
        material: usize,
        light: Option<u32>,
        origin: Origin,
    ) {
        assert_eq!(prim as usize, self.scene.shades.len());
        let (class, colour) = class_of(&self.world.materials[material]);
        let [x, y, z, w] = geometry;
        let [r, g, b] = colour;
        self.scene.shades.push([x, y, z, w, r, g, b, f32::from_bits(surface)]);
        self.scene.classes.push(class as u32 | light.map_or(0, |light| (light + 1) << Class::BITS));
        self.scene.origins.push(origin);
    }

    fn vertex_id(&mut self, v: [f32; 3]) -> u32 {
        let vertices = &mut self.scene.vertices;
        // + 0.0 turns -0 into +0, so that both are one vertex.
        let v = v.map(|x| x + 0.0);
        *self.vertex_ids.entry(v.map(f32::to_bits)).or_insert_with(|| {
            vertices.push(v);
            vertices.len() as u32 - 1
        })
    }

    /// Faces in one plane, whichever side they show, share a surface id: a ray that leaves one cannot hit another.
    fn plane_id(&mut self, plane: [f32; 4]) -> u32 {
        let sign = plane.iter().find(|x| **x != 0.0).map_or(1.0, |x| x.signum());
        let key = plane.map(|x| (x * sign + 0.0).to_bits());
        let next = self.plane_ids.len() as u32;
        *self.plane_ids.entry(key).or_insert(next)
    }
}

/// Twice the area times the normal (Newell's method, from the first corner: exact for what is far from the origin).
pub fn newell(corners: &[DVec3]) -> DVec3 {
    corners[1..].windows(2).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0])).sum()
}

/// The stage that a material needs, and its colour as the shade record holds it.
fn class_of(material: &Material) -> (Class, [f32; 3]) {
    match *material {
        Material::Lambert { albedo: [0.0, 0.0, 0.0] } | Material::Mirror { reflectance: [0.0, 0.0, 0.0] } => {
            (Class::Black, [0.0; 3])
        }
        Material::Lambert { albedo } => (Class::Lambert, round(albedo)),
        Material::Mirror { reflectance } => (Class::Mirror, round(reflectance)),
        Material::Dielectric { ior, .. } => {
            (Class::Dielectric, [ior as f32, (1.0 / ior) as f32, ((ior - 1.0) * (ior + 1.0)) as f32])
        }
    }
}

fn view(frame: &Frame, camera: &Camera) -> View {
    let forward = (camera.look_at - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let reach = libm::tan(camera.fov / 2.0);
    View {
        name: camera.name.clone(),
        eye: frame.point(camera.eye).as_vec3().to_array(),
        forward: forward.as_vec3().to_array(),
        right: (right * reach).as_vec3().to_array(),
        up: (up * reach).as_vec3().to_array(),
    }
}

fn round(rgb: Rgb) -> [f32; 3] {
    rgb.map(|x| x as f32)
}

/// Compile-time check of the record's layout.
const _: () = assert!(size_of::<Shade>() == 32);

impl Default for Scene {
    fn default() -> Self {
        Self {
            frame: Frame::of(&World::default()),
            vertices: Vec::new(),
            corners: Vec::new(),
            faces: Vec::new(),
            spheres: Vec::new(),
            shades: Vec::new(),
            classes: Vec::new(),
            origins: Vec::new(),
            planes: 0,
            lights: LightTable::default(),
            environment: None,
            views: Vec::new(),
            media: None,
            room: None,
            joints: None,
            dropped: 0,
        }
    }
}
