//! The path integrator against the oracle, block by block.

use core::f64::consts::PI;

use glam::DVec3;
use smalti_core::scene::World;
use smalti_tests::build::{at, camera, closed_box, grey, material, quad};
use smalti_tests::estimate::{render, settings};
use smalti_tests::oracle::{self, Finds};

use crate::{SIZE, assert_agree, of_oracle, of_streams, scenes};

fn assert_as_the_oracle(name: &str, world: &World, finds: Finds, spp: u32, precision: f64) {
    let streams = of_streams(&render(world, &settings(SIZE, SIZE, 256)));
    let reference = of_oracle(&oracle::render(world, (SIZE, SIZE), spp, finds, 77));
    assert_agree(name, &streams, &reference, precision);
}

#[test]
fn room_with_balls() {
    assert_as_the_oracle("balls", &scenes::room_with_balls(), Finds::ByShadowRay, 256, 0.01);
}

#[test]
fn mesh_in_the_open() {
    assert_as_the_oracle("mesh", &scenes::mesh_in_the_open(), Finds::ByShadowRay, 192, 0.01);
}

#[test]
fn lamps_of_all_kinds() {
    assert_as_the_oracle("lamps", &scenes::lamps_of_all_kinds(), Finds::ByShadowRay, 256, 0.02);
}

#[test]
fn camera_in_glass() {
    assert_as_the_oracle("in glass", &scenes::camera_in_glass(), Finds::ByShadowRay, 256, 0.01);
}

#[test]
fn tinted_glass() {
    for eye in [at(0.2, -3.0, 0.6), at(-0.1, -0.45, -0.1)] {
        assert_as_the_oracle("tinted", &scenes::tinted_glass(eye), Finds::ByShadowRay, 384, 0.015);
    }
}

#[test]
fn under_the_sky() {
    assert_as_the_oracle("sky", &scenes::under_the_sky(), Finds::ByChance, 256, 0.005);
}

#[test]
fn glowing_room() {
    assert_as_the_oracle("glowing", &scenes::glowing_room(), Finds::ByChance, 384, 0.01);
}

/// The oracle itself is held against closed forms before anything is held against it.
#[test]
fn the_oracle_gives_known_answers() {
    let mean = |world: &World, spp: u32, finds: Finds| {
        let pixels = oracle::render(world, (16, 16), spp, finds, 5);
        let n = pixels.len() as f64;
        let sum: DVec3 = pixels.iter().map(|pixel| pixel.mean).sum();
        let variance: DVec3 = pixels.iter().map(|pixel| pixel.variance).sum();
        (sum.x / n, variance.x.sqrt() / n)
    };
    let assert = |name: &str, (mean, error): (f64, f64), truth: f64| {
        assert!(error < 0.004 * truth, "{name}: known only to {error}");
        assert!((mean - truth).abs() < 4.0 * error, "{name}: {mean} ± {error} instead of {truth}");
    };
    // A furnace of albedo 0.5 shows 2.
    let mut furnace = World::default();
    let wall = material(&mut furnace, grey(0.5));
    closed_box(&mut furnace, DVec3::ZERO, at(1.0, 1.2, 0.8), wall, Some(1.0));
    camera(&mut furnace, at(0.1, 0.2, 0.0), DVec3::X, 1.0);
    assert("furnace", mean(&furnace, 256, Finds::ByChance), 2.0);
    // Lambert's formula for a square of side 2 at height 1.
    let mut direct = World::default();
    let (white, black) = (material(&mut direct, grey(0.5)), material(&mut direct, grey(0.0)));
    quad(&mut direct, DVec3::ZERO, (DVec3::X * 0.1, DVec3::Y * 0.1), white, None);
    quad(&mut direct, DVec3::Z, (DVec3::Y, DVec3::X), black, Some(1.0));
    camera(&mut direct, at(0.2, 0.1, 0.4), DVec3::ZERO, 1e-4);
    for finds in [Finds::ByChance, Finds::ByShadowRay] {
        assert(&format!("{finds:?}"), mean(&direct, 1024, finds), 0.5 * 1.740_839_502_73 / PI);
    }
}
