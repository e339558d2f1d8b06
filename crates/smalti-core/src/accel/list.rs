//! Every primitive of a small set against many rays at a time.
//!
//! Corners and edges are shared: each distinct corner is projected once and each distinct edge tested once for a packet
//! of rays, and a face is the conjunction of its edges. For the closed room of 28 triangles that is 20 corners and 28
//! edges instead of 84 each, and neighbouring faces agree about their common edge by construction.

use std::collections::HashMap;

use super::MISS;
use crate::geometry::{Ray, grazing, polygon, ray, sphere};
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;
use crate::scene::Scene;

/// Most corners, and most edges, that a list can hold: corners are numbered in 8 bits.
const CAPACITY: usize = 256;

/// A compiled list.
#[derive(Clone, Debug, Default)]
pub struct List {
    corners: Vec<[f32; 3]>,
    /// Pairs of corners, the lower one first.
    edges: Vec<[u8; 2]>,
    faces: Vec<ListFace>,
    /// Edge number × 2, + 1 where the face runs along it backwards.
    sides: Vec<u16>,
    spheres: Vec<ListSphere>,
}

#[derive(Clone, Debug)]
struct ListFace {
    plane: [f32; 4],
    surface: u32,
    prim: u32,
    sides: (u32, u32),
    low: [f32; 3],
    high: [f32; 3],
}

#[derive(Clone, Debug)]
struct ListSphere {
    geometry: [f32; 4],
    surface: u32,
    prim: u32,
}

/// Edge signs and projected corners of one packet of rays; made once for a stream.
struct Scratch<L: Lanes> {
    corners: Vec<(L::F, L::F)>,
    signs: Vec<(L::M, L::M)>,
}

impl List {
    /// A list of these primitives (in increasing order), or `None` where they are too many.
    pub fn new(scene: &Scene, prims: impl IntoIterator<Item = u32>) -> Option<Self> {
        let mut list = List::default();
        let mut corner_ids = HashMap::new();
        let mut edge_ids = HashMap::new();
        for prim in prims {
            match scene.faces.get(prim as usize) {
                Some(_) => list.add_face(scene, prim, &mut corner_ids, &mut edge_ids)?,
                None => list.spheres.push(ListSphere {
                    geometry: scene.spheres[prim as usize - scene.faces.len()],
                    surface: scene.shades[prim as usize][7].to_bits(),
                    prim,
                }),
            }
        }
        Some(list)
    }

    fn add_face(
        &mut self,
        scene: &Scene,
        prim: u32,
        corner_ids: &mut HashMap<u32, u8>,
        edge_ids: &mut HashMap<[u8; 2], u16>,
    ) -> Option<()> {
        let face = &scene.faces[prim as usize];
        let mut ids = Vec::new();
        for &corner in scene.face_corners(face) {
            let next = self.corners.len();
            ids.push(*corner_ids.entry(corner).or_insert(next as u8));
            if corner_ids.len() > next {
                self.corners.push(scene.vertices[corner as usize]);
            }
        }
        let first = self.sides.len() as u32;
        for (k, &a) in ids.iter().enumerate() {
            let b = ids[(k + 1) % ids.len()];
            let next = self.edges.len() as u16;
            let edge = *edge_ids.entry([a.min(b), a.max(b)]).or_insert(next);
            if edge == next {
                self.edges.push([a.min(b), a.max(b)]);
            }
            self.sides.push(edge * 2 + u16::from(a > b));
        }
        if self.corners.len() > CAPACITY || self.edges.len() > CAPACITY {
            return None;
        }
        let (low, high) = scene.bounds(prim);
        let sides = (first, self.sides.len() as u32);
        self.faces.push(ListFace { plane: face.plane, surface: face.surface, prim, sides, low, high });
        Some(())
    }

    /// Number of primitives.
    pub fn len(&self) -> usize {
        self.faces.len() + self.spheres.len()
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The primitives in it.
    pub fn prims(&self) -> impl Iterator<Item = u32> {
        self.faces.iter().map(|face| face.prim).chain(self.spheres.iter().map(|sphere| sphere.prim))
    }

    /// Buffers for the packets of one stream.
    #[inline(always)]
    fn scratch<L: Lanes>(&self, l: L) -> Scratch<L> {
        let corners = vec![(l.f(0.0), l.f(0.0)); self.corners.len()];
        Scratch { corners, signs: vec![(l.m(false), l.m(false)); self.edges.len()] }
    }

    /// Projects the corners and takes the signs of the edges.
    #[inline(always)]
    fn project<L: Lanes>(&self, l: L, ray: &Ray<L>, scratch: &mut Scratch<L>) {
        for (corner, projected) in self.corners.iter().zip(&mut scratch.corners) {
            *projected = ray.project(l, V3::splat(l, *corner));
        }
        let zero = l.f(0.0);
        for (edge, signs) in self.edges.iter().zip(&mut scratch.signs) {
            let [a, b] = edge.map(|i| scratch.corners[usize::from(i)]);
            let side = ray::edge(a, b);
            *signs = (l.le(zero, side), l.le(side, zero));
            if mutant!("open_edges") {
                *signs = (l.lt(zero, side), l.lt(side, zero));
            }
        }
    }

    /// Lanes whose ray (as a line) passes through the face: on one side of all edges, or on the other.
    #[inline(always)]
    fn inside<L: Lanes>(&self, face: &ListFace, scratch: &Scratch<L>, lanes: L::M) -> L::M {
        let (mut left, mut right) = (lanes, lanes);
        for side in &self.sides[face.sides.0 as usize..face.sides.1 as usize] {
            let (positive, negative) = scratch.signs[usize::from(side >> 1)];
            if side & 1 == 0 {
                left = left & positive;
                right = right & negative;
            } else {
                left = left & negative;
                right = right & positive;
            }
        }
        // Both: the ray runs in the plane of the face, where it hits nothing.
        (left | right) & !(left & right)
    }

    /// 1 / (d · d), where there are spheres to need it.
    #[inline(always)]
    fn inverse_square<L: Lanes>(&self, l: L, ray: &Ray<L>) -> L::F {
        if self.spheres.is_empty() { l.f(1.0) } else { l.f(1.0) / ray.direction.dot(l, ray.direction) }
    }

    /// Whether the face lies in (0, 1) for the lanes `inside`.
    #[inline(always)]
    fn face_stops<L: Lanes>(&self, l: L, ray: &Ray<L>, face: &ListFace, inside: L::M) -> L::M {
        let [nx, ny, nz, offset] = face.plane;
        let (within, grazing) = polygon::within(l, ray, V3::splat(l, [nx, ny, nz]), l.f(offset));
        if l.any(inside & grazing) {
            let t = self.face_distance(l, ray, face, inside);
            let clamped = l.lt(l.f(0.0), t) & l.lt(t, l.f(1.0));
            return (grazing & clamped) | (!grazing & within);
        }
        within
    }

    /// Distance to a face for the lanes `inside`.
    #[inline(always)]
    fn face_distance<L: Lanes>(&self, l: L, ray: &Ray<L>, face: &ListFace, inside: L::M) -> L::F {
        let [nx, ny, nz, offset] = face.plane;
        let plane = (V3::splat(l, [nx, ny, nz]), l.f(offset));
        let (t, grazing) = polygon::distance(l, ray, plane.0, plane.1);
        let grazing = inside & grazing;
        if l.any(grazing) {
            let bounds = [V3::splat(l, face.low), V3::splat(l, face.high)];
            let made_good = grazing::distance(l, ray, (t, grazing), plane, bounds, |_| self.corners_of(face));
            return l.select(grazing, made_good, t);
        }
        t
    }

    /// A face's corners in their order.
    fn corners_of(&self, face: &ListFace) -> impl Iterator<Item = [f32; 3]> {
        let sides = &self.sides[face.sides.0 as usize..face.sides.1 as usize];
        // The first of an edge's two corners, or the second where the face runs along it backwards.
        sides.iter().map(|side| self.corners[usize::from(self.edges[usize::from(side >> 1)][usize::from(side & 1)])])
    }
}

/// A stage's view of a list: its scratch, and the two questions.
pub struct Tracer<'a, L: Lanes> {
    list: &'a List,
    scratch: Scratch<L>,
}

impl<'a, L: Lanes> Tracer<'a, L> {
    /// For one stream.
    #[inline(always)]
    pub fn new(l: L, list: &'a List) -> Self {
        Self { list, scratch: list.scratch(l) }
    }

    /// Nearest hit in (0, ∞): distance and primitive ([`MISS`] and ∞ for none).
    #[inline(always)]
    pub fn nearest(&mut self, l: L, ray: &Ray<L>) -> (L::F, L::U) {
        self.list.project(l, ray, &mut self.scratch);
        let (mut best, mut prim) = (l.f(f32::INFINITY), l.u(MISS));
        let zero = l.f(0.0);
        for face in &self.list.faces {
            let elsewhere = !l.eq_u(ray.leaves, l.u(face.surface));
            let inside = self.list.inside(face, &self.scratch, elsewhere);
            if l.any(inside) {
                let t = self.list.face_distance(l, ray, face, inside);
                let nearest = if mutant!("tie_by_the_higher_index") { l.le(t, best) } else { l.lt(t, best) };
                let nearer = inside & l.lt(zero, t) & nearest;
                best = l.select(nearer, t, best);
                prim = l.select_u(nearer, l.u(face.prim), prim);
            }
        }
        let inverse = self.list.inverse_square(l, ray);
        for ball in &self.list.spheres {
            let t = ball.hit(l, ray, inverse);
            let nearer = l.lt(t, best);
            best = l.select(nearer, t, best);
            prim = l.select_u(nearer, l.u(ball.prim), prim);
        }
        (best, prim)
    }

    /// Which of `lanes` hit something in (0, 1) that is not `target`.
    #[inline(always)]
    pub fn occluded(&mut self, l: L, ray: &Ray<L>, target: L::U, lanes: L::M) -> L::M {
        self.list.project(l, ray, &mut self.scratch);
        let mut open = lanes;
        for face in &self.list.faces {
            let own = l.u(face.surface);
            let counts = open & !l.eq_u(ray.leaves, own) & !l.eq_u(target, own);
            // No branch on whether any lane is inside: it could not be predicted, and there is no division to save.
            let inside = self.list.inside(face, &self.scratch, counts);
            open = open & !(inside & self.list.face_stops(l, ray, face, inside));
        }
        let inverse = self.list.inverse_square(l, ray);
        for ball in &self.list.spheres {
            open = open & !(ball.stops(l, ray, inverse) & !l.eq_u(target, l.u(ball.surface)));
        }
        lanes & !open
    }
}

impl ListSphere {
    #[inline(always)]
    fn hit<L: Lanes>(&self, l: L, ray: &Ray<L>, inverse: L::F) -> L::F {
        let [x, y, z, r] = self.geometry;
        let leaves_it = l.eq_u(ray.leaves, l.u(self.surface));
        sphere::hit(l, ray, inverse, V3::splat(l, [x, y, z]), l.f(r), leaves_it)
    }

    #[inline(always)]
    fn stops<L: Lanes>(&self, l: L, ray: &Ray<L>, inverse: L::F) -> L::M {
        let [x, y, z, r] = self.geometry;
        let leaves_it = l.eq_u(ray.leaves, l.u(self.surface));
        sphere::stops(l, ray, inverse, V3::splat(l, [x, y, z]), l.f(r), leaves_it)
    }
}
