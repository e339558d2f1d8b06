//! Caustics that are small beside the scene: a marble in a hall, a ball beside something far away, rooms of unlike scales.
//!
//! Each scene holds the same ball under the same small lamp, so that the light about the ball is known from where nothing
//! else is: by `path` with 16,384 samples a pixel, three seeds, 1.47 ± 0.03.

use glam::DVec3;
use smalti_core::photon::Tag;
use smalti_core::scene::world::Material;
use smalti_core::scene::{Origin, World};
use smalti_core::settings::{Integrator, Rect, Settings};
use smalti_tests::build::{at, camera, grey, material, quad, sphere};
use smalti_tests::estimate::{assert_near, render, repeat, settings};
use smalti_tests::oracle::photon;
use smalti_tests::photons::{mapper, trace};
use smalti_tests::rooms::room;

/// Mean of the pixels about the caustic.
const CAUSTIC: f64 = 1.474;

/// A ball of radius 0.5 on a floor of sides 2 × `half`, under a lamp of radius 0.05.
fn ball_on_floor(half: f64) -> World {
    let mut world = World::default();
    let (ground, black) = (material(&mut world, grey(0.5)), material(&mut world, grey(0.0)));
    let glass = material(&mut world, Material::clear(1.5));
    quad(&mut world, DVec3::ZERO, (DVec3::X * half, DVec3::Y * half), ground, None);
    sphere(&mut world, at(0.0, 0.0, 0.5), 0.5, glass, None);
    sphere(&mut world, at(2.0, 2.0, 4.0), 0.05, black, Some(20_000.0));
    camera(&mut world, at(0.0, -4.0, 3.0), DVec3::ZERO, 35f64.to_radians());
    world
}

/// The pixels about the caustic, in a picture of 64 × 64.
fn about_caustic() -> Settings {
    let crop = Some(Rect { x: 20, y: 29, width: 13, height: 13 });
    Settings { integrator: Integrator::Auto, crop, ..settings(64, 64, 64) }
}

fn assert_caustic(name: &str, world: &World, settings: &Settings) {
    assert_caustic_of(name, world, settings, 8);
}

fn assert_caustic_of(name: &str, world: &World, settings: &Settings, seeds: u64) {
    let found = repeat(world, settings, 0, seeds);
    assert_near(name, (found.mean[0], found.standard_error[0]), CAUSTIC, 0.03);
}

/// The hall is 20 to 3000 times as large as the ball.
#[test]
fn a_caustic_in_a_hall_is_as_bright_as_alone() {
    for ratio in [20.0, 50.0, 400.0, 3000.0] {
        let half = 0.5 * ratio;
        let mut world = ball_on_floor(half);
        let dark = material(&mut world, grey(0.1));
        quad(&mut world, at(0.0, 0.0, 2.0 * half), (DVec3::Y * half, DVec3::X * half), dark, None);
        quad(&mut world, at(0.0, half, half), (DVec3::X * half, DVec3::Z * half), dark, None);
        assert_caustic(&format!("a hall {ratio} times as large"), &world, &about_caustic());
    }
}

/// What nothing sees and stops no light changes nothing, however far away.
#[test]
fn a_caustic_beside_something_far_is_as_bright_as_alone() {
    for away in [10.0, 1e3, 1e5] {
        let mut world = ball_on_floor(10.0);
        let black = material(&mut world, grey(0.0));
        sphere(&mut world, at(0.0, away, away) / 2f64.sqrt() + DVec3::X * 20.0, 1.0, black, None);
        assert_caustic(&format!("{away} m away"), &world, &about_caustic());
    }
}

/// However many photons there are.
#[test]
fn a_caustic_in_a_hall_converges_with_photons() {
    let mut world = ball_on_floor(400.0);
    let dark = material(&mut world, grey(0.1));
    quad(&mut world, at(0.0, 0.0, 400.0), (DVec3::Y * 400.0, DVec3::X * 400.0), dark, None);
    for (photons, seeds) in [(8192, 32), (262_144, 8)] {
        let settings = Settings { photons: Some(photons), ..about_caustic() };
        assert_caustic_of(&format!("{photons} photons"), &world, &settings, seeds);
    }
}

/// Rooms with a lamp so large that `path` finds its caustics: their means agree, and those of the pixels of caustics.
#[test]
fn rooms_of_unlike_scales_are_as_bright_as_by_paths() {
    for number in [1, 3] {
        let world = room(number);
        let path = render(&world, &settings(64, 64, 2048));
        let bright: Vec<usize> =
            (0..64 * 64).filter(|pixel| f64::from(path.image.pixels[*pixel][0]) > 3.0 * path.mean[0]).collect();
        let photons = Some(1 << 17);
        let auto = Settings { integrator: Integrator::Auto, photons, ..settings(64, 64, 64) };
        let auto: Vec<_> = (0..4).map(|seed| render(&world, &Settings { seed, ..auto.clone() })).collect();
        let mean = auto.iter().map(|image| image.mean[0]).sum::<f64>() / 4.0;
        let error = 3.0 * (path.standard_error[0] + auto[0].standard_error[0] / 2.0);
        assert!((mean - path.mean[0]).abs() < error, "room {number}: {mean} instead of {} ± {error}", path.mean[0]);
        let sum = |pixels: &[[f32; 3]]| bright.iter().map(|pixel| f64::from(pixels[*pixel][0])).sum::<f64>();
        let found = auto.iter().map(|image| sum(&image.image.pixels)).sum::<f64>() / 4.0;
        // Pixels are chosen by their noise too, which makes those of `path` brighter.
        let off = found / sum(&path.image.pixels) - 1.0;
        assert!(off.abs() < 0.06, "room {number}: the caustic is off by {off:.3}");
    }
}

/// Rooms in which photons that the oracle sends everywhere, as they are, hit balls often enough from every lamp. In room 6
/// `path` does not find the caustics of a lamp of 0.00004 m: 2.6 % of the picture.
const LIT: [u64; 9] = [3, 4, 6, 8, 12, 14, 17, 20, 27];

/// Flux of caustics, near the first ball and elsewhere, by aimed photons through streams and by photons that the oracle
/// sends everywhere.
#[test]
fn caustics_of_rooms_have_the_oracles_flux() {
    for number in LIT {
        let world = room(number);
        let focus = world.spheres[0];
        let bin = |point: DVec3| usize::from(point.distance(focus.centre) > 3.0 * focus.radius);
        let lands = |landed: &photon::Landed| {
            let wall = matches!(landed.hit.origin, Origin::Polygon(0..6)) && landed.events > 0;
            wall.then(|| bin(landed.hit.point))
        };
        let expected = photon::fluxes(&world, 8_000_000, number, 2, lands);
        let renderer = mapper(&world, Settings::default());
        let (scene, photons) = (renderer.scene(), renderer.plan().photons.as_ref().unwrap());
        let traced = trace(&renderer, photons.caustic.as_ref().unwrap(), 1_000_000, 0);
        let mut found = [0.0; 2];
        for (place, flux) in traced.photons.places.iter().zip(&traced.photons.flux) {
            let [x, y, z, tag] = *place;
            if matches!(scene.origins[Tag(tag.to_bits()).prim() as usize], Origin::Polygon(0..6)) {
                found[bin(DVec3::from_array(scene.frame.to_world([x, y, z])))] += f64::from(flux[0]);
            }
        }
        for (k, ((expected, variance), found)) in expected.iter().zip(found).enumerate() {
            let (found, error) = (found / (scene.frame.scale * scene.frame.scale), variance.x.sqrt() / expected.x);
            let off = found / expected.x - 1.0;
            assert!(error < 0.02, "room {number}, bin {k}: known only to {error:.1e}");
            // The aimed photons have half a percent of noise.
            let noise = (error * error + 0.005 * 0.005).sqrt();
            assert!(off.abs() < 5.0 * noise, "room {number}, bin {k}: {found} instead of {}: {off:.1e}", expected.x);
        }
    }
}
