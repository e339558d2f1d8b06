//! The account of a render: one record, shown as text or as JSON. Its field names are a promise.

use serde::Serialize;
use smalti_core::film::{Film, Image, ROUND};
use smalti_core::plan::LEAST_CONTRIBUTION;
use smalti_core::render::{RayCounts, Rejected};
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Fresnel, Integrator, Rect, Settings};
use smalti_measure::{BiasStatement, ErrorStatement};
use smalti_scheduler::{Outcome, Timing};

use crate::job::Job;
use crate::quality::QualityRecord;
use crate::record::{self, RunRecord, SettingsRecord, Work};
use crate::reproduce;
use crate::{budget, error_statement};

/// Everything that is told of a render. Times in seconds; what does not exist is null.
#[derive(Debug, Serialize)]
pub struct Summary {
    pub version: &'static str,
    /// The estimator: images of one are the same bit for bit, whatever the version.
    pub estimator: u32,
    pub scene: String,
    pub scene_hash: String,
    /// What is worth knowing about scene and settings and stops nothing, each a sentence.
    pub notes: Vec<String>,
    #[serde(flatten)]
    pub settings: SettingsRecord,
    /// Fewest and most samples of any pixel; they differ after an interruption and where samples went to the noise.
    pub samples_least: u32,
    pub samples_most: u32,
    /// Complete rounds of every pixel: what the error is judged by.
    pub rounds: u32,
    #[serde(flatten)]
    pub run: RunRecord,
    /// Samples over all pixels.
    pub samples: u64,
    pub rays: RayRecord,
    /// Null without a camera ray.
    pub mean_path_length: Option<f64>,
    pub photons_emitted: u64,
    pub photons_stored: u64,
    /// Photons that were not finite and were left out.
    pub photons_nonfinite: u64,
    /// Photon maps of a round.
    pub photon_bytes: u64,
    /// The process's memory at its most, where the system tells.
    pub peak_bytes: Option<u64>,
    pub hash: String,
    pub nonfinite: u64,
    /// The first samples that were not finite.
    pub nonfinite_samples: Vec<RejectedRecord>,
    /// Paths that the hard cap on bounces ended.
    pub capped_paths: u64,
    pub mean: [f64; 3],
    /// Noise; null with too few samples. Upper ends that cannot be known are null.
    pub error: Option<ErrorStatement>,
    /// What photon radii add to the image in error; null without photons, or before two rounds. Not in `error`.
    pub bias: Option<BiasStatement>,
    /// What is wrong with the image apart from noise, in words.
    pub biases: Vec<String>,
    pub tiles: Option<TilesRecord>,
    /// Share of the workers' time for tiles that was spent waiting.
    pub idle: f64,
    /// What `--quality` chose, and what it expected; null without it.
    pub quality: Option<QualityRecord>,
    /// `spp`, `time`, `error` or `interrupt`.
    pub stopped_by: &'static str,
    /// Whether it came to what was asked for: the error, the time, or else the samples; a time that was exceeded is not
    /// reached.
    pub target_reached: bool,
    /// What it fell short of and why, in words; empty where it came to all, and where it was interrupted.
    pub shortfalls: Vec<String>,
    pub outputs: Vec<String>,
    /// Null where samples differ between tiles: no command gives that image.
    pub reproduce: Option<String>,
}

#[derive(Debug, Serialize)]
pub struct RayRecord {
    pub camera: u64,
    pub scattered: u64,
    pub shadow: u64,
}

impl RayRecord {
    /// Rays of all kinds.
    pub fn all(&self) -> u64 {
        self.camera + self.scattered + self.shadow
    }
}

/// A sample that was not finite, and how to see it again.
#[derive(Debug, Serialize)]
pub struct RejectedRecord {
    pub pixel: [u32; 2],
    pub sample: u32,
    pub replay: String,
}

/// How evenly the tiles share the work.
#[derive(Debug, Serialize)]
pub struct TilesRecord {
    pub count: usize,
    pub min_seconds: f64,
    pub median_seconds: f64,
    pub max_seconds: f64,
    /// Column, row, width and height.
    pub slowest: [u32; 4],
}

/// What the workers left, looked at: the film is no longer needed.
#[derive(Debug)]
pub struct Developed {
    /// The linear image.
    pub image: Image,
    /// Its error; `None` with too few samples.
    pub error: Option<ErrorStatement>,
    /// Its bias by photon radii; `None` where there is none, and with too few samples.
    pub bias: Option<BiasStatement>,
    /// Fewest and most samples of any pixel.
    pub samples: (u32, u32),
}

/// Develops a film; `by` × `by` of its pixels become one of the image.
pub fn develop(film: &Film, by: u32) -> Developed {
    let film = film.downsampled(by);
    let bias = || smalti_measure::bias_statement(&film);
    let (error, (bias, image)) = rayon::join(|| error_statement::of(&film, 1), || (bias(), film.develop()));
    Developed { image, error, bias, samples: film.samples() }
}

/// The summary before anything is written; the outcome's film is not looked at.
pub fn summary(job: &Job, work: Work, outcome: &Outcome, developed: &Developed) -> Summary {
    let (least, most) = developed.samples;
    let RayCounts { camera, scattered, shadow } = outcome.rays;
    let idle = outcome.timing.idle();
    Summary {
        version: env!("CARGO_PKG_VERSION"),
        estimator: smalti_core::ESTIMATOR,
        scene: job.path.display().to_string(),
        scene_hash: job.scene_hash.clone(),
        notes: record::notes(job),
        settings: record::settings(job),
        samples_least: least,
        samples_most: most,
        rounds: least / ROUND,
        run: RunRecord::new(job, work, outcome),
        samples: outcome.samples,
        rays: RayRecord { camera, scattered, shadow },
        mean_path_length: (camera > 0).then(|| (camera + scattered) as f64 / camera as f64),
        photons_emitted: outcome.photons.emitted,
        photons_stored: outcome.photons.stored,
        photons_nonfinite: outcome.photons.nonfinite,
        photon_bytes: outcome.photons.bytes,
        peak_bytes: None,
        hash: smalti_image::hash(&developed.image),
        nonfinite: outcome.rejected.count,
        nonfinite_samples: outcome.rejected.first.iter().map(|rejected| rejected_record(job, rejected)).collect(),
        capped_paths: outcome.capped,
        mean: developed.image.mean(),
        error: developed.error,
        bias: developed.bias,
        biases: biases(&job.settings, &job.world, outcome.capped),
        tiles: tiles(&outcome.timing),
        idle: idle.iter().sum::<f64>() / idle.len().max(1) as f64,
        quality: None,
        stopped_by: budget::name(outcome.stopped),
        target_reached: !outcome.interrupted,
        shortfalls: Vec::new(),
        outputs: Vec::new(),
        reproduce: repeatable(job, outcome, (least, most)).then(|| reproduce(job, outcome.mean_samples)),
    }
}

/// Whether the samples are those of whole passes: after an interruption they are of some tiles only.
fn repeatable(job: &Job, outcome: &Outcome, (least, most): (u32, u32)) -> bool {
    if job.settings.adaptive { !outcome.interrupted } else { least == most }
}

/// The command that makes the image again.
fn reproduce(job: &Job, spp: u32) -> String {
    reproduce::command(&job.path, (&job.settings, job.downsample), spp, job.camera())
}

fn rejected_record(job: &Job, rejected: &Rejected) -> RejectedRecord {
    let &Rejected { pixel, sample } = rejected;
    let replay = reproduce::replay_command(&job.path, &job.settings, job.camera(), pixel, sample);
    RejectedRecord { pixel: [pixel.0, pixel.1], sample, replay }
}

fn tiles(timing: &Timing) -> Option<TilesRecord> {
    let balance = timing.balance()?;
    let Rect { x, y, width, height } = balance.slowest;
    Some(TilesRecord {
        count: timing.tiles.len(),
        min_seconds: balance.min.as_secs_f64(),
        median_seconds: balance.median.as_secs_f64(),
        max_seconds: balance.max.as_secs_f64(),
        slowest: [x, y, width, height],
    })
}

/// Whether the scene has light that goes from a point by specular surfaces to diffuse ones, and no photons carry it.
fn lacks_point_caustics(settings: &Settings, world: &World) -> bool {
    let has = |wanted: fn(&Material) -> bool| world.materials.iter().any(wanted);
    let photons = settings.integrator.asks_photons() && settings.photons_of_round() > 0;
    !photons
        && !world.point_lights.is_empty()
        && has(|material| matches!(material, Material::Lambert { .. }))
        && has(Material::is_specular)
}

/// What more samples would not mend; `capped` paths were ended by the hard cap on bounces.
pub fn biases(settings: &Settings, world: &World, capped: u64) -> Vec<String> {
    let mut biases = Vec::new();
    if settings.integrator == Integrator::Whitted {
        let least = 1.0 / LEAST_CONTRIBUTION;
        biases.push("whitted: no indirect diffuse light and no ambient term".into());
        biases.push(format!("whitted: branches that count for less than 1/{least} are not followed"));
    }
    if lacks_point_caustics(settings, world) {
        let name = settings.integrator.name();
        biases.push(format!("{name}: caustics of point lights are missing; only photons find them"));
    }
    if let Some(bounces) = settings.max_bounces {
        biases.push(format!("max_bounces: light that scatters more than {bounces} times is missing"));
    }
    if settings.fresnel == Fresnel::Schlick {
        biases.push("schlick: dielectrics reflect by an approximation".into());
    }
    if !settings.jitter {
        biases.push("no jitter: a pixel shows its centre, not its area".into());
    }
    if capped > 0 {
        biases.push(format!("cap: {capped} paths were ended by the hard cap on bounces"));
    }
    biases
}
