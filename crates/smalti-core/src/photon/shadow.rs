//! Photons that go straight on through what they hit: what is behind it does not see their light.

use crate::accel::MISS;
use crate::lanes::{Lanes, V3};
use crate::scene::Scene;
use crate::stream::{DIRECTION, PRIM, Scattered, Stream, THROUGHPUT, surface};

/// Sends the photons that hit something on behind it.
#[inline(always)]
pub fn run<L: Lanes>(l: L, scene: &Scene, hits: &Stream, next: &mut Stream) {
    next.reserve(hits.len());
    for at in (0..hits.len()).step_by(L::WIDTH) {
        let active = hits.active(l, at) & !l.eq_u(hits.u(l, PRIM, at), l.u(MISS));
        if !l.any(active) {
            continue;
        }
        let hit = surface::hit_where(l, scene, hits, at, active);
        let behind = V3::select(l, hit.outside, -hit.normal, hit.normal);
        let rays = Scattered {
            origin: hit.leave(l, behind),
            direction: hits.v3(l, DIRECTION, at),
            throughput: hits.v3(l, THROUGHPUT, at),
            leaves: hit.surface,
            pdf: l.f(0.0),
            eta: l.f(1.0),
            medium: l.u(0),
        };
        next.scatter(l, hits, at, active, &rays);
    }
}
