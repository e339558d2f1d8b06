//! Where a path hit a diffuse surface: the point, moved off the surface; the normal on the side the path came from; and
//! the throughput with the albedo taken in.

use super::{DIRECTION, DISTANCE, LEAVES, ORIGIN, PRIM, Stream, THROUGHPUT};
use crate::geometry::offset;
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;
use crate::scene::Scene;

/// A hit as shading sees it.
pub struct Hit<L: Lanes> {
    /// On the surface.
    pub point: V3<L>,
    /// Unit normal as the surface has it (outward on spheres).
    pub normal: V3<L>,
    /// Lanes in which the ray came from the side of the normal.
    pub outside: L::M,
    /// Colour of the material.
    pub colour: V3<L>,
    /// Surface id.
    pub surface: L::U,
    /// Largest coordinate that the point was made from: its error is relative to this.
    scale: L::F,
    /// How far rays may start off it, to the side of the normal and to the other, where something is near.
    room: Option<[L::F; 2]>,
}

impl<L: Lanes> Hit<L> {
    /// Where rays start that leave to the side of `side`, the normal or its opposite.
    #[inline(always)]
    pub fn leave(&self, l: L, side: V3<L>) -> V3<L> {
        let room = self.room.filter(|_| !mutant!("thin_panes_jumped_over"));
        let Some([outside, inside]) = room else { return offset::leave(l, self.point, self.scale, side) };
        let room = l.select(l.lt(l.f(0.0), side.dot(l, self.normal)), outside, inside);
        offset::leave_within(l, self.point, self.scale, room, side)
    }
}

/// The hits of a packet.
#[inline(always)]
pub fn hit<L: Lanes>(l: L, scene: &Scene, hits: &Stream, at: usize) -> Hit<L> {
    of(l, scene, hits, at, hits.u(l, PRIM, at))
}

/// The hits of the lanes `mask` of a packet; the others may have missed.
#[inline(always)]
pub fn hit_where<L: Lanes>(l: L, scene: &Scene, hits: &Stream, at: usize, mask: L::M) -> Hit<L> {
    of(l, scene, hits, at, l.select_u(mask, hits.u(l, PRIM, at), l.u(0)))
}

#[inline(always)]
fn of<L: Lanes>(l: L, scene: &Scene, hits: &Stream, at: usize, prim: L::U) -> Hit<L> {
    let [x, y, z, w, r, g, b, surface] = l.gather_record(&scene.shades, prim);
    let surface = l.bits(surface);
    let (origin, direction) = (hits.v3(l, ORIGIN, at), hits.v3(l, DIRECTION, at));
    let point = origin.along(l, hits.f(l, DISTANCE, at), direction);
    let geometry = V3::new(x, y, z);
    let is_sphere = !l.lt_u(surface, l.u(scene.planes));
    let (mut on_surface, mut normal) = (offset::onto_plane(l, point, geometry, w), geometry);
    let mut scale = on_surface.max_abs(l);
    if l.any(is_sphere) {
        let (on_sphere, outward) = offset::onto_sphere(l, point, geometry, w);
        on_surface = V3::select(l, is_sphere, on_sphere, on_surface);
        normal = V3::select(l, is_sphere, outward, normal);
        // A sphere's point is made from its centre, which may be far when the point is near the origin.
        scale = l.select(is_sphere, geometry.max_abs(l) + w, scale);
    }
    let outside = l.lt(normal.dot(l, direction), l.f(0.0));
    let room = scene.room.as_ref().map(
        #[inline(always)]
        |room| [l.gather(&room.outside, prim), l.gather(&room.inside, prim)],
    );
    Hit { point: on_surface, normal, outside, colour: V3::new(r, g, b), surface, scale, room }
}

/// The places on the surfaces of `prim` that lie beneath `point`, where rays leave them.
#[inline(always)]
pub fn beneath<L: Lanes>(l: L, scene: &Scene, prim: L::U, point: V3<L>) -> V3<L> {
    let [x, y, z, w, _, _, _, surface] = l.gather_record(&scene.shades, prim);
    let geometry = V3::new(x, y, z);
    let is_sphere = !l.lt_u(l.bits(surface), l.u(scene.planes));
    let on_plane = offset::onto_plane(l, point, geometry, w);
    if !l.any(is_sphere) {
        return on_plane;
    }
    V3::select(l, is_sphere, offset::onto_sphere(l, point, geometry, w).0, on_plane)
}

/// Turns the hits of a diffuse stream into vertices, in place.
#[inline(always)]
pub fn run<L: Lanes>(l: L, scene: &Scene, hits: &mut Stream) {
    for at in (0..hits.len()).step_by(L::WIDTH) {
        let hit = hit(l, scene, hits, at);
        let normal = V3::select(l, hit.outside, hit.normal, -hit.normal);
        hits.set_v3(l, ORIGIN, at, hit.leave(l, normal));
        hits.set_v3(l, DIRECTION, at, normal);
        hits.set_v3(l, THROUGHPUT, at, hits.v3(l, THROUGHPUT, at) * hit.colour);
        hits.set_u(l, LEAVES, at, hit.surface);
    }
}
