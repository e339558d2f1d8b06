//! Lamps far smaller than a pixel are as bright as their pictures are large, seen directly, in mirrors and through glass.

use core::f64::consts::PI;

use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, material, mirror, quad, sphere};
use smalti_tests::estimate::{render, settings};

const SIDE: u32 = 8;
const FOV: f64 = 0.2;
const RADIUS: f64 = 4e-4;
const RADIANCE: f64 = 1e5;

/// Radiance of a disc of this angular radius, added up over the pixels of the picture.
fn total(angle: f64) -> f64 {
    let pixel = 2.0 * libm::tan(FOV / 2.0) / f64::from(SIDE);
    RADIANCE * PI * (angle / pixel) * (angle / pixel)
}

/// A camera at (0, 0, `height`) that looks down, a little to the side: by `aside` at distance 1.
fn looks_down(world: &mut World, height: f64, aside: (f64, f64)) {
    camera(world, at(0.0, 0.0, height), at(aside.0, aside.1, height - 1.0), FOV);
}

fn lamp(world: &mut World, height: f64) {
    let black = material(world, smalti_tests::build::grey(0.0));
    sphere(world, at(0.0, 0.0, height), RADIUS, black, Some(RADIANCE));
}

/// Asserts that the pixels together are as bright as they are to be, and known to 6 %.
fn assert_total(name: &str, world: &World, expected: f64) {
    for integrator in [Integrator::Path, Integrator::Auto, Integrator::Whitted] {
        let rendered = render(world, &Settings { integrator, ..settings(SIDE, SIDE, 1024) });
        let pixels = f64::from(SIDE * SIDE);
        let (found, error) = (rendered.mean[0] * pixels, rendered.standard_error[0] * pixels);
        assert!(error < 0.06 * expected, "{name}, {integrator:?}: {found} ± {error} instead of {expected}");
        assert!(
            (found - expected).abs() < 4.0 * error,
            "{name}, {integrator:?}: {found} ± {error} instead of {expected}"
        );
    }
}

/// In the middle of a pixel, on an edge of two and on a corner of four.
const ASIDE: [(f64, f64); 3] = [(0.012, 0.037), (0.0, 0.012), (0.0, 0.0)];

#[test]
fn a_lamp_seen_directly() {
    for aside in ASIDE {
        let mut world = World::default();
        lamp(&mut world, 0.0);
        looks_down(&mut world, 2.0, aside);
        assert_total(&format!("{aside:?}"), &world, total(RADIUS / 2.0));
    }
}

#[test]
fn a_lamp_in_a_flat_mirror() {
    for aside in ASIDE {
        let mut world = World::default();
        let silver = material(&mut world, mirror(0.8));
        quad(&mut world, at(0.0, 0.0, 0.0), (at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0)), silver, None);
        lamp(&mut world, 3.0);
        looks_down(&mut world, 1.0, aside);
        assert_total(&format!("{aside:?}"), &world, 0.8 * total(RADIUS / 4.0));
    }
}

/// A convex mirror of focal length R / 2 has the lamp's picture behind it: at R s / (2 s + R) for a lamp at s, R / (2 s +
/// R) times as large.
#[test]
fn a_lamp_in_a_mirror_ball() {
    for aside in ASIDE {
        let mut world = World::default();
        let silver = material(&mut world, mirror(0.8));
        let (ball, near, far) = (0.5, 2.0, 3.0);
        sphere(&mut world, at(0.0, 0.0, -ball), ball, silver, None);
        lamp(&mut world, far);
        looks_down(&mut world, near, aside);
        let (size, depth) = (ball / (2.0 * far + ball), ball * far / (2.0 * far + ball));
        assert_total(&format!("{aside:?}"), &world, 0.8 * total(RADIUS * size / (near + depth)));
    }
}

/// A pane passes (1 − R) / (1 + R) in all, R = ((n − 1) / (n + 1))², and brings what is behind it nearer by d (1 − 1 / n).
#[test]
fn a_lamp_behind_a_pane() {
    let mut world = World::default();
    let glass = material(&mut world, Material::clear(1.5));
    let edges = (at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0));
    quad(&mut world, at(0.0, 0.0, 1.0), edges, glass, None);
    quad(&mut world, at(0.0, 0.0, 0.9), (edges.1, edges.0), glass, None);
    lamp(&mut world, 0.0);
    looks_down(&mut world, 2.0, ASIDE[0]);
    assert_total("pane", &world, 0.96 / 1.04 * total(RADIUS / (2.0 - 0.1 / 3.0)));
}
