//! What each ray of the stream hits.

use super::{DIRECTION, DISTANCE, LEAVES, ORIGIN, PRIM, Stream};
use crate::accel::{Accel, Tracer};
use crate::geometry::Ray;
use crate::lanes::Lanes;
use crate::light::table::NO_SURFACE;
use crate::mutant::mutant;

/// The ray of every lane of a packet.
#[inline(always)]
pub fn ray<L: Lanes>(l: L, rays: &Stream, at: usize) -> Ray<L> {
    let leaves = if mutant!("any_positive_distance") { l.u(NO_SURFACE) } else { rays.u(l, LEAVES, at) };
    Ray::new(l, rays.v3(l, ORIGIN, at), rays.v3(l, DIRECTION, at), leaves)
}

/// Writes distance and primitive of every ray's nearest hit.
#[inline(always)]
pub fn run<L: Lanes>(l: L, accel: &Accel, rays: &mut Stream) {
    let mut tracer = Tracer::new(l, accel);
    for at in (0..rays.len()).step_by(L::WIDTH) {
        let (t, prim) = tracer.nearest(l, &ray(l, rays, at), rays.active(l, at));
        rays.set_f(l, DISTANCE, at, t);
        rays.set_u(l, PRIM, at, prim);
    }
}
