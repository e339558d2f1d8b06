//! Which faces can touch another at all: those within the box of another object, and those of dielectrics.

use glam::DVec3;

use super::meeting::{self, Extent};
use super::{NEAR, STEP};
use crate::scene::world::World;
use crate::scene::{Frame, Origin, newell};

/// A face that may lie on another.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The face.
    pub origin: Origin,
    /// The polygon or mesh that it is of.
    pub object: u32,
    /// Whether it bounds a dielectric.
    pub clear: bool,
    /// Unit normal and distance of its plane.
    pub plane: [f32; 4],
    /// The box around it, wider by as much as is near.
    pub extent: Extent,
}

/// A polygon or a mesh.
struct Object {
    clear: bool,
    extent: Extent,
    /// Those whose boxes its own meets.
    others: Vec<u32>,
}

/// With more objects about a mesh than this, all of its faces are candidates.
const MOST_OTHERS: usize = 32;

/// The faces of `world` that may lie on another one.
pub fn candidates(world: &World, frame: &Frame) -> Vec<Candidate> {
    let objects = objects(world, frame);
    let mut found = Vec::new();
    let polygons = world.polygons.len();
    for (index, (polygon, object)) in world.polygons.iter().zip(&objects).enumerate() {
        if !object.others.is_empty() {
            let corners: Vec<DVec3> = polygon.vertices.iter().map(|v| frame.point(*v)).collect();
            found.extend(candidate(&corners, Origin::Polygon(index as u32), (index, object)));
        }
    }
    for (index, mesh) in world.meshes.iter().enumerate() {
        let object = &objects[polygons + index];
        if object.others.is_empty() && !object.clear {
            continue;
        }
        for (number, face) in mesh.faces.iter().enumerate() {
            let corners = face.map(|corner| frame.point(mesh.vertices[corner as usize]));
            if object.clear || near_others(&corners, object, &objects) {
                let origin = Origin::Mesh(index as u32, number as u32);
                found.extend(candidate(&corners, origin, (polygons + index, object)));
            }
        }
    }
    found
}

fn objects(world: &World, frame: &Frame) -> Vec<Object> {
    let object = |vertices: &[DVec3], material: usize| {
        let extent = Extent::around(vertices.iter().map(|v| frame.point(*v)), NEAR * STEP);
        Object { clear: world.materials[material].is_dielectric(), extent, others: Vec::new() }
    };
    let polygons = world.polygons.iter().map(|polygon| object(&polygon.vertices, polygon.material));
    let meshes = world.meshes.iter().map(|mesh| object(&mesh.vertices, mesh.material));
    let mut objects: Vec<Object> = polygons.chain(meshes).collect();
    let boxes = objects.iter().map(|object| object.extent).zip(0..).collect();
    meeting::within(boxes, &mut |a, b| {
        objects[a as usize].others.push(b);
        objects[b as usize].others.push(a);
    });
    objects
}

fn near_others(corners: &[DVec3; 3], object: &Object, objects: &[Object]) -> bool {
    let extent = Extent::around(corners.iter().copied(), NEAR * STEP);
    let near = |other: &u32| objects[*other as usize].extent.meets(&extent);
    object.others.len() > MOST_OTHERS || object.others.iter().any(near)
}

/// `None` without an area.
fn candidate(corners: &[DVec3], origin: Origin, (index, object): (usize, &Object)) -> Option<Candidate> {
    let normal = newell(corners).try_normalize()?;
    let plane = normal.extend(normal.dot(corners[0])).as_vec4().to_array();
    let extent = Extent::around(corners.iter().copied(), NEAR * STEP);
    Some(Candidate { origin, object: index as u32, clear: object.clear, plane, extent })
}
