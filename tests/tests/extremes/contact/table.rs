//! What stands on a table, and lies on it.

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::{Material, Order};
use smalti_core::settings::{Integrator, Settings};
use smalti_image::hash;
use smalti_tests::build::{at, camera, grey, material, mirror, sphere};
use smalti_tests::draw::{Way, draw};
use smalti_tests::estimate::{render, settings};

use super::{
    KINDS, Kind, MIRRORED, by_paths, dust, elsewhere, faces_of_box, from_above, put, scaled, square, under_a_sky,
};
use crate::assert_sound;

/// A plate of glass on a table of this albedo under a uniform sky: what the glass mirrors, and what goes through it, back and
/// forth between the table and the underside of its upper face (Saunderson 1942).
fn plate_on_a_table(albedo: f64) -> f64 {
    // Of index 1.5: what diffuse light loses on the way in, and on the way out.
    let (outer, inner) = (0.091_78, 0.596_35);
    MIRRORED + (1.0 - MIRRORED) / 2.25 * albedo * (1.0 - outer) / (1.0 - albedo * inner)
}

/// A plate of glass and a table in one plane, the table of this half width.
fn on_a_table(table: (Kind, f64, f64), glass: Kind, table_first: bool) -> World {
    let mut world = under_a_sky();
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
                let mut world = under_a_sky();
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

/// Two balls in one place: what is opaque is seen, and of two dielectrics there is one boundary.
#[test]
fn two_balls_may_be_one() {
    for first in [0, 1] {
        let mut world = under_a_sky();
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

/// In any unit of length, turned by odd angles and a thousand times its size away: no ray gets between the two.
#[test]
fn contact_holds_in_every_unit_and_place() {
    let integrators = [Integrator::Path, Integrator::Whitted, Integrator::Photon, Integrator::Auto];
    for (k, integrator) in (0..12).zip(integrators.into_iter().cycle()) {
        for scale in [1e-3, 1.0, 1e3] {
            for away in [0.0, 3e4] {
                let (table, glass) = (KINDS[k as usize % 2], KINDS[k as usize / 2 % 2]);
                let world = scaled(&on_a_table((table, 31.0, 0.0), glass, k % 3 == 0), k, scale);
                let world = world.placed(1.0, |point| point + DVec3::new(0.3, -0.7, 1.0) * away * scale);
                let found = render(&world, &Settings { integrator, ..settings(4, 4, 16) });
                let name = format!("{glass:?} on {table:?}, place {k}, × {scale}, {away} away, {}", integrator.name());
                found.assert_every_pixel(&name, MIRRORED, 1e-4);
            }
        }
    }
}

/// From within the glass the table is black to the horizon: rays along it leak no more than others.
#[test]
fn nothing_leaks_where_rays_graze() {
    for k in 0..6 {
        for (table, glass) in [(KINDS[0], KINDS[0]), (KINDS[0], KINDS[1]), (KINDS[1], KINDS[0]), (KINDS[1], KINDS[1])] {
            let mut world = on_a_table((table, 40.0, 0.0), glass, k % 2 == 0);
            world.cameras.clear();
            camera(&mut world, at(0.0, -20.0, 0.05), at(0.0, 5.0, 0.0), 0.001);
            if k % 3 == 0 {
                dust(&mut world, 0);
            }
            let found = render(&elsewhere(&world, k), &by_paths(256));
            assert_eq!(found.mean, [0.0; 3], "{glass:?} on {table:?}, place {k}");
        }
    }
}

/// In a furnace a plate that lies on a perfect mirror cannot be seen.
#[test]
fn glass_on_a_mirror_keeps_the_furnace() {
    for k in 0..4 {
        let mut world = on_a_table((KINDS[k as usize % 2], 40.0, 0.0), Kind::Mesh, k % 2 == 0);
        world.materials[0] = mirror(1.0);
        render(&elsewhere(&world, k), &by_paths(4096)).assert_mean(&format!("place {k}"), 1.0, 0.001);
    }
}

/// Glass and water on a table, beside and on each other: paths and photons agree, whatever was written first and wherever
/// it stands.
#[test]
fn every_integrator_sees_the_same_contact() {
    let world = |order: [usize; 4], kind: Kind, absorption: f64| {
        let mut world = World { environment: Some([0.5; 3]), ..World::default() };
        let wood = material(&mut world, grey(0.5));
        let glass = material(&mut world, Material::Dielectric { ior: 1.5, absorption: [absorption; 3] });
        let water = material(&mut world, Material::Dielectric { ior: 1.33, absorption: [absorption / 3.0; 3] });
        let parts = [
            (square(4.0, 0.0), wood),
            (faces_of_box(at(-1.0, -1.0, 0.0), at(0.0, 1.0, 0.8)), glass),
            (faces_of_box(at(0.0, -1.2, 0.0), at(1.0, 1.0, 0.6)), water),
            (faces_of_box(at(-0.5, -0.5, 0.8), at(0.0, 0.5, 1.1)), water),
        ];
        order.into_iter().for_each(|part| put(&mut world, parts[part].0.clone(), kind, parts[part].1));
        sphere(&mut world, at(1.5, -1.5, 3.0), 1.2, wood, Some(4.0));
        camera(&mut world, at(0.3, -3.0, 4.0), at(0.0, 0.0, 0.3), 0.5);
        world
    };
    for absorption in [0.0, 2.0] {
        let first = world([0, 1, 2, 3], Kind::Quads, absorption);
        let truth = render(&first, &by_paths(8192));
        let last = scaled(&world([3, 1, 2, 0], Kind::Mesh, absorption), 3, 1e3);
        for (name, world) in [("as listed", first), ("elsewhere", last)] {
            for integrator in [Integrator::Path, Integrator::Photon, Integrator::Auto] {
                let found = render(&world, &Settings { integrator, ..by_paths(2048) });
                let error = found.mean[0] / truth.mean[0] - 1.0;
                assert!(error.abs() < 0.02, "{name}, {}, absorption {absorption}: off by {error}", integrator.name());
            }
        }
    }
}

/// A lamp beneath a plate, touching it: its light leaves glass as that of any lamp in glass.
#[test]
fn a_lamp_under_glass_shines_through_it() {
    for (k, integrator) in
        [Integrator::Path, Integrator::Whitted, Integrator::Photon, Integrator::Auto].iter().enumerate()
    {
        for (table, glass) in [(KINDS[0], KINDS[0]), (KINDS[0], KINDS[1]), (KINDS[1], KINDS[0]), (KINDS[1], KINDS[1])] {
            let mut world = on_a_table((table, 31.0, 0.0), glass, false);
            world.polygons.iter_mut().filter(|face| face.material == 0).for_each(|face| face.radiance = Some([3.0; 3]));
            world.meshes.iter_mut().filter(|mesh| mesh.material == 0).for_each(|mesh| mesh.radiance = Some([3.0; 3]));
            let found =
                render(&elsewhere(&world, k as u32), &Settings { integrator: *integrator, ..settings(4, 4, 256) });
            let name = format!("{glass:?} on a lamp, {table:?}, {}", integrator.name());
            found.assert_mean(&name, MIRRORED + (1.0 - MIRRORED) / 2.25 * 3.0, 0.005);
        }
    }
}
