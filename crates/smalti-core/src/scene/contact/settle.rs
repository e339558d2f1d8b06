//! What a compiled scene needs where surfaces coincide: one plane for all of them, so that they are met at one distance;
//! numbers in the order in which they are to be seen, as ties go to the lowest; and what touches what.

use super::numbers::Numbers;
use super::{Joints, Room, pairs};
use crate::accel::cones::leader;
use crate::light::table::NO_SURFACE;
use crate::mutant::mutant;
use crate::scene::Scene;
use crate::scene::world::World;

/// Settles what coincides, and enters what is near. Does nothing to a scene without such pairs.
pub fn settle(scene: &mut Scene, world: &World) {
    let found = pairs(world, &scene.frame);
    if found.is_empty() {
        return;
    }
    let mut numbered = Numbers::of(scene, world).numbered(&found);
    let coincident: Vec<[u32; 2]> =
        numbered.iter().filter(|(pair, _)| pair.coincides()).map(|(_, prims)| *prims).collect();
    share_planes(scene, &coincident);
    if coincident.iter().any(|[a, b]| rank(scene, world, *a) > rank(scene, world, *b)) {
        renumber(scene, world);
        numbered = Numbers::of(scene, world).numbered(&found);
    }
    scene.room = Room::beside(scene, &numbered);
    scene.joints = Joints::among(scene, world, &numbered);
}

/// What is seen first of surfaces in one place: what emits, as shadow rays find it too; then what is opaque, as light in
/// glass on a table is scattered by the table; then what was written first.
fn rank(scene: &Scene, world: &World, prim: u32) -> (bool, bool, (usize, u32)) {
    let origin = scene.origins[prim as usize];
    let (material, radiance) = world.skin(origin);
    let is_clear = world.materials[material].is_dielectric() && !mutant!("glass_before_the_table");
    (radiance.is_none(), is_clear, world.place(origin))
}

/// Gives what coincides the plane, or sphere, and the surface id of the lowest number among it.
fn share_planes(scene: &mut Scene, pairs: &[[u32; 2]]) {
    if pairs.is_empty() {
        return;
    }
    let mut leaders: Vec<u32> = (0..scene.shades.len() as u32).collect();
    let mut ids: Vec<u32> = (0..scene.planes + scene.spheres.len() as u32).collect();
    for prims in pairs {
        join(&mut leaders, *prims);
        join(&mut ids, prims.map(|prim| scene.surface(prim)));
    }
    for prim in pairs.iter().flatten().copied() {
        take_geometry(scene, prim, leader(&mut leaders, prim));
    }
    let of_faces = scene.faces.iter_mut().map(|face| &mut face.surface);
    let of_lights = scene.lights.surfaces.iter_mut().filter(|surface| **surface != NO_SURFACE);
    of_faces.chain(of_lights).for_each(|surface| *surface = leader(&mut ids, *surface));
    for shade in &mut scene.shades {
        shade[7] = f32::from_bits(leader(&mut ids, shade[7].to_bits()));
    }
}

fn join(leaders: &mut [u32], pair: [u32; 2]) {
    let [a, b] = pair.map(|one| leader(leaders, one));
    leaders[a.max(b) as usize] = a.min(b);
}

/// Puts a primitive into the plane of another, whichever side it shows; or makes a sphere the same as another.
fn take_geometry(scene: &mut Scene, prim: u32, from: u32) {
    let [prim, from] = [prim, from].map(|number| number as usize);
    let [x, y, z, w, ..] = scene.shades[from];
    let [own_x, own_y, own_z, ..] = scene.shades[prim];
    let turn = match scene.faces.get(prim) {
        Some(_) if x * own_x + y * own_y + z * own_z < 0.0 => -1.0,
        _ => 1.0,
    };
    let geometry = [x, y, z, w].map(|value| turn * value);
    scene.shades[prim][..4].copy_from_slice(&geometry);
    match scene.faces.get_mut(prim) {
        Some(face) => face.plane = geometry,
        None => scene.spheres[prim - scene.faces.len()] = geometry,
    }
}

/// Numbers the faces anew, and the spheres, by their rank.
fn renumber(scene: &mut Scene, world: &World) {
    let faces = scene.faces.len() as u32;
    let mut order: Vec<u32> = (0..scene.shades.len() as u32).collect();
    order.sort_by_cached_key(|prim| (*prim >= faces, rank(scene, world, *prim)));
    let (of_faces, of_spheres) = order.split_at(faces as usize);
    scene.faces = of_faces.iter().map(|prim| scene.faces[*prim as usize]).collect();
    scene.spheres = of_spheres.iter().map(|prim| scene.spheres[(*prim - faces) as usize]).collect();
    scene.shades = order.iter().map(|prim| scene.shades[*prim as usize]).collect();
    scene.classes = order.iter().map(|prim| scene.classes[*prim as usize]).collect();
    scene.origins = order.iter().map(|prim| scene.origins[*prim as usize]).collect();
}
