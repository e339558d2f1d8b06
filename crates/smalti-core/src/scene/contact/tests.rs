use glam::DVec3;

use super::*;
use crate::scene::newell;
use crate::scene::world::{Material, Mesh, Polygon, Sphere, World};

/// Corners of a square of this half width about a point, seen from above.
fn square(middle: DVec3, half: f64) -> Vec<DVec3> {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| middle + half * DVec3::new(x, y, 0.0)).to_vec()
}

/// Material 0 is opaque, 1 is glass.
fn world() -> World {
    World { materials: vec![Material::Lambert { albedo: [0.5; 3] }, Material::clear(1.5)], ..World::default() }
}

fn with(mut world: World, corners: Vec<DVec3>, material: usize) -> World {
    world.polygons.push(Polygon { vertices: corners, material, radiance: None });
    world
}

fn found(world: &World) -> Vec<Pair> {
    pairs(world, &Frame::of(world))
}

/// A table of half width 1 at height `z`, in a world of size 2 about the origin.
fn table(z: f64) -> World {
    with(world(), square(DVec3::Z * z, 1.0), 0)
}

#[test]
fn faces_in_one_plane_pair_where_they_overlap_only() {
    let over =
        |x: f64, half: f64, material: usize| found(&with(table(0.0), square(DVec3::X * x, half), material)).len();
    for material in [0, 1] {
        assert_eq!(over(0.0, 0.3, material), 1, "a small one on a large one");
        assert_eq!(over(0.0, 3.0, material), 1, "a large one on a small one");
        assert_eq!(over(0.9, 0.3, material), 1, "over the edge");
        assert_eq!(over(1.3, 0.3, material), 0, "side by side");
        assert_eq!(over(7.0, 0.3, material), 0, "apart");
    }
}

#[test]
fn a_gap_has_a_height_and_a_side() {
    let gap = |z: f64, turned: bool| {
        let mut corners = square(DVec3::Z * z, 0.5);
        if turned {
            corners.reverse();
        }
        found(&with(table(0.0), corners, 1))
    };
    for z in [3e-7, -3e-7] {
        for turned in [false, true] {
            let pairs = gap(z, turned);
            assert!(
                matches!(pairs[..], [pair] if (pair.gap - z).abs() < 1e-12 && pair.same_way != turned),
                "{pairs:?}"
            );
            let back = pairs[0].turned();
            assert_eq!(back.gap, if turned { z } else { -z }, "as seen from the other");
        }
    }
    assert_eq!(gap(1e-4, false), [], "far enough for every ray");
}

#[test]
fn an_opaque_gap_is_nobodys_business() {
    assert_eq!(found(&with(table(0.0), square(DVec3::Z * 3e-7, 0.5), 0)), []);
}

/// However a plane lies, and whatever rounding makes of its corners, two that are written as one are one.
#[test]
fn inclined_planes_coincide_too() {
    for k in 0..200 {
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, f64::from(k), 0.3 * f64::from(k), 1.7 * f64::from(k));
        let move_by = DVec3::new(0.3, -0.2, 0.7) * f64::from(k % 7);
        let place = |corners: Vec<DVec3>| corners.into_iter().map(|v| turn * v + move_by).collect::<Vec<_>>();
        let rounded = |corners: Vec<DVec3>| corners.into_iter().map(|v| v.as_vec3().as_dvec3()).collect::<Vec<_>>();
        let base = with(world(), place(square(DVec3::ZERO, 1.0)), 0);
        let mut turned = place(square(DVec3::new(0.1, 0.2, 0.0), 0.4));
        turned.reverse();
        let exact = found(&with(base.clone(), turned.clone(), 1));
        assert!(matches!(exact[..], [pair] if pair.coincides() && !pair.same_way), "{k}: {exact:?}");
        // What a file of f32 makes of it is rounded by half a step of its own coordinates.
        let of_file = found(&with(base, rounded(turned), 1));
        assert!(matches!(of_file[..], [pair] if !pair.same_way), "{k}: {of_file:?}");
    }
}

#[test]
fn the_triangles_of_one_opaque_mesh_are_let_be_and_those_of_glass_are_not() {
    let vertices = square(DVec3::ZERO, 1.0);
    let mesh = |material: usize| World {
        meshes: vec![Mesh {
            vertices: vertices.clone(),
            faces: vec![[0, 1, 2], [0, 2, 3], [2, 1, 0]],
            material,
            radiance: None,
        }],
        ..world()
    };
    assert_eq!(found(&mesh(0)), []);
    let pairs = found(&mesh(1));
    assert!(matches!(pairs[..], [pair] if pair.of == [Origin::Mesh(0, 0), Origin::Mesh(0, 2)]), "{pairs:?}");
}

#[test]
fn spheres_pair_where_one_is_around_the_other() {
    let balls = |radius: f64, x: f64| {
        let ball =
            |x: f64, radius: f64, material: usize| Sphere { centre: DVec3::X * x, radius, material, radiance: None };
        let mut world = world();
        world.spheres = vec![ball(0.0, 1.0, 1), ball(x, radius, 0), ball(2.9, 0.2, 0)];
        assert_eq!(Frame::of(&world).scale, 0.25);
        found(&world)
    };
    let scale = 0.25;
    assert!(matches!(balls(1.0, 0.0)[..], [pair] if pair.coincides()));
    assert!(
        matches!(balls(1.0 - 3e-6, 0.0)[..], [pair] if !pair.coincides() && (pair.gap + 3e-6 * scale).abs() < 1e-9)
    );
    assert!(matches!(balls(1.0 + 3e-6, 0.0)[..], [pair] if pair.gap > 0.0));
    assert_eq!(balls(0.5, 0.5), [], "they touch at a point");
    assert_eq!(balls(1.0, 2.0), []);
    assert_eq!(balls(0.9, 0.0), []);
}

/// A plate of glass that stands on another, both cut into many triangles in a way of their own: every two that lie over each
/// other are found, once, and neighbours are not.
#[test]
fn finely_cut_planes_pair_where_they_overlap() {
    let plane = |cuts: u32, turned: bool| {
        let at = |i: u32, j: u32| DVec3::new(f64::from(i), f64::from(j), 0.0) / f64::from(cuts);
        let cell = |k: u32| {
            let (i, j) = (k % cuts, k / cuts);
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        };
        let mut vertices: Vec<DVec3> = (0..cuts * cuts).flat_map(cell).flatten().collect();
        if turned {
            vertices.reverse();
        }
        let faces = (0..2 * cuts * cuts).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        Mesh { vertices, faces, material: 1, radiance: None }
    };
    let area = |corners: &[DVec3]| newell(corners).length() / 2.0;
    for (one, other) in [(1, 1), (1, 40), (40, 1), (24, 24), (24, 48)] {
        let world = World { meshes: vec![plane(one, false), plane(other, true)], ..world() };
        let mut pairs: Vec<[Origin; 2]> = found(&world).iter().map(|pair| pair.of).collect();
        let count = pairs.len();
        pairs.dedup();
        assert_eq!(pairs.len(), count, "each once");
        // The diagonals are the same, so that of two faces one lies on the other, and they cover the square once.
        let common = pairs.iter().map(|pair| {
            let [a, b] = pair.map(|face| area(&world.corners(face)));
            a.min(b)
        });
        assert!((common.sum::<f64>() - 1.0).abs() < 1e-9, "{one} on {other}: {count}");
    }
}
