//! What a knob costs: one arm against another that differs in one knob, and whether it is worth it.
//!
//! The measure is error² × time: of unbiased renders it is the same at any number of samples, so that what lowers it is
//! gained for nothing. Runs are compared in pairs of one repetition, which share their seed and the state of the machine.

use serde::Serialize;
use smalti_measure::{Ends, Repetitions, repetitions};

use crate::findings::runs_of;
use crate::knobs::differing;
use crate::record::{Arm, Run, Study};

/// One arm against another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Index of the arm in question.
    pub arm: usize,
    /// Index of the arm that it is compared with.
    pub other: usize,
    /// The knob in which they differ.
    pub knob: String,
    /// The arm's seconds by the other's.
    pub seconds: Repetitions,
    /// The arm's relative error by the other's; `None` where one cannot be told from the reference's.
    pub error: Option<Repetitions>,
    /// Error² × time by the other's.
    pub cost: Option<Repetitions>,
    /// What follows.
    pub verdict: Verdict,
}

/// Whether a change is worth it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Error² × time is lower.
    Worth,
    /// It is higher.
    NotWorth,
    /// The interval of its ratio holds 1.
    NoDifference,
    /// The arm has these biases, which the other has not: more time does not remove them.
    Biased(Vec<String>),
    /// The images differ in size: an error for each pixel does not say which is better.
    OtherSize,
    /// There are too few repetitions for an interval.
    TooFew,
    /// An error cannot be told from that of the reference.
    ErrorUnknown,
}

/// Each arm that differs from the baseline in one knob against it; without a baseline, each arm against the best of those
/// that differ from it in one knob. The baseline says nothing of arms of another size that differ in more: they too are
/// compared with the best, of their own size.
pub fn comparisons(study: &Study) -> Vec<Comparison> {
    (0..study.arms.len()).filter_map(|arm| comparison(study, arm)).collect()
}

fn comparison(study: &Study, arm: usize) -> Option<Comparison> {
    let all = 0..study.arms.len();
    let Some(baseline) = study.baseline else { return against_best(study, arm, all) };
    let size = |arm: usize| study.arms[arm].size;
    let of_its_size = || against_best(study, arm, all.filter(|&other| size(other) == size(arm)));
    against(study, arm, baseline).or_else(|| (size(arm) != size(baseline)).then(of_its_size).flatten())
}

fn against(study: &Study, arm: usize, baseline: usize) -> Option<Comparison> {
    match differing(study.arms.get(arm)?, study.arms.get(baseline)?).as_slice() {
        [knob] => compare(study, arm, baseline, knob),
        _ => None,
    }
}

fn against_best(study: &Study, arm: usize, others: impl Iterator<Item = usize>) -> Option<Comparison> {
    let cost = |comparison: &Comparison| comparison.cost.map_or(f64::NEG_INFINITY, |cost| cost.median);
    // The best neighbour is the one by which the arm's cost is highest.
    others.filter_map(|other| against(study, arm, other)).max_by(|a, b| cost(a).total_cmp(&cost(b)))
}

/// Compares two arms that differ in `knob`; `None` without a repetition that both have.
pub(crate) fn compare(study: &Study, arm: usize, other: usize, knob: &str) -> Option<Comparison> {
    let pairs = pairs(study, arm, other);
    let ratios = |of: fn(&Run) -> f64| pairs.iter().map(|(run, other)| of(run) / of(other)).collect::<Vec<_>>();
    let has_error = pairs.iter().all(|(run, other)| run.relative_error > 0.0 && other.relative_error > 0.0);
    let cost = repetitions(&ratios(cost)).filter(|_| has_error);
    Some(Comparison {
        arm,
        other,
        knob: knob.into(),
        seconds: repetitions(&ratios(|run| run.seconds))?,
        error: repetitions(&ratios(|run| run.relative_error)).filter(|_| has_error),
        cost,
        verdict: verdict(&study.arms[arm], &study.arms[other], cost),
    })
}

/// Error² × time of a run.
fn cost(run: &Run) -> f64 {
    run.relative_error * run.relative_error * run.seconds
}

/// Runs of two arms that have the same repetition.
fn pairs(study: &Study, arm: usize, other: usize) -> Vec<(&Run, &Run)> {
    let others = runs_of(study, other);
    let partner = |run: &Run| others.iter().copied().find(|other| other.repetition == run.repetition);
    runs_of(study, arm).into_iter().filter_map(|run| Some((run, partner(run)?))).collect()
}

fn verdict(arm: &Arm, other: &Arm, cost: Option<Repetitions>) -> Verdict {
    let biases: Vec<String> = arm.biases.iter().filter(|bias| !other.biases.contains(bias)).cloned().collect();
    match cost {
        _ if arm.size != other.size => Verdict::OtherSize,
        _ if !biases.is_empty() => Verdict::Biased(biases),
        None => Verdict::ErrorUnknown,
        Some(cost) if cost.ends == Ends::Range => Verdict::TooFew,
        Some(cost) if cost.high < 1.0 => Verdict::Worth,
        Some(cost) if cost.low > 1.0 => Verdict::NotWorth,
        Some(_) => Verdict::NoDifference,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// Two arms with 10 and 20 shadow rays that take `seconds` and have `errors`; the first is the baseline.
    fn study(seconds: [[f64; 3]; 2], errors: [[f64; 3]; 2]) -> Study {
        let mut study = fixture::study();
        study.arms = ["10", "20"].map(|rays| fixture::arm("path", &[("shadow-rays", rays)])).to_vec();
        study.baseline = Some(0);
        for repetition in 0..3 {
            for arm in 0..2 {
                let (seconds, error) = (seconds[arm][repetition], errors[arm][repetition]);
                study.runs.push(fixture::run(arm, repetition as u32, seconds, error));
            }
        }
        study
    }

    fn only(study: &Study) -> Comparison {
        let found = comparisons(study);
        assert_eq!(found.len(), 1);
        found[0].clone()
    }

    #[test]
    fn what_repetitions_share_cancels() {
        // The machine slows down by a factor of 10 and the seeds differ by 4, for both arms alike.
        let found = only(&study([[1.0, 3.0, 10.0], [2.0, 6.0, 20.0]], [[0.1, 0.2, 0.4], [0.05, 0.1, 0.2]]));
        assert_eq!((found.seconds.median, found.error.unwrap().median), (2.0, 0.5));
        let cost = found.cost.unwrap();
        assert!([cost.low, cost.median, cost.high].iter().all(|end| (end - 0.5).abs() < 1e-12), "{cost:?}");
        assert_eq!(found.verdict, Verdict::Worth);
    }

    #[test]
    fn twice_the_time_must_lower_the_error_by_more_than_the_root_of_two() {
        let of = |error: f64| {
            only(&study([[1.0; 3], [2.0, 2.02, 1.98]], [[0.1; 3], [error, error * 0.99, error * 1.01]])).verdict
        };
        assert_eq!(of(0.09), Verdict::NotWorth);
        assert_eq!(of(0.1 / 2.0f64.sqrt()), Verdict::NoDifference);
        assert_eq!(of(0.05), Verdict::Worth);
    }

    #[test]
    fn biases_sizes_and_a_lack_of_figures_come_first() {
        let plain = study([[1.0; 3], [2.0; 3]], [[0.1; 3], [0.01; 3]]);
        let mut biased = plain.clone();
        biased.arms.iter_mut().for_each(|arm| arm.biases.push("of both".into()));
        assert_eq!(only(&biased).verdict, Verdict::Worth);
        biased.arms[1].biases.push("of one".into());
        assert_eq!(only(&biased).verdict, Verdict::Biased(vec!["of one".into()]));
        let mut sized = plain.clone();
        sized.arms[1].size = [40, 30];
        assert_eq!(only(&sized).verdict, Verdict::OtherSize);
        let mut few = plain.clone();
        few.runs.retain(|run| run.repetition < 2);
        assert_eq!(only(&few).verdict, Verdict::TooFew);
        let mut exact = plain;
        exact.runs[1].relative_error = 0.0;
        assert_eq!((only(&exact).verdict, only(&exact).error), (Verdict::ErrorUnknown, None));
    }

    #[test]
    fn without_a_baseline_the_best_neighbour_is_the_measure() {
        let mut study = study([[1.0; 3], [2.0; 3]], [[0.1; 3], [0.01; 3]]);
        study.baseline = None;
        study.arms.push(fixture::arm("path", &[("shadow-rays", "1")]));
        study.arms.push(fixture::arm("path", &[("shadow-rays", "1"), ("spp", "4")]));
        study.runs.extend((0..3).map(|repetition| fixture::run(2, repetition, 0.5, 0.3)));
        let pairs: Vec<(usize, usize)> = comparisons(&study).iter().map(|found| (found.arm, found.other)).collect();
        assert_eq!(pairs, [(0, 1), (1, 0), (2, 1)]);
    }

    #[test]
    fn with_a_baseline_only_single_knobs_are_compared() {
        let arms: Vec<usize> = comparisons(&fixture::sweep()).iter().map(|found| found.arm).collect();
        assert_eq!(arms, [1, 2, 3]);
    }

    #[test]
    fn arms_of_another_size_are_compared_among_themselves() {
        let mut study = study([[1.0; 3], [2.0; 3]], [[0.1; 3], [0.01; 3]]);
        for (knobs, seconds) in
            [([("shadow-rays", "5"), ("size", "8x8")], 0.5), ([("shadow-rays", "1"), ("size", "8x8")], 0.2)]
        {
            study.runs.extend((0..3).map(|repetition| fixture::run(study.arms.len(), repetition, seconds, 0.1)));
            study.arms.push(Arm { size: [8, 8], ..fixture::arm("path", &knobs) });
        }
        study.arms[0].knobs.insert("size".into(), "80x60".into());
        study.arms[1].knobs.insert("size".into(), "80x60".into());
        let found = comparisons(&study);
        let pairs: Vec<(usize, usize)> = found.iter().map(|found| (found.arm, found.other)).collect();
        assert_eq!(pairs, [(1, 0), (2, 3), (3, 2)]);
        assert_eq!((&found[1].verdict, &found[2].verdict), (&Verdict::NotWorth, &Verdict::Worth));
    }
}
