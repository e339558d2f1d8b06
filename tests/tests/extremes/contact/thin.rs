//! Panes and gaps from what anyone can measure down to what coordinates cannot hold.

use glam::DVec3;
use smalti_core::scene::world::Material;
use smalti_core::scene::{Frame, World, contact, soundness};
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, grey, material, sphere};
use smalti_tests::estimate::{render, settings};

use super::{KINDS, Kind, MIRRORED, by_paths, elsewhere, faces_of_box, from_above, put, square, under_a_sky};

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
                    let mut world = under_a_sky();
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
    let through = (1.0 - r) * (1.0 - r) * passes / (1.0 - r * passes * r * passes);
    let mirrored = r + r * passes * through;
    through + mirrored
}

/// However a thin pane lies: what it absorbs is what its thickness says.
#[test]
fn a_thin_tinted_pane_absorbs_by_its_thickness() {
    for (thickness, far) in [(1e-2, 1e4), (1e-3, 1e3), (3e-3, 2e3)] {
        for k in 0..4 {
            let mut world = under_a_sky();
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
        let mut world = under_a_sky();
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

/// Air between a black table and a plate of glass, of any height: two more mirrors, or none where the gap is closed.
#[test]
fn a_gap_under_glass_is_a_gap_or_noted() {
    let open = {
        let below = MIRRORED / (1.0 + MIRRORED);
        2.0 * below
    };
    for (k, gap) in [1e-2, 1e-3, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7, 1e-9].into_iter().enumerate() {
        for (table, glass) in [(KINDS[0], KINDS[0]), (KINDS[0], KINDS[1]), (KINDS[1], KINDS[0]), (KINDS[1], KINDS[1])] {
            for place in [0, 1 + k as u32] {
                let mut world = under_a_sky();
                let (clear, black) = (material(&mut world, Material::clear(1.5)), material(&mut world, grey(0.0)));
                put(&mut world, faces_of_box(at(-30.0, -30.0, gap), at(30.0, 30.0, 0.5)), glass, clear);
                put(&mut world, square(50.0, 0.0), table, black);
                from_above(&mut world);
                let world = elsewhere(&world, place);
                let mean = render(&world, &by_paths(256)).mean[0];
                let near = |truth: f64| (mean / truth - 1.0).abs() < 0.05;
                let name = format!("{gap} between {glass:?} and {table:?}, place {place}");
                // Less than coordinates can hold, and the two touch.
                let is_closed = gap < 1e-5 && near(MIRRORED);
                assert!(is_noted(&world) || near(open) || is_closed, "{name}: {mean} instead of {open}");
                assert!(near(open) || near(MIRRORED), "{name}: {mean} is neither of the two");
                assert!(!is_noted(&world) || gap < 1e-4, "{name}: noted");
            }
        }
    }
}

/// Coordinates as a file of f32 has them, up to thirty times the size of the scene away: glass that was meant to stand on
/// a table stands above it, touches it, or crosses it, which is noted.
#[test]
fn contact_that_was_rounded_away_is_noted() {
    let round = |point: DVec3| point.as_vec3().as_dvec3();
    for k in 0..10 {
        for (table, glass) in [(KINDS[1], KINDS[1]), (KINDS[0], KINDS[1])] {
            for away in [0.0, 30.0, 100.0, 300.0] {
                let mut world = under_a_sky();
                let (clear, black) = (material(&mut world, Material::clear(1.5)), material(&mut world, grey(0.0)));
                put(&mut world, square(4.0, 0.0), table, black);
                put(&mut world, faces_of_box(at(-3.0, -3.0, 0.0), at(3.0, 3.0, 0.5)), glass, clear);
                camera(&mut world, at(0.1, 0.2, 9.0), at(0.1, 0.2, 0.0), 0.02);
                let mut world = elsewhere(&world, k).placed(1.0, |point| point + away * at(0.7, -0.4, 0.9));
                world.meshes.iter_mut().flat_map(|mesh| &mut mesh.vertices).for_each(|corner| *corner = round(*corner));
                let mean = render(&world, &by_paths(64)).mean[0];
                let is_right = mean > 0.9 * MIRRORED && mean < 2.1 * MIRRORED;
                assert!(is_noted(&world) || is_right, "{glass:?} on {table:?}, place {k}, {away} away: {mean}");
            }
        }
    }
}

/// From 9 m a ray cannot tell which side of a pane of 10 nm it meets first, however fine coordinates are where that lies.
#[test]
fn a_pane_too_thin_to_be_seen_from_where_the_camera_is_is_noted() {
    for (thickness, noted) in [(1e-8, true), (1e-7, true), (1e-5, false), (1e-3, false)] {
        for kind in KINDS {
            let mut world = under_a_sky();
            let clear = material(&mut world, Material::clear(1.5));
            put(&mut world, faces_of_box(at(-1.0, -1.0, 0.0), at(1.0, 1.0, thickness)), kind, clear);
            camera(&mut world, at(0.1, 0.2, 9.0), at(0.1, 0.2, 0.0), 0.1);
            assert_eq!(is_noted(&world), noted, "{thickness}, {kind:?}");
            let mean = render(&world, &by_paths(16)).mean[0];
            assert!(noted || (mean - 1.0).abs() < 1e-4, "{thickness}, {kind:?}: {mean}");
        }
    }
}
