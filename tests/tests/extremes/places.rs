//! Any unit, any place; cameras on surfaces and in glass; grazing.

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, closed_box, grey, material, quad, sphere};
use smalti_tests::draw::{load, scene_files};
use smalti_tests::estimate::{render, settings};

use crate::assert_sound;

/// A tenfold unit is no power of two, and coordinates are rounded anew: the light is the same, and hardly a sample differs.
#[test]
fn any_power_of_ten_as_unit_of_length() {
    for path in scene_files("scenes") {
        let loaded = load(&path);
        // (Photons sent ahead decide where photons go: with them another rounding is another realisation.)
        let own = loaded.settings.settings();
        let small = Settings { width: 24, height: 16, crop: None, spp: 4, integrator: Integrator::Path, ..own };
        let expected = render(&loaded.world, &small).image.mean();
        for factor in [1e-6, 1e-3, 10.0, 1e6] {
            let world = loaded.world.placed(factor, |point| point * factor);
            let found = render(&world, &small).image.mean();
            for (a, b) in expected.into_iter().zip(found) {
                assert!(
                    (b / a - 1.0).abs() < 0.005,
                    "{} × {factor}: {found:?} instead of {expected:?}",
                    path.display()
                );
            }
        }
    }
}

/// A furnace of a metre, a thousand to ten million metres away: nothing leaks, and all of it is as bright as it was.
#[test]
fn a_furnace_may_be_far_away() {
    let furnace = |place: DVec3| {
        let mut world = World::default();
        let white = material(&mut world, grey(0.5));
        closed_box(&mut world, DVec3::ZERO, DVec3::splat(0.5), white, Some(1.0));
        sphere(&mut world, at(0.1, 0.1, -0.2), 0.2, white, Some(1.0));
        camera(&mut world, at(-0.3, -0.3, 0.1), DVec3::ZERO, 1.2);
        world.placed(1.0, |point| point + place)
    };
    for away in [1e3, 1e4, 1e6, 1e7] {
        let world = furnace(at(0.6, -0.64, 0.48) * away);
        render(&world, &settings(64, 64, 256)).assert_mean(&format!("{away} m away"), 2.0, 0.005);
        assert_sound(&format!("{away} m away"), &world);
    }
    // Here a metre has ten thousand steps left, and the doctor says so.
    let warnings = assert_sound("1e12 m away", &furnace(at(0.0, 1e12, 0.0)));
    assert!(warnings.iter().any(|finding| finding.case == "coordinates"), "{warnings:?}");
}

/// From a plane one sees what is on the side that one looks to, and not the plane itself.
#[test]
fn a_camera_on_a_plane_sees_the_side_that_it_looks_to() {
    for height in [0.0, 0.1, 1.0 / 3.0, 0.7] {
        for beside in [at(0.3, 0.2, 0.0), at(1.0 / 3.0, 0.1, 0.0), at(1.0, 0.0, 0.0)] {
            let mut world = World { environment: Some([1.0; 3]), ..World::default() };
            let black = material(&mut world, grey(0.0));
            quad(&mut world, at(0.0, 0.0, height), (DVec3::X, DVec3::Y), black, None);
            let eye = beside + at(0.0, 0.0, height);
            for way in [at(0.1, 0.2, 1.0), at(0.1, 0.2, -1.0)] {
                world.cameras.clear();
                camera(&mut world, eye, eye + way, 0.8);
                render(&world, &settings(16, 16, 16)).assert_every_pixel(&format!("from {eye} along {way}"), 1.0, 0.0);
            }
        }
    }
}

/// From a ball of smoke one sees the sky, or nothing.
#[test]
fn a_camera_on_a_ball_sees_the_side_that_it_looks_to() {
    for k in 0..6 {
        let mut world = World { environment: Some([1.0; 3]), ..World::default() };
        let smoke = material(&mut world, Material::Dielectric { ior: 1.0, absorption: [50.0; 3] });
        let centre = at(0.1, 0.2, 0.3);
        sphere(&mut world, centre, 1.7, smoke, None);
        let way = at(0.3 * f64::from(k), 1.0, 0.7 - 0.2 * f64::from(k)).normalize();
        for (side, expected) in [(1.0, 1.0), (-1.0, 0.0)] {
            world.cameras.clear();
            camera(&mut world, centre + 1.7 * way, centre + (1.7 + side) * way, 0.8);
            let mean = render(&world, &settings(16, 16, 16)).image.mean()[0];
            assert!((mean - expected).abs() < 1e-6, "{k}, to {side}: {mean}");
        }
    }
}

/// At 89.9999° and beyond a floor of glass is a mirror: the sky that it shows has the sky's radiance, and nothing is lost.
#[test]
fn grazing_glass_is_a_mirror() {
    for height in [1e-1, 1e-3, 1e-5, 1e-6] {
        let mut world = World { environment: Some([1.0; 3]), ..World::default() };
        let clear = material(&mut world, Material::clear(1.5));
        // A slab: what is refracted leaves by its lower side.
        closed_box(&mut world, at(0.0, 0.0, -0.5), at(1.0, 1.0, 0.5), clear, None);
        // Its faces look inward: turned, they look out.
        world.polygons.iter_mut().for_each(|polygon| polygon.vertices.reverse());
        camera(&mut world, at(-1.5, 0.0, height), at(1.0, 0.0, 0.0), 0.1);
        for integrator in [Integrator::Path, Integrator::Whitted] {
            let rendered = render(&world, &Settings { integrator, ..settings(32, 32, 16) });
            let mean = rendered.image.mean()[0];
            assert!((mean - 1.0).abs() < 2e-3, "{height} m above, {}: {mean}", integrator.name());
        }
        assert_sound(&format!("{height} m above glass"), &world);
    }
}
