//! Scattering as the stages of the renderer do it, on streams of a million paths.

use glam::DVec3;
use smalti_core::lanes::{One, V3};
use smalti_core::sampling::sampler::pixel_key;
use smalti_core::scene::{Scene, World, compile, world::Material};
use smalti_core::settings::{Fresnel, SamplerKind};
use smalti_core::stream::mirror::Ending;
use smalti_core::stream::{
    Columns, DIRECTION, DISTANCE, ETA, KEY, ORIGIN, PDF, SLOT, Stream, THROUGHPUT, dielectric, diffuse, mirror,
};
use smalti_tests::build::{material, quad};
use smalti_tests::oracle::optics::{reflectance, reflected, refracted};
use smalti_tests::statistics::{critical, sidak};

use crate::{assert_fits, of_cosine, turn};

const PATHS: u32 = 4096;
const STREAMS: u32 = 244;

/// A stream of paths that all come along `direction` (or stand on a surface whose normal that is), each with its own
/// random numbers.
fn stream(number: u32, origin: DVec3, direction: DVec3, throughput: [f32; 3]) -> Stream {
    let mut stream = Stream::new(PATHS as usize, Columns { pdf: true, eta: true, ..Columns::default() });
    let v3 = |v: DVec3| V3::splat(One, v.as_vec3().to_array());
    for at in 0..PATHS {
        let to = at as usize;
        stream.set_v3(One, ORIGIN, to, v3(origin));
        stream.set_v3(One, DIRECTION, to, v3(direction));
        stream.set_v3(One, THROUGHPUT, to, V3::splat(One, throughput));
        stream.set_u(One, KEY, to, pixel_key(9, at, number, 0));
        stream.set_u(One, SLOT, to, at & 0xfff);
        stream.set_f(One, ETA, to, 1.0);
    }
    stream.set_len(PATHS as usize);
    stream
}

fn vector(stream: &Stream, column: usize, at: usize) -> DVec3 {
    DVec3::from_array(stream.triple(column, at).map(f64::from))
}

/// Scatters all streams and shows each path that goes on.
fn scattered(mut of_one: impl FnMut(u32, &mut Stream), mut look: impl FnMut(&Stream, usize)) -> u32 {
    let mut count = 0;
    for number in 0..STREAMS {
        let mut next = Stream::new(PATHS as usize, Columns { pdf: true, eta: true, ..Columns::default() });
        of_one(number, &mut next);
        (0..next.len()).for_each(|at| look(&next, at));
        count += next.len() as u32;
    }
    count
}

/// Asserts that `count` of all paths is a chance of `p` each.
fn assert_share(name: &str, count: u32, p: f64) {
    let n = f64::from(PATHS * STREAMS);
    let error = (p * (1.0 - p) / n).sqrt();
    let z = (f64::from(count) / n - p) / error;
    assert!(z.abs() < critical(sidak(1e-4, 12)), "{name}: {} instead of {p}, z = {z:.1}", f64::from(count) / n);
}

#[test]
fn diffuse_directions_are_cosine_weighted_and_carry_their_density() {
    let normal = DVec3::new(0.3, -0.5, -0.7).normalize();
    let (tangent, bitangent) = (normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector()));
    let mut pairs = Vec::new();
    let count = scattered(
        |number, next| {
            let vertices = stream(number, DVec3::ZERO, normal, [1.0; 3]);
            diffuse::run(One, SamplerKind::Independent, 3, &vertices, next);
        },
        |next, at| {
            let d = vector(next, DIRECTION, at);
            let cosine = d.dot(normal);
            let pdf = f64::from(f32::from_bits(next.value(PDF, at)));
            assert!((pdf - cosine / core::f64::consts::PI).abs() < 2e-7, "density {pdf} at cosine {cosine}");
            pairs.push((cosine.clamp(0.0, 1.0), turn(d.dot(tangent), d.dot(bitangent))));
        },
    );
    assert_eq!(count, PATHS * STREAMS, "a throughput of 1 always goes on");
    assert_fits("diffuse bounce", pairs.into_iter(), of_cosine);
}

/// Asserts that roulette is fair: all survivors carry the same multiple of `before`, and they are as many as make up for
/// those that are gone. How large the multiple is, is the renderer's own affair.
fn assert_fair(name: &str, survivors: &[DVec3], before: DVec3) {
    let multiple = survivors[0].max_element() / before.max_element();
    assert!(multiple > 1.5, "{name}: the test has no power, survivors carry {multiple} times as much");
    for survivor in survivors {
        assert!(survivor.distance(before * multiple) < 1e-6, "{name}: {survivor}, not {multiple} times {before}");
    }
    assert_share(name, survivors.len() as u32, 1.0 / multiple);
}

#[test]
fn roulette_keeps_the_expected_throughput_of_every_channel() {
    let mut survivors = Vec::new();
    scattered(
        |number, next| {
            let vertices = stream(number, DVec3::ZERO, DVec3::Z, [0.03, 0.05, 0.02]);
            diffuse::run(One, SamplerKind::Independent, 0, &vertices, next);
        },
        |next, at| survivors.push(vector(next, THROUGHPUT, at)),
    );
    assert_fair("diffuse bounce", &survivors, DVec3::new(0.03, 0.05, 0.02));
}

/// One pane in the plane z = 0.
fn pane(made_of: Material) -> Scene {
    let mut world = World::default();
    let of = material(&mut world, made_of);
    quad(&mut world, DVec3::ZERO, (DVec3::X, DVec3::Y), of, None);
    compile(&world, false)
}

#[test]
fn glass_reflects_fresnels_share_and_refracts_by_snells_law() {
    let ior = 1.5;
    let scene = pane(Material::clear(ior));
    for (angle, outside) in [(0.0f64, true), (45.0, true), (80.0, true), (20.0, false), (41.0, false), (60.0, false)] {
        let (s, c) = libm::sincos(angle.to_radians());
        let normal = if outside { DVec3::Z } else { -DVec3::Z };
        let incoming = DVec3::new(s, 0.0, 0.0) - c * normal;
        let (n1, n2) = if outside { (1.0, ior) } else { (ior, 1.0) };
        let through = refracted(incoming, normal, n1, n2);
        let mirrored = reflected(incoming, normal);
        let mut reflections = 0;
        scattered(
            |number, next| {
                let mut hits = stream(number, DVec3::new(0.3, 0.2, 0.0) - 0.5 * incoming, incoming, [1.0; 3]);
                (0..PATHS as usize).for_each(|at| hits.set_f(One, DISTANCE, at, 0.5));
                dielectric::run(One, &scene, (Fresnel::Exact, SamplerKind::Independent), 0, &hits, next);
            },
            |next, at| {
                let d = vector(next, DIRECTION, at);
                let eta = f64::from(f32::from_bits(next.value(ETA, at)));
                let reflects = d.dot(normal) > 0.0;
                reflections += u32::from(reflects);
                let (expected, factor) =
                    if reflects { (mirrored, 1.0) } else { (through.expect("not total"), (n1 / n2) * (n1 / n2)) };
                assert!(d.distance(expected) < 1e-6, "{angle}°: {d} instead of {expected}");
                assert!((eta - factor).abs() < 1e-6 && vector(next, THROUGHPUT, at) == DVec3::ONE);
                assert!(vector(next, ORIGIN, at).z * d.z > 0.0, "starts on the side to which it goes");
            },
        );
        let share = reflectance(c, n1, n2);
        if share == 1.0 {
            assert_eq!(reflections, PATHS * STREAMS, "{angle}° is total");
        } else {
            assert_share(&format!("{angle}°, outside: {outside}"), reflections, share);
        }
    }
}

#[test]
fn mirrors_mirror_on_both_sides_and_colour_what_they_send_on() {
    let scene = pane(Material::Mirror { reflectance: [0.9, 0.45, 0.0] });
    for normal in [DVec3::Z, -DVec3::Z] {
        let incoming = (DVec3::new(0.6, 0.2, 0.0) - 0.5 * normal).normalize();
        let run = |number: u32, next: &mut Stream, throughput: [f32; 3], ending: Ending| {
            let mut hits = stream(number, -0.5 * incoming, incoming, throughput);
            (0..PATHS as usize).for_each(|at| hits.set_f(One, DISTANCE, at, 0.5));
            mirror::run(One, &scene, ending, 0, &hits, next);
        };
        let expected = reflected(incoming, normal);
        let mut survivors = Vec::new();
        scattered(
            |number, next| run(number, next, [0.1; 3], Ending::Roulette(SamplerKind::Independent)),
            |next, at| {
                assert!(vector(next, DIRECTION, at).distance(expected) < 1e-6);
                survivors.push(vector(next, THROUGHPUT, at));
            },
        );
        assert_fair("mirror", &survivors, DVec3::new(0.09, 0.045, 0.0));
        let all = scattered(
            |number, next| run(number, next, [1.0; 3], Ending::Threshold(0.5)),
            |next, at| assert!(vector(next, THROUGHPUT, at).distance(DVec3::new(0.9, 0.45, 0.0)) < 1e-6),
        );
        assert_eq!(all, PATHS * STREAMS);
    }
}
