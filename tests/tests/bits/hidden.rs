//! Whole images where the same primitives are in a list, in a tree, or in both: what makes the difference is hidden
//! geometry that no ray can reach. And shadow rays with and without what is pruned as unable to stop them.

use glam::DVec3;
use smalti_core::accel::{LIST_UP_TO, Tracer};
use smalti_core::geometry::Ray;
use smalti_core::lanes::{One, V3};
use smalti_core::scene::world::{Material, Mesh, Polygon};
use smalti_core::scene::{Scene, World};
use smalti_core::settings::{Integrator, Settings};
use smalti_image::hash;
use smalti_tests::build::{closed_box, grey, material, sphere};
use smalti_tests::draw::{Way, draw, renderer, scene};
use smalti_tests::oracle::Random;

/// More triangles than a list takes, in two corners of the room's box that lie outside of its walls: as many in each, so
/// that the middle of the details, and with it the frame, stays where it is.
fn hidden() -> Vec<[DVec3; 3]> {
    let middle = DVec3::new(5.0, 0.0, 0.0);
    let pair = |i: usize| {
        let low = DVec3::new(-7.9, -5.9, -4.9 + i as f64 * 0.01);
        [1.0, -1.0].map(|side| [low, low + DVec3::X * 0.1, low + DVec3::Y * 0.1].map(|at| middle + at * side))
    };
    (0..=LIST_UP_TO / 2).flat_map(pair).collect()
}

/// The room with the hidden triangles in a mesh (then its own mesh is in a tree as well), or as polygons (then all is).
fn with_hidden(world: &World, as_mesh: bool) -> World {
    let mut world = world.clone();
    let material = world.materials.len();
    world.materials.push(Material::Lambert { albedo: [0.5; 3] });
    if as_mesh {
        let vertices = hidden().concat();
        let faces = (0..hidden().len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        world.meshes.push(Mesh { vertices, faces, material, radiance: None });
    } else {
        let polygon = |corners: [DVec3; 3]| Polygon { vertices: corners.to_vec(), material, radiance: None };
        world.polygons.extend(hidden().into_iter().map(polygon));
    }
    world
}

#[test]
fn the_room_with_hidden_geometry() {
    let room = scene("hexroom").world;
    let worlds = [room.clone(), with_hidden(&room, true), with_hidden(&room, false)];
    for integrator in [Integrator::Path, Integrator::Whitted] {
        let settings = Settings { integrator, width: 96, height: 96, spp: 8, shadow_rays: 2, ..Settings::default() };
        let kinds = worlds.each_ref().map(|world| {
            let renderer = renderer(world, &settings, Way::default().level);
            let everything = &renderer.plan().everything;
            (!everything.list.is_empty(), everything.tree.is_some())
        });
        assert_eq!(kinds, [(true, false), (true, true), (false, true)]);
        let [list, both, tree] = worlds.each_ref().map(|world| hash(&draw(world, &settings, Way::default())));
        assert_eq!(list, both, "list or both, {integrator:?}");
        assert_eq!(list, tree, "list or tree, {integrator:?}");
    }
}

/// A room with shelves anywhere, boxes and balls, and a lamp under the ceiling.
fn furnished(random: &mut Random) -> World {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    closed_box(&mut world, DVec3::ZERO, DVec3::ONE, white, None);
    for _ in 0..4 {
        let middle = random.cube() * 0.8;
        closed_box(&mut world, middle, DVec3::splat(0.02 + 0.1 * random.unit()), white, None);
        sphere(&mut world, random.cube() * 0.8, 0.1 * random.unit(), white, None);
        let (height, side) = (1.9 * random.unit() - 0.95, random.unit());
        let shelf = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let vertices = shelf.map(|(x, y)| DVec3::new(x, y * side, height)).to_vec();
        world.polygons.push(Polygon { vertices, material: white, radiance: None });
    }
    let lamp = [(-0.3, -0.3), (-0.3, 0.3), (0.3, 0.3), (0.3, -0.3)];
    let vertices = lamp.map(|(x, y)| DVec3::new(x, y, 0.99)).to_vec();
    world.polygons.push(Polygon { vertices, material: white, radiance: Some([1.0; 3]) });
    world
}

/// A point on a face, as weights of its first three corners say.
fn on_face(scene: &Scene, prim: usize, random: &mut Random) -> DVec3 {
    let corners = scene.face_corners(&scene.faces[prim]);
    let [a, b, c] = [0, 1, 2].map(|k| DVec3::from_array(scene.vertices[corners[k] as usize].map(f64::from)));
    let (u, v) = (random.unit(), random.unit());
    let (u, v) = if u + v < 1.0 { (u, v) } else { (1.0 - u, 1.0 - v) };
    a + u * (b - a) + v * (c - a)
}

#[test]
fn what_is_pruned_would_stop_no_shadow_ray() {
    let mut random = Random::new(71);
    let (mut asked, mut stopped, mut pruned) = (0, 0, 0);
    for _ in 0..60 {
        let world = furnished(&mut random);
        let renderer =
            renderer(&world, &Settings { integrator: Integrator::Path, ..Settings::default() }, Way::default().level);
        let (scene, plan) = (renderer.scene(), renderer.plan());
        pruned += plan.everything.len() - plan.occluders.len();
        let (mut few, mut all) = (Tracer::new(One, &plan.occluders), Tracer::new(One, &plan.everything));
        // Emitting faces come first: the lamp.
        let lamp = scene.faces[0].surface;
        for _ in 0..500 {
            let face = 1 + random.below(scene.faces.len() - 1);
            let (from, goal) = (on_face(scene, face, &mut random), on_face(scene, 0, &mut random));
            let reach = (goal - from).as_vec3().to_array();
            let from = V3::splat(One, from.as_vec3().to_array());
            let ray = Ray::new(One, from, V3::splat(One, reach), scene.faces[face].surface);
            let answers = [few.occluded(One, &ray, lamp, true), all.occluded(One, &ray, lamp, true)];
            assert_eq!(answers[0], answers[1], "from face {face} along {reach:?}");
            asked += 1;
            stopped += u32::from(answers[0]);
        }
    }
    assert!(pruned >= 60 && stopped > asked / 10 && stopped < asked * 9 / 10, "{pruned} pruned, {stopped} of {asked}");
}
