//! Renders by a renderer whose radiance is known.

use std::panic::resume_unwind;
use std::sync::atomic::Ordering::Relaxed;

use crossbeam::channel::{Receiver, bounded, unbounded};
use smalti_core::film::{Counts, Image};
use smalti_core::render::{RayCounts, Rejected};
use smalti_core::settings::Rect;

use super::*;
use crate::pool;

const AREA: Rect = Rect { x: 3, y: 5, width: 21, height: 17 };

/// A renderer whose radiance is a function of pixel and sample; every seventh sample of row 9 is not finite.
fn fake(tile: &mut Tile, (until, _): Samples, _: &mut (), done: &AtomicU64) -> Work {
    let mut work = Work::default();
    let before = tile.samples();
    for sample in before..until {
        for index in 0..tile.pixels.len() as u32 {
            let pixel = (tile.area.x + index % tile.area.width, tile.area.y + index / tile.area.width);
            let radiance = [pixel.0 as f32, pixel.1 as f32, 1.0 / (sample + 1) as f32];
            tile.pixels[index as usize].add(tile.counts.batch(), 1.0, radiance);
            if pixel.1 == 9 && sample % 7 == 0 {
                work.rejected.push(Rejected { pixel, sample });
            }
            done.fetch_add(1, Relaxed);
        }
        tile.counts.add_plain();
    }
    let added = u64::from(until - before) * tile.pixels.len() as u64;
    work.rays = RayCounts { camera: added, scattered: 2 * added, shadow: 3 * added };
    work.capped = 1;
    work
}

type Fake<'a> = &'a (dyn Fn(&mut Tile, Samples, &mut (), &AtomicU64) -> Work + Sync);

fn run(spp: u32, film: Film, threads: usize, watch: Option<Watch>, advance: Fake) -> Result<Outcome, Panicked> {
    run_until(&Cancel::default(), spp, film, threads, watch, advance)
}

fn run_until(
    cancel: &Cancel,
    spp: u32,
    film: Film,
    threads: usize,
    watch: Option<Watch>,
    advance: Fake,
) -> Result<Outcome, Panicked> {
    let pool = pool(threads).unwrap();
    perform(
        &Job {
            goal: &Goal::default(),
            spp,
            seed: 42,
            pool: &pool,
            cancel,
            workspace: &|| (),
            emit: None,
            advance: &advance,
        },
        film,
        watch,
    )
}

fn facts(events: &Receiver<Event>) -> Vec<Event> {
    events.try_iter().collect()
}

fn image(outcome: Outcome) -> Image {
    outcome.film.develop()
}

#[test]
fn threads_and_tiles_change_no_bit_and_no_count() {
    let one = run(40, Film::new(AREA, 64), 1, None, &fake).unwrap();
    for (threads, tile) in [(1, 8), (2, 5), (5, 1)] {
        let many = run(40, Film::new(AREA, tile), threads, None, &fake).unwrap();
        assert_eq!((many.samples, many.rays), (one.samples, one.rays));
        assert_eq!(many.rejected, one.rejected);
        assert_eq!(image(many), image(one.clone()));
    }
}

#[test]
fn the_account_adds_up() {
    let outcome = run(40, Film::new(AREA, 8), 2, None, &fake).unwrap();
    let samples = 21 * 17 * 40;
    assert_eq!(outcome.samples, samples);
    assert_eq!(outcome.rays, RayCounts { camera: samples, scattered: 2 * samples, shadow: 3 * samples });
    // 7 passes (1, 2, 4, 8, 16, 32, 40) of 9 tiles, each capped once; samples 0, 7 ... 35 of 21 pixels.
    assert_eq!((outcome.timing.passes, outcome.capped, outcome.rejected.count), (7, 7 * 9, 6 * 21));
    assert_eq!(outcome.rejected.first[0], Rejected { pixel: (3, 9), sample: 0 });
    assert_eq!(outcome.rejected.first[99], Rejected { pixel: (18, 9), sample: 28 });
    assert_eq!((outcome.timing.tiles.len(), outcome.timing.workers.len()), (9, 2));
    assert!(!outcome.interrupted);
}

#[test]
fn facts_come_in_order() {
    let (sender, events) = unbounded();
    run(5, Film::new(AREA, 8), 3, Some(Watch::new(sender)), &fake).unwrap();
    let facts = facts(&events);
    assert!(matches!(&facts[0], Event::Started { tiles, until: Some(5), samples: Some(1785), .. } if tiles.len() == 9));
    assert!(matches!(facts.last(), Some(Event::Finished { interrupted: false, .. })));
    let (mut tiles, mut ends) = (0, Vec::new());
    for fact in &facts {
        match fact {
            Event::TileFinished { pass, worker, pixels, .. } => {
                assert_eq!((*pass as usize, pixels.is_none(), *worker < 3), (tiles / 9, true, true));
                tiles += 1;
            }
            Event::PassFinished { pass, samples, .. } => {
                assert_eq!(9 * (pass + 1), tiles as u32);
                ends.push(*samples);
            }
            _ => {}
        }
    }
    assert_eq!(ends, [1, 2, 4, 5]);
    assert_eq!(facts.iter().filter(|fact| matches!(fact, Event::SampleRejected(_))).count(), 21);
}

#[test]
fn pictures_are_means_and_left_out_for_a_watcher_that_is_far_behind() {
    let (sender, events) = unbounded();
    let watch = Watch { pictures: true, ..Watch::new(sender) };
    run(2000, Film::new(AREA, 4), 1, Some(watch), &fake).unwrap();
    let pictures = facts(&events).into_iter().filter_map(|fact| match fact {
        Event::TileFinished { area, pixels, .. } => Some((area, pixels)),
        _ => None,
    });
    let pictures: Vec<_> = pictures.collect();
    let (area, first) = &pictures[0];
    assert_eq!(first.as_ref().unwrap().len(), area.pixels());
    assert_eq!(first.as_ref().unwrap()[5], [4.0, 6.0, 1.0]);
    // Units by the thousand, and nobody listened.
    assert!(pictures.len() > 2000 && pictures[2000].1.is_none());
}

#[test]
fn the_error_is_judged_when_the_samples_have_doubled() {
    let (sender, events) = unbounded();
    let error = Box::new(|film: &Film| Some(f64::from(film.samples().0)).filter(|samples| *samples >= 32.0));
    run(160, Film::new(AREA, 8), 2, Some(Watch { error: Some(error), ..Watch::new(sender) }), &fake).unwrap();
    let told = facts(&events).into_iter().filter_map(|fact| match fact {
        Event::PassFinished { samples, error, .. } => Some((samples, error)),
        _ => None,
    });
    let judged: Vec<_> = told.filter_map(|(samples, error)| Some((samples, error?))).collect();
    assert_eq!(judged, [(32, 32.0), (64, 64.0), (128, 128.0)]);
}

#[test]
fn a_watcher_that_leaves_or_is_full_stops_nothing() {
    let (gone, _) = unbounded();
    let (full, _events) = bounded(1);
    for sender in [gone, full] {
        let outcome = run(3, Film::new(AREA, 8), 2, Some(Watch::new(sender)), &fake).unwrap();
        assert_eq!(outcome.film.samples(), (3, 3));
    }
}

#[test]
fn cancel_finishes_what_runs_and_begins_nothing() {
    let (sender, events) = unbounded();
    let (cancel, units) = (Cancel::default(), AtomicU64::new(0));
    let advance = |tile: &mut Tile, until: Samples, workspace: &mut (), done: &AtomicU64| {
        // In the middle of the third pass.
        if units.fetch_add(1, Relaxed) == 9 + 9 + 4 {
            cancel.cancel();
        }
        fake(tile, until, workspace, done)
    };
    let outcome = run_until(&cancel, 64, Film::new(AREA, 8), 1, Some(Watch::new(sender)), &advance).unwrap();
    assert_eq!((units.load(Relaxed), outcome.film.samples(), outcome.interrupted), (23, (2, 4), true));
    assert_eq!((outcome.timing.passes, outcome.film.tiles.iter().filter(|tile| tile.samples() == 4).count()), (2, 5));
    assert!(matches!(facts(&events).last(), Some(Event::Finished { interrupted: true, .. })));
}

#[test]
fn an_interrupted_film_is_continued_to_the_same_bits() {
    let cancel = Cancel::default();
    let advance = |tile: &mut Tile, until: Samples, workspace: &mut (), done: &AtomicU64| {
        if until.0 == 8 && tile.area.x > 10 {
            cancel.cancel();
        }
        fake(tile, until, workspace, done)
    };
    let half = run_until(&cancel, 50, Film::new(AREA, 4), 2, None, &advance).unwrap();
    assert!(half.interrupted);
    let rest = run(50, half.film, 2, None, &fake).unwrap();
    assert_eq!(half.samples + rest.samples, 21 * 17 * 50);
    assert_eq!(image(rest), image(run(50, Film::new(AREA, 4), 1, None, &fake).unwrap()));
}

#[test]
fn a_panic_becomes_an_error_with_its_place() {
    for threads in [1, 3] {
        let begun = AtomicU64::new(0);
        let advance = |tile: &mut Tile, until: Samples, workspace: &mut (), done: &AtomicU64| {
            begun.fetch_add(1, Relaxed);
            if until.0 == 4 && (tile.area.x, tile.area.y) == (11, 5) {
                resume_unwind(Box::new("a hole in the sphere".to_owned()));
            }
            fake(tile, until, workspace, done)
        };
        let (sender, events) = unbounded();
        let watch = Some(Watch::new(sender));
        let panicked = run(64, Film::new(AREA, 8), threads, watch, &advance).unwrap_err();
        assert_eq!((panicked.tile, panicked.samples, panicked.seed), (1, 2..4, 42));
        assert_eq!(panicked.area, Rect { x: 11, y: 5, width: 8, height: 8 });
        assert_eq!(panicked.message, "a hole in the sphere");
        assert!(begun.load(Relaxed) <= 27, "no pass was begun after the panic");
        assert!(!facts(&events).iter().any(|fact| matches!(fact, Event::Finished { .. })));
    }
}

#[test]
fn slow_tiles_are_handed_out_first() {
    let mut film = Film::new(AREA, 8);
    film.tiles[3].counts = Counts::of(8);
    let mut records = vec![Record::default(); film.tiles.len()];
    records[7].last = Duration::from_millis(5);
    records[2].last = Duration::from_millis(9);
    records[3].last = Duration::from_millis(99);
    let goal = Goal::default();
    let course = Course::new(&goal, 8, false, (0, Instant::now()));
    let order: Vec<_> =
        units(&mut film, &mut records, (0, Step::Until(8)), &course).iter().map(|unit| unit.index).collect();
    assert_eq!(order, [2, 7, 0, 1, 4, 5, 6, 8]);
}

#[test]
fn nothing_to_do_is_done_at_once() {
    let empty = Film::new(Rect::default(), 8);
    let outcome = run(4, empty, 2, None, &|_, _, _, _| panic!("there is no unit")).unwrap();
    assert_eq!((outcome.samples, outcome.interrupted, outcome.timing.passes), (0, false, 0));
    let full = run(4, Film::new(AREA, 8), 2, None, &fake).unwrap().film;
    let outcome = run(4, full, 2, None, &|_, _, _, _| panic!("there is no unit")).unwrap();
    assert_eq!((outcome.samples, outcome.film.samples()), (0, (4, 4)));
}
