//! Ray against sphere, in the form of Haines, Günther and Akenine-Möller (Ray Tracing Gems, ch. 7, 2019): the
//! discriminant from the point of closest approach, which keeps its digits far away where the report's eq. 20 loses them.

use super::Ray;
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;

/// Smallest distance > 0 at which the ray meets the sphere, in units of its direction; +∞ where it does not.
///
/// A ray that leaves this very sphere starts on it: one root is 0 by construction and only the other is asked for, so
/// nothing depends on the rounding of the start point.
#[inline(always)]
pub fn hit<L: Lanes>(l: L, ray: &Ray<L>, centre: V3<L>, radius: L::F, leaves_it: L::M) -> L::F {
    let never = l.f(f32::INFINITY);
    let d = ray.direction;
    let f = ray.origin - centre;
    let a = d.dot(l, d);
    let b = -f.dot(l, d);
    let zero = l.f(0.0);
    let closest = f.along(l, b / a, d);
    let mut discriminant = l.mul_add(radius, radius, -closest.dot(l, closest));
    // Report eq. 20: the textbook discriminant b² − a c, which cancels far away.
    if mutant!("eq20_textbook_quadratic") {
        discriminant = (b * b - a * (f.dot(l, f) - radius * radius)) / a;
    }
    let meets = l.lt(zero, discriminant);
    if !l.any(meets | leaves_it) {
        return never;
    }
    let root = l.sqrt(l.max(a * discriminant, zero));
    let q = b + l.copysign(root, b);
    let c = f.dot(l, f) - radius * radius;
    let (t0, t1) = (c / q, q / a);
    let (near, far) = (l.min(t0, t1), l.max(t0, t1));
    // Report §2.13: "choose the smaller t", also where it lies behind.
    let first = if mutant!("smaller_root") { near } else { l.select(l.lt(zero, near), near, far) };
    let leaves_it = if mutant!("smaller_root") { l.m(false) } else { leaves_it };
    let other = (b + b) / a;
    // Report §2.12: any t > 0 will do.
    let leaves_it = leaves_it & l.m(!mutant!("any_positive_distance"));
    let t = l.select(leaves_it, other, l.select(meets, first, never));
    l.select(l.lt(zero, t), t, never)
}
