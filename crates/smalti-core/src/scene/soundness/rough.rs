//! Spheres so large that rounding makes their surface rough beside small things: the ground as a planet.

use glam::DVec3;

use super::Finding;
use super::coarse::{STEPS, things};
use crate::scene::contact::STEP;
use crate::scene::world::{Sphere, World};
use crate::scene::{Frame, Origin};

/// What is nearer to a sphere than so many times its own extent is beside it: its shadow falls there.
const BESIDE: f64 = 4.0;

/// Pairs of a sphere and a thing that are looked at, the roughest spheres first.
const MOST_PAIRS: usize = 20_000_000;

/// One finding for all such spheres, with the smallest thing for its sphere.
pub fn examine(world: &World, frame: &Frame) -> Option<Finding> {
    let things = things(world);
    let extent = |(_, low, high): &(Origin, DVec3, DVec3)| (*high - *low).max_element();
    let least = things.iter().map(extent).fold(f64::INFINITY, f64::min);
    let mut found = Vec::new();
    for (sphere, ball, rounding) in rough(world, frame, least).into_iter().take(MOST_PAIRS / things.len().max(1)) {
        let beside = |thing: &&(Origin, DVec3, DVec3)| {
            let away = (((thing.1 + thing.2) / 2.0).distance(ball.centre) - ball.radius).abs();
            thing.0 != sphere && extent(thing) < STEPS * rounding && away < BESIDE * extent(thing)
        };
        found.extend(things.iter().filter(beside).map(|thing| (sphere, 2.0 * ball.radius, rounding, thing)));
    }
    let steps = |(_, _, rounding, thing): &(Origin, f64, f64, &(Origin, DVec3, DVec3))| extent(thing) / rounding;
    let &(sphere, across, rounding, thing) = found.iter().min_by(|a, b| steps(a).total_cmp(&steps(b)))?;
    let (beside, extent, things) = (thing.0, extent(thing), found.len());
    Some(Finding::Rough { sphere, across, rounding, beside, extent, things })
}

/// Spheres that are rough for a thing of the extent `least`, and are not themselves too small for where they lie; the
/// roughest first.
fn rough<'w>(world: &'w World, frame: &Frame, least: f64) -> Vec<(Origin, &'w Sphere, f64)> {
    let spheres =
        world.spheres.iter().zip(0..).map(|(ball, index)| (Origin::Sphere(index), ball, rounding(ball, frame)));
    let is_rough =
        |(_, ball, rounding): &(Origin, &Sphere, f64)| STEPS * rounding > least && 2.0 * ball.radius > STEPS * rounding;
    let mut rough: Vec<_> = spheres.filter(is_rough).collect();
    rough.sort_by(|a, b| b.2.total_cmp(&a.2));
    rough
}

/// Rounding of points on a sphere, metres: of its centre and of its radius.
fn rounding(ball: &Sphere, frame: &Frame) -> f64 {
    STEP * (frame.point(ball.centre).abs().max_element() / frame.scale + ball.radius)
}
