//! Scenes whose every sample has the same value, and changes of a scene that may change no bit, or only the noise.

use core::f64::consts::PI;

use glam::DVec3;
use smalti_core::film::Image;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Fresnel, Integrator, SamplerKind, Settings};
use smalti_tests::build::{
    at, brighter, camera, closed_box, globe, grey, material, mesh, mirror, point_light, quad, sphere,
};
use smalti_tests::estimate::{render, settings};

/// A glass ball in an environment of radiance 1, seen from `eye`.
fn ball_in_the_sky(ior: f64, eye: DVec3) -> World {
    let mut world = World { environment: Some([1.0; 3]), ..World::default() };
    let glass = material(&mut world, Material::clear(ior));
    sphere(&mut world, DVec3::ZERO, 1.0, glass, None);
    camera(&mut world, eye, eye * 0.5 + at(0.01, 0.0, 0.0), 1.0);
    world
}

#[test]
fn a_glass_ball_vanishes_in_a_uniform_environment() {
    for ior in [1.0, 1.0001, 1.5, 2.4, 100.0, 0.7] {
        for fresnel in [Fresnel::Exact, Fresnel::Schlick] {
            let world = ball_in_the_sky(ior, at(0.0, -3.0, 0.5));
            let rendered = render(&world, &Settings { fresnel, ..settings(24, 24, 64) });
            rendered.assert_every_pixel(&format!("index {ior}, {fresnel:?}"), 1.0, 1e-5);
            assert_eq!(rendered.capped, 0, "index {ior}: paths that never leave");
        }
    }
}

#[test]
fn inside_glass_radiance_is_n_squared_times_that_outside() {
    let mut world = ball_in_the_sky(1.5, DVec3::ZERO);
    world.cameras[0].look_at = DVec3::X;
    render(&world, &settings(24, 24, 64)).assert_every_pixel("camera in glass", 2.25, 1e-5);
}

/// From the middle of a ball every ray goes straight out: what is reflected goes through the middle again.
#[test]
fn glass_that_absorbs_leaves_what_beer_and_lambert_say() {
    for (ior, radius, absorption) in [
        (1.0, 1.0, [0.0, 1.0, 10.0]),
        (1.0, 3e4, [1e-3, 80.0 / 3e4, 1e4 / 3e4]),
        (1.5, 2.5e-7, [1e6, 4e6, 2e7]),
        (0.8, 7.0, [0.01, 0.1, 1.0]),
    ] {
        let mut world = ball_in_the_sky(ior, DVec3::ZERO);
        world.materials[0] = Material::Dielectric { ior, absorption };
        world.spheres[0].radius = radius;
        world.cameras[0].look_at = DVec3::X;
        let reflected = ((ior - 1.0) / (ior + 1.0)) * ((ior - 1.0) / (ior + 1.0));
        let expected = absorption.map(|each| {
            let once = libm::exp(-each * radius);
            ior * ior * (1.0 - reflected) * once / (1.0 - reflected * once * once)
        });
        let rendered = render(&world, &settings(24, 24, 64));
        for (channel, expected) in expected.into_iter().enumerate() {
            // An ulp of the distance is as many of what is left as it is absorbed times; and few rays are reflected twice.
            let tolerance = 5e-6 + 2e-2 * reflected;
            for pixel in &rendered.image.pixels {
                let found = f64::from(pixel[channel]);
                let off = (found - expected).abs();
                assert!(off <= tolerance * expected + 1e-38, "index {ior}, channel {channel}: {found}, not {expected}");
            }
        }
    }
}

#[test]
fn a_box_of_mirrors_is_a_geometric_series() {
    let mut world = World::default();
    let shiny = material(&mut world, mirror(0.9));
    closed_box(&mut world, DVec3::ZERO, at(1.0, 1.5, 0.7), shiny, Some(1.0));
    camera(&mut world, at(0.1, 0.2, 0.3), at(1.0, -0.4, 0.0), 1.2);
    for bounces in [0u32, 1, 2, 10, 40] {
        let series: f64 = (0..=bounces).map(|k| libm::pow(0.9, f64::from(k))).sum();
        let of_tree = Settings { integrator: Integrator::Whitted, max_bounces: Some(bounces), ..settings(16, 16, 4) };
        render(&world, &of_tree).assert_every_pixel(&format!("{bounces} bounces"), series, 1e-5);
        let of_paths = Settings { max_bounces: Some(bounces), ..settings(32, 32, 256) };
        render(&world, &of_paths).assert_mean(&format!("{bounces} bounces, roulette"), series, 0.015);
    }
    render(&world, &settings(32, 32, 1024)).assert_mean("every bounce", 10.0, 0.01);
}

#[test]
fn under_a_point_light_radiance_is_that_of_the_inverse_square() {
    for height in [1e-3, 0.5, 1.0, 7.0, 1e4] {
        let mut world = World::default();
        let white = material(&mut world, grey(0.6));
        quad(&mut world, DVec3::ZERO, (DVec3::X * height, DVec3::Y * height), white, None);
        point_light(&mut world, at(0.0, 0.0, height), 2.5);
        camera(&mut world, at(0.3, 0.2, 0.4) * height, DVec3::ZERO, 1e-3);
        for integrator in [Integrator::Path, Integrator::Whitted] {
            let still = Settings { integrator, jitter: false, ..settings(1, 1, 16) };
            let expected = 0.6 * 2.5 / (PI * height * height);
            // The point is moved off the surface by up to 24 · 2⁻²⁴ of its largest coordinate, here half the height.
            let name = format!("{height} m, {integrator:?}");
            render(&world, &still).assert_every_pixel(&name, expected, 2.0 * 0.72e-6 + 0.5e-6);
        }
    }
}

/// Every kind of primitive, material and light.
fn everything() -> World {
    let mut world = World { environment: Some([0.1, 0.2, 0.3]), ..World::default() };
    let white = material(&mut world, Material::Lambert { albedo: [0.7, 0.6, 0.5] });
    let shiny = material(&mut world, mirror(0.9));
    let glass = material(&mut world, Material::clear(1.5));
    quad(&mut world, DVec3::ZERO, (DVec3::X * 3.0, DVec3::Y * 3.0), white, None);
    quad(&mut world, at(0.3, 3.0, 1.7), (DVec3::X * 2.0, DVec3::Z), shiny, None);
    quad(&mut world, at(0.0, 0.0, 3.0), (DVec3::Y * 0.5, DVec3::X * 0.5), white, Some(8.0));
    sphere(&mut world, at(-1.0, 0.3, 0.8), 0.7, glass, None);
    sphere(&mut world, at(1.0, 0.4, 0.5), 0.5, white, None);
    sphere(&mut world, at(0.2, -0.6, 0.2), 0.1, white, Some(20.0));
    point_light(&mut world, at(2.0, -2.0, 2.5), 3.0);
    let (vertices, faces) = globe(9, 5, |row, column| 0.3 + 0.05 * f64::from((row * 7 + column * 3) % 4));
    mesh(&mut world, (vertices.into_iter().map(|v| v + at(0.4, 1.3, 0.45)).collect(), faces), white, None);
    camera(&mut world, at(0.3, -4.0, 1.9), at(0.0, 0.3, 0.6), 0.8);
    world
}

fn bits(image: &Image) -> Vec<[u32; 3]> {
    image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

fn power_of_two(k: i32) -> f64 {
    libm::ldexp(1.0, k)
}

#[test]
fn powers_of_two_in_length_change_no_bit() {
    let world = everything();
    for integrator in [Integrator::Path, Integrator::Whitted] {
        let settings = Settings { integrator, ..settings(40, 30, 4) };
        let at_one = render(&world, &settings).image;
        for k in [-40, -20, -1, 1, 20, 40] {
            let s = power_of_two(k);
            let scaled = render(&world.placed(s, |v| v * s), &settings).image;
            assert!(bits(&scaled) == bits(&at_one), "{integrator:?}: lengths × 2^{k}");
        }
    }
}

#[test]
fn translations_that_f64_holds_change_no_bit() {
    let world = everything();
    // On a grid of 2⁻²⁰ m, sums with these are exact.
    let snap = |v: DVec3| (v * 1_048_576.0).round() / 1_048_576.0;
    let on_grid = world.placed(1.0, snap);
    let at_origin = render(&on_grid, &settings(40, 30, 4)).image;
    for away in [at(1.0, -2.0, 3.0), at(1e3, 0.0, 5e5), at(-67_108_864.0, 12_345.0, 0.125)] {
        let mut there = on_grid.placed(1.0, |v| v + away);
        there.spheres.iter_mut().zip(&on_grid.spheres).for_each(|(moved, still)| moved.radius = still.radius);
        let moved = render(&there, &settings(40, 30, 4)).image;
        assert!(bits(&moved) == bits(&at_origin), "moved by {away}");
    }
}

#[test]
fn powers_of_two_in_radiance_scale_every_pixel_exactly() {
    let world = everything();
    let at_one = render(&world, &settings(40, 30, 4)).image;
    for k in [-60, -7, 1, 60] {
        let factor = power_of_two(k);
        let bright = render(&brighter(&world, factor), &settings(40, 30, 4)).image;
        let expected = at_one.pixels.iter().map(|pixel| pixel.map(|x| (x * factor as f32).to_bits()));
        assert!(bits(&bright).into_iter().eq(expected), "emission × 2^{k}");
    }
}

/// Panels that emit differently, an environment, and, if asked for, a ball of index 1 before them.
fn panels(ball: bool) -> World {
    let mut world = World { environment: Some([0.25; 3]), ..World::default() };
    let black = material(&mut world, grey(0.0));
    let clear = material(&mut world, Material::clear(1.0));
    for k in 0..5 {
        let x = 0.7 * f64::from(k) - 1.4;
        quad(&mut world, at(x, 3.0, 0.0), (DVec3::X * 0.21, DVec3::Z), black, Some(f64::from(k) + 1.0));
    }
    // It stands outside the picture: the frame must not depend on the ball.
    quad(&mut world, at(0.0, 0.0, -9.0), (DVec3::X, DVec3::Y), black, None);
    if ball {
        sphere(&mut world, DVec3::ZERO, 1.0, clear, None);
    }
    camera(&mut world, at(0.0, -4.0, 0.1), DVec3::ZERO, 0.6);
    world
}

#[test]
fn a_ball_of_index_1_cannot_be_seen() {
    let still = Settings { jitter: false, ..settings(64, 48, 4) };
    let (with, without) = (render(&panels(true), &still).image, render(&panels(false), &still).image);
    let values: std::collections::BTreeSet<_> = without.pixels.iter().map(|pixel| pixel[0].to_bits()).collect();
    assert_eq!(values.len(), 6, "all panels and the environment are in the picture");
    for (index, (with, without)) in with.pixels.iter().zip(&without.pixels).enumerate() {
        assert!((with[0] - without[0]).abs() <= 1e-6, "pixel {index}: {with:?} instead of {without:?}");
    }
}

#[test]
fn a_light_cut_to_pieces_gives_the_same_light() {
    // Lambert's formula for a square of side 1 at height 1.
    let expected = 0.752_274_688_454 * 0.5 / PI;
    for (columns, rows) in [(1u32, 1u32), (2, 1), (4, 2), (8, 8)] {
        let mut world = World::default();
        let (white, black) = (material(&mut world, grey(0.5)), material(&mut world, grey(0.0)));
        quad(&mut world, DVec3::ZERO, (DVec3::X * 0.1, DVec3::Y * 0.1), white, None);
        let half = at(0.5 / f64::from(columns), 0.5 / f64::from(rows), 0.0);
        for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
            let corner = at(f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows), 1.0);
            let centre = corner + half - at(0.5, 0.5, 0.0);
            quad(&mut world, centre, (DVec3::Y * half.y, DVec3::X * half.x), black, Some(1.0));
        }
        camera(&mut world, at(0.3, 0.2, 0.4), DVec3::ZERO, 1e-4);
        for sampler in [SamplerKind::Sobol, SamplerKind::Independent] {
            let rendered = render(&world, &Settings { sampler, ..settings(32, 32, 1024) });
            rendered.assert_mean(&format!("{columns} × {rows} pieces, {sampler:?}"), expected, 0.002);
        }
    }
}
