//! A study as it is kept in `study.json`. The names of the fields are a promise.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use smalti_measure::ErrorStatement;

/// Version of the format: another one is refused.
pub const FORMAT: u32 = 1;

/// Several ways to render one scene, each several times, with the error of each image against one truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// [`FORMAT`].
    pub format: u32,
    /// Version of the program.
    pub version: String,
    /// What was asked: `sweep`, `report`, `equal-time`, `equal-error`, `knobs`.
    pub preset: String,
    /// The same in full, by the names of flags and of what else matters: whoever goes on must ask the same.
    #[serde(default)]
    pub question: BTreeMap<String, String>,
    /// The command that repeats it.
    pub command: String,
    /// The scene file as typed.
    pub scene: String,
    /// Hash of what it says.
    pub scene_hash: String,
    /// Where it ran.
    pub machine: Machine,
    /// Brightness of the pictures, stops.
    #[serde(default)]
    pub exposure: f64,
    /// What images were compared with; one for each size of image.
    pub references: Vec<Reference>,
    /// The ways to render.
    pub arms: Vec<Arm>,
    /// The arm that others are compared with, in words ('20 shadow rays instead of 10'); `None`: each with the best.
    pub baseline: Option<usize>,
    /// Renders that are finished, in the order in which they ran: all arms once, then all again.
    pub runs: Vec<Run>,
}

/// The machine of a study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Threads that it can run at once.
    pub cores: usize,
    /// SIMD level that was used.
    pub simd: String,
    /// Operating system and processor family, as the compiler names them: `linux x86_64`.
    pub system: String,
}

/// What stands for the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Width and height.
    pub size: [u32; 2],
    /// The file, relative to the study's folder if it is in there.
    pub file: String,
    /// The command that made it; `None`: it was given.
    pub command: Option<String>,
    /// The relmse that it states of itself, and which errors are freed of; `None`: nothing is known, and nothing taken off.
    pub relmse: Option<f64>,
    /// The same for the square of the relative error.
    pub relative_error_squared: Option<f64>,
}

/// One way to render.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arm {
    /// Short and unique, good for a file name: `auto-64spp-10`.
    pub name: String,
    /// For people: `auto, 64 spp, 10 shadow rays`.
    pub label: String,
    /// Arms of one curve or one table row heading have the same: `auto`.
    pub group: String,
    /// Every knob by its flag's name (`integrator`, `spp`, `shadow-rays`, `sampler`, `threads` ...), resolved.
    pub knobs: BTreeMap<String, String>,
    /// Names of the knobs in which it differs from the baseline.
    pub varies: Vec<String>,
    /// A command that gives the image of repetition 0.
    pub command: String,
    /// Width and height of the image.
    pub size: [u32; 2],
    /// Its first image as a tone-mapped PNG, relative to the study's folder.
    pub picture: Option<String>,
    /// The same as linear radiance (PFM).
    pub image: Option<String>,
    /// What the image lacks apart from noise, in words.
    pub biases: Vec<String>,
}

/// One finished render.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Index of the arm.
    pub arm: usize,
    /// Repetition, from 0.
    pub repetition: u32,
    /// Seed: another in each repetition, the same for all arms.
    pub seed: u64,
    /// From the first sample to the last, photons included.
    pub seconds: f64,
    /// The part of it for photons.
    pub photon_seconds: f64,
    /// Samples a pixel (a mean where pixels differ).
    pub spp: f64,
    /// Rays of all kinds.
    pub rays: u64,
    /// Error against the reference, freed of the reference's own: mean of (x − r)² / (r² + 0.01); below 0 by chance where
    /// the two are alike.
    pub relmse: f64,
    /// The same with the worst 0.1 % of the pixels left out, not freed of anything.
    pub relmse_trimmed: f64,
    /// Relative error against the reference, freed of the reference's own (0 where that is the larger).
    pub relative_error: f64,
    /// What the render stated of itself.
    pub stated: Option<ErrorStatement>,
    /// Mean of each channel, linear.
    pub mean: [f64; 3],
    /// Hash of the image.
    pub hash: String,
    /// Time in each tile; kept of the first repetition.
    pub tiles: Vec<TileTime>,
}

/// Time spent in a tile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TileTime {
    /// Column, row, width and height.
    pub area: [u32; 4],
    /// Over all passes.
    pub seconds: f64,
}
