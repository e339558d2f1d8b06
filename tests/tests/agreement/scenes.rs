//! Small scenes that between them have every primitive, material and light.

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_tests::build::{
    at, camera, closed_box, globe, grey, hexagon_room, material, mesh, mirror, point_light, polygon, quad, sphere,
};

fn coloured(albedo: [f64; 3]) -> Material {
    Material::Lambert { albedo }
}

fn glass() -> Material {
    Material::clear(1.5)
}

/// A closed room with a diffuse, a mirroring and a glass ball under a square lamp.
pub fn room_with_balls() -> World {
    let mut world = World::default();
    let wall = material(&mut world, coloured([0.7, 0.6, 0.5]));
    let (shiny, clear) = (material(&mut world, mirror(0.9)), material(&mut world, glass()));
    closed_box(&mut world, DVec3::ZERO, at(1.5, 1.5, 1.0), wall, None);
    quad(&mut world, at(0.0, 0.3, 0.98), (DVec3::Y * 0.5, DVec3::X * 0.6), wall, Some(4.0));
    sphere(&mut world, at(-0.7, 0.4, -0.6), 0.4, shiny, None);
    sphere(&mut world, at(0.6, 0.2, -0.5), 0.45, clear, None);
    sphere(&mut world, at(0.0, 0.9, -0.7), 0.3, wall, None);
    camera(&mut world, at(0.0, -1.3, 0.1), at(0.0, 0.3, -0.2), 1.2);
    world
}

/// A jagged mesh and a mirror on the floor, in the open under a spherical lamp.
pub fn mesh_in_the_open() -> World {
    let mut world = World { environment: Some([0.1, 0.15, 0.3]), ..World::default() };
    let ground = material(&mut world, coloured([0.5, 0.6, 0.4]));
    let (red, shiny) = (material(&mut world, coloured([0.8, 0.3, 0.2])), material(&mut world, mirror(0.8)));
    quad(&mut world, DVec3::ZERO, (DVec3::X * 3.0, DVec3::Y * 3.0), ground, None);
    let (vertices, faces) = globe(7, 5, |row, column| 0.6 + 0.15 * f64::from((row * 5 + column * 3) % 4));
    mesh(&mut world, (vertices.into_iter().map(|v| v + at(-0.3, 0.4, 1.0)).collect(), faces), red, None);
    quad(&mut world, at(1.6, 0.8, 1.0), (at(0.3, -0.9, 0.0), DVec3::Z), shiny, None);
    sphere(&mut world, at(0.8, -1.0, 2.2), 0.4, ground, Some(12.0));
    camera(&mut world, at(0.2, -4.0, 1.8), at(0.0, 0.0, 0.8), 0.9);
    world
}

/// A hexagonal room with a lamp of each kind, unlike in power.
pub fn lamps_of_all_kinds() -> World {
    let mut world = World::default();
    let wall = material(&mut world, coloured([0.6, 0.5, 0.7]));
    let black = material(&mut world, grey(0.0));
    hexagon_room(&mut world, wall, None);
    quad(&mut world, at(0.3, 0.2, 0.9), (at(0.0, 0.2, 0.05), at(0.2, 0.0, 0.0)), black, Some(6.0));
    polygon(&mut world, &[at(-0.6, 0.3, 0.5), at(-0.5, -0.1, 0.4), at(-0.5, 0.1, 0.9)], black, Some(3.0));
    let pentagon = [(0.2, 0.0), (0.06, 0.19), (-0.16, 0.12), (-0.16, -0.12), (0.06, -0.19)];
    polygon(&mut world, &pentagon.map(|(x, y)| at(x, y - 0.3, -0.9)), wall, Some(4.0));
    sphere(&mut world, at(0.4, -0.4, 0.1), 0.08, wall, Some(15.0));
    point_light(&mut world, at(-0.2, -0.3, 0.6), 0.4);
    point_light(&mut world, at(0.1, 0.5, -0.4), 0.1);
    let (vertices, faces) = globe(4, 3, |_, _| 0.15);
    mesh(&mut world, (vertices.into_iter().map(|v| v + at(0.2, 0.4, 0.3)).collect(), faces), wall, Some(2.0));
    camera(&mut world, at(-0.7, -0.3, 0.0), at(0.5, 0.2, -0.1), 1.5);
    world
}

/// A camera inside a ball of glass that looks at a lit room.
pub fn camera_in_glass() -> World {
    let mut world = World { environment: Some([0.3, 0.4, 0.5]), ..World::default() };
    let wall = material(&mut world, coloured([0.7, 0.4, 0.3]));
    let clear = material(&mut world, glass());
    quad(&mut world, at(0.0, 0.0, -1.0), (DVec3::X * 2.0, DVec3::Y * 2.0), wall, None);
    quad(&mut world, at(0.0, 2.0, 0.0), (DVec3::X * 2.0, DVec3::Z), wall, None);
    quad(&mut world, at(0.5, 0.9, 1.5), (DVec3::Y * 0.6, DVec3::X * 0.6), wall, Some(5.0));
    sphere(&mut world, at(0.0, -0.5, 0.0), 0.6, clear, None);
    sphere(&mut world, at(0.2, 1.0, -0.6), 0.4, wall, None);
    camera(&mut world, at(0.1, -0.6, 0.1), at(0.0, 1.0, -0.2), 1.3);
    world
}

/// Diffuse and glass balls on the ground under a uniform sky.
pub fn under_the_sky() -> World {
    let mut world = World { environment: Some([1.0, 0.8, 0.6]), ..World::default() };
    let ground = material(&mut world, coloured([0.5, 0.5, 0.8]));
    let clear = material(&mut world, Material::clear(1.8));
    quad(&mut world, DVec3::ZERO, (DVec3::X * 2.0, DVec3::Y * 2.0), ground, None);
    sphere(&mut world, at(-0.5, 0.0, 0.5), 0.5, ground, None);
    sphere(&mut world, at(0.6, -0.2, 0.4), 0.4, clear, None);
    sphere(&mut world, at(0.1, -0.8, 0.2), 0.2, clear, None);
    camera(&mut world, at(0.3, -3.0, 1.2), at(0.0, 0.0, 0.4), 0.8);
    world
}

/// A room whose back wall and a ball emit: light that chance finds.
pub fn glowing_room() -> World {
    let mut world = World::default();
    let wall = material(&mut world, coloured([0.8, 0.6, 0.4]));
    let clear = material(&mut world, glass());
    closed_box(&mut world, DVec3::ZERO, at(1.0, 1.0, 1.0), wall, None);
    quad(&mut world, at(0.0, 0.99, 0.0), (DVec3::X * 0.9, DVec3::Z * 0.9), wall, Some(1.0));
    sphere(&mut world, at(0.4, -0.2, -0.5), 0.4, wall, Some(0.5));
    sphere(&mut world, at(-0.4, 0.2, -0.5), 0.4, clear, None);
    camera(&mut world, at(0.0, -0.9, 0.2), at(0.0, 0.5, -0.2), 1.4);
    world
}

fn tinted(ior: f64, absorption: [f64; 3]) -> Material {
    Material::Dielectric { ior, absorption }
}

/// A ball of tinted glass with a lamp, a diffuse ball and a bubble in it; a block of another, and of a third that bends no
/// light, in a lit room. The camera is in the room, or in the glass.
pub fn tinted_glass(eye: DVec3) -> World {
    let mut world = World { environment: Some([0.3, 0.4, 0.5]), ..World::default() };
    let wall = material(&mut world, coloured([0.7, 0.6, 0.5]));
    let amber = material(&mut world, tinted(1.5, [0.3, 0.9, 2.5]));
    let bubble = material(&mut world, glass_in_glass());
    let blue = material(&mut world, tinted(1.3, [3.0, 1.0, 0.2]));
    let smoke = material(&mut world, tinted(1.0, [1.5; 3]));
    quad(&mut world, at(0.0, 0.0, -1.0), (DVec3::X * 2.0, DVec3::Y * 2.0), wall, None);
    quad(&mut world, at(0.0, 1.5, 0.0), (DVec3::X * 2.0, DVec3::Z), wall, None);
    quad(&mut world, at(0.5, 0.6, 1.5), (DVec3::Y * 0.6, DVec3::X * 0.6), wall, Some(4.0));
    sphere(&mut world, at(0.0, 0.0, -0.2), 0.7, amber, None);
    sphere(&mut world, at(0.2, 0.1, -0.4), 0.2, wall, None);
    sphere(&mut world, at(-0.25, -0.1, 0.0), 0.15, wall, Some(3.0));
    sphere(&mut world, at(0.3, -0.3, 0.0), 0.2, bubble, None);
    let (corners, faces) = globe(5, 4, |_, _| 0.35);
    mesh(&mut world, (corners.into_iter().map(|v| v + at(-1.0, 0.2, -0.6)).collect(), faces), blue, None);
    sphere(&mut world, at(1.1, 0.3, -0.6), 0.3, smoke, None);
    let target = if eye.length() < 1.0 { at(0.2, 1.0, -0.4) } else { at(0.0, 0.0, -0.2) };
    camera(&mut world, eye, target, 0.9);
    world
}

/// A vacuum as seen from glass.
fn glass_in_glass() -> Material {
    Material::clear(1.0 / 1.5)
}
