//! Leaving a surface without hitting it again.

use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;

/// Bound on the error of a refined hit point along its normal, relative to the largest coordinate: 2⁻²⁴ times about
/// twice the γ(7) of pbrt's analysis, plus the neighbour's share.
const ERROR: f32 = 24.0 / 16_777_216.0;

/// The point from where rays leave to the side of `normal`: moved out by the bound on its error. `scale` is the largest
/// coordinate that the point was made from.
#[inline(always)]
pub fn leave<L: Lanes>(l: L, point: V3<L>, scale: L::F, normal: V3<L>) -> V3<L> {
    point.along(l, error(l, scale), normal)
}

/// The same, but no farther than `room`: something else is as near.
#[inline(always)]
pub fn leave_within<L: Lanes>(l: L, point: V3<L>, scale: L::F, room: L::F, normal: V3<L>) -> V3<L> {
    point.along(l, l.min(error(l, scale), room), normal)
}

#[inline(always)]
fn error<L: Lanes>(l: L, scale: L::F) -> L::F {
    let error = if mutant!("any_positive_distance") { 0.0 } else { ERROR };
    let scale = if mutant!("absolute_epsilon") { l.f(1e-4 / ERROR) } else { scale };
    scale * l.f(error)
}

/// A hit at distance `t` of a ray, moved onto the plane n·x = d that it hit.
#[inline(always)]
pub fn onto_plane<L: Lanes>(l: L, point: V3<L>, normal: V3<L>, offset: L::F) -> V3<L> {
    point.along(l, offset - normal.dot(l, point), normal)
}

/// A hit of a ray, moved onto the sphere that it hit, and the unit normal there.
#[inline(always)]
pub fn onto_sphere<L: Lanes>(l: L, point: V3<L>, centre: V3<L>, radius: L::F) -> (V3<L>, V3<L>) {
    let normal = (point - centre).normalised(l);
    (centre.along(l, radius, normal), normal)
}
