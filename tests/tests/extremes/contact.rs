//! Glass that stands on a table, glass against glass, and panes as thin as coordinates allow.

use glam::{DQuat, DVec3};
use smalti_core::scene::world::{Material, Order, Polygon};
use smalti_core::scene::{Frame, World, contact, soundness};
use smalti_core::settings::{Integrator, Settings};
use smalti_image::hash;
use smalti_tests::build::{at, camera, grey, material, mesh, sphere};
use smalti_tests::draw::{Way, draw};
use smalti_tests::estimate::{assert_near, render, settings};

use crate::assert_sound;

/// Reflectance of glass of index 1.5 for perpendicular light.
const MIRRORED: f64 = 0.04;

/// How a thing is put into the world.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Quads,
    Mesh,
}

const KINDS: [Kind; 2] = [Kind::Quads, Kind::Mesh];

/// The six faces of the box between two corners, with the normals out.
fn faces_of_box(low: DVec3, high: DVec3) -> Vec<Vec<DVec3>> {
    let corner = |k: usize| {
        let side = |bit: usize, axis: usize| if k >> bit & 1 == 1 { high[axis] } else { low[axis] };
        at(side(2, 0), side(1, 1), side(0, 2))
    };
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    faces.map(|face| face.map(corner).to_vec()).to_vec()
}

/// A square about the z axis, seen from above.
fn square(half: f64, z: f64) -> Vec<Vec<DVec3>> {
    vec![[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| at(half * x, half * y, z)).to_vec()]
}

/// Puts faces behind everything that was put so far.
fn put(world: &mut World, faces: Vec<Vec<DVec3>>, kind: Kind, material: usize) {
    let place = world.order.polygons.len() + world.order.meshes.len();
    match kind {
        Kind::Quads => {
            for vertices in faces {
                world.polygons.push(Polygon { vertices, material, radiance: None });
                world.order.polygons.push(place);
            }
        }
        Kind::Mesh => {
            let triangles = (0..faces.len() as u32).flat_map(|k| [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|c| 4 * k + c)));
            mesh(world, (faces.concat(), triangles.collect()), material, None);
            world.order.meshes.push(place);
        }
    }
}

/// So many triangles far below that the rest is found by a tree.
fn dust(world: &mut World, material: usize) {
    let corners = |k: u32| {
        let (x, y) = (f64::from(k % 16) - 8.0, f64::from(k / 16) - 8.0);
        [at(x, y, -90.0), at(x + 0.5, y, -90.0), at(x, y + 0.5, -90.0)]
    };
    let faces = (0..256).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    mesh(world, ((0..256).flat_map(corners).collect(), faces), material, None);
    world.order.meshes.push(usize::MAX);
}

/// Looks down on the middle of what is at the origin, almost in parallel.
fn from_above(world: &mut World) {
    world.cameras.clear();
    camera(world, at(0.3, 0.2, 40.0), at(0.3, 0.2, 0.0), 0.005);
}

/// Everything turned and moved.
fn elsewhere(world: &World, k: u32) -> World {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, f64::from(k), 0.6 * f64::from(k), 1.9 * f64::from(k));
    let mut moved = world.placed(1.0, |point| turn * point + at(3.0, -1.0, 0.7) * f64::from(k));
    moved.cameras.iter_mut().for_each(|camera| camera.up = turn * camera.up);
    moved
}

fn by_paths(spp: u32) -> Settings {
    Settings { integrator: Integrator::Path, ..settings(8, 8, spp) }
}

/// A plate of glass on a table of this albedo under a uniform sky: what the glass mirrors, and what goes through it, back and
/// forth between the table and the underside of its upper face (Saunderson 1942).
fn plate_on_a_table(albedo: f64) -> f64 {
    // Of index 1.5: what diffuse light loses on the way in, and on the way out.
    let (outer, inner) = (0.091_78, 0.596_35);
    MIRRORED + (1.0 - MIRRORED) / 2.25 * albedo * (1.0 - outer) / (1.0 - albedo * inner)
}

/// A plate of glass and a table in one plane, the table of this half width.
fn on_a_table(table: (Kind, f64, f64), glass: Kind, table_first: bool) -> World {
    let mut world = World { environment: Some([1.0; 3]), ..World::default() };
    let wood = material(&mut world, grey(table.2));
    let clear = material(&mut world, Material::clear(1.5));
    let plate = faces_of_box(at(-30.0, -30.0, 0.0), at(30.0, 30.0, 0.5));
    if table_first {
        put(&mut world, square(table.1, 0.0), table.0, wood);
    }
    put(&mut world, plate, glass, clear);
    if !table_first {
        put(&mut world, square(table.1, 0.0), table.0, wood);
    }
    from_above(&mut world);
    world
}

/// Nothing but what the glass mirrors comes from a black table: no ray gets between the two.
#[test]
fn glass_on_a_black_table_shows_no_sky() {
    for (table, glass) in [(KINDS[0], KINDS[0]), (KINDS[0], KINDS[1]), (KINDS[1], KINDS[0]), (KINDS[1], KINDS[1])] {
        for table_first in [true, false] {
            for half in [20.0, 30.0, 50.0] {
                for in_a_tree in [false, true] {
                    let mut world = on_a_table((table, half, 0.0), glass, table_first);
                    if in_a_tree {
                        dust(&mut world, 0);
                    }
                    let name = format!("{glass:?} on {table:?} of {half}, first {table_first}, tree {in_a_tree}");
                    for integrator in [Integrator::Path, Integrator::Whitted, Integrator::Auto] {
                        let found = render(&world, &Settings { integrator, ..settings(4, 4, 16) });
                        found.assert_every_pixel(&format!("{name}, {}", integrator.name()), MIRRORED, 1e-5);
                    }
                }
            }
        }
    }
}

#[test]
fn glass_on_a_grey_table_is_in_optical_contact() {
    for (k, kind) in [(0, Kind::Quads), (1, Kind::Mesh), (2, Kind::Quads), (5, Kind::Mesh)] {
        for albedo in [0.2, 0.5, 0.8] {
            let world = elsewhere(&on_a_table((kind, 31.0, albedo), Kind::Mesh, true), k);
            let found = render(&world, &by_paths(8192));
            found.assert_mean(&format!("albedo {albedo}, {kind:?}, place {k}"), plate_on_a_table(albedo), 0.01);
        }
    }
}

/// From below one sees the table, whatever stands on it.
#[test]
fn the_table_is_seen_from_below() {
    for kind in KINDS {
        for table_first in [true, false] {
            let mut world = on_a_table((kind, 20.0, 0.5), Kind::Mesh, table_first);
            world.cameras.clear();
            camera(&mut world, at(0.3, 0.2, -40.0), at(0.3, 0.2, 0.0), 0.005);
            render(&world, &by_paths(64)).assert_mean("from below", 0.5, 0.01);
        }
    }
}

/// However they are turned, and through however many rays: the doctor finds no leak where glass stands on things.
#[test]
fn contact_is_sound() {
    for k in [0, 3] {
        let mut world = on_a_table((Kind::Quads, 40.0, 0.5), Kind::Mesh, true);
        let clear = world.materials.len() - 1;
        put(&mut world, faces_of_box(at(-1.0, -1.0, 0.5), at(1.0, 1.0, 1.5)), Kind::Quads, clear);
        world.cameras.clear();
        camera(&mut world, at(3.0, 4.0, 5.0), at(0.0, 0.0, 0.5), 0.5);
        assert_eq!(assert_sound(&format!("contact, place {k}"), &elsewhere(&world, k)), []);
    }
}

/// The first in the file, whichever kind of primitive it is.
#[test]
fn of_two_opaque_faces_the_first_in_the_file_is_seen() {
    for kinds in [[Kind::Quads, Kind::Mesh], [Kind::Mesh, Kind::Quads], [Kind::Mesh; 2], [Kind::Quads; 2]] {
        for albedos in [[0.2, 0.7], [0.7, 0.2]] {
            for (half, in_a_tree, k) in [(3.0, false, 0), (1.0, true, 0), (3.0, true, 4), (1.0, false, 7)] {
                let mut world = World { environment: Some([1.0; 3]), ..World::default() };
                let of = albedos.map(|albedo| material(&mut world, grey(albedo)));
                put(&mut world, square(2.0, 0.3), kinds[0], of[0]);
                put(&mut world, square(half, 0.3), kinds[1], of[1]);
                if in_a_tree {
                    dust(&mut world, of[0]);
                }
                from_above(&mut world);
                let name = format!("{kinds:?} of {half}, tree {in_a_tree}, place {k}");
                let mean = |world: &World| render(world, &by_paths(64)).mean[0];
                // Roulette makes noise; the other one's albedo is more than a factor of 3 away.
                let is_near = |found: f64, albedo: f64| (found / albedo - 1.0).abs() < 0.25;
                let found = mean(&elsewhere(&world, k));
                assert!(is_near(found, albedos[0]), "{name}: {found} instead of {}", albedos[0]);
                // No order was told: polygons before meshes.
                world.order = Order::default();
                let first = if kinds == [Kind::Mesh, Kind::Quads] { albedos[1] } else { albedos[0] };
                let found = mean(&world);
                assert!(is_near(found, first), "{name}, by default: {found} instead of {first}");
            }
        }
    }
}

/// Radiance from a pile of plates over a black ground, each mirroring the next, for perpendicular light: of index and of what
/// light loses on the way through it.
fn pile(plates: &[(f64, f64)]) -> f64 {
    let mut below = 0.0;
    for (number, (index, passes)) in plates.iter().enumerate().rev() {
        let above = if number == 0 { 1.0 } else { plates[number - 1].0 };
        let mirrored = ((index - above) / (index + above)).powi(2);
        let beneath = passes * passes * below;
        below = mirrored + (1.0 - mirrored).powi(2) * beneath / (1.0 - mirrored * beneath);
    }
    below
}

/// Plates of these indices and absorptions, from the top, each 0.5 thick, on a black table.
fn piled(plates: &[(f64, f64)], kinds: [Kind; 2], last_first: bool) -> World {
    let mut world = World { environment: Some([1.0; 3]), ..World::default() };
    let black = material(&mut world, grey(0.0));
    let count = plates.len();
    let mut order: Vec<usize> = (0..count).collect();
    if last_first {
        order.reverse();
    }
    for number in order {
        let (ior, absorption) = plates[number];
        let glass = material(&mut world, Material::Dielectric { ior, absorption: [absorption; 3] });
        let (low, half) = (0.5 * (count - 1 - number) as f64, 20.0 + 3.0 * number as f64);
        let plate = faces_of_box(at(-half, -half, low), at(half, half, low + 0.5));
        put(&mut world, plate, kinds[number % 2], glass);
    }
    put(&mut world, square(50.0, 0.0), kinds[0], black);
    from_above(&mut world);
    world
}

#[test]
fn glass_on_glass_has_one_boundary() {
    let piles: [&[(f64, f64)]; 6] = [
        &[(1.5, 0.0), (1.5, 0.0)],
        &[(1.5, 0.0), (1.33, 0.0)],
        &[(1.33, 0.0), (2.4, 0.0)],
        &[(1.5, 0.0), (1.5, 0.0), (1.7, 0.0)],
        &[(1.5, 0.7), (2.0, 0.3)],
        &[(1.3, 0.4), (1.3, 0.0), (2.2, 1.0)],
    ];
    for plates in piles {
        let with_losses: Vec<(f64, f64)> = plates.iter().map(|(n, loss)| (*n, libm::exp(-0.5 * loss))).collect();
        let truth = pile(&with_losses);
        for kinds in [[Kind::Quads; 2], [Kind::Mesh; 2], [Kind::Quads, Kind::Mesh]] {
            for last_first in [false, true] {
                for (k, in_a_tree) in [(0, false), (0, true), (3, false), (6, true)] {
                    let mut world = piled(plates, kinds, last_first);
                    if in_a_tree {
                        dust(&mut world, 0);
                    }
                    let name = format!("{plates:?}, {kinds:?}, reversed {last_first}, place {k}, tree {in_a_tree}");
                    let whitted = Settings { integrator: Integrator::Whitted, ..settings(2, 2, 16) };
                    render(&elsewhere(&world, k), &whitted).assert_every_pixel(&name, truth, 2e-3);
                }
            }
        }
        let found = render(&piled(plates, KINDS, false), &by_paths(8192));
        assert_near(&format!("{plates:?} by paths"), (found.mean[0], found.standard_error[0]), truth, 0.02);
    }
}

/// Where glass lies on glass in part: beside the upper plate the lower one has the sky on it.
#[test]
fn each_hit_finds_out_whether_glass_is_there() {
    for (x, truth) in [(0.3, pile(&[(1.5, 1.0), (2.0, 1.0)])), (21.0, pile(&[(2.0, 1.0)]))] {
        for kinds in [[Kind::Quads; 2], [Kind::Mesh; 2], [Kind::Quads, Kind::Mesh], [Kind::Mesh, Kind::Quads]] {
            let mut world = piled(&[(1.5, 0.0), (2.0, 0.0)], kinds, false);
            world.cameras.clear();
            camera(&mut world, at(x, 0.2, 40.0), at(x, 0.2, 0.0), 0.005);
            let whitted = Settings { integrator: Integrator::Whitted, ..settings(2, 2, 16) };
            render(&world, &whitted).assert_every_pixel(&format!("at {x}, {kinds:?}"), truth, 2e-3);
        }
    }
}

/// Of one kind of glass a box in two halves is a box.
#[test]
fn two_halves_of_glass_are_one_box() {
    let halves = |parts: &[(f64, f64)], kind: Kind| {
        let mut world = World { environment: Some([1.0; 3]), ..World::default() };
        let clear = material(&mut world, Material::Dielectric { ior: 1.5, absorption: [0.8, 0.2, 0.0] });
        for (low, high) in parts {
            put(&mut world, faces_of_box(at(*low, -1.0, -1.0), at(*high, 1.0, 1.0)), kind, clear);
        }
        camera(&mut world, at(3.0, 4.0, 2.0), at(0.0, 0.0, 0.0), 0.5);
        world
    };
    let whole = render(&halves(&[(-1.0, 1.0)], Kind::Quads), &by_paths(4096)).mean;
    for kind in KINDS {
        for parts in [[(-1.0, 0.0), (0.0, 1.0)], [(0.3, 1.0), (-1.0, 0.3)]] {
            let found = render(&halves(&parts, kind), &by_paths(4096));
            for channel in 0..3 {
                assert!(
                    (found.mean[channel] / whole[channel] - 1.0).abs() < 0.004,
                    "{kind:?}: {:?} {whole:?}",
                    found.mean
                );
            }
        }
    }
}

/// Two balls in one place: what is opaque is seen, and of two dielectrics there is one boundary.
#[test]
fn two_balls_may_be_one() {
    for first in [0, 1] {
        let mut world = World { environment: Some([1.0; 3]), ..World::default() };
        let of = [material(&mut world, grey(0.0)), material(&mut world, Material::clear(1.5))];
        sphere(&mut world, DVec3::ZERO, 1.0, of[first], None);
        sphere(&mut world, DVec3::ZERO, 1.0, of[1 - first], None);
        camera(&mut world, at(0.0, -4.0, 0.0), DVec3::ZERO, 0.2);
        assert_eq!(render(&world, &by_paths(16)).mean, [0.0; 3], "opaque {first}");
    }
}

/// Scenes in which nothing coincides: to know it changes no bit.
#[test]
fn the_order_of_the_file_changes_no_bit_elsewhere() {
    let world = |order: bool| {
        let mut world = on_a_table((Kind::Mesh, 20.0, 0.5), Kind::Quads, true);
        world.meshes[0].vertices.iter_mut().for_each(|v| v.z -= 1.0);
        if !order {
            world.order = Order::default();
        }
        hash(&draw(&world, &settings(16, 16, 16), Way::default()))
    };
    assert_eq!(world(true), world(false));
}

/// Whether something in it is noted as too thin.
fn is_noted(world: &World) -> bool {
    let frame = Frame::of(world);
    let found = soundness::examine(world, &frame, &contact::pairs(world, &frame));
    found.iter().any(|finding| matches!(finding, soundness::Finding::Thin { .. }))
}

/// A pane in a furnace, with something far away: what it is as thin as, beside the scene.
#[test]
fn a_thin_pane_is_left_again() {
    for far in [10.0, 1e3, 1e5] {
        for thickness in [1e-3, 3e-4, 1e-4, 1e-5] {
            for way in [DVec3::X, DVec3::Y, DVec3::Z] {
                for kind in KINDS {
                    let mut world = World { environment: Some([1.0; 3]), ..World::default() };
                    let clear = material(&mut world, Material::clear(1.5));
                    let half = material(&mut world, grey(0.5));
                    let pane = faces_of_box(at(-1.0, 0.0, -1.0), at(1.0, thickness, 1.0));
                    put(&mut world, pane, kind, clear);
                    let away = way * far;
                    put(
                        &mut world,
                        vec![vec![away, away + at(0.0, 1.0, 0.0), away + at(0.0, 1.0, 1.0), away + DVec3::Z]],
                        kind,
                        half,
                    );
                    camera(&mut world, at(0.0, -3.0, 0.1), DVec3::ZERO, 0.3);
                    let name = format!("{thickness} in {far} along {way}, {kind:?}");
                    let warned = is_noted(&world);
                    let mean = render(&world, &by_paths(64)).mean[0];
                    assert!(warned || (mean - 1.0).abs() < 2e-3, "{name}: {mean}, and nobody said so");
                }
            }
        }
    }
}

/// What a pane of this transmittance lets through and mirrors, for perpendicular light from both sides.
fn slab(passes: f64) -> f64 {
    let r = MIRRORED;
    let through = (1.0 - r).powi(2) * passes / (1.0 - (r * passes).powi(2));
    let mirrored = r + r * passes * through;
    through + mirrored
}

/// However a thin pane lies: what it absorbs is what its thickness says.
#[test]
fn a_thin_tinted_pane_absorbs_by_its_thickness() {
    for (thickness, far) in [(1e-2, 1e4), (1e-3, 1e3), (3e-3, 2e3)] {
        for k in 0..4 {
            let mut world = World { environment: Some([1.0; 3]), ..World::default() };
            let tinted = Material::Dielectric { ior: 1.5, absorption: [0.5 / thickness; 3] };
            let (clear, black) = (material(&mut world, tinted), material(&mut world, grey(0.0)));
            put(&mut world, faces_of_box(at(-1.0, -1.0, 0.0), at(1.0, 1.0, thickness)), KINDS[k as usize % 2], clear);
            let aside = square(1.0, -far).remove(0).into_iter().map(|corner| corner + DVec3::X * far).collect();
            put(&mut world, vec![aside], Kind::Quads, black);
            camera(&mut world, at(0.02, 0.01, 3.0), at(0.02, 0.01, 0.0), 0.005);
            let world = elsewhere(&world, k);
            let whitted = Settings { integrator: Integrator::Whitted, ..settings(2, 2, 16) };
            let mean = render(&world, &whitted).mean[0];
            let truth = slab(libm::exp(-0.5));
            // Its thickness is known to a step of the coordinates.
            assert!(
                is_noted(&world) || (mean / truth - 1.0).abs() < 0.12,
                "{thickness} in {far}, {k}: {mean}, {truth}"
            );
        }
    }
}

/// A bottle in a furnace: walls of a few steps of the coordinates are left again, or noted.
#[test]
fn a_thin_shell_is_left_again() {
    for steps in [4.0, 8.0, 16.0, 24.0, 32.0, 64.0, 1000.0] {
        let mut world = World { environment: Some([1.0; 3]), ..World::default() };
        let clear = material(&mut world, Material::clear(1.5));
        let hole = material(&mut world, Material::clear(1.0 / 1.5));
        let gap = steps / f64::from(1u32 << 24);
        sphere(&mut world, DVec3::ZERO, 1.0, clear, None);
        sphere(&mut world, DVec3::ZERO, 1.0 - gap, hole, None);
        camera(&mut world, at(0.3, -4.0, 0.5), DVec3::ZERO, 0.3);
        let mean = render(&world, &by_paths(64)).mean[0];
        assert!(is_noted(&world) || (mean - 1.0).abs() < 2e-3, "{steps} steps: {mean}, and nobody said so");
        assert_eq!(is_noted(&world), steps < 16.0, "{steps} steps");
    }
}
