//! `auto`, `photon` and `path` against each other, and photons against the oracle's.
//!
//! Pixels of a picture share photons, so its own account of its noise does not serve: a picture is rendered with several
//! seeds, and the means of its blocks are compared by Welch's test over the seeds.

use core::f64::consts::PI;

use glam::DVec3;
use smalti_core::photon::{Photons, Quantity, Tag};
use smalti_core::render::Renderer;
use smalti_core::scene::world::Material;
use smalti_core::scene::{Origin, World};
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, closed_box, globe, grey, material, mesh, mirror, quad, sphere};
use smalti_tests::estimate::{assert_near, render, settings};
use smalti_tests::oracle::{Random, photon};
use smalti_tests::photons::{Place, irradiance, map_of, mapper, trace};
use smalti_tests::statistics::{critical_of_t, sidak};

use crate::{BLOCK, PAIRS, SIZE, block, scenes};

/// Renders of a picture.
const SEEDS: u64 = 8;

/// Means of each channel of each block, and of the whole picture, over the seeds; and the variances of these means.
type Blocks = Vec<(f64, f64)>;

fn blocks(world: &World, settings: &Settings, first_seed: u64) -> Blocks {
    let across = SIZE / BLOCK;
    let mut sums = vec![(0.0, 0.0); 3 * (1 + across * across) as usize];
    for seed in first_seed..first_seed + SEEDS {
        let image = render(world, &Settings { seed, ..settings.clone() }).image;
        let mean = |pixels: &mut dyn Iterator<Item = usize>, channel: usize| {
            let (sum, count) =
                pixels.fold((0.0, 0), |(sum, n), pixel| (sum + f64::from(image.pixels[pixel][channel]), n + 1));
            sum / f64::from(count)
        };
        for (k, sum) in sums.iter_mut().enumerate() {
            let (channel, number) = (k % 3, k as u32 / 3);
            let value = match number.checked_sub(1) {
                None => mean(&mut (0..image.pixels.len()), channel),
                Some(number) => mean(&mut block(number % across, number / across), channel),
            };
            sum.0 += value;
            sum.1 += value * value;
        }
    }
    let n = SEEDS as f64;
    let of = |(sum, squares): (f64, f64)| (sum / n, (squares / n - sum / n * sum / n).max(0.0) / (n - 1.0));
    sums.into_iter().map(of).collect()
}

/// Asserts that blocks have the same means, up to a bias of `allowance` of the mean, and that the whole picture is
/// known to `precision`.
fn assert_same(name: &str, a: &Blocks, b: &Blocks, (allowance, precision): (f64, f64)) {
    let alpha = sidak(1e-4, PAIRS * a.len());
    let mut squares = 0.0;
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        let name =
            format!("{name}, channel {}, {}", k % 3, if k < 3 { "whole".into() } else { format!("block {}", k / 3) });
        let error = (a.1 + b.1).sqrt();
        // What is seen directly has no noise.
        if error < 1e-5 * b.0 {
            assert!((a.0 - b.0).abs() <= 1e-4 * b.0, "{name}: {a:?} and {b:?}");
            continue;
        }
        let off = (a.0 - b.0).abs();
        let alpha = if k < 3 { 1e-4 } else { alpha };
        let limit = critical_of_t(alpha, freedom(a.1, b.1)) * error;
        assert!(off <= limit + allowance * b.0, "{name}: {a:?} and {b:?}, z = {:.1}", off / error);
        assert!(k >= 3 || error < precision * b.0, "{name}: known only to {:e}", error / b.0);
        squares += off * off / (error * error);
    }
    // With 14 degrees of freedom 1.17 is expected.
    let spread = squares / a.len() as f64;
    assert!((0.35..2.5).contains(&spread), "{name}: t² is {spread:.2} in the mean");
}

/// Welch's degrees of freedom.
fn freedom(a: f64, b: f64) -> f64 {
    (a + b) * (a + b) / ((a * a + b * b) / (SEEDS as f64 - 1.0))
}

/// Photon radii blur: what they may do to a block, by its mean. The radius is given and small.
fn assert_all_agree(name: &str, world: &World, radius: f64, spp: u32, (allowance, precision): (f64, f64)) {
    let of = |integrator, first_seed| {
        let photons = Settings { photons: Some(1 << 16), radius: Some(radius), ..settings(SIZE, SIZE, spp) };
        blocks(world, &Settings { integrator, ..photons }, first_seed)
    };
    let path = of(Integrator::Path, 1000);
    for (integrator, first_seed) in [(Integrator::Auto, 2000), (Integrator::Photon, 3000)] {
        let name = format!("{name}, {}", integrator.name());
        assert_same(&name, &of(integrator, first_seed), &path, (allowance, precision));
    }
}

#[test]
fn photons_and_paths_in_a_room_with_balls() {
    assert_all_agree("balls", &scenes::room_with_balls(), 0.03, 64, (0.005, 0.005));
}

#[test]
fn photons_and_paths_under_lamps_of_all_kinds() {
    assert_all_agree("lamps", &scenes::lamps_of_all_kinds(), 0.02, 64, (0.005, 0.005));
}

#[test]
fn photons_and_paths_in_a_glowing_room() {
    assert_all_agree("glowing", &scenes::glowing_room(), 0.03, 48, (0.005, 0.005));
}

#[test]
fn photons_and_paths_with_a_mesh_under_the_sky() {
    assert_all_agree("mesh", &scenes::mesh_in_the_open(), 0.06, 48, (0.005, 0.005));
}

#[test]
fn photons_and_paths_inside_glass() {
    assert_all_agree("in glass", &scenes::camera_in_glass(), 0.03, 48, (0.005, 0.005));
}

#[test]
fn photons_and_paths_in_tinted_glass() {
    assert_all_agree("tinted", &scenes::tinted_glass(at(0.2, -3.0, 0.6)), 0.04, 48, (0.005, 0.005));
    assert_all_agree("in tinted", &scenes::tinted_glass(at(-0.1, -0.45, -0.1)), 0.04, 48, (0.005, 0.005));
}

/// A glass ball and a bent mirror above the floor, under a square lamp: the floor comes first.
fn above_the_floor() -> World {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    let (shiny, clear) = (material(&mut world, mirror(0.7)), material(&mut world, Material::clear(1.5)));
    quad(&mut world, DVec3::ZERO, (DVec3::X * 1.5, DVec3::Y * 1.5), white, None);
    quad(&mut world, at(0.0, 0.0, 2.0), (DVec3::Y * 0.2, DVec3::X * 0.2), white, Some(5.0));
    sphere(&mut world, at(0.0, 0.0, 0.8), 0.5, clear, None);
    sphere(&mut world, at(0.9, 0.0, 0.5), 0.3, shiny, None);
    world
}

/// Rings about the point under the glass ball, by their outer radius.
const RINGS: [f64; 2] = [0.2, 1.0];

fn ring(point: DVec3) -> Option<usize> {
    RINGS.iter().position(|outer| point.truncate().length() < *outer)
}

/// Aimed photons through streams against photons that the oracle sends everywhere.
#[test]
fn caustics_on_the_floor_have_the_oracles_flux() {
    let world = above_the_floor();
    let bin = |landed: &photon::Landed| {
        ring(landed.hit.point).filter(|_| landed.events > 0 && landed.hit.origin == Origin::Polygon(0))
    };
    let expected = photon::fluxes(&world, 16_000_000, 61, RINGS.len(), bin);
    let renderer = mapper(&world, Settings::default());
    let (frame, photons) = (renderer.scene().frame, renderer.plan().photons.as_ref().unwrap());
    let traced = trace(&renderer, photons.caustic.as_ref().unwrap(), 4_000_000, 0);
    let (floor, mut found) = (Origin::Polygon(0), [0.0; RINGS.len()]);
    for (place, flux) in traced.photons.places.iter().zip(&traced.photons.flux) {
        let [x, y, z, tag] = *place;
        let point = DVec3::from_array(frame.to_world([x, y, z]));
        if let Some(ring) =
            ring(point).filter(|_| renderer.scene().origins[Tag(tag.to_bits()).prim() as usize] == floor)
        {
            found[ring] += f64::from(flux[0]) / (frame.scale * frame.scale);
        }
    }
    let (sum, squares) = expected.iter().fold((0.0, 0.0), |(sum, squares), of| (sum + of.0.x, squares + of.1.x));
    assert_near("all rings", (sum, squares.sqrt()), found.iter().sum(), 0.005);
    for (k, ((expected, variance), found)) in expected.iter().zip(found).enumerate() {
        let (expected, error) = (expected.x, variance.x.sqrt() / expected.x);
        let off = found / expected - 1.0;
        assert!(error < 0.002, "ring {k}: known only to {error:e}");
        assert!(off.abs() < 5.0 * error, "ring {k}: flux {found} instead of {expected}, off by {off:.1e}");
    }
    let irradiance = mean_irradiance(&renderer, &traced.photons, RINGS[0]);
    let off = irradiance * PI * RINGS[0] * RINGS[0] / expected[0].0.x - 1.0;
    assert!(off.abs() < 0.02, "the irradiance of the spot is off by {off:.3}");
}

/// Mean irradiance of a disc about the origin: it is gathered within a radius so small that it blurs little of the spot
/// away.
fn mean_irradiance(renderer: &Renderer, photons: &Photons, radius: f64) -> f64 {
    let surfaces = &renderer.plan().photons.as_ref().unwrap().surfaces;
    let map = map_of(photons, surfaces, (0.01 * renderer.scene().frame.scale) as f32, Quantity::Radiance);
    let mut random = Random::new(62);
    let count = 4000;
    let mut at_random = || {
        let (from_middle, turn) = (radius * random.unit().sqrt(), 2.0 * PI * random.unit());
        let point = at(from_middle * libm::cos(turn), from_middle * libm::sin(turn), 0.0);
        let place = Place::on(renderer, Origin::Polygon(0), point, DVec3::Z);
        irradiance((&map, 0, 99), surfaces, &place)[0]
    };
    (0..count).map(|_| at_random()).sum::<f64>() / f64::from(count)
}

/// All that the lamps of a room send out by way of specular things, surface by surface.
#[test]
fn caustics_in_a_room_have_the_oracles_flux() {
    let mut world = World::default();
    let wall = material(&mut world, grey(0.5));
    let (shiny, clear) = (material(&mut world, mirror(0.9)), material(&mut world, Material::clear(1.6)));
    closed_box(&mut world, DVec3::ZERO, at(1.0, 1.0, 1.0), wall, None);
    sphere(&mut world, at(0.2, 0.3, 0.6), 0.15, wall, Some(4.0));
    sphere(&mut world, at(0.4, 0.3, 0.1), 0.3, clear, None);
    quad(&mut world, at(-0.6, 0.0, 0.0), (DVec3::Y * 0.4, DVec3::Z * 0.5), shiny, None);
    let (vertices, faces) = globe(5, 4, |_, _| 0.3);
    mesh(&mut world, (vertices.into_iter().map(|v| v + at(0.3, -0.5, -0.2)).collect(), faces), clear, None);
    let walls = 6;
    let bin = |landed: &photon::Landed| match landed.hit.origin {
        Origin::Polygon(number) if landed.events > 0 => Some(number as usize),
        _ => None,
    };
    let expected = photon::fluxes(&world, 8_000_000, 63, walls + 1, bin);
    let renderer = mapper(&world, Settings::default());
    let (scale, photons) = (renderer.scene().frame.scale, renderer.plan().photons.as_ref().unwrap());
    let traced = trace(&renderer, photons.caustic.as_ref().unwrap(), 4_000_000, 0);
    let mut found = vec![0.0; walls + 1];
    for (place, flux) in traced.photons.places.iter().zip(&traced.photons.flux) {
        if let Origin::Polygon(number) = renderer.scene().origins[Tag(place[3].to_bits()).prim() as usize] {
            found[number as usize] += f64::from(flux[0]) / (scale * scale);
        }
    }
    for (k, ((expected, variance), found)) in expected.iter().zip(&found).enumerate().take(walls) {
        let error = variance.x.sqrt() / expected.x;
        let off = found / expected.x - 1.0;
        assert!(error < 0.01, "wall {k}: known only to {error:e}");
        assert!(off.abs() < 5.0 * error, "wall {k}: flux {found} instead of {}, off by {off:.1e}", expected.x);
    }
    let (expected, found) = (expected.iter().map(|of| of.0.x).sum::<f64>(), found.iter().sum::<f64>());
    assert!((found / expected - 1.0).abs() < 0.005, "{found} in all instead of {expected}");
}
