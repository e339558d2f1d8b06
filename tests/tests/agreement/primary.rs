//! What single rays hit, against the oracle.

use glam::DVec3;
use smalti_core::accel::{Accel, MISS, Tracer};
use smalti_core::geometry::Ray;
use smalti_core::lanes::{Level, One, V3};
use smalti_core::light::table::NO_SURFACE;
use smalti_core::render::Renderer;
use smalti_core::scene::{Origin, Scene, World};
use smalti_core::settings::{Rect, Settings};
use smalti_tests::estimate::settings;
use smalti_tests::oracle::{self, Random, camera_ray};

use crate::{SIZE, scenes};

/// Nearest hit by the kernels: where it comes from and its distance in metres.
fn kernel(scene: &Scene, tracer: &mut Tracer<'_, One>, origin: [f32; 3], direction: [f32; 3]) -> Option<(Origin, f64)> {
    let ray = Ray::new(One, V3::splat(One, origin), V3::splat(One, direction), NO_SURFACE);
    let (distance, prim) = tracer.nearest(One, &ray, true);
    (prim != MISS).then(|| (scene.origins[prim as usize], f64::from(distance) / scene.frame.scale))
}

fn as_oracle_sees_it(world: &World, origin: DVec3, direction: DVec3) -> Option<(Origin, f64)> {
    let length = direction.length();
    let ray = oracle::Ray { origin, direction: direction / length };
    oracle::nearest(world, &ray).map(|hit| (hit.origin, hit.distance / length))
}

/// Rays from anywhere in the scene, exactly representable on both sides. Where they disagree about the primitive, some
/// ray a rounding error beside must give the other answer.
fn assert_same_hits(name: &str, world: &World, accel: impl Fn(&Scene) -> Accel) {
    let scene = smalti_core::scene::compile(world, false);
    let accel = accel(&scene);
    let mut tracer = Tracer::new(One, &accel);
    let mut random = Random::new(55);
    let mut disputed = 0;
    let rays = 30_000;
    for _ in 0..rays {
        let origin = random.cube().as_vec3().to_array();
        let direction = random.direction().as_vec3().to_array();
        let hit = kernel(&scene, &mut tracer, origin, direction);
        let from = DVec3::from_array(scene.frame.to_world(origin));
        let along = DVec3::from_array(direction.map(f64::from));
        let reference = as_oracle_sees_it(world, from, along);
        let same = match (hit, reference) {
            (None, None) => true,
            (Some((a, t)), Some((b, truth))) => a == b && (t - truth).abs() <= 2e-5 * (1.0 / scene.frame.scale),
            _ => false,
        };
        if !same {
            disputed += 1;
            let nudge = 3e-6 / scene.frame.scale;
            let beside = (0..200).any(|_| {
                let beside = as_oracle_sees_it(world, from + random.cube() * nudge, along);
                beside.map(|hit| hit.0) == hit.map(|hit| hit.0)
            });
            assert!(beside, "{name}: from {from} along {along}: {hit:?} instead of {reference:?}");
        }
    }
    assert!(disputed <= rays / 2000, "{name}: {disputed} of {rays} rays disputed");
}

#[test]
fn random_rays_hit_what_the_oracle_hits() {
    for (name, world) in [
        ("balls", scenes::room_with_balls()),
        ("mesh", scenes::mesh_in_the_open()),
        ("lamps", scenes::lamps_of_all_kinds()),
    ] {
        let all = |scene: &Scene| (0..scene.shades.len() as u32).collect::<Vec<_>>();
        assert_same_hits(name, &world, |scene| Accel::new(scene, &all(scene)));
        assert_same_hits(&format!("{name} in a tree"), &world, |scene| Accel::tree_only(scene, &all(scene)));
    }
}

#[test]
fn camera_rays_go_through_the_centres_of_their_pixels() {
    let world = scenes::room_with_balls();
    let (width, height) = (SIZE + 11, SIZE);
    let crop = Some(Rect { x: 1, y: 2, width: 3, height: 4 });
    let still = Settings { jitter: false, crop, ..settings(width, height, 1) };
    let renderer = Renderer::new(&world, still, Level::Scalar).unwrap();
    for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))).step_by(7) {
        let (vertices, _) = renderer.replay((x, y), 0);
        let ray = camera_ray(&world, (width, height), (f64::from(x) + 0.5, f64::from(y) + 0.5));
        let (origin, direction) = (DVec3::from_array(vertices[0].origin), DVec3::from_array(vertices[0].direction));
        assert!(origin.distance(ray.origin) < 1e-6, "pixel {x}, {y}: starts at {origin}");
        assert!(direction.distance(ray.direction) < 1e-6, "pixel {x}, {y}: goes along {direction}");
        let hit = oracle::nearest(&world, &ray).expect("the room is closed");
        if vertices[0].hit == Some(hit.origin) {
            assert!((vertices[0].distance.unwrap() - hit.distance).abs() < 1e-4, "pixel {x}, {y}");
        }
    }
}
