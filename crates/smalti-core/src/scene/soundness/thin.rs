//! Panes and gaps as thin as the coordinates' steps.

use glam::DVec3;

use super::Finding;
use crate::scene::contact::{Pair, STEP};
use crate::scene::world::World;
use crate::scene::{Frame, Origin, newell};

/// Thinner than so many steps, and which side of a face a ray starts on is a matter of rounding. (On spheres and on inclined
/// faces; a pane along the axes is right down to two.)
const STEPS: f64 = 8.0;

/// Two faces of one body that are nearer than this, in steps, were written as one.
const WRITTEN_AS_ONE: f64 = 1e-3;

/// One finding for each two materials, with the thinnest place.
pub fn examine(world: &World, frame: &Frame, pairs: &[Pair]) -> Vec<Finding> {
    let mut found: Vec<Finding> = Vec::new();
    for pair in pairs {
        let steps = pair.gap.abs() / step(world, frame, pair);
        if is_lost(world, pair, steps) {
            enter(&mut found, lost(world, frame, pair, steps));
        }
    }
    found
}

fn lost(world: &World, frame: &Frame, pair: &Pair, steps: f64) -> Finding {
    let mut materials = pair.of.map(|origin| world.skin(origin).0);
    materials.sort_unstable();
    Finding::Thin { of: pair.of, materials, thickness: pair.gap.abs() / frame.scale, steps, places: 1 }
}

/// Adds a finding, to one of these materials if there is one.
fn enter(found: &mut Vec<Finding>, new: Finding) {
    let Finding::Thin { materials: of_new, steps: new_steps, .. } = new else { return };
    for known in found.iter_mut() {
        let Finding::Thin { materials, steps, places, .. } = known else { continue };
        if *materials == of_new {
            let count = *places + 1;
            if new_steps < *steps {
                *known = new;
            }
            if let Finding::Thin { places, .. } = known {
                *places = count;
            }
            return;
        }
    }
    found.push(new);
}

/// A step across the gap: of coordinates, or of the distance from the farthest camera. (By their distances rays find out
/// which of the two is nearer; those are apart from two steps on.)
fn step(world: &World, frame: &Frame, pair: &Pair) -> f64 {
    let heights = world.cameras.iter().map(|camera| height(world, pair.of[0], camera.eye));
    pair.step.max(STEP * 2.0 / STEPS * heights.fold(0.0, f64::max) * frame.scale)
}

/// Of an eye over the plane of a face, or over a sphere.
fn height(world: &World, surface: Origin, eye: DVec3) -> f64 {
    if let Origin::Sphere(index) = surface {
        let ball = &world.spheres[index as usize];
        return (ball.centre.distance(eye) - ball.radius).abs();
    }
    let corners = world.corners(surface);
    newell(&corners).normalize_or_zero().dot(eye - corners[0]).abs()
}

/// Whether what is between the two may be lost.
fn is_lost(world: &World, pair: &Pair, steps: f64) -> bool {
    if !pair.coincides() {
        return steps < if matches!(pair.of[0], Origin::Sphere(_)) { 2.0 * STEPS } else { STEPS };
    }
    let [a, b] = pair.of.map(|origin| world.skin(origin).0);
    let one_thing = match pair.of {
        [Origin::Polygon(_), Origin::Polygon(_)] => a == b,
        [Origin::Mesh(one, _), Origin::Mesh(other, _)] => one == other,
        _ => false,
    };
    // A pane whose two faces have become one; not two things that stand at each other.
    let is_pane = one_thing && !pair.same_way && pair.gap < 0.0 && world.materials[a].is_dielectric();
    is_pane && pair.gap.abs() > WRITTEN_AS_ONE * pair.step
}
