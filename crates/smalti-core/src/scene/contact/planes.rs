//! From candidates to pairs: sorted into drawers by their planes, so that few have to be compared.

use super::meeting;
use super::objects::Candidate;
use super::overlap::{self, Corners};
use super::{NEAR, ONE_PLACE, Pair, ROUNDING, STEP};
use crate::scene::Frame;
use crate::scene::world::World;

/// Planes whose normals differ by more than this are not parallel.
const PARALLEL: f64 = 1e-5;

/// Planes whose distance is not even are one within this many steps: the corners of faces, small ones above all, are
/// rounded each for itself, in files of f32 by their own size.
const CROSSING: f64 = 8.0;

/// Width of a drawer: as much as the figures of two planes can differ that are parallel and near.
const DRAWER: f64 = 3e-5;

/// Pairs among `faces`, each once.
pub fn pairs(world: &World, frame: &Frame, faces: &[Candidate]) -> Vec<Pair> {
    let mut sorted: Vec<(i64, &Candidate)> = faces.iter().map(|face| (drawer(face), face)).collect();
    sorted.sort_by_key(|(number, _)| *number);
    let drawers: Vec<&[(i64, &Candidate)]> = sorted.chunk_by(|a, b| a.0 == b.0).collect();
    let mut found = Vec::new();
    let mut give = |a: &Candidate, b: &Candidate| {
        if may_pair(a, b) {
            let (a, b) = if a.origin < b.origin { (a, b) } else { (b, a) };
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

/// The faces in a drawer.
fn content<'f>(drawer: &[(i64, &'f Candidate)]) -> Vec<&'f Candidate> {
    drawer.iter().map(|(_, face)| *face).collect()
}

/// The drawer of a plane, whichever side it shows.
fn drawer(face: &Candidate) -> i64 {
    let [x, y, z, distance] = face.plane.map(f64::from);
    let figure = 0.613 * x + 0.352 * y + 0.709 * z + 0.5 * distance;
    (figure.abs() / DRAWER) as i64
}

/// What can be excluded without a look at corners. Of one opaque mesh no two faces pair: the first of them is seen.
fn may_pair(a: &Candidate, b: &Candidate) -> bool {
    let [p, q] = [a.plane, b.plane].map(|plane| glam::DVec4::from_array(plane.map(f64::from)).truncate());
    (a.object != b.object || a.clear) && p.cross(q).length_squared() < PARALLEL * PARALLEL
}

fn pair(world: &World, frame: &Frame, a: &Candidate, b: &Candidate) -> Option<Pair> {
    let corners = [a, b].map(|face| Corners::new(world, frame, face.origin));
    let overlap::Overlap { heights: (low, high), size, step, as_f32, same_way } =
        overlap::of(&corners[0], &corners[1])?;
    let most = low.abs().max(high.abs());
    let even = low * high > 0.0 && most <= 2.0 * low.abs().min(high.abs());
    let inclined = !even && most <= CROSSING * step.max(as_f32) && most <= NEAR * STEP;
    let coincide = inclined || most <= ONE_PLACE * step + ROUNDING;
    let near = even && most <= NEAR * STEP * size && (a.clear || b.clear);
    let gap = if inclined { 0.0 } else { (low + high) / 2.0 };
    let found = Pair { of: [a.origin, b.origin], gap, step, same_way };
    (coincide || near).then_some(found)
}
