//! What leaves hold: up to eight triangles in columns, and other primitives one by one.

use super::WIDTH;
use crate::accel::MISS;
use crate::geometry::{Ray, grazing, polygon, ray, sphere};
use crate::lanes::{Lanes, One, V3};
use crate::light::table::NO_SURFACE;
use crate::scene::Scene;

/// Eight triangles in columns; unused lanes have no extent and are never hit.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Packet {
    /// `[corner][axis][triangle]`.
    corners: [[[f32; WIDTH]; 3]; 3],
    plane: [[f32; WIDTH]; 4],
    surface: [u32; WIDTH],
    prim: [u32; WIDTH],
}

impl Packet {
    pub fn new(scene: &Scene, prims: &[u32]) -> Self {
        let mut packet = Self {
            corners: [[[f32::NAN; WIDTH]; 3]; 3],
            plane: [[f32::NAN; WIDTH]; 4],
            surface: [NO_SURFACE; WIDTH],
            prim: [MISS; WIDTH],
        };
        for (lane, &prim) in prims.iter().enumerate() {
            let face = &scene.faces[prim as usize];
            for (k, &corner) in scene.face_corners(face).iter().enumerate() {
                for axis in 0..3 {
                    packet.corners[k][axis][lane] = scene.vertices[corner as usize][axis];
                }
            }
            for k in 0..4 {
                packet.plane[k][lane] = face.plane[k];
            }
            packet.surface[lane] = face.surface;
            packet.prim[lane] = prim;
        }
        packet
    }

    /// Distances of the eight triangles along a ray (the same in all lanes), and the lanes that are hit in front of
    /// the origin, up to and including `limit`; triangles on the surface that the ray leaves, or on `target`, are not.
    #[inline(always)]
    pub fn hits<L: Lanes>(&self, l: L, ray: &Ray<L>, limit: f32, target: u32) -> (L::F, L::M) {
        let [a, b, c] = [0, 1, 2].map(
            #[inline(always)]
            |k| self.corner(l, k),
        );
        let [pa, pb, pc] = [a, b, c].map(
            #[inline(always)]
            |corner| ray.project(l, corner),
        );
        let (ab, bc, ca) = (ray::edge(pa, pb), ray::edge(pb, pc), ray::edge(pc, pa));
        let zero = l.f(0.0);
        let left = l.le(zero, ab) & l.le(zero, bc) & l.le(zero, ca);
        let right = l.le(ab, zero) & l.le(bc, zero) & l.le(ca, zero);
        let surface = l.load_u(&self.surface);
        let inside = (left | right) & !(left & right) & !l.eq_u(surface, ray.leaves) & !l.eq_u(surface, l.u(target));
        if !l.any(inside) {
            return (zero, inside);
        }
        let [nx, ny, nz, offset] = [0, 1, 2, 3].map(
            #[inline(always)]
            |k| l.load(&self.plane[k]),
        );
        let plane = (V3::new(nx, ny, nz), offset);
        let (mut t, grazing) = polygon::distance(l, ray, plane.0, plane.1);
        let grazing = inside & grazing;
        if l.any(grazing) {
            let corners = |lane: usize| self.corners.iter().map(move |corner| corner.map(|axis| axis[lane]));
            let made_good = grazing::distance(l, ray, (t, grazing), plane, bounds(l, a, b, c), corners);
            t = l.select(grazing, made_good, t);
        }
        (t, inside & l.lt(zero, t) & l.le(t, l.f(limit)) & l.lt(t, l.f(f32::INFINITY)))
    }

    /// Primitive in a lane.
    pub fn prim(&self, lane: usize) -> u32 {
        self.prim[lane]
    }

    #[inline(always)]
    fn corner<L: Lanes>(&self, l: L, k: usize) -> V3<L> {
        V3::new(l.load(&self.corners[k][0]), l.load(&self.corners[k][1]), l.load(&self.corners[k][2]))
    }
}

#[inline(always)]
fn bounds<L: Lanes>(l: L, a: V3<L>, b: V3<L>, c: V3<L>) -> [V3<L>; 2] {
    let low = V3::new(l.min(a.x, l.min(b.x, c.x)), l.min(a.y, l.min(b.y, c.y)), l.min(a.z, l.min(b.z, c.z)));
    let high = V3::new(l.max(a.x, l.max(b.x, c.x)), l.max(a.y, l.max(b.y, c.y)), l.max(a.z, l.max(b.z, c.z)));
    [low, high]
}

/// A primitive that is not a triangle.
#[derive(Clone, Debug)]
pub struct Single {
    shape: Shape,
    surface: u32,
    prim: u32,
}

#[derive(Clone, Debug)]
enum Shape {
    Sphere([f32; 4]),
    Polygon { corners: Vec<[f32; 3]>, plane: [f32; 4], low: [f32; 3], high: [f32; 3] },
}

impl Single {
    pub fn new(scene: &Scene, prim: u32) -> Self {
        let surface = scene.shades[prim as usize][7].to_bits();
        let shape = match scene.faces.get(prim as usize) {
            None => Shape::Sphere(scene.spheres[prim as usize - scene.faces.len()]),
            Some(face) => {
                let corners = scene.face_corners(face).iter().map(|&corner| scene.vertices[corner as usize]).collect();
                let (low, high) = scene.bounds(prim);
                Shape::Polygon { corners, plane: face.plane, low, high }
            }
        };
        Self { shape, surface, prim }
    }

    /// Distance and primitive of the nearest hit; ∞ and [`MISS`] for none.
    pub fn nearest(&self, ray: &Ray<One>) -> (f32, u32) {
        let t = self.distance(ray);
        (t, if t < f32::INFINITY { self.prim } else { MISS })
    }

    /// Whether the ray is stopped in (0, 1) and `target` is not what stops it.
    pub fn occludes(&self, ray: &Ray<One>, target: u32) -> bool {
        if self.surface == target {
            return false;
        }
        match &self.shape {
            Shape::Sphere([x, y, z, r]) => {
                let leaves_it = ray.leaves == self.surface;
                sphere::stops(One, ray, inverse_square(ray), V3::new(*x, *y, *z), *r, leaves_it)
            }
            Shape::Polygon { .. } => self.distance(ray) < 1.0,
        }
    }

    fn distance(&self, ray: &Ray<One>) -> f32 {
        let leaves_it = ray.leaves == self.surface;
        match &self.shape {
            Shape::Sphere([x, y, z, r]) => {
                sphere::hit(One, ray, inverse_square(ray), V3::new(*x, *y, *z), *r, leaves_it)
            }
            Shape::Polygon { .. } if leaves_it => f32::INFINITY,
            Shape::Polygon { corners, plane: [nx, ny, nz, offset], low, high } => {
                if !polygon::passes(corners.iter().copied(), ray) {
                    return f32::INFINITY;
                }
                let plane = (V3::new(*nx, *ny, *nz), *offset);
                let (mut t, grazing) = polygon::distance(One, ray, plane.0, plane.1);
                if grazing {
                    let bounds = [*low, *high].map(|corner| V3::splat(One, corner));
                    t = grazing::distance(One, ray, (t, grazing), plane, bounds, |_| corners.iter().copied());
                }
                if t > 0.0 { t } else { f32::INFINITY }
            }
        }
    }
}

fn inverse_square(ray: &Ray<One>) -> f32 {
    1.0 / ray.direction.dot(One, ray.direction)
}
