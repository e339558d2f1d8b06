//! What is left of a face while its ears are cut off: corners in a ring, counter-clockwise.

use robust::{Coord, orient2d};

/// Corners that lose one another.
pub struct Ring<'p> {
    points: &'p [Coord<f64>],
    after: Vec<usize>,
    before: Vec<usize>,
    gone: Vec<bool>,
    /// Corners that are left.
    pub left: usize,
}

/// What a corner is to the ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// The same place as a neighbour, or the tip of a spike without area.
    Nothing,
    /// Convex: an ear, if nothing stands in it.
    Left,
    /// Straight or reflex.
    Other,
}

impl<'p> Ring<'p> {
    /// The ring of all corners.
    pub fn new(points: &'p [Coord<f64>]) -> Self {
        let count = points.len();
        let after = (1..count).chain([0]).collect();
        let before = [count - 1].into_iter().chain(0..count - 1).collect();
        Self { points, after, before, gone: vec![false; count], left: count }
    }

    /// The corner and its neighbours: the one before, itself, the one after.
    pub fn triangle(&self, corner: usize) -> [usize; 3] {
        [self.before[corner], corner, self.after[corner]]
    }

    /// Corners that are left, in ascending order.
    pub fn corners(&self) -> impl Iterator<Item = usize> {
        (0..self.points.len()).filter(|&corner| !self.gone[corner])
    }

    /// Whether the corner is left.
    pub fn has(&self, corner: usize) -> bool {
        !self.gone[corner]
    }

    /// Joins the neighbours of a corner.
    pub fn remove(&mut self, corner: usize) {
        let [before, _, after] = self.triangle(corner);
        self.after[before] = after;
        self.before[after] = before;
        self.gone[corner] = true;
        self.left -= 1;
    }

    /// Which way the boundary turns at a corner.
    pub fn turn(&self, corner: usize) -> Turn {
        let triangle = self.triangle(corner);
        let [a, b, c] = triangle.map(|index| self.points[index]);
        let side = orient2d(a, b, c);
        if a == b || b == c || (side == 0.0 && is_spike(a, b, c)) {
            Turn::Nothing
        } else if side > 0.0 {
            Turn::Left
        } else {
            Turn::Other
        }
    }

    /// Whether `other`, a corner of the ring, forbids to cut off the ear `a`, `b`, `c`. Only a corner that is not convex
    /// needs to be looked at: where a convex one stands in an ear, one that is not does too.
    pub fn forbids(&self, other: usize, [a, b, c]: [usize; 3]) -> bool {
        if self.gone[other] || [a, b, c].contains(&other) {
            return false;
        }
        let edges = [(a, b), (b, c), (c, a)];
        let sides = edges.map(|edge| self.side(edge, other));
        if sides.iter().any(|side| *side < 0.0) || self.turn(other) == Turn::Left {
            return false;
        }
        // The ear's third edge is new: nothing may stand on it. On its other edges, and where it touches a corner at the
        // same place, the boundary may pass by, if it does not go into the ear.
        let [ab, bc, ca] = sides.map(|side| side == 0.0);
        let into = |neighbour: usize| {
            edges.iter().zip([ab, bc, ca]).all(|(&edge, touches)| !touches || self.side(edge, neighbour) > 0.0)
        };
        (ca && !ab && !bc) || into(self.before[other]) || into(self.after[other])
    }

    /// Above zero where `corner` is on the inner side of an edge, zero on its line. The sign is exact.
    fn side(&self, (from, to): (usize, usize), corner: usize) -> f64 {
        orient2d(self.points[from], self.points[to], self.points[corner])
    }
}

/// Whether three places on a line go back on themselves at the second.
fn is_spike(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> bool {
    if a.x == b.x { (a.y > b.y) == (c.y > b.y) } else { (a.x > b.x) == (c.x > b.x) }
}
