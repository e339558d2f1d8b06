//! What a watcher knows: the facts so far, added up.

use std::sync::Arc;
use std::time::{Duration, Instant};

use smalti_core::settings::Rect;
use smalti_scheduler::{Current, Event, Progress, Timing};

use super::pace::Pace;

/// The facts so far.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The part of the image that is rendered.
    pub area: Rect,
    /// Every tile's place.
    pub tiles: Vec<Rect>,
    /// Samples (camera paths) to do, over all pixels; `None` where that cannot be foreseen yet.
    pub total: Option<u64>,
    /// Samples done, those of units in hand included. Never falls.
    pub done: u64,
    /// Samples a pixel that it will come to; likewise.
    pub until: Option<u32>,
    /// Samples that every pixel has.
    pub samples: u32,
    /// Samples of finished units.
    finished: u64,
    /// Rays of finished units.
    pub rays: u64,
    /// Samples that were not finite.
    pub rejected: u64,
    /// The last judgement of the error, with the samples a pixel that it was made at.
    pub error: Option<(f64, u32)>,
    /// Photons that are on their way, and how many of them were traced at the last look.
    pub photons: Option<(u64, u64)>,
    /// Every worker.
    pub workers: Vec<Worker>,
    /// Time since the start, at the last look.
    pub elapsed: Duration,
    /// How fast it goes.
    pub pace: Pace,
    /// How it ended, if it did.
    pub end: Option<End>,
    progress: Option<Arc<Progress>>,
}

/// What is known of a worker.
#[derive(Clone, Debug, Default)]
pub struct Worker {
    /// What it had in hand at the last look.
    pub current: Option<Current>,
    /// Rays a second of its last unit.
    pub rays_per_second: Option<f64>,
}

/// How a render ended.
#[derive(Clone, Debug)]
pub struct End {
    /// Whether it was stopped.
    pub interrupted: bool,
    /// Where the time went.
    pub timing: Timing,
}

impl Tally {
    /// Adds a fact.
    pub fn hear(&mut self, event: &Event) {
        match event {
            Event::Started { area, tiles, from, until, samples, progress } => {
                self.area = *area;
                self.tiles.clone_from(tiles);
                (self.samples, self.until, self.total) = (*from, *until, *samples);
                self.workers = vec![Worker::default(); progress.workers()];
                self.progress = Some(progress.clone());
            }
            Event::TileFinished { worker, elapsed, rays, samples, rejected, .. } => {
                let rays = rays.camera + rays.scattered + rays.shadow;
                self.workers[*worker].rays_per_second = Some(rays as f64 / elapsed.as_secs_f64().max(1e-9));
                self.finished += samples;
                self.done = self.done.max(self.finished);
                self.rays += rays;
                self.rejected += rejected;
            }
            Event::PhotonsEmitted { photons, .. } => self.photons = Some((0, *photons)),
            Event::PhotonsStored { .. } => self.photons = None,
            Event::SampleRejected(_) => {}
            Event::PassFinished { samples, foreseen, elapsed, error, .. } => {
                self.elapsed = self.elapsed.max(*elapsed);
                self.foresee(*samples, *foreseen);
                self.error = error.map(|error| (error, *samples)).or(self.error);
            }
            Event::Finished { interrupted, timing } => {
                self.elapsed = timing.elapsed;
                self.end = Some(End { interrupted: *interrupted, timing: timing.clone() });
            }
        }
    }

    /// Takes what is foreseen into the account: as many more samples a pixel as are missing.
    fn foresee(&mut self, samples: u32, foreseen: Option<u32>) {
        (self.samples, self.until) = (samples, foreseen);
        let missing = |foreseen: u32| u64::from(foreseen.saturating_sub(samples)) * self.area.pixels() as u64;
        self.total = foreseen.map(|foreseen| self.finished + missing(foreseen));
    }

    /// Looks at what the workers have in hand at `now`.
    pub fn look(&mut self, now: Instant) {
        let Some(progress) = self.progress.as_ref().filter(|_| self.end.is_none()) else {
            return;
        };
        self.elapsed = now.saturating_duration_since(progress.start());
        for (index, worker) in self.workers.iter_mut().enumerate() {
            worker.current = progress.current(index, now);
        }
        self.done = self.done.max(self.finished + progress.in_hand()).min(self.total.unwrap_or(u64::MAX));
        self.photons = self.photons.map(|(_, all)| (progress.photons().min(all), all));
        self.pace.note(self.elapsed, self.done);
    }

    /// Rays a second so far, over finished units.
    pub fn rays_per_second(&self) -> f64 {
        self.rays as f64 / self.elapsed.as_secs_f64().max(1e-9)
    }
}
