//! Closed meshes, and rays that may find a way out of them at an edge or a corner.

use glam::DVec3;
use smalti_core::accel::{Accel, MISS, Tracer};
use smalti_core::geometry::Ray;
use smalti_core::lanes::{One, V3};
use smalti_core::light::table::NO_SURFACE;
use smalti_core::scene::{Scene, World, compile};

use crate::build::{globe, grey, material, mesh};
use crate::leaving::{next, shaded, vector};
use crate::oracle::Random;

/// A closed mesh about the origin whose corners are jittered in distance, squeezed and put `away`.
pub fn shell((columns, rows): (u32, u32), squeeze: DVec3, away: DVec3, random: &mut Random) -> Scene {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    let (vertices, faces) = globe(columns, rows, |_, _| random.between(0.7, 1.3));
    mesh(&mut world, (vertices.into_iter().map(|v| v * squeeze + away).collect(), faces), white, None);
    compile(&world, false)
}

/// Directions from `from` to corners, points of edges and points of faces, as f32 has them.
pub fn aims(scene: &Scene, from: DVec3, random: &mut Random) -> [f32; 3] {
    let corners = &scene.corners[3 * random.below(scene.corners.len() / 3)..][..3];
    let [a, b, c] = [0, 1, 2].map(|k| DVec3::from_array(scene.vertices[corners[k] as usize].map(f64::from)));
    let goal = match random.below(4) {
        0 => a,
        1 => (a + b) / 2.0,
        2 => a + random.unit() * (b - a),
        _ => (a + b + c) / 3.0,
    };
    (goal - from).normalize().as_vec3().to_array()
}

/// Rays of `shots` that leave the shell unhindered.
pub fn leaks(scene: &Scene, accel: &Accel, centre: DVec3, shots: u32, random: &mut Random) -> u32 {
    let mut tracer = Tracer::new(One, accel);
    let mut leaks = 0;
    for _ in 0..shots {
        let from = scene.frame.point(centre) + random.cube() * 0.01 * scene.frame.scale;
        let from = from.as_vec3();
        let direction = aims(scene, from.as_dvec3(), random);
        let ray = Ray::new(One, V3::splat(One, from.to_array()), V3::splat(One, direction), NO_SURFACE);
        let (distance, prim) = tracer.nearest(One, &ray, true);
        leaks += u32::from(prim == MISS || !distance.is_finite());
    }
    leaks
}

/// Rays that start on the inside of the shell, at random places of it, and leave it unhindered.
pub fn slips(scene: &Scene, accel: &Accel, centre: DVec3, shots: u32, random: &mut Random) -> u32 {
    let mut tracer = Tracer::new(One, accel);
    let mut slips = 0;
    for _ in 0..shots.div_ceil(8) {
        let from = scene.frame.point(centre) + random.cube() * 0.01 * scene.frame.scale;
        let Some((hit, _)) = shaded(scene, accel, from, from + random.direction()) else { continue };
        let side = if hit.outside { hit.normal } else { -hit.normal };
        for _ in 0..8 {
            let (_, prim) = next(&mut tracer, &hit, side, random.cosine_about(vector(side)));
            slips += u32::from(prim == MISS);
        }
    }
    slips
}

/// Round, flat, a needle.
pub const SQUEEZES: [DVec3; 4] =
    [DVec3::ONE, DVec3::new(1.0, 1.0, 0.05), DVec3::new(20.0, 0.3, 1.0), DVec3::new(1.0, 1000.0, 1.0)];
