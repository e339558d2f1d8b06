//! The diffuse bounce: roulette, then a cosine-distributed direction (report eq. 12, with two independent numbers).

use super::{DIRECTION, LEAVES, ORIGIN, Scattered, Stream, THROUGHPUT, roulette};
use crate::lanes::Lanes;
use crate::sampling::{Purpose, pair, warp};
use crate::settings::SamplerKind;

/// Scatters the vertices of a diffuse stream into `next`.
#[inline(always)]
pub fn run<L: Lanes>(l: L, sampler: SamplerKind, bounce: u32, vertices: &Stream, next: &mut Stream) {
    next.reserve(vertices.len());
    for at in (0..vertices.len()).step_by(L::WIDTH) {
        let keys = vertices.keys(l, at);
        let (u, _) = pair(l, sampler, keys, bounce, Purpose::Roulette);
        let (survives, throughput) = roulette::run(l, vertices.v3(l, THROUGHPUT, at), u);
        let (u, v) = pair(l, sampler, keys, bounce, Purpose::Bsdf);
        let normal = vertices.v3(l, DIRECTION, at);
        let local = warp::cosine_hemisphere(l, u, v);
        let direction = warp::about(l, normal, local).normalised(l);
        let rays = Scattered {
            origin: vertices.v3(l, ORIGIN, at),
            direction,
            throughput,
            leaves: vertices.u(l, LEAVES, at),
            pdf: warp::cosine_hemisphere_pdf(l, local.z),
            eta: vertices.eta(l, at),
            medium: vertices.medium(l, at),
        };
        next.scatter(l, vertices, at, vertices.active(l, at) & survives, &rays);
    }
}
