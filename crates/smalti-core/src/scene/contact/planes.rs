//! From candidates to pairs: sorted into drawers by their planes, so that few have to be compared.

use std::collections::HashMap;

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
    let mut drawers: HashMap<i64, Vec<u32>> = HashMap::new();
    for (index, face) in faces.iter().enumerate() {
        drawers.entry(drawer(face)).or_default().push(index as u32);
    }
    let mut numbers: Vec<i64> = drawers.keys().copied().collect();
    numbers.sort_unstable();
    let mut found = Vec::new();
    for number in numbers {
        let own = &drawers[&number];
        let next = drawers.get(&(number + 1)).map_or(&[][..], |next| &next[..]);
        sweep(faces, own, next, &mut |a, b| found.extend(pair(world, frame, &faces[a as usize], &faces[b as usize])));
    }
    found
}

/// The drawer of a plane, whichever side it shows.
fn drawer(face: &Candidate) -> i64 {
    let [x, y, z, distance] = face.plane.map(f64::from);
    let figure = 0.613 * x + 0.352 * y + 0.709 * z + 0.5 * distance;
    (figure.abs() / DRAWER) as i64
}

/// Gives every two faces whose boxes meet, one of `own` and the other of `own` or `next`.
fn sweep(faces: &[Candidate], own: &[u32], next: &[u32], give: &mut impl FnMut(u32, u32)) {
    if own.len() + next.len() < 2 {
        return;
    }
    let mut all: Vec<(u32, bool)> = own.iter().map(|face| (*face, true)).collect();
    all.extend(next.iter().map(|face| (*face, false)));
    let axis = widest(faces, &all);
    let low = |face: u32| faces[face as usize].low[axis];
    all.sort_by(|a, b| low(a.0).total_cmp(&low(b.0)).then(a.0.cmp(&b.0)));
    for (at, &(a, is_own)) in all.iter().enumerate() {
        let until = faces[a as usize].high[axis];
        for &(b, also_own) in all[at + 1..].iter().take_while(|b| low(b.0) <= until) {
            if (is_own || also_own) && may_pair(&faces[a as usize], &faces[b as usize]) {
                give(a.min(b), a.max(b));
            }
        }
    }
}

fn widest(faces: &[Candidate], all: &[(u32, bool)]) -> usize {
    let spread = |axis: usize| {
        let lows = all.iter().map(|(face, _)| faces[*face as usize].low[axis]);
        let (least, most) =
            lows.fold((f32::INFINITY, f32::NEG_INFINITY), |(least, most), low| (least.min(low), most.max(low)));
        most - least
    };
    (0..3).reduce(|a, b| if spread(b) > spread(a) { b } else { a }).unwrap_or(0)
}

/// What can be excluded without a look at corners. Of one opaque mesh no two faces pair: the first of them is seen.
fn may_pair(a: &Candidate, b: &Candidate) -> bool {
    let meet = (0..3).all(|k| a.low[k] <= b.high[k] && b.low[k] <= a.high[k]);
    let [p, q] = [a.plane, b.plane].map(|plane| glam::DVec4::from_array(plane.map(f64::from)).truncate());
    meet && (a.object != b.object || a.clear) && p.cross(q).length_squared() < PARALLEL * PARALLEL
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
