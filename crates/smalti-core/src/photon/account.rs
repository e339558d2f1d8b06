//! Where the emitted light went: what was emitted is what was stored, absorbed and lost to infinity, to rounding.

use serde::{Deserialize, Serialize};

/// The balance of a photon pass. Fluxes per channel, in the frame's units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    /// Flux that was emitted.
    pub emitted: [f64; 3],
    /// Flux that ended where it was stored; of photons that go on what surfaces take is absorbed.
    pub stored: [f64; 3],
    /// Flux that surfaces took: by reflecting less than arrived, by roulette, or because its way ended there.
    pub absorbed: [f64; 3],
    /// Flux that hit nothing.
    pub escaped: [f64; 3],
    /// Photons that set out.
    pub photons: u64,
    /// Photons that are in the map.
    pub kept: u64,
    /// Photons that were not finite; they are left out.
    pub nonfinite: u64,
    /// Rays that were traced.
    pub rays: u64,
}

impl core::ops::AddAssign<&Account> for Account {
    fn add_assign(&mut self, other: &Self) {
        let pairs = [
            (&mut self.emitted, &other.emitted),
            (&mut self.stored, &other.stored),
            (&mut self.absorbed, &other.absorbed),
            (&mut self.escaped, &other.escaped),
        ];
        for (sum, more) in pairs {
            (0..3).for_each(|c| sum[c] += more[c]);
        }
        self.photons += other.photons;
        self.kept += other.kept;
        self.nonfinite += other.nonfinite;
        self.rays += other.rays;
    }
}
