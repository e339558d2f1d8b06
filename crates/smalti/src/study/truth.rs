//! How good the truth must be: the references of a study, found in its folder, taken as given or rendered.

use std::time::Duration;

use smalti_report::{Reference, Study};

use super::bench::{self, Halt};
use super::perform::Performance;
use super::reference::{self, Family, Truth};
use super::way::Way;
use crate::exit::Failure;
use crate::frontend::numbers;
use crate::summary;

impl Performance<'_> {
    /// Sees to it that there is a truth for every size, from the folder or rendered now.
    ///
    /// # Errors
    /// It was interrupted, or could not be written.
    pub(super) fn find_truth(&mut self, study: &mut Study) -> Result<Vec<Truth>, Halt> {
        let sizes: Vec<[u32; 2]> = self.plan.arms.iter().map(|arm| arm.way.size()).collect();
        if !study.references.is_empty() {
            let gone = || Failure::user("a reference is gone from the study's folder; --fresh begins anew");
            return Ok(reference::kept(&study.references, &sizes, self.folder).ok_or_else(gone)?);
        }
        let truths = match self.given.take() {
            Some(given) => given,
            None => self.render_truth(&sizes)?,
        };
        truths.iter().try_for_each(|truth| reference::keep(truth, self.folder))?;
        study.references = truths.iter().map(|truth| truth.record.clone()).collect();
        self.folder.save(study)?;
        Ok(truths)
    }

    fn render_truth(&mut self, sizes: &[[u32; 2]]) -> Result<Vec<Truth>, Halt> {
        let families = reference::families(sizes.to_vec());
        let seconds = self.plan.reference_share * self.seconds_of_all()? / families.len() as f64;
        let mut truths = Vec::new();
        for family in &families {
            let best: Vec<Option<f64>> = family.iter().map(|size| self.best(*size)).collect::<Result<_, _>>()?;
            let way = self.reference_way(family, &best, seconds)?;
            let [width, height] = family[0];
            let expected = Duration::from_secs_f64(self.pilot(&way)?.seconds(&way));
            let (spp, expected) = (way.image.spp, numbers::duration(expected));
            let what = format!("reference, {width}x{height}, {spp} spp, about {expected}");
            self.progress.say(&what);
            self.progress.begin(&what, None);
            let made = reference::made(&way, family, &mut self.bench)?;
            made.iter().zip(&best).for_each(|(truth, best)| self.judge(&truth.record, *best));
            truths.extend(made);
        }
        Ok(truths)
    }

    fn reference_way(&mut self, family: &Family, best: &[Option<f64>], seconds: f64) -> Result<Way, Halt> {
        let scene = &self.plan.arms[0].way.clone();
        let mut way = reference::way(scene, family, 1);
        way.image.spp = match self.reference_spp {
            Some(spp) => spp,
            None => {
                let pilot = self.pilot(&way)?;
                let needed = pilot.noise.map_or(u32::MAX, |noise| reference::needed(noise, family, best));
                reference::samples(needed, pilot.samples_in(&way, seconds))
            }
        };
        bench::check(&way)?;
        Ok(way)
    }

    /// The least squared error that noise leaves any arm of a size; arms with a bias as well only where all have one.
    fn best(&mut self, size: [u32; 2]) -> Result<Option<f64>, Halt> {
        let of_size = |way: &&Way| way.size() == size;
        let ways: Vec<Way> = self.plan.arms.iter().map(|arm| &arm.way).filter(of_size).cloned().collect();
        let world = &self.bench.job.world;
        let (fair, biased): (Vec<Way>, Vec<Way>) =
            ways.into_iter().partition(|way| summary::biases(&way.image, world, 0).is_empty());
        let mut best: Option<f64> = None;
        for way in if fair.is_empty() { biased } else { fair } {
            let error = self.pilot(&way)?.squared_error(&way);
            best = best.into_iter().chain(error).reduce(f64::min);
        }
        Ok(best)
    }

    /// Says of a reference that is not as good as wanted.
    fn judge(&self, record: &Reference, best: Option<f64>) {
        let (Some(own), Some(best)) = (record.relative_error_squared, best) else { return };
        if own > reference::FIFTH * best {
            let [width, height] = record.size;
            self.progress.say(&format!(
                "the reference of {width}x{height} has a squared error of about {:.2} of the best arm's; errors are \
                 freed of it, but {:.1} would be better: --reference-spp N takes more time for it",
                own / best,
                reference::FIFTH
            ));
        }
    }

    /// How long all renders will take, by pilots.
    fn seconds_of_all(&mut self) -> Result<f64, Halt> {
        let mut all = 0.0;
        for (index, repetitions) in self.repetitions.clone().into_iter().enumerate() {
            let way = self.plan.arms[index].way.clone();
            all += f64::from(repetitions) * self.pilot(&way)?.seconds(&way);
        }
        Ok(all)
    }
}
