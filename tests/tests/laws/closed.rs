//! Closed surfaces are closed: no ray from inside slips out at an edge or a corner, in the list or in the tree.

use glam::DVec3;
use smalti_core::accel::{Accel, List, Tracer};
use smalti_core::geometry::Ray;
use smalti_core::lanes::{One, V3};
use smalti_core::light::table::NO_SURFACE;
use smalti_tests::build::at;
use smalti_tests::closed::{SQUEEZES, aims, leaks, shell};
use smalti_tests::oracle::Random;

#[test]
fn no_ray_leaves_a_closed_mesh_in_the_tree() {
    let mut random = Random::new(31);
    for squeeze in SQUEEZES {
        for away in [DVec3::ZERO, at(3.0, -40.0, 1000.0)] {
            let scene = shell((48, 24), squeeze, away, &mut random);
            let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
            let accel = Accel::tree_only(&scene, &prims);
            let missed = leaks(&scene, &accel, away, 80_000, &mut random);
            assert_eq!(missed, 0, "squeezed by {squeeze}, at {away}");
        }
    }
}

#[test]
fn no_ray_leaves_a_closed_mesh_in_the_list() {
    let mut random = Random::new(32);
    for squeeze in SQUEEZES {
        for _ in 0..8 {
            let scene = shell((8, 5), squeeze, DVec3::ZERO, &mut random);
            let list = List::new(&scene, 0..scene.shades.len() as u32).expect("64 triangles fit a list");
            let accel = Accel { list, tree: None };
            assert_eq!(leaks(&scene, &accel, DVec3::ZERO, 12_000, &mut random), 0, "squeezed by {squeeze}");
        }
    }
}

#[test]
fn list_and_tree_hit_the_same_primitive_at_the_same_distance() {
    let mut random = Random::new(33);
    let scene = shell((8, 5), DVec3::new(1.0, 0.4, 2.0), DVec3::ZERO, &mut random);
    let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
    let list = Accel { list: List::new(&scene, prims.iter().copied()).unwrap(), tree: None };
    let tree = Accel::tree_only(&scene, &prims);
    let (mut of_list, mut of_tree) = (Tracer::new(One, &list), Tracer::new(One, &tree));
    for _ in 0..200_000 {
        // From inside and from outside, at corners and edges, and past everything.
        let from = (random.cube() * 1.5).as_vec3();
        let direction = if random.unit() < 0.5 {
            aims(&scene, from.as_dvec3(), &mut random)
        } else {
            random.direction().as_vec3().to_array()
        };
        let ray = Ray::new(One, V3::splat(One, from.to_array()), V3::splat(One, direction), NO_SURFACE);
        let (a, b) = (of_list.nearest(One, &ray, true), of_tree.nearest(One, &ray, true));
        assert_eq!((a.0.to_bits(), a.1), (b.0.to_bits(), b.1), "from {from} along {direction:?}");
    }
}
