//! Transcendental functions on lanes: polynomials with stated errors, the same bits at every width.
//! (std's differ between machines, so they may not reach the image.)

use core::f32::consts::FRAC_PI_4;

use super::Lanes;

/// (sin x, cos x) for |x| ≤ π/4; absolute error below 1e-7.
///
/// Minimax coefficients of the Cephes library's `sinf` and `cosf` (S. Moshier).
#[inline(always)]
pub fn sin_cos_quarter<L: Lanes>(l: L, x: L::F) -> (L::F, L::F) {
    let z = x * x;
    let sine =
        l.mul_add(l.mul_add(z, l.mul_add(z, l.f(-1.951_529_6e-4), l.f(8.332_161e-3)), l.f(-1.666_665_5e-1)) * z, x, x);
    let c = l.mul_add(z, l.mul_add(z, l.f(2.443_315_7e-5), l.f(-1.388_731_6e-3)), l.f(4.166_664_6e-2));
    let cosine = l.mul_add(c * z, z, l.mul_add(z, l.f(-0.5), l.f(1.0)));
    (sine, cosine)
}

/// (sin 2πu, cos 2πu) for u in [0, 1): the octant by arithmetic on `u`, which is exact, then the quarter polynomials.
#[inline(always)]
pub fn sin_cos_turn<L: Lanes>(l: L, u: L::F) -> (L::F, L::F) {
    // v in [-4, 4): eighths of a turn from the middle; the quadrant is the nearest even integer's half.
    let turned = u * l.f(8.0);
    let q1 = !l.lt(turned, l.f(1.0)) & l.lt(turned, l.f(3.0));
    let q2 = !l.lt(turned, l.f(3.0)) & l.lt(turned, l.f(5.0));
    let q3 = !l.lt(turned, l.f(5.0)) & l.lt(turned, l.f(7.0));
    let q4 = !l.lt(turned, l.f(7.0));
    let zero = l.f(0.0);
    let centre = l.select(q1, l.f(2.0), l.select(q2, l.f(4.0), l.select(q3, l.f(6.0), l.select(q4, l.f(8.0), zero))));
    let (s, c) = sin_cos_quarter(l, (turned - centre) * l.f(FRAC_PI_4));
    let sine = l.select(q1, c, l.select(q2, -s, l.select(q3, -c, s)));
    let cosine = l.select(q1, -s, l.select(q2, -c, l.select(q3, s, c)));
    (sine, cosine)
}

/// The part of a disc of radius 1 that a chord at distance `t` in [0, 1] from its centre cuts off:
/// (acos t − t √(1 − t²)) / π; absolute error below 2e-6. (Fitted in powers of 1 − t, times (1 − t)^1.5.)
#[inline(always)]
pub fn disc_segment<L: Lanes>(l: L, t: L::F) -> L::F {
    let x = l.max(l.f(1.0) - t, l.f(0.0));
    let series = l.mul_add(x, l.f(-3.570_129_6e-3), l.f(-5.803_492e-3));
    let series = l.mul_add(x, l.mul_add(x, series, l.f(-9.095_896e-2)), l.f(6.003_343_2e-1));
    x * l.sqrt(x) * series
}
