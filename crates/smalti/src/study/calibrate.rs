//! The samples of arms that are to take one time, or to have one error.

use smalti_report::Study;

use super::bench::Halt;
use super::measure;
use super::perform::Performance;
use super::pilot::{self, Pilot};
use super::plan::Budget;
use super::reference::Truth;
use super::way::Way;
use crate::exit::Failure;
use crate::summary;

/// Renders of an arm, at most, that look for its error.
const TRIALS: usize = 3;

/// An error this near is the one that was asked for, by the ratio of the squares.
const NEAR: f64 = 1.1;

impl Performance<'_> {
    /// Finds the samples of every arm by pilots, where the plan does not say them.
    ///
    /// # Errors
    /// It was interrupted.
    pub(super) fn calibrate(&mut self) -> Result<(), Halt> {
        for index in 0..self.plan.arms.len() {
            let way = self.plan.arms[index].way.clone();
            let spp = match self.plan.budget {
                Budget::Samples => continue,
                Budget::Seconds(seconds) => {
                    let pilot = self.pilot(&way)?;
                    pilot::fit_time(&way, pilot, seconds, &mut self.bench)?
                }
                Budget::Error(error) => self.pilot(&way)?.samples_for(&way, error),
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
        let Budget::Error(error) = self.plan.budget else { return Ok(()) };
        for index in 0..self.plan.arms.len() {
            let way = self.plan.arms[index].way.clone();
            if summary::biases(&way.image, &self.bench.job.world, 0).is_empty() {
                self.plan.arms[index].way.image.spp = self.samples_for(way, error, truths)?;
            }
        }
        Ok(())
    }

    fn samples_for(&mut self, mut way: Way, error: f64, truths: &[Truth]) -> Result<u32, Halt> {
        for _ in 0..TRIALS {
            self.progress.begin(&format!("trial: {}, {} spp", way.image.integrator.name(), way.image.spp), None);
            let rendered = self.bench.render(&way, pilot::SEED)?;
            let truth = truths.iter().find(|truth| truth.record.size == way.size());
            let truth = truth.ok_or_else(|| Failure::bug("an arm has no reference of its size"))?;
            let found = measure::distance(&rendered.developed.image, truth)?.relative_error;
            let ratio = found * found / (error * error);
            if (1.0 / NEAR..NEAR).contains(&ratio) {
                break;
            }
            way.image.spp = pilot::corrected(way.image.spp, ratio);
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
