//! A scene in a folder of its own, and the program started there.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A diffuse floor under a square light and a glass sphere, small enough to render in no time.
pub const SCENE: &str = r#"
[camera.front]
eye = [0, -4, 1]
look_at = [0, 0, 0.5]
up = [0, 0, 1]
fov = 60

[camera.above]
eye = [0, 0, 3]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 60

[render]
size = [24, 16]
spp = 2

[material.floor]
lambert = { albedo = [0.7, 0.5, 0.3] }
[material.glass]
dielectric = { ior = 1.5 }

[[polygon]]
material = "floor"
vertices = [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]]

[[sphere]]
material = "glass"
centre = [0, 0, 0.6]
radius = 0.5

[[light.quad]]
vertices = [[-1, -1, 4], [-1, 1, 4], [1, 1, 4], [1, -1, 4]]
radiance = [5, 5, 5]
"#;

/// A folder with the scene in it as `room.toml`.
pub fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.toml"), SCENE).unwrap();
    folder
}

pub fn command(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_smalti"));
    command.current_dir(folder).args(line.split_whitespace()).stdin(Stdio::null());
    command
}

pub fn run(folder: &TempDir, line: &str) -> Output {
    command(folder.path(), line).output().unwrap()
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Runs what must succeed and prints JSON.
pub fn json(folder: &TempDir, line: &str) -> Value {
    let output = run(folder, line);
    assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Runs what is a mistake; the message must have every one of `parts`.
pub fn refuses(line: &str, parts: &[&str]) {
    let folder = folder();
    let output = run(&folder, line);
    assert_eq!(output.status.code(), Some(2), "{line}: {}", stderr(&output));
    assert_eq!(stdout(&output), "", "{line}");
    for part in parts {
        assert!(stderr(&output).contains(part), "{line}: '{part}' is not in\n{}", stderr(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{line} left a file");
}
