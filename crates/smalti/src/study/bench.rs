//! Where renders are timed: one at a time, nothing else meanwhile.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::time::Instant;

use rayon::ThreadPool;
use smalti_core::film::Film;
use smalti_core::render::Renderer;
use smalti_core::settings::Settings;
use smalti_scheduler::Outcome;

use super::way::Way;
use crate::budget::{self, Budget};
use crate::exit::Failure;
use crate::interrupt::Interrupt;
use crate::job::Job;
use crate::memory::{self, Need};
use crate::summary::{Developed, develop};

/// Renders ways of one scene.
pub struct Bench<'a> {
    /// The scene.
    pub job: &'a Job,
    /// Side of a tile in pixels.
    pub tile: u32,
    interrupt: &'a Interrupt,
    /// Workers, by their number: started once.
    pools: BTreeMap<usize, ThreadPool>,
}

/// Why there is no result.
#[derive(Debug)]
pub enum Halt {
    /// A signal asked for the end.
    Interrupted,
    /// Something went wrong.
    Failed(Failure),
}

impl From<Failure> for Halt {
    fn from(failure: Failure) -> Self {
        Halt::Failed(failure)
    }
}

/// What a render came to.
pub struct Rendered {
    /// What was rendered.
    pub settings: Settings,
    /// Times, rays and photons; without the film.
    pub outcome: Outcome,
    /// The image and what it states of itself.
    pub developed: Developed,
}

impl<'a> Bench<'a> {
    /// A bench without workers yet.
    pub fn new(job: &'a Job, tile: u32, interrupt: &'a Interrupt) -> Self {
        Self { job, tile, interrupt, pools: BTreeMap::new() }
    }

    /// Renders a way with a seed of its own.
    ///
    /// # Errors
    /// It was interrupted, the system has no threads to give, or a worker panicked.
    pub fn render(&mut self, way: &Way, seed: u64) -> Result<Rendered, Halt> {
        let (settings, mut outcome) = self.expose(way, seed)?;
        let developed = self.develop(way, &outcome, way.downsample)?;
        outcome.film.tiles = Vec::new();
        Ok(Rendered { settings, outcome, developed })
    }

    /// [`Bench::render`] without a look at the film.
    ///
    /// # Errors
    /// The same.
    pub fn expose(&mut self, way: &Way, seed: u64) -> Result<(Settings, Outcome), Halt> {
        let settings = Settings { seed, ..way.rendered()? };
        let (job, tile, cancel) = (self.job, self.tile, &self.interrupt.cancel);
        let pool = pool(&mut self.pools, way.threads)?;
        let renderer = pool.install(|| Renderer::new(&job.world, settings.clone(), job.level));
        let renderer = renderer.map_err(Failure::user)?;
        let film = Film::new(settings.area(), budget::tile(settings.adaptive, way.downsample, tile));
        let goal = Budget::default().goal(&settings, way.downsample, pool, Instant::now());
        let outcome = smalti_scheduler::render_to(&goal, &renderer, film, (pool, cancel), None, None);
        let outcome = outcome.map_err(Failure::bug)?;
        if outcome.interrupted || cancel.is_cancelled() { Err(Halt::Interrupted) } else { Ok((settings, outcome)) }
    }

    /// Looks at a film of `way`; `by` × `by` of its pixels become one.
    ///
    /// # Errors
    /// The system has no threads to give.
    pub fn develop(&mut self, way: &Way, outcome: &Outcome, by: u32) -> Result<Developed, Failure> {
        Ok(pool(&mut self.pools, way.threads)?.install(|| develop(&outcome.film, by)))
    }
}

fn pool(pools: &mut BTreeMap<usize, ThreadPool>, threads: usize) -> Result<&ThreadPool, Failure> {
    Ok(match pools.entry(threads) {
        Entry::Occupied(there) => there.into_mut(),
        Entry::Vacant(place) => place.insert(smalti_scheduler::pool(threads).map_err(Failure::user)?),
    })
}

/// A way that cannot be rendered is refused before anything is.
pub fn check(way: &Way) -> Result<(), Failure> {
    let settings = way.rendered()?;
    let photons = memory::photon_bytes(&settings);
    Need { settings: &settings, downsample: way.downsample, photons, shifts: false, shapes: 0 }.check(&memory::least())
}
