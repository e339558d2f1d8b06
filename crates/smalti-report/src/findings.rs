//! What a study found of each arm: its repetitions together, and whether anything is better.

use serde::Serialize;
use smalti_measure::{Repetitions, repetitions};

use crate::front::front;
use crate::record::{Run, Study};
use crate::stated::{Stated, stated};

/// What was measured of one arm.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Index of the arm.
    pub arm: usize,
    /// Render time, seconds.
    pub seconds: Repetitions,
    /// Relative error against the reference.
    pub relative_error: Repetitions,
    /// relmse against the reference; below 0 where image and reference are alike.
    pub relmse: Repetitions,
    /// 1 / (relmse × seconds); `None` where the relmse of a run is not above 0.
    pub efficiency: Option<Repetitions>,
    /// No other arm of its size is as fast and as accurate, and better in one of the two.
    pub on_front: bool,
    /// What the renders stated of themselves; `None` where they stated nothing.
    pub stated: Option<Stated>,
}

/// The finding of each arm that has a finished run, in the order of the arms.
pub fn findings(study: &Study) -> Vec<Finding> {
    let mut findings: Vec<Finding> = (0..study.arms.len()).filter_map(|arm| finding(study, arm)).collect();
    for size in sizes(study) {
        let of_size: Vec<usize> =
            (0..findings.len()).filter(|&index| study.arms[findings[index].arm].size == size).collect();
        let points: Vec<[f64; 2]> = of_size.iter().map(|&index| findings[index].point()).collect();
        for (&index, on_front) in of_size.iter().zip(front(&points)) {
            findings[index].on_front = on_front;
        }
    }
    findings
}

/// The sizes of images, in the order in which the arms have them first.
fn sizes(study: &Study) -> Vec<[u32; 2]> {
    let mut sizes = Vec::new();
    for arm in &study.arms {
        if !sizes.contains(&arm.size) {
            sizes.push(arm.size);
        }
    }
    sizes
}

/// Finished runs of an arm, in the order in which they ran.
pub(crate) fn runs_of(study: &Study, arm: usize) -> Vec<&Run> {
    study.runs.iter().filter(|run| run.arm == arm).collect()
}

fn finding(study: &Study, arm: usize) -> Option<Finding> {
    let runs = runs_of(study, arm);
    let of = |value: fn(&Run) -> f64| repetitions(&runs.iter().map(|run| value(run)).collect::<Vec<_>>());
    let efficiency: Option<Vec<f64>> =
        runs.iter().map(|run| smalti_measure::efficiency(run.relmse, run.seconds)).collect();
    Some(Finding {
        arm,
        seconds: of(|run| run.seconds)?,
        relative_error: of(|run| run.relative_error)?,
        relmse: of(|run| run.relmse)?,
        efficiency: efficiency.and_then(|values| repetitions(&values)),
        on_front: false,
        stated: stated(&runs),
    })
}

impl Finding {
    /// Seconds and relative error.
    fn point(&self) -> [f64; 2] {
        [self.seconds.median, self.relative_error.median]
    }
}

/// Findings from the most efficient on; those of unknown efficiency last.
pub(crate) fn by_efficiency(findings: &[Finding]) -> Vec<&Finding> {
    let efficiency = |finding: &Finding| finding.efficiency.map_or(f64::NEG_INFINITY, |found| found.median);
    let mut sorted: Vec<&Finding> = findings.iter().collect();
    sorted.sort_by(|a, b| efficiency(b).total_cmp(&efficiency(a)));
    sorted
}

/// Findings on the front, from the fastest on.
pub(crate) fn front_by_time(findings: &[Finding]) -> Vec<&Finding> {
    let mut front: Vec<&Finding> = findings.iter().filter(|finding| finding.on_front).collect();
    front.sort_by(|a, b| a.seconds.median.total_cmp(&b.seconds.median));
    front
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn an_arm_has_the_medians_of_its_runs() {
        let found = findings(&fixture::sweep());
        assert_eq!(found.len(), 5);
        assert_eq!((found[1].seconds.median, found[1].relative_error.median), (0.4, 0.2));
        // relmse 0.04, times 0.4 s.
        assert!((found[1].efficiency.unwrap().median * 0.016 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_front_is_of_one_size() {
        let mut study = fixture::sweep();
        let on_front =
            |study: &Study| -> Vec<usize> { front_by_time(&findings(study)).iter().map(|f| f.arm).collect() };
        assert_eq!(on_front(&study), [0, 3, 4]);
        study.arms[2].size = [40, 30];
        assert_eq!(on_front(&study), [0, 3, 4, 2]);
    }

    #[test]
    fn the_most_efficient_come_first() {
        let mut study = fixture::sweep();
        // relmse × seconds: 0.016 for all of path, 0.002 for both of auto, of which the second becomes unknown.
        study.runs.iter_mut().filter(|run| run.arm == 4).for_each(|run| run.relmse = -1e-6);
        let found = findings(&study);
        let order: Vec<usize> = by_efficiency(&found).iter().map(|finding| finding.arm).collect();
        assert_eq!((order[0], order[4], found[4].efficiency), (3, 4, None));
    }

    #[test]
    fn arms_without_a_run_have_no_finding() {
        let mut study = fixture::sweep();
        study.runs.truncate(2);
        let arms: Vec<usize> = findings(&study).iter().map(|finding| finding.arm).collect();
        assert_eq!(arms, [0, 1]);
    }
}
