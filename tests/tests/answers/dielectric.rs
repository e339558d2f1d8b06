//! What glass reflects and lets through.

use glam::DVec3;
use smalti_core::bsdf::fresnel::{boundary, reflectance};
use smalti_core::lanes::One;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Fresnel, Integrator, Settings};
use smalti_tests::build::{at, camera, grey, material, quad};
use smalti_tests::estimate::{render, settings};

/// Reflectance as the kernels have it, met from outside or from inside.
fn kernel(kind: Fresnel, ior: f64, outside: bool, cosine: f64) -> f64 {
    let constants = [ior as f32, (1.0 / ior) as f32, ((ior - 1.0) * (ior + 1.0)) as f32];
    f64::from(reflectance(One, kind, &boundary(One, constants, outside, cosine as f32)))
}

/// ∫ F 2 cosθ d(cosθ): mean over cosine-weighted directions, by the midpoint rule.
fn diffuse(kind: Fresnel, ior: f64, outside: bool) -> f64 {
    let steps = 1_000_000;
    let midpoint = |k: u32| (f64::from(k) + 0.5) / f64::from(steps);
    (0..steps).map(midpoint).map(|c| 2.0 * c * kernel(kind, ior, outside, c)).sum::<f64>() / f64::from(steps)
}

#[test]
fn normal_and_diffuse_reflectances_are_the_tables() {
    for (ior, normal, external, internal) in [
        (1.33, 0.020_059_3, 0.065_930_849_3, 0.471_949_148_8),
        (1.5, 0.04, 0.091_777_959_34, 0.596_345_759_7),
        (2.4, 0.169_550_2, 0.210_181_302, 0.862_878_698_3),
        (100.0, 0.960_788_2, 0.950_161_171_2, 0.999_995_016_1),
    ] {
        assert!((kernel(Fresnel::Exact, ior, true, 1.0) - normal).abs() < 1e-6, "index {ior} at normal incidence");
        // Inside index 100 the critical angle is 0.6°, where an f32 cosine has few digits left.
        let bound = if ior > 10.0 { 2e-5 } else { 1e-6 };
        assert!((kernel(Fresnel::Exact, ior, false, 1.0) - normal).abs() < bound, "index {ior} from inside");
        let (outer, inner) = (diffuse(Fresnel::Exact, ior, true), diffuse(Fresnel::Exact, ior, false));
        assert!((outer - external).abs() < 1e-5, "index {ior}: {outer} from outside instead of {external}");
        assert!((inner - internal).abs() < 1e-5, "index {ior}: {inner} from inside instead of {internal}");
        // Radiance / n² is kept in both directions: the one follows from the other.
        assert!((1.0 - (1.0 - outer) / (ior * ior) - inner).abs() < 1e-5, "index {ior}: the sides disagree");
    }
}

#[test]
fn schlick_is_as_far_off_as_it_is_known_to_be() {
    let worst = (1..=9000).map(|k| libm::cos(f64::from(k) * core::f64::consts::FRAC_PI_2 / 9000.0));
    let off = |c: f64| (kernel(Fresnel::Schlick, 1.5, true, c) - kernel(Fresnel::Exact, 1.5, true, c)).abs();
    assert!((worst.map(off).fold(0.0, f64::max) - 0.0357).abs() < 1e-4);
    assert!((diffuse(Fresnel::Schlick, 1.5, true) - 0.085_71).abs() < 1e-5);
    // With the cosine on the thinner side the inside is no worse: the wrong one is off by 0.878.
    let inside = (7460..10_000).map(|k| f64::from(k) / 1e4);
    let off = |c: f64| (kernel(Fresnel::Schlick, 1.5, false, c) - kernel(Fresnel::Exact, 1.5, false, c)).abs();
    assert!(inside.map(off).fold(0.0, f64::max) < 0.036);
}

#[test]
fn reflection_is_total_from_the_critical_angle_on() {
    let degrees = |angle: f64| libm::cos(angle.to_radians());
    for kind in [Fresnel::Exact, Fresnel::Schlick] {
        assert!(kernel(kind, 1.5, false, degrees(41.80)) < 1.0, "{kind:?}");
        for angle in [41.82, 50.0, 89.0, 89.9999, 90.0] {
            assert_eq!(kernel(kind, 1.5, false, degrees(angle)), 1.0, "{kind:?} at {angle}°");
        }
        let critical = (1.0 - 1.0 / 2.25f64).sqrt();
        for nudge in -20..20 {
            let cosine = f64::from(f32::from_bits((critical as f32).to_bits().wrapping_add_signed(nudge)));
            assert!((0.9..=1.0).contains(&kernel(kind, 1.5, false, cosine)), "{kind:?} at the critical angle");
        }
    }
}

/// A pane of index 1.5 between the camera and a lamp: T = (1 − F)/(1 + F) over all inner reflections, where light is
/// taken as unpolarised at each of them.
#[test]
fn a_pane_lets_through_what_its_inner_reflections_leave() {
    for (angle, expected) in [
        (0.0f64, 0.923_076_923_1),
        (30.0, 0.920_265_5),
        (45.0, 0.904_326_791_5),
        (60.0, 0.836_232_462_7),
        (75.0, 0.596_092_0),
        (85.0, 0.240_079_6),
    ] {
        let world = behind_a_pane(angle);
        let still = Settings { jitter: false, ..settings(32, 32, 1024) };
        let rendered = render(&world, &still);
        let (error, off) = (rendered.standard_error[0], rendered.mean[0] - expected);
        assert!(error <= 5e-4 && off.abs() <= 2.5e-3, "{angle}°: off by {off:.1e}, standard error {error:.1e}");
        // The tree drops branches below 1/1024, which at the steepest angle add up to a few of them.
        let tree = Settings { integrator: Integrator::Whitted, ..still.clone() };
        let tree = render(&world, &Settings { spp: 1, width: 1, height: 1, ..tree });
        let missing = expected - f64::from(tree.image.pixels[0][0]);
        assert!((-1e-5..3e-3).contains(&missing), "{angle}° as a tree: {missing:.1e} missing");
    }
}

fn behind_a_pane(angle: f64) -> World {
    let mut world = World::default();
    let glass = material(&mut world, Material::clear(1.5));
    let black = material(&mut world, grey(0.0));
    quad(&mut world, at(0.0, 0.0, 0.0), (DVec3::X * 50.0, DVec3::Y * 50.0), glass, None);
    quad(&mut world, at(0.0, 0.0, -0.1), (DVec3::Y * 50.0, DVec3::X * 50.0), glass, None);
    quad(&mut world, at(0.0, 0.0, -0.3), (DVec3::X * 100.0, DVec3::Y * 100.0), black, Some(1.0));
    let (s, c) = libm::sincos(angle.to_radians());
    camera(&mut world, at(-s, 0.0, c), DVec3::ZERO, 1e-5);
    world
}

/// A lamp seen in a pane at 60°: each sample has what the front reflects, F, and no sample more than that and what is
/// left of the rest after one reflection more. By chance alone they would have 0 or 1.
#[test]
fn a_highlight_is_in_every_sample() {
    let mut world = behind_a_pane(60.0);
    world.polygons.pop();
    let black = material(&mut world, grey(0.0));
    let (s, c) = libm::sincos(60f64.to_radians());
    // Across the reflected ray, facing the pane.
    let across = at(-c, 0.0, s);
    quad(&mut world, at(s, 0.0, c), (across * 0.5, DVec3::Y * 0.5), black, Some(1.0));
    let (all, once) = (2.0 * 0.089_189 / 1.089_189, 0.089_189);
    let one = Settings { jitter: false, spp: 1, ..settings(32, 32, 1) };
    let pixels = render(&world, &one).image.pixels;
    for value in pixels.iter().map(|pixel| f64::from(pixel[0])) {
        assert!((once - 1e-4..once + once * (1.0 - once) + 1e-4).contains(&value), "{value}");
    }
    let mean = pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / pixels.len() as f64;
    assert!((mean - all).abs() < 0.003, "{mean} instead of {all}");
}
