//! What several commands' JSON objects have in common: the settings of a render under their documented names.

use std::fmt::{self, Display, Formatter};

use serde::Serialize;
use smalti_core::settings::{Rect, Settings};

use crate::job::Job;

/// Settings as users write them.
#[derive(Debug, Serialize)]
pub struct SettingsRecord {
    pub integrator: &'static str,
    pub sampler: &'static str,
    pub fresnel: &'static str,
    pub jitter: bool,
    /// Name of the camera; null: the only one, which has none.
    pub camera: Option<String>,
    /// Size of the whole image.
    pub width: u32,
    pub height: u32,
    /// Column, row, width and height of the part that is rendered; null: all of it.
    pub crop: Option<[u32; 4]>,
    pub spp: u32,
    pub shadow_rays: u32,
    /// Null: roulette alone ends paths.
    pub max_bounces: Option<u32>,
    pub seed: u64,
    /// Photons of a round and map; null: the integrator asks none.
    pub photons: Option<u32>,
    /// How far they count in the first round, metres; null: by their density.
    pub radius: Option<f64>,
}

/// The settings of a job.
pub fn settings(job: &Job) -> SettingsRecord {
    let settings: &Settings = &job.settings;
    SettingsRecord {
        integrator: settings.integrator.name(),
        sampler: settings.sampler.name(),
        fresnel: settings.fresnel.name(),
        jitter: settings.jitter,
        camera: Some(job.camera().to_owned()).filter(|name| !name.is_empty()),
        width: settings.width,
        height: settings.height,
        crop: settings.crop.map(|Rect { x, y, width, height }| [x, y, width, height]),
        spp: settings.spp,
        shadow_rays: settings.shadow_rays,
        max_bounces: settings.max_bounces,
        seed: settings.seed,
        photons: settings.integrator.asks_photons().then(|| settings.photons_of_round()),
        radius: settings.radius,
    }
}

/// In a few words, without the samples: `path, 800x800, shadow rays 1, sobol, seed 0`.
impl Display for SettingsRecord {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "{}, {}x{}", self.integrator, self.width, self.height)?;
        if let Some([x, y, width, height]) = self.crop {
            write!(f, " at {x},{y},{width},{height}")?;
        }
        write!(f, ", shadow rays {}, {}, seed {}", self.shadow_rays, self.sampler, self.seed)
    }
}
