//! However primitives are divided between list and tree, a ray finds the same hit: the same bits of the distance and, of
//! several at that distance, the primitive of the lowest number. Checked against lists of a few primitives each.

use glam::Vec3;
use smalti_core::accel::cones::{Cones, Parts};
use smalti_core::accel::{Accel, List, MISS, Tracer};
use smalti_core::geometry::Ray;
use smalti_core::lanes::{Lanes, Native, One, V3};
use smalti_core::scene::Scene;

use crate::rays::{Rays, rays};
use crate::shapes;

/// Distance (bits) and primitive of the nearest hit, and whether something stops the ray before its end.
type Answer = (u32, u32, bool);

/// What `accel` answers to every ray.
#[inline(always)]
fn ask<L: Lanes>(l: L, accel: &Accel, rays: &Rays) -> Vec<Answer> {
    let mut tracer = Tracer::new(l, accel);
    let mut answers = Vec::with_capacity(rays.len());
    for at in (0..rays.len()).step_by(L::WIDTH) {
        let lanes = l.first((rays.len() - at).min(L::WIDTH));
        let [x, y, z, dx, dy, dz] = rays.columns.each_ref();
        let origin = V3::new(l.load(&x[at..]), l.load(&y[at..]), l.load(&z[at..]));
        let direction = V3::new(l.load(&dx[at..]), l.load(&dy[at..]), l.load(&dz[at..]));
        let ray = Ray::new(l, origin, direction, l.load_u(&rays.leaves[at..]));
        let (t, prim) = tracer.nearest(l, &ray, lanes);
        let stopped = l.bitmask(tracer.occluded(l, &ray, l.load_u(&rays.target[at..]), lanes));
        let (mut distances, mut prims) = ([0.0; 16], [0; 16]);
        l.store(t, &mut distances);
        l.store_u(prim, &mut prims);
        let found = distances.iter().zip(prims).take(L::WIDTH.min(rays.len() - at));
        answers.extend(found.enumerate().map(|(lane, (t, prim))| (t.to_bits(), prim, stopped >> lane & 1 == 1)));
    }
    answers
}

/// The answers at the best level of this machine.
fn ask_best(accel: &Accel, rays: &Rays) -> Vec<Answer> {
    fearless_simd::dispatch!(fearless_simd::Level::new(), simd => ask(Native(simd), accel, rays))
}

/// The answers of short lists, put together.
fn ask_all(scene: &Scene, rays: &Rays) -> Vec<Answer> {
    let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
    let mut answers = vec![(f32::INFINITY.to_bits(), MISS, false); rays.len()];
    for some in prims.chunks(20) {
        let list = List::new(scene, some.iter().copied()).expect("few enough for a list");
        let of_these = ask_best(&Accel { list, tree: None }, rays);
        for (answer, (t, prim, stopped)) in answers.iter_mut().zip(of_these) {
            if f32::from_bits(t) < f32::from_bits(answer.0) {
                (answer.0, answer.1) = (t, prim);
            }
            answer.2 |= stopped;
        }
    }
    answers
}

fn first_difference(name: &str, expected: &[Answer], found: &[Answer], rays: &Rays) {
    if let Some(at) = (0..expected.len()).find(|&at| expected[at] != found[at]) {
        let wrong = (0..expected.len()).filter(|&at| expected[at] != found[at]).count();
        let show =
            |(t, prim, stopped): Answer| format!("{:e} ({t:#x}) prim {prim} stopped {stopped}", f32::from_bits(t));
        panic!(
            "{name}: {wrong} rays differ; {}: expected {}, got {}",
            rays.show(at),
            show(expected[at]),
            show(found[at])
        );
    }
}

/// Asks every accelerator that `scene` can have, at every width, about `count` rays.
fn agree(name: &str, scene: &Scene, count: usize) {
    let rays = rays(scene, count);
    let expected = ask_all(scene, &rays);
    let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
    for (kind, accel) in [("planned", Accel::new(scene, &prims)), ("tree", Accel::tree_only(scene, &prims))] {
        first_difference(&format!("{name}, {kind}"), &expected, &ask_best(&accel, &rays), &rays);
        first_difference(&format!("{name}, {kind}, scalar"), &expected, &ask(One, &accel, &rays), &rays);
    }
    none_cleared_that_is_stopped(name, scene, &rays, &prims, &expected);
    let hits = expected.iter().filter(|answer| answer.1 != MISS).count();
    let stopped = expected.iter().filter(|answer| answer.2).count();
    assert!(hits > count / 4 && stopped > count / 20, "{name}: only {hits} of {count} rays hit, {stopped} are stopped");
    for (at, &(t, prim, stopped)) in expected.iter().enumerate() {
        let t = f32::from_bits(t);
        // At the very end of the ray the two questions may round differently.
        let same = stopped == (t < 1.0) || (t - 1.0).abs() < 1e-4;
        assert!(rays.target[at] != u32::MAX || same, "{name}: {} hits at {t}", rays.show(at));
        assert!(
            prim == MISS || beside(scene, prim, &rays, at, t) < 1e-4,
            "{name}: {} hits {prim} at {t}",
            rays.show(at)
        );
    }
}

/// Lanes of the packet at `at` that the cones do not clear.
fn doubtful<L: Lanes>(l: L, cones: &mut Cones<'_>, rays: &Rays, at: usize) -> u64 {
    let [x, y, z, dx, dy, dz] = rays.columns.each_ref();
    cones.look_from(l, V3::new(l.load(&x[at..]), l.load(&y[at..]), l.load(&z[at..])));
    let reach = V3::new(l.load(&dx[at..]), l.load(&dy[at..]), l.load(&dz[at..]));
    l.bitmask(cones.may_stop(l, reach))
}

/// No ray that something stops is outside all cones.
fn none_cleared_that_is_stopped(name: &str, scene: &Scene, rays: &Rays, prims: &[u32], expected: &[Answer]) {
    let parts = Parts::new(scene, prims);
    let mut cones = Cones::new(&parts);
    for (at, answer) in expected.iter().enumerate().filter(|(_, answer)| answer.2) {
        assert!(doubtful(One, &mut cones, rays, at) == 1, "{name}: {} is stopped by {}", rays.show(at), answer.1);
    }
}

/// How far the hit is from the primitive's box, by the larger of the box and the distance of the ray's origin.
fn beside(scene: &Scene, prim: u32, rays: &Rays, at: usize, t: f32) -> f32 {
    let value = |axis: usize| rays.columns[axis][at];
    let (low, high) = scene.bounds(prim);
    let outside = |axis: usize| {
        let x = value(axis) + t * value(axis + 3);
        (low[axis] - x).max(x - high[axis]) / value(axis).abs().max(1.0)
    };
    outside(0).max(outside(1)).max(outside(2))
}

#[test]
fn a_ray_in_the_plane_of_a_face_does_not_hit_it_from_beside() {
    let scene = shapes::of_file("scenes/hexroom.toml");
    let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
    let mut rays = Rays::default();
    for face in &scene.faces {
        let corners = scene.face_corners(face).iter().map(|&corner| Vec3::from_array(scene.vertices[corner as usize]));
        let corners: Vec<Vec3> = corners.collect();
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        // Along one side of the face, three times as far from it as the face is wide.
        rays.push(c + (c - b) * 3.0 - (b - a) * 5.0, b - a, u32::MAX, u32::MAX);
    }
    for (accel, kind) in [(Accel::new(&scene, &prims), "list"), (Accel::tree_only(&scene, &prims), "tree")] {
        for (at, (t, prim, _)) in ask(One, &accel, &rays).into_iter().enumerate() {
            let distance = beside(&scene, prim.min(prims.len() as u32 - 1), &rays, at, f32::from_bits(t));
            assert!(prim == MISS || distance < 1e-4, "{kind}: {} hits {prim}", rays.show(at));
        }
    }
}

#[test]
fn list_and_tree_in_the_rooms() {
    agree("hexroom", &shapes::of_file("scenes/hexroom.toml"), 200_000);
    agree("cornell", &shapes::of_file("scenes/cornell.toml"), 200_000);
}

#[test]
fn list_and_tree_in_a_mesh() {
    agree("blob", &shapes::of_file("tests/scenes/golden/mesh_in_a_tree.toml"), 100_000);
    agree("flat grid", &shapes::flat_grid(24), 50_000);
}

#[test]
fn list_and_tree_in_soups_of_triangles() {
    for seed in 0..4 {
        agree("shared corners", &shapes::shared_corners(seed), 40_000);
        agree("on a lattice", &shapes::on_a_lattice(seed), 40_000);
        agree("slivers", &shapes::slivers(seed), 40_000);
    }
}

#[test]
fn list_and_tree_in_soups_of_spheres() {
    for seed in 0..3 {
        agree("spheres", &shapes::spheres(seed), 40_000);
    }
}

#[test]
fn rays_that_are_no_rays_hit_nothing_or_the_same() {
    let scene = shapes::of_file("scenes/hexroom.toml");
    let mut rays = Rays::default();
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -0.0, 1.0, 1e-45, 1e38];
    for code in 0..odd.len() * odd.len() * odd.len() {
        let [a, b, c] = [code % 8, code / 8 % 8, code / 64].map(|digit| odd[digit]);
        rays.push(Vec3::new(0.1, 0.2, -0.3), Vec3::new(a, b, c), u32::MAX, u32::MAX);
        rays.push(Vec3::new(a, b, c), Vec3::new(0.5, -0.25, 0.125), u32::MAX, u32::MAX);
    }
    let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
    let (list, tree) = (Accel::new(&scene, &prims), Accel::tree_only(&scene, &prims));
    for (name, accel) in [("list", list), ("tree", tree)] {
        let narrow = ask(One, &accel, &rays);
        first_difference(name, &narrow, &ask_best(&accel, &rays), &rays);
        for (at, (t, prim, _)) in narrow.into_iter().enumerate() {
            let t = f32::from_bits(t);
            assert!(t > 0.0 && (t < f32::INFINITY) == (prim != MISS), "{name}: {} hits at {t}", rays.show(at));
        }
    }
}
