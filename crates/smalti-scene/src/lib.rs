//! Scene files and meshes: read, checked, and handed to the core as a [`World`] with the settings that stand beside it.
//!
//! A scene is a TOML file whose tables are keyed by kind (`[material.glass]`, `[[sphere]]`, `[[light.quad]]`); the
//! files in `scenes/` teach the format by example. The way is one: text → TOML with spans (`document`) → world, each
//! value checked while its place in the file is at hand, so every mistake is answered with file, line and what was
//! perhaps meant ([`SceneError`]). Nothing is repaired silently: what is dropped is counted in [`Loaded::notes`].

mod camera;
mod document;
mod error;
mod file;
mod hash;
mod light;
mod material;
mod mesh;
mod note;
mod place;
mod polygon;
mod render_table;
mod soundness;
mod surface;
mod world;

use std::path::Path;

use smalti_core::scene::World;

pub use error::SceneError;
pub use mesh::{Reading, Watch};
pub use note::{Note, Severity};
pub use render_table::RenderTable;

/// What a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// Surfaces, lights and cameras, checked.
    pub world: World,
    /// The `[render]` table.
    pub settings: RenderTable,
    /// XXH3-128, 32 lower-case hex digits, of everything in the world that light or a camera can see: geometry after
    /// its transformation, each surface's material by value, emission, environment and views, in f64 and in order.
    /// Comments, formatting, names, paths, mesh file formats, unused materials and `[render]` do not change it.
    pub scene_hash: String,
    /// What was dropped, counted, and what looks unintended; in the order of the tables.
    pub notes: Vec<Note>,
}

/// Reads the scene file at `path` and the meshes that it names (relative to its folder), each file once.
///
/// # Errors
/// The first mistake in the scene file or in a mesh file, and files that cannot be read.
pub fn load(path: &Path) -> Result<Loaded, SceneError> {
    load_watched(path, &|_| Ok(()))
}

/// [`load`], of whose mesh files `watch` hears before they are read.
///
/// # Errors
/// The same, and what `watch` refuses.
pub fn load_watched(path: &Path, watch: &Watch) -> Result<Loaded, SceneError> {
    let name = path.display().to_string();
    let text = file::text(path).map_err(|(fault, text)| SceneError::new(&name, text, fault))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    document::parse(&text)
        .and_then(|document| world::read(&document, &text, (folder, watch)))
        .map_err(|fault| SceneError::new(&name, text, fault))
}
