//! A small render to test with: its facts, without a clock and without a renderer.

use std::sync::Arc;
use std::time::{Duration, Instant};

use smalti_core::film::Film;
use smalti_core::render::{RayCounts, Rejected};
use smalti_core::settings::Rect;
use smalti_scheduler::{Event, Progress, Timing};

use super::tally::Tally;
use super::{Goal, Title};

/// The part of the image that is rendered.
pub const AREA: Rect = Rect { x: 10, y: 20, width: 64, height: 64 };

/// What is rendered.
pub fn title() -> Title {
    Title {
        scene: "scenes/a room with a rather long name.toml".into(),
        size: (64, 64),
        goal: Goal::samples(64),
        integrator: "path",
        threads: 2,
        level: "avx2",
        setup: Duration::from_millis(120),
        exposure: 0.0,
        pictures: true,
    }
}

/// The facts of the first pass: 16 tiles, 10 ms and 100 000 rays each.
pub fn first_pass(workers: usize) -> Vec<Event> {
    let tiles: Vec<Rect> = Film::new(AREA, 16).tiles.iter().map(|tile| tile.area).collect();
    let finished = |(tile, area): (usize, &Rect)| Event::TileFinished {
        tile,
        area: *area,
        pass: 0,
        worker: tile % workers,
        elapsed: Duration::from_millis(10),
        rays: RayCounts { camera: 256, scattered: 50_000, shadow: 49_744 },
        samples: 256,
        rejected: 0,
        pixels: Some(vec![[0.5; 3]; area.pixels()].into()),
    };
    let mut facts: Vec<_> = tiles.iter().enumerate().map(finished).collect();
    let progress = Arc::new(Progress::new(workers, Instant::now()));
    facts.insert(
        0,
        Event::Started { area: AREA, tiles, from: 0, until: Some(64), samples: Some(64 * 64 * 64), progress },
    );
    let rejected = Rejected { pixel: (12, 30), sample: 0 };
    facts.push(Event::SampleRejected(rejected));
    facts.push(Event::PassFinished {
        pass: 0,
        samples: 1,
        foreseen: Some(64),
        elapsed: Duration::from_millis(80),
        error: Some(0.0213),
    });
    facts
}

/// The last fact.
pub fn finished(interrupted: bool) -> Event {
    let tiles =
        Film::new(AREA, 16).tiles.iter().zip(1..).map(|(tile, n)| (tile.area, Duration::from_millis(n))).collect();
    let workers = vec![Duration::from_millis(990), Duration::from_millis(700)];
    let timing = Timing { elapsed: Duration::from_secs(1), passes: 7, tiles, workers, ..Timing::default() };
    Event::Finished { interrupted, timing }
}

/// What is known half-way: at 20 s half of the samples are done, worker 0 has a tile in hand, the others wait.
pub fn half_way(workers: usize) -> Tally {
    let mut tally = Tally::default();
    for fact in first_pass(workers) {
        if let Event::Started { progress, .. } = &fact {
            progress.begin(0, 5, 1000, progress.start());
        }
        tally.hear(&fact);
    }
    tally.done = tally.total.unwrap() / 2;
    for second in 0..=20 {
        tally.pace.note(Duration::from_secs(second), tally.done * second / 20);
    }
    tally.workers[0].current =
        Some(smalti_scheduler::Current { tile: 5, done: 500, total: 1000, elapsed: Duration::from_millis(45) });
    tally.elapsed = Duration::from_secs(20);
    tally
}
