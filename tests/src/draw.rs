//! From a scene file, or a world, to an image: in any way that must not change a bit of it.

use std::fs;
use std::path::{Path, PathBuf};

use smalti_core::film::{Film, Image};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::settings::Settings;
use smalti_scene::Loaded;
use smalti_scheduler::{ADAPTIVE_TILE, Cancel, Goal, Outcome, Watch};

/// The root of the repository.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every scene file in `folder` (as seen from the root), in the order of their names.
pub fn scene_files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(repository().join(folder)).expect("a folder of the repository");
    let paths = entries.map(|entry| entry.expect("a file of the repository").path());
    let mut scenes: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    scenes.sort();
    scenes
}

/// What the scene file at `path` says.
pub fn load(path: &Path) -> Loaded {
    smalti_scene::load(path).unwrap_or_else(|error| panic!("{error}"))
}

/// What the scene `name` in `scenes/` says.
pub fn scene(name: &str) -> Loaded {
    load(&repository().join("scenes").join(name).with_extension("toml"))
}

/// How the machine works: no bit of an image depends on it.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Worker threads.
    pub threads: usize,
    /// Side of a tile, pixels.
    pub tile: u32,
    /// SIMD level.
    pub level: Level,
}

impl Default for Way {
    /// One thread, tiles of 32, the best level.
    fn default() -> Self {
        Self { threads: 1, tile: 32, level: Level::available()[0] }
    }
}

/// The renderer of `world` with `settings`.
pub fn renderer(world: &World, settings: &Settings, level: Level) -> Renderer {
    Renderer::new(world, settings.clone(), level).unwrap_or_else(|error| panic!("{error}"))
}

/// Renders, with someone watching or not.
pub fn render(world: &World, settings: &Settings, way: Way, watch: Option<Watch>) -> Outcome {
    let renderer = renderer(world, settings, way.level);
    let pool = smalti_scheduler::pool(way.threads).expect("threads");
    let film = Film::new(settings.area(), way.tile);
    smalti_scheduler::render(&renderer, film, &pool, &Cancel::default(), watch).expect("no panic")
}

/// The film of `world`; where samples go to the noise, its tiles are as that wants them.
pub fn film(world: &World, settings: &Settings, way: Way) -> Film {
    let renderer = renderer(world, settings, way.level);
    let pool = smalti_scheduler::pool(way.threads).expect("threads");
    let tile = if settings.adaptive { ADAPTIVE_TILE } else { way.tile };
    let noise = settings.adaptive.then_some(Box::new(smalti_measure::noise) as _);
    let (goal, film) = (Goal { noise, ..Goal::default() }, Film::new(settings.area(), tile));
    let hands = (&pool, &Cancel::default());
    smalti_scheduler::render_to(&goal, &renderer, film, hands, None, None).expect("no panic").film
}

/// The image of `world`.
pub fn draw(world: &World, settings: &Settings, way: Way) -> Image {
    render(world, settings, way, None).film.develop()
}
