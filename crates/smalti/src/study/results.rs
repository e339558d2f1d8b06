//! What the repetitions of an arm come to.

use serde::Serialize;
use smalti_report::{Run, Study};

/// A figure over the repetitions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The one that counts.
    pub middle: f64,
    /// The least of the repetitions.
    pub least: f64,
    /// The most.
    pub most: f64,
}

/// What is told of an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmResult {
    /// Repetitions.
    pub runs: usize,
    /// The median counts.
    pub seconds: Spread,
    /// The mean counts: it is free of the reference's noise, which single ones may fall below.
    pub relmse: Spread,
    /// The root of the mean square counts.
    pub relative_error: Spread,
    /// 1 / (relmse × seconds); `None` without error or time.
    pub efficiency: Option<f64>,
}

impl Spread {
    fn of(runs: &[&Run], value: fn(&Run) -> f64, middle: impl Fn(&[f64]) -> f64) -> Self {
        let values: Vec<f64> = runs.iter().map(|run| value(run)).collect();
        let (least, most) = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, most) = values.iter().fold((least, most), |(low, high), value| (low.min(*value), high.max(*value)));
        Self { middle: middle(&values), least, most }
    }
}

/// The result of an arm; `None` before its first run.
pub fn of(study: &Study, arm: usize) -> Option<ArmResult> {
    let runs: Vec<&Run> = study.runs.iter().filter(|run| run.arm == arm).collect();
    if runs.is_empty() {
        return None;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let root_mean_square = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let seconds = Spread::of(&runs, |run| run.seconds, |values| smalti_measure::median(values).unwrap_or_default());
    let relmse = Spread::of(&runs, |run| run.relmse, mean);
    Some(ArmResult {
        runs: runs.len(),
        seconds,
        relmse,
        relative_error: Spread::of(&runs, |run| run.relative_error, root_mean_square),
        efficiency: smalti_measure::efficiency(relmse.middle, seconds.middle),
    })
}

#[cfg(test)]
pub mod tests {
    use smalti_report::{Arm, FORMAT, Machine};

    use super::*;

    pub fn run(arm: usize, repetition: u32, seconds: f64, error: f64) -> Run {
        Run {
            arm,
            repetition,
            seed: u64::from(repetition),
            seconds,
            photon_seconds: 0.0,
            spp: 4.0,
            rays: 1000,
            relmse: error * error,
            relmse_trimmed: error * error,
            relative_error: error,
            stated: None,
            mean: [1.0; 3],
            hash: "h".into(),
            tiles: Vec::new(),
        }
    }

    pub fn arm(name: &str) -> Arm {
        Arm {
            name: name.into(),
            label: format!("{name}, 4 spp"),
            group: name.into(),
            knobs: [("integrator".into(), name.into()), ("spp".into(), "4".into())].into(),
            varies: Vec::new(),
            command: "smalti render".into(),
            size: [8, 8],
            picture: None,
            image: None,
            biases: Vec::new(),
        }
    }

    /// Two arms, of which the second takes twice as long for half of the error.
    pub fn study() -> Study {
        Study {
            format: FORMAT,
            version: "0.1.0".into(),
            preset: "sweep".into(),
            question: Default::default(),
            command: "smalti study sweep a.toml".into(),
            scene: "a.toml".into(),
            scene_hash: "00".into(),
            machine: Machine { cores: 2, simd: "scalar".into(), system: "linux x86_64".into() },
            references: Vec::new(),
            arms: vec![arm("path"), arm("auto")],
            baseline: Some(0),
            exposure: 0.0,
            runs: [1.0, 3.0, 1.2]
                .iter()
                .zip(0..)
                .map(|(s, n)| run(0, n, *s, 0.2))
                .chain([run(1, 0, 2.4, 0.1)])
                .collect(),
        }
    }

    #[test]
    fn times_have_medians_and_errors_means() {
        let found = of(&study(), 0).unwrap();
        assert_eq!((found.runs, found.seconds), (3, Spread { middle: 1.2, least: 1.0, most: 3.0 }));
        assert!((found.relmse.middle - 0.04).abs() < 1e-15);
        assert!((found.efficiency.unwrap() - 1.0 / (0.04 * 1.2)).abs() < 1e-9);
        let mut mixed = study();
        mixed.runs = vec![run(0, 0, 1.0, 0.1), run(0, 1, 1.0, 0.7)];
        let found = of(&mixed, 0).unwrap();
        assert!((found.relative_error.middle - 0.5).abs() < 1e-15, "{found:?}");
        assert_eq!(of(&mixed, 1), None);
    }
}
