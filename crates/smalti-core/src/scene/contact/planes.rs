//! From candidates to pairs: sorted into drawers by their planes, so that few have to be compared.

use glam::DVec4;

use super::meeting;
use super::objects::Candidate;
use super::overlap::{self, Corners};
use super::{NEAR, ONE_PLACE, Pair, ROUNDING, STEP};
use crate::scene::world::World;
use crate::scene::{Frame, Origin};

/// Planes whose normals differ by more than this are not parallel.
const PARALLEL: f64 = 1e-5;

/// Planes whose distance is not even are one within this many steps: the corners of faces, small ones above all, are
/// rounded each for itself, in files of f32 by their own size.
const CROSSING: f64 = 8.0;

/// Width of a drawer: as much as the figures of two planes can differ that are parallel and near.
const DRAWER: f64 = 3e-5;

/// Pairs among `faces`, each once.
pub fn pairs(world: &World, frame: &Frame, faces: &[Candidate]) -> Vec<Pair> {
    let mut sorted: Vec<(i64, u32)> = faces.iter().map(drawer).zip(0..).collect();
    sorted.sort_unstable();
    let drawers: Vec<&[(i64, u32)]> = sorted.chunk_by(|a, b| a.0 == b.0).collect();
    let content =
        |drawer: &[(i64, u32)]| drawer.iter().map(|(_, face)| (faces[*face as usize].extent, *face)).collect();
    let mut found = Vec::new();
    let mut give = |a: u32, b: u32| {
        let (a, b) = (&faces[a.min(b) as usize], &faces[a.max(b) as usize]);
        if may_pair(world, a, b) {
            found.extend(pair(world, frame, a, b));
        }
    };
    for (at, own) in drawers.iter().enumerate() {
        meeting::within(content(own), &mut give);
        if let Some(next) = drawers.get(at + 1).filter(|next| next[0].0 == own[0].0 + 1) {
            meeting::between(content(own), content(next), &mut give);
        }
    }
    found.sort_unstable_by_key(|pair| pair.of);
    found
}

/// The drawer of a plane, whichever side it shows.
fn drawer(face: &Candidate) -> i64 {
    let [x, y, z, distance] = face.plane.map(f64::from);
    let figure = 0.613 * x + 0.352 * y + 0.709 * z + 0.5 * distance;
    (figure.abs() / DRAWER) as i64
}

/// What can be excluded without a look at corners. Of one opaque mesh no two faces pair: the first of them is seen.
fn may_pair(world: &World, a: &Candidate, b: &Candidate) -> bool {
    let [p, q] = [a.plane, b.plane].map(|plane| DVec4::from_array(plane.map(f64::from)).truncate());
    (a.object != b.object || (a.clear && !(p.dot(q) > 0.0 && are_neighbours(world, a.origin, b.origin))))
        && p.cross(q).length_squared() < PARALLEL * PARALLEL
}

/// Whether two triangles of one mesh share an edge or a corner; showing one side, they lie beside each other.
fn are_neighbours(world: &World, a: Origin, b: Origin) -> bool {
    let (Origin::Mesh(mesh, a), Origin::Mesh(_, b)) = (a, b) else { return false };
    let faces = &world.meshes[mesh as usize].faces;
    let shared = faces[a as usize].iter().filter(|corner| faces[b as usize].contains(corner)).count();
    matches!(shared, 1 | 2)
}

fn pair(world: &World, frame: &Frame, a: &Candidate, b: &Candidate) -> Option<Pair> {
    let corners = [a, b].map(|face| Corners::new(world, frame, face.origin));
    let overlap::Overlap { heights: (low, high), size, step, as_f32, same_way } =
        overlap::of(&corners[0], &corners[1])?;
    let most = low.abs().max(high.abs());
    let even = low * high > 0.0 && most <= 2.0 * low.abs().min(high.abs());
    let inclined = !even && most <= CROSSING * step.max(as_f32) && most <= NEAR * STEP;
    // Rounded too coarsely for one plane: rays may get between the two wherever they cross.
    let crossing = !even && !inclined && most <= CROSSING * as_f32 && (a.clear || b.clear);
    if crossing {
        let gap = most.max(2.0 * as_f32);
        return Some(Pair { of: [a.origin, b.origin], gap, step: as_f32, same_way });
    }
    let coincide = inclined || most <= ONE_PLACE * step + ROUNDING;
    let near = even && most <= NEAR * STEP * size && (a.clear || b.clear);
    let gap = if inclined { 0.0 } else { (low + high) / 2.0 };
    let found = Pair { of: [a.origin, b.origin], gap, step, same_way };
    (coincide || near).then_some(found)
}
