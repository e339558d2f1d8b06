//! Every scene file of the repository that is meant to work: it loads, it can be explained, and it renders.

use std::path::{Path, PathBuf};

use smalti_core::settings::Settings;
use smalti_tests::draw::{Way, load, render, renderer, scene_files};

/// What works: the scenes that a user opens first, and those of the tests.
fn working() -> Vec<PathBuf> {
    let mut scenes = scene_files("scenes");
    assert!(scenes.len() >= 5, "only {} scenes were found", scenes.len());
    scenes.extend(scene_files("tests/scenes/golden"));
    scenes
}

/// Settings of the scene, made small.
fn small(path: &Path) -> Settings {
    let settings = load(path).settings.settings();
    Settings { width: 40, height: 40, crop: None, spp: 4, ..settings }
}

#[test]
fn every_scene_loads_without_a_note() {
    for path in working() {
        let loaded = load(&path);
        assert!(loaded.notes.is_empty(), "{}: {:?}", path.display(), loaded.notes);
        assert!(!loaded.world.cameras.is_empty());
    }
}

#[test]
fn every_scene_is_explained_with_reasons() {
    for path in working() {
        let renderer = renderer(&load(&path).world, &small(&path), Way::default().level);
        let decisions = renderer.decisions();
        let subjects: Vec<&str> = decisions.iter().map(|decision| decision.subject).collect();
        for subject in ["accelerator", "stage", "ending", "film"] {
            assert!(subjects.contains(&subject), "{}: nothing is said of {subject}", path.display());
        }
        assert!(decisions.iter().all(|decision| !decision.reason.is_empty()), "{}", path.display());
    }
}

#[test]
fn every_scene_renders_something() {
    for path in working() {
        let outcome = render(&load(&path).world, &small(&path), Way { threads: 2, ..Way::default() }, None);
        let image = outcome.film.develop();
        assert_eq!((outcome.rejected.count, outcome.capped), (0, 0), "{}", path.display());
        assert!(image.pixels.as_flattened().iter().all(|value| value.is_finite() && *value >= 0.0));
        assert!(image.mean().iter().all(|mean| *mean > 0.0), "{} is black", path.display());
        assert!(image.pixels.iter().any(|pixel| *pixel != image.pixels[0]), "{} is of one colour", path.display());
    }
}
