//! Spheres so large that rounding makes their surface rough beside small things: the ground as a planet.

use glam::DVec3;

use super::Finding;
use super::coarse::{STEPS, things};
use crate::scene::contact::STEP;
use crate::scene::world::{Sphere, World};
use crate::scene::{Frame, Origin};

/// What is nearer to a sphere than so many times its own extent is beside it: its shadow falls there.
const BESIDE: f64 = 4.0;

/// One finding for all such spheres, with the smallest thing for its sphere.
pub fn examine(world: &World, frame: &Frame) -> Option<Finding> {
    let things = things(world);
    let extent = |(_, low, high): &(Origin, DVec3, DVec3)| (*high - *low).max_element();
    let least = things.iter().map(extent).fold(f64::INFINITY, f64::min);
    let spheres = world.spheres.iter().enumerate().map(|(index, ball)| (index, ball, rounding(ball, frame)));
    let mut found: Vec<(f64, Finding)> = Vec::new();
    for (index, ball, rounding) in spheres.filter(|(_, _, rounding)| STEPS * rounding > least) {
        let sphere = Origin::Sphere(index as u32);
        let beside = |thing: &&(Origin, DVec3, DVec3)| {
            let away = (((thing.1 + thing.2) / 2.0).distance(ball.centre) - ball.radius).abs();
            thing.0 != sphere && extent(thing) < STEPS * rounding && away < BESIDE * extent(thing)
        };
        for thing in things.iter().filter(beside) {
            let (beside, extent, across) = (thing.0, extent(thing), 2.0 * ball.radius);
            found.push((extent / rounding, Finding::Rough { sphere, across, rounding, beside, extent, things: 1 }));
        }
    }
    let count = found.len();
    let worst = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?.1;
    Some(match worst {
        Finding::Rough { sphere, across, rounding, beside, extent, .. } => {
            Finding::Rough { sphere, across, rounding, beside, extent, things: count }
        }
        other => other,
    })
}

/// Rounding of points on a sphere, metres: of its centre and of its radius.
fn rounding(ball: &Sphere, frame: &Frame) -> f64 {
    STEP * (frame.point(ball.centre).abs().max_element() / frame.scale + ball.radius)
}
