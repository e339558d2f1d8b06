//! Kernels in f32 against the same in f64: no more than their stated error.

use core::f64::consts::{FRAC_PI_4, TAU};

use glam::DVec3;
use smalti_core::accel::{Accel, Tracer};
use smalti_core::bsdf::fresnel::{boundary, reflectance};
use smalti_core::geometry::Ray;
use smalti_core::lanes::math::{exp_minus, leading_bits, sin_cos_quarter, sin_cos_turn};
use smalti_core::lanes::{One, V3};
use smalti_core::light::table::NO_SURFACE;
use smalti_core::sampling::warp;
use smalti_core::scene::{World, compile};
use smalti_core::settings::Fresnel;
use smalti_tests::build::{grey, material, sphere};
use smalti_tests::oracle::{Random, optics};

#[test]
fn sine_and_cosine_keep_seven_digits() {
    for k in -1_000_000..=1_000_000 {
        let x = (f64::from(k) / 1e6 * FRAC_PI_4) as f32;
        let (s, c) = sin_cos_quarter(One, x);
        let (sine, cosine) = libm::sincos(f64::from(x));
        assert!((f64::from(s) - sine).abs() < 1e-7 && (f64::from(c) - cosine).abs() < 1e-7, "at {x}");
    }
    for k in 0..1_000_003u32 {
        let u = ((u64::from(k) << 24) / 1_000_003) as f32 / 16_777_216.0;
        let (s, c) = sin_cos_turn(One, u);
        let (sine, cosine) = libm::sincos(TAU * f64::from(u));
        assert!((f64::from(s) - sine).abs() < 1.5e-7 && (f64::from(c) - cosine).abs() < 1.5e-7, "at {u} turns");
    }
}

/// Beer and Lambert: 4e-7 up to 80 e-foldings, and nothing left of light behind more than can be told from nothing.
#[test]
fn transmittance_keeps_its_digits() {
    let of = |absorption: f64, distance: f32| {
        let leading = leading_bits(absorption as f32);
        exp_minus(One, (leading, (absorption - f64::from(leading)) as f32), distance)
    };
    for absorption in [1.0, 0.3, 1.7e-3, 12.345_678_9, 3.3e4] {
        for k in 0..=400_000u32 {
            let distance = (f64::from(k) / 400_000.0 * 80.0 / absorption) as f32;
            let (found, truth) = (f64::from(of(absorption, distance)), libm::exp(-absorption * f64::from(distance)));
            assert!((found / truth - 1.0).abs() < 4e-7, "{absorption} over {distance}: {found:e}, not {truth:e}");
        }
        assert_eq!(of(absorption, (1e4 / absorption) as f32), 0.0);
        assert_eq!(of(absorption, f32::MAX), 0.0);
        assert_eq!(of(absorption, 0.0), 1.0);
    }
    assert_eq!(of(0.0, f32::MAX), 1.0);
    assert_eq!(of(f32::MAX.into(), f32::MAX), 0.0);
}

fn kernel(ior: f64, outside: bool, cosine: f32) -> f64 {
    let constants = [ior as f32, (1.0 / ior) as f32, ((ior - 1.0) * (ior + 1.0)) as f32];
    f64::from(reflectance(One, Fresnel::Exact, &boundary(One, constants, outside, cosine)))
}

#[test]
fn reflectance_keeps_its_digits_at_every_index() {
    for (ior, outside, bound) in [
        (1.0, true, 1e-7),
        (1.0 + 1.2e-7, true, 4e-7),
        (1.0 + 1e-6, true, 4e-7),
        (1.001, true, 4e-7),
        (1.33, true, 4e-7),
        (1.5, true, 4e-7),
        (2.4, true, 4e-7),
        (100.0, true, 4e-7),
        // At the critical angle the derivative is infinite: an f32 cosine allows no better.
        (1.5, false, 2.5e-4),
        (0.999_999, true, 1.5e-3),
    ] {
        for k in 1..=200_000u32 {
            let cosine = k as f32 / 200_000.0;
            let (n1, n2) = if outside { (1.0, ior) } else { (ior, 1.0) };
            let (got, exact) = (kernel(ior, outside, cosine), optics::reflectance(f64::from(cosine), n1, n2));
            assert!((got - exact).abs() <= bound, "index {ior}, cosine {cosine}: {got} instead of {exact}");
        }
    }
}

#[test]
fn reflectance_is_a_fraction_and_the_same_from_both_sides() {
    let mut random = Random::new(21);
    for _ in 0..1_000_000 {
        let ior = libm::exp2(random.between(-3.0, 7.0));
        // Grazing more than others, and exactly.
        let cosine = random.unit() as f32 * [1.0, 1e-3, 1e-6, 0.0][random.below(4)];
        for outside in [true, false] {
            let f = kernel(ior, outside, cosine);
            assert!((0.0..=1.0).contains(&f), "index {ior}, cosine {cosine}: {f}");
        }
        let constants = [ior as f32, (1.0 / ior) as f32, ((ior - 1.0) * (ior + 1.0)) as f32];
        let into = boundary(One, constants, true, cosine);
        if cosine > 0.1 && into.cosine_refracted > 0.1 && (0.5..4.0).contains(&ior) {
            let (there, back) = (kernel(ior, true, cosine), kernel(ior, false, into.cosine_refracted));
            // The cosine on the other side is rounded, and counts n² times as much here.
            assert!(
                (there - back).abs() < 5e-6 * (ior * ior).max(1.0 / ior),
                "index {ior}, cosine {cosine}: {there} and back {back}"
            );
        }
    }
}

#[test]
fn distant_spheres_are_hit_where_they_are() {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    // In the frame it fills the cube about the origin.
    sphere(&mut world, DVec3::ZERO, 1.0, white, None);
    let scene = compile(&world, false);
    let accel = Accel::new(&scene, &[0]);
    let mut tracer = Tracer::new(One, &accel);
    let mut random = Random::new(22);
    for (distance, bound) in [(3.0, 1e-5), (1e1, 2e-5), (1e2, 2e-4), (1e3, 2e-3), (1e4, 2e-2)] {
        for _ in 0..100_000 {
            let origin = (random.direction() * distance).as_vec3();
            let goal = random.direction() * 0.999 * random.unit();
            let direction = (goal - origin.as_dvec3()).normalize().as_vec3();
            let ray =
                Ray::new(One, V3::splat(One, origin.to_array()), V3::splat(One, direction.to_array()), NO_SURFACE);
            let (t, _) = tracer.nearest(One, &ray, true);
            let (origin, direction) = (origin.as_dvec3(), direction.as_dvec3());
            let closest = origin - origin.dot(direction) / direction.length_squared() * direction;
            if closest.length() > 0.9999 {
                continue;
            }
            assert!(t.is_finite(), "from {origin} along {direction}: missed");
            // Along the ray the error grows towards the silhouette: what counts is the distance to the surface.
            let point = origin + f64::from(t) * direction;
            let off = (point.length() - 1.0).abs();
            assert!(off < bound && point.dot(origin) > 0.0, "{distance} radii away: off by {off:.1e} radii");
        }
    }
}

#[test]
fn cones_of_distant_spheres_keep_their_opening() {
    for k in 1..=600 {
        let ratio = libm::exp2(f64::from(k) / 20.0);
        let (r2, d2) = (1.0f32, (ratio * ratio) as f32);
        let sine_squared = 1.0 / f64::from(d2);
        let exact = sine_squared / (1.0 + (1.0 - sine_squared).sqrt());
        let off = f64::from(warp::sphere_opening(One, r2, d2)) / exact - 1.0;
        assert!(off.abs() < 3e-7, "{ratio} radii away: off by {off:.1e}");
    }
}
