//! A mesh file that is named several times is read once, and whoever watches hears of it before.

use std::cell::RefCell;
use std::fs;
use std::path::Path;

use smalti_scene::{Loaded, Reading, SceneError, load, load_watched};
use tempfile::TempDir;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A folder with a scene of these meshes; each is a file and where it is moved to.
fn folder(meshes: &[(&str, f64)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nfov = 40\n\
                     [environment]\nradiance = 1\n[material.white]\nlambert = { albedo = 0.5 }\n"
        .to_owned();
    for (file, x) in meshes {
        scene += &format!("[[mesh]]\nmaterial = \"white\"\nfile = \"{file}\"\ntranslate = [{x}, 0, 0]\n");
    }
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    fs::create_dir(folder.path().join("meshes")).unwrap();
    fs::write(folder.path().join("meshes/a.obj"), TRIANGLE).unwrap();
    fs::write(folder.path().join("b.obj"), TRIANGLE.replace('1', "1.0").replace("f 1.0", "f 1")).unwrap();
    folder
}

/// The scene, and the names and lengths of the files that were read for it.
fn watched(folder: &TempDir) -> (Result<Loaded, SceneError>, Vec<(String, u64)>) {
    let heard = RefCell::new(Vec::new());
    let watch = |reading: &Reading| {
        let name = reading.path.strip_prefix(folder.path()).unwrap_or(reading.path);
        heard.borrow_mut().push((name.display().to_string(), reading.bytes));
        Ok(())
    };
    let loaded = load_watched(&folder.path().join("scene.toml"), &watch);
    (loaded, heard.into_inner())
}

#[test]
fn a_file_that_is_named_several_times_is_read_once() {
    let names = ["meshes/a.obj", "b.obj", "meshes/../meshes/a.obj", "./meshes/a.obj", "b.obj"];
    let folder = folder(&[0.0, 1.0, 2.0, 3.0, 4.0].map(|x| (names[x as usize], x)));
    let (loaded, heard) = watched(&folder);
    let length = |name: &str| fs::metadata(folder.path().join(name)).unwrap().len();
    let expected = ["meshes/a.obj", "b.obj"].map(|name| (name.to_owned(), length(name)));
    assert_eq!(heard, expected);
    let meshes = loaded.unwrap().world.meshes;
    let corners: Vec<f64> = meshes.iter().map(|mesh| mesh.vertices[0].x).collect();
    assert_eq!(corners, [0.0, 1.0, 2.0, 3.0, 4.0], "each has its own place");
    assert!(meshes.iter().all(|mesh| mesh.faces == [[0, 1, 2]]));
}

#[test]
fn a_scene_is_the_same_whether_its_files_are_one_or_copies() {
    let shared = folder(&[("meshes/a.obj", 0.0), ("meshes/a.obj", 2.0)]);
    let copies = folder(&[("meshes/a.obj", 0.0), ("copy.obj", 2.0)]);
    fs::write(copies.path().join("copy.obj"), TRIANGLE).unwrap();
    let hash = |folder: &TempDir| load(&folder.path().join("scene.toml")).unwrap().scene_hash;
    assert_eq!(hash(&shared), hash(&copies));
}

#[cfg(unix)]
#[test]
fn another_name_of_the_same_file_is_the_same_file() {
    let folder = folder(&[("meshes/a.obj", 0.0), ("link.obj", 2.0), ("meshes/a.obj", 4.0)]);
    std::os::unix::fs::symlink("meshes/a.obj", folder.path().join("link.obj")).unwrap();
    let (loaded, heard) = watched(&folder);
    assert_eq!((loaded.unwrap().world.meshes.len(), heard.len()), (3, 1));
}

#[test]
fn a_file_that_is_missing_is_answered_at_its_first_place() {
    let folder = folder(&[("b.obj", 0.0), ("c.obj", 1.0), ("c.obj", 2.0)]);
    let message = watched(&folder).0.unwrap_err().to_string();
    assert!(message.contains("there is no such mesh file") && message.contains("scene.toml:16:8"), "{message}");
}

#[test]
fn whoever_watches_may_refuse_a_file() {
    let folder = folder(&[("b.obj", 0.0)]);
    let refuse = |reading: &Reading| match reading.path.ends_with(Path::new("b.obj")) {
        true => Err("the mesh file is too large".to_owned()),
        false => Ok(()),
    };
    let message = load_watched(&folder.path().join("scene.toml"), &refuse).unwrap_err().to_string();
    assert!(message.contains("error: the mesh file is too large") && message.contains("file = \"b.obj\""), "{message}");
}
