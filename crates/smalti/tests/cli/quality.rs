//! `render --quality`: what is chosen, whether it was kept to, the plain command for the same image.

use std::fs;

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::room::{SCENE, folder, json, refuses, run, stderr, stdout};

/// A room whose scene asks for far too many shadow rays.
fn wasteful() -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("room.toml"), SCENE.replace("spp = 2", "spp = 2\nshadow_rays = 32")).unwrap();
    folder
}

fn rendered(folder: &TempDir, flags: &str) -> Value {
    json(folder, &format!("render room.toml {flags} --json -q"))
}

/// Settings of the pilots, in their order.
fn tried(summary: &Value) -> Vec<(u64, bool)> {
    let pilots = summary["quality"]["pilots"].as_array().unwrap().iter();
    pilots.map(|pilot| (pilot["shadow_rays"].as_u64().unwrap(), pilot["adaptive"].as_bool().unwrap())).collect()
}

/// Squared error times cost of a pilot.
fn inefficiency(pilot: &Value) -> f64 {
    let [error, spp, cost] = ["relative_error", "spp", "cost"].map(|field| pilot[field].as_f64().unwrap());
    error * error * spp * cost
}

#[test]
fn what_has_the_least_error_for_its_cost_is_chosen() {
    let folder = wasteful();
    let summary = rendered(&folder, "--quality draft --integrator path");
    let quality = &summary["quality"];
    assert_eq!((&quality["name"], &quality["target_error"]), (&json!("draft"), &json!(0.1)));
    let tried = tried(&summary);
    assert_eq!(tried[..4], [(32, false), (1, false), (2, false), (4, false)]);
    assert!(tried.len() == 5 && tried[4].1, "{tried:?}");
    let pilots = quality["pilots"].as_array().unwrap();
    let best = pilots.iter().min_by(|a, b| inefficiency(a).total_cmp(&inefficiency(b))).unwrap();
    assert_eq!((&summary["shadow_rays"], &summary["adaptive"]), (&best["shadow_rays"], &best["adaptive"]));
    assert!(summary["shadow_rays"] != 32 && quality["gain"].as_f64().unwrap() > 1.5, "{quality}");
}

#[test]
fn the_plain_command_gives_the_same_image() {
    let folder = wasteful();
    for (flags, other) in
        [("--quality draft --threads 1", "--threads 3"), ("--quality good --seed 5 --spp 80", "--tile 7")]
    {
        let summary = rendered(&folder, flags);
        let line = summary["reproduce"].as_str().unwrap().strip_prefix("smalti ").unwrap();
        assert!(!line.contains("--quality"), "{line}");
        let again = json(&folder, &format!("{line} --json -q"));
        assert_eq!((&again["hash"], &again["quality"]), (&summary["hash"], &Value::Null), "{line}");
        // And so does the same question with other workers and tiles.
        let asked = rendered(&folder, &format!("{flags} {other}").replace("--threads 1 ", ""));
        assert_eq!((&asked["hash"], &asked["quality"]), (&summary["hash"], &summary["quality"]));
    }
}

#[test]
fn what_was_typed_stays() {
    let folder = wasteful();
    let tried = |flags: &str| tried(&rendered(&folder, &format!("--quality draft --spp 4 {flags}")));
    assert_eq!(tried("--shadow-rays 3"), [(3, false), (3, true)]);
    assert_eq!(tried("--adaptive off"), [(32, false), (1, false), (2, false), (4, false)]);
    assert_eq!(tried("--adaptive on --shadow-rays 2"), [(2, true)]);
    let summary = rendered(&folder, "--quality final --integrator whitted --shadow-rays 3 --adaptive off --spp 64");
    assert_eq!((&summary["shadow_rays"], &summary["integrator"]), (&json!(3), &json!("whitted")));
    // The pilot is the render: the image is small enough for it.
    let quality = &summary["quality"];
    assert_eq!((&quality["expected_spp"], &quality["gain"]), (&json!(64), &json!(1.0)));
    let [expected, got] =
        [&quality["expected_error"], &summary["error"]["relative_error"]].map(|of| of.as_f64().unwrap());
    assert!((expected / got - 1.0).abs() < 1e-12, "{summary}");
}

#[test]
fn the_error_that_it_stands_for_is_reached() {
    let folder = wasteful();
    let summary = rendered(&folder, "--quality good --integrator whitted");
    assert_eq!((&summary["stopped_by"], &summary["target_reached"]), (&json!("error"), &json!(true)));
    assert!(summary["error"]["relative_error_high"].as_f64().unwrap() <= 0.03);
    let capped = run(&folder, "render room.toml --quality final --integrator whitted --spp 64 --color never -q");
    assert!(stderr(&capped).starts_with("warning: the error of 1.000 % was not reached"), "{}", stderr(&capped));
}

#[test]
fn people_are_told_what_and_why() {
    let folder = wasteful();
    let output = run(&folder, "render room.toml --quality draft --integrator path --spp 64 --color never");
    assert_eq!(stderr(&output).matches("note: short render: shadow rays").count(), 5, "{}", stderr(&output));
    let said = stdout(&output);
    for part in [
        "quality  draft (10.000 %): shadow rays ",
        "of 5 short renders",
        "times less error² × cost",
        "expected ",
        "got ",
    ] {
        assert!(said.contains(part), "'{part}' is not in\n{said}");
    }
}

#[test]
fn a_time_holds_for_the_short_renders_too() {
    let folder = wasteful();
    // Nothing is there after a quarter of a millisecond.
    let summary = rendered(&folder, "--quality good --time 0.001");
    assert_eq!((tried(&summary).len(), &summary["quality"]["expected_error"]), (0, &Value::Null));
    assert_eq!((&summary["stopped_by"], &summary["shadow_rays"]), (&json!("time"), &json!(32)));
}

#[test]
fn qualities_that_make_no_sense() {
    refuses("render room.toml --quality goood", &["draft, good, final", "'good'"]);
    refuses("render room.toml --quality good --target-error 1%", &["--quality", "--target-error"]);
}

#[test]
fn what_short_renders_cannot_judge_is_said() {
    let folder = wasteful();
    // Without shadow rays chance finds the light.
    let flags = "--quality draft --integrator path --shadow-rays 0 --adaptive off --spp 64";
    assert_eq!(rendered(&folder, flags)["quality"]["certain"], json!(false));
    let said = stdout(&run(&folder, &format!("render room.toml {flags} --color never --progress none")));
    assert!(said.contains(" or more at 64 spp, got "), "{said}");
    assert_eq!(rendered(&folder, "--quality draft --integrator whitted --spp 64")["quality"]["certain"], json!(true));
}
