//! Mesh files as programs write them, from the file to the picture.

use std::fs;

use crate::room::{folder, json, run, stderr};

/// The view is 4 × 4 at the mesh, which is black before a sky of 1: the mean of the picture is 1 - area / 16.
const VIEW: &str = "[camera]\neye = [0, 0, 1000]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nfov = 0.22918311\n\
                    [render]\nsize = [32, 32]\nspp = 16\n[environment]\nradiance = 1\n\
                    [material.black]\nlambert = { albedo = 0 }\n[[mesh]]\nmaterial = 'black'\n";

/// A square of 2 × 2 with a notch of 1 × 1.5.
const U: &str = "-1 -1 0\n1 -1 0\n1 1 0\n0.5 1 0\n0.5 -0.5 0\n-0.5 -0.5 0\n-0.5 1 0\n-1 1 0\n";
const PLATE: &str = "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n";

fn obj(vertices: &str, faces: &str) -> String {
    vertices.lines().map(|line| format!("v {line}\n")).collect::<String>() + faces
}

fn ply(vertices: &str, more: &str, element: &str, row: &str) -> String {
    let count = vertices.lines().count();
    let header = format!("ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\n");
    format!("{header}property float z\n{more}{element}\nend_header\n{vertices}{row}\n")
}

fn faces(index: &str) -> String {
    format!("element face 1\nproperty list uchar {index} vertex_indices")
}

#[test]
fn meshes_of_other_programs_have_their_area() {
    let folder = folder();
    let u_ply = ply(U, "", &faces("int"), "8 0 1 2 3 4 5 6 7");
    let nan = PLATE.replace(" 0\n", " 0 nan -nan 1.#QNAN\n");
    let normals = "property float nx\nproperty float ny\nproperty float nz\n";
    let strips = "element tristrips 1\nproperty list int int vertex_indices";
    for (name, text, mean) in [
        ("u.obj", obj(U, "f 1 2 3 4 5 6 7 8\n"), 0.84375),
        ("u.ply", u_ply.clone(), 0.84375),
        ("dart.obj", obj("1 -1 0\n-0.6 -0.6 0\n-1 1 0\n-1 -1 0\n", "f 1 2 3 4\n"), 0.95),
        ("mark.obj", format!("\u{feff}{}", obj(PLATE, "v 0 3 0\nf 1 2 3 4\n")), 0.75),
        ("mark.ply", format!("\u{feff}{u_ply}"), 0.84375),
        ("continued.obj", obj(PLATE, "f 1/1/1 2/2/1 \\\n  3/3/1 4/4/1\n"), 0.75),
        ("strip.ply", ply(PLATE, "", strips, "8 0 1 3 2 -1 0 1 2"), 0.75),
        ("nan.ply", ply(&nan, normals, &faces("int"), "4 0 1 2 3"), 0.75),
        ("floats.ply", ply(PLATE, "", &faces("float"), "4 0 1 2 3"), 0.75),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
        fs::write(folder.path().join("view.toml"), format!("{VIEW}file = '{name}'\n")).unwrap();
        let found = json(&folder, "render view.toml -q --json -o view.pfm")["mean"][0].as_f64().unwrap();
        assert!((found - mean).abs() < 2e-3, "{name}: {found} is not {mean}");
    }
    let vertices: Vec<String> = U.lines().map(|line| format!("[{}]", line.replace(' ', ","))).collect();
    let written = format!("vertices = [{}]\nfaces = [[0,1,2,3,4,5,6,7]]\n", vertices.join(","));
    fs::write(folder.path().join("view.toml"), format!("{VIEW}{written}")).unwrap();
    let found = json(&folder, "render view.toml -q --json -o view.pfm")["mean"][0].as_f64().unwrap();
    assert!((found - 0.84375).abs() < 2e-3, "{found}");
}

#[test]
fn what_a_mesh_holds_beside_its_faces_is_said_once() {
    let folder = folder();
    fs::write(folder.path().join("plate.obj"), obj(PLATE, "vn 0 0 1\nf 1 2 3 4\nl 1 2\n")).unwrap();
    let twice = "file = 'plate.obj'\n[[mesh]]\nmaterial = 'black'\nfile = 'plate.obj'\ntranslate = [0, 0, 1]\n";
    fs::write(folder.path().join("view.toml"), format!("{VIEW}{twice}")).unwrap();
    let note = "`plate.obj` also holds 1 normal and 1 line: not used";
    let output = run(&folder, "render view.toml --progress none --spp 1 -o view.pfm");
    assert_eq!(stderr(&output), format!("note: {note}\n"));
    assert_eq!(json(&folder, "explain view.toml --json")["notes"], serde_json::json!([note]));
}

#[test]
fn a_file_that_is_no_mesh_is_answered_with_what_it_is() {
    let folder = folder();
    for (bytes, parts) in [
        (&b"<!DOCTYPE html><html></html>"[..], ["a page in HTML", "fetch the file itself"]),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", ["git-lfs", "git lfs pull"]),
        (b"\xff\xfev\0 \x000\0", ["UTF-16", "UTF-8"]),
        (b"", ["is empty", "again"]),
    ] {
        fs::write(folder.path().join("view.toml"), format!("{VIEW}file = 'mesh.obj'\n")).unwrap();
        fs::write(folder.path().join("mesh.obj"), bytes).unwrap();
        let output = run(&folder, "render view.toml");
        assert_eq!(output.status.code(), Some(2));
        assert!(parts.iter().all(|part| stderr(&output).contains(part)), "{}", stderr(&output));
    }
}
