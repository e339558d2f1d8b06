//! Direct light on a diffuse surface, against Lambert's formula for polygons and the closed form for spheres.
//!
//! Each case states E/L: irradiance at the origin a unit of the light's radiance. The camera looks at that one point,
//! whose radiance is albedo · E / π.

use core::f64::consts::{PI, TAU};

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::settings::Settings;
use smalti_tests::build::{at, camera, grey, material, polygon, quad, sphere};
use smalti_tests::estimate::{render, settings};

const ALBEDO: f64 = 0.5;

/// A small diffuse square about the origin that looks along `normal`, and a camera that looks at its middle from not
/// farther than `near`.
fn receiver(normal: DVec3, near: f64) -> World {
    let mut world = World::default();
    let white = material(&mut world, grey(ALBEDO));
    let tangent = normal.any_orthonormal_vector();
    let bitangent = normal.cross(tangent);
    quad(&mut world, DVec3::ZERO, (tangent * 0.1 * near, bitangent * 0.1 * near), white, None);
    camera(&mut world, (normal * 0.4 + tangent * 0.2 + bitangent * 0.1) * near, DVec3::ZERO, 1e-5);
    world
}

/// A polygon above the origin that emits 1 downward; corners anticlockwise as seen from above.
fn panel(world: &mut World, corners: &[DVec3]) {
    let black = material(world, grey(0.0));
    let down: Vec<_> = corners.iter().rev().copied().collect();
    polygon(world, &down, black, Some(1.0));
}

fn square(side: f64, x: f64, height: f64) -> Vec<DVec3> {
    let s = side / 2.0;
    [(-s, -s), (s, -s), (s, s), (-s, s)].map(|(dx, dy)| at(x + dx, dy, height)).to_vec()
}

fn hexagon(radius: f64, x: f64, height: f64) -> Vec<DVec3> {
    let corner = |k: u32| f64::from(k) * TAU / 6.0;
    (0..6).map(corner).map(|a| at(x + radius * libm::cos(a), radius * libm::sin(a), height)).collect()
}

/// Panels with their E/L, as arbitrary-precision arithmetic has it.
fn panels() -> [(&'static str, Vec<DVec3>, DVec3, f64); 10] {
    let up = DVec3::Z;
    [
        ("L1 square 1 at 1", square(1.0, 0.0, 1.0), up, 0.752_274_688_454),
        ("L2 square 2 at 1", square(2.0, 0.0, 1.0), up, 1.740_839_502_73),
        ("L3 square 1 at 1, beside", square(1.0, 1.0, 1.0), up, 0.265_004_852_345),
        ("L4 square 1 at 0.01", square(1.0, 0.0, 0.01), up, 3.140_564_683_43),
        ("L5 square 1 at 1000", square(1.0, 0.0, 1000.0), up, 9.999_996_666_67e-7),
        ("L6 hexagon 1 at 1", hexagon(1.0, 0.0, 1.0), up, 1.419_421_884_83),
        ("L7 hexagon 1 at 1, beside", hexagon(1.0, 1.0, 1.0), up, 0.720_147_246_653),
        ("L8 hexagon 0.5 at 2.5", hexagon(0.5, 0.0, 2.5), up, 0.100_571_527_741),
        ("L9 square beside, looking up", square(1.0, 1.5, 1.0), up, 0.104_637_075_191),
        ("L9 square beside, looking aside", square(1.0, 1.5, 1.0), DVec3::X, 0.141_919_368_835),
    ]
}

/// Asserts E/L, by shadow rays and, where chance finds the light often enough, by scattered rays alone.
fn assert_irradiance(name: &str, world: &World, expected: f64, tolerance: f64) {
    let radiance = ALBEDO * expected / PI;
    for (shadow_rays, spp) in [(1, 1280), (4, 512)] {
        let settings = Settings { shadow_rays, ..settings(32, 32, spp) };
        render(world, &settings).assert_mean(&format!("{name}, {shadow_rays} shadow rays"), radiance, tolerance);
    }
    if expected > 0.5 {
        let by_chance = Settings { shadow_rays: 0, ..settings(32, 32, 1024) };
        render(world, &by_chance).assert_mean(&format!("{name}, by chance"), radiance, 0.005);
    }
}

#[test]
fn panels_give_lamberts_irradiance() {
    for (name, corners, normal, expected) in panels() {
        let height = corners[0].z;
        let mut world = receiver(normal, height.min(1.0));
        panel(&mut world, &corners);
        assert_irradiance(name, &world, expected, 0.002);
    }
}

#[test]
fn panels_give_the_same_at_any_scale() {
    for (name, corners, normal, expected) in panels() {
        let mut world = receiver(normal, corners[0].z.min(1.0));
        panel(&mut world, &corners);
        for scale in [1e-6, 1e6] {
            let scaled = world.placed(scale, |v| v * scale);
            let rendered = render(&scaled, &settings(32, 32, 1280));
            rendered.assert_mean(&format!("{name} × {scale:e}"), ALBEDO * expected / PI, 0.002);
        }
    }
}

/// Irradiance from a sphere of radius 1 and radiance 1 at distance `h`, under the angle whose cosine is given.
fn of_sphere(h: f64, cosine: f64) -> f64 {
    if h * cosine > 1.0 {
        return PI * cosine / (h * h);
    }
    let sine = (1.0 - cosine * cosine).sqrt();
    let x = (h * h - 1.0).sqrt();
    let y = (-x * cosine / sine).clamp(-1.0, 1.0);
    let root = (1.0 - y * y).sqrt();
    (cosine * libm::acos(y) - x * sine * root) / (h * h) + libm::atan(sine * root / x)
}

fn under_a_sphere(radius: f64, distance: f64, cosine: f64) -> World {
    // The camera stays below the sphere, however close that is.
    let mut world = receiver(DVec3::Z, 0.2 * distance.min(distance - radius));
    let black = material(&mut world, grey(0.0));
    let sine = (1.0 - cosine * cosine).sqrt();
    sphere(&mut world, at(distance * sine, 0.0, distance * cosine), radius, black, Some(1.0));
    world
}

#[test]
fn spheres_give_the_closed_form_even_partly_below_the_horizon() {
    let table = [(1.0, PI / 4.0), (0.6, 0.471_238_898), (0.3, 0.247_291_818_9), (0.0, 0.090_586_073_71)];
    for (cosine, expected) in table.into_iter().chain([(-0.3, 0.011_672_369_89)]) {
        assert!((of_sphere(2.0, cosine) - expected).abs() < 1e-9, "the closed form itself, {cosine}");
        // Of the last, shadow rays find only a rim.
        let tolerance = if cosine < 0.0 { 0.0075 } else { 0.002 };
        assert_irradiance(
            &format!("sphere at cosine {cosine}"),
            &under_a_sphere(1.0, 2.0, cosine),
            expected,
            tolerance,
        );
        for scale in [1e-6, 1e6] {
            let rendered = render(&under_a_sphere(scale, 2.0 * scale, cosine), &settings(32, 32, 1280));
            rendered.assert_mean(&format!("{scale:e} × {cosine}"), ALBEDO * expected / PI, tolerance);
        }
    }
}

#[test]
fn far_and_near_spheres_give_the_closed_form() {
    for (h, cosine) in [(1.001, 1.0), (1.1, 0.8), (10.0, 0.7), (1e3, 1.0), (1e4, 0.3), (1e5, 0.5), (1e6, 0.9)] {
        let world = under_a_sphere(1.0, h, cosine);
        let radiance = ALBEDO * of_sphere(h, cosine) / PI;
        let rendered = render(&world, &settings(16, 16, 2048));
        rendered.assert_mean(&format!("sphere {h:e} radii away"), radiance, 0.002);
    }
}

/// Form factors of a unit cube, by the mean over a whole face: a pinhole that looks straight at a face and sees all of
/// it weighs all parts of it alike.
#[test]
fn faces_of_a_cube_exchange_light_by_their_form_factors() {
    for (name, eye, factor) in
        [("opposite", at(0.0, 0.0, 0.4), 0.199_824_895_698), ("adjacent", at(0.9, 0.0, 0.0), 0.200_043_776_075)]
    {
        let mut world = World::default();
        let (white, black) = (material(&mut world, grey(ALBEDO)), material(&mut world, grey(0.0)));
        quad(&mut world, at(0.0, 0.0, 0.5), (DVec3::Y * 0.5, DVec3::X * 0.5), black, Some(1.0));
        let (centre, spans) = match name {
            "opposite" => (at(0.0, 0.0, -0.5), (DVec3::X * 0.5, DVec3::Y * 0.5)),
            _ => (at(-0.5, 0.0, 0.0), (DVec3::Y * 0.5, DVec3::Z * 0.5)),
        };
        quad(&mut world, centre, spans, white, None);
        camera(&mut world, eye, centre, 2.0 * libm::atan(0.5 / eye.distance(centre)));
        let rendered = render(&world, &settings(64, 64, 128));
        rendered.assert_mean(name, ALBEDO * factor, 0.002);
    }
}
