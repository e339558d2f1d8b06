//! Photons on diffuse surfaces are stored: where they landed, on which side, and the flux that they brought.

use super::{Photons, Tag};
use crate::lanes::Lanes;
use crate::mutant::mutant;
use crate::scene::Scene;
use crate::stream::{PRIM, Stream, THROUGHPUT, surface};

/// Stores the photons of a diffuse stream, with what `events` says of their slots (the scattering events after they were
/// emitted). Returns how many were not finite and are left out.
#[inline(always)]
pub fn run<L: Lanes>(
    l: L,
    scene: &Scene,
    events: &impl Fn(usize) -> u32,
    hits: &Stream,
    power: &[f32],
    photons: &mut Photons,
) -> u64 {
    let mut nonfinite = 0;
    photons.places.reserve(hits.len());
    photons.flux.reserve(hits.len());
    for at in (0..hits.len()).step_by(L::WIDTH) {
        let hit = surface::hit(l, scene, hits, at);
        let [mut xs, mut ys, mut zs] = [[0.0; 16]; 3];
        l.store(hit.point.x, &mut xs);
        l.store(hit.point.y, &mut ys);
        l.store(hit.point.z, &mut zs);
        let outside = l.bitmask(hit.outside);
        let places = xs.into_iter().zip(ys).zip(zs);
        for (lane, ((x, y), z)) in places.take(L::WIDTH.min(hits.len() - at)).enumerate() {
            let flux = flux(hits, at + lane, power);
            if !flux.iter().chain(&[x, y, z]).all(|value| value.is_finite()) {
                nonfinite += 1;
                continue;
            }
            let tag = Tag::new(hits.value(PRIM, at + lane), outside >> lane & 1 == 1);
            photons.places.push([x, y, z, f32::from_bits(tag.0)]);
            photons.flux.push([flux[0], flux[1], flux[2], f32::from_bits(events(hits.slot(at + lane)))]);
        }
    }
    nonfinite
}

/// Flux that photon `at` of a stream carries.
pub fn flux(photons: &Stream, at: usize, power: &[f32]) -> [f32; 3] {
    let mut power = power[photons.slot(at)];
    // Photons carry flux; the square of the index is for radiance.
    if mutant!("n_squared_for_photons") {
        power *= f32::from_bits(photons.value(crate::stream::ETA, at));
    }
    photons.triple(THROUGHPUT, at).map(|share| share * power)
}
