//! Ray against sphere, in the form of Haines, Günther and Akenine-Möller (Ray Tracing Gems, ch. 7, 2019): the
//! discriminant from the point of closest approach, which keeps its digits far away where the report's eq. 20 loses them.

use super::Ray;
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;

/// A ray against a sphere: what both questions need.
struct Meeting<L: Lanes> {
    /// From the centre to the ray's origin.
    from_centre: V3<L>,
    /// d · d.
    a: L::F,
    /// Minus the centre's distance behind the origin, times d · d.
    b: L::F,
    /// Squared radius minus squared distance of the closest approach.
    discriminant: L::F,
}

impl<L: Lanes> Meeting<L> {
    /// `inverse` is 1 / (d · d), the same for all spheres.
    #[inline(always)]
    fn new(l: L, ray: &Ray<L>, inverse: L::F, centre: V3<L>, radius: L::F) -> Self {
        let d = ray.direction;
        let f = ray.origin - centre;
        let (a, b) = (d.dot(l, d), -f.dot(l, d));
        let closest = f.along(l, b * inverse, d);
        let mut discriminant = radius * radius - closest.dot(l, closest);
        // Report eq. 20: the textbook discriminant b² − a c, which cancels far away.
        if mutant!("eq20_textbook_quadratic") {
            discriminant = (b * b - a * (f.dot(l, f) - radius * radius)) * inverse;
        }
        Self { from_centre: f, a, b, discriminant }
    }
}

/// Smallest distance > 0 at which the ray meets the sphere, in units of its direction; +∞ where it does not.
/// `inverse` is 1 / (d · d) of the ray's direction.
///
/// A ray that leaves this very sphere starts on it, moved to one side by more than its error. From outside it cannot
/// meet it again. From inside one root is 0 by construction and only the other is asked for: the whole chord.
#[inline(always)]
pub fn hit<L: Lanes>(l: L, ray: &Ray<L>, inverse: L::F, centre: V3<L>, radius: L::F, leaves_it: L::M) -> L::F {
    let never = l.f(f32::INFINITY);
    let zero = l.f(0.0);
    let Meeting { from_centre: f, a, b, discriminant } = Meeting::new(l, ray, inverse, centre, radius);
    let meets = l.lt(zero, discriminant);
    if !l.any(meets | leaves_it) {
        return never;
    }
    let root = l.sqrt(l.max(a * discriminant, zero));
    let q = b + l.copysign(root, b);
    let c = f.dot(l, f) - radius * radius;
    let (t0, t1) = (c / q, q * inverse);
    let (near, far) = (l.min(t0, t1), l.max(t0, t1));
    // Report §2.13: "choose the smaller t", also where it lies behind.
    let first = if mutant!("smaller_root") { near } else { l.select(l.lt(zero, near), near, far) };
    let leaves_it = if mutant!("smaller_root") { l.m(false) } else { leaves_it };
    // Report §2.12: any t > 0 will do.
    let leaves_it = leaves_it & l.m(!mutant!("any_positive_distance"));
    let chord = l.select(l.lt(zero, c), never, (b + b) * inverse);
    let t = l.select(leaves_it, chord, l.select(meets, first, never));
    l.select(l.lt(zero, t), t, never)
}

/// Whether the ray meets the sphere in (0, 1), in units of its direction: without a root, as no distance is asked for.
#[inline(always)]
pub fn stops<L: Lanes>(l: L, ray: &Ray<L>, inverse: L::F, centre: V3<L>, radius: L::F, leaves_it: L::M) -> L::M {
    let zero = l.f(0.0);
    let Meeting { from_centre: f, a, b, discriminant } = Meeting::new(l, ray, inverse, centre, radius);
    let meets = l.lt(zero, discriminant);
    let end = f + ray.direction;
    let ends_inside = l.lt(end.dot(l, end), radius * radius);
    let starts_outside = l.lt(radius * radius, f.dot(l, f));
    // From outside: it comes in before the end. From inside: it is out at the end.
    let ahead = l.lt(zero, b);
    let enters = starts_outside & meets & ahead & (l.lt(b, a) | ends_inside);
    let exits = !starts_outside & !ends_inside;
    let across = !starts_outside & ahead & l.lt(b + b, a);
    (leaves_it & across) | (!leaves_it & (enters | exits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::One;
    use crate::light::table::NO_SURFACE;

    #[test]
    fn stops_says_what_hit_says() {
        let mut state = 1u32;
        let mut number = || {
            state = crate::sampling::sampler::mix(state.wrapping_add(0x9e37_79b9));
            (state >> 8) as f32 / 8_388_608.0 - 1.0
        };
        let (mut stopped, mut differ) = (0, 0);
        for _ in 0..200_000 {
            let [origin, to, centre] = [0; 3].map(|_| V3::<One>::new(number(), number(), number()));
            let ray = Ray::new(One, origin, to - origin, NO_SURFACE);
            let inverse = 1.0 / ray.direction.dot(One, ray.direction);
            let radius = 0.5 + 0.5 * number();
            let by_distance = hit(One, &ray, inverse, centre, radius, false) < 1.0;
            let answer = stops(One, &ray, inverse, centre, radius, false);
            stopped += u32::from(answer);
            differ += u32::from(answer != by_distance);
        }
        // They may differ where the end touches the sphere to the last bits.
        assert!(stopped > 20_000 && differ <= 2, "{stopped} {differ}");
    }
}
