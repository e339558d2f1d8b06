//! Warps: from the unit square to directions and points, each with its pdf.

use core::f32::consts::{FRAC_1_PI, FRAC_PI_4, PI};

use crate::lanes::math::{sin_cos_quarter, sin_cos_turn};
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;

/// A point of the unit disc, concentric (Shirley and Chiu 1997): areas and neighbourhoods are kept.
#[inline(always)]
pub fn disc<L: Lanes>(l: L, u: L::F, v: L::F) -> (L::F, L::F) {
    let two = l.f(2.0);
    let (a, b) = (l.mul_add(two, u, l.f(-1.0)), l.mul_add(two, v, l.f(-1.0)));
    let a_wins = l.lt(l.abs(b), l.abs(a));
    let radius = l.select(a_wins, a, b);
    let other = l.select(a_wins, b, a);
    let safe = l.select(l.eq(radius, l.f(0.0)), l.f(1.0), radius);
    let (s, c) = sin_cos_quarter(l, other / safe * l.f(FRAC_PI_4));
    (radius * l.select(a_wins, c, s), radius * l.select(a_wins, s, c))
}

/// A direction about +z with density cosθ/π (Malley's method); z > 0 and unit length to rounding.
///
/// Corrects the report's eq. 12, which draws azimuth and inclination from one number.
#[inline(always)]
pub fn cosine_hemisphere<L: Lanes>(l: L, u: L::F, v: L::F) -> V3<L> {
    // Report eq. 12: azimuth and inclination from one number.
    let v = if mutant!("eq12_one_number") { u } else { v };
    let (x, y) = disc(l, u, v);
    // Report eq. 11 with directions that are not cosine-distributed: uniform, but weighed as if they were.
    if mutant!("eq11_uniform_directions") {
        let z = l.f(1.0) - (x * x + y * y);
        let stretch = l.sqrt(l.f(1.0) + z);
        return V3::new(x * stretch, y * stretch, z);
    }
    // 1 - x² - y² is at least about 1e-7 for numbers below 1; the floor keeps the pdf away from 0.
    let z = l.sqrt(l.max(l.mul_add(-x, x, l.mul_add(-y, y, l.f(1.0))), l.f(6e-8)));
    V3::new(x, y, z)
}

/// Density of [`cosine_hemisphere`] at a direction with this cosine, sr⁻¹.
#[inline(always)]
pub fn cosine_hemisphere_pdf<L: Lanes>(l: L, cosine: L::F) -> L::F {
    cosine * l.f(FRAC_1_PI)
}

/// A direction uniform in the cone about +z with 1 − cos θmax = `opening`, and its 1 − cosθ.
#[inline(always)]
pub fn cone<L: Lanes>(l: L, opening: L::F, u: L::F, v: L::F) -> (V3<L>, L::F) {
    let below = u * opening;
    let sine = l.sqrt(below * (l.f(2.0) - below));
    let (s, c) = sin_cos_turn(l, v);
    (V3::new(sine * c, sine * s, l.f(1.0) - below), below)
}

/// A direction uniform over the whole sphere; density 1 / 4π.
#[inline(always)]
pub fn sphere<L: Lanes>(l: L, u: L::F, v: L::F) -> V3<L> {
    let z = l.mul_add(l.f(-2.0), u, l.f(1.0));
    let across = l.sqrt(l.f(4.0) * u * (l.f(1.0) - u));
    let (s, c) = sin_cos_turn(l, v);
    V3::new(across * c, across * s, z)
}

/// Density of [`cone`], sr⁻¹.
#[inline(always)]
pub fn cone_pdf<L: Lanes>(l: L, opening: L::F) -> L::F {
    l.f(1.0 / (2.0 * PI)) / opening
}

/// 1 − cosθmax of the cone in which a sphere of radius `r` is seen from distance `d` > r, without cancellation.
#[inline(always)]
pub fn sphere_opening<L: Lanes>(l: L, r_squared: L::F, d_squared: L::F) -> L::F {
    let sine_squared = r_squared / d_squared;
    sine_squared / (l.f(1.0) + l.sqrt(l.max(l.f(1.0) - sine_squared, l.f(0.0))))
}

/// Barycentric (u, v) uniform on the triangle: a low-distortion fold of the square (Heitz 2019).
#[inline(always)]
pub fn triangle<L: Lanes>(l: L, u: L::F, v: L::F) -> (L::F, L::F) {
    let half = l.f(0.5);
    let below = l.lt(u, v);
    let (small, large) = (l.select(below, u, v) * half, l.select(below, v, u));
    let rest = large - small;
    (l.select(below, small, rest), l.select(below, rest, small))
}

/// `v`, given about +z, turned so that +z becomes the unit vector `n` (Duff et al., JCGT 6(1), 2017).
#[inline(always)]
pub fn about<L: Lanes>(l: L, n: V3<L>, v: V3<L>) -> V3<L> {
    let sign = l.copysign(l.f(1.0), n.z);
    let a = l.f(-1.0) / (sign + n.z);
    let b = n.x * n.y * a;
    let tangent: V3<L> = V3::new(l.mul_add(sign * n.x * n.x, a, l.f(1.0)), sign * b, -sign * n.x);
    let bitangent: V3<L> = V3::new(b, l.mul_add(n.y * n.y, a, sign), -n.y);
    V3::new(
        l.mul_add(v.x, tangent.x, l.mul_add(v.y, bitangent.x, v.z * n.x)),
        l.mul_add(v.x, tangent.y, l.mul_add(v.y, bitangent.y, v.z * n.y)),
        l.mul_add(v.x, tangent.z, l.mul_add(v.y, bitangent.z, v.z * n.z)),
    )
}
