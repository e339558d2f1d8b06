//! When a render is to stop, and where its samples go.

use std::time::Instant;

use smalti_core::film::Film;

/// When a render stops: at the first of these.
#[derive(Default)]
pub struct Goal<'a> {
    /// Samples a pixel at most; `None`: as many as the renderer's settings say.
    pub spp: Option<u32>,
    /// When the last sample should be there.
    pub deadline: Option<Instant>,
    /// An error to be reached.
    pub target: Option<Target<'a>>,
    /// Where the noise is, for samples to go there; `None`: every pixel gets as many.
    pub noise: Option<NoiseOf<'a>>,
}

/// An error to be reached.
pub struct Target<'a> {
    /// The error that is small enough.
    pub error: f64,
    /// What the error is; `None` while nobody can say. Asked at numbers of samples that depend on its answers alone,
    /// between passes; nobody renders meanwhile.
    pub judge: JudgeOf<'a>,
}

/// The error of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// What it seems to be.
    pub error: f64,
    /// What it is at most.
    pub at_most: f64,
}

/// Judges the error of a film; `None` while nobody can say what it is at most.
pub type JudgeOf<'a> = Box<dyn Fn(&Film) -> Option<Judgement> + Send + Sync + 'a>;

/// For each tile of a film what a single sample of each of its pixels would leave of squared error.
pub type NoiseOf<'a> = Box<dyn Fn(&Film) -> Vec<f64> + Send + Sync + 'a>;

/// Why a render stopped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stopped {
    /// All samples are there.
    #[default]
    Samples,
    /// The time was up.
    Time,
    /// The error is small enough.
    Error,
    /// Someone cancelled.
    Cancelled,
}
