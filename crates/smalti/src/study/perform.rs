//! A study from its plan to its last render. What is done is kept after every step, and found again by whoever goes on.

use smalti_image::Provenance;
use smalti_report::{Arm, FORMAT, Machine, Run, Study};

use super::bench::{Bench, Halt, Rendered};
use super::folder::Folder;
use super::naming::{self, Named};
use super::pilot::Pilots;
use super::plan::{Plan, interleaved};
use super::progress::Progress;
use super::question::Question;
use super::reference::{self, Truth};
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
    /// Does what is missing of a study, and says what it found.
    ///
    /// # Errors
    /// It was interrupted, or something could not be written.
    pub fn perform(&mut self, study: &mut Study) -> Result<String, Halt> {
        let is_new = study.arms.is_empty();
        if is_new {
            self.calibrate()?;
        } else {
            self.adopt(study)?;
        }
        let truths = self.find_truth(study)?;
        if is_new {
            self.refine(&truths)?;
            study.arms = arms(&self.plan, self.bench.job)?;
            self.folder.save(study)?;
        }
        self.render(study, &truths)?;
        Ok(present::present(study, self.folder)?)
    }

    /// A study of which nothing is known yet but what was asked; it is kept from here on.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn begin(&self, question: Question, command: String) -> Result<Study, Failure> {
        let job = self.bench.job;
        let system = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        let study = Study {
            format: FORMAT,
            version: env!("CARGO_PKG_VERSION").into(),
            preset: self.plan.preset.into(),
            question,
            command,
            scene: job.path.display().to_string(),
            scene_hash: job.scene_hash.clone(),
            machine: Machine { cores: super::way::cores(), simd: job.level.name().into(), system },
            references: Vec::new(),
            arms: Vec::new(),
            baseline: self.plan.baseline,
            runs: Vec::new(),
            exposure: f64::from(job.exposure(None)),
        };
        self.folder.make()?;
        self.folder.save(&study)?;
        Ok(study)
    }

    /// Renders what is missing, in its order, and keeps it.
    ///
    /// # Errors
    /// It was interrupted, or something could not be written.
    fn render(&mut self, study: &mut Study, truths: &[Truth]) -> Result<(), Halt> {
        let missing = missing(&self.repetitions, &study.runs);
        for (done, &(arm, repetition)) in missing.iter().enumerate() {
            let rest = rest(&missing[done..], &study.runs);
            self.progress.begin(&study.arms[arm].name, rest);
            let way = self.plan.arms[arm].way.clone();
            let rendered = self.bench.render(&way, seed(way.image.seed, repetition))?;
            let truth = reference::of_size(truths, study.arms[arm].size)?;
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
        provenance.push("estimator", smalti_core::ESTIMATOR);
        provenance.push("scene_hash", &self.bench.job.scene_hash);
        provenance.push("hash", &run.hash);
        provenance.push("reproduce", &arm.command);
        let image = &rendered.developed.image;
        let [picture, linear] = self.folder.write_image(&arm.name, image, &provenance, self.exposure)?;
        (arm.picture, arm.image) = (Some(picture), Some(linear));
        Ok(())
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
    use crate::study::fixture::run;

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
