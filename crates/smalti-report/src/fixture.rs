//! Studies with chosen figures, for tests.

use std::collections::BTreeMap;

use crate::record::{Arm, FORMAT, Machine, Reference, Run, Study, TileTime};

/// A study without arms.
pub(crate) fn study() -> Study {
    Study {
        format: FORMAT,
        version: "0.1.0".into(),
        preset: "sweep".into(),
        question: BTreeMap::new(),
        command: "smalti study sweep room.toml --spp 4,16".into(),
        scene: "room.toml".into(),
        scene_hash: "0123456789abcdef".into(),
        machine: Machine { cores: 2, simd: "avx2".into(), system: "linux x86_64".into() },
        exposure: 0.0,
        references: vec![Reference {
            size: [80, 60],
            file: "reference.pfm".into(),
            command: Some("smalti render room.toml --spp 4096 -o reference.pfm".into()),
            relmse: Some(1e-5),
            relative_error_squared: Some(1e-4),
        }],
        arms: Vec::new(),
        baseline: None,
        runs: Vec::new(),
    }
}

/// Knobs by name and value.
pub(crate) fn knobs(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
    pairs.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect()
}

/// An arm with these knobs, named by their values.
pub(crate) fn arm(group: &str, pairs: &[(&str, &str)]) -> Arm {
    let values: Vec<&str> = pairs.iter().map(|(_, value)| *value).collect();
    Arm {
        name: format!("{group}-{}", values.join("-")),
        label: format!("{group}, {}", values.join(", ")),
        group: group.into(),
        knobs: knobs(pairs),
        varies: Vec::new(),
        command: format!("smalti render room.toml --integrator {group}"),
        size: [80, 60],
        picture: None,
        image: None,
        biases: Vec::new(),
    }
}

/// A run that took `seconds` and has this relative error; the relmse is the square of it.
pub(crate) fn run(arm: usize, repetition: u32, seconds: f64, error: f64) -> Run {
    Run {
        arm,
        repetition,
        seed: u64::from(repetition) + 1,
        seconds,
        photon_seconds: 0.0,
        spp: 4.0,
        rays: 1000,
        relmse: error * error,
        relmse_trimmed: error * error,
        relative_error: error,
        stated: None,
        mean: [0.5; 3],
        hash: "00".into(),
        tiles: Vec::new(),
    }
}

/// Three runs of each arm that scatter by the given factors about its seconds and relative error.
pub(crate) fn runs(figures: &[(f64, f64)], scatter: [f64; 3]) -> Vec<Run> {
    let all =
        (0..3).flat_map(|repetition| figures.iter().enumerate().map(move |(arm, figure)| (repetition, arm, figure)));
    all.map(|(repetition, arm, &(seconds, error))| run(arm, repetition, seconds * scatter[repetition as usize], error))
        .collect()
}

/// `path` with 4, 16 and 64 samples and `auto` with 4 and 16, baseline the first; a tile map for each.
pub(crate) fn sweep() -> Study {
    let settings = [("path", "4"), ("path", "16"), ("path", "64"), ("auto", "4"), ("auto", "16")];
    let figures = [(0.1, 0.4), (0.4, 0.2), (1.6, 0.1), (0.2, 0.1), (0.8, 0.05)];
    let mut study = study();
    study.arms = settings.iter().map(|(group, spp)| arm(group, &[("integrator", group), ("spp", spp)])).collect();
    study.arms[0].biases = vec!["paths end after 4 events".into()];
    study.baseline = Some(0);
    study.runs = runs(&figures, [0.98, 1.0, 1.02]);
    for run in study.runs.iter_mut().filter(|run| run.repetition == 0) {
        run.tiles = tiles(run.seconds);
    }
    study
}

/// Four tiles of 40 × 30 that take 1, 2, 3 and 4 tenths of `seconds`.
fn tiles(seconds: f64) -> Vec<TileTime> {
    let places = [[0, 0], [40, 0], [0, 30], [40, 30]];
    let tile = |(index, [x, y]): (usize, [u32; 2])| TileTime {
        area: [x, y, 40, 30],
        seconds: seconds * (index + 1) as f64 / 10.0,
    };
    places.into_iter().enumerate().map(tile).collect()
}
