//! Fresnel reflectance of a smooth dielectric, in the g-form, which keeps its digits at every index; and Schlick's
//! approximation (report eq. 7 and 8, with R₀ squared and the cosine taken on the thinner side).

use crate::lanes::Lanes;
use crate::mutant::mutant;
use crate::settings::Fresnel;

/// A ray at a boundary.
pub struct Boundary<L: Lanes> {
    /// Cosine on the side the ray comes from, in [0, 1].
    pub cosine: L::F,
    /// Cosine on the other side; 0 with total reflection.
    pub cosine_refracted: L::F,
    /// n_i / n_t.
    pub eta: L::F,
    /// (n_t / n_i) · cosine refracted, squared; not positive with total reflection.
    g_squared: L::F,
    /// Whether the other side is the denser one.
    denser: L::M,
}

/// The boundary of a medium with constants `[n, 1/n, (n−1)(n+1)]`, met from outside or from inside.
#[inline(always)]
pub fn boundary<L: Lanes>(l: L, [n, inverse, excess]: [L::F; 3], outside: L::M, cosine: L::F) -> Boundary<L> {
    let one = l.f(1.0);
    let c = l.max(l.min(cosine, one), l.f(0.0));
    // g² = (m − 1)(m + 1) + c² with m = n_t / n_i; inside, m = 1/n and (m − 1)(m + 1) = −(n − 1)(n + 1) / n².
    // Report eq. 4 to 6: R = n₁/n₂ "from air to glass" at every hit, also when leaving.
    let eta = if mutant!("eq6_ratio_not_inverted") { inverse } else { l.select(outside, inverse, n) };
    let step = l.select(outside, excess, -(excess * inverse * inverse));
    let g_squared = l.mul_add(c, c, step);
    let g = l.sqrt(l.max(g_squared, l.f(0.0)));
    Boundary { cosine: c, cosine_refracted: g * eta, eta, g_squared, denser: l.lt(eta, one) }
}

/// Fraction of the light that is reflected, in [0, 1].
#[inline(always)]
pub fn reflectance<L: Lanes>(l: L, kind: Fresnel, at: &Boundary<L>) -> L::F {
    let one = l.f(1.0);
    let passes = l.lt(l.f(0.0), at.g_squared);
    // Report eq. 10 left out: what cannot be refracted is refracted all the same.
    let total = if mutant!("eq10_no_total_reflection") { l.f(0.0) } else { one };
    let partial = match kind {
        Fresnel::Exact => exact(l, at.cosine, l.sqrt(l.max(at.g_squared, l.f(0.0)))),
        // Report eq. 8: the same cosine both ways.
        Fresnel::Schlick if mutant!("eq8_inner_cosine") => schlick(l, at.eta, at.cosine),
        Fresnel::Schlick => schlick(l, at.eta, l.select(at.denser, at.cosine, at.cosine_refracted)),
    };
    l.select(passes, l.min(partial, one), total)
}

/// ½ A² (1 + B²) with A = (g − c)/(g + c), B = (c(g + c) − 1)/(c(g − c) + 1); unpolarised.
#[inline(always)]
fn exact<L: Lanes>(l: L, c: L::F, g: L::F) -> L::F {
    let one = l.f(1.0);
    let (sum, difference) = (g + c, g - c);
    let a = difference / sum;
    let b = l.mul_add(c, sum, -one) / l.mul_add(c, difference, one);
    l.f(0.5) * a * a * l.mul_add(b, b, one)
}

/// R₀ + (1 − R₀)(1 − cos)⁵, R₀ = ((n₁ − n₂)/(n₁ + n₂))², cos on the less dense side.
#[inline(always)]
fn schlick<L: Lanes>(l: L, eta: L::F, cosine: L::F) -> L::F {
    let one = l.f(1.0);
    let root = (one - eta) / (one + eta);
    // Report eq. 7: not squared.
    let r0 = if mutant!("eq7_not_squared") { root } else { root * root };
    let m = one - cosine;
    let squared = m * m;
    l.mul_add(one - r0, squared * squared * m, r0)
}
