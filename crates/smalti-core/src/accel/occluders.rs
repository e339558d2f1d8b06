//! Which primitives can stop a ray between a surface point and a light.
//!
//! A planar face with every corner, sphere and light on one side (or in its plane) cannot: a segment between two
//! such points does not cross it. Neither can a face in whose plane every light lies: the segment meets that plane only
//! at its end. For rays to infinity nothing is pruned.

use crate::light::table::Kind;
use crate::mutant::mutant;
use crate::scene::{Face, Scene};

/// Primitives that may occlude, in increasing order.
pub fn of(scene: &Scene) -> Vec<u32> {
    let faces = scene.faces.iter().enumerate().filter(|(_, face)| !prunable(scene, face)).map(|(prim, _)| prim as u32);
    let spheres = scene.faces.len() as u32..(scene.faces.len() + scene.spheres.len()) as u32;
    faces.chain(spheres).collect()
}

/// Whether no ray between two points of the scene can be stopped by this face.
fn prunable(scene: &Scene, face: &Face) -> bool {
    if scene.lights.has(Kind::Sky) && !mutant!("occluder_of_the_sky_pruned") {
        return false;
    }
    scene.lights.surfaces.iter().all(|surface| *surface == face.surface)
        || everything_beside(scene, face, 1.0)
        || everything_beside(scene, face, -1.0)
}

/// Whether everything lies on the side of the face's plane that `side` (±1) names. What is in the plane up to the
/// rounding of coordinates (which are within 1) counts as beside it.
fn everything_beside(scene: &Scene, face: &Face, side: f64) -> bool {
    let [nx, ny, nz, d] = face.plane.map(|x| side * f64::from(x));
    let height = |p: &[f32]| nx * f64::from(p[0]) + ny * f64::from(p[1]) + nz * f64::from(p[2]) - d;
    let tolerance = if mutant!("occluder_pruned_that_can_occlude") { 0.5 } else { 4e-7 };
    let lights = scene.lights.rows.iter().zip(&scene.lights.kinds);
    scene.vertices.iter().all(|v| height(v) >= -tolerance)
        && scene.spheres.iter().all(|s| height(s) - f64::from(s[3]) >= -tolerance)
        && lights.filter(|(_, kind)| **kind == Kind::Point as u32).all(|(row, _)| height(row) >= -tolerance)
}
