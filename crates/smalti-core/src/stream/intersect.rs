//! What each ray of the stream hits.

use super::{DIRECTION, DISTANCE, LEAVES, ORIGIN, PRIM, Stream};
use crate::accel::{List, list::Tracer};
use crate::geometry::Ray;
use crate::lanes::Lanes;

/// The ray of every lane of a packet.
#[inline(always)]
pub fn ray<L: Lanes>(l: L, rays: &Stream, at: usize) -> Ray<L> {
    Ray::new(l, rays.v3(l, ORIGIN, at), rays.v3(l, DIRECTION, at), rays.u(l, LEAVES, at))
}

/// Nearest hits in the list.
#[inline(always)]
pub fn list<L: Lanes>(l: L, list: &List, rays: &mut Stream) {
    let mut tracer = Tracer::new(l, list);
    for at in (0..rays.len()).step_by(L::WIDTH) {
        let (t, prim) = tracer.nearest(l, &ray(l, rays, at));
        rays.set_f(l, DISTANCE, at, t);
        rays.set_u(l, PRIM, at, prim);
    }
}
