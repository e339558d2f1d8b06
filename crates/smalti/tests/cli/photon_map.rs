//! `--photon-map`: the same image with and without it, from any camera; and files that do not fit are refused.

use std::fs;
use std::path::PathBuf;
use std::process::Output;

use serde_json::Value;
use tempfile::TempDir;

use crate::room::{SCENE, json, run, stderr};

/// The room under a small lamp, whose caustics chance hardly finds.
fn scene() -> String {
    let [large, small] =
        [1.0, 0.2].map(|r| format!("[[-{r}, -{r}, 4], [-{r}, {r}, 4], [{r}, {r}, 4], [{r}, -{r}, 4]]"));
    let lit = SCENE.replace(&large, &small).replace("radiance = [5, 5, 5]", "radiance = [50, 50, 50]");
    lit.replace("spp = 2\n", "spp = 20\nphotons = 4000\n")
}

/// A folder with the scene.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("room.toml"), scene()).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn run(&self, flags: &str) -> Output {
        run(&self.0, &format!("render room.toml --json --progress none {flags}"))
    }

    fn render(&self, flags: &str) -> Value {
        json(&self.0, &format!("render room.toml --json --progress none {flags}"))
    }

    /// Asserts that the file is refused with this in the message, and nothing is made.
    fn refuses(&self, flags: &str, part: &str) {
        let before = fs::read_dir(self.0.path()).unwrap().count();
        let output = self.run(flags);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{flags}: {message}");
        assert!(message.contains(part), "{flags}: {message}");
        assert_eq!(fs::read_dir(self.0.path()).unwrap().count(), before, "{flags}");
    }
}

#[test]
fn renders_with_a_map_are_those_without() {
    let folder = Folder::new();
    for (camera, integrator) in [("front", "auto"), ("above", "auto"), ("front", "photon"), ("above", "photon")] {
        let flags = format!("--camera {camera} --integrator {integrator}");
        let kept = format!("{flags} --photon-map {integrator}.map");
        let (alone, shared, again) = (folder.render(&flags), folder.render(&kept), folder.render(&kept));
        assert_eq!(shared["hash"], alone["hash"], "{flags}");
        assert_eq!(again["hash"], alone["hash"], "{flags}");
        assert_eq!(again["photons_stored"], alone["photons_stored"]);
        // The first camera traced for both.
        assert_eq!(shared["photons_emitted"] == 0, camera == "above", "{flags}");
        assert_eq!(again["photons_emitted"], 0);
    }
}

#[test]
fn a_map_grows_with_the_rounds_that_are_asked() {
    let folder = Folder::new();
    let first = folder.render("--spp 10 --photon-map a.map");
    let more = folder.render("--spp 40 --photon-map a.map");
    // One round was there, and with it what is sent ahead.
    assert_eq!(first["photons_emitted"], 4000 + 32_768);
    assert_eq!(more["photons_emitted"], 2 * 4000);
    assert_eq!(more["hash"], folder.render("--spp 40")["hash"]);
    assert_eq!(folder.render("--spp 40 --photon-map a.map")["photons_emitted"], 0);
}

#[test]
fn without_a_number_of_photons_that_of_the_file_is_taken() {
    let folder = Folder::new();
    let scene = scene().replace("photons = 4000\n", "");
    fs::write(folder.path("room.toml"), scene).unwrap();
    let first = folder.render("--photons 2000 --photon-map a.map");
    let second = folder.render("--size 300x16 --spp 1 --photon-map a.map");
    assert_eq!((&first["photons"], &second["photons"]), (&Value::from(2000), &Value::from(2000)));
}

#[test]
fn a_map_may_have_a_long_name() {
    let folder = Folder::new();
    let name = format!("{}.map", "a".repeat(240));
    let first = folder.render(&format!("--photon-map {name}"));
    assert!(folder.path(&name).is_file());
    let again = folder.render(&format!("--photon-map {name}"));
    assert_eq!((&again["photons_emitted"], &again["hash"]), (&Value::from(0), &first["hash"]));
}

#[test]
fn what_does_not_fit_is_refused_with_the_reason() {
    let folder = Folder::new();
    folder.render("--photon-map a.map");
    folder.refuses("--photon-map a.map --seed 7", "seed is 0, this render asks for 7");
    folder.refuses("--photon-map a.map --photons 5000", "number of photons is 4000, this render asks for 5000");
    folder.refuses("--photon-map a.map --integrator photon", "integrator is auto");
    folder.refuses("--photon-map a.map --integrator path", "asks no photons");
    folder.refuses("--photon-map a.map --radius 0.5", "radius is none");
    folder.refuses("--photon-map a.map --size 24x17", "height of the picture is 16, this render asks for 17");
    fs::write(folder.path("room.toml"), scene().replace("radius = 0.5", "radius = 0.4")).unwrap();
    folder.refuses("--photon-map a.map", "scene");
    folder.refuses("--photon-map nowhere/a.map", "nowhere");
}

#[test]
fn damaged_truncated_and_foreign_files_are_refused() {
    let folder = Folder::new();
    folder.render("--photon-map a.map");
    let whole = fs::read(folder.path("a.map")).unwrap();
    // Every place of the beginning, where the structure is, and some of the rest.
    let places = (0..300).step_by(7).chain((300..whole.len()).step_by(whole.len() / 40));
    for place in places {
        let mut damaged = whole.clone();
        damaged[place] ^= 0x10;
        fs::write(folder.path("a.map"), damaged).unwrap();
        folder.refuses("--photon-map a.map", "a.map");
        fs::write(folder.path("a.map"), &whole[..place]).unwrap();
        folder.refuses("--photon-map a.map", "a.map");
    }
    fs::write(folder.path("a.map"), "P6 24 16 255 and so on, for longer than a header is").unwrap();
    folder.refuses("--photon-map a.map", "is no photon map");
    fs::write(folder.path("a.map"), &whole).unwrap();
    folder.render("--photon-map a.map");
}
