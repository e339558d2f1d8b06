//! The part of two nearly parallel convex polygons in which they lie over each other.

use glam::{DVec2, DVec3};

use super::STEP;
use crate::scene::world::World;
use crate::scene::{Frame, Origin, newell};

/// Less than this part of the smaller one's area, and they are neighbours that share an edge.
const AREA: f64 = 1e-6;

/// What f64 makes of coordinates that were computed, by their size.
const WRITTEN: f64 = 4.0 * f64::EPSILON;

/// A convex polygon in the frame.
pub struct Corners {
    points: Vec<DVec3>,
    normal: DVec3,
    /// Largest coordinate as it was written, in the frame's unit.
    written: f64,
}

impl Corners {
    /// Those of a face of the world; a face without area has a normal of 0 and overlaps nothing.
    pub fn new(world: &World, frame: &Frame, face: Origin) -> Self {
        let corners = world.corners(face);
        let largest = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
        let points: Vec<DVec3> = corners.into_iter().map(|corner| frame.point(corner)).collect();
        let normal = if points.is_empty() { DVec3::ZERO } else { newell(&points).normalize_or_zero() };
        Self { points, normal, written: largest * frame.scale }
    }
}

/// How one polygon lies over another.
pub struct Overlap {
    /// Least and greatest height of the second over the first, along the first one's normal.
    pub heights: (f64, f64),
    /// Largest coordinate.
    pub size: f64,
    /// Rounding of coordinates across the plane.
    pub step: f64,
    /// Rounding of coordinates where they were written as f32.
    pub as_f32: f64,
    /// Whether both normals point to the same side.
    pub same_way: bool,
}

/// `None` where they do not overlap by an area.
pub fn of(a: &Corners, b: &Corners) -> Option<Overlap> {
    if a.normal == DVec3::ZERO || b.normal == DVec3::ZERO {
        return None;
    }
    let axis = dominant(a.normal);
    if is_beside(&a.points, &b.points, axis) || is_beside(&b.points, &a.points, axis) {
        return None;
    }
    let common = clipped(&a.points, &b.points, axis);
    let area = |points: &[DVec3]| if points.len() < 3 { 0.0 } else { newell(points).length() };
    if area(&common) <= AREA * area(&a.points).min(area(&b.points)) {
        return None;
    }
    let slope = a.normal.dot(b.normal);
    let height = |point: &DVec3| (b.points[0] - *point).dot(b.normal) / slope;
    let heights = common
        .iter()
        .map(height)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| (low.min(height), high.max(height)));
    let largest = common.iter().fold(DVec3::ZERO, |largest, point| largest.max(point.abs()));
    let written = a.written.max(b.written);
    let step = (STEP * a.normal.abs().dot(largest)).max(WRITTEN * written);
    Some(Overlap { heights, size: largest.max_element(), step, as_f32: STEP * written, same_way: slope > 0.0 })
}

fn dominant(normal: DVec3) -> usize {
    let size = normal.abs();
    (0..3).reduce(|a, b| if size[b] > size[a] { b } else { a }).unwrap_or(0)
}

fn flat(point: DVec3, axis: usize) -> DVec2 {
    DVec2::new(point[(axis + 1) % 3], point[(axis + 2) % 3])
}

/// Edges of a polygon, seen along an axis.
fn edges(points: &[DVec3], axis: usize) -> impl Iterator<Item = (DVec2, DVec2)> {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(move |(a, b)| (flat(*a, axis), flat(*b, axis)))
}

/// 1 where the corners go round to the left, seen along an axis, and -1 where they go to the right.
fn turn(points: &[DVec3], axis: usize) -> f64 {
    let first = flat(points[0], axis);
    edges(points, axis).map(|(a, b)| (a - first).perp_dot(b - first)).sum::<f64>().signum()
}

/// Whether all corners of `other` are beyond one edge, or on it: so it is with neighbours.
fn is_beside(points: &[DVec3], other: &[DVec3], axis: usize) -> bool {
    let turn = turn(points, axis);
    edges(points, axis).any(|(a, b)| other.iter().all(|point| turn * (b - a).perp_dot(flat(*point, axis) - a) <= 0.0))
}

/// `subject` (in its own plane) cut off along every edge of `by`, both seen along `axis` (Sutherland and Hodgman 1974).
fn clipped(subject: &[DVec3], by: &[DVec3], axis: usize) -> Vec<DVec3> {
    let turn = turn(by, axis);
    let mut left = subject.to_vec();
    for (a, b) in edges(by, axis) {
        let side = |point: DVec3| turn * (b - a).perp_dot(flat(point, axis) - a);
        let mut kept = Vec::with_capacity(left.len() + 1);
        for (from, to) in left.iter().zip(left.iter().cycle().skip(1)) {
            let (before, after) = (side(*from), side(*to));
            if before >= 0.0 {
                kept.push(*from);
            }
            if (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0) {
                kept.push(from.lerp(*to, before / (before - after)));
            }
        }
        left = kept;
    }
    left
}
