//! Spheres that are one, or lie within another with so small a gap all around that rays would miss it.

use super::meeting::{self, Extent};
use super::{NEAR, ONE_PLACE, Pair, STEP};
use crate::scene::world::{Sphere, World};
use crate::scene::{Frame, Origin};

/// Pairs of spheres. Spheres that touch at a point are none.
pub fn pairs(world: &World, frame: &Frame) -> Vec<Pair> {
    // One that lies around another, or in it, has its low corner where that has it, but for the gap.
    let low_corner = |ball: &Sphere| {
        let corner = frame.point(ball.centre) - ball.radius * frame.scale;
        Extent::around([corner].into_iter(), 2.0 * NEAR * STEP * size(ball, frame))
    };
    let corners = world.spheres.iter().map(low_corner).zip(0..).collect();
    let mut found = Vec::new();
    meeting::within(corners, &mut |a, b| found.extend(pair(world, frame, a.min(b), a.max(b))));
    found.sort_unstable_by_key(|pair| pair.of);
    found
}

fn pair(world: &World, frame: &Frame, a: u32, b: u32) -> Option<Pair> {
    let [one, other] = [a, b].map(|index| &world.spheres[index as usize]);
    let apart = one.centre.distance(other.centre) * frame.scale;
    let step = STEP * size(one, frame).max(size(other, frame));
    // Height of the second over the first where they are nearest to each other.
    let wider = (other.radius - one.radius) * frame.scale;
    let gap = if wider < 0.0 { wider + apart } else { wider - apart };
    let within = apart <= wider.abs();
    let coincide = wider.abs() + apart <= ONE_PLACE * step;
    let near = within && apart <= wider.abs() / 2.0 && gap.abs() <= NEAR * step;
    let clear = [one, other].iter().any(|ball| world.materials[ball.material].is_dielectric());
    let of = [Origin::Sphere(a), Origin::Sphere(b)];
    (coincide || (near && clear)).then_some(Pair { of, gap, step, same_way: true })
}

/// Largest coordinate that the points of a sphere are made from.
fn size(ball: &Sphere, frame: &Frame) -> f64 {
    frame.point(ball.centre).abs().max_element() + ball.radius * frame.scale
}
