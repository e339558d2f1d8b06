//! When a render stops other than by its samples: `--time`, `--target-error`; and where its samples go: `--adaptive`.

mod verdict;

use std::time::{Duration, Instant};

use rayon::ThreadPool;
use smalti_core::film::Film;
use smalti_core::settings::{Rect, Settings};
use smalti_measure::{BiasStatement, ErrorStatement};
use smalti_scheduler::{ADAPTIVE_TILE, Goal, Judgement, MOST_SAMPLES, Stopped, Target};

use crate::args::BudgetArgs;
use crate::error_statement;
use crate::frontend;
use crate::names::QualityArg;
pub use verdict::{Came, Spent};

/// What a render may take, and what is wanted of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// From the start of the process to its end.
    pub time: Option<Duration>,
    /// Relative error at most.
    pub error: Option<f64>,
    /// Samples a pixel at most; `None`: as the scene says, or without end where time or error do.
    pub spp: Option<u32>,
}

/// Time that is left for what comes after the last sample: the error statement, the files, the end of the process.
const CLOSING: Duration = Duration::from_millis(4);

/// The same for each pixel.
const CLOSING_A_PIXEL: Duration = Duration::from_nanos(120);

impl Budget {
    /// What was typed; `spp` likewise.
    pub fn new(args: &BudgetArgs, spp: Option<u32>) -> Self {
        Self {
            time: args.time.map(Duration::from_secs_f64),
            error: args.target_error.or(args.quality.map(QualityArg::error)),
            spp,
        }
    }

    /// Whether time or error end the render.
    pub fn is_open(&self) -> bool {
        self.time.is_some() || self.error.is_some()
    }

    /// What a display says of the end of a render of `settings`.
    pub fn shown(&self, settings: &Settings) -> frontend::Goal {
        let spp = if self.is_open() { self.spp } else { Some(settings.spp) };
        frontend::Goal { spp, time: self.time, error: self.error }
    }

    /// Samples a pixel at most.
    pub fn most_samples(&self, settings: &Settings) -> u32 {
        match self.is_open() {
            true => self.spp.unwrap_or(MOST_SAMPLES),
            false => settings.spp,
        }
    }

    /// The goal of a render of `settings`, `by` × `by` of whose pixels become one, in a process that began at `start`.
    pub fn goal<'a>(&self, settings: &Settings, by: u32, pool: &'a ThreadPool, start: Instant) -> Goal<'a> {
        let judge = move |film: &Film| pool.install(|| judgement(film, by));
        let noise = move |film: &Film| pool.install(|| smalti_measure::noise(film));
        Goal {
            spp: Some(self.most_samples(settings)),
            deadline: self.time.map(|time| start + time.saturating_sub(closing(settings.area()))),
            target: self.error.map(|error| Target { error, judge: Box::new(judge) }),
            noise: settings.adaptive.then_some(Box::new(noise) as _),
        }
    }
}

fn closing(area: Rect) -> Duration {
    CLOSING + CLOSING_A_PIXEL.saturating_mul(u32::try_from(area.pixels()).unwrap_or(u32::MAX))
}

/// The relative error of the image that `film` develops into.
fn judgement(film: &Film, by: u32) -> Option<Judgement> {
    let film = film.downsampled(by);
    let noise = error_statement::of(&film, 1)?;
    let bias = smalti_measure::bias_statement(&film);
    let at_most = at_most(Some(&noise), bias.as_ref())?;
    let bias = bias.map_or(0.0, |bias| bias.relative_bias);
    let error = (noise.relative_error * noise.relative_error + bias * bias).sqrt();
    Some(Judgement { error, at_most })
}

/// What a relative error is at most, noise and the bias by photon radii together; `None` while nobody can say.
pub fn at_most(error: Option<&ErrorStatement>, bias: Option<&BiasStatement>) -> Option<f64> {
    let noise = error?.relative_error_high?;
    let bias = bias.map_or(0.0, |bias| bias.relative_bias_high.max(bias.relative_bias));
    Some((noise * noise + bias * bias).sqrt())
}

/// Side of the tiles of a film, where `asked` was asked for: adaptive sampling has its own.
pub fn tile(adaptive: bool, by: u32, asked: u32) -> u32 {
    if adaptive { ADAPTIVE_TILE.next_multiple_of(by) } else { asked.next_multiple_of(by) }
}

/// Why a render stopped, as users write it.
pub fn name(stopped: Stopped) -> &'static str {
    match stopped {
        Stopped::Samples => "spp",
        Stopped::Time => "time",
        Stopped::Error => "error",
        Stopped::Cancelled => "interrupt",
    }
}

#[cfg(test)]
mod fixture {
    use super::ErrorStatement;

    /// An error of 3 %, 2 % at least.
    pub fn statement(relative_error_high: Option<f64>, uncertified_pixels: usize) -> ErrorStatement {
        ErrorStatement {
            relmse: 9e-4,
            relmse_low: 4e-4,
            relmse_high: None,
            relative_error: 0.03,
            relative_error_low: 0.02,
            relative_error_high,
            uncertified_pixels,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::fixture::statement;
    use super::*;

    #[test]
    fn noise_and_bias_add_up_in_squares() {
        let bias = BiasStatement { relative_bias: 0.02, relative_bias_high: 0.03, brightness: 0.0 };
        let known = statement(Some(0.04), 0);
        assert!((at_most(Some(&known), Some(&bias)).unwrap() - 0.05).abs() < 1e-15);
        assert_eq!(at_most(Some(&known), None), Some(0.04));
        assert_eq!((at_most(Some(&statement(None, 3)), Some(&bias)), at_most(None, None)), (None, None));
    }

    #[test]
    fn larger_images_take_longer_to_close() {
        let area = |side| Rect { x: 0, y: 0, width: side, height: side };
        assert!(closing(area(10)) < Duration::from_millis(5) && closing(area(1000)) > Duration::from_millis(100));
    }
}
