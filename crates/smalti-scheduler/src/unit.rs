//! One unit of work: a tile in a pass, done by one worker, and what became of it.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::AtomicU64;
use std::time::{Duration, Instant};

use smalti_core::film::Tile;
use smalti_core::render::Work;

use crate::account::{Done, Record};
use crate::{Event, Progress, Watch};

/// A tile in a pass.
pub(crate) struct Unit<'a> {
    /// Index of the tile.
    pub index: usize,
    /// Its pixels.
    pub tile: &'a mut Tile,
    /// What is known of it.
    pub record: &'a mut Record,
    /// The pass.
    pub pass: u32,
    /// Samples that every pixel has afterwards.
    pub until: u32,
    /// How often each counts, where they are a round of their own.
    pub weight: Option<f64>,
}

/// The samples that every pixel is to have, and how often the new ones count where they are a round of their own.
pub(crate) type Samples = (u32, Option<f64>);

/// A worker's own things.
pub(crate) struct Worker<W> {
    /// Its number.
    pub index: usize,
    /// Its buffers.
    pub workspace: W,
    /// Time that it spent in units.
    pub busy: Duration,
}

/// Those who look on.
pub(crate) struct Audience<'a> {
    /// Where workers note what they have in hand.
    pub progress: &'a Progress,
    /// Who hears of what is done.
    pub watch: Option<&'a Watch>,
}

impl Audience<'_> {
    /// Tells a fact if someone watches.
    pub(crate) fn tell(&self, event: impl FnOnce() -> Event) {
        if let Some(watch) = self.watch {
            watch.tell(event());
        }
    }
}

impl Unit<'_> {
    /// Does the work; or says what the panic said.
    pub(crate) fn perform<W>(
        self,
        worker: &mut Worker<W>,
        audience: &Audience,
        advance: &impl Fn(&mut Tile, Samples, &mut W, &AtomicU64) -> Work,
    ) -> Result<(), String> {
        let samples = self.tile.area.pixels() as u64 * u64::from(self.until - self.tile.samples());
        let begun = Instant::now();
        let counter = audience.progress.begin(worker.index, self.index, samples, begun);
        let work = catch_unwind(AssertUnwindSafe(|| {
            advance(self.tile, (self.until, self.weight), &mut worker.workspace, counter)
        }));
        audience.progress.end(worker.index);
        let elapsed = begun.elapsed();
        worker.busy += elapsed;
        let done = Done { samples, elapsed, work: work.map_err(message)? };
        let told = self.record.rejected.first.len();
        self.record.add(&done);
        if let Some(watch) = audience.watch {
            self.tell(watch, worker.index, &done, told);
        }
        Ok(())
    }

    /// Tells what was done, and of the rejected samples after the first `told`.
    fn tell(&self, watch: &Watch, worker: usize, done: &Done, told: usize) {
        for rejected in &self.record.rejected.first[told..] {
            watch.tell(Event::SampleRejected(*rejected));
        }
        watch.tell(Event::TileFinished {
            tile: self.index,
            area: self.tile.area,
            pass: self.pass,
            worker,
            elapsed: done.elapsed,
            rays: done.work.rays,
            samples: done.samples,
            rejected: done.work.rejected.len() as u64,
            pixels: watch.wants_picture().then(|| picture(self.tile)),
        });
    }
}

/// The tile's linear radiance so far.
fn picture(tile: &Tile) -> Box<[[f32; 3]]> {
    tile.pixels.iter().map(|pixel| pixel.mean(&tile.counts).map(|value| value as f32)).collect()
}

/// What a panic said.
fn message(panic: Box<dyn Any + Send>) -> String {
    match panic.downcast::<String>() {
        Ok(text) => *text,
        Err(panic) => panic.downcast_ref::<&str>().map_or("no message", |text| text).to_owned(),
    }
}
