//! The account of a render, kept tile by tile so that no two workers write to the same place.

use std::time::Duration;

use smalti_core::film::{Film, Tile};
use smalti_core::render::{RayCounts, Work};

use crate::{Outcome, Photons, Rejections, Stopped, Timing};

/// What is known of a tile besides its pixels.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    /// Time of its last unit.
    pub last: Duration,
    /// Time of all units.
    pub elapsed: Duration,
    /// Samples added, over all pixels.
    pub samples: u64,
    /// Rays traced.
    pub rays: RayCounts,
    /// Samples that were not finite.
    pub rejected: Rejections,
    /// Paths that the hard cap ended.
    pub capped: u64,
}

/// What a unit came to.
pub(crate) struct Done {
    /// Samples added, over all pixels.
    pub samples: u64,
    /// Time that it took.
    pub elapsed: Duration,
    /// What the renderer says of it.
    pub work: Work,
}

impl Record {
    /// Rays of a sample of each pixel of `tile`, of all kinds; at least one a pixel.
    pub(crate) fn rays_a_sample(&self, tile: &Tile) -> f64 {
        let pixels = tile.pixels.len() as f64;
        let RayCounts { camera, scattered, shadow } = self.rays;
        ((camera + scattered + shadow) as f64 / self.samples.max(1) as f64).max(1.0) * pixels
    }

    /// Adds a unit.
    pub(crate) fn add(&mut self, done: &Done) {
        self.last = done.elapsed;
        self.elapsed += done.elapsed;
        self.samples += done.samples;
        self.rejected.add(done.work.rejected.len() as u64, &done.work.rejected);
        self.capped += done.work.capped;
        self.rays += done.work.rays;
    }
}

/// Adds up the records of all tiles.
pub(crate) fn outcome(
    film: Film,
    (stopped, mean_samples): (Stopped, u32),
    records: Vec<Record>,
    photons: Photons,
    timing: Timing,
) -> Outcome {
    let mut outcome = Outcome {
        interrupted: stopped == Stopped::Cancelled,
        stopped,
        mean_samples,
        film,
        samples: 0,
        rays: RayCounts::default(),
        rejected: Rejections::default(),
        capped: 0,
        photons,
        timing,
    };
    for record in records {
        outcome.samples += record.samples;
        outcome.capped += record.capped;
        outcome.rejected.add(record.rejected.count, &record.rejected.first);
        outcome.rays += record.rays;
    }
    outcome
}
