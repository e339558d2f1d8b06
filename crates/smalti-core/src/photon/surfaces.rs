//! Surfaces as photons see them: which faces are one surface, and where a surface ends.
//!
//! Photons of one surface count for each other: faces that share an edge and hardly bend there are one, a sphere is one.
//! Where a surface ends (at a free edge, or where it bends sharply) part of the disc in which photons are gathered lies
//! beyond it, and irradiance is flux by the rest: exact as long as the disc reaches over the edges of its own face only.

use std::collections::HashMap;

use glam::DVec3;

use super::Tag;
use crate::accel::cones::leader;
use crate::lanes::math::disc_segment;
use crate::lanes::{Lanes, V3};
use crate::sampling::warp;
use crate::scene::{Face, Scene};

/// Faces that bend less than this cosine across an edge are one surface.
const SMOOTH: f64 = 0.9;

/// Photons whose surface is turned further than this cosine do not count.
const ALIKE: f32 = 0.7;

/// Directions in which a disc that reaches over several edges is measured.
const DIRECTIONS: usize = 32;

/// Steps of a coordinate that a photon's radius has at least: below that places are too coarse.
pub const LEAST_STEPS: f32 = 32.0;

/// A step of coordinates, relative to them.
pub const STEP: f32 = 1.0 / 16_777_216.0;

/// Set in a group's number where the group is a sphere.
const SPHERE: u32 = 1 << 31;

/// What photons need to know of the primitives.
#[derive(Clone, Debug, Default)]
pub struct Surfaces {
    /// For each primitive its normal, or centre, and the number of its group (bits).
    records: Vec<[f32; 4]>,
    /// Borders of faces: a unit vector m in the face, across the border and into the face, and o: m·x ≥ o inside.
    borders: Vec<[f32; 4]>,
    /// First border of each primitive, and the end of the last.
    first: Vec<u32>,
    /// For each primitive the least radius that its places allow (of faces by the place alone: 0), and the largest over
    /// which it is about flat.
    limits: Vec<[f32; 2]>,
    /// Cosine and sine of directions all around.
    directions: Vec<[f32; 2]>,
}

/// The surface that a primitive is part of.
#[derive(Clone, Copy)]
pub struct Group<L: Lanes> {
    /// Number, the same for all its primitives.
    pub number: L::U,
    /// Normal of the primitive; the centre of a sphere.
    pub normal: V3<L>,
}

impl Surfaces {
    /// The surfaces of a scene.
    pub fn new(scene: &Scene) -> Self {
        let edges = edges(scene);
        let mut leaders: Vec<u32> = (0..scene.shades.len() as u32).collect();
        let mut limits: Vec<[f32; 2]> = (0..scene.shades.len()).map(|prim| limits(scene, prim)).collect();
        for (a, b) in edges.iter().flat_map(|(edge, faces)| smooth_pairs(scene, *edge, faces)) {
            let flat = 0.5 * curvature_radius(scene, a, b) as f32;
            [a, b].into_iter().for_each(|face| limits[face as usize][1] = limits[face as usize][1].min(flat));
            let (a, b) = (leader(&mut leaders, a), leader(&mut leaders, b));
            leaders[a.max(b) as usize] = a.min(b);
        }
        let mut surfaces = Self { first: vec![0], limits, directions: directions(), ..Self::default() };
        for prim in 0..scene.shades.len() as u32 {
            let group = leader(&mut leaders, prim);
            let [x, y, z, ..] = scene.shades[prim as usize];
            let kind = if (prim as usize) < scene.faces.len() { 0 } else { SPHERE };
            surfaces.records.push([x, y, z, f32::from_bits(group | kind)]);
            surfaces.borders.extend(borders(scene, prim, &edges));
            surfaces.first.push(surfaces.borders.len() as u32);
        }
        surfaces
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        (self.records.len() * 24 + self.borders.len() * 16 + self.first.len() * 4) as u64
    }

    /// Number of primitives.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Whether there is no primitive.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// The number of the surface of a primitive.
    pub fn number(&self, prim: u32) -> u32 {
        self.records[prim as usize][3].to_bits()
    }

    /// The least radius of a photon at `point` on `prim`, by the steps of its coordinates, and the largest, over which the
    /// surface is about flat.
    #[inline(always)]
    pub fn radii<L: Lanes>(&self, l: L, prim: L::U, point: V3<L>) -> [L::F; 2] {
        let [least, most] = l.gather_record(&self.limits, prim);
        [l.max(least, point.max_abs(l) * l.f(LEAST_STEPS * STEP)), most]
    }

    /// The surface of a primitive.
    #[inline(always)]
    pub fn group<L: Lanes>(&self, l: L, prim: L::U) -> Group<L> {
        let [x, y, z, number] = l.gather_record(&self.records, prim);
        Group { number: l.bits(number), normal: V3::new(x, y, z) }
    }

    /// The surface of a primitive, and the tag of photons on it that are on the side of the normal of `place` (a point and
    /// its normal).
    #[inline(always)]
    pub fn side<L: Lanes>(&self, l: L, prim: L::U, place: (V3<L>, V3<L>)) -> (Group<L>, L::U) {
        let group = self.group(l, prim);
        let outside = self.is_outside(l, &group, place);
        (group, prim | l.select_u(outside, l.u(Tag::OUTSIDE), l.u(0)))
    }

    /// Lanes where `normal` at `point` is on the side of the primitive's own normal.
    #[inline(always)]
    fn is_outside<L: Lanes>(&self, l: L, group: &Group<L>, (point, normal): (V3<L>, V3<L>)) -> L::M {
        let is_sphere = l.lt_u(l.u(SPHERE - 1), group.number);
        let own = V3::select(l, is_sphere, point - group.normal, group.normal);
        l.lt(l.f(0.0), normal.dot(l, own))
    }

    /// Whether a photon lies on the surface `group`, on a face that is turned about as `normal` (on the side that asks).
    #[inline(always)]
    pub fn alike<L: Lanes>(&self, l: L, tag: Tag, group: L::U, normal: V3<L>) -> L::M {
        let [x, y, z, number] = self.records[tag.prim() as usize];
        let turned = V3::splat(l, [x, y, z]).dot(l, normal);
        // All of a sphere is one primitive: what lies on another side of it does not count.
        let same = l.eq_u(group, l.u(number.to_bits())) & l.lt_u(group, l.u(SPHERE));
        same & l.le(l.f(ALIKE), if tag.outside() { turned } else { -turned })
    }

    /// The part in (0, 1] of the disc of `radius` about `point` that lies on the face `prim`'s surface.
    #[inline(always)]
    pub fn part_of_disc<L: Lanes>(&self, l: L, asks: L::M, prim: L::U, point: V3<L>, radius: L::F) -> L::F {
        let prim = l.select_u(asks, prim, l.u(0));
        let first = l.gather_u(&self.first, prim);
        let end = l.gather_u(&self.first, l.add_u(prim, l.u(1)));
        let one = l.f(1.0);
        let (mut part, mut near, mut several) = (one, l.m(false), l.m(false));
        let mut at = first;
        let mut left = asks & l.lt_u(at, end);
        while l.any(left) {
            let cut = self.border(l, left, at, (point, radius)).distance;
            let reaches = left & l.lt(cut, one);
            several = several | (near & reaches);
            near = near | reaches;
            part = l.select(reaches, part * (one - disc_segment(l, cut)), part);
            at = l.add_u(at, l.u(1));
            left = left & l.lt_u(at, end);
        }
        if l.any(several) {
            part = l.select(several, self.corner(l, (several, prim), (first, end), (point, radius)), part);
        }
        part
    }

    /// How far the nearest border of the face `prim` is from each point; infinite where there is none.
    #[inline(always)]
    pub fn distance_to_border<L: Lanes>(&self, l: L, asks: L::M, prim: L::U, point: V3<L>) -> L::F {
        let prim = l.select_u(asks, prim, l.u(0));
        let (mut at, end) = (l.gather_u(&self.first, prim), l.gather_u(&self.first, l.add_u(prim, l.u(1))));
        let mut nearest = l.f(f32::INFINITY);
        let mut left = asks & l.lt_u(at, end);
        while l.any(left) {
            let distance = self.border(l, left, at, (point, l.f(1.0))).distance;
            nearest = l.select(left, l.min(nearest, distance), nearest);
            at = l.add_u(at, l.u(1));
            left = left & l.lt_u(at, end);
        }
        nearest
    }

    /// A border as seen from a point: how far it is in units of the radius, at least 0, and where it lies.
    #[inline(always)]
    fn border<L: Lanes>(&self, l: L, asks: L::M, at: L::U, (point, radius): (V3<L>, L::F)) -> Border<L> {
        let [x, y, z, offset] = l.gather_record(&self.borders, l.select_u(asks, at, l.u(0)));
        let inward = V3::new(x, y, z);
        let distance = (inward.dot(l, point) - offset) / radius;
        Border { distance: l.max(distance, l.f(0.0)), inward }
    }

    /// The part of a disc that reaches over several borders: the mean over directions of the squared distance to where
    /// the disc or the surface ends.
    #[inline(always)]
    fn corner<L: Lanes>(
        &self,
        l: L,
        (asks, prim): (L::M, L::U),
        (first, end): (L::U, L::U),
        place: (V3<L>, L::F),
    ) -> L::F {
        let (one, zero) = (l.f(1.0), l.f(0.0));
        let normal = self.group(l, prim).normal;
        let first_axis = warp::about(l, normal, V3::new(one, zero, zero));
        let second_axis = warp::about(l, normal, V3::new(zero, one, zero));
        let mut squares = [one; DIRECTIONS];
        let (mut at, mut left) = (first, asks & l.lt_u(first, end));
        while l.any(left) {
            let Border { distance, inward } = self.border(l, left, at, place);
            let (across, along) = (first_axis.dot(l, inward), second_axis.dot(l, inward));
            for (square, [cosine, sine]) in squares.iter_mut().zip(&self.directions) {
                let outward = -l.mul_add(across, l.f(*cosine), along * l.f(*sine));
                let reach = distance / outward;
                let ends = left & l.lt(zero, outward) & l.lt(reach * reach, *square);
                *square = l.select(ends, reach * reach, *square);
            }
            at = l.add_u(at, l.u(1));
            left = left & l.lt_u(at, end);
        }
        let mut sum = zero;
        for square in squares {
            sum = sum + square;
        }
        // A wedge narrower than the directions is still something.
        l.max(sum, one) * l.f(1.0 / DIRECTIONS as f32)
    }
}

/// The limits of a primitive by itself: a disc with a radius up to half of a sphere's own lies within a quarter of it on
/// the sphere, and has its area.
fn limits(scene: &Scene, prim: usize) -> [f32; 2] {
    if prim < scene.faces.len() {
        return [0.0, f32::INFINITY];
    }
    let [x, y, z, radius, ..] = scene.shades[prim];
    let largest = [x, y, z].map(f32::abs).into_iter().fold(0.0, f32::max) + radius;
    [largest * LEAST_STEPS * STEP, 0.5 * radius]
}

/// The radius of the sphere on which two neighbouring faces lie about: the distance of their middles by the difference of
/// their normals.
fn curvature_radius(scene: &Scene, a: u32, b: u32) -> f64 {
    let middle = |prim: u32| {
        let corners = scene.face_corners(&scene.faces[prim as usize]);
        corners.iter().map(|corner| point(scene, *corner)).sum::<DVec3>() / corners.len() as f64
    };
    let turned = (normal(scene, a) - normal(scene, b)).length().min((normal(scene, a) + normal(scene, b)).length());
    middle(a).distance(middle(b)) / turned
}

/// A border as seen from a point.
struct Border<L: Lanes> {
    distance: L::F,
    inward: V3<L>,
}

/// The directions in which a disc is measured.
fn directions() -> Vec<[f32; 2]> {
    let turn = |k: usize| 2.0 * core::f64::consts::PI * (k as f64 + 0.5) / DIRECTIONS as f64;
    (0..DIRECTIONS).map(turn).map(|angle| [libm::cos(angle) as f32, libm::sin(angle) as f32]).collect()
}

/// An edge by the numbers of its corners, the lower one first.
type Edge = (u32, u32);

/// The faces at each edge.
fn edges(scene: &Scene) -> HashMap<Edge, Vec<u32>> {
    let mut edges: HashMap<Edge, Vec<u32>> = HashMap::new();
    for (prim, face) in (0..).zip(&scene.faces) {
        for (a, b) in corner_pairs(scene, face) {
            edges.entry((a.min(b), a.max(b))).or_default().push(prim);
        }
    }
    edges
}

/// The corners of a face, each with the next one.
fn corner_pairs<'s>(scene: &'s Scene, face: &Face) -> impl Iterator<Item = (u32, u32)> + 's {
    let corners = scene.face_corners(face);
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| (*a, *b))
}

/// Pairs of faces that hardly bend across an edge that both have.
fn smooth_pairs(scene: &Scene, edge: Edge, faces: &[u32]) -> Vec<(u32, u32)> {
    let pairs = faces.iter().enumerate().flat_map(|(k, a)| faces[..k].iter().map(|b| (*a, *b)));
    pairs.filter(|(a, b)| is_smooth(scene, edge, (*a, *b))).collect()
}

/// Whether a surface goes on across an edge from one face to another: whichever sides they show, they must lie on
/// opposite sides of it. The faces of a blade lie on the same.
fn is_smooth(scene: &Scene, edge: Edge, (a, b): (u32, u32)) -> bool {
    inward(scene, a, edge).dot(inward(scene, b, edge)) <= -SMOOTH
}

/// Unit vector in a face, across one of its edges and into the face.
fn inward(scene: &Scene, prim: u32, (a, b): Edge) -> DVec3 {
    let along = (point(scene, b) - point(scene, a)).normalize_or_zero();
    let turned = corner_pairs(scene, &scene.faces[prim as usize]).any(|pair| pair == (b, a));
    normal(scene, prim).cross(if turned { -along } else { along })
}

fn point(scene: &Scene, corner: u32) -> DVec3 {
    DVec3::from_array(scene.vertices[corner as usize].map(f64::from))
}

fn normal(scene: &Scene, prim: u32) -> DVec3 {
    let [x, y, z, _] = scene.faces[prim as usize].plane.map(f64::from);
    DVec3::new(x, y, z)
}

/// The borders of a primitive: the edges across which its surface does not go on.
fn borders(scene: &Scene, prim: u32, edges: &HashMap<Edge, Vec<u32>>) -> Vec<[f32; 4]> {
    let Some(face) = scene.faces.get(prim as usize) else { return Vec::new() };
    let goes_on = |(a, b): &Edge| {
        let edge = (*a.min(b), *a.max(b));
        edges[&edge].iter().any(|other| *other != prim && is_smooth(scene, edge, (prim, *other)))
    };
    let border = |edge: Edge| {
        let inward = inward(scene, prim, edge);
        let offset = inward.dot(point(scene, edge.0));
        [inward.x as f32, inward.y as f32, inward.z as f32, offset as f32]
    };
    corner_pairs(scene, face).filter(|edge| !goes_on(edge)).map(border).collect()
}
