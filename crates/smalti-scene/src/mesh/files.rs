//! Mesh files as a scene names them: each is read once, however often it is named, and whoever watches hears of it before.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::document::{Node, Section};
use crate::error::{Fault, Result};

/// A mesh file that is about to be read.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// The file, as the scene names it, in the scene's folder.
    pub path: &'a Path,
    /// Its length.
    pub bytes: u64,
}

/// Someone who hears of each mesh file before it is read, and may refuse it with a reason: a sentence without a full stop.
pub type Watch<'a> = dyn Fn(&Reading) -> std::result::Result<(), String> + 'a;

/// The mesh files of a scene; `T` is what they are read to.
pub struct Files<'a, T> {
    folder: &'a Path,
    watch: &'a Watch<'a>,
    /// How often each file is still to be read.
    uses: HashMap<PathBuf, usize>,
    /// Files that were read and will be once more.
    kept: HashMap<PathBuf, T>,
}

impl<'a, T: Clone> Files<'a, T> {
    /// The files that `meshes` name, relative to `folder`.
    pub fn new(meshes: &[Section], folder: &'a Path, watch: &'a Watch<'a>) -> Self {
        let mut uses = HashMap::new();
        for name in meshes.iter().filter_map(|mesh| mesh.find("file")?.text().ok()) {
            *uses.entry(identity(&folder.join(name))).or_default() += 1;
        }
        Self { folder, watch, uses, kept: HashMap::new() }
    }

    /// The file that `node` names; `read` reads it unless it was read before.
    pub fn read(&mut self, node: Node, read: impl FnOnce(Node, &Path) -> Result<T>) -> Result<T> {
        let path = self.folder.join(node.text()?);
        let identity = identity(&path);
        let left = self.uses.get_mut(&identity).map_or(0, |uses| {
            *uses = uses.saturating_sub(1);
            *uses
        });
        let there = if left > 0 { self.kept.get(&identity).cloned() } else { self.kept.remove(&identity) };
        if let Some(there) = there {
            return Ok(there);
        }
        if let Ok(about) = path.metadata() {
            let reading = Reading { path: &path, bytes: about.len() };
            (self.watch)(&reading).map_err(|why| Fault::at(node.span(), why, ""))?;
        }
        let found = read(node, self.folder)?;
        if left > 0 {
            self.kept.insert(identity, found.clone());
        }
        Ok(found)
    }
}

/// What two names of one file have in common.
fn identity(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
