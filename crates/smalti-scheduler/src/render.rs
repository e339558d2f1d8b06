//! A render from the first pass to the last.

use std::cmp::Reverse;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, RwLock};
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use smalti_core::film::{Film, ROUND, Tile};
use smalti_core::photon::{Account, Maps};
use smalti_core::render::{Renderer, Work};

use crate::account::{Record, outcome};
use crate::course::{Course, Step};
use crate::unit::{Audience, Samples, Unit, Worker};
use crate::{Cancel, Event, Goal, Outcome, Panicked, Photons, Progress, Shelf, Stopped, Timing, Watch};

/// Adds samples to `film` until every pixel has as many as the renderer's settings ask for, on all workers of `pool`.
/// A film that has samples already is continued.
///
/// # Errors
/// A worker panicked.
pub fn render(
    renderer: &Renderer,
    film: Film,
    pool: &ThreadPool,
    cancel: &Cancel,
    watch: Option<Watch>,
) -> Result<Outcome, Panicked> {
    render_to(&Goal::default(), renderer, film, (pool, cancel), watch, None)
}

/// [`render`] with photon maps from a shelf, as far as they are there; the others are put there. The image is the same.
///
/// # Errors
/// A worker panicked.
pub fn render_with(
    renderer: &Renderer,
    film: Film,
    pool: &ThreadPool,
    cancel: &Cancel,
    watch: Option<Watch>,
    shelf: Option<&dyn Shelf>,
) -> Result<Outcome, Panicked> {
    render_to(&Goal::default(), renderer, film, (pool, cancel), watch, shelf)
}

/// [`render_with`] that stops at a goal.
///
/// Where samples go where the noise is, the film's tiles should be [`ADAPTIVE_TILE`](crate::ADAPTIVE_TILE) pixels wide and
/// high.
///
/// # Errors
/// A worker panicked.
pub fn render_to(
    goal: &Goal,
    renderer: &Renderer,
    film: Film,
    (pool, cancel): (&ThreadPool, &Cancel),
    watch: Option<Watch>,
    shelf: Option<&dyn Shelf>,
) -> Result<Outcome, Panicked> {
    let maps: RwLock<Option<Maps>> = RwLock::new(None);
    let none = Maps::default();
    let emit = |round, told: &dyn Fn(u64), done: &AtomicU64| {
        let pilots = maps.read().unwrap_or_else(PoisonError::into_inner).as_ref().map(Maps::pilots);
        // The last round's photons make room before the next ones are there.
        *maps.write().unwrap_or_else(PoisonError::into_inner) = None;
        let kept = shelf.and_then(|shelf| shelf.take(round));
        let made = kept.and_then(|(kept, pilots)| renderer.maps_from(kept, &pilots)).unwrap_or_else(|| {
            told(renderer.photons_of_round(pilots.is_none()));
            let made = pool.install(|| renderer.maps(round, pilots.unwrap_or_default(), done));
            shelf.inspect(|shelf| shelf.put(&made));
            made
        });
        let (account, bytes, radii) = (made.account(), made.bytes(), made.radii());
        *maps.write().unwrap_or_else(PoisonError::into_inner) = Some(made);
        let Account { kept: stored, nonfinite, .. } = account;
        Photons { stored, nonfinite, bytes, account, radii, ..Photons::default() }
    };
    let job = Job {
        goal,
        spp: goal.spp.unwrap_or(renderer.settings().spp),
        seed: renderer.settings().seed,
        pool,
        cancel,
        workspace: &|| renderer.workspace(),
        emit: renderer.plan().photons.is_some().then_some(&emit),
        advance: &|tile: &mut Tile, (until, weight): Samples, workspace: &mut _, done: &_| {
            let maps = maps.read().unwrap_or_else(PoisonError::into_inner);
            let maps = maps.as_ref().unwrap_or(&none);
            match weight {
                None => renderer.advance(tile, until, maps, workspace, done),
                Some(weight) => renderer.visit(tile, (until - tile.samples(), weight), maps, workspace, done),
            }
        },
    };
    perform(&job, film, watch)
}

/// What is to be done and by whom; `workspace` and `advance` are the renderer's, or a test's.
struct Job<'a, F, A> {
    goal: &'a Goal<'a>,
    /// Samples a pixel at most.
    spp: u32,
    seed: u64,
    pool: &'a ThreadPool,
    cancel: &'a Cancel,
    workspace: &'a F,
    /// Emits the photons of a round, where each round has its own.
    emit: Option<&'a Emit<'a>>,
    advance: &'a A,
}

/// Emits the photons of a round: tells how many there will be, counts them as they are traced, and says what is stored.
type Emit<'a> = dyn Fn(u32, &dyn Fn(u64), &AtomicU64) -> Photons + Sync + 'a;

/// The workers of a render; each is locked by its own thread alone, so nobody ever waits for a lock.
type Crew<W> = Vec<Mutex<Worker<W>>>;

/// Performs `job`.
fn perform<W: Send>(
    job: &Job<impl Fn() -> W + Sync, impl Fn(&mut Tile, Samples, &mut W, &AtomicU64) -> Work + Sync>,
    mut film: Film,
    watch: Option<Watch>,
) -> Result<Outcome, Panicked> {
    let crew: Crew<W> = job.pool.broadcast(|thread| {
        Mutex::new(Worker { index: thread.index(), workspace: (job.workspace)(), busy: Duration::ZERO })
    });
    let mut records = vec![Record::default(); film.tiles.len()];
    let progress = Arc::new(Progress::new(crew.len(), Instant::now()));
    let audience = Audience { progress: &progress, watch: watch.as_ref() };
    // Where there is no tile, there is nothing to do.
    let from = if film.tiles.is_empty() { job.spp } else { film.samples().0 };
    let mut course = Course::new(job.goal, job.spp, job.emit.is_some(), (from, progress.start()));
    audience.tell(|| started(&film, course.foreseen(), &progress));
    let (passes, photons, stopped) = run_passes(job, &mut film, &mut records, (&crew, &mut course), &audience)?;
    let elapsed = [progress.start().elapsed(), photons.elapsed];
    let timing = timing(&film, &records, crew, elapsed, passes);
    let outcome = outcome(film, (stopped, course.samples()), records, photons, timing);
    audience.tell(|| Event::Finished { interrupted: outcome.interrupted, timing: outcome.timing.clone() });
    Ok(outcome)
}

/// Performs passes until the goal is reached or someone cancels; returns how many were completed, what the photons came
/// to, and why it stopped.
fn run_passes<W: Send>(
    job: &Job<impl Sync, impl Fn(&mut Tile, Samples, &mut W, &AtomicU64) -> Work + Sync>,
    film: &mut Film,
    records: &mut [Record],
    (crew, course): (&Crew<W>, &mut Course),
    audience: &Audience,
) -> Result<(u32, Photons, Stopped), Panicked> {
    let mut pass = 0;
    let mut judged = 0;
    let mut emitted = Emitted::default();
    let stopped = loop {
        let step = match course.next(film, records) {
            Ok(step) => step,
            Err(why) => break why,
        };
        let emission = job.emit.and_then(|emit| emitted.enter(course.samples() / ROUND, emit, audience));
        let begun = Instant::now();
        let done = run_pass(job, units(film, records, (pass, step), course), crew, audience)?;
        if !done {
            break Stopped::Cancelled;
        }
        course.note(step, begun.elapsed(), emission);
        audience.tell(|| {
            let (samples, foreseen) = (course.samples(), course.foreseen());
            let error = judge(audience.watch, film, samples, foreseen, &mut judged);
            let elapsed = audience.progress.start().elapsed();
            Event::PassFinished { pass, samples, foreseen, elapsed, error }
        });
        pass += 1;
    };
    Ok((pass, emitted.all, stopped))
}

/// The photons so far.
#[derive(Default)]
struct Emitted {
    round: Option<u32>,
    all: Photons,
}

impl Emitted {
    /// Sees to it that the photons are those of `round`. Returns the time that it took, if they were not.
    fn enter(&mut self, round: u32, emit: &Emit, audience: &Audience) -> Option<Duration> {
        if self.round == Some(round) {
            return None;
        }
        self.round = Some(round);
        let begun = Instant::now();
        let progress = audience.progress;
        let told = |photons| audience.tell(|| Event::PhotonsEmitted { round, photons });
        let photons = emit(round, &told, progress.emit());
        let photons = Photons { elapsed: begun.elapsed(), emitted: progress.photons(), ..photons };
        self.all.add(&photons);
        audience.tell(|| Event::PhotonsStored { round, photons });
        Some(photons.elapsed)
    }
}

/// Performs `units` in their order, as workers become free. Stops handing out when someone cancels or panics. Returns
/// whether all were done.
fn run_pass<W: Send>(
    job: &Job<impl Sync, impl Fn(&mut Tile, Samples, &mut W, &AtomicU64) -> Work + Sync>,
    units: Vec<Unit>,
    crew: &Crew<W>,
    audience: &Audience,
) -> Result<bool, Panicked> {
    let (panicked, left_out) = (OnceLock::new(), AtomicBool::new(false));
    job.pool.in_place_scope_fifo(|scope| {
        for unit in units {
            let (panicked, left_out) = (&panicked, &left_out);
            scope.spawn_fifo(move |_| {
                if job.cancel.is_cancelled() || panicked.get().is_some() {
                    left_out.store(true, Ordering::Relaxed);
                    return;
                }
                if let Err(place) = run_unit(job, unit, crew, audience) {
                    // Of several panics the first tells enough.
                    let _ = panicked.set(place);
                }
            });
        }
    });
    panicked.into_inner().map_or(Ok(!left_out.into_inner()), Err)
}

/// Performs `unit` on the thread that calls.
fn run_unit<W: Send>(
    job: &Job<impl Sync, impl Fn(&mut Tile, Samples, &mut W, &AtomicU64) -> Work + Sync>,
    unit: Unit,
    crew: &Crew<W>,
    audience: &Audience,
) -> Result<(), Panicked> {
    let (tile, area, samples) = (unit.index, unit.tile.area, unit.tile.samples()..unit.until);
    let thread = rayon::current_thread_index().expect("units run on the pool");
    let mut worker = crew[thread].lock().unwrap_or_else(PoisonError::into_inner);
    let panicked = |message| Panicked { tile, area, samples, seed: job.seed, message };
    unit.perform(&mut worker, audience, job.advance).map_err(panicked)
}

/// The units of a pass, the slowest of the pass before first: what is long must not begin last.
fn units<'a>(
    film: &'a mut Film,
    records: &'a mut [Record],
    (pass, step): (u32, Step),
    course: &Course,
) -> Vec<Unit<'a>> {
    let samples = |index: usize, tile: &Tile| match step {
        Step::Until(until) => (until, None),
        Step::More(more) => (tile.samples() + more, Some(1.0)),
        Step::Visit(visit) => {
            let (rounds, weight) = course.rounds(index, visit);
            (tile.samples() + rounds * ROUND, Some(weight))
        }
    };
    let tiles = film.tiles.iter_mut().zip(records).enumerate();
    let unit = |(index, (tile, record)): (usize, (&'a mut Tile, &'a mut Record))| {
        let (until, weight) = samples(index, tile);
        (until > tile.samples()).then_some(Unit { index, tile, record, pass, until, weight })
    };
    let mut units: Vec<_> = tiles.filter_map(unit).collect();
    units.sort_by_key(|unit| Reverse(unit.record.last));
    units
}

/// The error as the watcher judges it: where the samples have doubled since the last time, as each time costs the same,
/// and not at the end, where the error is stated from the whole film anyway.
fn judge(watch: Option<&Watch>, film: &Film, samples: u32, foreseen: Option<u32>, judged: &mut u32) -> Option<f64> {
    if samples < 2 * *judged || foreseen.is_some_and(|foreseen| samples >= foreseen) {
        return None;
    }
    *judged = samples;
    watch?.error.as_ref()?(film)
}

fn started(film: &Film, until: Option<u32>, progress: &Arc<Progress>) -> Event {
    let missing = |tile: &Tile, until: u32| tile.area.pixels() as u64 * u64::from(until.saturating_sub(tile.samples()));
    Event::Started {
        area: film.area,
        tiles: film.tiles.iter().map(|tile| tile.area).collect(),
        from: film.samples().0,
        until,
        samples: until.map(|until| film.tiles.iter().map(|tile| missing(tile, until)).sum()),
        progress: progress.clone(),
    }
}

fn timing<W>(film: &Film, records: &[Record], crew: Crew<W>, [elapsed, photons]: [Duration; 2], passes: u32) -> Timing {
    let busy = |worker: Mutex<Worker<W>>| worker.into_inner().unwrap_or_else(PoisonError::into_inner).busy;
    let tiles = film.tiles.iter().zip(records);
    Timing {
        elapsed,
        photons,
        passes,
        tiles: tiles.map(|(tile, record)| (tile.area, record.elapsed)).collect(),
        workers: crew.into_iter().map(busy).collect(),
    }
}

#[cfg(test)]
mod tests {
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
        assert!(
            matches!(&facts[0], Event::Started { tiles, until: Some(5), samples: Some(1785), .. } if tiles.len() == 9)
        );
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
        assert_eq!(
            (outcome.timing.passes, outcome.film.tiles.iter().filter(|tile| tile.samples() == 4).count()),
            (2, 5)
        );
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
}
