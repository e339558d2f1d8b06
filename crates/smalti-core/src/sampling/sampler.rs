//! The sampler: keys for pixels and rounds, and the numbers of a purpose.

use super::{sobol, xoshiro};
use crate::lanes::Lanes;
use crate::settings::SamplerKind;

/// What a pair of numbers is for. The value keys the set; a new purpose takes a new value and shifts no other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    /// The place in the pixel.
    Film = 0,
    /// Which light.
    LightChoice = 1,
    /// Which point of it.
    LightPoint = 2,
    /// Direction of a diffuse bounce.
    Bsdf = 3,
    /// Reflect or refract (first number).
    Lobe = 4,
    /// Roulette (first number).
    Roulette = 5,
}

/// A path's identity as the sampler knows it.
#[derive(Clone, Copy)]
pub struct Keys<L: Lanes> {
    /// Hash of (seed, pixel, round).
    pub key: L::U,
    /// Sample number inside the round, its bits reversed.
    pub index: L::U,
}

/// Hash of (seed, pixel, round): the key of all samples of a pixel in one round.
pub fn pixel_key(seed: u64, x: u32, y: u32, round: u32) -> u32 {
    let mut h = mix(seed as u32 ^ 0x9e37_79b9);
    for part in [(seed >> 32) as u32, x, y, round] {
        h = mix(h.wrapping_mul(0x2c1b_3c6d) ^ mix(part.wrapping_add(0x68e3_1da4)));
    }
    h
}

/// Two numbers in [0, 1) for `purpose` at `bounce`. `number` of 2^`log2_numbers` sets is drawn where a vertex needs
/// several (shadow rays); together with the samples of the round they stay one well spread set.
#[inline(always)]
pub fn pair<L: Lanes>(
    l: L,
    kind: SamplerKind,
    keys: Keys<L>,
    bounce: u32,
    purpose: Purpose,
    (number, log2_numbers): (u32, u32),
) -> (L::F, L::F) {
    let salt = mix(bounce.wrapping_mul(8).wrapping_add(purpose as u32).wrapping_add(0x51ed_270b));
    let seed = mix_lanes(l, keys.key ^ l.u(salt));
    let index = l.shr_by(keys.index, log2_numbers) | l.u(number.reverse_bits());
    let (a, b) = match kind {
        SamplerKind::Sobol => sobol::scrambled_pair(l, index, seed),
        SamplerKind::Independent => xoshiro::pair(l, index, seed),
    };
    (unit(l, a), unit(l, b))
}

/// The top 24 bits as a number in [0, 1): never 1.
#[inline(always)]
fn unit<L: Lanes>(l: L, bits: L::U) -> L::F {
    l.to_f(l.shr::<8>(bits)) * l.f(1.0 / 16_777_216.0)
}

/// A bijective hash of 32 bits with low bias (constants of C. Wellons, `lowbias32`).
pub(crate) fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// [`mix`] on lanes.
#[inline(always)]
pub(crate) fn mix_lanes<L: Lanes>(l: L, x: L::U) -> L::U {
    let x = l.mul_u(x ^ l.shr::<16>(x), l.u(0x7feb_352d));
    let x = l.mul_u(x ^ l.shr::<15>(x), l.u(0x846c_a68b));
    x ^ l.shr::<16>(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::One;

    fn draw(kind: SamplerKind, key: u32, sample: u32) -> (f32, f32) {
        pair(One, kind, Keys { key, index: sample.reverse_bits() }, 0, Purpose::Film, (0, 0))
    }

    #[test]
    fn sixteen_sobol_samples_fill_every_elementary_interval() {
        for key in 0..200 {
            let points: Vec<_> = (0..16).map(|s| draw(SamplerKind::Sobol, pixel_key(7, key, 1, 0), s)).collect();
            for log2_columns in 0..=4u32 {
                let (columns, rows) = (1 << log2_columns, 1 << (4 - log2_columns));
                let mut cells: Vec<_> =
                    points.iter().map(|(u, v)| ((u * columns as f32) as u32, (v * rows as f32) as u32)).collect();
                cells.sort_unstable();
                cells.dedup();
                assert_eq!(cells.len(), 16, "key {key}: {columns} × {rows}");
            }
        }
    }

    #[test]
    fn numbers_are_uniform_and_uncorrelated_in_both_samplers() {
        for kind in [SamplerKind::Sobol, SamplerKind::Independent] {
            let n = 200_000u32;
            let (mut u, mut v, mut uv, mut uu) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
            for k in 0..n {
                let (a, b) = draw(kind, pixel_key(3, k / 16, 0, 0), k % 16);
                assert!((0.0..1.0).contains(&a) && (0.0..1.0).contains(&b));
                let (a, b) = (f64::from(a) - 0.5, f64::from(b) - 0.5);
                u += a;
                v += b;
                uv += a * b;
                uu += a * a;
            }
            let n = f64::from(n);
            // Standard errors: 0.29/√n = 6.5e-4, (1/12)/√n = 1.9e-4.
            assert!((u / n).abs() < 3e-3 && (v / n).abs() < 3e-3, "{kind:?}: means {} {}", u / n, v / n);
            assert!((uv / n).abs() < 1e-3, "{kind:?}: correlation {}", uv / n);
            assert!((uu / n - 1.0 / 12.0).abs() < 1e-3, "{kind:?}: variance {}", uu / n);
        }
    }

    #[test]
    fn shadow_rays_and_samples_together_are_one_net() {
        let keys = |s: u32| Keys::<One> { key: 99, index: s.reverse_bits() };
        let mut cells: Vec<_> = (0..16)
            .flat_map(|s| (0..4).map(move |i| pair(One, SamplerKind::Sobol, keys(s), 2, Purpose::LightPoint, (i, 2))))
            .map(|(u, v)| ((u * 8.0) as u32, (v * 8.0) as u32))
            .collect();
        cells.sort_unstable();
        cells.dedup();
        assert_eq!(cells.len(), 64);
    }

    #[test]
    fn every_part_of_the_key_counts() {
        let one = pixel_key(1, 2, 3, 4);
        for other in
            [pixel_key(2, 2, 3, 4), pixel_key(1 + (1 << 32), 2, 3, 4), pixel_key(1, 3, 2, 4), pixel_key(1, 2, 3, 5)]
        {
            assert_ne!(one, other);
        }
        let numbers: Vec<_> = [(0, Purpose::Bsdf), (1, Purpose::Bsdf), (0, Purpose::Roulette)]
            .map(|(bounce, purpose)| pair(One, SamplerKind::Sobol, Keys { key: 1, index: 0 }, bounce, purpose, (0, 0)))
            .into();
        assert!(numbers[0] != numbers[1] && numbers[0] != numbers[2] && numbers[1] != numbers[2]);
    }
}
