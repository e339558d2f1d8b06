//! Cutting off ears: convex corners whose triangle holds nothing else of the face.

use std::collections::VecDeque;

use robust::Coord;

use super::grid::Grid;
use super::ring::{Ring, Turn};

/// The triangles of a face whose corners go counter-clockwise, and whether ears had to be made where there was none: only
/// a face that crosses itself has none.
pub fn clip(points: &[Coord<f64>]) -> (Vec<[usize; 3]>, bool) {
    let ring = Ring::new(points);
    let obstacles: Vec<usize> = ring.corners().filter(|&corner| ring.turn(corner) != Turn::Left).collect();
    let mut clipper = Clipper {
        points,
        obstacles: Grid::new(points, &obstacles),
        ring,
        triangles: Vec::with_capacity(points.len() - 2),
        visits: vec![0; points.len()],
    };
    let mut forced = false;
    while clipper.ring.left > 2 {
        let left = clipper.ring.left;
        clipper.round();
        if clipper.ring.left == left {
            forced = true;
            clipper.force();
        }
    }
    (clipper.triangles, forced)
}

struct Clipper<'p> {
    points: &'p [Coord<f64>],
    obstacles: Grid,
    ring: Ring<'p>,
    triangles: Vec<[usize; 3]>,
    /// How often each corner got new neighbours: visits planned before are void.
    visits: Vec<u32>,
}

impl Clipper<'_> {
    /// Visits every corner, and those beside an ear again, at the end: so a long strip is cut in one round, and a round
    /// face into even triangles.
    fn round(&mut self) {
        let mut queue: VecDeque<_> = self.ring.corners().map(|corner| (corner, self.visits[corner])).collect();
        while let Some((corner, visit)) = queue.pop_front() {
            let stands = self.ring.left > 2 && self.ring.has(corner) && self.visits[corner] == visit;
            if stands && self.visit(corner) {
                let [before, _, after] = self.ring.triangle(corner);
                for neighbour in [before, after] {
                    self.visits[neighbour] += 1;
                    queue.push_back((neighbour, self.visits[neighbour]));
                }
            }
        }
    }

    /// Removes the corner if it is an ear or nothing at all.
    fn visit(&mut self, corner: usize) -> bool {
        let triangle = self.ring.triangle(corner);
        match self.ring.turn(corner) {
            Turn::Nothing => {
                self.ring.remove(corner);
                self.see_obstacles([triangle[0], triangle[2]]);
            }
            Turn::Left if self.is_free(triangle) => {
                self.triangles.push(triangle);
                self.ring.remove(corner);
            }
            Turn::Left | Turn::Other => return false,
        }
        true
    }

    /// Beside an ear a corner becomes convex sooner than it ceases to be; where a spike was, it may cease.
    fn see_obstacles(&mut self, corners: [usize; 2]) {
        for corner in corners {
            if self.ring.turn(corner) != Turn::Left {
                self.obstacles.insert(corner, self.points[corner]);
            }
        }
    }

    fn is_free(&self, triangle: [usize; 3]) -> bool {
        let mut near = self.obstacles.near(triangle.map(|corner| self.points[corner]));
        !near.any(|other| self.ring.forbids(other, triangle))
    }

    /// Cuts off the first convex corner whatever stands in it; without one, the fan of all that is left.
    fn force(&mut self) {
        let convex = self.ring.corners().find(|&corner| self.ring.turn(corner) == Turn::Left);
        match convex {
            Some(corner) => {
                self.triangles.push(self.ring.triangle(corner));
                self.ring.remove(corner);
            }
            None => {
                let rest: Vec<usize> = self.ring.corners().collect();
                self.triangles.extend(rest[1..].windows(2).map(|pair| [rest[0], pair[0], pair[1]]));
                self.ring.left = 0;
            }
        }
    }
}
