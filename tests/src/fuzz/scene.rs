//! Scene files and mesh files: what is accepted is rendered too.

use std::sync::atomic::AtomicU64;

use smalti_core::film::{Film, Image};
use smalti_core::photon::Maps;
use smalti_core::photon::maps::Pilots;
use smalti_core::render::{Level, Renderer};
use smalti_core::settings::{Integrator, Settings};
use smalti_scene::Loaded;

use super::file;

/// The scene around a mesh file.
const AROUND: &str = "[camera]\neye = [0, -5, 1]\nlook_at = [0, 0, 1]\nup = [0, 0, 1]\nfov = 60\n\
    [material.white]\nlambert = { albedo = 0.5 }\n[environment]\nradiance = 1\n[[mesh]]\nmaterial = \"white\"\n";

/// A scene file.
pub fn ask(bytes: &[u8]) {
    match smalti_scene::load(&file("scene.toml", bytes)) {
        Ok(loaded) => render(&loaded),
        Err(error) => assert!(error.render(true).contains("error"), "an answer without a word"),
    }
}

/// A mesh file: PLY where it begins like one, else OBJ.
pub fn ask_mesh(bytes: &[u8]) {
    let name = if bytes.starts_with(b"ply") { "mesh.ply" } else { "mesh.obj" };
    file(name, bytes);
    ask(format!("{AROUND}file = \"{name}\"\n").as_bytes());
}

/// Renders a stamp of it by each integrator.
pub fn render(loaded: &Loaded) {
    for integrator in Integrator::ALL {
        let table = &loaded.settings;
        let settings = Settings {
            integrator,
            width: 5,
            height: 4,
            spp: 2,
            // Rooms that absorb nothing keep their paths for very long.
            max_bounces: Some(table.max_bounces.unwrap_or(12).min(12)),
            shadow_rays: table.shadow_rays.unwrap_or(1).min(3),
            seed: table.seed.unwrap_or(0),
            photons: Some(table.photons.unwrap_or(512).min(512)),
            radius: table.radius,
            ..Settings::default()
        };
        // A plan may refuse settings, with its reason.
        if let Ok(renderer) = Renderer::new(&loaded.world, settings, Level::available()[0]) {
            let maps = renderer.maps(0, Pilots::default(), &AtomicU64::new(0));
            check(&stamp(&renderer, &maps), &maps);
        }
    }
}

/// All samples of the first round.
pub fn stamp(renderer: &Renderer, maps: &Maps) -> Image {
    let mut film = Film::new(renderer.settings().area(), 8);
    let mut workspace = renderer.workspace();
    for tile in &mut film.tiles {
        renderer.advance(tile, renderer.settings().spp, maps, &mut workspace, &AtomicU64::new(0));
    }
    film.develop()
}

/// A picture holds radiance: finite, and not negative. (Where shadow photons say that a light is seen and a shadow ray
/// finds that it is not, the difference counts for others, and a pixel of few samples can be below 0.)
pub fn check(image: &Image, maps: &Maps) {
    let least = if maps.visibility.is_some() { f32::MIN } else { 0.0 };
    for value in image.pixels.as_flattened() {
        assert!(value.is_finite() && *value >= least, "radiance {value}");
    }
}
