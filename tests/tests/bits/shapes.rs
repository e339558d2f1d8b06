//! Compiled scenes whose geometry is hard: shared corners, faces in one plane, duplicates, slivers, touching spheres.

use glam::{DVec3, Vec3};
use smalti_core::scene::world::{Material, Mesh, Sphere};
use smalti_core::scene::{Scene, World, compile};
use smalti_tests::draw::{load, repository};

use crate::rays::Dice;

/// The scene in a file.
pub fn of_file(path: &str) -> Scene {
    compile(&load(&repository().join(path)).world, false)
}

fn of_mesh(vertices: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Scene {
    let mesh = Mesh { vertices, faces, material: 0, radiance: None };
    compile(
        &World { materials: vec![Material::Lambert { albedo: [0.5; 3] }], meshes: vec![mesh], ..World::default() },
        false,
    )
}

/// Random triangles between few points: most corners and edges are shared, triangles cross, some have no area.
pub fn shared_corners(seed: u64) -> Scene {
    let mut dice = Dice::new(seed);
    let vertices: Vec<DVec3> = (0..24).map(|_| dice.cube().as_dvec3()).collect();
    let faces = (0..90).map(|_| [0; 3].map(|_| dice.below(vertices.len()) as u32));
    let faces = faces.collect();
    of_mesh(vertices, faces)
}

/// Triangles between points of a coarse lattice: many in one plane, many twice, on both windings.
pub fn on_a_lattice(seed: u64) -> Scene {
    let mut dice = Dice::new(100 + seed);
    let vertices: Vec<DVec3> =
        (0..27).map(|i| DVec3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64)).collect();
    let mut faces: Vec<[u32; 3]> = (0..70).map(|_| [0; 3].map(|_| dice.below(27) as u32)).collect();
    let again: Vec<[u32; 3]> = faces.iter().step_by(3).map(|&[a, b, c]| [c, b, a]).collect();
    faces.extend(again);
    of_mesh(vertices, faces)
}

/// Triangles a million times as long as wide, in a fan and at random.
pub fn slivers(seed: u64) -> Scene {
    let mut dice = Dice::new(200 + seed);
    let mut vertices = vec![DVec3::ZERO];
    let mut faces = Vec::new();
    for _ in 0..70 {
        let (a, b) = (dice.cube().as_dvec3(), dice.cube().as_dvec3());
        let near = vertices.len() as u32;
        vertices.extend([a, b, b + (dice.cube() * 1e-6).as_dvec3()]);
        faces.push(if dice.unit() < 0.5 { [0, near, near + 1] } else { [near, near + 1, near + 2] });
    }
    of_mesh(vertices, faces)
}

/// A flat square of n × n × 2 triangles: all in one plane, which lies along the axes.
pub fn flat_grid(n: u32) -> Scene {
    let point = |i: u32| DVec3::new(f64::from(i % (n + 1)), f64::from(i / (n + 1)), 0.0) / f64::from(n);
    let mut vertices: Vec<DVec3> = (0..(n + 1) * (n + 1)).map(point).collect();
    // Something else, or the box is flat as well.
    vertices.push(DVec3::new(0.3, 0.4, -0.7));
    let top = vertices.len() as u32 - 1;
    let square = |i: u32| {
        let corner = i / n * (n + 1) + i % n;
        [[corner, corner + 1, corner + n + 2], [corner, corner + n + 2, corner + n + 1]]
    };
    let mut faces: Vec<[u32; 3]> = (0..n * n).flat_map(square).collect();
    faces.extend([[0, n, top], [n, top - 1, top]]);
    of_mesh(vertices, faces)
}

/// Spheres at random, around one another, touching one another, and twice.
pub fn spheres(seed: u64) -> Scene {
    let mut dice = Dice::new(300 + seed);
    let mut spheres = Vec::new();
    for number in 0..80 {
        let (centre, radius) = match number % 4 {
            0 => (dice.cube(), 0.02 + 0.3 * dice.unit()),
            1 => (Vec3::ZERO, 0.1 + 0.01 * number as f32),
            2 => ((dice.cube() * 2.0).round() * 0.5, 0.25),
            _ => (dice.cube(), 1e-3 * dice.unit()),
        };
        spheres.push(Sphere { centre: centre.as_dvec3(), radius: radius.into(), material: 0, radiance: None });
    }
    compile(&World { materials: vec![Material::Lambert { albedo: [0.5; 3] }], spheres, ..World::default() }, false)
}
