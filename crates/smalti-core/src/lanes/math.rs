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

/// `x` cut to its leading 12 bits, so that products of two such are exact.
pub fn leading_bits(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & LEADING)
}

const LEADING: u32 = 0xffff_f000;

/// e^(−(a + b)·x) for a of [`leading_bits`], b small beside a, all finite and at least 0; 0 below 1e-38, relative error
/// else below 2e-7.
///
/// The product is kept in two parts, as its rounding would be an error of as many ulps as it is large; e^−r by the
/// minimax polynomial of the Cephes library's `expf` (S. Moshier), times a power of two.
#[inline(always)]
pub fn exp_minus<L: Lanes>(l: L, (a, b): (L::F, L::F), x: L::F) -> L::F {
    let coarse = l.reinterpret(l.bits(x) & l.u(LEADING));
    let (product, rest) = (a * coarse, l.mul_add(a, x - coarse, b * x));
    let within = l.lt(product + rest, l.f(87.0));
    let (product, rest) = (l.keep(within, product), l.keep(within, rest));
    // Adding 1.5 · 2²³ rounds to a whole number, which then stands in the lowest bits.
    let shift = l.f(12_582_912.0);
    let shifted = product * l.f(core::f32::consts::LOG2_E) + shift;
    let power = shifted - shift;
    // ln 2 in two parts, the first of 9 bits.
    let r = -(product - power * l.f(0.693_359_4) + power * l.f(2.121_944_4e-4) + rest);
    let series = l.mul_add(r, l.f(1.987_569_1e-4), l.f(1.398_2e-3));
    let series = l.mul_add(r, l.mul_add(r, series, l.f(8.333_452e-3)), l.f(4.166_579_6e-2));
    let series = l.mul_add(r, l.mul_add(r, series, l.f(1.666_666_5e-1)), l.f(0.5));
    let of_r = l.mul_add(r * r, series, r) + l.f(1.0);
    let exponent = l.add_u(l.u(127), l.mul_u(l.bits(shifted) & l.u(0xff), l.u(u32::MAX)));
    l.keep(within, of_r * l.reinterpret(l.shl::<23>(exponent)))
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
