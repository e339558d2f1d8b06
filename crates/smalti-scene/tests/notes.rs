//! What loads with a warning, and what a scene's hash depends on.

use std::fs;
use std::path::Path;

use smalti_core::scene::World;
use smalti_scene::{Loaded, Note, Severity, load};

const CAMERA: &str = "[camera]\neye = [0, -5, 1]\nlook_at = [0, 0, 1]\nup = [0, 0, 1]\nfov = 60\n\
                      [material.white]\nlambert = { albedo = 0.5 }\n[environment]\nradiance = 1\n";

/// Loads `CAMERA` and `rest` from `folder`.
fn scene(folder: &Path, rest: &str) -> Loaded {
    let path = folder.join("scene.toml");
    fs::write(&path, format!("{CAMERA}{rest}")).unwrap();
    load(&path).unwrap_or_else(|error| panic!("{error}"))
}

fn alone(rest: &str) -> Loaded {
    scene(tempfile::tempdir().unwrap().path(), rest)
}

fn counts(world: &World) -> [usize; 3] {
    [world.polygons.len(), world.spheres.len(), world.meshes.len()]
}

#[test]
fn clear_surfaces_are_removed_unless_they_emit() {
    let ball = "[[sphere]]\nmaterial = 'air'\ncentre = [0, 0, 0]\nradius = 1\n";
    let triangle = "[[triangle]]\nmaterial = 'air'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n";
    let air =
        |ior: &str| format!("[material.air]\ndielectric = {{ ior = {ior} }}\n{ball}{triangle}{ball}radiance = 1\n");
    let loaded = alone(&air("1"));
    assert_eq!(counts(&loaded.world), [0, 1, 0]);
    let note = "material `air` has an index of exactly 1 and cannot be seen: 2 surfaces are removed";
    assert_eq!(loaded.notes, [Note::new(note)]);
    assert_eq!(counts(&alone(&air("1.0000001")).world), [1, 2, 0]);
}

#[test]
fn triangles_without_area_are_dropped_and_noted() {
    let mesh = "[[mesh]]\nmaterial = 'white'\nvertices = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]]\n\
                faces = [[0, 1, 2], [0, 1, 3]]\n";
    let loaded = alone(mesh);
    assert_eq!(loaded.notes, [Note::new("mesh 1: 1 of 2 triangles have no area and are dropped")]);
    assert_eq!(loaded.world.meshes[0].faces, [[0, 1, 3]]);
}

#[test]
fn a_dark_scene_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dark.toml");
    let dark = "[[light.point]]\nposition = [0, 0, 3]\nintensity = 0\n";
    fs::write(&path, CAMERA.replace("radiance = 1", "radiance = [0, 0, 0]") + dark).unwrap();
    let loaded = load(&path).unwrap();
    assert_eq!(loaded.notes, [Note::warning("nothing in the scene emits light: the image will be black")]);
    assert_eq!((loaded.world.environment, loaded.world.point_lights.len()), (None, 0));
}

#[test]
fn surfaces_keep_the_order_of_the_file() {
    let corners =
        |x: u32| format!("material = 'white'\nvertices = [[{x}, 0, 0], [{x}, 1, 0], [{x}, 1, 1], [{x}, 0, 1]]\n");
    let lamp = corners(9).replace("material = 'white'", "radiance = 1");
    let rest =
        format!("[[light.quad]]\n{lamp}[[quad]]\n{}[[polygon]]\n{}[[quad]]\n{}", corners(0), corners(1), corners(2));
    let places: Vec<f64> = alone(&rest).world.polygons.iter().map(|polygon| polygon.vertices[0].x).collect();
    assert_eq!(places, [0.0, 1.0, 2.0, 9.0], "surfaces, then lamps");
}

#[test]
fn cameras_keep_their_names_and_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.toml");
    let camera =
        |name: &str| CAMERA.split("[material").next().unwrap().replace("[camera]", &format!("[camera.{name}]"));
    fs::write(&path, camera("right") + &camera("left")).unwrap();
    let names: Vec<String> = load(&path).unwrap().world.cameras.into_iter().map(|camera| camera.name).collect();
    assert_eq!(names, ["right", "left"]);
    assert_eq!(alone("").world.cameras[0].name, "");
}

#[test]
fn the_hash_is_of_the_world_not_of_the_words() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "# any\nv 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n";
    fs::write(folder.path().join("a.obj"), obj).unwrap();
    fs::write(folder.path().join("b.PLY"), ply).unwrap();
    let hash = |rest: &str| scene(folder.path(), rest).scene_hash;
    let written = "vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0.5]]\nfaces = [[0, 1, 2]]\n";
    let plain = hash(&format!("[[mesh]]\nmaterial = 'white'\n{written}"));
    assert_eq!(plain, hash("# a comment\n[[mesh]]\nfile='a.obj' # another\nmaterial   = \"white\"\n"));
    assert_eq!(plain, hash("[[mesh]]\nmaterial = 'white'\nfile = 'b.PLY'\nscale = 1\n[render]\nspp = 3\n"));
    assert_ne!(plain, hash("[[mesh]]\nmaterial = 'white'\nfile = 'b.PLY'\nscale = 2\n"));
    assert_ne!(plain, hash(&format!("[[mesh]]\nmaterial = 'white'\nradiance = 1\n{written}")));
}

/// The texts of the notes, all of which are warnings.
fn warnings(loaded: &Loaded) -> Vec<&str> {
    assert!(loaded.notes.iter().all(|note| note.severity == Severity::Warning), "{:?}", loaded.notes);
    loaded.notes.iter().map(|note| note.text.as_str()).collect()
}

/// Two squares in one place, one a quad and one a mesh.
#[test]
fn the_order_of_coinciding_surfaces_is_hashed_and_kept() {
    let corners = "vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]\n";
    let quad = format!("[[quad]]\nmaterial = 'white'\n{corners}");
    let mesh = |lift: &str| {
        let corners = corners.replace(", 0]", &format!(", {lift}]"));
        format!("[[mesh]]\nmaterial = 'white'\nfaces = [[0, 1, 2], [0, 2, 3]]\n{corners}")
    };
    let [quad_first, mesh_first] =
        [format!("{quad}{}", mesh("0")), format!("{}{quad}", mesh("0"))].map(|rest| alone(&rest));
    assert!(quad_first.world.order.polygons[0] < quad_first.world.order.meshes[0]);
    assert!(mesh_first.world.order.polygons[0] > mesh_first.world.order.meshes[0]);
    assert_ne!(quad_first.scene_hash, mesh_first.scene_hash, "they look different");
    let apart = [format!("{quad}{}", mesh("1")), format!("{}{quad}", mesh("1"))].map(|rest| alone(&rest).scene_hash);
    assert_eq!(apart[0], apart[1], "they look the same");
}

const GLASS: &str = "[material.glass]\ndielectric = { ior = 1.5 }\n";

#[test]
fn open_glass_is_noted_with_its_line_and_a_box_of_quads_is_not() {
    let quad = |corners: [[u32; 3]; 4]| format!("[[quad]]\nmaterial = 'glass'\nvertices = {corners:?}\n");
    let sides = [
        [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]],
        [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
        [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]],
        [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
        [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    ];
    let of =
        |count: usize| alone(&format!("{GLASS}{}", sides[..count].iter().map(|side| quad(*side)).collect::<String>()));
    assert_eq!(warnings(&of(6)), [""; 0]);
    for count in [1, 5] {
        let loaded = of(count);
        let notes = warnings(&loaded);
        let [note] = &notes[..] else { panic!("{notes:?}") };
        assert!(note.starts_with("the surface of `glass` is open: the quad in line 12"), "{note}");
        assert!(note.contains("4 free edges"), "{note}");
    }
}

#[test]
fn inside_out_and_thin_and_coarse_things_are_noted() {
    let tetrahedron = |faces: &str| {
        format!(
            "{GLASS}[[mesh]]\nmaterial = 'glass'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]\nfaces = {faces}\n"
        )
    };
    let outward = "[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]";
    let inward = "[[1, 2, 0], [3, 1, 0], [3, 2, 1], [3, 0, 2]]";
    assert_eq!(warnings(&alone(&tetrahedron(outward))), [""; 0]);
    let loaded = alone(&tetrahedron(inward));
    let notes = warnings(&loaded);
    assert!(matches!(&notes[..], [note] if note.contains("`glass` is inside out: the mesh in line 12")), "{notes:?}");
    let lamp = |faces: &str| tetrahedron(faces).replace("'glass'\n", "'white'\nradiance = 1\n");
    assert_eq!(warnings(&alone(&lamp(outward))), [""; 0]);
    let loaded = alone(&lamp(inward));
    let notes = warnings(&loaded);
    assert!(matches!(&notes[..], [note] if note.contains("lamp shines inwards")), "{notes:?}");
    let ball =
        |z: &str, radius: &str| format!("[[sphere]]\nmaterial = 'white'\ncentre = [0, 0, {z}]\nradius = {radius}\n");
    let loaded = alone(&format!("{}{}", ball("-1e6", "1e6"), ball("0.5", "0.5")));
    let notes = warnings(&loaded);
    assert!(
        matches!(&notes[..], [note] if note.contains("the sphere in line 14 beside it is 1 m across, 8.4 times that")),
        "{notes:?}"
    );
    let shell = |radius: &str| {
        alone(&format!("{GLASS}{}{}", ball("0", "1"), ball("0", radius)).replace("'white'\ncentre", "'glass'\ncentre"))
    };
    assert_eq!(warnings(&shell("0.99")), [""; 0]);
    let loaded = shell("0.9999998");
    let notes = warnings(&loaded);
    assert!(matches!(&notes[..], [note] if note.contains("from the sphere in line 16 (`glass`)")), "{notes:?}");
}
