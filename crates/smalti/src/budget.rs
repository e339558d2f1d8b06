//! When a render stops other than by its samples: `--time`, `--target-error`; and where its samples go: `--adaptive`.

use std::time::{Duration, Instant};

use rayon::ThreadPool;
use smalti_core::film::Film;
use smalti_core::settings::{Rect, Settings};
use smalti_scheduler::{ADAPTIVE_TILE, Goal, Stopped, Target};

use crate::args::BudgetArgs;
use crate::error_statement;

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

/// Samples a pixel at most where only time or error end a render.
const WITHOUT_END: u32 = 1 << 24;

/// Time that is left for what comes after the last sample: the error statement, the files, the end of the process.
const CLOSING: Duration = Duration::from_millis(4);

/// The same for each pixel.
const CLOSING_A_PIXEL: Duration = Duration::from_nanos(120);

impl Budget {
    /// What was typed; `spp` likewise.
    pub fn new(args: &BudgetArgs, spp: Option<u32>) -> Self {
        Self { time: args.time.map(Duration::from_secs_f64), error: args.target_error, spp }
    }

    /// Whether time or error end the render.
    pub fn is_open(&self) -> bool {
        self.time.is_some() || self.error.is_some()
    }

    /// Samples a pixel at most.
    pub fn most_samples(&self, settings: &Settings) -> u32 {
        match self.is_open() {
            true => self.spp.unwrap_or(WITHOUT_END),
            false => settings.spp,
        }
    }

    /// The goal of a render of `settings`, `by` × `by` of whose pixels become one, in a process that began at `start`.
    pub fn goal<'a>(&self, settings: &Settings, by: u32, pool: &'a ThreadPool, start: Instant) -> Goal<'a> {
        let at_most = move |film: &Film| pool.install(|| error_at_most(film, by));
        let noise = move |film: &Film| pool.install(|| smalti_measure::noise(film));
        Goal {
            spp: Some(self.most_samples(settings)),
            deadline: self.time.map(|time| start + time.saturating_sub(closing(settings.area()))),
            target: self.error.map(|error| Target { error, at_most: Box::new(at_most) }),
            noise: settings.adaptive.then_some(Box::new(noise) as _),
        }
    }

    /// Whether what was wanted was reached.
    pub fn is_reached(&self, stopped: Stopped) -> bool {
        match stopped {
            Stopped::Error => true,
            Stopped::Time => self.error.is_none(),
            Stopped::Samples => !self.is_open(),
            Stopped::Cancelled => false,
        }
    }
}

fn closing(area: Rect) -> Duration {
    CLOSING + CLOSING_A_PIXEL.saturating_mul(u32::try_from(area.pixels()).unwrap_or(u32::MAX))
}

/// What the relative error of the image is at most, noise and the bias by photon radii together; `None` while nobody can
/// say.
fn error_at_most(film: &Film, by: u32) -> Option<f64> {
    let film = film.downsampled(by);
    let noise = error_statement::of(&film, 1)?.relative_error_high?;
    let bias = film.shifts().and_then(|shifts| smalti_measure::bias_statement(&shifts, film.area.width));
    let bias = bias.map_or(0.0, |bias| bias.relative_bias_high);
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
mod tests {
    use super::*;

    #[test]
    fn what_was_wanted_is_reached_or_not() {
        let (plain, error) = (Budget::default(), Budget { error: Some(0.01), ..Budget::default() });
        let timed = Budget { time: Some(Duration::from_secs(1)), ..Budget::default() };
        assert!(plain.is_reached(Stopped::Samples) && timed.is_reached(Stopped::Time));
        assert!(error.is_reached(Stopped::Error) && !error.is_reached(Stopped::Samples));
        let both = Budget { time: timed.time, ..error };
        assert!(!both.is_reached(Stopped::Time) && !both.is_reached(Stopped::Cancelled));
    }

    #[test]
    fn larger_images_take_longer_to_close() {
        let area = |side| Rect { x: 0, y: 0, width: side, height: side };
        assert!(closing(area(10)) < Duration::from_millis(5) && closing(area(1000)) > Duration::from_millis(100));
    }
}
