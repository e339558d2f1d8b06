//! Kept photons: what is inside of a photon map's file, behind its checksums, with words of it changed.

use std::sync::atomic::AtomicU64;

use smalti_core::photon::maps::{Kept, Pilots};
use smalti_core::render::{Level, Renderer};
use smalti_core::settings::{Integrator, Settings};

use super::scene::{check, stamp};
use crate::draw::scene;

/// A render, and what is kept of its first round: what was sent ahead, and the photons.
struct Whole {
    renderer: Renderer,
    ahead: Vec<u8>,
    round: Vec<u8>,
}

impl Whole {
    /// Of a room with glass.
    fn new(integrator: Integrator) -> Self {
        let (photons, max_bounces) = (Some(256), Some(4));
        let settings =
            Settings { integrator, width: 5, height: 4, spp: 2, photons, max_bounces, ..Settings::default() };
        let renderer = Renderer::new(&scene("hexroom-caustic").world, settings, Level::available()[0]).expect("a plan");
        let maps = renderer.maps(0, Pilots::default(), &AtomicU64::new(0));
        let [ahead, round] = [postcard::to_stdvec(&maps.pilots()), postcard::to_stdvec(&maps.kept())]
            .map(|bytes| bytes.expect("what is kept can be written"));
        Self { renderer, ahead, round }
    }

    fn ask(&self, ahead: &[u8], round: &[u8]) {
        let (Ok(pilots), Ok(kept)) = (postcard::from_bytes::<Pilots>(ahead), postcard::from_bytes::<Kept>(round))
        else {
            return;
        };
        // A file has the rounds by their numbers.
        if kept.round != 0 {
            return;
        }
        if let Some(maps) = self.renderer.maps_from(kept, &pilots) {
            check(&stamp(&self.renderer, &maps), &maps);
        }
    }
}

thread_local! {
    static WHOLE: [Whole; 2] = [Whole::new(Integrator::Auto), Whole::new(Integrator::Photon)];
}

/// One byte for the integrator, one for what is changed, then eight for each change: where, and what stands there.
pub fn ask(bytes: &[u8]) {
    let [which, what, changes @ ..] = bytes else { return };
    WHOLE.with(|whole| {
        let whole = &whole[usize::from(which & 1)];
        let [mut ahead, mut round] = [whole.ahead.clone(), whole.round.clone()];
        let changed = if what & 1 == 0 { &mut round } else { &mut ahead };
        for change in changes.chunks_exact(8) {
            let [at, value] = [0, 4].map(|k| u32::from_le_bytes([0, 1, 2, 3].map(|j| change[k + j])));
            let at = at as usize % (changed.len() - 3);
            changed[at..at + 4].copy_from_slice(&value.to_le_bytes());
        }
        whole.ask(&ahead, &round);
    });
}
