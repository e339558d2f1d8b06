//! Radiance, albedo and index at their limits.

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, brighter, camera, closed_box, grey, material, quad, sphere};
use smalti_tests::draw::{Way, render as outcome};
use smalti_tests::estimate::{render, settings};

use crate::assert_sound;

/// A grey and a glass ball over a floor, under a lamp.
fn still_life(index: f64) -> World {
    let mut world = World { environment: Some([0.1; 3]), ..World::default() };
    let white = material(&mut world, grey(0.5));
    let clear = material(&mut world, Material::clear(index));
    quad(&mut world, DVec3::ZERO, (DVec3::X * 2.0, DVec3::Y * 2.0), white, None);
    quad(&mut world, at(0.0, 0.0, 2.0), (DVec3::Y * 0.3, DVec3::X * 0.3), white, Some(4.0));
    sphere(&mut world, at(-0.5, 0.0, 0.4), 0.4, white, None);
    sphere(&mut world, at(0.5, 0.0, 0.5), 0.4, clear, None);
    camera(&mut world, at(0.0, -3.0, 1.0), at(0.0, 0.0, 0.4), 0.7);
    world
}

/// From 10⁻³⁰ to 10³⁰ the picture is the same, times what the lamps are times as bright.
#[test]
fn radiance_of_any_size() {
    for integrator in Integrator::ALL {
        let settings = Settings { integrator, photons: Some(2000), ..settings(24, 24, 32) };
        let plain = render(&still_life(1.5), &settings).image;
        for factor in [1e-30, 1e-10, 1e10, 1e30] {
            let bright = render(&brighter(&still_life(1.5), factor), &settings).image;
            let pairs = plain.pixels.as_flattened().iter().zip(bright.pixels.as_flattened());
            let off = pairs.map(|(a, b)| (f64::from(*b) / factor / f64::from(*a) - 1.0).abs()).fold(0.0, f64::max);
            // Photons are dropped by their flux, which is rounded.
            assert!(off < 1e-2, "{} × {factor}: off by {off}", integrator.name());
            let mean = bright.mean()[0] / factor / plain.mean()[0] - 1.0;
            assert!(mean.abs() < 1e-5, "{} × {factor}: the mean is off by {mean}", integrator.name());
        }
    }
}

/// What f32 cannot hold is counted, named, and never a NaN in the film.
#[test]
fn radiance_beyond_f32_is_counted() {
    let mut world = World::default();
    let white = material(&mut world, grey(0.9));
    closed_box(&mut world, DVec3::ZERO, DVec3::ONE, white, Some(2e38));
    camera(&mut world, DVec3::ZERO, DVec3::Y, 1.0);
    let found = outcome(&world, &settings(16, 16, 16), Way::default(), None);
    assert!(found.rejected.count > 0 && !found.rejected.first.is_empty());
    assert!(found.film.develop().pixels.as_flattened().iter().all(|value| !value.is_nan()));
}

#[test]
fn indices_of_any_size() {
    for index in [0.01, 0.5, 1.0, 1.0 + 1e-6, 1.5, 2.4, 100.0, 1e6] {
        assert_sound(&format!("index {index}"), &still_life(index));
    }
}

/// Black ends a path; white never does by itself, so that the cap does, and says so.
#[test]
fn albedo_of_0_and_of_1() {
    for (albedo, capped) in [(0.0, false), (1.0, true)] {
        let mut world = World::default();
        let white = material(&mut world, grey(albedo));
        let dark = material(&mut world, grey(0.0));
        closed_box(&mut world, DVec3::ZERO, DVec3::ONE, white, None);
        quad(&mut world, at(0.0, 0.0, 0.99), (DVec3::Y * 1e-3, DVec3::X * 1e-3), dark, Some(1.0));
        camera(&mut world, at(0.0, -0.9, 0.0), at(0.0, 0.9, 0.6), 1.5);
        let rendered = render(&world, &settings(8, 8, 4));
        assert_eq!(rendered.capped > 0, capped, "albedo {albedo}");
        assert!(rendered.image.pixels.as_flattened().iter().all(|value| value.is_finite()));
    }
}
