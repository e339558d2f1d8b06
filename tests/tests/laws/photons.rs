//! Photons on their way: none of the light is lost or made, as much leaves a light as its power says, wherever it is
//! aimed, and glass reflects, lets through and bends as it must.

use core::f64::consts::PI;

use glam::DVec3;
use smalti_core::lanes::One;
use smalti_core::photon::pass::Pass;
use smalti_core::photon::{Account, Aim, Kind, Tag};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::scene::world::{Material, PointLight};
use smalti_core::settings::{Fresnel, SamplerKind, Settings};
use smalti_core::stream::{
    Columns, DIRECTION, KEY, LEAVES, ORIGIN, SLOT, Stream, THROUGHPUT, dielectric, intersect, sort,
};
use smalti_core::{lanes::V3, light::table::NO_SURFACE};
use smalti_tests::build::{at, closed_box, grey, material, mirror, point_light, polygon, quad, sphere};
use smalti_tests::oracle::Random;
use smalti_tests::photons::{mapper, trace};

fn glass() -> Material {
    Material::clear(1.5)
}

/// A closed room of unlike albedos with a tinted mirror, glass and black balls.
fn closed() -> World {
    let mut world = World::default();
    let wall = material(&mut world, Material::Lambert { albedo: [0.7, 0.0, 0.5] });
    let tinted = material(&mut world, Material::Mirror { reflectance: [0.9, 0.2, 0.0] });
    let (clear, black) = (material(&mut world, glass()), material(&mut world, grey(0.0)));
    closed_box(&mut world, DVec3::ZERO, at(1.5, 1.5, 1.0), wall, None);
    quad(&mut world, at(0.0, 0.3, 0.98), (DVec3::Y * 0.3, DVec3::X * 0.4), wall, Some(4.0));
    world.polygons[6].radiance = Some([4.0, 0.0, 1.0]);
    sphere(&mut world, at(-0.7, 0.4, -0.6), 0.4, tinted, None);
    sphere(&mut world, at(0.6, 0.2, -0.5), 0.45, clear, None);
    sphere(&mut world, at(0.0, 0.9, -0.7), 0.3, black, None);
    world
}

/// A floor and a mirror in the open, under a spherical lamp.
fn open() -> World {
    let mut world = World::default();
    let ground = material(&mut world, Material::Lambert { albedo: [0.2, 0.9, 1.0] });
    let shiny = material(&mut world, mirror(0.8));
    let clear = material(&mut world, glass());
    quad(&mut world, DVec3::ZERO, (DVec3::X * 3.0, DVec3::Y * 3.0), ground, None);
    quad(&mut world, at(1.6, 0.8, 1.0), (at(0.3, -0.9, 0.0), DVec3::Z), shiny, None);
    sphere(&mut world, at(-0.8, 0.3, 0.6), 0.5, clear, None);
    sphere(&mut world, at(0.0, -0.5, 1.2), 0.3, ground, Some(2.0));
    world
}

/// A point and a triangle that shine on glass and black before a mirror.
fn small_lamps() -> World {
    let mut world = World::default();
    let (wall, black) = (material(&mut world, grey(0.6)), material(&mut world, grey(0.0)));
    let (shiny, clear) = (material(&mut world, mirror(1.0)), material(&mut world, glass()));
    quad(&mut world, DVec3::ZERO, (DVec3::X, DVec3::Y), wall, None);
    quad(&mut world, at(0.0, 1.0, 0.5), (DVec3::X, DVec3::Z * 0.5), shiny, None);
    polygon(&mut world, &[at(-0.6, 0.3, 1.5), at(-0.5, 0.6, 1.4), at(-0.5, 0.1, 1.9)], black, Some(3.0));
    sphere(&mut world, at(0.3, 0.1, 0.4), 0.3, clear, None);
    sphere(&mut world, at(-0.5, 0.1, 0.4), 0.2, black, None);
    world.point_lights.push(PointLight { position: at(0.2, -0.4, 1.3), intensity: [0.5, 1.0, 0.0] });
    world
}

fn assert_balanced(name: &str, account: &Account, kept: usize) {
    let Account { emitted, stored, absorbed, escaped, nonfinite, .. } = *account;
    for c in 0..3 {
        let ended = stored[c] + absorbed[c] + escaped[c];
        let off = (ended - emitted[c]).abs();
        assert!(off <= 1e-6 * emitted[c], "{name}: {ended} of {} in channel {c}", emitted[c]);
    }
    assert_eq!((nonfinite, account.kept), (0, kept as u64), "{name}");
}

/// P1.
/// The closed world with glass that absorbs.
fn tinted() -> World {
    let mut world = closed();
    for material in world.materials.iter_mut().filter(|material| matches!(material, Material::Dielectric { .. })) {
        *material = Material::Dielectric { ior: 1.5, absorption: [0.5, 1.0, 4.0] };
    }
    assert!(world.materials.iter().any(Material::absorbs));
    world
}

#[test]
fn light_is_stored_absorbed_or_lost_to_infinity() {
    let mut ends = [[0.0; 3]; 3];
    for (name, world) in [("closed", closed()), ("open", open()), ("small lamps", small_lamps()), ("tinted", tinted())]
    {
        for max_bounces in [None, Some(0), Some(1), Some(4)] {
            let renderer = mapper(&world, Settings { max_bounces, ..Settings::default() });
            let photons = renderer.plan().photons.as_ref().unwrap();
            let caustic = photons.caustic.as_ref().unwrap();
            let going_on = Pass { goes_on: true, ..caustic.clone() };
            let passes = [caustic, photons.global.as_ref().unwrap(), &going_on];
            for (pass, ends) in passes.into_iter().zip(&mut ends) {
                for count in [1, 2, 3, 100, 4097, 100_000] {
                    let traced = trace(&renderer, pass, count, count);
                    let name = format!("{name}, {:?}, {count} photons, {max_bounces:?}", pass.kind);
                    assert_balanced(&name, &traced.account, traced.photons.len());
                    let Account { stored, absorbed, escaped, .. } = traced.account;
                    let flux = traced.photons.flux.iter().map(|photon| f64::from(photon[0])).sum::<f64>();
                    let off = if pass.goes_on { stored[0] } else { (flux - stored[0]).abs() };
                    assert!(off <= 1e-6 * flux, "{name}: {stored:?} is said to be stored, and {flux} is");
                    [stored, absorbed, escaped].iter().zip(ends.iter_mut()).for_each(|(flux, sum)| *sum += flux[0]);
                }
            }
        }
    }
    let [[stored, absorbed, escaped], [_, taken, gone], [_, lost, out]] = ends;
    assert!(
        [stored, absorbed, escaped, taken, gone, lost, out].iter().all(|sum| *sum > 0.0),
        "some way to end never came: {ends:?}"
    );
}

/// A world with one lamp, channels unlike, and the power of the first channel.
fn lamps() -> Vec<(&'static str, World, f64)> {
    let one = |build: &dyn Fn(&mut World)| {
        let mut world = World::default();
        material(&mut world, grey(0.0));
        build(&mut world);
        world
    };
    let corners = [at(0.4, 0.0, 2.0), at(-0.3, 0.5, 2.2), at(-0.3, -0.5, 2.0)];
    let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length() / 2.0;
    let square = at(0.1, 0.0, 2.0);
    vec![
        ("square", one(&|w| quad(w, square, (DVec3::Y * 0.3, DVec3::X * 0.4), 0, Some(5.0))), 5.0 * PI * 0.48),
        ("triangle", one(&|w| polygon(w, &[corners[0], corners[2], corners[1]], 0, Some(5.0))), 5.0 * PI * area),
        ("sphere", one(&|w| sphere(w, at(0.0, 0.2, 2.0), 0.4, 0, Some(5.0))), 5.0 * PI * 4.0 * PI * 0.16),
        ("point", one(&|w| point_light(w, at(0.0, 0.1, 2.0), 5.0)), 5.0 * 4.0 * PI),
    ]
}

/// Diffuse balls, the first two of which have bounding spheres that overlap as seen from above.
fn add_balls(world: &mut World) {
    let white = material(world, grey(0.5));
    for (centre, radius) in [(at(0.0, 0.0, 0.0), 0.5), (at(0.7, 0.1, 0.4), 0.3), (at(-1.3, 0.3, 0.4), 0.4)] {
        sphere(world, centre, radius, white, None);
    }
}

/// Traces direct light alone: photons are stored where they first land.
fn direct(world: &World) -> Renderer {
    mapper(world, Settings { max_bounces: Some(1), ..Settings::default() })
}

#[test]
fn as_much_leaves_a_lamp_as_its_power_says() {
    for (name, mut world, power) in lamps() {
        add_balls(&mut world);
        let renderer = direct(&world);
        let pass = renderer.plan().photons.as_ref().unwrap().global.as_ref().unwrap();
        let scale = renderer.scene().frame.scale;
        for count in [1, 5000, 200_000] {
            let Account { emitted, photons, .. } = trace(&renderer, pass, count, 3).account;
            let off = emitted[0] / (power * scale * scale) - 1.0;
            assert!(off.abs() < 1e-5, "{name}, {count} photons: off by {off:e}");
            assert_eq!((photons, emitted[0]), (count.into(), emitted[2]), "{name}");
        }
    }
}

#[test]
fn as_much_leaves_all_lamps_together_as_their_powers_say() {
    let mut all = World::default();
    let mut power = 0.0;
    for (_, world, of_one) in lamps() {
        all.materials = world.materials;
        all.polygons.extend(world.polygons);
        all.spheres.extend(world.spheres);
        all.point_lights.extend(world.point_lights);
        power += of_one;
    }
    // The mean of the channels decides which lamp a photon leaves: of one colour its flux varies.
    all.spheres[0].radiance = Some([15.0, 0.0, 0.0]);
    power += 10.0 * PI * 4.0 * PI * 0.16;
    add_balls(&mut all);
    let renderer = direct(&all);
    let pass = renderer.plan().photons.as_ref().unwrap().global.as_ref().unwrap();
    let scale = renderer.scene().frame.scale;
    let emitted = trace(&renderer, pass, 100_000, 0).account.emitted;
    let off = emitted[0] / (power * scale * scale) - 1.0;
    assert!(off.abs() < 1e-3, "off by {off:e}");
}

/// Flux of the first channel that lands on each of the last three primitives, by several passes: means and the
/// variances of these means.
fn onto_balls(renderer: &Renderer, pass: &Pass, count: u32) -> [(f64, f64); 3] {
    let rounds = 8;
    let first = renderer.scene().shades.len() as u32 - 3;
    let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
    for round in 0..rounds {
        let photons = trace(renderer, pass, count, round).photons;
        let mut landed = [0.0; 3];
        for (place, flux) in photons.places.iter().zip(&photons.flux) {
            landed[(Tag(place[3].to_bits()).prim() - first) as usize] += f64::from(flux[0]);
        }
        for k in 0..3 {
            sums[k] += landed[k];
            squares[k] += landed[k] * landed[k];
        }
    }
    let n = f64::from(rounds);
    [0, 1, 2].map(|k: usize| {
        let mean = sums[k] / n;
        (mean, (squares[k] / n - mean * mean).max(0.0) / (n - 1.0))
    })
}

/// Targets that are larger than what is in them, overlap, hold a part of the lamp or lie behind it change nothing.
#[test]
fn aimed_photons_bring_what_photons_sent_everywhere_bring() {
    for (name, mut world, _) in lamps() {
        add_balls(&mut world);
        let renderer = direct(&world);
        let scene = renderer.scene();
        let everywhere = renderer.plan().photons.as_ref().unwrap().global.as_ref().unwrap();
        let expected = onto_balls(&renderer, everywhere, 1 << 19);
        let balls = &scene.spheres[scene.spheres.len() - 3..];
        let grown = |by: [f32; 3]| [0, 1, 2].map(|k: usize| balls[k]).map(|[x, y, z, r]| [x, y, z, r * by[0]]);
        let scale = scene.frame.scale as f32;
        let [x, y, z] = scene.frame.point(at(0.0, 0.0, 3.0)).as_vec3().to_array();
        let behind = [x, y, z, 0.3 * scale];
        let mut around_lamp = grown([1.0; 3]).to_vec();
        around_lamp[1][3] *= 6.0;
        for (how, targets) in [
            ("tight", grown([1.0; 3]).to_vec()),
            ("wide", grown([2.5; 3]).to_vec()),
            ("around the lamp", around_lamp),
            ("twice and behind", [&grown([1.0; 3])[..], &grown([1.3; 3])[..], &[behind]].concat()),
        ] {
            let aim = Aim::at(&scene.lights, &targets, &vec![true; scene.lights.rows.len()]);
            let found = onto_balls(&renderer, &Pass { kind: Kind::Global, aim, photons: 0, goes_on: true }, 1 << 18);
            for (k, (expected, found)) in expected.iter().zip(&found).enumerate() {
                let error = (expected.1 + found.1).sqrt();
                let off = found.0 / expected.0 - 1.0;
                let name = format!("{name}, {how}, ball {k}");
                assert!(error < 0.015 * expected.0, "{name}: known only to {:e}", error / expected.0);
                assert!(off.abs() < 0.075, "{name}: {found:?} instead of {expected:?}, off by {off:e}");
                assert!(off.abs() < 6.0 * error / expected.0, "{name}: {found:?} instead of {expected:?}");
            }
        }
    }
}

/// A glass ball of radius 1 about the origin of world and frame.
fn ball() -> Renderer {
    let mut world = World::default();
    let clear = material(&mut world, glass());
    sphere(&mut world, DVec3::ZERO, 1.0, clear, None);
    let renderer = Renderer::new(&world, Settings::default(), Level::Scalar).unwrap();
    assert_eq!(renderer.scene().spheres, [[0.0, 0.0, 0.0, 1.0]]);
    renderer
}

/// `count` rays downward, uniform over the disc of `radius` about the axis.
fn beam(count: u32, radius: f64, random: &mut Random) -> Stream {
    let mut rays = Stream::new(count as usize, Columns::default());
    let key = (random.unit() * 4e9) as u32;
    for slot in 0..count {
        let (r, turn) = (radius * random.unit().sqrt(), core::f64::consts::TAU * random.unit());
        let origin = [(r * libm::cos(turn)) as f32, (r * libm::sin(turn)) as f32, 1.5];
        let mut push = rays.push(One, true);
        push.v3(ORIGIN, V3::splat(One, origin)).v3(DIRECTION, V3::splat(One, [0.0, 0.0, -1.0]));
        push.v3(THROUGHPUT, V3::splat(One, [1.0; 3])).u(LEAVES, NO_SURFACE);
        push.u(KEY, key).u(SLOT, (slot.reverse_bits() & 0xffff_0000) | slot);
    }
    rays
}

/// Sends rays through the ball; `left` sees those that left after 0, 1, 2 ... events at its surface.
fn through(renderer: &Renderer, mut rays: Stream, mut left: impl FnMut(usize, &Stream)) {
    let empty = || Stream::new(rays.len(), Columns::default());
    let (mut next, mut escaped, mut hits) = (empty(), empty(), empty());
    let scattering = (Fresnel::Exact, SamplerKind::Independent);
    for event in 0..200 {
        intersect::run(One, &renderer.plan().everything, &mut rays);
        escaped.clear();
        hits.clear();
        let mut bins =
            sort::Bins { emitters: None, escaped: Some(&mut escaped), materials: [None, None, Some(&mut hits)] };
        sort::run(One, renderer.scene(), false, &rays, &mut bins);
        left(event, &escaped);
        next.clear();
        dielectric::run(One, renderer.scene(), scattering, event as u32, &hits, &mut next);
        core::mem::swap(&mut rays, &mut next);
    }
}

/// D4.
#[test]
fn a_glass_ball_splits_a_beam_as_fresnel_says() {
    let renderer = ball();
    let mut random = Random::new(41);
    let (mut counts, total) = ([0u32; 200], 16 * 65_536);
    for _ in 0..16 {
        let rays = beam(65_536, 1.0, &mut random);
        through(&renderer, rays, |event, escaped| counts[event] += escaped.len() as u32);
    }
    let part = |range: core::ops::Range<usize>| f64::from(counts[range].iter().sum::<u32>()) / f64::from(total);
    assert!(part(0..1) < 1e-5, "{} rays miss the ball", counts[0]);
    assert_eq!(counts.iter().sum::<u32>(), total, "rays are lost");
    for (name, found, expected) in [
        ("reflected", part(1..2), 0.091_777_959_3),
        ("entering", part(2..200), 0.908_222_040_7),
        ("leaving at once", part(2..3), 0.835_544_400_1),
        ("leaving after one reflection", part(3..4), 0.061_183_216_7),
        ("leaving after two", part(4..5), 0.007_993_377_1),
        ("leaving after three", part(5..6), 0.001_968_212_9),
    ] {
        // Five standard errors of a count, and never more than 2e-3.
        let tolerance = 5.0 * (expected * (1.0 - expected) / f64::from(total)).sqrt();
        let off = found - expected;
        assert!(off.abs() < tolerance.min(2e-3), "{name}: {found} instead of {expected}, off by {off:e}");
    }
}

/// D5.
#[test]
fn a_glass_ball_focuses_half_a_radius_behind_itself() {
    let renderer = ball();
    let rays = beam(20_000, 0.05, &mut Random::new(42));
    let mut crossings = Vec::new();
    through(&renderer, rays, |event, escaped| {
        if event != 2 {
            return;
        }
        for at in 0..escaped.len() {
            let [origin, direction] =
                [ORIGIN, DIRECTION].map(|column| DVec3::from_array(escaped.triple(column, at).map(f64::from)));
            let (from_axis, across) = (origin.truncate(), direction.truncate());
            // So near the axis that f32 has no digits left for the angle.
            if from_axis.length() < 2e-3 {
                continue;
            }
            let t = -from_axis.dot(across) / across.length_squared();
            let crossing = origin + t * direction;
            assert!(crossing.truncate().length() < 1e-5, "{crossing} is not on the axis");
            crossings.push(-1.0 - crossing.z);
        }
    });
    assert!(crossings.len() > 18_000, "only {} rays go through", crossings.len());
    for crossing in crossings {
        assert!((crossing / 0.5 - 1.0).abs() < 0.01, "a ray crosses the axis {crossing} behind the ball");
    }
}
