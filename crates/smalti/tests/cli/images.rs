//! `compare` and `pixel`: what images and single samples say.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

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

/// Writes a PFM of one row, grey.
fn write_row(folder: &TempDir, name: &str, values: &[f32]) {
    let mut bytes = format!("Pf\n{} 1\n-1\n", values.len()).into_bytes();
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    fs::write(folder.path().join(name), bytes).unwrap();
}

#[test]
fn a_pixel_that_is_not_finite_fails_the_check() {
    let folder = folder();
    write_row(&folder, "good.pfm", &[1.0, 2.0, 3.0]);
    write_row(&folder, "nan.pfm", &[1.0, f32::NAN, 3.0]);
    write_row(&folder, "inf.pfm", &[1.0, f32::INFINITY, 3.0]);
    write_row(&folder, "none.pfm", &[f32::NAN; 3]);
    let pairs = [("nan", "good"), ("good", "nan"), ("inf", "good"), ("inf", "nan"), ("none", "good"), ("none", "nan")];
    for (image, reference) in pairs {
        for limits in ["", " --max-rmse 9 --max-relmse 9"] {
            let output = run(&folder, &format!("compare {image}.pfm {reference}.pfm{limits}"));
            assert_eq!(output.status.code(), Some(1), "{image} {reference}: {}", stderr(&output));
            let text = stdout(&output);
            assert!(text.contains("pixels that are not finite") && !text.contains("no pixel differs"), "{text}");
            assert!(text.contains("The worst pixels"), "{text}");
        }
    }
    for name in ["nan", "inf", "none"] {
        let output = run(&folder, &format!("compare {name}.pfm {name}.pfm"));
        assert_eq!(output.status.code(), Some(0));
        assert!(stdout(&output).contains("alike in both"), "{}", stdout(&output));
    }
}

#[test]
fn pixels_that_are_not_finite_are_counted_in_json() {
    let folder = folder();
    write_row(&folder, "a.pfm", &[1.0, f32::NAN, 3.0, f32::INFINITY, f32::NAN]);
    write_row(&folder, "b.pfm", &[1.0, 2.0, 3.0, f32::INFINITY, f32::INFINITY]);
    let output = run(&folder, "compare a.pfm b.pfm --json -o d.png");
    let report: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let counts = ["pixels", "image", "reference", "both", "alike"].map(|of| report[format!("nonfinite_{of}")].clone());
    assert_eq!(counts, [3, 3, 2, 2, 1]);
    assert_eq!(
        (&report["rmse"], &report["worst"][0]["x"], &report["worst"][1]["x"]),
        (&0.0.into(), &1.into(), &4.into())
    );
    assert_eq!((&report["worst"][0]["nonfinite"], &report["worst"][1]["nonfinite"]), (&"image".into(), &"both".into()));
    assert!(report["worst"][0]["relmse"].is_null() && report["worst"][0]["value"][0].is_null());
    write_row(&folder, "none.pfm", &[f32::NAN; 5]);
    let output = run(&folder, "compare none.pfm b.pfm --json");
    let report: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert!(output.status.code() == Some(1) && report["rmse"].is_null() && report["relmse"].is_null());
}

#[test]
fn a_crop_lies_on_its_part_of_the_whole() {
    let folder = folder();
    json(&folder, "render room.toml -o whole.exr -o whole.pfm --json -q");
    json(&folder, "render room.toml --crop 5,3,10,8 -o crop.exr -o crop.pfm --json -q");
    json(&folder, "render room.toml --crop 6,3,10,8 -o right.exr --json -q");
    json(&folder, "render room.toml --crop 0,11,24,5 -o below.exr --json -q");
    for whole in ["whole.exr", "whole.pfm"] {
        for line in [format!("crop.exr {whole}"), format!("{whole} crop.exr")] {
            let report = json(&folder, &format!("compare {line} --max-rmse 0 --json"));
            assert_eq!(report["part"], serde_json::json!({ "x": 5, "y": 3, "width": 10, "height": 8 }));
        }
    }
    assert_eq!(json(&folder, "compare crop.exr right.exr --max-rmse 0 --json")["width"], 9);
    assert_eq!(json(&folder, "compare crop.exr crop.pfm --max-rmse 0 --json")["width"], 10);
    assert!(json(&folder, "compare whole.exr whole.pfm --max-rmse 0 --json")["part"].is_null());
    let output = run(&folder, "compare crop.exr whole.exr");
    assert!(stderr(&output).contains("what both hold, 10x8 pixels at 5,3"), "{}", stderr(&output));
    assert!(stdout(&output).contains("no pixel differs"), "{}", stdout(&output));
    let output = run(&folder, "compare crop.exr below.exr");
    assert!(output.status.code() == Some(2) && stderr(&output).contains("no pixel is in both"), "{}", stderr(&output));
    // A crop of another format has no place.
    assert_eq!(run(&folder, "compare crop.pfm whole.exr").status.code(), Some(2));
}

#[test]
fn a_crop_of_fewer_pixels_lies_there_too() {
    let folder = folder();
    json(&folder, "render room.toml --downsample 2 --spp 1 -o whole.exr --json -q");
    json(&folder, "render room.toml --downsample 2 --spp 1 --crop 5,3,10,8 -o crop.exr --json -q");
    let report = json(&folder, "compare crop.exr whole.exr --max-rmse 0 -o difference.exr --json");
    assert_eq!(report["part"], serde_json::json!({ "x": 5, "y": 3, "width": 10, "height": 8 }));
    // The difference lies there as well.
    let report = json(&folder, "compare difference.exr crop.exr --json");
    assert_eq!(report["part"], Value::Null);
}

#[test]
fn what_an_image_file_really_is_is_told() {
    let folder = folder();
    json(&folder, "render room.toml -o good.png --json -q");
    for (name, content, answer) in [
        ("page.png", "<!DOCTYPE html><html>404</html>", "page.png: is no valid .png file: it is an HTML page"),
        ("lfs.exr", "version https://git-lfs.github.com/spec/v1\noid sha256:1\n", "it is a Git LFS pointer"),
        ("empty.hdr", "", "empty.hdr: is no valid .hdr file: it is empty"),
        ("mesh.pfm", "o Cube\nv 0 0 0\nv 1 0 0\n", "it is an OBJ mesh"),
        ("photo.jpg", "GIF89a", "photo.jpg: is a GIF image; images are read as .png, .exr, .pfm, .hdr"),
    ] {
        fs::write(folder.path().join(name), content).unwrap();
        let output = run(&folder, &format!("compare {name} good.png"));
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(answer), "{}", stderr(&output));
    }
    fs::copy(folder.path().join("good.png"), folder.path().join("good.exr")).unwrap();
    let output = run(&folder, "compare good.exr good.png --max-rmse 0");
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("note: good.exr: its content is that of a .png file"), "{}", stderr(&output));
}

#[test]
fn a_file_name_may_be_as_long_as_the_system_takes() {
    let folder = folder();
    let name = format!("{}.png", "a".repeat(246));
    json(&folder, &format!("render room.toml -o {name} --json -q"));
    assert!(folder.path().join(&name).is_file());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    let output = run(&folder, &format!("render room.toml -o {}{name}", "a".repeat(6)));
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("the file name is too long: it has 256 bytes"), "{}", stderr(&output));
    assert!(!stderr(&output).contains("folder"), "{}", stderr(&output));
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
    assert_eq!(first["bounce"], 0);
    let origin = first["origin"].as_array().expect("three numbers").iter().map(|x| x.as_f64().expect("a number"));
    assert!(origin.zip([0.0, -4.0, 1.0]).all(|(found, eye)| (found - eye).abs() < 1e-6), "{first}");
    let text = stdout(&run(&folder, "pixel room.toml 12 9 --sample 1"));
    assert!(text.contains("throughput") && text.contains("radiance of the sample"), "{text}");
}
