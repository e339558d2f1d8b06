//! `render` until a time or an error, with samples where the noise is: why it stopped, what was reached, the same image
//! again.

use serde_json::Value;
use tempfile::TempDir;

use crate::room::{folder, json, refuses, run, stderr, stdout};

fn rendered(folder: &TempDir, flags: &str) -> Value {
    json(folder, &format!("render room.toml {flags} --json -q"))
}

/// What the error of an image is at most, with the bias of photon radii.
fn at_most(summary: &Value) -> f64 {
    let noise = summary["error"]["relative_error_high"].as_f64().unwrap();
    let bias = ["relative_bias", "relative_bias_high"].map(|end| summary["bias"][end].as_f64().unwrap_or_default());
    let bias = bias[0].max(bias[1]);
    (noise * noise + bias * bias).sqrt()
}

/// The command that a render prints makes its image again, whatever the number of threads.
fn assert_reproducible(folder: &TempDir, summary: &Value) {
    let line = summary["reproduce"].as_str().unwrap().strip_prefix("smalti ").unwrap();
    assert!(!line.contains("--time") && !line.contains("--target-error"), "{line}");
    for threads in [1, 3] {
        let again = json(folder, &format!("{line} --threads {threads} --json -q"));
        assert_eq!(again["hash"], summary["hash"], "{line}");
        assert_eq!(again["samples"], summary["samples"]);
    }
}

#[test]
fn an_error_that_was_asked_for_is_reached() {
    let folder = folder();
    for adaptive in ["off", "on"] {
        let summary = rendered(&folder, &format!("--target-error 4% --adaptive {adaptive} --threads 2"));
        assert_eq!((&summary["stopped_by"], &summary["target_reached"]), (&"error".into(), &true.into()));
        assert!(at_most(&summary) <= 0.04, "{summary}");
        assert_reproducible(&folder, &summary);
    }
}

#[test]
fn a_smaller_error_takes_more_samples() {
    let folder = folder();
    let spp = |error: &str| {
        let summary = rendered(&folder, &format!("--integrator whitted --target-error {error}"));
        summary["spp"].as_u64().unwrap()
    };
    assert!(spp("1%") > 4 * spp("0.05"));
}

#[test]
fn where_the_noise_is_there_are_more_samples() {
    let folder = folder();
    let summary = rendered(&folder, "--size 64x48 --spp 256 --adaptive on");
    let [least, most] = ["samples_least", "samples_most"].map(|field| summary[field].as_u64().unwrap());
    assert!((64..256).contains(&least) && most > 256, "{least} to {most}");
    assert_eq!((&summary["adaptive"], &summary["spp"], &summary["tile"]), (&true.into(), &256.into(), &16.into()));
    assert_reproducible(&folder, &summary);
    let even = rendered(&folder, "--size 64x48 --spp 256");
    assert_eq!((&even["samples_least"], &even["samples_most"]), (&256.into(), &256.into()));
    assert_ne!(even["hash"], summary["hash"]);
}

#[test]
fn a_time_that_is_up_ends_it() {
    let folder = folder();
    for flags in ["--time 1s", "--time 1000ms --adaptive on", "--time 0m1s --target-error 0.01%"] {
        let summary = rendered(&folder, flags);
        assert_eq!(summary["stopped_by"], "time", "{flags}");
        assert_eq!(summary["target_reached"], !flags.contains("--target-error"), "{flags}");
        assert_reproducible(&folder, &summary);
    }
}

#[test]
fn a_time_shorter_than_a_sample_a_pixel_is_exceeded_by_no_more_than_that_and_said() {
    let folder = folder();
    let large = "--size 1600x1200 --time 30ms --threads 1";
    for flags in [
        "--integrator path",
        "--integrator photon --photons 20000",
        "--integrator auto --photons 20000 --adaptive on",
        "--integrator whitted --target-error 5%",
        "--integrator path --quality draft",
        "--integrator path --downsample 2",
        "--integrator path --spp 1",
    ] {
        let output = run(&folder, &format!("render room.toml {large} {flags} --json -q"));
        assert_eq!(output.status.code(), Some(0), "{flags}: {}", stderr(&output));
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        let samples = ["samples_least", "samples_most", "spp"].map(|field| summary[field].as_u64().unwrap());
        assert_eq!((samples, &summary["target_reached"]), ([1; 3], &false.into()), "{flags}");
        let said = stderr(&output);
        assert!(said.contains("warning: the time of 30.0 ms was too short: "), "{flags}: {said}");
        assert!(said.contains("one sample a pixel"), "{flags}: {said}");
        assert_eq!(
            said.contains("the error of"),
            flags.contains("error") || flags.contains("quality"),
            "{flags}: {said}"
        );
        let first = summary["shortfalls"][0].as_str().unwrap();
        assert!(said.contains(first), "{first} is not in {said}");
        assert_reproducible(&folder, &summary);
    }
}

#[test]
fn a_time_that_was_too_short_stands_in_the_text_too() {
    let folder = folder();
    let output = run(&folder, "render room.toml --size 1600x1200 --time 30ms --progress none");
    let text = stdout(&output);
    assert!(text.lines().any(|line| line.contains("missed") && line.contains("the time of 30.0 ms")), "{text}");
    let in_time = stdout(&run(&folder, "render room.toml --time 1s --progress none"));
    assert!(!in_time.contains("missed"), "{in_time}");
}

#[test]
fn whatever_comes_first_ends_it() {
    let folder = folder();
    let summary = rendered(&folder, "--time 1000 --target-error 10%");
    assert_eq!((&summary["stopped_by"], &summary["target_reached"]), (&"error".into(), &true.into()));
    let summary = rendered(&folder, "--time 1000 --spp 3");
    assert_eq!((&summary["stopped_by"], &summary["target_reached"]), (&"spp".into(), &false.into()));
    assert_eq!(summary["spp"], 3);
    assert_reproducible(&folder, &summary);
}

#[test]
fn an_error_that_is_small_enough_is_reached_whoever_stopped_it() {
    let folder = folder();
    // The error is judged first at 64 samples.
    let summary = rendered(&folder, "--integrator whitted --target-error 50% --spp 48");
    assert_eq!((&summary["stopped_by"], &summary["target_reached"]), (&"spp".into(), &true.into()));
}

#[test]
fn an_error_that_is_out_of_reach_is_answered_with_what_was_reached() {
    let folder = folder();
    for (flags, part) in [
        ("--spp 100", "too few samples in --spp: the error is at most"),
        ("--spp 20", "too few samples in --spp: it takes 32 a pixel to tell"),
        ("--time 0.4", "the error of 0.010 % was not reached"),
    ] {
        let output =
            run(&folder, &format!("render room.toml --integrator whitted --target-error 0.01% {flags} --json -q"));
        assert_eq!(output.status.code(), Some(0));
        let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(summary["target_reached"], false);
        let said = stderr(&output);
        assert!(said.starts_with("warning: the error of 0.010 % was not reached"), "{said}");
        assert!(said.contains(part), "{flags}: {said}");
    }
    assert_eq!(stderr(&run(&folder, "render room.toml --target-error 10% -q")), "");
}

#[test]
fn what_nobody_can_judge_is_said() {
    let folder = folder();
    // Without shadow rays and photons chance finds the light, and through glass hardly ever.
    let flags = "--integrator path --shadow-rays 0 --target-error 1% --spp 64";
    let output = run(&folder, &format!("render room.toml {flags} --json -q"));
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    let pixels = summary["error"]["uncertified_pixels"].as_u64().unwrap();
    assert!(pixels > 1 && summary["error"]["relative_error_high"].is_null(), "{summary}");
    let expected = format!("{pixels} pixels are too uncertain to judge, so nobody can say what the error is at most");
    assert!(stderr(&output).contains(&expected), "{}", stderr(&output));
}

#[test]
fn budgets_that_make_no_sense() {
    for time in ["0", "-1", "abc", "10x"] {
        refuses(&format!("render room.toml --time {time}"), &["--time", "greater than 0, for example 500ms, 10s"]);
    }
    refuses("render room.toml --time 5min", &["--time", "did you mean '5m'?"]);
    refuses("render room.toml --time 1e20", &["--time", "at most 1e9 seconds"]);
    refuses("study equal-time room.toml --seconds 1m30", &["--seconds", "did you mean '1m30s'?"]);
    refuses("study equal-error room.toml --seconds 2hours", &["--seconds", "did you mean '2h'?"]);
    for error in ["0", "-1", "0%", "much"] {
        let parts = ["--target-error", "greater than 0, for example 3% or 0.03"];
        refuses(&format!("render room.toml --target-error {error}"), &parts);
    }
    refuses("render room.toml --adaptive maybe", &["--adaptive", "on, off"]);
}
