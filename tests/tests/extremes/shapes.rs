//! Slivers, duplicates, tangencies and gaps.

use core::f64::consts::TAU;

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Settings};
use smalti_doctor::Verdict;
use smalti_image::hash;
use smalti_tests::build::{at, camera, closed_box, grey, material, mesh, point_light, quad, sphere};
use smalti_tests::draw::{Way, draw};
use smalti_tests::estimate::{render, settings};

use crate::assert_sound;

/// A closed double cone of so many needles, a million times as long as wide where there are a hundred thousand of them.
fn needles(count: u32, length: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let ring = (0..count).map(|k| TAU * f64::from(k) / f64::from(count)).map(|a| at(libm::cos(a), libm::sin(a), 0.0));
    let mut vertices = vec![at(0.0, 0.0, length), at(0.0, 0.0, -length)];
    vertices.extend(ring);
    let corner = |k: u32| 2 + k % count;
    let faces = (0..count).flat_map(|k| [[0, corner(k), corner(k + 1)], [1, corner(k + 1), corner(k)]]).collect();
    (vertices, faces)
}

/// From inside a closed fan of slivers nothing of the sky is seen, and all that is seen glows.
#[test]
fn a_fan_of_slivers_is_closed() {
    for (count, length) in [(64, 1000.0), (20_000, 10.0), (2000, 1.0), (3, 1e5)] {
        let mut world = World { environment: Some([1000.0; 3]), ..World::default() };
        let black = material(&mut world, grey(0.0));
        let (vertices, mut faces) = needles(count, length);
        // They look inward.
        faces.iter_mut().for_each(|face| face.swap(1, 2));
        mesh(&mut world, (vertices, faces), black, Some(1.0));
        for goal in [at(0.0, 0.0, 1.0), at(0.3, 0.2, 0.1), at(1.0, 0.0, 0.0)] {
            world.cameras.clear();
            camera(&mut world, at(0.01, 0.02, 0.03), goal, 1.5);
            render(&world, &settings(64, 64, 16)).assert_every_pixel(&format!("{count} needles"), 1.0, 1e-6);
        }
    }
}

/// Of two faces in one place the first one is seen, however they are found.
#[test]
fn of_two_faces_in_one_place_the_first_is_seen() {
    let of = |order: [f64; 2], as_mesh: bool, turned: bool| {
        let mut world = World::default();
        let black = material(&mut world, grey(0.0));
        for radiance in order {
            let corners = [at(-1.0, -1.0, 0.1), at(1.0, -1.0, 0.1), at(1.0, 1.0, 0.1), at(-1.0, 1.0, 0.1)];
            match as_mesh {
                true => {
                    let faces = if turned { vec![[1, 2, 3], [1, 3, 0]] } else { vec![[0, 1, 2], [0, 2, 3]] };
                    mesh(&mut world, (corners.to_vec(), faces), black, Some(radiance));
                }
                false => quad(&mut world, at(0.0, 0.0, 0.1), (DVec3::X, DVec3::Y), black, Some(radiance)),
            }
        }
        // Enough for a tree.
        let (vertices, faces) = needles(60, 0.01);
        mesh(&mut world, (vertices.into_iter().map(|v| v * 0.1 - DVec3::Z).collect(), faces), black, None);
        camera(&mut world, at(0.2, 0.1, 3.0), at(0.1, 0.0, 0.0), 0.3);
        world
    };
    for (as_mesh, turned) in [(false, false), (true, false), (true, true)] {
        for order in [[1.0, 2.0], [2.0, 1.0]] {
            let world = of(order, as_mesh, turned);
            render(&world, &settings(48, 48, 4)).assert_every_pixel("the first", order[0], 0.0);
            let way = |threads: usize, tile: u32| {
                hash(&draw(&world, &settings(48, 48, 4), Way { threads, tile, ..Way::default() }))
            };
            assert_eq!(way(1, 48), way(3, 5));
        }
    }
}

/// Triangles that are points or lines are dropped and counted, also from a lamp, and nothing else changes.
#[test]
fn what_has_no_area_is_not_there() {
    let lamp = |flat: bool| {
        let mut world = World::default();
        let white = material(&mut world, grey(0.7));
        quad(&mut world, DVec3::ZERO, (DVec3::X * 2.0, DVec3::Y * 2.0), white, None);
        let corners = vec![at(0.0, 0.0, 1.0), at(0.5, 0.0, 1.0), at(0.0, 0.5, 1.0), at(0.25, 0.25, 1.0)];
        let more = [[0, 0, 0], [0, 1, 1], [1, 3, 2], [2, 3, 1]];
        let faces = [[0, 2, 1]].into_iter().chain(more.into_iter().filter(|_| flat)).collect();
        mesh(&mut world, (corners, faces), white, Some(5.0));
        camera(&mut world, at(0.0, -3.0, 2.0), DVec3::ZERO, 1.0);
        world
    };
    for integrator in Integrator::ALL {
        let settings = Settings { integrator, photons: Some(2000), ..settings(32, 32, 16) };
        let [without, with] = [false, true].map(|flat| hash(&draw(&lamp(flat), &settings, Way::default())));
        assert_eq!(without, with, "{}", integrator.name());
    }
    let warnings = assert_sound("no area", &lamp(true));
    assert!(warnings.iter().any(|finding| finding.case == "degenerate" && finding.figure == Some(4.0)), "{warnings:?}");
}

/// A ball that touches the floor, glass and grey: no ring of acne about the contact, no leak, no sample lost.
#[test]
fn a_ball_may_touch_a_plane() {
    for touching in [1.0, 1.0 - 1e-9, 1.0 + 1e-9, 1.0 - 1e-6, 1.0 + 1e-6] {
        for material_of_ball in [grey(0.6), Material::clear(1.5)] {
            let mut world = World { environment: Some([1.0; 3]), ..World::default() };
            let white = material(&mut world, grey(0.5));
            let of_ball = material(&mut world, material_of_ball);
            quad(&mut world, DVec3::ZERO, (DVec3::X * 3.0, DVec3::Y * 3.0), white, None);
            sphere(&mut world, at(0.3, 0.2, touching), 1.0, of_ball, None);
            camera(&mut world, at(0.3, -0.8, 0.3), at(0.3, 0.2, 0.0), 0.5);
            assert_sound(&format!("touching at {touching}"), &world);
        }
    }
}

/// What is inside a ball is found through a gap of 16 steps of 2⁻²⁴ of the frame; below, the two are one, and the doctor says
/// so.
#[test]
fn a_gap_is_seen_or_told() {
    for steps in [1, 8, 16, 32, 64, 1000, 16_384] {
        let mut world = World::default();
        let smoke = material(&mut world, Material::Dielectric { ior: 1.0, absorption: [1e-9; 3] });
        let black = material(&mut world, grey(0.0));
        let gap = f64::from(steps) / f64::from(1u32 << 24);
        sphere(&mut world, DVec3::ZERO, 1.0, smoke, None);
        sphere(&mut world, DVec3::ZERO, 1.0 - gap, black, Some(1.0));
        camera(&mut world, at(0.3, -4.0, 0.5), DVec3::ZERO, 0.3);
        if steps >= 16 {
            render(&world, &settings(32, 32, 16)).assert_every_pixel(&format!("{steps} steps"), 1.0, 1e-6);
        }
        let is_told = assert_sound("a gap", &world).iter().any(|finding| finding.case == "gaps");
        assert_eq!(is_told, steps < 16, "{steps} steps");
    }
}

/// A lamp that fills a wall, touches one, or is a millionth of the room; each with a light in the open.
#[test]
fn lamps_of_any_size_may_touch_walls() {
    for half in [1e-6, 1e-3, 0.3, 1.0] {
        for height in [1.0, 1.0 - 1e-7, 0.999] {
            let mut world = World::default();
            let white = material(&mut world, grey(0.5));
            closed_box(&mut world, DVec3::ZERO, DVec3::ONE, white, None);
            let radiance = 1.0 / (half * half);
            quad(&mut world, at(0.0, 0.0, height), (DVec3::Y * half, DVec3::X * half), white, Some(radiance));
            point_light(&mut world, at(0.5, 0.5, 0.5), 0.1);
            camera(&mut world, at(0.0, -0.9, 0.0), DVec3::ZERO, 1.3);
            let warnings = assert_sound(&format!("a lamp of {half} at {height}"), &world);
            let is_told = warnings.iter().any(|finding| finding.case == "small");
            assert_eq!(is_told, half < 1e-5, "{half}: {warnings:?}");
            assert!(warnings.iter().all(|finding| finding.verdict == Verdict::Warning));
        }
    }
}

/// A lamp in the plane of a ceiling that comes before it in the file: it is seen where it is, and gives the light that it
/// gives a hair below.
#[test]
fn a_lamp_in_a_wall_is_seen() {
    let room = |height: f64, as_mesh: bool| {
        let mut world = World::default();
        let white = material(&mut world, grey(0.5));
        let black = material(&mut world, grey(0.0));
        closed_box(&mut world, DVec3::ZERO, DVec3::ONE, white, None);
        let corners = [at(-0.5, -0.5, height), at(-0.5, 0.5, height), at(0.5, 0.5, height), at(0.5, -0.5, height)];
        match as_mesh {
            true => mesh(&mut world, (corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]), black, Some(2.0)),
            false => quad(&mut world, at(0.0, 0.0, height), (DVec3::Y * 0.5, DVec3::X * 0.5), black, Some(2.0)),
        }
        camera(&mut world, at(0.0, -0.9, -0.5), at(0.0, 0.3, 0.6), 1.3);
        world
    };
    for as_mesh in [false, true] {
        let of = |height: f64| render(&room(height, as_mesh), &settings(48, 48, 256));
        let (inside, below) = (of(1.0), of(0.999));
        inside.assert_mean("a lamp in the ceiling", below.mean[0], 0.01);
    }
}
