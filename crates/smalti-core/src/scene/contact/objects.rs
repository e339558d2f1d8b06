//! Which faces can touch another at all: those within the box of another object, and those of dielectrics.

use glam::DVec3;

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
    /// Low corner of its box.
    pub low: [f32; 3],
    /// High corner of its box.
    pub high: [f32; 3],
}

impl Candidate {
    /// Whether the boxes meet.
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// A polygon or a mesh.
struct Object {
    clear: bool,
    low: DVec3,
    high: DVec3,
    others: Vec<u32>,
}

/// With more objects about a mesh than this, all of its faces are candidates.
const MOST_OTHERS: usize = 32;

/// The faces of `world` that may lie on another one.
pub fn candidates(world: &World, frame: &Frame) -> Vec<Candidate> {
    let mut objects = objects(world, frame);
    meet(&mut objects);
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
        let (low, high) = bounds(vertices.iter().map(|v| frame.point(*v)));
        Object { clear: world.materials[material].is_dielectric(), low, high, others: Vec::new() }
    };
    let polygons = world.polygons.iter().map(|polygon| object(&polygon.vertices, polygon.material));
    let meshes = world.meshes.iter().map(|mesh| object(&mesh.vertices, mesh.material));
    polygons.chain(meshes).collect()
}

/// Low and high corner of the box around points, wider by as much as is near.
fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.fold(none, |(low, high), point| (low.min(point), high.max(point)));
    (low - NEAR * STEP, high + NEAR * STEP)
}

/// Enters into every object those whose boxes meet its own.
fn meet(objects: &mut [Object]) {
    let axis = widest(objects);
    let mut order: Vec<u32> = (0..objects.len() as u32).collect();
    order.sort_by(|a, b| objects[*a as usize].low[axis].total_cmp(&objects[*b as usize].low[axis]));
    for (at, &a) in order.iter().enumerate() {
        let until = objects[a as usize].high[axis];
        let after = order[at + 1..].iter().take_while(|b| objects[**b as usize].low[axis] <= until);
        let met: Vec<u32> = after.copied().filter(|b| overlap(&objects[a as usize], &objects[*b as usize])).collect();
        met.iter().for_each(|b| objects[*b as usize].others.push(a));
        objects[a as usize].others.extend(met);
    }
}

/// The axis along which the objects are spread widest.
fn widest(objects: &[Object]) -> usize {
    let lows = objects.iter().map(|object| object.low).filter(|low| low.is_finite());
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (least, most) = lows.fold(none, |(least, most), low| (least.min(low), most.max(low)));
    let spread = most - least;
    (0..3).reduce(|a, b| if spread[b] > spread[a] { b } else { a }).unwrap_or(0)
}

fn overlap(a: &Object, b: &Object) -> bool {
    a.low.cmple(b.high).all() && b.low.cmple(a.high).all()
}

fn near_others(corners: &[DVec3; 3], object: &Object, objects: &[Object]) -> bool {
    let (low, high) = bounds(corners.iter().copied());
    let meets = |other: &u32| {
        let other = &objects[*other as usize];
        low.cmple(other.high).all() && other.low.cmple(high).all()
    };
    object.others.len() > MOST_OTHERS || object.others.iter().any(meets)
}

/// `None` without an area.
fn candidate(corners: &[DVec3], origin: Origin, (index, object): (usize, &Object)) -> Option<Candidate> {
    let normal = newell(corners).try_normalize()?;
    let (low, high) = bounds(corners.iter().copied());
    let plane = normal.extend(normal.dot(corners[0])).as_vec4().to_array();
    let [low, high] = [low, high].map(|corner| corner.as_vec3().to_array());
    Some(Candidate { origin, object: index as u32, clear: object.clear, plane, low, high })
}
