//! Radiance from infinity for paths that hit nothing.

use super::{SLOT, Slots, Stream, THROUGHPUT};
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;

/// Adds the environment's radiance.
#[inline(always)]
pub fn run<L: Lanes>(l: L, radiance: [f32; 3], escaped: &Stream, slots: &mut Slots) {
    let radiance = V3::splat(l, radiance);
    for at in (0..escaped.len()).step_by(L::WIDTH) {
        let arrives = escaped.v3(l, THROUGHPUT, at) * radiance.scale(escaped.eta(l, at));
        let mut counts = escaped.active(l, at);
        if mutant!("environment_hit_pruned") {
            counts = counts & escaped.comes_from_camera(l, at);
        }
        slots.add(l, counts, escaped.u(l, SLOT, at), arrives);
    }
}
