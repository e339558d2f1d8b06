//! Cones that hold whatever can stop a shadow ray from a point: they clear most shadow rays in a few operations each.
//!
//! Occluders fall into parts (a sphere; faces that hang together by their corners), and each part has a bounding sphere.
//! From a point outside it, only directions within a cone about its centre can meet it. Rays outside all cones are
//! free; the others have to be traced. The parts are those of the scene, whatever accelerator holds them, so that which
//! rays are traced, and in which order light is summed, does not depend on it.

use crate::lanes::{Lanes, V3};
use crate::scene::Scene;

/// Most parts that are told apart; more are taken as one.
const MOST_PARTS: usize = 128;

/// Bounding spheres of the parts of a set of occluders.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Centre and radius.
    spheres: Vec<[f32; 4]>,
}

impl Parts {
    /// The parts of these primitives, given in increasing order.
    pub fn new(scene: &Scene, prims: &[u32]) -> Self {
        let (faces, spheres) = prims.split_at(prims.partition_point(|prim| (*prim as usize) < scene.faces.len()));
        let mut parts: Vec<[f32; 4]> =
            spheres.iter().map(|prim| scene.spheres[*prim as usize - scene.faces.len()]).collect();
        parts.extend(hanging_together(scene, faces).into_iter().map(|corners| around(&corners, &[])));
        if parts.len() > MOST_PARTS {
            parts = vec![around(&[], &parts)];
        }
        Self { spheres: parts }
    }

    /// Their spheres: centre and radius.
    pub fn spheres(&self) -> &[[f32; 4]] {
        &self.spheres
    }

    /// Number of parts.
    pub fn len(&self) -> usize {
        self.spheres.len()
    }

    /// Whether nothing can stop a ray.
    pub fn is_empty(&self) -> bool {
        self.spheres.is_empty()
    }
}

/// Corners of the faces, grouped by the faces that share corners.
fn hanging_together(scene: &Scene, faces: &[u32]) -> Vec<Vec<[f32; 3]>> {
    let mut leaders: Vec<u32> = (0..scene.vertices.len() as u32).collect();
    for prim in faces {
        let corners = scene.face_corners(&scene.faces[*prim as usize]);
        for corner in &corners[1..] {
            let (a, b) = (leader(&mut leaders, corners[0]), leader(&mut leaders, *corner));
            leaders[a.max(b) as usize] = a.min(b);
        }
    }
    let mut used: Vec<u32> =
        faces.iter().flat_map(|prim| scene.face_corners(&scene.faces[*prim as usize])).copied().collect();
    used.sort_unstable();
    used.dedup();
    let mut groups = std::collections::BTreeMap::<u32, Vec<[f32; 3]>>::new();
    for corner in used {
        groups.entry(leader(&mut leaders, corner)).or_default().push(scene.vertices[corner as usize]);
    }
    groups.into_values().collect()
}

/// The lowest number of the group that a number is in; `leaders` points each to a lower one of its group, or to itself.
pub(crate) fn leader(leaders: &mut [u32], mut corner: u32) -> u32 {
    while leaders[corner as usize] != corner {
        leaders[corner as usize] = leaders[leaders[corner as usize] as usize];
        corner = leaders[corner as usize];
    }
    corner
}

/// A sphere around points and spheres: not the smallest, but about the middle of their box.
fn around(points: &[[f32; 3]], spheres: &[[f32; 4]]) -> [f32; 4] {
    let balls = || points.iter().map(|[x, y, z]| [*x, *y, *z, 0.0]).chain(spheres.iter().copied());
    let mut centre = [0.0; 3];
    for (k, middle) in centre.iter_mut().enumerate() {
        let low = balls().map(|ball| ball[k] - ball[3]).fold(f32::INFINITY, f32::min);
        let high = balls().map(|ball| ball[k] + ball[3]).fold(f32::NEG_INFINITY, f32::max);
        *middle = (low + high) / 2.0;
    }
    let reach = |[x, y, z, r]: [f32; 4]| {
        let across = [(x, 0), (y, 1), (z, 2)].map(|(x, k)| f64::from(x) - f64::from(centre[k]));
        across.iter().map(|d| d * d).sum::<f64>().sqrt() + f64::from(r)
    };
    let radius = balls().map(reach).fold(0.0, f64::max);
    [centre[0], centre[1], centre[2], (radius as f32).next_up()]
}

/// A packet's values, on a cache line of their own.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Line([f32; 16]);

/// The cones in which a packet of points sees the parts.
pub struct Cones<'a> {
    parts: &'a Parts,
    /// For each part: the axis (3), from the point to the centre, and |axis|² cos² of the cone's half angle, −∞ where
    /// the point is inside the sphere.
    cones: Vec<[Line; 4]>,
}

impl<'a> Cones<'a> {
    /// Room for a packet.
    pub fn new(parts: &'a Parts) -> Self {
        Self { parts, cones: vec![[Line([0.0; 16]); 4]; parts.len()] }
    }

    /// Looks at the parts from the points of a packet.
    #[inline(always)]
    pub fn look_from<L: Lanes>(&mut self, l: L, point: V3<L>) {
        for ([x, y, z, radius], cone) in self.parts.spheres.iter().zip(&mut self.cones) {
            let axis = V3::splat(l, [*x, *y, *z]) - point;
            // Room for the rounding of coordinates (which are within 1) and of hits in them.
            let radius = radius * 1.0001 + 1e-5;
            let squared = axis.dot(l, axis);
            let cosine = squared * l.f(1.0 - 4e-6) - l.f(radius * radius);
            let outside = l.lt(l.f(0.0), cosine);
            let values = [axis.x, axis.y, axis.z, l.select(outside, cosine, l.f(f32::NEG_INFINITY))];
            for (value, line) in values.into_iter().zip(cone) {
                l.store(value, &mut line.0);
            }
        }
    }

    /// Lanes whose ray along `reach` may meet a part.
    #[inline(always)]
    pub fn may_stop<L: Lanes>(&self, l: L, reach: V3<L>) -> L::M {
        let squared = reach.dot(l, reach);
        let mut may = l.m(false);
        for [x, y, z, cosine] in &self.cones {
            let along = V3::new(l.load(&x.0), l.load(&y.0), l.load(&z.0)).dot(l, reach);
            may = may | l.lt(l.load(&cosine.0) * squared, along * l.abs(along));
        }
        may
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Ray, sphere};
    use crate::lanes::One;
    use crate::light::table::NO_SURFACE;

    /// Rays past spheres of all sizes, most aimed near a silhouette: (stopped, doubtful, by how much the line misses
    /// the sphere in units of the coordinates' size).
    fn rays(count: usize) -> Vec<(bool, bool, f64)> {
        let mut state = 1u32;
        let mut number = || {
            state = crate::sampling::sampler::mix(state.wrapping_add(0x9e37_79b9));
            (state >> 8) as f32 / 8_388_608.0 - 1.0
        };
        let one = |number: &mut dyn FnMut() -> f32| V3::<One>::new(number(), number(), number());
        (0..count)
            .map(|_| {
                let (from, centre) = (one(&mut number), one(&mut number));
                let radius = (number() * 6.0 - 6.0).exp2();
                let beside = one(&mut number).normalised(One).scale(radius * (1.2 + number()));
                let reach = (centre + beside - from).scale(1.5 + number());
                let ray = Ray::new(One, from, reach, NO_SURFACE);
                let inverse = 1.0 / reach.dot(One, reach);
                let stopped = sphere::stops(One, &ray, inverse, centre, radius, false);
                let parts = Parts { spheres: vec![[centre.x, centre.y, centre.z, radius]] };
                let mut cones = Cones::new(&parts);
                cones.look_from(One, from);
                (stopped, cones.may_stop(One, reach), miss(from, reach, centre, radius))
            })
            .collect()
    }

    fn miss(from: V3<One>, reach: V3<One>, centre: V3<One>, radius: f32) -> f64 {
        let vector = |v: V3<One>| glam::DVec3::new(v.x.into(), v.y.into(), v.z.into());
        let (axis, direction) = (vector(centre) - vector(from), vector(reach).normalize());
        let (across, outside) = (axis.cross(direction).length(), axis.length() - f64::from(radius));
        if axis.dot(direction) < 0.0 { outside } else { across - f64::from(radius) }
    }

    #[test]
    fn a_cleared_ray_is_not_stopped() {
        let rays = rays(300_000);
        assert!(rays.iter().all(|(stopped, doubtful, _)| *doubtful || !stopped));
        assert!(rays.iter().filter(|(stopped, ..)| *stopped).count() > 50_000);
    }

    #[test]
    fn what_passes_clearly_is_cleared() {
        let clear: Vec<_> = rays(300_000).into_iter().filter(|(.., miss)| *miss > 0.02).collect();
        assert!(clear.len() > 20_000 && clear.iter().all(|(_, doubtful, _)| !doubtful), "{}", clear.len());
    }
}
