//! The scenes that a user opens first: they load, without notes, and are what their comments say.

use std::path::Path;

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::{Material, Mesh, Polygon};
use smalti_scene::{Loaded, load};

fn scene(name: &str) -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let loaded = load(&path).unwrap_or_else(|error| panic!("{error}"));
    assert!(loaded.notes.is_empty(), "{:?}", loaded.notes);
    loaded
}

/// Area times unit normal.
fn area(polygon: &Polygon) -> DVec3 {
    let v = &polygon.vertices;
    (1..v.len() - 1).map(|i| (v[i] - v[0]).cross(v[i + 1] - v[0])).sum::<DVec3>() / 2.0
}

/// Signed volume within closed polygons, by the divergence theorem: negative where normals point inward.
fn volume<'p>(polygons: impl IntoIterator<Item = &'p Polygon>) -> f64 {
    polygons.into_iter().map(|polygon| area(polygon).dot(polygon.vertices[0]) / 3.0).sum()
}

fn triangles(mesh: &Mesh) -> Vec<Polygon> {
    let triangle = |face: &[u32; 3]| face.map(|index| mesh.vertices[index as usize]).to_vec();
    let polygon = |face| Polygon { vertices: triangle(face), material: 0, radiance: None };
    mesh.faces.iter().map(polygon).collect()
}

fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} is not {expected}");
}

/// The room's own measures: floor 156, surface 780.33, volume 1560; all normals look into it.
fn assert_is_the_room(world: &World) {
    let room = &world.polygons[..8];
    assert_near(volume(room), -1560.0);
    assert_eq!(area(&room[0]), DVec3::Z * 156.0);
    let surface: f64 = room.iter().map(|polygon| area(polygon).length()).sum();
    assert!((surface - 780.33).abs() < 0.005, "{surface}");
    let red = |albedo: [f64; 3]| albedo == [0.75, 0.15, 0.15];
    let facing =
        room.iter().find(|p| matches!(world.materials[p.material], Material::Lambert { albedo } if red(albedo)));
    assert!(facing.unwrap().vertices.iter().all(|v| v.y == 6.0), "the red wall is the left one");
}

#[test]
fn hexroom() {
    let Loaded { world, settings, .. } = scene("hexroom.toml");
    assert_is_the_room(&world);
    assert_eq!((settings.size, settings.spp, settings.shadow_rays), (Some([800, 800]), Some(5), Some(10)));
    assert_eq!((world.polygons.len(), world.spheres.len(), world.meshes.len()), (9, 2, 1));
    assert_eq!(area(&world.polygons[8]), DVec3::Z * -4.0, "the lamp shines down");
    assert_eq!(world.polygons[8].radiance, Some([20.0; 3]));
    assert_eq!(world.materials[world.polygons[8].material], Material::Lambert { albedo: [0.0; 3] });
    assert_eq!(world.materials[world.spheres[0].material], Material::Mirror { reflectance: [1.0; 3] });
    assert_eq!(world.materials[world.spheres[1].material], Material::clear(1.5));
    assert_near(volume(&triangles(&world.meshes[0])), 2.16 * 1.25 * 2.04 / 3.0);
    assert_near(world.cameras[0].fov, std::f64::consts::FRAC_PI_2);
}

#[test]
fn hexroom_caustic_has_the_same_power() {
    let (plain, caustic) = (scene("hexroom.toml").world, scene("hexroom-caustic.toml").world);
    assert_is_the_room(&caustic);
    let power = |world: &World| area(&world.polygons[8]).length() * world.polygons[8].radiance.unwrap()[0];
    assert_near(power(&caustic), power(&plain));
    assert!(caustic.spheres.iter().all(|s| caustic.materials[s.material] == Material::clear(1.5)));
    assert_eq!(caustic.meshes[0].vertices, plain.meshes[0].vertices);
    let places = |world: &World| world.spheres.iter().map(|s| (s.centre, s.radius)).collect::<Vec<_>>();
    assert_eq!(places(&caustic), places(&plain));
}

#[test]
fn blob() {
    let world = scene("blob.toml").world;
    assert_is_the_room(&world);
    let blob = &world.meshes[0];
    assert_eq!((blob.vertices.len(), blob.faces.len()), (40_962, 81_920));
    let (low, high) = blob.vertices.iter().fold((DVec3::MAX, DVec3::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    assert!(((low + high) / 2.0 - DVec3::new(6.0, 0.0, -1.0)).abs().max_element() < 0.1);
    assert!(((high - low) / 5.0 - DVec3::ONE).abs().max_element() < 0.08);
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 2.5 * 2.5 * 2.5;
    assert!((volume(&triangles(blob)) / ball - 1.0).abs() < 0.01, "closed, and its normals point outward");
    let lamps = &world.polygons[8..];
    assert_eq!(lamps.len(), 16);
    for lamp in lamps {
        assert!((area(lamp) + DVec3::Z * 0.16).length() < 1e-12);
        assert_eq!(lamp.radiance, Some([31.25; 3]));
    }
}

#[test]
fn cornell() {
    let world = scene("cornell.toml").world;
    for (mesh, height) in world.meshes.iter().zip([0.165, 0.33]) {
        // The missing bottom lies in y = 0 and adds nothing to the integral.
        let base = volume(&triangles(mesh)) / height;
        assert!((base.sqrt() - 0.165).abs() < 0.003, "{base}");
    }
    let centre = DVec3::new(0.278, 0.274, 0.28);
    for wall in &world.polygons {
        assert!(area(wall).dot(centre - wall.vertices[0]) > 0.0, "{:?} looks outward", wall.vertices);
    }
}

#[test]
fn every_surface_of_the_furnace_sends_out_1() {
    let world = scene("furnace.toml").world;
    assert_near(volume(&world.polygons), -8.0);
    let all = world
        .polygons
        .iter()
        .map(|p| (p.material, p.radiance))
        .chain(world.spheres.iter().map(|s| (s.material, s.radiance)));
    for (material, radiance) in all {
        let emitted = radiance.unwrap_or_default()[0];
        match world.materials[material] {
            Material::Lambert { albedo } => assert_eq!(emitted + albedo[0], 1.0),
            Material::Mirror { reflectance } => assert_eq!(reflectance, [1.0; 3]),
            Material::Dielectric { .. } => assert_eq!(emitted, 0.0),
        }
    }
}
