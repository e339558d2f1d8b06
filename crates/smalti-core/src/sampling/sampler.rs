//! The sampler: keys for pixels and rounds, and the numbers of a purpose.

use super::{sobol, xoshiro};
use crate::lanes::Lanes;
use crate::mutant::mutant;
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
    /// Direction in which a photon is emitted.
    Emission = 6,
    /// Whether a photon map is asked (first number).
    Gather = 7,
    /// Whether a shadow ray is traced where photons decide (first number).
    Verify = 8,
}

impl Purpose {
    /// Bits of a purpose: room for 256 of them beside each other, at every bounce.
    const BITS: u32 = 8;

    /// The number that keys this purpose at `bounce`: no other pair of bounce (below 2²⁴) and purpose has it.
    const fn salt(self, bounce: u32) -> u32 {
        bounce << Self::BITS | self as u32
    }
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
    key(mix(seed as u32 ^ 0x9e37_79b9), [(seed >> 32) as u32, x, y, round])
}

/// Hash of (seed, map, round, sub-map, set): the key of a set of up to 65,536 photons.
pub fn photon_key(seed: u64, map: u32, round: u32, sub_map: u32, set: u32) -> u32 {
    let seed = if mutant!("seed_ignored_by_photons") { 0 } else { seed };
    key(mix(seed as u32 ^ 0x85eb_ca6b), [(seed >> 32) as u32, map, round, sub_map, set])
}

fn key<const N: usize>(start: u32, parts: [u32; N]) -> u32 {
    let absorb = |h: u32, part: u32| mix(h.wrapping_mul(0x2c1b_3c6d) ^ mix(part.wrapping_add(0x68e3_1da4)));
    parts.into_iter().fold(start, absorb)
}

/// Two numbers in [0, 1) for `purpose` at `bounce`.
#[inline(always)]
pub fn pair<L: Lanes>(l: L, kind: SamplerKind, keys: Keys<L>, bounce: u32, purpose: Purpose) -> (L::F, L::F) {
    Fan::new(l, kind, keys, bounce, purpose, 1).pair(l, 0)
}

/// Number `number` of `count` for `purpose`, scrambled by itself: what goes with a [`Fan`] of another purpose must not be
/// a fan too, whose numbers differ by the same constants.
#[inline(always)]
pub fn one_of<L: Lanes>(
    l: L,
    kind: SamplerKind,
    keys: Keys<L>,
    bounce: u32,
    purpose: Purpose,
    (number, count): (u32, u32),
) -> L::F {
    let index = l.shr_by(keys.index, room(count)) | l.u(number.reverse_bits());
    pair(l, kind, Keys { key: keys.key, index }, bounce, purpose).0
}

/// Binary digits of a number below `count`.
fn room(count: u32) -> u32 {
    count.next_power_of_two().ilog2()
}

/// The numbers of a vertex that asks for several pairs (shadow rays). Together with those of the other samples of the
/// round they are one well spread set.
#[derive(Clone, Copy)]
pub struct Fan<L: Lanes> {
    kind: SamplerKind,
    /// Sobol: the first pair, 32-bit fractions. Independent: index (room left for the numbers) and seed.
    base: (L::U, L::U),
}

impl<L: Lanes> Fan<L> {
    /// For `count` pairs, at least 1.
    #[inline(always)]
    pub fn new(l: L, kind: SamplerKind, keys: Keys<L>, bounce: u32, purpose: Purpose, count: u32) -> Self {
        let salt = mix(purpose.salt(bounce).wrapping_add(0x51ed_270b));
        // The same numbers in every pixel, whatever the seed.
        let unkeyed = mutant!("seed_ignored_by_bounces") && purpose == Purpose::Bsdf;
        let seed = if unkeyed { l.u(salt) } else { mix_lanes(l, keys.key ^ l.u(salt)) };
        let room = room(count);
        let base = match kind {
            SamplerKind::Sobol => sobol::scrambled_pair(l, keys.index, seed, room),
            SamplerKind::Independent => (l.shr_by(keys.index, room), seed),
        };
        Self { kind, base }
    }

    /// Pair `number`, below the count.
    #[inline(always)]
    pub fn pair(&self, l: L, number: u32) -> (L::F, L::F) {
        let (a, b) = match self.kind {
            SamplerKind::Sobol => sobol::shifted(l, self.base, number),
            SamplerKind::Independent => xoshiro::pair(l, self.base.0 | l.u(number.reverse_bits()), self.base.1),
        };
        (unit(l, a), unit(l, b))
    }
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
        pair(One, kind, Keys { key, index: sample.reverse_bits() }, 0, Purpose::Film)
    }

    #[test]
    fn sixteen_sobol_samples_fill_every_elementary_interval() {
        for key in 0..200 {
            let points: Vec<_> = (0..16).map(|s| draw(SamplerKind::Sobol, pixel_key(7, key, 1, 0), s)).collect();
            assert!(fills_every_elementary_interval(&points), "key {key}");
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

    /// The pairs of 16 samples with `count` numbers each.
    fn fans(key: u32, count: u32) -> Vec<(f32, f32)> {
        (0..16u32)
            .flat_map(|s| {
                let keys = Keys { key, index: s.reverse_bits() };
                let fan = Fan::new(One, SamplerKind::Sobol, keys, 2, Purpose::LightPoint, count);
                (0..count).map(move |number| fan.pair(One, number))
            })
            .collect()
    }

    fn fills_every_elementary_interval(points: &[(f32, f32)]) -> bool {
        let log2 = points.len().ilog2();
        (0..=log2).all(|log2_columns| {
            let (columns, rows) = ((1 << log2_columns) as f32, (1 << (log2 - log2_columns)) as f32);
            let mut cells: Vec<_> = points.iter().map(|(u, v)| ((u * columns) as u32, (v * rows) as u32)).collect();
            cells.sort_unstable();
            cells.dedup();
            cells.len() == points.len()
        })
    }

    #[test]
    fn shadow_rays_are_one_net_and_so_are_those_of_all_samples() {
        for (key, count) in (0..60).flat_map(|key| [(key, 1), (key, 4), (key, 32)]) {
            let points = fans(key, count);
            assert!(fills_every_elementary_interval(&points), "key {key}, {count} a vertex: the round");
            let vertices = points.chunks(count as usize);
            assert!(vertices.into_iter().all(fills_every_elementary_interval), "key {key}, {count} a vertex");
        }
    }

    /// χ² of counts that should all be the same.
    fn chi_squared<'a>(counts: impl Iterator<Item = &'a u32> + Clone) -> f64 {
        let expected = f64::from(counts.clone().sum::<u32>()) / counts.clone().count() as f64;
        counts.map(|n| (f64::from(*n) - expected) * (f64::from(*n) - expected) / expected).sum()
    }

    /// How often choice (rows) and place (columns) of the light samples of a vertex fall in each pair of halves.
    fn halves(key: u32, sample: u32, count: u32) -> [[u32; 2]; 2] {
        let keys = Keys { key, index: sample.reverse_bits() };
        let fan = Fan::new(One, SamplerKind::Sobol, keys, 1, Purpose::LightPoint, count);
        let mut cells = [[0; 2]; 2];
        for number in 0..count {
            let choice = one_of(One, SamplerKind::Sobol, keys, 1, Purpose::LightChoice, (number, count));
            cells[usize::from(choice >= 0.5)][usize::from(fan.pair(One, number).0 >= 0.5)] += 1;
        }
        cells
    }

    #[test]
    fn the_choice_of_a_light_says_nothing_of_the_place_on_it() {
        let mut sum = [[0u32; 2]; 2];
        for vertex in 0..2000 {
            let cells = halves(pixel_key(5, vertex / 16, 0, 0), vertex % 16, 16);
            // Each choice has 8 of 16; that all 8 fall in one half is a chance of 2 in 2⁸ at worst.
            assert!(cells.iter().all(|row| row.iter().sum::<u32>() == 8));
            for (sum, cell) in sum.iter_mut().flatten().zip(cells.iter().flatten()) {
                *sum += u32::from(*cell >= 2);
            }
        }
        assert!(sum.iter().flatten().all(|spread| *spread > 1800), "{sum:?}");
    }

    #[test]
    fn each_number_of_a_fan_is_uniform() {
        for number in [0, 13, 19] {
            let mut counts = [[0u32; 8]; 8];
            let keys = 20_000;
            for key in 0..keys {
                let keys = Keys { key: pixel_key(5, key, 0, 0), index: (key % 16).reverse_bits() };
                let fan = Fan::new(One, SamplerKind::Sobol, keys, 1, Purpose::LightPoint, 20);
                let (u, v) = fan.pair(One, number);
                counts[(u * 8.0) as usize][(v * 8.0) as usize] += 1;
            }
            let chi2 = chi_squared(counts.iter().flatten());
            // 63 degrees of freedom: above 110 by chance once in 5000.
            assert!(chi2 < 110.0, "number {number}: χ² {chi2}");
        }
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
            .map(|(bounce, purpose)| pair(One, SamplerKind::Sobol, Keys { key: 1, index: 0 }, bounce, purpose))
            .into();
        assert!(numbers[0] != numbers[1] && numbers[0] != numbers[2] && numbers[1] != numbers[2]);
    }

    /// The last purpose of a bounce has numbers of its own, not those of the next bounce's first purpose.
    #[test]
    fn no_bounce_and_purpose_share_their_numbers() {
        let salts: Vec<u32> = (0..8).flat_map(|bounce| PURPOSES.map(|purpose| purpose.salt(bounce))).collect();
        let unique: std::collections::HashSet<u32> = salts.iter().copied().collect();
        assert_eq!(unique.len(), salts.len());
    }

    const PURPOSES: [Purpose; 9] = [
        Purpose::Film,
        Purpose::LightChoice,
        Purpose::LightPoint,
        Purpose::Bsdf,
        Purpose::Lobe,
        Purpose::Roulette,
        Purpose::Emission,
        Purpose::Gather,
        Purpose::Verify,
    ];
}
