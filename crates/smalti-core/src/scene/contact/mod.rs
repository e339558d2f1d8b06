//! What lies in one place, or so near that rays which leave one face would start beyond the other.
//!
//! A glass that stands on a table has a bottom in the table's plane; a pane may be thinner than rays are moved off a
//! surface. Both are found here, in f64, from the world as it was written: pairs of faces that overlap and are (nearly)
//! parallel, and spheres within spheres. `settle` makes a compiled scene right by them; scenes without such pairs are
//! left as they are, to the bit.

mod joints;
mod meeting;
mod numbers;
mod objects;
mod overlap;
mod planes;
mod room;
mod settle;
mod spheres;

pub use joints::Joints;
pub use room::Room;
pub(super) use settle::settle;

use super::world::World;
use super::{Frame, Origin};

/// Rounding of a coordinate of 1 in the frame: half a step of f32 below it.
pub(crate) const STEP: f64 = 1.0 / (1 << 24) as f64;

/// Nearer than so many steps at their own coordinates, two faces are in one place: each is rounded by half a step.
const ONE_PLACE: f64 = 1.5;

/// Nearer than so many steps of the largest coordinate, and rays have to leave with care: twice as far as they usually
/// leave a surface.
const NEAR: f64 = 48.0;

/// What f64 makes of two planes that are written as one.
const ROUNDING: f64 = 1e-14;

/// Two faces, or spheres, in one place or nearly so. Lengths are those of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The two, in no order.
    pub of: [Origin; 2],
    /// Height of the second over the first, along the first one's normal.
    pub gap: f64,
    /// Rounding of coordinates across the gap, where the two overlap.
    pub step: f64,
    /// Whether their normals point to the same side.
    pub same_way: bool,
}

impl Pair {
    /// Whether the two are in one place, as far as coordinates can tell.
    pub fn coincides(&self) -> bool {
        self.gap.abs() <= ONE_PLACE * self.step + ROUNDING
    }

    /// The same pair, the second as the first.
    fn turned(self) -> Self {
        let [a, b] = self.of;
        Self { of: [b, a], gap: if self.same_way { -self.gap } else { self.gap }, ..self }
    }
}

/// Every pair of `world` whose faces coincide; and of those that have a dielectric among them, every pair so near that
/// rays have to leave with care.
pub fn pairs(world: &World, frame: &Frame) -> Vec<Pair> {
    let faces = objects::candidates(world, frame);
    let mut found = planes::pairs(world, frame, &faces);
    found.extend(spheres::pairs(world, frame));
    found
}

#[cfg(test)]
mod tests;
