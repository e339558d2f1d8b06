//! Glass that is open or inside out, and lamps that shine inwards: rendered as written, and noted.

use core::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use smalti_core::scene::soundness::{Finding, examine};
use smalti_core::scene::world::{Material, Polygon};
use smalti_core::scene::{Frame, World, contact};
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, grey, material, mesh};
use smalti_tests::estimate::{render, settings};

/// A closed surface, with the normals out.
type Faces = Vec<Vec<DVec3>>;

/// A ball of quads and triangles.
fn ball(cuts: usize) -> Faces {
    let corner = |i: usize, j: usize| {
        let (polar, around) = (PI * i as f64 / cuts as f64, TAU * (j % (2 * cuts)) as f64 / (2 * cuts) as f64);
        at(libm::sin(polar) * libm::cos(around), libm::sin(polar) * libm::sin(around), libm::cos(polar))
    };
    let face = |k: usize| {
        let (i, j) = (k / (2 * cuts), k % (2 * cuts));
        match i {
            0 => vec![DVec3::Z, corner(1, j), corner(1, j + 1)],
            i if i == cuts - 1 => vec![corner(i, j), -DVec3::Z, corner(i, j + 1)],
            i => vec![corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)],
        }
    };
    (0..2 * cuts * cuts).map(face).collect()
}

/// A column of so many sides; its ends are polygons.
fn column(sides: usize) -> Faces {
    let ring = |z: f64| {
        let angle = move |k: usize| TAU * (k % sides) as f64 / sides as f64;
        (0..sides).map(|k| at(libm::cos(angle(k)), libm::sin(angle(k)), z)).collect::<Vec<_>>()
    };
    let (low, high) = (ring(-1.0), ring(1.0));
    let side = |k: usize| vec![low[k], low[(k + 1) % sides], high[(k + 1) % sides], high[k]];
    let mut faces: Faces = (0..sides).map(side).collect();
    faces.push(high.clone());
    faces.push(low.iter().rev().copied().collect());
    faces
}

/// Every corner of every face as a file may have it that rounds them: off by up to a step of f32, each for itself.
fn rounded(faces: &Faces) -> Faces {
    let mut state = 1u64;
    let mut off = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) as f64 / f64::from(1u32 << 24) - 0.5) * f64::from(f32::EPSILON)
    };
    faces.iter().map(|face| face.iter().map(|corner| *corner + at(off(), off(), off())).collect()).collect()
}

fn turned_round(faces: &Faces) -> Faces {
    faces.iter().map(|face| face.iter().rev().copied().collect()).collect()
}

/// The faces as polygons, as one mesh whose triangles share corners, or as one whose faces have corners of their own.
fn put(world: &mut World, faces: &Faces, way: u32, (material, radiance): (usize, Option<f64>)) {
    if way == 0 {
        let polygon = |vertices: &Vec<DVec3>| Polygon {
            vertices: vertices.clone(),
            material,
            radiance: radiance.map(|x| [x; 3]),
        };
        world.polygons.extend(faces.iter().map(polygon));
        return;
    }
    let (mut vertices, mut triangles): (Vec<DVec3>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    for face in faces {
        let mut number = |corner: &DVec3| {
            let known = vertices.iter().position(|vertex| vertex == corner).filter(|_| way == 1);
            known.unwrap_or_else(|| {
                vertices.push(*corner);
                vertices.len() - 1
            }) as u32
        };
        let numbers: Vec<u32> = face.iter().map(&mut number).collect();
        triangles.extend((1..numbers.len() - 1).map(|k| [numbers[0], numbers[k], numbers[k + 1]]));
    }
    mesh(world, (vertices, triangles), material, radiance);
}

/// Something under a sky of 1, of this surface.
fn of(faces: &Faces, way: u32, is_lamp: bool) -> World {
    let mut world = World { environment: Some([1.0; 3]), ..World::default() };
    let (clear, white) = (material(&mut world, Material::clear(1.5)), material(&mut world, grey(0.5)));
    put(&mut world, faces, way, if is_lamp { (white, Some(1.0)) } else { (clear, None) });
    camera(&mut world, at(0.1, -4.0, 0.2), at(0.1, 0.0, 0.2), 0.1);
    world
}

/// What is found, wherever the world lies and in whatever unit.
fn found(world: &World) -> Vec<Finding> {
    let mut all: Vec<Vec<Finding>> = Vec::new();
    for (k, scale) in [1.0, 1e-3, 1e3, 1.0, 1e6].into_iter().enumerate() {
        let k = k as f64;
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, k, 0.6 * k, 1.9 * k);
        let world = world.placed(scale, |point| scale * (turn * point + 20.0 * k * at(3.0, -1.0, 0.7)));
        let frame = Frame::of(&world);
        all.push(examine(&world, &frame, &contact::pairs(&world, &frame)));
    }
    assert!(all.iter().all(|found| *found == all[0]), "{all:?}");
    all.swap_remove(0)
}

#[test]
fn closed_things_are_sound_and_what_lacks_a_face_is_open() {
    for faces in [ball(4), ball(9), column(3), column(11)] {
        for way in 0..3 {
            assert_eq!(found(&of(&faces, way, false)), [], "way {way}");
            assert_eq!(found(&of(&rounded(&faces), way, false)), [], "rounded, way {way}");
            for missing in [0, faces.len() / 2, faces.len() - 1] {
                let mut open = faces.clone();
                let edges = open.remove(missing).len();
                let found = found(&of(&open, way, false));
                assert!(matches!(found[..], [Finding::Open { edges: of, .. }] if of == edges), "way {way}: {found:?}");
                let mut twisted = faces.clone();
                twisted[missing].reverse();
                let found = self::found(&of(&twisted, way, false));
                assert!(matches!(found[..], [Finding::Open { .. }]), "way {way}: {found:?}");
            }
        }
    }
}

#[test]
fn what_is_inside_out_is_noted_and_a_hollow_thing_is_not() {
    for faces in [ball(6), column(5)] {
        for way in 0..3 {
            let found_of = |is_lamp: bool| found(&of(&turned_round(&faces), way, is_lamp));
            assert!(matches!(found_of(false)[..], [Finding::InsideOut { .. }]), "way {way}");
            assert!(matches!(found_of(true)[..], [Finding::ShinesInwards { .. }]), "way {way}");
            assert_eq!(found(&of(&faces, way, true)), [], "way {way}");
            let mut hollow = of(&faces, way, false);
            let inner = faces.iter().map(|face| face.iter().map(|corner| 0.5 * *corner).collect()).collect();
            put(&mut hollow, &turned_round(&inner), way, (0, None));
            assert_eq!(found(&hollow), [], "way {way}");
        }
    }
}

/// The picture is that of the scene as it is written: a window of one quad is entered and never left.
#[test]
fn a_window_of_one_face_is_rendered_as_written() {
    let quad = vec![[(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)].map(|(x, z)| at(x, 0.0, z)).to_vec()];
    for (faces, truth) in [(quad.clone(), 0.04 + 0.96 / 2.25), (turned_round(&quad), 0.04 + 0.96 * 2.25)] {
        for way in 0..3 {
            let world = of(&faces, way, false);
            let found = found(&world);
            assert!(matches!(found[..], [Finding::Open { edges: 4, .. }]), "{found:?}");
            let whitted = Settings { integrator: Integrator::Whitted, ..settings(4, 4, 16) };
            render(&world, &whitted).assert_every_pixel(&format!("way {way}"), truth, 1e-3);
        }
    }
}
