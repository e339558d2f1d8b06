//! `photons`: the picture of a map, its account, and what cannot be shown.

use std::fs;

use tempfile::TempDir;

use crate::room::{SCENE, folder, json, refuses, run, stderr, stdout};

#[test]
fn a_photon_map_becomes_a_picture() {
    let folder = folder();
    let output = run(&folder, "photons room.toml --photons 20000 --progress none");
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    assert!(folder.path().join("room-photons.png").is_file());
    for part in ["room-photons.png", "caustic map", "20000 emitted", "W emitted", "radius", "hash", "smalti photons"] {
        assert!(stdout(&output).contains(part), "{part}: {}", stdout(&output));
    }
}

#[test]
fn the_account_of_a_photon_map_has_every_documented_field() {
    let folder = folder();
    let summary = json(&folder, "photons room.toml --photons 20000 -o a.exr -o a.png --threads 2 --json -q");
    let fields = "version scene scene_hash notes map colour camera width height crop spp seed fresnel radius lights threads simd \
                  tile setup_seconds photon_seconds render_seconds write_seconds wall_seconds photons_emitted \
                  photons_ahead photons_stored photons_nonfinite flux radius_metres photon_bytes peak_bytes hash mean \
                  scale nonfinite stopped_by outputs reproduce";
    for field in fields.split_whitespace() {
        assert!(summary.get(field).is_some(), "{field}");
    }
    assert_eq!((&summary["map"], &summary["colour"]), (&"caustic".into(), &"flux".into()));
    assert_eq!(summary["photons_emitted"], 20_000);
    assert!(summary["photons_stored"].as_u64() > Some(0) && summary["mean"][0].as_f64() > Some(0.0));
    assert_eq!(summary["outputs"], serde_json::json!(["a.exr", "a.png"]));
    let radius = &summary["radius_metres"];
    assert!(radius["least"].as_f64() > Some(0.0) && radius["least"].as_f64() <= radius["most"].as_f64());
}

/// The light of the map of all light is that of the lamp: 5 W m⁻² sr⁻¹ from 4 m² are 20π W.
#[test]
fn no_flux_is_lost() {
    let folder = folder();
    let summary = json(&folder, "photons room.toml --map global --photons 20000 --json -q");
    for channel in 0..3 {
        let watts = |part: &str| summary["flux"][part][channel].as_f64().unwrap();
        let (emitted, stored) = (watts("emitted"), watts("stored"));
        assert!((emitted - 20.0 * std::f64::consts::PI).abs() < 1e-3 * emitted, "{emitted}");
        assert!((stored + watts("absorbed") + watts("escaped") - emitted).abs() < 1e-4 * emitted);
    }
}

#[test]
fn neither_threads_nor_lanes_change_a_photon_map() {
    let folder = folder();
    for colour in ["flux", "density", "bounces"] {
        let line = format!("photons room.toml --photons 20000 --colour {colour} --map global --json -q");
        let one = json(&folder, &format!("{line} --threads 1"));
        let two = json(&folder, &format!("{line} --threads 2 --tile 5 --simd scalar"));
        assert_eq!((&one["hash"], &one["flux"]), (&two["hash"], &two["flux"]), "{colour}");
        assert_ne!(one["hash"], json(&folder, &format!("{line} --seed 1"))["hash"], "{colour}");
        assert_eq!(one["scale"].is_null(), colour == "flux");
    }
}

#[test]
fn the_command_in_the_account_shows_the_same_map() {
    let folder = folder();
    let flags = "--photons 5000 --map global --colour density --radius 0.25 --size 20x10 --crop 2,1,9,8 --spp 3 --seed 5 \
                 --camera above --fresnel schlick";
    let first = json(&folder, &format!("photons room.toml {flags} --json -q"));
    let changed = SCENE.replace("size = [24, 16]", "size = [30, 30]").replace("spp = 2", "spp = 5\nseed = 3");
    fs::write(folder.path().join("room.toml"), changed).unwrap();
    let line = first["reproduce"].as_str().unwrap().strip_prefix("smalti ").unwrap().to_owned();
    assert_eq!(json(&folder, &format!("{line} --json -q"))["hash"], first["hash"]);
    assert_eq!(first["radius_metres"]["least"], first["radius_metres"]["most"]);
}

/// A scene with every kind of light, and what it is called.
fn with_lights(folder: &TempDir, name: &str, lights: &str) -> String {
    let (room, _) = SCENE.split_once("[[light.quad]]").unwrap();
    fs::write(folder.path().join(name), format!("{room}{lights}")).unwrap();
    format!("photons {name} --photons 20000 --json -q")
}

#[test]
fn photons_leave_every_kind_of_light() {
    let folder = folder();
    let points = "[[light.point]]\nposition = [0, 0, 3]\nintensity = 5\n\
                  [[light.point]]\nposition = [1, 0, 3]\nintensity = [1, 2, 3]\n";
    let sphere = "[[light.sphere]]\ncentre = [0, 0, 3]\nradius = 0.2\nradiance = 9\n";
    for (lights, surfaces, count) in [(points, 0, 2), (sphere, 1, 0), (&format!("{points}{sphere}"), 1, 2)] {
        let line = with_lights(&folder, "lit.toml", lights);
        let summary = json(&folder, &line);
        assert_eq!(summary["lights"], serde_json::json!({ "surfaces": surfaces, "points": count }));
        assert!(summary["photons_stored"].as_u64() > Some(1000), "{summary}");
    }
}

#[test]
fn maps_that_would_be_empty_are_refused() {
    let folder = folder();
    let refused = |line: &str, parts: &[&str]| {
        let output = run(&folder, line);
        assert_eq!((output.status.code(), stdout(&output)), (Some(2), String::new()), "{}", stderr(&output));
        assert!(parts.iter().all(|part| stderr(&output).contains(part)), "{}", stderr(&output));
        assert!(!fs::read_dir(folder.path()).unwrap().any(|file| file.unwrap().path().extension().unwrap() != "toml"));
    };
    refused(&with_lights(&folder, "dark.toml", ""), &["no light"]);
    refused(&with_lights(&folder, "sky.toml", "[environment]\nradiance = 1\n"), &["no light with a place"]);
    let diffuse = SCENE.replace("material = \"glass\"", "material = \"floor\"");
    fs::write(folder.path().join("diffuse.toml"), diffuse).unwrap();
    refused("photons diffuse.toml --map caustic", &["no caustics", "--map global"]);
    let usual = json(&folder, "photons diffuse.toml --photons 1000 --json -q");
    assert_eq!(usual["map"], "global");
}

#[test]
fn photon_maps_that_make_no_sense() {
    refuses("photons room.toml --photons 0", &["--photons"]);
    refuses("photons room.toml --spp 17", &["--spp", "16"]);
    refuses("photons room.toml --radius 0", &["--radius", "greater than 0"]);
    refuses("photons room.toml --map all", &["caustic", "global"]);
    refuses("photons room.toml --colour red", &["flux", "density", "bounces"]);
    refuses("photons room.toml -o a.jpeg", &[".png"]);
    refuses("photons room.toml --camera abov", &["did you mean 'above'?"]);
}
