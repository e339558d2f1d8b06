//! Absorption on the way from one vertex to the next (Beer–Lambert): what a ray's throughput loses in the medium that it
//! travels in.

use super::{DISTANCE, MEDIUM, PRIM, Stream, THROUGHPUT};
use crate::accel::MISS;
use crate::lanes::Lanes;
use crate::scene::Media;

/// Takes from every ray what is absorbed up to its hit.
#[inline(always)]
pub fn run<L: Lanes>(l: L, media: &Media, rays: &mut Stream) {
    for at in (0..rays.len()).step_by(L::WIDTH) {
        let medium = l.select_u(rays.active(l, at), rays.u(l, MEDIUM, at), l.u(0));
        if !l.any(!l.eq_u(medium, l.u(0))) {
            continue;
        }
        // A ray that leaves for infinity out of a medium has found a hole in its boundary: nothing is left of it.
        let missed = l.eq_u(rays.u(l, PRIM, at), l.u(MISS));
        let far = l.select(missed, l.f(f32::MAX), rays.f(l, DISTANCE, at));
        let left = media.transmittance(l, medium, far);
        let throughput = rays.v3(l, THROUGHPUT, at) * left;
        rays.set_v3(l, THROUGHPUT, at, throughput);
        // What carries nothing any more goes nowhere; else total reflection could hold it for ever.
        let carries = l.lt(l.f(0.0), throughput.max_component(l));
        rays.set_u(l, PRIM, at, l.select_u(carries, rays.u(l, PRIM, at), l.u(MISS)));
    }
}
