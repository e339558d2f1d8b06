//! Lights: chosen by place or by power, sampled with the density that a chance hit is weighed by, and each seen under its
//! solid angle.

use core::f64::consts::PI;

use glam::DVec3;
use smalti_core::lanes::{One, V3};
use smalti_core::light::place::{BY_POWER, MOST};
use smalti_core::light::sample::{pdf_of_hit, sample};
use smalti_core::scene::{Scene, World, compile};
use smalti_tests::build::{at, grey, material, point_light, polygon, quad, sphere};
use smalti_tests::oracle::Random;
use smalti_tests::statistics::{chi_square, sidak};

/// A quad, a pentagon, a triangle and two spheres, of unlike power.
fn lamps() -> World {
    let mut world = World::default();
    let black = material(&mut world, grey(0.0));
    quad(&mut world, at(0.0, 0.0, 1.0), (DVec3::Y * 0.3, DVec3::X * 0.2), black, Some(3.0));
    let ring = |k: u32| f64::from(k) * core::f64::consts::TAU / 5.0;
    let pentagon: Vec<_> = (0..5).map(ring).map(|a| at(0.9, libm::sin(a), libm::cos(a))).collect();
    polygon(&mut world, &pentagon, black, Some(1.0));
    polygon(&mut world, &[at(-0.9, -0.5, 0.0), at(-0.9, 0.5, 0.0), at(-0.8, 0.0, 0.7)], black, Some(5.0));
    sphere(&mut world, at(-0.4, 0.6, 0.5), 0.25, black, Some(2.0));
    sphere(&mut world, at(0.3, -0.8, 0.4), 0.01, black, Some(50.0));
    world
}

fn unit(random: &mut Random) -> f32 {
    (random.unit() * 16_777_216.0) as u32 as f32 / 16_777_216.0
}

/// A row drawn by place, or by power where there is none, and the chance of its lamp.
fn draw(scene: &Scene, from: Option<V3<One>>, random: &mut Random) -> (usize, f32) {
    let outlook = from.and_then(|place| scene.lights.seen_from(One, place));
    let (row, chance) = scene.lights.choose(One, outlook.as_ref(), unit(random));
    (row as usize, chance)
}

#[test]
fn many_lights_are_chosen_by_their_power() {
    let mut world = lamps();
    for _ in 0..MOST {
        point_light(&mut world, DVec3::ZERO, 0.5);
    }
    let scene = compile(&world, false);
    let scale = scene.frame.scale;
    let area = |corners: &[DVec3]| -> f64 {
        (1..corners.len() - 1)
            .map(|k| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]).length() / 2.0)
            .sum()
    };
    let polygons = &world.polygons;
    let mut powers = vec![3.0 * area(&polygons[0].vertices)];
    // A pentagon is three rows: a triangle each.
    let fan = |k: usize| [0, k, k + 1].map(|i| polygons[1].vertices[i]);
    powers.extend((1..4).map(|k| area(&fan(k))));
    powers.push(5.0 * area(&polygons[2].vertices));
    powers.extend(world.spheres.iter().map(|s| s.radiance.unwrap()[0] * 4.0 * PI * s.radius * s.radius));
    powers.iter_mut().for_each(|power| *power *= PI * scale * scale);
    powers.extend([0.5 * 4.0 * PI * scale * scale; MOST]);
    assert_eq!(powers.len(), scene.lights.rows.len());

    let mut counts = vec![0; powers.len()];
    let mut random = Random::new(11);
    let draws = 1_000_000;
    for _ in 0..draws {
        counts[draw(&scene, None, &mut random).0] += 1;
    }
    let total: f64 = powers.iter().sum();
    let expected: Vec<_> = powers.iter().map(|power| power / total * f64::from(draws)).collect();
    let p = chi_square(&counts, &expected);
    assert!(p > sidak(0.01, crate::CHI_SQUARES), "{counts:?} instead of {expected:.0?}: p = {p:e}");
}

/// Small lamps of unlike power and distance, one of which shows its back to the middle.
fn small_lamps() -> World {
    let mut world = World::default();
    let black = material(&mut world, grey(0.0));
    let side = 1e-3;
    let patch = |world: &mut World, height: f64, power: f64| {
        let edges = (DVec3::Y * side / 2.0, DVec3::X * side / 2.0);
        quad(world, at(0.0, 0.0, height), edges, black, Some(power / side / side));
    };
    patch(&mut world, 1.0, 1.0);
    patch(&mut world, 0.1, 0.01);
    patch(&mut world, -1.0, 5.0);
    sphere(&mut world, at(0.0, 0.5, 0.0), side, black, Some(0.5 / side / side));
    point_light(&mut world, at(0.2, 0.0, 0.0), 0.03);
    world
}

#[test]
fn few_lights_are_chosen_by_what_they_bring_to_the_place() {
    let scene = compile(&small_lamps(), false);
    let place = V3::splat(One, scene.frame.point(DVec3::ZERO).as_vec3().to_array());
    // L · A / d² of the patches, L · π r² / d² of the ball, I / d² of the point; the back brings nothing.
    let brought = [1.0, 0.01 / 0.01, 0.0, 0.5 * PI / 0.25, 0.03 / 0.04];
    let powers = [PI, 0.01 * PI, 5.0 * PI, 0.5 * 4.0 * PI * PI, 0.03 * 4.0 * PI];
    let [all_brought, all_power] = [brought, powers].map(|values| values.iter().sum::<f64>());
    let by_power = f64::from(BY_POWER);
    let chance = |k: usize| by_power * powers[k] / all_power + (1.0 - by_power) * brought[k] / all_brought;

    let mut counts = vec![0; 5];
    let mut random = Random::new(13);
    let draws = 200_000;
    for _ in 0..draws {
        let (row, told) = draw(&scene, Some(place), &mut random);
        counts[row] += 1;
        assert!((f64::from(told) / chance(row) - 1.0).abs() < 0.01, "row {row}: {told} instead of {}", chance(row));
    }
    // The lamps are not points: their chances are those of points to within 0.6 %, far below what this many draws tell.
    let expected: Vec<_> = (0..5).map(|k| chance(k) * f64::from(draws)).collect();
    let p = chi_square(&counts, &expected);
    assert!(p > sidak(0.01, crate::CHI_SQUARES), "{counts:?} instead of {expected:.0?}: p = {p:e}");
}

#[test]
fn every_number_falls_on_a_light_that_has_power() {
    let mut world = lamps();
    let black = 0;
    // Lights without power at the ends and in the middle of the table.
    world.polygons.insert(0, world.polygons[2].clone());
    world.polygons[0].radiance = Some([0.0; 3]);
    sphere(&mut world, at(0.0, 0.0, -1.0), 0.1, black, Some(0.0));
    let lights = compile(&world, false).lights;
    let outlook = lights.seen_from(One, V3::splat(One, [0.0; 3]));
    for outlook in [None, outlook] {
        for u in [0.0, f32::MIN_POSITIVE, 0.5, 1.0 - f32::EPSILON / 2.0] {
            let (row, chance) = lights.choose(One, outlook.as_ref(), u);
            assert!(lights.power(row as usize) > 0.0 && chance > 0.0, "{u} falls on row {row}");
        }
    }
}

/// Samples as the direct stage draws them: pdf, the pdf that the emission stage computes for the same hit, and whether
/// the light shows its front.
fn samples(scene: &Scene, from: DVec3, count: u32) -> impl Iterator<Item = (f64, f64, bool)> {
    let mut random = Random::new(12);
    let place = scene.frame.point(from).as_vec3().to_array();
    let emitting: Vec<usize> = (0..scene.classes.len()).filter(|prim| scene.classes[*prim] >> 4 != 0).collect();
    (0..count).map(move |_| {
        let x = V3::splat(One, place);
        let outlook = scene.lights.seen_from(One, x);
        let (row, chance) = scene.lights.choose(One, outlook.as_ref(), unit(&mut random));
        let numbers = (unit(&mut random), unit(&mut random));
        let incident = sample(One, &scene.lights, row, (x, V3::splat(One, [0.0, 0.0, 1.0])), numbers);
        let surface = scene.lights.surfaces[row as usize];
        let prim = emitting.iter().find(|prim| scene.shades[**prim][7].to_bits() == surface).unwrap();
        let shade = scene.shades[*prim];
        let number = (scene.classes[*prim] >> 4) - 1;
        let emitter = scene.lights.emitters[number as usize];
        let distance = incident.reach.dot(One, incident.reach).sqrt();
        let is_sphere = surface >= scene.planes;
        let hit = (x, incident.reach.normalised(One), distance);
        let by_hit = pdf_of_hit(One, &emitter, &[shade[0], shade[1], shade[2], shade[3]], is_sphere, hit);
        let by_hit = by_hit * scene.lights.chance_of(One, outlook.as_ref(), number);
        (f64::from(incident.pdf(One) * chance), f64::from(by_hit), incident.radiance.x > 0.0)
    })
}

#[test]
fn sampling_and_weighing_agree_about_the_density() {
    let scene = compile(&lamps(), false);
    for from in [at(0.0, 0.0, 0.0), at(0.5, 0.1, -0.9), at(-0.4, 0.3, 0.4)] {
        for (sampled, weighed, front) in samples(&scene, from, 20_000) {
            let off = if front { sampled / weighed - 1.0 } else { 0.0 };
            assert!(off.abs() < 2e-4, "from {from}: sampled with {sampled}, weighed with {weighed}");
        }
    }
}

/// Solid angle of a triangle (van Oosterom and Strackee 1983), negative from behind.
fn solid_angle([a, b, c]: [DVec3; 3], from: DVec3) -> f64 {
    let [a, b, c] = [a, b, c].map(|v| (v - from).normalize());
    -2.0 * libm::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

#[test]
fn the_density_integrates_to_the_solid_angle_of_the_lights() {
    let world = lamps();
    let scene = compile(&world, false);
    for from in [at(0.0, 0.0, 0.0), at(0.5, 0.1, -0.9), at(-0.2, 0.1, 0.3)] {
        let mut expected = 0.0;
        for polygon in &world.polygons {
            let v = &polygon.vertices;
            expected += (1..v.len() - 1).map(|k| solid_angle([v[0], v[k], v[k + 1]], from).max(0.0)).sum::<f64>();
        }
        for ball in &world.spheres {
            let sine = ball.radius / ball.centre.distance(from);
            expected += 2.0 * PI * (1.0 - (1.0 - sine * sine).sqrt());
        }
        let count = 400_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for (pdf, _, front) in samples(&scene, from, count) {
            let inverse = if front { 1.0 / pdf } else { 0.0 };
            sum += inverse;
            squares += inverse * inverse;
        }
        let n = f64::from(count);
        let mean = sum / n;
        let error = ((squares / n - mean * mean) / n).sqrt();
        assert!(error < 0.01 * expected, "from {from}: the test has no power, standard error {error}");
        assert!((mean - expected).abs() < 5.0 * error, "from {from}: {mean} ± {error} instead of {expected}");
    }
}
