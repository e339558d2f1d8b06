//! Every broken scene in `tests/scenes/bad`, given to the program: exit code 2, the answer on stderr, and nothing else.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The scenes that are broken, and the repository's root as their messages begin with it.
fn broken() -> (Vec<PathBuf>, String) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let entries = fs::read_dir(root.join("tests/scenes/bad")).expect("the folder of broken scenes");
    let paths = entries.map(|entry| entry.expect("a file").path());
    let scenes: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert!(scenes.len() > 70, "only {} scenes were found", scenes.len());
    (scenes, format!("{}/", root.display()))
}

#[test]
fn every_broken_scene_is_refused() {
    let (scenes, root) = broken();
    let folder = tempfile::tempdir().expect("a folder");
    for scene in scenes {
        let expected = fs::read_to_string(scene.with_extension("expected")).expect("the answer beside the scene");
        let commands: [&[&str]; 3] = [&["render", "-o", "picture.exr"], &["explain"], &["pixel"]];
        for command in commands {
            let mut program = Command::new(env!("CARGO_BIN_EXE_smalti"));
            program.current_dir(&folder).args(command).arg(&scene).stdin(Stdio::null());
            if command == ["pixel"] {
                program.args(["0", "0"]);
            }
            let output = program.output().expect("the program starts");
            let what = format!("{} {}", command[0], scene.display());
            let answer = String::from_utf8_lossy(&output.stderr).replace(&root, "");
            assert_eq!(output.status.code(), Some(2), "{what}: {answer}");
            assert_eq!(answer.trim_end(), expected.trim_end(), "{what}");
            assert!(output.stdout.is_empty(), "{what} prints something");
            assert_eq!(fs::read_dir(&folder).expect("the folder").count(), 0, "{what} leaves a file behind");
        }
    }
}
