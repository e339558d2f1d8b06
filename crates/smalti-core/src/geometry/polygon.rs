//! The plane of a face against a ray.

use super::Ray;
use super::ray::edge;
use crate::lanes::{Lanes, One, V3};
use crate::mutant::mutant;

/// Below this |cosine| (relative to the direction's largest component) a ray grazes and the distance is clamped to the
/// face's box.
const GRAZING: f32 = 1.0 / 128.0;

/// The ray's cosine with a plane and its height below it, both in units of the direction: the distance is height /
/// cosine. And the lanes that graze it.
#[inline(always)]
fn approach<L: Lanes>(l: L, ray: &Ray<L>, normal: V3<L>, offset: L::F) -> (L::F, L::F, L::M) {
    let cosine = normal.dot(l, ray.direction);
    let mut height = offset - normal.dot(l, ray.origin);
    // Report eq. 16: (Q·E1) in place of (Q·E2) makes every distance 0.
    if mutant!("eq16_distance_zero") {
        height = l.f(0.0);
    }
    (height, cosine, l.lt(l.abs(cosine), ray.major * l.f(GRAZING)))
}

/// Distance to the plane, in units of the direction, and the lanes that graze it. The error of a distance that does
/// not graze is below [`SLACK`](crate::accel::SLACK).
#[inline(always)]
pub fn distance<L: Lanes>(l: L, ray: &Ray<L>, normal: V3<L>, offset: L::F) -> (L::F, L::M) {
    let (height, cosine, grazing) = approach(l, ray, normal, offset);
    (height / cosine, grazing)
}

/// Whether the plane's distance lies in (0, 1), and the lanes that graze it: what comparing [`distance`] would say, as
/// a / b < 1 exactly where a < b, without the division.
#[inline(always)]
pub fn within<L: Lanes>(l: L, ray: &Ray<L>, normal: V3<L>, offset: L::F) -> (L::M, L::M) {
    let (height, cosine, grazing) = approach(l, ray, normal, offset);
    let towards = l.reinterpret(l.bits(height) ^ (l.bits(cosine) & l.u(0x8000_0000)));
    (l.lt(l.f(0.0), towards) & l.lt(towards, l.abs(cosine)), grazing)
}

/// Whether the ray (as a line) passes on one side of all edges between these corners.
pub fn passes(mut corners: impl Iterator<Item = [f32; 3]>, ray: &Ray<One>) -> bool {
    let project = |corner: [f32; 3]| ray.project(One, V3::splat(One, corner));
    let Some(first) = corners.next().map(project) else { return false };
    let (mut left, mut right, mut from) = (true, true, first);
    for to in corners.map(project).chain([first]) {
        let side = edge(from, to);
        left &= side >= 0.0;
        right &= side <= 0.0;
        from = to;
    }
    left != right
}

/// 1 / d with ±MAX in place of ±∞, so that 0 · ∞ cannot arise.
#[inline(always)]
pub fn inverse_direction<L: Lanes>(l: L, d: V3<L>) -> V3<L> {
    V3::new(inverse(l, d.x), inverse(l, d.y), inverse(l, d.z))
}

#[inline(always)]
fn inverse<L: Lanes>(l: L, x: L::F) -> L::F {
    let tiny = l.lt(l.abs(x), l.f(f32::MIN_POSITIVE));
    l.select(tiny, l.copysign(l.f(f32::MAX), x), l.f(1.0) / x)
}

/// The low and high corner of a box around an origin that is wider than what rounding can make of a ray's place: with
/// it, [`slab`] misses no box whose content the ray is found to hit, and no 0 · MAX arises where the origin is in the
/// plane of a side.
#[inline(always)]
pub fn around<L: Lanes>(l: L, origin: V3<L>) -> [V3<L>; 2] {
    let wider = if mutant!("boxes_not_widened") { 0.0 } else { 1.0 / 524_288.0 };
    let e = l.max(origin.max_abs(l), l.f(1.0)) * l.f(wider);
    [V3::new(origin.x - e, origin.y - e, origin.z - e), V3::new(origin.x + e, origin.y + e, origin.z + e)]
}

/// Interval of t inside the box (low, high): monotone in the box, so a larger box never gives a smaller interval.
#[inline(always)]
pub fn slab<L: Lanes>(l: L, [before, behind]: [V3<L>; 2], inverse: V3<L>, low: V3<L>, high: V3<L>) -> (L::F, L::F) {
    let (x0, x1) = ((low.x - behind.x) * inverse.x, (high.x - before.x) * inverse.x);
    let (y0, y1) = ((low.y - behind.y) * inverse.y, (high.y - before.y) * inverse.y);
    let (z0, z1) = ((low.z - behind.z) * inverse.z, (high.z - before.z) * inverse.z);
    let near = l.max(l.min(x0, x1), l.max(l.min(y0, y1), l.min(z0, z1)));
    let far = l.min(l.max(x0, x1), l.min(l.max(y0, y1), l.max(z0, z1)));
    (near, far)
}
