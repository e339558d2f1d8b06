//! `compare` and `pixel`: what images and single samples say.

use std::fs;

use crate::room::{folder, json, run, stderr, stdout};

#[test]
fn compare_checks_thresholds() {
    let folder = folder();
    json(&folder, "render room.toml -o a.pfm -o a.png --json -q");
    json(&folder, "render room.toml -o b.pfm --seed 1 --json -q");
    assert_eq!(json(&folder, "compare a.pfm a.pfm --json")["rmse"], 0.0);
    let line = "compare a.pfm b.pfm -o difference.png --json";
    let report = json(&folder, line);
    assert!(report["relmse"].as_f64().unwrap() > 0.0 && !report["worst"].as_array().unwrap().is_empty());
    assert!(folder.path().join("difference.png").is_file());
    assert_eq!(run(&folder, "compare a.pfm b.pfm --max-relmse 0").status.code(), Some(1));
    assert_eq!(run(&folder, "compare a.pfm a.pfm --max-relmse 0 --max-rmse 0").status.code(), Some(0));
}

#[test]
fn images_of_different_size_cannot_be_compared() {
    let folder = folder();
    json(&folder, "render room.toml -o a.pfm --json -q");
    json(&folder, "render room.toml -o b.pfm --size 8x8 --json -q");
    let output = run(&folder, "compare a.pfm b.pfm");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("24×16"), "{}", stderr(&output));
}

#[test]
fn a_pixel_is_the_sum_of_its_samples() {
    let folder = folder();
    json(&folder, "render room.toml -o a.pfm --json -q");
    let bytes = fs::read(folder.path().join("a.pfm")).unwrap();
    let (x, y) = (12, 9);
    let start = bytes.len() - 24 * 16 * 12 + ((15 - y) * 24 + x) * 12;
    let value = |c: usize| f32::from_le_bytes(bytes[start + 4 * c..][..4].try_into().unwrap());
    let pixel = json(&folder, &format!("pixel room.toml {x} {y} --json"));
    for c in 0..3 {
        assert_eq!(pixel["mean"][c].as_f64().unwrap() as f32, value(c));
    }
}

#[test]
fn a_sample_is_replayed_bounce_by_bounce() {
    let folder = folder();
    let sample = json(&folder, "pixel room.toml 12 9 --sample 1 --json");
    let first = &sample["vertices"][0];
    assert_eq!((&first["bounce"], &first["origin"]), (&0.into(), &serde_json::json!([0.0, -4.0, 1.0])));
    let text = stdout(&run(&folder, "pixel room.toml 12 9 --sample 1"));
    assert!(text.contains("throughput") && text.contains("radiance of the sample"), "{text}");
}
