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

/// [`render`] that stops at a goal, with photon maps from a shelf, as far as they are there; the others are put there. The
/// image is the same with a shelf and without.
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
mod tests;
