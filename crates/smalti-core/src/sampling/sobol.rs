//! Owen-scrambled Sobol points, the first two dimensions: a (0, 2)-sequence in base 2, so that every 2^k consecutive
//! points fill every elementary interval. Scrambling by hashing after Laine and Karras, index shuffled by the same hash
//! (Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020), with the hash constants of N. Vegdahl (2021).

use crate::lanes::Lanes;
use crate::sampling::sampler::mix_lanes;

/// The point of one sample as 32-bit fractions. `index` is the sample number with its bits reversed.
///
/// With `room` > 0 it is the first of 2^`room` points, the others given by [`shifted`]: the sample has as many
/// consecutive points of the sequence, of which only the first `room` digits differ. Those are scrambled by a random
/// digital shift, the digits below by nested scrambling, which depends on them alone; so the points of one sample are a
/// net, and those of 2^k samples together are one too.
#[inline(always)]
pub fn scrambled_pair<L: Lanes>(l: L, index: L::U, seed: L::U, room: u32) -> (L::U, L::U) {
    let shuffled = reverse(l, owen(l, index, seed));
    let second_seed = mix_lanes(l, seed ^ l.u(0x2545_f491));
    let third_seed = l.mul_u(second_seed, l.u(0x9e37_79b1)) ^ l.shr::<16>(second_seed);
    // In both dimensions the hash wants reversed bits: van der Corput's point reversed is the index itself.
    if room == 0 {
        let first = owen(l, shuffled, second_seed);
        let second = owen(l, second_dimension_reversed(l, shuffled), third_seed);
        return (reverse(l, first), reverse(l, second));
    }
    let (up, low) = (l.u(1 << room), l.u((1 << room) - 1));
    let shift = mix_lanes(l, third_seed ^ l.u(0x68bc_21eb));
    // Which of its points a sample takes first is random, lest purposes that share a number share a stratum.
    let place = l.mul_u(shuffled, up) | (mix_lanes(l, shuffled ^ shift) & low);
    let second = second_dimension_reversed(l, place);
    let first = l.mul_u(owen(l, shuffled, second_seed), up) | ((place ^ shift) & low);
    let scrambled = l.mul_u(owen(l, l.shr_by(second, room), third_seed), up);
    let second = scrambled | ((second ^ l.shr::<16>(shift)) & low);
    (reverse(l, first), reverse(l, second))
}

/// Point `number` of a sample from its first.
#[inline(always)]
pub fn shifted<L: Lanes>(l: L, (first, second): (L::U, L::U), number: u32) -> (L::U, L::U) {
    let across = second_dimension_reversed(crate::lanes::One, number).reverse_bits();
    (first ^ l.u(number.reverse_bits()), second ^ l.u(across))
}

/// Sobol's second dimension, bits reversed: the index times Pascal's triangle modulo 2.
#[inline(always)]
fn second_dimension_reversed<L: Lanes>(l: L, n: L::U) -> L::U {
    // Pascal's triangle mod 2 is the tensor power of [[1, 1], [0, 1]]: one step for each bit of the bit's number.
    let n = n ^ (l.shr::<1>(n) & l.u(0x5555_5555));
    let n = n ^ (l.shr::<2>(n) & l.u(0x3333_3333));
    let n = n ^ (l.shr::<4>(n) & l.u(0x0f0f_0f0f));
    let n = n ^ (l.shr::<8>(n) & l.u(0x00ff_00ff));
    n ^ l.shr::<16>(n)
}

/// Nested uniform scrambling of reversed bits: each bit is flipped by a hash of the bits below it.
#[inline(always)]
fn owen<L: Lanes>(l: L, x: L::U, seed: L::U) -> L::U {
    let x = x ^ l.mul_u(x, l.u(0x3d20_adea));
    let x = l.add_u(x, seed);
    let x = l.mul_u(x, l.shr::<16>(seed) | l.u(1));
    let x = x ^ l.mul_u(x, l.u(0x0552_6c56));
    x ^ l.mul_u(x, l.u(0x53a2_2864))
}

/// Bits in reverse order.
#[inline(always)]
pub fn reverse<L: Lanes>(l: L, x: L::U) -> L::U {
    let x = l.shl::<16>(x) | l.shr::<16>(x);
    let x = l.shl::<8>(x & l.u(0x00ff_00ff)) | (l.shr::<8>(x) & l.u(0x00ff_00ff));
    let x = l.shl::<4>(x & l.u(0x0f0f_0f0f)) | (l.shr::<4>(x) & l.u(0x0f0f_0f0f));
    let x = l.shl::<2>(x & l.u(0x3333_3333)) | (l.shr::<2>(x) & l.u(0x3333_3333));
    l.shl::<1>(x & l.u(0x5555_5555)) | (l.shr::<1>(x) & l.u(0x5555_5555))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::One;

    #[test]
    fn reversal_is_that_of_the_standard_library() {
        for x in [0, 1, 0x8000_0000, 0x1234_5678, u32::MAX, 0xdead_beef] {
            assert_eq!(reverse(One, x), x.reverse_bits());
        }
    }

    #[test]
    fn second_dimension_is_sobols() {
        // The first points of Sobol's second dimension: 0, 1/2, 3/4, 1/4, 5/8, 1/8, 3/8, 7/8.
        let points: Vec<u32> = (0..8).map(|n| second_dimension_reversed(One, n).reverse_bits() >> 29).collect();
        assert_eq!(points, [0, 4, 6, 2, 5, 1, 3, 7]);
    }
}
