//! A scene at its numerical extremes: in other units, in other places, turned, at every SIMD level; ray by ray against f64;
//! the light of its photons beside the same light by paths; and what of its geometry asks for trouble.
//!
//! [`examine`] runs every check and tells each finding as soon as it is there. Nothing here is about one scene: what the
//! checks ask for are the renderer's promises (docs/stability.md).

mod finding;
mod geometry;
mod photons;
mod pictures;
mod rays;
mod turned;

pub use finding::{Finding, Verdict};

use rayon::ThreadPool;
use smalti_core::render::{Level, PlanError};
use smalti_core::scene::World;
use smalti_core::settings::Settings;

use crate::pictures::Studio;

/// Why an examination ended early.
#[derive(Debug, thiserror::Error)]
pub enum DoctorError {
    /// The settings do not suit the scene.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A worker panicked.
    #[error("a worker panicked: {0}")]
    Panicked(String),
}

/// What is examined.
#[derive(Clone, Copy)]
pub struct Patient<'a> {
    /// The scene.
    pub world: &'a World,
    /// How it is rendered; the size should be small, as there are some two hundred renders.
    pub settings: &'a Settings,
    /// The SIMD level of everything that is not about levels.
    pub level: Level,
}

/// Runs every check on `pool` and tells each finding.
///
/// # Errors
/// Settings that the scene cannot meet, or a worker that panicked.
pub fn examine(patient: Patient<'_>, pool: &ThreadPool, mut tell: impl FnMut(Finding)) -> Result<(), DoctorError> {
    geometry::check(&patient, &mut tell);
    let studio = Studio { pool, level: patient.level };
    let films = studio.films(patient.world, patient.settings)?;
    pictures::check(&patient, (&studio, &films), &mut tell)?;
    photons::check(&patient, (&studio, &films), &mut tell)?;
    rays::check(&patient, pool, &mut tell)
}
