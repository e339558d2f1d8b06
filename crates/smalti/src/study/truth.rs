//! How good the truth must be: the references of a study, found in its folder, taken as given or rendered.

use std::time::Duration;

use smalti_report::Study;

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

    /// The least squared error that noise leaves any arm of a size. Arms with a bias, and those whose noise is not known
    /// for certain, are left out unless there are no others.
    fn best(&mut self, size: [u32; 2]) -> Result<Option<f64>, Halt> {
        let of_size = |way: &&Way| way.size() == size;
        let ways: Vec<Way> = self.plan.arms.iter().map(|arm| &arm.way).filter(of_size).cloned().collect();
        let mut best: Option<(bool, f64)> = None;
        for way in ways {
            let pilot = self.pilot(&way)?;
            let biases = summary::biases(&way.image, &self.bench.job.world, 0);
            let doubtful = !biases.is_empty() || !pilot.certain;
            let error = pilot.squared_error(&way).map(|error| (doubtful, error));
            best = best.into_iter().chain(error).min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        }
        Ok(best.map(|(_, error)| error))
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
