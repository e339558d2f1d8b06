//! What fuzzers ask: whatever bytes come in, the answer is a picture or a message. Never a panic, never without end, never
//! more memory than the bytes deserve.
//!
//! Each kind of input is a function of bytes. `tests/tests/fuzz.rs` calls them with the corpus and with damage to it,
//! `tests/fuzz` with what a coverage-guided fuzzer thinks of (`just fuzz`).

mod built;
mod damage;
mod image;
mod photons;
mod scene;

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

pub use built::text as built_text;
pub use damage::damage;

/// A kind of input.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// The name of its folder in the corpus, and of its fuzzer.
    pub name: &'static str,
    /// Takes an input. Panics where something is wrong.
    pub ask: fn(&[u8]),
}

/// All kinds.
pub const KINDS: [Kind; 5] = [
    Kind { name: "scene", ask: scene::ask },
    Kind { name: "built", ask: built::ask },
    Kind { name: "mesh", ask: scene::ask_mesh },
    Kind { name: "image", ask: image::ask },
    Kind { name: "photons", ask: photons::ask },
];

/// A folder in memory for the files of this thread.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    thread_local! {
        static FOLDER: TempDir = folder();
    }
    let path = FOLDER.with(|folder| folder.path().join(name));
    fs::write(&path, bytes).expect("a file can be written");
    path
}

fn folder() -> TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).expect("a folder")
}
