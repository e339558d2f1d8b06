//! Glass that stands on a table, glass against glass, and panes as thin as coordinates allow.

mod glass;
mod table;
mod thin;

use glam::{DQuat, DVec3};
use smalti_core::scene::World;
use smalti_core::scene::world::Polygon;
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, mesh};
use smalti_tests::estimate::settings;

/// Reflectance of glass of index 1.5 for perpendicular light.
pub const MIRRORED: f64 = 0.04;

/// How a thing is put into the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Each face by itself.
    Quads,
    /// All of them cut into triangles.
    Mesh,
}

/// Every way.
pub const KINDS: [Kind; 2] = [Kind::Quads, Kind::Mesh];

/// The six faces of the box between two corners, with the normals out.
pub fn faces_of_box(low: DVec3, high: DVec3) -> Vec<Vec<DVec3>> {
    let corner = |k: usize| {
        let side = |bit: usize, axis: usize| if k >> bit & 1 == 1 { high[axis] } else { low[axis] };
        at(side(2, 0), side(1, 1), side(0, 2))
    };
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    faces.map(|face| face.map(corner).to_vec()).to_vec()
}

/// A square about the z axis, seen from above.
pub fn square(half: f64, z: f64) -> Vec<Vec<DVec3>> {
    vec![[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| at(half * x, half * y, z)).to_vec()]
}

/// Puts faces behind everything that was put so far.
pub fn put(world: &mut World, faces: Vec<Vec<DVec3>>, kind: Kind, material: usize) {
    let place = world.order.polygons.len() + world.order.meshes.len();
    match kind {
        Kind::Quads => {
            for vertices in faces {
                world.polygons.push(Polygon { vertices, material, radiance: None });
                world.order.polygons.push(place);
            }
        }
        Kind::Mesh => {
            let triangles = (0..faces.len() as u32).flat_map(|k| [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|c| 4 * k + c)));
            mesh(world, (faces.concat(), triangles.collect()), material, None);
            world.order.meshes.push(place);
        }
    }
}

/// So many triangles far below that the rest is found by a tree.
pub fn dust(world: &mut World, material: usize) {
    let corners = |k: u32| {
        let (x, y) = (f64::from(k % 16) - 8.0, f64::from(k / 16) - 8.0);
        [at(x, y, -90.0), at(x + 0.5, y, -90.0), at(x, y + 0.5, -90.0)]
    };
    let faces = (0..256).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    mesh(world, ((0..256).flat_map(corners).collect(), faces), material, None);
    world.order.meshes.push(usize::MAX);
}

/// Looks down on the middle of what is at the origin, almost in parallel.
pub fn from_above(world: &mut World) {
    world.cameras.clear();
    camera(world, at(0.3, 0.2, 40.0), at(0.3, 0.2, 0.0), 0.005);
}

/// Everything turned and moved.
pub fn elsewhere(world: &World, k: u32) -> World {
    scaled(world, k, 1.0)
}

/// The same, with all lengths × `scale`.
pub fn scaled(world: &World, k: u32, scale: f64) -> World {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, f64::from(k), 0.6 * f64::from(k), 1.9 * f64::from(k));
    let mut moved = world.placed(scale, |point| scale * (turn * point + at(3.0, -1.0, 0.7) * f64::from(k)));
    moved.cameras.iter_mut().for_each(|camera| camera.up = turn * camera.up);
    moved
}

/// A picture of 8 × 8 pixels by path tracing.
pub fn by_paths(spp: u32) -> Settings {
    Settings { integrator: Integrator::Path, ..settings(8, 8, spp) }
}

/// Nothing but a sky of radiance 1.
pub fn under_a_sky() -> World {
    World { environment: Some([1.0; 3]), ..World::default() }
}
