//! Radii and rounds: what a radius blurs is its square, and noise and blur both go to zero with more rounds.

use std::sync::atomic::AtomicU64;

use glam::DVec3;
use smalti_core::film::{Film, ROUND};
use smalti_core::photon::maps::Pilots;
use smalti_core::photon::pass::Pass;
use smalti_core::photon::{Aim, Kind, Quantity};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::{Origin, World};
use smalti_core::settings::{Integrator, SamplerKind, Settings};
use smalti_scheduler::pool;
use smalti_tests::build::{at, camera, grey, material, mirror, point_light, quad};
use smalti_tests::estimate::settings;
use smalti_tests::oracle::camera_ray;
use smalti_tests::photons::{Place, irradiance, map_of, mapper, trace};

/// Slope of a straight line through points, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / n, y + point.1 / n));
    let along: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    along / points.iter().map(|point| (point.0 - x) * (point.0 - x)).sum::<f64>()
}

/// Under a point light at height 1 a disc of radius r has the mean irradiance 2/r² (1 − 1/√(1 + r²)).
#[test]
fn a_radius_blurs_by_its_square() {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    quad(&mut world, DVec3::ZERO, (DVec3::X * 2.0, DVec3::Y * 2.0), white, None);
    point_light(&mut world, DVec3::Z, 1.0);
    let renderer = mapper(&world, Settings { max_bounces: Some(1), ..Settings::default() });
    let (scene, photons) = (renderer.scene(), renderer.plan().photons.as_ref().unwrap());
    let scale = scene.frame.scale;
    let [x, y, z] = scene.frame.point(DVec3::ZERO).as_vec3().to_array();
    let aim = Aim::at(&scene.lights, &[[x, y, z, (0.7 * scale) as f32]], &[true]);
    let pass = Pass { kind: Kind::Global, aim, photons: 0, goes_on: true };
    let radii = [0.15, 0.3, 0.6];
    let (rounds, mut sums, mut squares) = (32u32, [0.0; 3], [0.0; 3]);
    for round in 0..rounds {
        let traced = trace(&renderer, &pass, 1 << 16, round);
        for (k, radius) in radii.into_iter().enumerate() {
            let map = map_of(&traced.photons, &photons.surfaces, (radius * scale) as f32, Quantity::Radiance);
            let place = Place::on(&renderer, Origin::Polygon(0), DVec3::ZERO, DVec3::Z);
            let [found, ..] = irradiance((&map, 0, 0), &photons.surfaces, &place);
            sums[k] += found;
            squares[k] += found * found;
        }
    }
    let n = f64::from(rounds);
    let mut points = Vec::new();
    for (k, radius) in radii.into_iter().enumerate() {
        let mean = sums[k] / n;
        let error = ((squares[k] / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
        let expected = 2.0 / (radius * radius) * (1.0 - 1.0 / (1.0 + radius * radius).sqrt());
        assert!(error < 0.05 * (1.0 - expected), "radius {radius}: {mean} known only to {error}");
        // Beyond the noise, the f32 sum of tens of thousands of equal fluxes is off by up to 4e-4.
        assert!(
            (mean - expected).abs() < 5.0 * error + 5e-4,
            "radius {radius}: {mean} ± {error} instead of {expected}"
        );
        points.push((libm::log(radius), libm::log(1.0 - mean)));
    }
    let slope = slope(&points);
    assert!((slope - 2.0).abs() < 0.3, "the bias grows as r^{slope:.2}");
}

/// Height of the light, and of its image in the mirror.
const LIGHT: f64 = 1.0;
const IMAGE: f64 = 1.4;
const ALBEDO: f64 = 0.5;
const REFLECTANCE: f64 = 0.9;

/// A point light between the floor and a mirror: only photons find its image.
fn below_a_mirror() -> World {
    let mut world = World::default();
    let (white, shiny) = (material(&mut world, grey(ALBEDO)), material(&mut world, mirror(REFLECTANCE)));
    quad(&mut world, DVec3::ZERO, (DVec3::X, DVec3::Y), white, None);
    quad(&mut world, at(0.0, 0.0, (LIGHT + IMAGE) / 2.0), (DVec3::Y, DVec3::X), shiny, None);
    point_light(&mut world, at(0.0, 0.0, LIGHT), 1.0);
    camera(&mut world, at(0.0, -0.8, 0.6), DVec3::ZERO, 0.6);
    world
}

/// Radiance of the floor behind the middle of each pixel.
fn truth(world: &World, settings: &Settings) -> Vec<f64> {
    let size = (settings.width, settings.height);
    let from = |height: f64, point: DVec3| height / libm::pow(height * height + point.length_squared(), 1.5);
    let radiance = |index: u32| {
        let place = (f64::from(index % size.0) + 0.5, f64::from(index / size.0) + 0.5);
        let ray = camera_ray(world, size, place);
        let point = ray.origin - ray.origin.z / ray.direction.z * ray.direction;
        ALBEDO / core::f64::consts::PI * (from(LIGHT, point) + REFLECTANCE * from(IMAGE, point))
    };
    (0..size.0 * size.1).map(radiance).collect()
}

/// Mean squared relative error of the image after 2², 2³ ... 2⁸ rounds.
fn errors(world: &World, settings: &Settings, truth: &[f64]) -> Vec<f64> {
    let renderer = Renderer::new(world, settings.clone(), Level::available()[0]).unwrap();
    let mut film = Film::new(settings.area(), 64);
    let (progress, mut pilots, mut workspace) = (AtomicU64::new(0), Pilots::default(), renderer.workspace());
    let mut errors = Vec::new();
    for round in 0..256u32 {
        let maps = renderer.maps(round, pilots, &progress);
        for tile in &mut film.tiles {
            renderer.advance(tile, (round + 1) * ROUND, &maps, &mut workspace, &progress);
        }
        pilots = maps.pilots();
        if round + 1 >= 4 && (round + 1).is_power_of_two() {
            let image = film.develop();
            let off = |(pixel, truth): (&[f32; 3], &f64)| f64::from(pixel[0]) / truth - 1.0;
            let squares = image.pixels.iter().zip(truth).map(off).map(|off| off * off);
            errors.push(squares.sum::<f64>() / truth.len() as f64);
        }
    }
    errors
}

/// P3. With α = 2/3 squared bias and variance both fall as n^(−2/3).
#[test]
fn the_error_falls_with_the_rounds() {
    let (world, alone) = (below_a_mirror(), pool(1).unwrap());
    // Of the one nearly all is noise, of the other much is blur.
    for (sampler, radius) in [(SamplerKind::Sobol, 0.15), (SamplerKind::Independent, 0.6)] {
        let of = |seed| Settings {
            integrator: Integrator::Auto,
            sampler,
            seed,
            photons: Some(1 << 12),
            radius: Some(radius),
            max_bounces: Some(2),
            jitter: false,
            ..settings(8, 8, 256 * ROUND)
        };
        let truth = truth(&world, &of(0));
        // Rounds of so few photons are over before other threads have woken up.
        let all: Vec<Vec<f64>> = alone.install(|| (0..3).map(|seed| errors(&world, &of(seed), &truth)).collect());
        let mean = |k: usize| all.iter().map(|errors| errors[k]).sum::<f64>() / all.len() as f64;
        let points: Vec<_> = (0..7).map(|k| (k as f64 * core::f64::consts::LN_2, libm::log(mean(k)))).collect();
        let slope = slope(&points);
        assert!((-1.0..-0.5).contains(&slope), "{sampler:?}, radius {radius}: the error falls as n^{slope:.2}");
    }
}
