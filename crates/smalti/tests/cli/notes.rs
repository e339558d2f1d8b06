//! Notes: what is worth knowing and stops nothing is said once by every command that reads a scene, and stands in its JSON.

use std::fs;

use tempfile::TempDir;

use crate::room::{SCENE, folder, json, run, stderr, stdout};

const CLEAR: &str = "material `air` has an index of exactly 1 and cannot be seen: 1 surface is removed";
const DARK: &str = "nothing in the scene emits light: the image will be black";

/// The scene without a lamp, and with a surface that cannot be seen.
fn dark() -> TempDir {
    let folder = folder();
    let air = "[material.air]\ndielectric = { ior = 1 }\n\
               [[sphere]]\nmaterial = 'air'\ncentre = [2, 0, 1]\nradius = 0.5\n";
    let lamp = SCENE.find("[[light.quad]]").unwrap();
    fs::write(folder.path().join("dark.toml"), SCENE[..lamp].to_owned() + air).unwrap();
    folder
}

#[test]
fn each_note_is_printed_once() {
    let folder = dark();
    let expected = format!("note: {CLEAR}\nwarning: {DARK}\n");
    for line in ["render dark.toml --progress none", "doctor dark.toml --hunt", "scaling dark.toml --threads 1"] {
        let message = stderr(&run(&folder, line));
        assert!(message.starts_with(&expected), "{line}: {message}");
        assert_eq!(message.matches(CLEAR).count(), 1, "{line}: {message}");
    }
    let explained = run(&folder, "explain dark.toml");
    assert_eq!((stderr(&explained), stdout(&explained).matches(CLEAR).count()), (String::new(), 1));
    assert!(stdout(&explained).ends_with(&format!("\nnote: {CLEAR}\n\nwarning: {DARK}\n")));
}

#[test]
fn quiet_leaves_warnings() {
    let folder = dark();
    for line in ["render dark.toml -q", "doctor dark.toml --hunt -q"] {
        assert_eq!(stderr(&run(&folder, line)), format!("warning: {DARK}\n"), "{line}");
    }
}

#[test]
fn json_lists_notes_under_their_documented_name() {
    let folder = dark();
    let commands = [
        "render dark.toml -q --json",
        "explain dark.toml --json",
        "doctor dark.toml --hunt --json",
        "scaling dark.toml --threads 1 -q --json",
    ];
    for line in commands {
        assert_eq!(json(&folder, line)["notes"], serde_json::json!([CLEAR, DARK]), "{line}");
    }
    assert_eq!(json(&folder, "render room.toml -q --json")["notes"], serde_json::json!([]));
}
