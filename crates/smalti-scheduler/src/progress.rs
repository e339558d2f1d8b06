//! What each worker does at the moment, for a display: relaxed atomics that no worker ever waits for.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

use crossbeam::utils::CachePadded;

/// A look at what the workers are doing. Figures of one worker may be a moment apart from each other.
#[derive(Debug)]
pub struct Progress {
    start: Instant,
    slots: Vec<CachePadded<Slot>>,
    /// Photons of the round that were traced.
    photons: AtomicU64,
}

/// The unit that a worker has in hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Current {
    /// Index of the tile.
    pub tile: usize,
    /// Samples (camera paths) that the unit has finished.
    pub done: u64,
    /// Samples of the unit in all.
    pub total: u64,
    /// Time since the unit was begun.
    pub elapsed: Duration,
}

/// One worker's line in the book; on a cache line of its own.
#[derive(Debug, Default)]
struct Slot {
    /// Index of the tile plus one; 0: idle.
    tile: AtomicU64,
    done: AtomicU64,
    total: AtomicU64,
    /// Nanoseconds from the start of the render to the start of the unit.
    begun: AtomicU64,
}

impl Progress {
    /// A book for `workers` idle workers; time counts from `start`.
    pub fn new(workers: usize, start: Instant) -> Self {
        Self { start, slots: (0..workers).map(|_| CachePadded::default()).collect(), photons: AtomicU64::new(0) }
    }

    /// Number of workers.
    pub fn workers(&self) -> usize {
        self.slots.len()
    }

    /// Photons of the round that were traced.
    pub fn photons(&self) -> u64 {
        self.photons.load(Relaxed)
    }

    /// Notes that photons set out; returns the counter of those that were traced.
    pub(crate) fn emit(&self) -> &AtomicU64 {
        self.photons.store(0, Relaxed);
        &self.photons
    }

    /// When the render began.
    pub fn start(&self) -> Instant {
        self.start
    }

    /// What `worker` has in hand at `now`; `None` while it is idle.
    pub fn current(&self, worker: usize, now: Instant) -> Option<Current> {
        let slot = &self.slots[worker];
        let tile = slot.tile.load(Relaxed).checked_sub(1)? as usize;
        let total = slot.total.load(Relaxed);
        let begun = Duration::from_nanos(slot.begun.load(Relaxed));
        let elapsed = now.saturating_duration_since(self.start).saturating_sub(begun);
        Some(Current { tile, done: slot.done.load(Relaxed).min(total), total, elapsed })
    }

    /// Samples that the units in hand have finished.
    pub fn in_hand(&self) -> u64 {
        let busy = self.slots.iter().filter(|slot| slot.tile.load(Relaxed) > 0);
        busy.map(|slot| slot.done.load(Relaxed).min(slot.total.load(Relaxed))).sum()
    }

    /// Notes that `worker` began a unit of `total` samples; returns the counter of those that are done.
    pub fn begin(&self, worker: usize, tile: usize, total: u64, now: Instant) -> &AtomicU64 {
        let slot = &self.slots[worker];
        slot.done.store(0, Relaxed);
        slot.total.store(total, Relaxed);
        slot.begun.store(now.saturating_duration_since(self.start).as_nanos() as u64, Relaxed);
        slot.tile.store(tile as u64 + 1, Relaxed);
        &slot.done
    }

    /// Notes that `worker` has nothing in hand.
    pub fn end(&self, worker: usize) {
        self.slots[worker].tile.store(0, Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_worker_is_idle_then_busy_then_idle() {
        let start = Instant::now();
        let progress = Progress::new(2, start);
        assert_eq!(progress.current(1, start), None);
        let done = progress.begin(1, 0, 100, start + Duration::from_millis(5));
        done.fetch_add(30, Relaxed);
        let current = progress.current(1, start + Duration::from_millis(9)).unwrap();
        assert_eq!(current, Current { tile: 0, done: 30, total: 100, elapsed: Duration::from_millis(4) });
        assert_eq!(progress.current(0, start), None);
        assert_eq!(progress.in_hand(), 30);
        progress.end(1);
        assert_eq!((progress.current(1, start), progress.in_hand()), (None, 0));
    }

    #[test]
    fn a_unit_never_looks_more_than_done_nor_older_than_the_render() {
        let start = Instant::now();
        let progress = Progress::new(1, start);
        progress.begin(0, 3, 10, start + Duration::from_secs(1)).fetch_add(11, Relaxed);
        let current = progress.current(0, start).unwrap();
        assert_eq!((current.done, current.elapsed), (10, Duration::ZERO));
    }
}
