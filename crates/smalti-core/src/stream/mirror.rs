//! Perfect reflection (report eq. 3).

use super::{DIRECTION, Scattered, Stream, THROUGHPUT, roulette, surface};
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;
use crate::sampling::{Purpose, pair};
use crate::scene::Scene;
use crate::settings::SamplerKind;

/// What ends a path that reflects less and less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// Roulette with numbers of this sampler.
    Roulette(SamplerKind),
    /// Dropped below this throughput (whitted).
    Threshold(f32),
}

/// Reflects the hits of a mirror stream into `next`.
#[inline(always)]
pub fn run<L: Lanes>(l: L, scene: &Scene, ending: Ending, bounce: u32, hits: &Stream, next: &mut Stream) {
    next.reserve(hits.len());
    for at in (0..hits.len()).step_by(L::WIDTH) {
        let hit = surface::hit(l, scene, hits, at);
        let incoming = hits.v3(l, DIRECTION, at);
        let arrives = hits.v3(l, THROUGHPUT, at);
        let throughput = if mutant!("mirrors_colourless") { arrives } else { arrives * hit.colour };
        let (survives, throughput) = match ending {
            Ending::Roulette(sampler) => {
                let (u, _) = pair(l, sampler, hits.keys(l, at), bounce, Purpose::Roulette);
                roulette::run(l, throughput, u)
            }
            Ending::Threshold(least) => (l.le(l.f(least), throughput.max_component(l)), throughput),
        };
        let side = V3::select(l, hit.outside, hit.normal, -hit.normal);
        let rays = Scattered {
            origin: hit.leave(l, side),
            direction: reflect(l, incoming, hit.normal),
            throughput,
            leaves: hit.surface,
            pdf: hits.specular_pdf(l, at),
            eta: hits.eta(l, at),
            medium: hits.medium(l, at),
        };
        next.scatter(l, hits, at, hits.active(l, at) & survives, &rays);
    }
}

/// The mirrored direction d − 2 (d·n) n, renormalised.
#[inline(always)]
pub fn reflect<L: Lanes>(l: L, direction: V3<L>, normal: V3<L>) -> V3<L> {
    let twice = normal.dot(l, direction) * l.f(-2.0);
    direction.along(l, twice, normal).normalised(l)
}
