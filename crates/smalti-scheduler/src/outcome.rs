//! What a render leaves behind.

use std::ops::Range;
use std::time::Duration;

use smalti_core::film::Film;
use smalti_core::photon::Account;
use smalti_core::render::{RayCounts, Rejected};
use smalti_core::settings::Rect;

use crate::Stopped;

/// A film and the account of how it came about.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The film. After an interruption the tiles may differ in their samples.
    pub film: Film,
    /// Whether someone stopped it before its goal.
    pub interrupted: bool,
    /// Why it stopped.
    pub stopped: Stopped,
    /// Samples that every pixel had after the last pass that was finished; a mean where tiles take more or fewer.
    pub mean_samples: u32,
    /// Samples (camera paths) that were added, over all pixels.
    pub samples: u64,
    /// Rays traced.
    pub rays: RayCounts,
    /// Samples that were not finite.
    pub rejected: Rejections,
    /// Paths that the hard cap on bounces ended.
    pub capped: u64,
    /// What the photons of all rounds came to.
    pub photons: Photons,
    /// Where the time went.
    pub timing: Timing,
}

/// What photons came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Photons {
    /// Photons that were emitted, those that were sent ahead included.
    pub emitted: u64,
    /// Photons that are in the maps.
    pub stored: u64,
    /// Photons that were not finite and were left out.
    pub nonfinite: u64,
    /// Bytes of the maps; of several rounds the most.
    pub bytes: u64,
    /// Where the light went of those in the maps, in the frame's units.
    pub account: Account,
    /// How far they count, the least and the most, in the frame.
    pub radii: Option<[f32; 2]>,
    /// Time to emit, trace and build.
    pub elapsed: Duration,
}

impl Photons {
    /// Adds those of another round.
    pub(crate) fn add(&mut self, other: &Self) {
        self.emitted += other.emitted;
        self.stored += other.stored;
        self.nonfinite += other.nonfinite;
        self.bytes = self.bytes.max(other.bytes);
        self.account += &other.account;
        let wider = |a: [f32; 2], b: [f32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        self.radii = self.radii.into_iter().chain(other.radii).reduce(wider);
        self.elapsed += other.elapsed;
    }
}

/// Samples that were not finite.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rejections {
    /// How many there were.
    pub count: u64,
    /// The first ones: by sample, then by row and column.
    pub first: Vec<Rejected>,
}

impl Rejections {
    /// Rejections that are kept one by one.
    pub const KEPT: usize = 100;

    /// Adds `more`, of which `count` were counted.
    pub(crate) fn add(&mut self, count: u64, more: &[Rejected]) {
        self.count += count;
        self.first.extend_from_slice(more);
        self.first.sort_by_key(|rejected| (rejected.sample, rejected.pixel.1, rejected.pixel.0));
        self.first.truncate(Self::KEPT);
    }
}

/// Where the time of a render went.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timing {
    /// From the first unit to the last.
    pub elapsed: Duration,
    /// The part of it in which photons were emitted and their maps built, by all workers; no tile is worked on then.
    pub photons: Duration,
    /// Passes that every tile completed.
    pub passes: u32,
    /// Time spent in each tile, over all passes.
    pub tiles: Vec<(Rect, Duration)>,
    /// Time that each worker spent in units.
    pub workers: Vec<Duration>,
}

/// How evenly the tiles share the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Balance {
    /// Time of the quickest tile.
    pub min: Duration,
    /// Time of the tile in the middle (the upper one of two).
    pub median: Duration,
    /// Time of the slowest tile.
    pub max: Duration,
    /// The slowest tile; the first of several.
    pub slowest: Rect,
}

impl Timing {
    /// How evenly the tiles share the work; `None` without tiles.
    pub fn balance(&self) -> Option<Balance> {
        let mut times: Vec<_> = self.tiles.iter().map(|tile| tile.1).collect();
        times.sort_unstable();
        let max = *times.last()?;
        let slowest = self.tiles.iter().find(|tile| tile.1 == max)?.0;
        Some(Balance { min: times[0], median: times[times.len() / 2], max, slowest })
    }

    /// The share of the time for tiles, in [0, 1], that each worker spent waiting.
    pub fn idle(&self) -> Vec<f64> {
        let all = self.elapsed.saturating_sub(self.photons).as_secs_f64();
        let idle = |busy: &Duration| if all > 0.0 { 1.0 - busy.as_secs_f64() / all } else { 0.0 };
        self.workers.iter().map(|busy| idle(busy).clamp(0.0, 1.0)).collect()
    }
}

/// A worker panicked: a bug of ours. The picture is lost, the place is not.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a worker panicked in tile {tile} (x {}..{}, y {}..{}), samples {}..{}, seed {seed}: {message}",
    area.x, area.x + area.width, area.y, area.y + area.height, samples.start, samples.end
)]
pub struct Panicked {
    /// Index of the tile.
    pub tile: usize,
    /// Its place in the whole image.
    pub area: Rect,
    /// The samples of each pixel that the unit was to add.
    pub samples: Range<u32>,
    /// The seed of the render.
    pub seed: u64,
    /// What the panic said.
    pub message: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rect(x: u32) -> Rect {
        Rect { x, y: 0, width: 8, height: 8 }
    }

    #[test]
    fn balance_names_the_extremes_and_the_middle() {
        let tiles = [30, 10, 40, 20, 40].map(Duration::from_millis);
        let timing = Timing { tiles: (0..).map(rect).zip(tiles).collect(), ..Timing::default() };
        let balance = timing.balance().unwrap();
        assert_eq!((balance.min, balance.median, balance.max), (tiles[1], tiles[0], tiles[2]));
        assert_eq!(balance.slowest, rect(2));
        assert_eq!(Timing::default().balance(), None);
    }

    #[test]
    fn idle_is_what_is_not_busy() {
        let workers = vec![Duration::from_secs(3), Duration::from_secs(5)];
        let [elapsed, photons] = [6, 2].map(Duration::from_secs);
        let timing = Timing { elapsed, photons, workers, ..Timing::default() };
        assert_eq!(timing.idle(), [0.25, 0.0]);
    }

    #[test]
    fn the_first_rejections_are_kept_whatever_the_order() {
        let rejected = |n: u32| Rejected { pixel: (n % 7, n / 7), sample: 0 };
        let mut kept = Rejections::default();
        for n in (0..300).rev() {
            kept.add(1, &[rejected(n)]);
        }
        assert_eq!(kept.count, 300);
        assert_eq!(kept.first, (0..100).map(rejected).collect::<Vec<_>>());
    }

    #[test]
    fn a_panic_names_its_place() {
        let area = Rect { x: 32, y: 64, width: 16, height: 8 };
        let panicked = Panicked { tile: 5, area, samples: 4..8, seed: 7, message: "index 9".into() };
        assert_eq!(
            panicked.to_string(),
            "a worker panicked in tile 5 (x 32..48, y 64..72), samples 4..8, seed 7: index 9"
        );
    }
}
