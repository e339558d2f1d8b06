//! Random numbers and what they are turned into.
//!
//! A number is a pure function of (seed, pixel, round, sample, bounce, purpose). Numbers come in padded two-dimensional
//! sets keyed by purpose, so a purpose that a scene does not use shifts nothing elsewhere and no dimension limit is
//! met. Below the stages, functions take numbers, never a sampler.

pub mod discrete;
pub mod sampler;
pub mod sobol;
pub mod warp;
pub mod xoshiro;

pub use sampler::{Fan, Keys, Purpose, one_of, pair};
