//! A photon map made visible (report §2.8 and Figure 6): what its photons alone say of every surface that is seen.
//!
//! Camera paths go through mirrors and glass as always; where they come to a diffuse surface they ask the map and end.

use super::{Kind, SUB_MAPS};

/// What is made visible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Show {
    /// The map.
    pub map: Kind,
    /// What of its photons.
    pub quantity: Quantity,
}

/// What a pixel tells of the photons about the points that are seen in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The radiance that the surface sends back of their flux, albedo × irradiance / π, W m⁻² sr⁻¹; lamps and sky that
    /// are seen have their own.
    Radiance,
    /// How many there are, and how often they had scattered: scattering events, photons and 0, by area (m⁻²).
    Count,
}

/// Trees that a map is built of where each pixel has `spp` samples: each sample asks one, and all together ask all.
///
/// Sample n asks that one whose number is n with its bits reversed, in as many bits as it takes.
pub fn trees(spp: u32) -> u32 {
    1 << spp.clamp(1, SUB_MAPS).ilog2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_samples_of_a_pixel_ask_every_tree() {
        for spp in 1..=SUB_MAPS {
            let (trees, mut times) = (trees(spp), [0; SUB_MAPS as usize]);
            for sample in 0..spp {
                times[((sample.reverse_bits() >> 28) * trees / SUB_MAPS) as usize] += 1;
            }
            assert!(SUB_MAPS.is_multiple_of(trees) && 2 * trees > spp);
            assert!(times[..trees as usize].iter().all(|times| [1, 2].contains(times)), "{spp}: {times:?}");
        }
    }
}
