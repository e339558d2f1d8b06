//! Whole images where the same primitives are in a list, in a tree, or in both: what makes the difference is hidden
//! geometry that no ray can reach.

use glam::DVec3;
use smalti_core::accel::LIST_UP_TO;
use smalti_core::scene::World;
use smalti_core::scene::world::{Material, Mesh, Polygon};
use smalti_core::settings::{Integrator, Settings};
use smalti_image::hash;
use smalti_tests::draw::{Way, draw, renderer, scene};

/// More triangles than a list takes, in a corner of the room's box that lies outside of its walls.
fn hidden() -> Vec<[DVec3; 3]> {
    let corner = DVec3::new(-2.9, -5.9, 0.0);
    let triangle = |i: usize| {
        let low = corner + DVec3::Z * (i as f64 * 0.01);
        [low, low + DVec3::X * 0.1, low + DVec3::Y * 0.1]
    };
    (0..=LIST_UP_TO).map(triangle).collect()
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
