//! A small study to test with.

use smalti_report::{Arm, FORMAT, Machine, Run, Study};

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
        runs: [1.0, 3.0, 1.2].iter().zip(0..).map(|(s, n)| run(0, n, *s, 0.2)).chain([run(1, 0, 2.4, 0.1)]).collect(),
    }
}
