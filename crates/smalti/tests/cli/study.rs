//! `study`: what it keeps, how it goes on, what it refuses.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::room::{folder, json, refuses, run, stderr, stdout};

const SWEEP: &str = "study sweep room.toml --integrator path,auto --spp 1,3 --reference-spp 64 -o out";

/// What does not depend on the time that renders took: arm, repetition, seed, error and hash of each.
fn facts(study: &Value) -> Vec<[Value; 5]> {
    let fact = |run: &Value| ["arm", "repetition", "seed", "relmse", "hash"].map(|name| run[name].clone());
    study["runs"].as_array().unwrap().iter().map(fact).collect()
}

fn kept(folder: &TempDir) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.path().join("out/study.json")).unwrap()).unwrap()
}

fn lines(folder: &TempDir, name: &str) -> usize {
    fs::read_to_string(folder.path().join(name)).unwrap().lines().count()
}

#[test]
fn a_sweep_renders_all_arms_once_then_all_again() {
    let folder = folder();
    let study = json(&folder, &format!("{SWEEP} --reps 2 --seed 5 --json -q"));
    let names: Vec<_> = study["arms"].as_array().unwrap().iter().map(|arm| arm["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["path-1spp", "path-3spp", "auto-1spp", "auto-3spp"]);
    let order: Vec<_> = facts(&study)
        .iter()
        .map(|[arm, repetition, seed, ..]| [arm, repetition, seed].map(|n| n.as_u64().unwrap()))
        .collect();
    let expected: Vec<_> =
        (0..2).flat_map(|repetition| (0..4).map(move |arm| [arm, repetition, 5 + repetition])).collect();
    assert_eq!(order, expected);
    assert_eq!(kept(&folder), study);
    assert_eq!((lines(&folder, "out/runs.csv"), lines(&folder, "out/arms.csv")), (9, 5));
    for name in ["out/images/auto-3spp.png", "out/images/auto-3spp.pfm", "out/reference-24x16.pfm"] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
    assert!(study["runs"][0]["tiles"].as_array().is_some_and(|tiles| !tiles.is_empty()));
}

#[test]
fn commands_give_the_images_of_a_study_again() {
    let folder = folder();
    let study = json(
        &folder,
        "study sweep room.toml --integrator auto --size 24x16,12x8 --downsample 1,2 --reps 1 -o out --json -q",
    );
    let again = |command: &Value| {
        let line = command.as_str().unwrap().strip_prefix("smalti ").unwrap().to_owned();
        json(&folder, &format!("{line} -o again.pfm --json -q"))
    };
    for (arm, run) in study["arms"].as_array().unwrap().iter().zip(study["runs"].as_array().unwrap()) {
        assert_eq!(again(&arm["command"])["hash"], run["hash"], "{arm}");
    }
    let references = study["references"].as_array().unwrap();
    assert_eq!(references.len(), 2);
    assert!(references[1]["command"].as_str().unwrap().contains("--size 12x8") && references[1]["relmse"].is_f64());
    for reference in references {
        let again = again(&reference["command"]);
        let relmse = again["error"]["relmse"].as_f64().unwrap();
        assert_eq!(Some(relmse), reference["relmse"].as_f64());
        let line = format!("compare again.pfm out/{} --max-rmse 0", reference["file"].as_str().unwrap());
        assert_eq!(run(&folder, &line).status.code(), Some(0));
    }
}

#[test]
fn a_study_that_was_stopped_goes_on_as_if_it_had_not() {
    let folder = folder();
    let whole = json(&folder, &format!("{SWEEP} --reps 2 --json -q"));
    let mut stopped = whole.clone();
    stopped["runs"].as_array_mut().unwrap().truncate(3);
    fs::write(folder.path().join("out/study.json"), stopped.to_string()).unwrap();
    let output = run(&folder, &format!("{SWEEP} --reps 2 --json --progress plain"));
    assert!(stderr(&output).contains("4 arms, 8 renders; 3 are there already"), "{}", stderr(&output));
    let again: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(facts(&again), facts(&whole));
    assert_eq!((&again["arms"], &again["references"]), (&whole["arms"], &whole["references"]));
    assert_eq!(again["runs"][2], whole["runs"][2], "what was there is kept as it was");

    (stopped["runs"], stopped["arms"]) = (Value::Array(Vec::new()), Value::Array(Vec::new()));
    fs::write(folder.path().join("out/study.json"), stopped.to_string()).unwrap();
    assert_eq!(facts(&json(&folder, &format!("{SWEEP} --reps 2 --json -q"))), facts(&whole), "before the first render");
}

#[test]
fn more_repetitions_extend_a_study() {
    let folder = folder();
    let first = json(&folder, &format!("{SWEEP} --reps 1 --json -q"));
    let more = json(&folder, &format!("{SWEEP} --reps 3 --json -q"));
    assert_eq!((facts(&more).len(), &facts(&more)[..4]), (12, &facts(&first)[..]));
    assert_eq!(facts(&json(&folder, &format!("{SWEEP} --reps 2 --json -q"))), facts(&more), "nothing is thrown away");
}

#[test]
fn a_folder_holds_the_answer_to_one_question() {
    let folder = folder();
    let study = json(&folder, &format!("{SWEEP} --reps 1 --json -q"));
    let other = SWEEP.replace("1,3", "1,4");
    let refused = run(&folder, &format!("{other} --seed 7"));
    assert_eq!((refused.status.code(), stdout(&refused)), (Some(2), String::new()));
    for part in ["spp is 1,3 there and 1,4 here", "seed is 0 there and 7 here", "--fresh"] {
        assert!(stderr(&refused).contains(part), "{}", stderr(&refused));
    }
    assert_eq!(kept(&folder), study);
    let fresh = json(&folder, &format!("{other} --fresh --reps 1 --json -q"));
    assert_eq!(fresh["arms"][1]["knobs"]["spp"], "4");
    assert!(!folder.path().join("out/images/path-3spp.png").exists());
}

#[test]
fn a_reference_that_is_given_is_the_truth() {
    let folder = folder();
    json(&folder, "render room.toml --spp 256 --seed 77 -o truth.pfm --json -q");
    let line =
        "study sweep room.toml --integrator path --spp 16 --size 24x16,12x8 --reps 1 --reference truth.pfm -o out";
    let study = json(&folder, &format!("{line} --json -q"));
    assert_eq!((&study["references"][0]["command"], &study["references"][0]["relmse"]), (&Value::Null, &Value::Null));
    let compared = json(&folder, "compare out/images/path-24x16.pfm truth.pfm --json");
    assert_eq!(compared["relmse"], study["runs"][0]["relmse"]);
    fs::remove_file(folder.path().join("out/reference-12x8.pfm")).unwrap();
    assert!(stderr(&run(&folder, line)).contains("--fresh"));
}

#[test]
fn equal_error_comes_near_the_error() {
    let folder = folder();
    let line =
        "study equal-error room.toml --integrator path,auto --shadow-rays 1 --error 10% --reference-spp 512 -o out";
    let study = json(&folder, &format!("{line} --json -q"));
    for arm in 0..2 {
        let runs = study["runs"].as_array().unwrap().iter().filter(|run| run["arm"] == arm);
        let squares: Vec<f64> =
            runs.map(|run| run["relative_error"].as_f64().unwrap()).map(|error| error * error).collect();
        let error = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        assert!((0.07..0.14).contains(&error), "{error}: {}", study["arms"][arm]);
    }
}

#[test]
fn equal_time_keeps_the_samples_that_it_chose() {
    let folder = folder();
    let line = "study equal-time room.toml --integrator path,whitted --seconds 0.02 -o out";
    let first = json(&folder, &format!("{line} --reps 1 --json -q"));
    let more = json(&folder, &format!("{line} --reps 2 --json -q"));
    assert_eq!((&first["arms"], facts(&first)), (&more["arms"], facts(&more)[..4].to_vec()));
    assert!(first["arms"][2]["biases"].to_string().contains("whitted"));
}

#[test]
fn presets_have_their_arms() {
    let folder = folder();
    let report = json(&folder, "study report room.toml --size 24x16 --reps 1 --json -q");
    let arms = report["arms"].as_array().unwrap();
    let table: Vec<_> = arms.iter().filter(|arm| arm["group"] == "Table 1").map(|arm| arm["name"].clone()).collect();
    assert_eq!(table, ["comparison", "figure1", "figure2", "figure3", "figure4", "figure5"]);
    assert_eq!((&report["baseline"], &arms[1]["size"]), (&0.into(), &serde_json::json!([12, 8])));
    assert!(folder.path().join("room-study-report/study.json").is_file());
    let knobs = json(&folder, "study knobs room.toml --reps 1 --threads 1 --json -q");
    let varies: Vec<_> = knobs["arms"].as_array().unwrap().iter().map(|arm| arm["varies"].to_string()).collect();
    assert_eq!(varies[0], "[]");
    for knob in ["integrator", "spp", "shadow-rays", "sampler", "jitter", "max-bounces", "fresnel", "photons"] {
        assert!(varies.contains(&format!("[\"{knob}\"]")), "{knob} is not in {varies:?}");
    }
}

#[test]
fn the_table_is_for_people() {
    let folder = folder();
    let output = run(&folder, "study sweep room.toml --spp 1,2 --reps 2 --progress none");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = stdout(&output);
    for part in ["report.html", "2 spp", "relmse", "Pareto front", "relative error"] {
        assert!(table.contains(part), "{table}");
    }
    assert_eq!(stderr(&output), "");
}

#[test]
fn mistakes_are_found_before_anything_is_rendered() {
    refuses("study", &["sweep", "equal-time", "knobs"]);
    refuses("study sweep room.toml --integrator pth", &["--integrator", "did you mean 'path'?"]);
    refuses("study sweep room.toml --spp 4,,8", &["--spp"]);
    refuses("study sweep room.toml --size 40000x2 --downsample 1,2", &["--downsample 2", "80000x4"]);
    refuses("study sweep room.toml --reps 0", &["--reps"]);
    refuses("study equal-time room.toml --spp 4", &["--spp", "chooses the samples"]);
    refuses("study equal-time room.toml --seconds 0", &["--seconds", "greater than 0"]);
    refuses("study equal-error room.toml --error -3%", &["--error"]);
    refuses("study report room.toml --size 25x16", &["25x16", "even"]);
    refuses("study knobs nowhere.toml", &["nowhere.toml"]);
    refuses("study sweep room.toml --reference room.pfm", &["room.pfm"]);
    refuses("study sweep room.toml -o no/out", &["no/out", "folder"]);
    refuses("study sweep room.toml -o room.toml", &["room.toml", "not a folder"]);
    refuses("study sweep room.toml -o .", &["not empty"]);
}

#[test]
fn a_reference_must_fit() {
    let folder = folder();
    json(&folder, "render room.toml -o truth.pfm --json -q");
    let refused = run(&folder, "study sweep room.toml --size 16x16 --reference truth.pfm -o out");
    assert_eq!(refused.status.code(), Some(2));
    assert!(stderr(&refused).contains("24x16") && stderr(&refused).contains("16x16"), "{}", stderr(&refused));
    assert!(!folder.path().join("out").exists());
}
