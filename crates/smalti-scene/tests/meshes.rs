//! Mesh files as they are met: each has its area, its triangles and its notes, or its answer.

use std::fs;

use glam::DVec3;
use smalti_core::scene::world::Mesh;
use smalti_scene::{Loaded, load};

const AROUND: &str = "[camera]\neye = [0, -5, 1]\nlook_at = [0, 0, 1]\nup = [0, 0, 1]\nfov = 60\n\
                      [material.white]\nlambert = { albedo = 0.5 }\n[environment]\nradiance = 1\n\
                      [[mesh]]\nmaterial = 'white'\n";

/// The scene of one mesh file, or the answer to it.
fn scene(name: &str, bytes: &[u8]) -> Result<Loaded, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(folder.path().join(name), bytes).unwrap();
    fs::write(&path, format!("{AROUND}file = '{name}'\n")).unwrap();
    load(&path).map_err(|error| error.to_string())
}

/// The sum of all triangles' areas, and of their areas times normals.
fn areas(mesh: &Mesh) -> (f64, DVec3) {
    let vector = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|index| mesh.vertices[index as usize]);
        (b - a).cross(c - a) / 2.0
    };
    let vectors = mesh.faces.iter().map(vector);
    (vectors.clone().map(DVec3::length).sum(), vectors.sum())
}

/// What is expected of a file: its area (all of it facing up), how many triangles, and its notes.
type Case<'c> = (&'c [u8], f64, usize, &'c [&'c str]);

fn check(name: &str, cases: &[Case]) {
    for (bytes, area, count, notes) in cases {
        let text = String::from_utf8_lossy(bytes);
        let loaded = scene(name, bytes).unwrap_or_else(|answer| panic!("{answer}\n{text}"));
        let mesh = &loaded.world.meshes[0];
        let (sum, vector) = areas(mesh);
        assert!((sum - area).abs() < 1e-6 && (vector - DVec3::Z * *area).length() < 1e-6, "{sum} in\n{text}");
        assert_eq!(mesh.faces.len(), *count, "{text}");
        let found: Vec<&str> = loaded.notes.iter().map(|note| note.text.as_str()).collect();
        assert_eq!(found, *notes, "{text}");
    }
}

#[test]
fn obj_files_as_they_are_met() {
    check(
        "a.obj",
        &[
            // An L, from every kind of corner; clockwise it would face down.
            (b"v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n", 3.0, 4, &[]),
            (b"v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 2 3 4 5 6 1\n", 3.0, 4, &[]),
            (b"v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf -3 -2 -1 -6 -5 -4\n", 3.0, 4, &[]),
            // A square with a square hole, as a path that goes in and out.
            (
                b"v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\nf 1 2 3 4 1 5 6 7 8 5\n",
                8.0,
                8,
                &[],
            ),
            // Corners on edges, and corners twice.
            (b"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n", 4.0, 3, &[]),
            (b"v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 0\nf 1 1 2 3 3 4 5\n", 4.0, 2, &[]),
            // A mark, line ends of the first Macintosh, Latin-1.
            (b"\xef\xbb\xbf# \xe9\rv 0 0 0\rv 2 0 0\rv 0 2 0\rf 1 2 3\r", 2.0, 1, &[]),
            (b"\xef\xbb\xbfv 0 0 0\r\nv 2 0 0\r\nv 0 2 0\r\nf 1 \\\r\n2 \\\r\n3", 2.0, 1, &[]),
            (
                b"o caf\xe9\nusemtl \xff\nv 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n",
                2.0,
                1,
                &["`a.obj` also holds 1 material and 1 group: not used"],
            ),
            // What is not used is not looked at.
            (
                b"v 0 0 0\nv 2 0 0\nv 0 2 0\nvn nan inf -1.#IND\nvt x\nf 1/9/9 2//77 3/\n",
                2.0,
                1,
                &["`a.obj` also holds 1 normal and 1 texture coordinate: not used"],
            ),
            (
                b"v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\nf 1 2\nf 3\nf 1 2 1\nl 1 2\n",
                2.0,
                1,
                &[
                    "`a.obj`: 3 faces have fewer than three different corners and are dropped",
                    "`a.obj` also holds 1 line: not used",
                ],
            ),
        ],
    );
}

#[test]
fn faces_that_cross_themselves_are_noted() {
    let bow_tie = b"v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 1 0\nf 1 2 3 4\nf 4 3 2 1\n";
    let loaded = scene("a.obj", bow_tie).unwrap();
    assert_eq!(loaded.notes[0].text, "`a.obj`: 2 faces cross themselves: their triangles may overlap");
    assert_eq!(loaded.world.meshes[0].faces.len(), 4);
}

const VERTICES: &str = "property float x\nproperty float y\nproperty float z\n";

#[test]
fn ply_files_as_they_are_met() {
    let text = |header: &str, body: &str| {
        format!("ply\nformat ascii 1.0\nelement vertex 4\n{VERTICES}{header}end_header\n{body}").into_bytes()
    };
    let square = "0 0 0\n2 0 0\n2 2 0\n0 2 0\n";
    let faces = "element face 1\nproperty list uchar int vertex_index\n";
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let plain = text(faces, &format!("{square}4 0 1 2 3\n"));
    let dart = text(faces, "0 0 0\n2 1 0\n0 2 0\n0.5 1 0\n4 0 1 2 3\n");
    let strip = text(strips, &format!("{square}8 0 1 3 2 -1 0 0 1\n"));
    let normals = text("property float nx\n", "");
    let normals = String::from_utf8(normals).unwrap().replace("end_header\n", faces) + "end_header\n";
    let normals = normals + &square.replace(" 0\n", " 0 -1.#IND\n") + "4 0 1 2 3\n";
    let edges = text(
        &format!("element edge 2\nproperty int a\nproperty list uchar int b\n{faces}"),
        &format!("{square}7 0\n8 2 1 1\n4 0 1 2 3\n"),
    );
    check(
        "a.ply",
        &[
            (&plain, 4.0, 2, &[]),
            (&[b"\xef\xbb\xbf", &plain[..]].concat(), 4.0, 2, &[]),
            (&String::from_utf8_lossy(&plain).replace('\n', "\r").into_bytes(), 4.0, 2, &[]),
            (&String::from_utf8_lossy(&plain).replace("uchar int", "uint8 float32").into_bytes(), 4.0, 2, &[]),
            (&[&b"ply\ncomment caf\xe9\n"[..], &plain[4..]].concat(), 4.0, 2, &[]),
            (&dart, 1.5, 2, &[]),
            (&strip, 4.0, 2, &[]),
            (normals.as_bytes(), 4.0, 2, &["`a.ply` also holds 4 normals: not used"]),
            (&edges, 4.0, 2, &["`a.ply` also holds 2 `edge`: not used"]),
        ],
    );
}

#[test]
fn binary_files_have_the_mesh_of_their_text() {
    for big in [false, true] {
        let number = |value: f32| if big { value.to_be_bytes() } else { value.to_le_bytes() };
        let order = if big { "big" } else { "little" };
        let faces = "element face 1\nproperty uchar red\nproperty list ushort float vertex_indices\n";
        let header = format!("ply\nformat binary_{order}_endian 1.0\nelement vertex 4\n{VERTICES}{faces}end_header\n");
        // A dart of area 1.5, whose corners are written as floats.
        let mut bytes = header.into_bytes();
        bytes.extend(
            [[0., 0., 0.], [2., 1., 0.], [0., 2., 0.], [0.5, 1., 0.]]
                .as_flattened()
                .iter()
                .flat_map(|value| number(*value)),
        );
        bytes.push(9);
        bytes.extend(if big { 4u16.to_be_bytes() } else { 4u16.to_le_bytes() });
        bytes.extend([0., 1., 2., 3.].map(number).as_flattened());
        check("a.ply", &[(&bytes, 1.5, 2, &["`a.ply` also holds 1 colour: not used"])]);
        let last = bytes.len() - 4;
        bytes[last..].copy_from_slice(&number(2.5));
        let answer = scene("a.ply", &bytes).unwrap_err();
        assert!(answer.contains("`2.5` is not the number of a vertex (`face` 0"), "{answer}");
    }
}

/// No word of a parser's own types comes through.
#[test]
fn what_cannot_be_read_is_answered_in_the_words_of_the_file() {
    let plain = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\n{VERTICES}element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    );
    for (name, text, parts) in [
        ("a.ply", plain.replace("3 0 1 2", "3 0 1 x"), ["a.ply:13:1", "`x` is not a number"]),
        ("a.ply", plain.replace("3 0 1 2", "3 0 1"), ["a.ply:13:1", "the row ends too early"]),
        ("a.ply", plain.replace("1 0 0", "1 0 nan"), ["a.ply:11:1", "a vertex is not finite"]),
        ("a.ply", plain.replace("face 1", "face -1"), ["a.ply:7:1", "`-1` is not a number of `face`"]),
        ("a.ply", plain.replace("uchar int", "uchar string"), ["a.ply:8:1", "`string` is not a type"]),
        (
            "a.ply",
            plain.replace("uchar int vertex_indices", "uchar int corners"),
            ["there is no face", "vertex_indices"],
        ),
        ("a.ply", plain.replace("ascii", "binary_little_endian"), ["bytes", "cut short?"]),
        ("a.ply", "v 0 0 0\n".to_owned(), ["is an OBJ file", "end in .obj"]),
        ("a.obj", plain.clone(), ["is a PLY file", "end in .ply"]),
        ("a.obj", "\u{feff}v 0 0\n".to_owned(), ["a.obj:1:1", "three coordinates"]),
        ("a.obj", "v 0 0 0\rv 1 0 0\rf 1 2 3\r".to_owned(), ["a.obj:3:1", "vertex 3"]),
        ("a.obj", "v 0 0 0\np 1\n".to_owned(), ["there is no face in it", "only 1 point"]),
        ("a.obj", "# nothing\n".to_owned(), ["there is no face in it", "error"]),
    ] {
        let answer = scene(name, text.as_bytes()).unwrap_err();
        assert!(parts.iter().all(|part| answer.contains(part)), "{parts:?} in\n{answer}");
        assert!(!["Property", "ParseInt", "pLY", "{ "].iter().any(|word| answer.contains(word)), "{answer}");
    }
}
