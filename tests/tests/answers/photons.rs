//! Photon maps, where the answer is known.

use glam::DVec3;
use smalti_core::photon::pass::Pass;
use smalti_core::photon::{Aim, Kind, Quantity};
use smalti_core::scene::world::Material;
use smalti_core::scene::{Origin, World};
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, closed_box, grey, material, point_light, quad, sphere};
use smalti_tests::estimate::{Repeated, assert_near, repeat, settings};
use smalti_tests::photons::{Place, irradiance, map_of, mapper, trace};

/// F4. Discs that reach over the room's edges are measured by the part that is on the wall, or corners would be dark.
#[test]
fn a_photon_mapped_furnace_shows_the_series_of_its_albedo() {
    for (albedo, expected) in [
        ([0.5; 3], [2.0; 3]),
        ([0.8; 3], [5.0; 3]),
        ([0.2, 0.5, 0.8], [1.25, 2.0, 5.0]),
        ([0.0, 0.5, 0.0], [1.0, 2.0, 1.0]),
    ] {
        let mut world = World::default();
        let wall = material(&mut world, Material::Lambert { albedo });
        closed_box(&mut world, DVec3::ZERO, at(1.0, 1.3, 0.8), wall, Some(1.0));
        camera(&mut world, at(0.1, 0.2, 0.3), at(-0.5, 1.0, 0.0), 1.4);
        for radius in [None, Some(0.2)] {
            let photon =
                Settings { integrator: Integrator::Photon, photons: Some(1 << 15), radius, ..settings(24, 24, 32) };
            let name = format!("albedo {albedo:?}, radius {radius:?}");
            let found = repeat(&world, &photon, 0, 4);
            found.assert_rgb(&name, expected, 0.01);
        }
    }
}

/// A room with glass, lit by a lamp and a point.
fn room() -> World {
    let mut world = World::default();
    let wall = material(&mut world, Material::Lambert { albedo: [0.7, 0.5, 0.3] });
    let clear = material(&mut world, Material::clear(1.5));
    closed_box(&mut world, DVec3::ZERO, at(1.0, 1.2, 1.0), wall, None);
    quad(&mut world, at(0.2, 0.1, 0.98), (DVec3::Y * 0.3, DVec3::X * 0.3), wall, Some(5.0));
    point_light(&mut world, at(-0.5, 0.4, 0.7), 0.3);
    sphere(&mut world, at(0.2, 0.3, -0.4), 0.4, clear, None);
    camera(&mut world, at(-0.2, -1.1, 0.1), at(0.1, 0.3, -0.4), 1.2);
    world
}

/// P2. The radius is the same for all, so that they are biased alike: flux is divided by what was emitted.
#[test]
fn the_number_of_photons_leaves_the_image_as_it_is() {
    let world = room();
    for integrator in [Integrator::Auto, Integrator::Photon] {
        let of = |photons: u32, first: u64| {
            let settings = Settings { integrator, photons: Some(photons), radius: Some(0.1), ..settings(24, 24, 16) };
            repeat(&world, &settings, first, if photons < 1_000_000 { 10 } else { 8 })
        };
        let [few, more, many] = [(10_000, 100), (100_000, 200), (1_000_000, 300)].map(|(n, first)| of(n, first));
        for (name, a, b) in [("1e4 and 1e6", &few, &many), ("1e5 and 1e6", &more, &many)] {
            assert_same(&format!("{integrator:?}, {name}"), a, b);
        }
    }
}

fn assert_same(name: &str, a: &Repeated, b: &Repeated) {
    for c in 0..3 {
        let error = (a.standard_error[c] * a.standard_error[c] + b.standard_error[c] * b.standard_error[c]).sqrt();
        let off = a.mean[c] - b.mean[c];
        assert!(error < 0.01 * b.mean[c], "{name}: known only to {:e}", error / b.mean[c]);
        // A few seeds tell little of the spread: what a wrong normalisation does is a factor.
        assert!(off.abs() < 6.0 * error, "{name}: {} ± {error} off {} in channel {c}", off, b.mean[c]);
    }
}

/// The map of all light without its bounces, against Lambert's formula (L1, L2).
#[test]
fn photons_bring_lamberts_irradiance() {
    for (side, expected) in [(1.0, 0.752_274_688_454), (2.0, 1.740_839_502_73)] {
        let mut world = World::default();
        let (white, black) = (material(&mut world, grey(0.5)), material(&mut world, grey(0.0)));
        quad(&mut world, DVec3::ZERO, (DVec3::X, DVec3::Y), white, None);
        quad(&mut world, DVec3::Z, (DVec3::Y * side / 2.0, DVec3::X * side / 2.0), black, Some(1.0));
        let renderer = mapper(&world, Settings { max_bounces: Some(1), ..Settings::default() });
        let (scene, photons) = (renderer.scene(), renderer.plan().photons.as_ref().unwrap());
        let place = Place::on(&renderer, Origin::Polygon(0), DVec3::ZERO, DVec3::Z);
        let radius = (0.1 * scene.frame.scale) as f32;
        // Only what comes near is asked.
        let aim = Aim::at(&scene.lights, &[[place.point[0], place.point[1], place.point[2], 4.0 * radius]], &[true]);
        let pass = Pass { kind: Kind::Global, aim, photons: 0, goes_on: true };
        let (rounds, mut sum, mut squares) = (16u32, 0.0, 0.0);
        for round in 0..rounds {
            let traced = trace(&renderer, &pass, 1 << 17, round);
            let map = map_of(&traced.photons, &photons.surfaces, radius, Quantity::Radiance);
            let [r, ..] = irradiance((&map, 0, 0), &photons.surfaces, &place);
            sum += r;
            squares += r * r;
        }
        let n = f64::from(rounds);
        let mean = sum / n;
        let error = ((squares / n - mean * mean) / (n - 1.0)).sqrt();
        assert_near(&format!("square of side {side}"), (mean, error), expected, 0.02);
    }
}
