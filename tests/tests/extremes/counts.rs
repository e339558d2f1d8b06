//! Sizes and counts from nothing to the largest.

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Settings};
use smalti_image::hash;
use smalti_tests::build::{at, camera, grey, material, quad, sphere};
use smalti_tests::draw::{Way, draw, render as outcome};
use smalti_tests::estimate::{render, settings};

/// A glass ball over a floor under a lamp.
fn ball(lit: bool) -> World {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    let clear = material(&mut world, Material::clear(1.5));
    quad(&mut world, DVec3::ZERO, (DVec3::X, DVec3::Y), white, None);
    sphere(&mut world, at(0.0, 0.0, 0.5), 0.4, clear, None);
    if lit {
        quad(&mut world, at(0.0, 0.0, 2.0), (DVec3::Y * 0.1, DVec3::X * 0.1), white, Some(9.0));
    }
    camera(&mut world, at(0.0, -3.0, 1.0), at(0.0, 0.0, 0.2), 0.8);
    world
}

#[test]
fn images_of_one_row_or_column() {
    let whole = |width: u32, height: u32| {
        let image = render(&ball(true), &settings(width, height, 1)).image;
        assert_eq!(image.pixels.len(), (width * height) as usize);
        assert!(image.pixels.as_flattened().iter().all(|value| value.is_finite()), "{width}x{height}");
        image
    };
    for (width, height) in [(1, 1), (1, 4096), (65_535, 1), (1, 65_535)] {
        whole(width, height);
    }
    let wide = Settings { crop: None, ..settings(65_535, 1, 1) };
    let one = hash(&draw(&ball(true), &wide, Way { tile: 1, ..Way::default() }));
    assert_eq!(one, hash(&draw(&ball(true), &wide, Way { tile: 100_000, threads: 64, ..Way::default() })));
}

#[test]
fn a_million_samples_of_one_pixel() {
    let rendered = render(&ball(true), &Settings { integrator: Integrator::Path, ..settings(1, 1, 1_000_000) });
    assert!(rendered.mean[0].is_finite() && rendered.mean[0] > 0.0);
    assert!(rendered.standard_error[0] < 0.05 * rendered.mean[0], "{:?}", rendered.standard_error);
}

#[test]
fn without_light_all_is_black() {
    for integrator in Integrator::ALL {
        let settings = Settings { integrator, ..settings(16, 16, 16) };
        let found = outcome(&ball(false), &settings, Way::default(), None);
        assert!(found.film.develop().pixels.as_flattened().iter().all(|value| *value == 0.0));
        assert_eq!(found.rejected.count, 0);
    }
}

#[test]
fn an_empty_scene_is_its_sky() {
    for integrator in Integrator::ALL {
        let mut world = World { environment: Some([0.25, 0.5, 1.0]), ..World::default() };
        camera(&mut world, DVec3::ZERO, DVec3::Y, 1.0);
        let image = render(&world, &Settings { integrator, ..settings(16, 16, 16) }).image;
        assert!(image.pixels.iter().all(|pixel| *pixel == [0.25, 0.5, 1.0]), "{}", integrator.name());
        world.environment = None;
        let dark = render(&world, &Settings { integrator, ..settings(16, 16, 16) }).image;
        assert!(dark.pixels.iter().all(|pixel| *pixel == [0.0; 3]), "{}", integrator.name());
    }
}

/// No photon: all light is found by chance. One: finite. Ten million: the same light.
#[test]
fn photons_from_none_to_ten_million() {
    for integrator in [Integrator::Auto, Integrator::Photon] {
        let of = |photons: u32, spp: u32| {
            let settings = Settings { integrator, photons: Some(photons), ..settings(12, 12, spp) };
            let found = outcome(&ball(true), &settings, Way { threads: 2, ..Way::default() }, None);
            let image = found.film.develop();
            assert!(image.pixels.as_flattened().iter().all(|value| value.is_finite()), "{photons} photons");
            assert_eq!(found.rejected.count, 0);
            image.mean()[0]
        };
        assert!(of(0, 64) > 0.0 && of(1, 64) > 0.0);
        let [some, most] = [of(100_000, 64), of(10_000_000, 16)];
        assert!((most / some - 1.0).abs() < 0.05, "{}: {some} and {most}", integrator.name());
    }
}
