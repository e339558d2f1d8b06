//! The samples of arms that are to take one time, or to have one error.

use smalti_report::Study;

use super::bench::{Halt, Rendered};
use super::measure;
use super::perform::Performance;
use super::pilot::{self, Pilot};
use super::plan::Budget;
use super::reference::{self, Truth};
use super::way::Way;
use crate::exit::Failure;
use crate::summary;

/// Renders of an arm, at most, that look for its time or its error.
const TRIALS: usize = 3;

/// The first of them takes this part of the time: a pilot may be far off.
const FIRST: f64 = 0.4;

/// What is this near is what was asked for, by the ratio.
const NEAR: f64 = 1.1;

fn is_near(ratio: f64) -> bool {
    (1.0 / NEAR..NEAR).contains(&ratio)
}

impl Performance<'_> {
    /// Finds the samples of every arm, where the plan does not say them: by pilots, and by trials in full size for those
    /// that are to take one time.
    ///
    /// # Errors
    /// It was interrupted.
    pub(super) fn calibrate(&mut self) -> Result<(), Halt> {
        for index in 0..self.plan.arms.len() {
            let way = self.plan.arms[index].way.clone();
            let spp = match self.plan.budget {
                Budget::Samples => continue,
                Budget::Seconds(seconds) => self.samples_in(way, seconds)?,
                Budget::Error { error, seconds } => {
                    let pilot = self.pilot(&way)?;
                    pilot.samples_for(&way, error).min(pilot.samples_in(&way, seconds))
                }
            };
            self.plan.arms[index].way.image.spp = spp;
        }
        Ok(())
    }

    /// The pilot of a way, while the display says so.
    pub(super) fn pilot(&mut self, way: &Way) -> Result<Pilot, Halt> {
        self.progress.begin(&format!("short renders: {}", way.image.integrator.name()), None);
        self.pilots.of(way, &mut self.bench)
    }

    /// Corrects the samples of arms that are to have one error by trials in full size: rare bright light, which most
    /// pilots miss, has its part in the error. An arm with a bias keeps what its noise asks for: no number of samples
    /// takes a bias away.
    ///
    /// # Errors
    /// It was interrupted.
    pub(super) fn refine(&mut self, truths: &[Truth]) -> Result<(), Halt> {
        let Budget::Error { error, seconds } = self.plan.budget else { return Ok(()) };
        for index in 0..self.plan.arms.len() {
            let way = self.plan.arms[index].way.clone();
            if summary::biases(&way.image, &self.bench.job.world, 0).is_empty() {
                self.plan.arms[index].way.image.spp = self.samples_for(way, (error, seconds), truths)?;
            }
        }
        Ok(())
    }

    fn samples_in(&mut self, mut way: Way, seconds: f64) -> Result<u32, Halt> {
        way.image.spp = self.pilot(&way)?.samples_in(&way, seconds * FIRST);
        self.search(way, |way, trial| {
            let is_near = is_near(trial.outcome.timing.elapsed.as_secs_f64() / seconds);
            Ok((!is_near).then(|| Pilot::of(way, trial).samples_in(way, seconds)))
        })
    }

    fn samples_for(&mut self, way: Way, (error, seconds): (f64, f64), truths: &[Truth]) -> Result<u32, Halt> {
        let truth = reference::of_size(truths, way.size())?;
        self.search(way, |way, trial| {
            let found = measure::distance(&trial.developed.image, truth)?.relative_error;
            let ratio = found * found / (error * error);
            let affordable = Pilot::of(way, trial).samples_in(way, seconds);
            Ok((!is_near(ratio)).then(|| pilot::corrected(way.image.spp, ratio).min(affordable)))
        })
    }

    /// The samples that trials come to, each corrected by what the last one showed; `None`: it was near.
    fn search(
        &mut self,
        mut way: Way,
        correct: impl Fn(&Way, &Rendered) -> Result<Option<u32>, Failure>,
    ) -> Result<u32, Halt> {
        for _ in 0..TRIALS {
            let (name, spp) = (way.image.integrator.name(), way.image.spp);
            self.progress.begin(&format!("trial: {name}, {spp} spp"), None);
            let trial = self.bench.render(&way, pilot::SEED)?;
            match correct(&way, &trial)?.filter(|corrected| *corrected != spp) {
                Some(corrected) => way.image.spp = corrected,
                None => break,
            }
        }
        Ok(way.image.spp)
    }

    /// Takes over the samples that an earlier part of the study chose.
    ///
    /// # Errors
    /// A record that somebody changed.
    pub(super) fn adopt(&mut self, study: &Study) -> Result<(), Failure> {
        let damaged = || Failure::user("the study's arms are not those of its question; --fresh begins anew");
        if study.arms.len() != self.plan.arms.len() {
            return Err(damaged());
        }
        for (planned, arm) in self.plan.arms.iter_mut().zip(&study.arms) {
            planned.way.image.spp = arm.knobs.get("spp").and_then(|spp| spp.parse().ok()).ok_or_else(damaged)?;
        }
        Ok(())
    }
}
