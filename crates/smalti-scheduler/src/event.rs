//! What happened: facts in the past tense, and who wants to hear them.

use std::sync::Arc;
use std::time::Duration;

use crossbeam::channel::Sender;
use smalti_core::film::Film;
use smalti_core::render::{RayCounts, Rejected};
use smalti_core::settings::Rect;

use crate::{Photons, Progress, Timing};

/// A fact about a render. Every fact of a pass comes before its `PassFinished`; `Finished` is the last, and missing
/// when a worker panicked.
#[derive(Clone, Debug)]
pub enum Event {
    /// The render began.
    Started {
        /// The part of the image that is rendered.
        area: Rect,
        /// Every tile's place; a tile's index elsewhere points into this.
        tiles: Vec<Rect>,
        /// Samples a pixel that the film had, in its least sampled tile.
        from: u32,
        /// Samples a pixel when it is done; `None` where that cannot be foreseen yet.
        until: Option<u32>,
        /// Samples (camera paths) to do, over all pixels; likewise.
        samples: Option<u64>,
        /// What each worker does at the moment.
        progress: Arc<Progress>,
    },
    /// Photons of a round set out; the book counts those that were traced.
    PhotonsEmitted {
        /// The round of samples that they serve, from 0.
        round: u32,
        /// How many.
        photons: u64,
    },
    /// The photon maps of a round were built.
    PhotonsStored {
        /// The round of samples that they serve, from 0.
        round: u32,
        /// What became of them.
        photons: Photons,
    },
    /// A unit of work was done.
    TileFinished {
        /// Index of the tile.
        tile: usize,
        /// Its place in the whole image.
        area: Rect,
        /// The pass, from 0.
        pass: u32,
        /// The worker that did it, from 0.
        worker: usize,
        /// Time that it took.
        elapsed: Duration,
        /// Rays traced for it.
        rays: RayCounts,
        /// Samples (camera paths) added, over all pixels of the tile.
        samples: u64,
        /// How many of them were not finite.
        rejected: u64,
        /// The tile's linear radiance so far, row by row; `None` unless pictures are wanted, or while the watcher is
        /// far behind.
        pixels: Option<Box<[[f32; 3]]>>,
    },
    /// A sample was not finite; it counts as 0. Told for the first ones of each tile; the outcome has their number.
    SampleRejected(Rejected),
    /// Every tile reached the end of a pass.
    PassFinished {
        /// The pass, from 0.
        pass: u32,
        /// Samples that every pixel has now, in the mean.
        samples: u32,
        /// Samples a pixel that it will come to; `None` where that cannot be foreseen yet.
        foreseen: Option<u32>,
        /// Time since the render began.
        elapsed: Duration,
        /// The watcher's own judgement of the error, where it made one.
        error: Option<f64>,
    },
    /// The render ended, complete or interrupted.
    Finished {
        /// Whether it was stopped before every pixel had its samples.
        interrupted: bool,
        /// Where the time went.
        timing: Timing,
    },
}

/// Someone who watches a render.
pub struct Watch {
    /// Where the facts go. Should be unbounded: a worker never waits, so what does not fit is lost.
    pub events: Sender<Event>,
    /// Whether finished tiles come with their pixels.
    pub pictures: bool,
    /// Judges the error of the film so far. Asked between passes, each time the number of samples has doubled; nobody
    /// renders meanwhile.
    pub error: Option<ErrorOf>,
}

/// Judges the error of a film; `None` where nothing can be said.
pub type ErrorOf = Box<dyn Fn(&Film) -> Option<f64> + Send + Sync>;

/// With more facts than this waiting, pictures are left out: a stopped terminal must not fill the memory.
const BACKLOG: usize = 1024;

impl Watch {
    /// A watcher of facts alone.
    pub fn new(events: Sender<Event>) -> Self {
        Self { events, pictures: false, error: None }
    }

    /// Tells a fact to whoever still listens.
    pub(crate) fn tell(&self, event: Event) {
        // A watcher that went away is no reason to stop rendering, and neither is one that is full.
        let _ = self.events.try_send(event);
    }

    /// Whether a picture would be looked at soon.
    pub(crate) fn wants_picture(&self) -> bool {
        self.pictures && self.events.len() < BACKLOG
    }
}
