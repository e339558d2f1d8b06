//! Warps: what they draw is distributed as they say, and their densities integrate to 1.

use core::f64::consts::{PI, TAU};

use glam::DVec3;
use smalti_core::lanes::{One, V3};
use smalti_core::sampling::{Keys, Purpose, pair, sampler::pixel_key, warp};
use smalti_core::settings::SamplerKind;
use smalti_tests::oracle::Random;

use crate::{assert_fits, of_cosine, turn, uniform};

const SAMPLES: u32 = 1_000_000;

/// Independent pairs as a sampler gives them: 24 bits, below 1.
fn numbers(seed: u64) -> impl Iterator<Item = (f32, f32)> {
    let mut random = Random::new(seed);
    let mut unit = move || (random.unit() * 16_777_216.0) as u32 as f32 / 16_777_216.0;
    (0..SAMPLES).map(move |_| (unit(), unit()))
}

fn f64s(v: V3<One>) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

#[test]
fn disc_is_uniform() {
    let points = numbers(1).map(|(u, v)| warp::disc(One, u, v)).map(|(x, y)| (f64::from(x), f64::from(y)));
    assert_fits("disc", points.map(|(x, y)| (x * x + y * y, turn(x, y))), uniform);
}

#[test]
fn hemisphere_is_cosine_weighted() {
    let directions = numbers(2).map(|(u, v)| f64s(warp::cosine_hemisphere(One, u, v)));
    let pairs = directions.map(|d| {
        assert!(d.z > 0.0 && (d.length() - 1.0).abs() < 3e-7);
        (d.z, turn(d.x, d.y))
    });
    assert_fits("hemisphere", pairs, of_cosine);
}

#[test]
fn cones_of_any_opening_are_uniform() {
    for opening in [2.0f32, 1.0, 0.1, 1e-4, 5e-13] {
        let pairs = numbers(u64::from(opening.to_bits())).map(|(u, v)| {
            let (direction, below) = warp::cone(One, opening, u, v);
            let d = f64s(direction);
            let sine_squared = f64::from(below) * (2.0 - f64::from(below));
            assert!((d.x * d.x + d.y * d.y - sine_squared).abs() <= 1e-6 * sine_squared);
            assert!((d.z - (1.0 - f64::from(below))).abs() < 1e-7);
            (f64::from(below / opening), turn(d.x, d.y))
        });
        assert_fits(&format!("cone of opening {opening}"), pairs, uniform);
    }
}

#[test]
fn triangle_is_uniform() {
    // 1 − u has density 2(1 − u): its square is uniform; v/(1 − u) is uniform beside it.
    let pairs = numbers(3).map(|(u, v)| warp::triangle(One, u, v)).map(|(u, v)| (f64::from(u), f64::from(v)));
    let folded = pairs.map(|(u, v)| {
        assert!(u >= 0.0 && v >= 0.0 && u + v <= 1.0);
        ((1.0 - u) * (1.0 - u), if u < 1.0 { v / (1.0 - u) } else { 0.0 })
    });
    assert_fits("triangle", folded, uniform);
}

#[test]
fn turning_keeps_the_distribution_about_any_normal() {
    let mut random = Random::new(4);
    let axes = [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(1e-4, 0.0, -1.0)];
    for normal in axes.into_iter().chain([random.direction(), random.direction()]) {
        let normal = normal.normalize().as_vec3();
        let n = V3::<One>::new(normal.x, normal.y, normal.z);
        let exact = f64s(n).normalize();
        let tangent = exact.any_orthonormal_vector();
        let bitangent = exact.cross(tangent);
        let pairs = numbers(5).map(|(u, v)| {
            let d = f64s(warp::about(One, n, warp::cosine_hemisphere(One, u, v)));
            assert!((d.length() - 1.0).abs() < 1e-6);
            (d.dot(exact).clamp(0.0, 1.0), turn(d.dot(tangent), d.dot(bitangent)))
        });
        assert_fits(&format!("about {exact}"), pairs, of_cosine);
    }
}

#[test]
fn densities_integrate_to_1() {
    let steps = 100_000u32;
    let cosine = |k: u32| (k as f32 + 0.5) / steps as f32;
    let hemisphere: f64 = (0..steps).map(|k| f64::from(warp::cosine_hemisphere_pdf(One, cosine(k)))).sum();
    assert!((hemisphere * TAU / f64::from(steps) - 1.0).abs() < 1e-6);
    for opening in [2.0f32, 0.3, 1e-6, 1e-12] {
        let whole = f64::from(warp::cone_pdf(One, opening)) * 2.0 * PI * f64::from(opening);
        assert!((whole - 1.0).abs() < 3e-7, "cone of opening {opening}");
    }
}

#[test]
fn independent_numbers_are_uniform_over_pixels_and_over_samples() {
    let draw = |key: u32, sample: u32| {
        let keys = Keys::<One> { key, index: sample.reverse_bits() };
        let (u, v) = pair(One, SamplerKind::Independent, keys, 1, Purpose::Bsdf);
        (f64::from(u), f64::from(v))
    };
    let over_pixels = (0..SAMPLES).map(|k| draw(pixel_key(1, k % 1000, k / 1000, 0), 0));
    assert_fits("independent numbers over pixels", over_pixels, uniform);
    let over_samples = (0..SAMPLES).map(|k| draw(pixel_key(1, 3, 4, k / 16), k % 16));
    assert_fits("independent numbers over samples", over_samples, uniform);
    let over_scrambles = (0..SAMPLES).map(|k| {
        let keys = Keys::<One> { key: pixel_key(2, k % 1000, k / 1000, 5), index: 3u32.reverse_bits() };
        let (u, v) = pair(One, SamplerKind::Sobol, keys, 2, Purpose::LightPoint);
        (f64::from(u), f64::from(v))
    });
    assert_fits("one Sobol point over its scrambles", over_scrambles, uniform);
}
