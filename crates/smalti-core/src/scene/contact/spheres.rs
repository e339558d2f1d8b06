//! Spheres that are one, or lie within another with so small a gap all around that rays would miss it.

use super::{NEAR, ONE_PLACE, Pair, STEP};
use crate::scene::world::{Sphere, World};
use crate::scene::{Frame, Origin};

/// Pairs of spheres. Spheres that touch at a point are none.
pub fn pairs(world: &World, frame: &Frame) -> Vec<Pair> {
    let spheres = &world.spheres;
    let mut order: Vec<u32> = (0..spheres.len() as u32).collect();
    let low = |index: u32| spheres[index as usize].centre.x - spheres[index as usize].radius;
    order.sort_by(|a, b| low(*a).total_cmp(&low(*b)).then(a.cmp(b)));
    let mut found = Vec::new();
    for (at, &a) in order.iter().enumerate() {
        // One that lies around this one, or in it, begins where it begins, but for the gap.
        let largest = frame.point(spheres[a as usize].centre).abs().max_element() / frame.scale;
        let reach = 2.0 * NEAR * STEP * (largest + spheres[a as usize].radius);
        let until = low(a) + reach;
        for &b in order[at + 1..].iter().take_while(|b| low(**b) <= until) {
            found.extend(pair(world, frame, a.min(b), a.max(b)));
        }
    }
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
