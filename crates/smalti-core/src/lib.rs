//! Light transport: a [`World`](scene::World) becomes radiance. No files, no clock, no terminal.

pub mod accel;
pub mod bsdf;
pub mod film;
pub mod geometry;
pub mod glint;
pub mod hunt;
pub mod lanes;
pub mod light;
mod mutant;
pub mod photon;
pub mod plan;
pub mod render;
mod replay;
pub mod sampling;
pub mod scene;
pub mod settings;
pub mod stream;

/// The version of the estimator: raised by whatever changes a sample of any render. Photon maps, studies, images and
/// summaries carry it, as samples of two estimators must not be put together.
///
/// 1: until November 2026. 2: photons with radii of their own, frames about a scene's details, sampler purposes with room.
/// 3: smaller radii, from more photons. 4: lamps chosen by what they can bring to the place, and samples
/// sent to glints.
pub const ESTIMATOR: u32 = 4;
