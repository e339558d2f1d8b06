//! `doctor`: what is sound, what asks for trouble, what fails; and the hunt.

use std::fs;

use crate::room::{SCENE, folder, json, run, stderr, stdout};

/// The verdict of a check.
fn verdict<'a>(report: &'a serde_json::Value, check: &str, case: &str) -> &'a str {
    let findings = report["findings"].as_array().unwrap();
    let found = findings.iter().find(|finding| finding["check"] == check && finding["case"] == case);
    found.unwrap_or_else(|| panic!("{check} {case}"))["verdict"].as_str().unwrap()
}

#[test]
fn a_sound_scene_is_sound() {
    let folder = folder();
    let output = run(&folder, "doctor room.toml --photons 2000");
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()), "{}", stdout(&output));
    for part in ["2^-40", "10^6", "10^7 sizes", "scalar", "leaks", "self-hits", "none failed, no warnings"] {
        assert!(stdout(&output).contains(part), "{part}: {}", stdout(&output));
    }
    let report = json(&folder, "doctor room.toml --photons 2000 --json");
    for field in ["version", "scene", "scene_hash", "integrator", "spp", "simd", "failed", "warnings"] {
        assert!(report.get(field).is_some(), "{field}");
    }
    assert_eq!((&report["failed"], &report["spp"]), (&0.into(), &32.into()));
    assert!(report["findings"].as_array().unwrap().len() > 30);
    assert_eq!(verdict(&report, "scale", "2^20"), "sound");
}

/// A lamp that is 10⁻⁹ of the scene: less than coordinates can hold. That is told, and rays hit it where in f64 they do not.
#[test]
fn what_cannot_be_kept_fails_and_what_is_doubtful_is_told() {
    let folder = folder();
    let tiny = SCENE.replace("radiance = [5, 5, 5]", "radiance = [0, 0, 0]")
        + "[[light.quad]]\nvertices = [[0, 0, 3], [0, 1e-8, 3], [1e-8, 1e-8, 3], [1e-8, 0, 3]]\nradiance = [1e16, 1e16, 1e16]\n";
    fs::write(folder.path().join("tiny.toml"), tiny).unwrap();
    let output = run(&folder, "doctor tiny.toml --integrator path --json");
    assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(verdict(&report, "geometry", "small"), "warning");
    assert_eq!(verdict(&report, "rays", "elsewhere"), "failed");
    assert_eq!(verdict(&report, "scale", "10^6"), "warning");
    assert_eq!(verdict(&report, "scale", "2^40"), "sound");
    let quiet = stdout(&run(&folder, "doctor tiny.toml --integrator path --quiet"));
    assert!(!quiet.contains("sound") && quiet.contains("the light polygon 2"), "{quiet}");
}

#[test]
fn a_hunt_that_finds_nothing_says_how_far_it_went() {
    let folder = folder();
    for integrator in ["auto", "path", "photon", "whitted"] {
        let line = format!("doctor room.toml --hunt --integrator {integrator} --photons 2000 --spp 20");
        let output = run(&folder, &line);
        assert_eq!(stdout(&output), "7680 samples: every value is finite, and none is negative\n");
        assert_eq!(output.status.code(), Some(0));
    }
    assert_eq!(json(&folder, "doctor room.toml --hunt --json")["impossible"], serde_json::Value::Null);
}
