//! Russian roulette: ends paths that carry little, and makes up for it in those that go on (report §2.6, with the
//! weight per channel that the report leaves out).

use crate::lanes::{Lanes, Rgb};

/// Survivors and their throughput: the chance of survival is the largest channel, at most 1.
#[inline(always)]
pub fn run<L: Lanes>(l: L, throughput: Rgb<L>, u: L::F) -> (L::M, Rgb<L>) {
    let chance = throughput.max_component(l);
    let certain = l.le(l.f(1.0), chance);
    let scale = l.select(certain, l.f(1.0), l.f(1.0) / chance);
    (certain | l.lt(u, chance), throughput.scale(scale))
}
