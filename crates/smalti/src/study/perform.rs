//! A study from its plan to its last render. What is done is kept after every step, and found again by who goes on.

use smalti_image::Provenance;
use smalti_report::{Arm, FORMAT, Machine, Reference, Run, Study};

use super::bench::{Bench, Halt, Rendered};
use super::folder::Folder;
use super::naming::{self, Named};
use super::pilot::{self, Pilot, Pilots};
use super::plan::{Budget, Plan, interleaved};
use super::progress::Progress;
use super::question::Question;
use super::reference::{self, Family, Truth};
use super::way::Way;
use super::{measure, present};
use crate::exit::Failure;
use crate::job::Job;
use crate::{reproduce, summary};

/// Everything that a study needs to go on.
pub struct Performance<'a> {
    /// What is to be done.
    pub plan: Plan,
    /// Repetitions of each arm.
    pub repetitions: Vec<u32>,
    /// Samples of references; `None`: as many as needed.
    pub reference_spp: Option<u32>,
    /// References that were given.
    pub given: Option<Vec<Truth>>,
    /// Where it is kept.
    pub folder: &'a Folder,
    /// Where it is rendered.
    pub bench: Bench<'a>,
    /// Who is told.
    pub progress: Progress,
    /// The renders that told something of others.
    pub pilots: Pilots,
    /// Brightness of pictures, stops.
    pub exposure: f32,
}

impl Performance<'_> {
    /// Finds the samples of every arm, where the plan does not say them.
    ///
    /// # Errors
    /// It was interrupted.
    pub fn calibrate(&mut self) -> Result<(), Halt> {
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

    fn pilot(&mut self, way: &Way) -> Result<Pilot, Halt> {
        self.progress.begin(&format!("short renders: {}", way.image.integrator.name()), None);
        self.pilots.of(way, &mut self.bench)
    }

    /// Takes over the samples that an earlier part of the study chose.
    ///
    /// # Errors
    /// A record that somebody changed.
    pub fn adopt(&mut self, study: &Study) -> Result<(), Failure> {
        let damaged = || Failure::user("the study's arms are not those of its question; --fresh begins anew");
        if study.arms.len() != self.plan.arms.len() {
            return Err(damaged());
        }
        for (planned, arm) in self.plan.arms.iter_mut().zip(&study.arms) {
            planned.way.image.spp = arm.knobs.get("spp").and_then(|spp| spp.parse().ok()).ok_or_else(damaged)?;
        }
        Ok(())
    }

    /// A study of which nothing is rendered yet.
    ///
    /// # Errors
    /// A way that cannot be rendered.
    pub fn begin(&self, question: Question, command: String) -> Result<Study, Failure> {
        let job = self.bench.job;
        let system = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        Ok(Study {
            format: FORMAT,
            version: env!("CARGO_PKG_VERSION").into(),
            preset: self.plan.preset.into(),
            question,
            command,
            scene: job.path.display().to_string(),
            scene_hash: job.scene_hash.clone(),
            machine: Machine { cores: super::way::cores(), simd: job.level.name().into(), system },
            references: Vec::new(),
            arms: arms(&self.plan, job)?,
            baseline: self.plan.baseline,
            runs: Vec::new(),
        })
    }

    /// Sees to it that there is a truth for every size, from the folder or rendered now.
    ///
    /// # Errors
    /// It was interrupted, or could not be written.
    pub fn find_truth(&mut self, study: &mut Study) -> Result<Vec<Truth>, Halt> {
        let sizes: Vec<[u32; 2]> = self.plan.arms.iter().map(|arm| arm.way.size()).collect();
        let truths = match self.given.take() {
            Some(given) => given,
            None if !study.references.is_empty() => {
                if let Some(kept) = reference::kept(&study.references, &sizes, self.folder) {
                    return Ok(kept);
                }
                let gone = "a reference is gone from the study's folder; --fresh begins anew";
                return Err(Failure::user(gone).into());
            }
            None => self.render_truth(&sizes)?,
        };
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
            let what = format!("reference, {width}x{height}, {} spp", way.image.spp);
            let expected = self.pilot(&way)?.seconds(&way);
            self.progress.say(&format!("{what}, about {expected:.0} s"));
            self.progress.begin(&what, None);
            let made = reference::made(&way, family, &mut self.bench, self.folder)?;
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
        super::bench::check(&way)?;
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

    /// Renders what is missing, in its order, and keeps it.
    ///
    /// # Errors
    /// It was interrupted, or something could not be written.
    pub fn render(&mut self, study: &mut Study, truths: &[Truth]) -> Result<(), Halt> {
        let missing = missing(&self.repetitions, &study.runs);
        for (done, &(arm, repetition)) in missing.iter().enumerate() {
            let rest = rest(&missing[done..], &study.runs);
            self.progress.begin(&study.arms[arm].name, rest);
            let way = self.plan.arms[arm].way.clone();
            let rendered = self.bench.render(&way, seed(way.image.seed, repetition))?;
            let truth = truths.iter().find(|truth| truth.record.size == study.arms[arm].size);
            let truth = truth.ok_or_else(|| Failure::bug("an arm has no reference of its size"))?;
            let run = measure::run((arm, repetition), &rendered, measure::distance(&rendered.developed.image, truth)?);
            if repetition == 0 {
                self.keep_image(&mut study.arms[arm], &rendered, &run)?;
            }
            study.runs.push(run);
            self.folder.save(study)?;
            let rest = self::rest(&missing[done + 1..], &study.runs);
            self.progress.finished(&study.arms[arm], &study.runs[study.runs.len() - 1], rest);
        }
        Ok(())
    }

    fn keep_image(&self, arm: &mut Arm, rendered: &Rendered, run: &Run) -> Result<(), Failure> {
        let mut provenance = Provenance::new();
        provenance.push("version", env!("CARGO_PKG_VERSION"));
        provenance.push("scene_hash", &self.bench.job.scene_hash);
        provenance.push("hash", &run.hash);
        provenance.push("reproduce", &arm.command);
        let image = &rendered.developed.image;
        let [picture, linear] = self.folder.write_image(&arm.name, image, &provenance, self.exposure)?;
        (arm.picture, arm.image) = (Some(picture), Some(linear));
        Ok(())
    }

    /// Says what the study found.
    ///
    /// # Errors
    /// Something cannot be written.
    pub fn present(&self, study: &Study) -> Result<String, Failure> {
        present::present(study, self.folder)
    }
}

/// The seed of a repetition, the same for all arms.
fn seed(of_study: u64, repetition: u32) -> u64 {
    of_study.wrapping_add(u64::from(repetition))
}

/// What of the interleaved order is not among `runs`.
fn missing(repetitions: &[u32], runs: &[Run]) -> Vec<(usize, u32)> {
    let is_missing =
        |(arm, repetition): &(usize, u32)| !runs.iter().any(|run| (run.arm, run.repetition) == (*arm, *repetition));
    interleaved(repetitions).into_iter().filter(is_missing).collect()
}

/// How long `missing` will take by the runs so far; `None` before every arm in it ran once.
fn rest(missing: &[(usize, u32)], runs: &[Run]) -> Option<[f64; 2]> {
    let mut rest = [0.0; 2];
    for (arm, _) in missing {
        let times: Vec<f64> = runs.iter().filter(|run| run.arm == *arm).map(|run| run.seconds).collect();
        rest[0] += times.iter().copied().reduce(f64::min)?;
        rest[1] += times.iter().copied().reduce(f64::max)?;
    }
    // A single run says nothing of the spread, and looking at an image takes time too.
    Some([rest[0], 1.15 * rest[1]])
}

/// The arms of a plan, none of them rendered.
fn arms(plan: &Plan, job: &Job) -> Result<Vec<Arm>, Failure> {
    let turned = plan.turned(&job.world);
    let named = plan.named(&turned);
    let arm = |(index, named): (usize, Named)| {
        let way = &plan.arms[index].way;
        let baseline = plan.baseline.map(|baseline| &turned[baseline]);
        Ok(Arm {
            name: named.name,
            label: named.label,
            group: named.group,
            varies: baseline.map_or(Vec::new(), |baseline| naming::differences(&turned[index], baseline)),
            command: reproduce::command(&job.path, (&way.rendered()?, way.downsample), way.image.spp, job.camera()),
            size: way.size(),
            knobs: turned[index].clone(),
            picture: None,
            image: None,
            biases: summary::biases(&way.image, &job.world, 0),
        })
    };
    named.into_iter().enumerate().map(arm).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::results::tests::run;

    #[test]
    fn what_is_there_is_not_rendered_again() {
        let runs = [run(0, 0, 1.0, 0.1), run(1, 0, 2.0, 0.1), run(0, 1, 1.5, 0.1)];
        assert_eq!(missing(&[2, 2], &runs), [(1, 1)]);
        assert_eq!(missing(&[3, 3], &runs), [(1, 1), (0, 2), (1, 2)]);
        assert_eq!(missing(&[1, 1], &runs), []);
    }

    #[test]
    fn the_rest_is_a_range_once_every_arm_ran() {
        let runs = [run(0, 0, 1.0, 0.1), run(0, 1, 3.0, 0.1)];
        let [low, high] = rest(&[(0, 2), (0, 3)], &runs).unwrap();
        assert!((low - 2.0).abs() < 1e-12 && (high - 6.9).abs() < 1e-12);
        assert_eq!(rest(&[(0, 2), (1, 0)], &runs), None);
    }

    #[test]
    fn repetitions_count_their_seeds_up() {
        assert_eq!([0, 1, 2].map(|repetition| seed(7, repetition)), [7, 8, 9]);
        assert_eq!(seed(u64::MAX, 1), 0);
    }
}
