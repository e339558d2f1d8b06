//! Russian roulette: ends paths that carry little, and makes up for it in those that go on (report §2.6, with the
//! weight per channel that the report leaves out).

use crate::lanes::{Lanes, Rgb, V3};
use crate::mutant::mutant;

/// Paths that carry at least 1 / `SPARED` of what they started with are not put to the roulette.
///
/// Measured on the reference room as error × time, against 1 (the report's: survive by the albedo): 2 is 6 % better with
/// its caustics and 35 % without; 3 costs 3 % with them and gains 10 % without.
const SPARED: f32 = 2.0;

/// Survivors and their throughput: the chance of survival is `SPARED` times the largest channel, at most 1.
#[inline(always)]
pub fn run<L: Lanes>(l: L, throughput: Rgb<L>, u: L::F) -> (L::M, Rgb<L>) {
    let chance = throughput.max_component(l) * l.f(SPARED);
    let certain = l.le(l.f(1.0), chance);
    let scale = l.select(certain, l.f(1.0), l.f(1.0) / chance);
    let mut survives = certain | l.lt(u, chance);
    // The chance by one measure of a colour, the weight by another.
    if mutant!("roulette_by_luminance") {
        let luminance = throughput.dot(l, V3::splat(l, [0.2126, 0.7152, 0.0722]));
        survives = l.lt(u, luminance * l.f(SPARED));
    }
    if mutant!("roulette_without_division") {
        return (survives, throughput);
    }
    // As the report prints it: whoever survives goes on with full weight in every channel.
    if mutant!("roulette_without_channels") {
        return (survives, V3::splat(l, [1.0; 3]));
    }
    (survives, throughput.scale(scale))
}
