//! `--quality`: an error to be reached, and the settings that reach it at the least cost, found by short renders of
//! the scene itself.
//!
//! What is chosen follows from samples, errors and counts of rays, never from the clock or the number of threads, so that
//! the image stays a function of scene, settings, seed and version. Only a time that was typed cuts the search short, as
//! it does the render.

mod choice;
mod pilot;
mod shelf;

use std::time::{Duration, Instant};

use rayon::ThreadPool;
use smalti_scheduler::Cancel;

pub use choice::QualityRecord;
use choice::{Candidate, Choice, Pilot};
use pilot::Bench;

use crate::args::{BudgetArgs, ImageArgs};
use crate::describe::percent;
use crate::exit::Failure;
use crate::job::Job;

/// What part of a time that was typed the short renders may take.
const PART: u32 = 4;

/// Who renders, and until when at most.
pub struct Means<'a> {
    /// The workers.
    pub pool: &'a ThreadPool,
    /// Who may stop them.
    pub cancel: &'a Cancel,
    /// When the process began, and the time that was typed.
    pub deadline: Option<(Instant, Duration)>,
}

/// Settles what `--quality` and the other flags leave open of the settings of `job`, and says why; `told` hears of each
/// short render. `None` without `--quality`. Whoever is stopped chooses by what is there.
///
/// # Errors
/// The scene cannot be rendered, or a worker panicked.
pub fn settle(
    job: &mut Job,
    (budget, typed): (&BudgetArgs, &ImageArgs),
    means: &Means,
    told: impl Fn(&str),
) -> Result<Option<QualityRecord>, Failure> {
    let Some(name) = budget.quality else { return Ok(None) };
    let choice = choose(job, typed, means, told)?;
    if let Some(Pilot { candidate, .. }) = choice.best() {
        job.settings.shadow_rays = candidate.shadow_rays;
        job.settings.adaptive = candidate.adaptive;
    }
    Ok(Some(choice.record(name, typed.spp, job.downsample)))
}

fn choose(job: &Job, typed: &ImageArgs, means: &Means, told: impl Fn(&str)) -> Result<Choice, Failure> {
    let deadline = means.deadline.map(|(start, time)| start + time / PART);
    let mut bench = Bench::new(job, means.pool, means.cancel, deadline);
    let mut choice = Choice::default();
    let mut add = |candidate: Candidate, choice: &mut Choice| {
        let pilot = bench.render(candidate)?;
        pilot.iter().for_each(|pilot| told(&in_words(pilot)));
        choice.pilots.extend(pilot);
        Ok::<bool, Failure>(pilot.is_some())
    };
    for candidate in Candidate::of_shadow_rays(&job.settings, typed) {
        if !add(candidate, &mut choice)? {
            return Ok(choice);
        }
    }
    if let Some(candidate) = choice.best().and_then(|best| best.candidate.otherwise(typed)) {
        add(candidate, &mut choice)?;
    }
    Ok(choice)
}

fn in_words(pilot: &Pilot) -> String {
    let Pilot { candidate: Candidate { shadow_rays, adaptive }, spp, cost, relative_error, certain } = pilot;
    let adaptive = if *adaptive { "on" } else { "off" };
    let error = relative_error.map_or("unknown".into(), percent);
    let error = if *certain { error } else { error + " or more" };
    let settings = format!("shadow rays {shadow_rays}, adaptive {adaptive}, {spp} spp");
    format!("short render: {settings}: error {error}, cost of a path {cost:.2} rays")
}
