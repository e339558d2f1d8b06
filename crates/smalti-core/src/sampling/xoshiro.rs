//! Independent numbers: Xoshiro128++ seeded by the same key, drawn path by path. It is the baseline of comparisons and
//! what the report did, so it may be slower.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use crate::lanes::Lanes;
use crate::sampling::sampler::mix;

/// Two 32-bit fractions for every lane.
#[inline(always)]
pub fn pair<L: Lanes>(l: L, index: L::U, seed: L::U) -> (L::U, L::U) {
    let (mut indices, mut seeds) = ([0; 16], [0; 16]);
    l.store_u(index, &mut indices);
    l.store_u(seed, &mut seeds);
    let (mut first, mut second) = ([0; 16], [0; 16]);
    for lane in 0..L::WIDTH {
        (first[lane], second[lane]) = draw(indices[lane], seeds[lane]);
    }
    (l.load_u(&first), l.load_u(&second))
}

fn draw(index: u32, seed: u32) -> (u32, u32) {
    let key = mix(index.reverse_bits() ^ 0x7f4a_7c15) ^ seed;
    let mut state = [0; 16];
    for (k, word) in state.chunks_exact_mut(4).enumerate() {
        word.copy_from_slice(&mix(key.wrapping_add(0x9e37_79b9u32.wrapping_mul(k as u32 + 1))).to_le_bytes());
    }
    let mut generator = Xoshiro128PlusPlus::from_seed(state);
    (generator.next_u32(), generator.next_u32())
}
