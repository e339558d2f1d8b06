//! Every mistake in `tests/scenes/bad` is answered with the message beside it (`NAME.expected`).
//!
//! `SMALTI_BLESS=1 cargo test -p smalti-scene --test bad` rewrites the messages: read them before committing them.

use std::path::{Path, PathBuf};
use std::{env, fs};

const FOLDER: &str = "tests/scenes/bad";

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The message as it reads from the root of the repository.
fn message(scene: &Path) -> String {
    match smalti_scene::load(scene) {
        Ok(_) => format!("{} loads without an error", scene.display()),
        Err(error) => error.render(false).replace(&format!("{}/", repository().display()), "") + "\n",
    }
}

#[test]
fn every_mistake_gets_its_answer() {
    let entries = fs::read_dir(repository().join(FOLDER)).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    scenes.sort();
    assert!(scenes.len() > 70, "only {} scenes were found", scenes.len());
    let bless = env::var_os("SMALTI_BLESS").is_some();
    let mut wrong = Vec::new();
    for scene in &scenes {
        let (found, expected) = (message(scene), scene.with_extension("expected"));
        if bless {
            fs::write(&expected, &found).unwrap();
        }
        if fs::read_to_string(&expected).unwrap_or_default() != found {
            wrong.push(found);
        }
    }
    assert!(wrong.is_empty(), "{} messages differ from those expected:\n{}", wrong.len(), wrong.join("\n"));
}
