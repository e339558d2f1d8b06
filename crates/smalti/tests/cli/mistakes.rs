//! Help, mistakes and their messages.

use std::fs;

use crate::room::{SCENE, folder, refuses, run, stderr, stdout};

#[test]
fn help_shows_examples_and_exit_codes() {
    let folder = folder();
    let help = stdout(&run(&folder, "--help"));
    for part in
        ["render", "explain", "scaling", "compare", "pixel", "photons", "study", "report", "Examples:", "Exit codes:"]
    {
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
    refuses("render room.toml --downsample 0", &["--downsample", "0"]);
    refuses("render room.toml --size 40000x1 --downsample 2", &["--downsample 2", "80000x2"]);
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
