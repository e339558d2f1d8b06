use glam::{DQuat, DVec3};

use super::*;
use crate::scene::contact::pairs;
use crate::scene::world::{Camera, Material, Mesh, Polygon, Sphere};

const GLASS: usize = 0;
const WHITE: usize = 1;

fn world() -> World {
    let camera = Camera { name: String::new(), eye: DVec3::X * 9.0, look_at: DVec3::ZERO, up: DVec3::Z, fov: 1.0 };
    World {
        materials: vec![Material::clear(1.5), Material::Lambert { albedo: [0.5; 3] }],
        cameras: vec![camera],
        ..World::default()
    }
}

/// The six faces of a box about `middle`, with the normals out.
fn box_of(middle: DVec3, half: DVec3) -> Vec<Vec<DVec3>> {
    let corner = |k: usize| {
        let side = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        middle + half * DVec3::new(side(2), side(1), side(0))
    };
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    faces.map(|face| face.map(corner).to_vec()).to_vec()
}

fn reversed(faces: Vec<Vec<DVec3>>) -> Vec<Vec<DVec3>> {
    faces.into_iter().map(|face| face.into_iter().rev().collect()).collect()
}

fn as_polygons(world: &mut World, faces: Vec<Vec<DVec3>>, material: usize, radiance: Option<f64>) {
    let polygon = |vertices| Polygon { vertices, material, radiance: radiance.map(|x| [x; 3]) };
    world.polygons.extend(faces.into_iter().map(polygon));
}

/// Corners of its own for every face, as files with normals have them.
fn as_mesh(world: &mut World, faces: Vec<Vec<DVec3>>, material: usize, radiance: Option<f64>) {
    let mut mesh = Mesh { material, radiance: radiance.map(|x| [x; 3]), ..Mesh::default() };
    for face in faces {
        let first = mesh.vertices.len() as u32;
        mesh.faces.extend((1..face.len() as u32 - 1).map(|k| [first, first + k, first + k + 1]));
        mesh.vertices.extend(face);
    }
    world.meshes.push(mesh);
}

fn found(world: &World) -> Vec<Finding> {
    let frame = Frame::of(world);
    examine(world, &frame, &pairs(world, &frame))
}

fn turn(faces: Vec<Vec<DVec3>>, k: u32) -> Vec<Vec<DVec3>> {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, f64::from(k), 0.4 * f64::from(k), 2.1 * f64::from(k));
    faces.into_iter().map(|face| face.into_iter().map(|v| turn * v).collect()).collect()
}

type Put = fn(&mut World, Vec<Vec<DVec3>>, usize, Option<f64>);
const PUTS: [Put; 2] = [as_polygons, as_mesh];

#[test]
fn a_closed_box_is_sound_whatever_it_is_made_of() {
    for put in PUTS {
        for k in 0..5 {
            let mut world = world();
            put(&mut world, turn(box_of(DVec3::splat(0.3), DVec3::new(1.0, 0.5, 0.1)), k), GLASS, None);
            assert_eq!(found(&world), [], "turned {k}");
        }
    }
    // Half of it polygons, half of it a mesh.
    let mut world = world();
    let mut faces = box_of(DVec3::ZERO, DVec3::ONE);
    let rest = faces.split_off(3);
    as_polygons(&mut world, faces, GLASS, None);
    as_mesh(&mut world, rest, GLASS, None);
    assert_eq!(found(&world), []);
}

/// One side of a box in two parts, the sides beside it whole: corners lie on edges, and yet it is closed.
#[test]
fn two_faces_may_end_at_one() {
    let mut world = world();
    let mut faces = box_of(DVec3::ZERO, DVec3::ONE);
    let [a, b, c, d] = faces.pop().unwrap().try_into().unwrap();
    let (low, high) = ((a + b) / 2.0, (c + d) / 2.0);
    faces.extend([vec![a, low, high, d], vec![low, b, c, high]]);
    as_polygons(&mut world, faces, GLASS, None);
    assert_eq!(found(&world), []);
}

#[test]
fn what_is_open_is_found_however_much_of_it() {
    for put in PUTS {
        for missing in 1..6 {
            let mut world = world();
            let mut faces = turn(box_of(DVec3::ZERO, DVec3::ONE), missing);
            faces.truncate(6 - missing as usize);
            put(&mut world, faces, GLASS, None);
            let found = found(&world);
            assert!(matches!(found[..], [Finding::Open { material: GLASS, edges, .. }] if edges >= 4), "{found:?}");
        }
        // Of what is opaque nobody minds.
        let mut world = world();
        put(&mut world, box_of(DVec3::ZERO, DVec3::ONE).split_off(2), WHITE, None);
        assert_eq!(found(&world), []);
    }
}

#[test]
fn a_face_wound_against_its_neighbours_is_a_hole() {
    let mut world = world();
    let mut faces = box_of(DVec3::ZERO, DVec3::ONE);
    faces[2].reverse();
    as_polygons(&mut world, faces, GLASS, None);
    assert!(matches!(found(&world)[..], [Finding::Open { edges: 4, .. }]));
}

#[test]
fn what_is_inside_out_is_found_and_inner_walls_are_not() {
    for put in PUTS {
        let mut alone = world();
        put(&mut alone, reversed(box_of(DVec3::ZERO, DVec3::ONE)), GLASS, None);
        assert!(matches!(found(&alone)[..], [Finding::InsideOut { material: GLASS, .. }]));
        let mut in_a_room = alone.clone();
        put(&mut in_a_room, reversed(box_of(DVec3::ZERO, DVec3::splat(12.0))), WHITE, None);
        assert!(matches!(found(&in_a_room)[..], [Finding::InsideOut { .. }]), "nor is it in a closed room");
        let mut hollow = alone.clone();
        put(&mut hollow, box_of(DVec3::ZERO, DVec3::splat(1.2)), GLASS, None);
        assert_eq!(found(&hollow), [], "the inner wall of a hollow box");
        let mut in_a_ball = alone.clone();
        in_a_ball.spheres.push(Sphere { centre: DVec3::ZERO, radius: 2.0, material: GLASS, radiance: None });
        assert_eq!(found(&in_a_ball), [], "a hole in a ball");
    }
}

/// Water in a pool of five walls ends at them; a window in a wall with nothing but the sky behind it does as well.
#[test]
fn water_may_end_at_walls_and_a_window_may_not() {
    for level in [1.0, 0.5, -0.7] {
        let mut pool = world();
        let mut walls = reversed(box_of(DVec3::ZERO, DVec3::ONE));
        walls.pop();
        as_polygons(&mut pool, walls, WHITE, None);
        let water = |half: f64| {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| DVec3::new(half * x, half * y, level))
                .to_vec()
        };
        let mut full = pool.clone();
        as_polygons(&mut full, vec![water(1.0)], GLASS, None);
        assert_eq!(found(&full), [], "water at {level}");
        let mut turned = pool.clone();
        as_polygons(&mut turned, reversed(vec![water(1.0)]), GLASS, None);
        assert!(matches!(found(&turned)[..], [Finding::Open { .. }]), "water whose inside is the sky");
        let mut short = pool.clone();
        as_polygons(&mut short, vec![water(0.8)], GLASS, None);
        assert!(matches!(found(&short)[..], [Finding::Open { edges: 4, .. }]), "water that does not reach the walls");
    }
}

#[test]
fn a_lamp_may_shine_inwards_on_something() {
    for put in PUTS {
        let lamp = |turned: bool| {
            let mut world = world();
            let faces = box_of(DVec3::ZERO, DVec3::ONE);
            put(&mut world, if turned { reversed(faces) } else { faces }, WHITE, Some(1.0));
            world
        };
        assert_eq!(found(&lamp(false)), []);
        assert!(matches!(found(&lamp(true))[..], [Finding::ShinesInwards { .. }]));
        // Its own corners do not count, which lie within the box around it.
        let mut leaning = world();
        put(&mut leaning, turn(reversed(box_of(DVec3::ZERO, DVec3::ONE)), 1), WHITE, Some(1.0));
        assert!(matches!(found(&leaning)[..], [Finding::ShinesInwards { .. }]));
        let mut dome = lamp(true);
        dome.cameras[0].eye = DVec3::splat(0.5);
        assert_eq!(found(&dome), [], "with a camera inside");
        let mut lit = lamp(true);
        lit.spheres.push(Sphere { centre: DVec3::ZERO, radius: 0.1, material: WHITE, radiance: None });
        assert_eq!(found(&lit), [], "with a ball inside");
    }
}

/// A pane of 2 m in a scene of 2 km: thinner than a few steps of f32 it is told, along the axes and across them.
#[test]
fn thin_panes_are_told() {
    let pane = |thickness: f64, k: u32| {
        let mut world = world();
        let faces = turn(box_of(DVec3::ZERO, DVec3::new(1.0, thickness / 2.0, 1.0)), k);
        let moved = faces.into_iter().map(|face| face.into_iter().map(|v| v + DVec3::splat(900.0)).collect()).collect();
        as_mesh(&mut world, moved, GLASS, None);
        // Coordinates are finest where most of the details are.
        let detail = |k: u32| Sphere {
            centre: DVec3::new(f64::from(k), 0.0, 0.0) - DVec3::splat(900.0),
            radius: 0.3,
            material: WHITE,
            radiance: None,
        };
        world.spheres.extend((0..60).map(detail));
        let found = found(&world);
        found.into_iter().find_map(|finding| match finding {
            Finding::Thin { thickness, steps, .. } => Some((thickness, steps)),
            _ => None,
        })
    };
    for k in 0..4 {
        assert_eq!(pane(0.01, k), None, "turned {k}");
        for thickness in [1e-4, 1e-5, 3e-6] {
            let told = pane(thickness, k).unwrap_or_else(|| panic!("{thickness}, turned {k}"));
            assert!((told.0 / thickness - 1.0).abs() < 0.02, "{thickness}, turned {k}: {told:?}");
        }
    }
}

/// A ball of 1 m on a planet, and two things of 1 m as far from each other as a planet is large.
#[test]
fn what_is_large_beside_what_is_small_is_told() {
    let ball = |z: f64, radius: f64| Sphere { centre: DVec3::Z * z, radius, material: WHITE, radiance: None };
    let of = |spheres: &[Sphere]| {
        let mut world = world();
        world.spheres = spheres.to_vec();
        found(&world)
    };
    for planet in [2e5, 1e6, 1e8] {
        let found = of(&[ball(-planet, planet), ball(0.5, 0.5)]);
        let [Finding::Rough { sphere, beside, extent, things, rounding, .. }] = found[..] else { panic!("{found:?}") };
        assert_eq!((sphere, beside, extent, things), (Origin::Sphere(0), Origin::Sphere(1), 1.0, 1));
        assert!((rounding / planet * f64::from(1u32 << 23) - 1.0).abs() < 0.01, "{rounding}");
        let found = of(&[ball(-planet, 0.5), ball(0.5, 0.5)]);
        assert!(matches!(found[..], [Finding::Coarse { extent: 1.0, things: 1, .. }]), "{found:?}");
    }
    assert_eq!(of(&[ball(-1e3, 1e3), ball(0.5, 0.5)]), []);
    assert_eq!(of(&[ball(-3e6, 1e6), ball(0.5, 0.5)]), [], "a planet in the sky");
    // A plane as large has coordinates enough where the ball is.
    let mut world = world();
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(1e6 * x, 1e6 * y, 0.0));
    as_polygons(&mut world, vec![corners.to_vec()], WHITE, None);
    world.spheres = vec![ball(0.5, 0.5)];
    assert_eq!(found(&world), []);
}

/// All faces of a file may have been dropped: its corners make the scene large, but are nothing that could be named.
#[test]
fn a_mesh_without_faces_is_nothing() {
    let mut world = world();
    world.spheres.push(Sphere { centre: DVec3::ZERO, radius: 0.5, material: WHITE, radiance: None });
    world.spheres.push(Sphere { centre: DVec3::X * 1e8, radius: 1.0, material: WHITE, radiance: None });
    let corners = vec![DVec3::X * 1e9, DVec3::Y * 1e9];
    world.meshes.push(Mesh { vertices: corners, faces: Vec::new(), material: WHITE, radiance: None });
    let found = found(&world);
    let [Finding::Coarse { surface, largest, .. }] = found[..] else { panic!("{found:?}") };
    assert!([surface, largest].iter().all(|named| matches!(named, Origin::Sphere(_))), "{found:?}");
}

/// Walls and ground are boxes with the normals out, and the water reaches into them.
#[test]
fn water_may_end_within_its_walls() {
    let pool = |half: f64, put: Put| {
        let mut world = world();
        for (middle, half) in [
            (DVec3::new(-1.2, 0.0, 0.0), DVec3::new(0.2, 1.4, 1.0)),
            (DVec3::new(1.2, 0.0, 0.0), DVec3::new(0.2, 1.4, 1.0)),
            (DVec3::new(0.0, -1.2, 0.0), DVec3::new(1.0, 0.2, 1.0)),
            (DVec3::new(0.0, 1.2, 0.0), DVec3::new(1.0, 0.2, 1.0)),
            (DVec3::new(0.0, 0.0, -1.2), DVec3::new(1.4, 1.4, 0.2)),
        ] {
            put(&mut world, box_of(middle, half), WHITE, None);
        }
        let water = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corners = water.map(|(x, y)| DVec3::new(half * x, half * y, 0.3)).to_vec();
        put(&mut world, vec![corners], GLASS, None);
        found(&world)
    };
    for put in PUTS {
        assert_eq!(pool(1.1, put), [], "into the walls");
        assert_eq!(pool(1.0, put), [], "to the walls");
        assert!(matches!(pool(0.9, put)[..], [Finding::Open { .. }]), "not to the walls");
        assert!(matches!(pool(1.7, put)[..], [Finding::Open { .. }]), "beyond the walls");
    }
}
