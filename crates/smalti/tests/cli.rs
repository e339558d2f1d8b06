//! The program as it is typed: help, mistakes and their messages, exit codes, files, JSON.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A diffuse floor under a square light and a glass sphere, small enough to render in no time.
const SCENE: &str = r#"
[camera.front]
eye = [0, -4, 1]
look_at = [0, 0, 0.5]
up = [0, 0, 1]
fov = 60

[camera.above]
eye = [0, 0, 3]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 60

[render]
size = [24, 16]
spp = 2

[material.floor]
lambert = { albedo = [0.7, 0.5, 0.3] }
[material.glass]
dielectric = { ior = 1.5 }

[[polygon]]
material = "floor"
vertices = [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]]

[[sphere]]
material = "glass"
centre = [0, 0, 0.6]
radius = 0.5

[[light.quad]]
vertices = [[-1, -1, 4], [-1, 1, 4], [1, 1, 4], [1, -1, 4]]
radiance = [5, 5, 5]
"#;

/// A folder with the scene in it as `room.toml`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.toml"), SCENE).unwrap();
    folder
}

fn command(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_smalti"));
    command.current_dir(folder).args(line.split_whitespace()).stdin(Stdio::null());
    command
}

fn run(folder: &TempDir, line: &str) -> Output {
    command(folder.path(), line).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Runs what must succeed and prints JSON.
fn json(folder: &TempDir, line: &str) -> Value {
    let output = run(folder, line);
    assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Runs what is a mistake; the message must have every one of `parts`.
fn refuses(line: &str, parts: &[&str]) {
    let folder = folder();
    let output = run(&folder, line);
    assert_eq!(output.status.code(), Some(2), "{line}: {}", stderr(&output));
    assert_eq!(stdout(&output), "", "{line}");
    for part in parts {
        assert!(stderr(&output).contains(part), "{line}: '{part}' is not in\n{}", stderr(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{line} left a file");
}

#[test]
fn help_shows_examples_and_exit_codes() {
    let folder = folder();
    let help = stdout(&run(&folder, "--help"));
    for part in ["render", "explain", "scaling", "compare", "pixel", "photons", "Examples:", "Exit codes:"] {
        assert!(help.contains(part), "{part}");
    }
    for part in ["--shadow-rays", "--crop", "Ctrl-C", "[possible values: auto, path, photon, whitted]"] {
        assert!(stdout(&run(&folder, "render --help")).contains(part), "{part}");
    }
    assert_eq!(run(&folder, "help scaling").status.code(), Some(0));
}

#[test]
fn version_is_that_of_the_package() {
    assert_eq!(stdout(&run(&folder(), "--version")), concat!("smalti ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[test]
fn flags_that_are_not_known() {
    refuses("render room.toml --sspp 4", &["--sspp", "--spp"]);
    refuses("render room.toml --photons some", &["--photons"]);
    refuses("render room.toml --radius 0", &["--radius", "greater than 0"]);
    refuses("rendr room.toml", &["render"]);
    refuses("", &["Usage:"]);
}

#[test]
fn values_that_make_no_sense() {
    refuses("render room.toml --spp 0", &["--spp", "0"]);
    refuses("render room.toml --tile 0", &["--tile", "0"]);
    refuses("render room.toml --size 0x5", &["at least 1x1"]);
    refuses("render room.toml --size 1x65537", &["at most 65536x65536"]);
    refuses("render room.toml --size 640", &["WIDTHxHEIGHT"]);
    refuses("render room.toml --crop 1,2,3", &["X,Y,W,H"]);
    refuses("render room.toml --threads many", &["many"]);
    refuses("render room.toml --exposure nan", &["nan"]);
    refuses("render room.toml --integrator pth", &["path", "whitted"]);
    refuses("render room.toml --simd avx3", &["avx2", "scalar"]);
    refuses("scaling room.toml --threads 0", &["'max'"]);
    refuses("compare a.pfm b.pfm --max-rmse -1", &["0 or larger"]);
}

#[test]
fn what_the_scene_or_the_machine_lacks() {
    refuses("render room.toml --camera abov", &["did you mean 'above'?", "front, above"]);
    refuses("render room.toml --crop 20,0,8,8", &["20,0,8,8", "24x16"]);
    refuses("pixel room.toml 24 0", &["0 to 23", "0 to 15"]);
    let foreign = if cfg!(target_arch = "aarch64") { "avx2" } else { "neon" };
    refuses(&format!("explain room.toml --simd {foreign}"), &["this machine has no", "scalar"]);
}

#[test]
fn files_that_cannot_be_read_or_written() {
    refuses("render nowhere.toml", &["nowhere.toml"]);
    refuses("render room.toml -o room.jpeg", &["room.jpeg", ".png"]);
    refuses("render room.toml -o no/room.png", &["no/room.png", "folder"]);
    refuses("render room.toml -o a.png -o a.png", &["twice"]);
    refuses("compare room.pfm reference.pfm", &["room.pfm"]);
}

#[test]
fn mistakes_in_a_scene_name_the_line() {
    let folder = folder();
    fs::write(folder.path().join("bad.toml"), SCENE.replace("radius = 0.5", "radious = 0.5")).unwrap();
    let output = run(&folder, "explain bad.toml");
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(message.starts_with("error: ") && !message.starts_with("error: error"), "{message}");
    for part in ["bad.toml:", "radious", "radius"] {
        assert!(message.contains(part), "{message}");
    }
}

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
    let fields = "version scene scene_hash integrator sampler width height spp rounds shadow_rays max_bounces seed threads \
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

#[test]
fn a_crop_is_a_part_of_the_whole_image() {
    let folder = folder();
    json(&folder, "render room.toml -o whole.pfm --json -q");
    json(&folder, "render room.toml -o part.pfm --crop 5,4,7,6 --json -q");
    let pixels = |name: &str| {
        let bytes = fs::read(folder.path().join(name)).unwrap();
        let start = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').nth(2).unwrap().0 + 1;
        bytes[start..].chunks(12).map(<[u8]>::to_vec).collect::<Vec<_>>()
    };
    let (whole, part) = (pixels("whole.pfm"), pixels("part.pfm"));
    for (index, pixel) in part.iter().enumerate() {
        // A PFM begins with the bottom row.
        let (x, y) = (5 + index % 7, 4 + (5 - index / 7));
        assert_eq!(*pixel, whole[(15 - y) * 24 + x], "{x} {y}");
    }
}

#[test]
fn progress_as_json_leaves_nothing_but_json_on_stderr() {
    let folder = folder();
    let output = run(&folder, "render room.toml --progress json");
    assert_eq!(output.status.code(), Some(0));
    for line in stderr(&output).lines() {
        assert!(serde_json::from_str::<Value>(line).unwrap().is_object(), "{line}");
    }
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
    let fields = "version scene scene_hash map colour camera width height crop spp seed fresnel radius lights threads simd \
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

#[cfg(unix)]
mod unix {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Child, ChildStderr};
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::flag::register_conditional_shutdown;

    use super::*;

    const LONG: &str = "render room.toml --spp 1000000 --progress json --json -o a.pfm";

    /// Starts a render that takes long and waits until a pass of it is done.
    fn start(command: &mut Command) -> (Child, BufReader<ChildStderr>) {
        // What this process ignores (in the background, under nohup) its children would ignore too; what it handles,
        // they do not.
        for signal in [SIGHUP, SIGINT, SIGTERM] {
            register_conditional_shutdown(signal, 1, Arc::new(AtomicBool::new(true))).unwrap();
        }
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut events = BufReader::new(child.stderr.take().unwrap());
        let mut event = String::new();
        while !event.contains("pass_finished") {
            event.clear();
            assert!(events.read_line(&mut event).unwrap() > 0, "it ended");
        }
        (child, events)
    }

    fn send(signal: &str, child: &Child) {
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    }

    #[test]
    fn an_interrupt_keeps_the_picture() {
        for (signal, code) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
            let folder = folder();
            let (child, mut events) = start(&mut command(folder.path(), LONG));
            send(signal, &child);
            let mut rest = String::new();
            events.read_to_string(&mut rest).unwrap();
            let output = child.wait_with_output().unwrap();
            assert_eq!(output.status.code(), Some(code), "{rest}");
            assert!(rest.contains("interrupted by SIG"), "{rest}");
            assert!(folder.path().join("a.pfm").is_file());
            let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!((&summary["stopped_by"], &summary["target_reached"]), (&"interrupt".into(), &false.into()));
            assert!(summary["samples_least"].as_u64() > Some(0));
        }
    }

    #[test]
    fn an_ignored_hangup_stays_ignored() {
        let folder = folder();
        let script = format!("trap '' HUP; exec '{}' {LONG}", env!("CARGO_BIN_EXE_smalti"));
        let mut shell = Command::new("sh");
        let (child, mut events) = start(shell.current_dir(folder.path()).args(["-c", &script]));
        send("-HUP", &child);
        send("-TERM", &child);
        let mut rest = String::new();
        events.read_to_string(&mut rest).unwrap();
        assert_eq!(child.wait_with_output().unwrap().status.code(), Some(143));
        assert!(rest.contains("interrupted by SIGTERM"), "{rest}");
    }

    #[test]
    fn a_reader_that_goes_away_is_no_error() {
        let folder = folder();
        let mut child = command(folder.path(), "render room.toml --progress plain")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().unwrap().code(), Some(0));
        assert!(folder.path().join("room.png").is_file());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_not_the_users_mistake() {
        let folder = folder();
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = command(folder.path(), "explain room.toml").stdout(full).stderr(Stdio::piped()).output().unwrap();
        assert_eq!(output.status.code(), Some(74), "{}", stderr(&output));
    }
}
