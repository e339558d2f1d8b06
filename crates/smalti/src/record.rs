//! What several commands' JSON objects have in common, under its documented names: the settings of a render, which
//! picture it is, and how the machine was used.

use std::fmt::{self, Display, Formatter};
use std::time::Duration;

use serde::Serialize;
use smalti_core::settings::{Rect, Settings};
use smalti_scheduler::Outcome;

use crate::downsample;
use crate::job::Job;

/// Which render of which scene an object is about.
#[derive(Debug, Serialize)]
pub struct Subject<'a> {
    pub version: &'static str,
    /// The estimator: images of one are the same bit for bit, whatever the version.
    pub estimator: u32,
    pub scene: String,
    pub scene_hash: &'a str,
    /// What is worth knowing and stops nothing, each a sentence.
    pub notes: Vec<String>,
    #[serde(flatten)]
    pub settings: SettingsRecord,
}

/// That of a job.
pub fn subject(job: &Job) -> Subject<'_> {
    Subject {
        version: env!("CARGO_PKG_VERSION"),
        estimator: smalti_core::ESTIMATOR,
        scene: job.path.display().to_string(),
        scene_hash: &job.scene_hash,
        notes: notes(job),
        settings: settings(job),
    }
}

/// The notes of a job as JSON has them.
pub fn notes(job: &Job) -> Vec<String> {
    job.notes.iter().map(|note| note.text.clone()).collect()
}

/// Settings as users write them.
#[derive(Debug, Serialize)]
pub struct SettingsRecord {
    pub integrator: &'static str,
    pub sampler: &'static str,
    pub fresnel: &'static str,
    pub jitter: bool,
    /// Whether samples went where the noise is; `spp` is their mean then.
    pub adaptive: bool,
    #[serde(flatten)]
    pub picture: PictureRecord,
    /// Pixels that were rendered for each one of the image, in each direction.
    pub downsample: u32,
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
        adaptive: settings.adaptive,
        picture: PictureRecord::new(job),
        downsample: job.downsample,
        shadow_rays: settings.shadow_rays,
        max_bounces: settings.max_bounces,
        seed: settings.seed,
        photons: settings.integrator.asks_photons().then(|| settings.photons_of_round()),
        radius: settings.radius,
    }
}

/// Which picture of a scene it is.
#[derive(Debug, Serialize)]
pub struct PictureRecord {
    /// Name of the camera; null: the only one, which has none.
    pub camera: Option<String>,
    /// Size of the whole image.
    pub width: u32,
    pub height: u32,
    /// Column, row, width and height of the part that is rendered; null: all of it.
    pub crop: Option<[u32; 4]>,
    pub spp: u32,
}

impl PictureRecord {
    /// That of a job.
    pub fn new(job: &Job) -> Self {
        let settings = downsample::image(&job.settings, job.downsample);
        Self {
            camera: Some(job.camera().to_owned()).filter(|name| !name.is_empty()),
            width: settings.width,
            height: settings.height,
            crop: settings.crop.map(|Rect { x, y, width, height }| [x, y, width, height]),
            spp: settings.spp,
        }
    }
}

/// How the machine was used.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    /// Worker threads.
    pub threads: usize,
    /// Side of a tile.
    pub tile: u32,
    /// From the start of the process to the first sample.
    pub setup: Duration,
}

/// How the machine was used and for how long, seconds.
#[derive(Debug, Serialize)]
pub struct RunRecord {
    pub threads: usize,
    pub simd: &'static str,
    pub tile: u32,
    /// Reading, compiling and building, and the short renders of `--quality`, from the start of the process.
    pub setup_seconds: f64,
    /// Emitting, tracing and storing photons, within `render_seconds`.
    pub photon_seconds: f64,
    pub render_seconds: f64,
    pub write_seconds: f64,
    /// From the start of the process to the end of writing.
    pub wall_seconds: f64,
}

impl RunRecord {
    /// Before anything is written.
    pub fn new(job: &Job, work: Work, outcome: &Outcome) -> Self {
        Self {
            threads: work.threads,
            simd: job.level.name(),
            tile: work.tile,
            setup_seconds: work.setup.as_secs_f64(),
            photon_seconds: outcome.photons.elapsed.as_secs_f64(),
            render_seconds: outcome.timing.elapsed.as_secs_f64(),
            write_seconds: 0.0,
            wall_seconds: 0.0,
        }
    }
}

/// In a few words, without the samples: `path, 800x800 down-sampled 2x2, shadow rays 1, sobol, seed 0`.
impl Display for SettingsRecord {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let PictureRecord { width, height, crop, .. } = self.picture;
        write!(f, "{}, {width}x{height}", self.integrator)?;
        if let Some([x, y, width, height]) = crop {
            write!(f, " at {x},{y},{width},{height}")?;
        }
        if self.downsample > 1 {
            write!(f, " down-sampled {0}x{0}", self.downsample)?;
        }
        write!(f, ", shadow rays {}, {}, seed {}", self.shadow_rays, self.sampler, self.seed)
    }
}
