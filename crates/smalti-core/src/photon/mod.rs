//! Photons: light followed from its source, and kept where it lands (Jensen 1996; report §1.3 and 2.8).
//!
//! A photon is a share of a light's power. It is emitted by [`emit`], aimed by [`aim`] at what it has to meet, traced by
//! the stages that camera paths go through, and stored by [`store`] on diffuse surfaces. Stored photons become a
//! [`Map`]: [`SUB_MAPS`] independent trees ([`kd_tree`]), each an estimate of all the light. Sample n of a round asks
//! sub-map n: what its pixel averages over is the whole map, and the spread of rounds tells the noise of both.
//!
//! Photons carry flux, not radiance: no n² where they are refracted (report eq. 9), and flux is divided by what was
//! emitted, never by what was stored (report eq. 14).

pub mod account;
pub mod aim;
pub mod emit;
pub mod forest;
pub mod gather;
pub mod kd_tree;
pub mod kernel;
pub mod map;
pub mod maps;
pub mod pass;
pub mod pilot;
pub mod shadow;
pub mod show;
pub mod store;
pub mod surfaces;
pub mod visibility;

pub use account::Account;
pub use aim::Aim;
pub use map::Map;
pub use maps::Maps;
pub use pass::{Batch, Traced};
pub use pilot::Pilot;
pub use show::{Quantity, Show};
pub use surfaces::Surfaces;
pub use visibility::Visibility;

use serde::{Deserialize, Serialize};

use crate::film::ROUND;

/// Independent parts of a map, one for each sample of a round.
pub const SUB_MAPS: u32 = ROUND;

/// What a photon map holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[repr(u32)]
pub enum Kind {
    /// Light that came to a diffuse surface by way of specular ones alone: L S+ D; and, where the pass goes on, all that
    /// diffuse and specular surfaces make of it: L S+ D (S|D)*, at every diffuse vertex.
    Caustic = 0,
    /// All light at every diffuse surface: L (S|D)* D.
    Global = 1,
    /// Where lights are seen and where they are hidden.
    Shadow = 2,
}

/// Photons as they were stored.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Photons {
    /// Where they landed, in the scene's frame, and their [`Tag`] (bits).
    pub places: Vec<[f32; 4]>,
    /// Flux that they brought, three channels, in the frame's units (W · frame²/m²), and the number of scattering
    /// events before (bits). With kernels, what each adds within its disc instead: irradiance.
    pub flux: Vec<[f32; 4]>,
    /// The radii of their [`kernel`]s; none of photons that serve only to see where photons lie.
    pub radii: Vec<f32>,
}

impl Photons {
    /// Bytes that a photon takes.
    pub const BYTES: u64 = (2 * size_of::<[f32; 4]>() + size_of::<f32>()) as u64;

    /// Number of photons.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }
}

/// On which primitive and which side of it a photon landed. It has [`Tag::BITS`] bits, so they are those of a
/// finite f32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tag(pub u32);

impl Tag {
    /// Bits of the primitive's number; the side is above them.
    pub const PRIM: u32 = (1 << 29) - 1;
    /// Set where the photon came from the side of the normal.
    pub const OUTSIDE: u32 = 1 << 29;
    /// Bits of a tag.
    pub const BITS: u32 = 30;

    /// Of a photon that landed on `prim`.
    pub fn new(prim: u32, outside: bool) -> Self {
        Self((prim & Self::PRIM) | if outside { Self::OUTSIDE } else { 0 })
    }

    /// The primitive.
    pub fn prim(self) -> u32 {
        self.0 & Self::PRIM
    }

    /// Whether the photon came from the side of the normal.
    pub fn outside(self) -> bool {
        self.0 & Self::OUTSIDE != 0
    }
}
