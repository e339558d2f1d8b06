//! `render`: files, the account, progress, the command that gives the same image; `explain` and `scaling`.

use std::fs;
use std::process::Output;

use serde_json::Value;
use tempfile::TempDir;

use crate::room::{SCENE, command, folder, json, refuses, run, stderr, stdout};

#[test]
fn the_default_output_lies_here_under_the_scenes_name() {
    let folder = folder();
    let here = folder.path().join("here");
    fs::create_dir(&here).unwrap();
    let output = command(&here, "render ../room.toml --progress none").output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(here.join("room.png").is_file());
    assert!(stdout(&output).contains("room.png") && stdout(&output).contains("hash"));
    assert_eq!(stderr(&output), "");
}

#[test]
fn quiet_says_nothing() {
    let folder = folder();
    let output = run(&folder, "render room.toml -q");
    assert_eq!((output.status.code(), stdout(&output), stderr(&output)), (Some(0), String::new(), String::new()));
}

#[test]
fn the_summary_has_every_documented_field() {
    let folder = folder();
    let summary = json(&folder, "render room.toml --spp 33 -o a.exr -o a.pfm --threads 2 --json -q");
    let fields = "version scene scene_hash notes integrator sampler width height spp rounds shadow_rays max_bounces seed threads \
                  simd tile setup_seconds photon_seconds render_seconds write_seconds wall_seconds samples rays \
                  mean_path_length photons_emitted photons_stored peak_bytes hash nonfinite mean error stopped_by \
                  target_reached reproduce";
    for field in fields.split_whitespace() {
        assert!(summary.get(field).is_some(), "{field}");
    }
    assert_eq!(summary["samples"], 24 * 16 * 33);
    assert_eq!((&summary["rounds"], &summary["threads"], &summary["tile"]), (&2.into(), &2.into(), &32.into()));
    assert_eq!((&summary["max_bounces"], &summary["target_reached"]), (&Value::Null, &true.into()));
    assert_eq!(summary["outputs"], serde_json::json!(["a.exr", "a.pfm"]));
    for field in "relmse relmse_low relmse_high relative_error relative_error_low relative_error_high \
                  uncertified_pixels"
        .split_whitespace()
    {
        assert!(summary["error"].get(field).is_some(), "{field}");
    }
}

#[test]
fn too_few_samples_tell_no_error() {
    let folder = folder();
    assert_eq!(json(&folder, "render room.toml --json -q")["error"], Value::Null);
    assert!(stdout(&run(&folder, "render room.toml --progress none")).contains("it takes 32 samples"));
}

#[test]
fn biases_are_named() {
    let folder = folder();
    let summary = json(&folder, "render room.toml --integrator whitted --max-bounces 3 --fresnel schlick --json -q");
    let biases = summary["biases"].to_string();
    for part in ["whitted", "3 times", "schlick"] {
        assert!(biases.contains(part), "{biases}");
    }
    assert_eq!(json(&folder, "render room.toml --json -q")["biases"], serde_json::json!([]));
}

#[test]
fn the_reproduce_command_gives_the_same_hash() {
    let folder = folder();
    let flags = "--spp 3 --seed 7 --camera above --crop 3,2,9,8 --max-bounces 4 --shadow-rays 2 --sampler independent \
                 --no-jitter --fresnel schlick --threads 1 --tile 5 --simd scalar";
    let first = json(&folder, &format!("render room.toml {flags} --json -q"));
    // The scene's own settings must not matter.
    let changed = SCENE.replace("size = [24, 16]", "size = [9, 9]").replace("spp = 2", "spp = 5\nseed = 3");
    fs::write(folder.path().join("room.toml"), changed).unwrap();
    let line = first["reproduce"].as_str().unwrap().strip_prefix("smalti ").unwrap().to_owned();
    let again = json(&folder, &format!("{line} --json -q"));
    assert_eq!(first["hash"], again["hash"]);
    assert_ne!(first["hash"], json(&folder, "render room.toml --json -q")["hash"]);
}

/// The pixels of a PFM, which begins with the bottom row.
fn pfm(folder: &TempDir, name: &str) -> Vec<[f32; 3]> {
    let bytes = fs::read(folder.path().join(name)).unwrap();
    let start = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').nth(2).unwrap().0 + 1;
    let (values, _) = bytes[start..].as_chunks::<4>();
    let (pixels, _) = values.as_chunks::<3>();
    pixels.iter().map(|pixel| pixel.map(f32::from_le_bytes)).collect()
}

#[test]
fn a_crop_is_a_part_of_the_whole_image() {
    let folder = folder();
    json(&folder, "render room.toml -o whole.pfm --json -q");
    json(&folder, "render room.toml -o part.pfm --crop 5,4,7,6 --json -q");
    let (whole, part) = (pfm(&folder, "whole.pfm"), pfm(&folder, "part.pfm"));
    for (index, pixel) in part.iter().enumerate() {
        let (x, y) = (5 + index % 7, 4 + (5 - index / 7));
        assert_eq!(*pixel, whole[(15 - y) * 24 + x], "{x} {y}");
    }
}

#[test]
fn a_downsampled_image_is_the_mean_of_the_larger_one() {
    let folder = folder();
    let flags = "--spp 33 --shadow-rays 2 --json -q";
    json(&folder, &format!("render room.toml -o large.pfm --size 48x32 --crop 8,4,20,12 {flags}"));
    let small = json(&folder, &format!("render room.toml -o small.pfm --downsample 2 --crop 4,2,10,6 {flags}"));
    let (large, image) = (pfm(&folder, "large.pfm"), pfm(&folder, "small.pfm"));
    assert_eq!((large.len(), image.len()), (20 * 12, 10 * 6));
    for (index, pixel) in image.iter().enumerate() {
        let first = index / 10 * 2 * 20 + index % 10 * 2;
        for c in 0..3 {
            let sum: f64 = [0, 1, 20, 21].iter().map(|next| f64::from(large[first + next][c])).sum();
            // The mean is of the sums in f64: the larger image has rounded each of its pixels.
            assert!((f64::from(pixel[c]) - sum / 4.0).abs() <= 2e-7 * sum, "{index}");
        }
    }
    assert_eq!((&small["width"], &small["height"], &small["downsample"]), (&24.into(), &16.into(), &2.into()));
    let line = small["reproduce"].as_str().unwrap().strip_prefix("smalti ").unwrap().to_owned();
    assert_eq!(small["hash"], json(&folder, &format!("{line} --json -q"))["hash"]);
}

#[test]
fn standard_errors_are_an_image_of_their_own() {
    let folder = folder();
    let told = json(&folder, "render room.toml --spp 64 -o image.pfm --standard-error error.pfm --json -q");
    assert_eq!(told["outputs"], serde_json::json!(["image.pfm", "error.pfm"]));
    let (image, errors) = (pfm(&folder, "image.pfm"), pfm(&folder, "error.pfm"));
    // The mean square error, taken relative to the image, is about what is stated.
    let square = |(x, error): (&f32, &f32)| f64::from(error * error) / (f64::from(x * x) + 0.01);
    let pairs = image.as_flattened().iter().zip(errors.as_flattened());
    let relmse = pairs.map(square).sum::<f64>() / (3 * image.len()) as f64;
    let stated = told["error"]["relmse"].as_f64().unwrap();
    assert!((0.5..1.5).contains(&(relmse / stated)), "{relmse} {stated}");
    let few = run(&folder, "render room.toml --spp 8 -o image.pfm --standard-error none.pfm");
    assert!(few.status.success() && stderr(&few).contains("none.pfm is not written"), "{}", stderr(&few));
    refuses("render room.toml -o a.pfm --standard-error a.pfm", &["twice"]);
}

#[test]
fn progress_as_json_leaves_nothing_but_json_on_stderr() {
    let folder = folder();
    let output = run(&folder, "render room.toml --progress json");
    assert_eq!(output.status.code(), Some(0));
    for line in stderr(&output).lines() {
        assert!(serde_json::from_str::<Value>(line).unwrap().is_object(), "{line}");
    }
    let events = |output: &Output| -> Vec<Value> {
        stderr(output).lines().map(|line| serde_json::from_str::<Value>(line).unwrap()["event"].clone()).collect()
    };
    assert_eq!(events(&output)[..3], ["reading", "building", "started"]);
    let output = run(&folder, "render nowhere.toml --progress json");
    assert_eq!(output.status.code(), Some(2));
    let message: Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!(message["event"], "error");
}

#[test]
fn colours_are_the_users_choice() {
    let folder = folder();
    let coloured = run(&folder, "render room.toml --progress none --color always");
    assert!(stdout(&coloured).contains('\x1b'));
    let plain = run(&folder, "render room.toml --progress none --color never");
    assert!(!stdout(&plain).contains('\x1b'));
    assert!(stderr(&run(&folder, "render nowhere.toml --color always")).contains('\x1b'));
}

#[test]
fn explain_tells_decisions_with_reasons() {
    let folder = folder();
    let explained = json(&folder, "explain room.toml --json");
    let decisions = explained["decisions"].as_array().unwrap();
    assert!(!decisions.is_empty());
    for decision in decisions {
        assert!(decision["subject"].is_string() && decision["choice"].is_string() && decision["reason"].is_string());
    }
    assert_eq!((&explained["contents"]["spheres"], &explained["contents"]["cameras"]), (&1.into(), &2.into()));
    let text = stdout(&run(&folder, "explain room.toml --simd scalar"));
    assert!(text.contains("scalar; this machine has") && text.contains("The plan"), "{text}");
}

#[test]
fn scaling_proves_the_same_image() {
    let folder = folder();
    let report = json(&folder, "scaling room.toml --threads 1,2 --reps 2 --tile 4 --json -q");
    assert_eq!((&report["same_image"], &report["reps"]), (&true.into(), &2.into()));
    let results = report["results"].as_array().unwrap();
    assert_eq!(results.iter().map(|row| row["threads"].as_u64().unwrap()).collect::<Vec<_>>(), [1, 2]);
    assert_eq!(results[0]["hashes"].as_array().unwrap().len(), 2);
    assert_eq!(report["hash"], json(&folder, "render room.toml --json -q")["hash"]);
}
