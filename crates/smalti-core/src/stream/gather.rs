//! Light from photon maps at diffuse vertices.
//!
//! [`caustic`] adds, at a path's first diffuse vertex, what left a light for specular surfaces first (L S+ D), and what
//! diffuse surfaces make of that before it comes there: a bright spot under glass is a light of its own, and chance
//! finds it as seldom. What the map holds is not found a second time: later vertices do not ask, and emission after a
//! diffuse and then only specular bounces does not count for lights that are in the map (see
//! [`emission`](super::emission)). Where a final gather follows, it finds what goes on from caustics. [`last`] adds all light where a path ends at its second diffuse vertex (the final
//! gather of Jensen's second pass). [`shown`] ends them at the first, so that the map itself is seen.
//!
//! Most vertices see little caustic light, and a query costs as much as a bounce. So a vertex asks with a chance in
//! proportion to what it may expect, and counts accordingly more: unbiased whatever was expected, and as no contribution
//! is then much larger than `CERTAIN` allows, with hardly any noise.

use core::f32::consts::FRAC_1_PI;

use super::{DIRECTION, ORIGIN, PRIM, SLOT, Slots, Stream, THROUGHPUT, surface};
use crate::lanes::{Lanes, V3};
use crate::photon::gather::{Gather, Query};
use crate::photon::pilot::Pilot;
use crate::photon::{Quantity, SUB_MAPS};
use crate::sampling::{Purpose, pair};
use crate::scene::Scene;
use crate::settings::SamplerKind;

/// The least chance with which a vertex asks for caustics.
///
/// With the reference room's error × time at 400 × 400 and 1 s, 1/16 is 5 % worse, 1/64 no better.
const LEAST_CHANCE: f32 = 1.0 / 32.0;

/// Contributions of this many times the scene's reference brightness are always asked for. 8 and 64 are worse.
const CERTAIN: f32 = 16.0;

/// What the stages need to know.
pub struct Context<'a> {
    /// The map.
    pub gather: Gather<'a>,
    /// What to expect of it.
    pub pilot: &'a Pilot,
    /// The scene.
    pub scene: &'a Scene,
    /// A brightness that is typical of the scene.
    pub reference: f32,
    /// Where numbers come from.
    pub sampler: SamplerKind,
}

/// Adds the caustic light of every vertex of the stream. `asking` is a stream to work with.
#[inline(always)]
pub fn caustic<L: Lanes>(
    l: L,
    context: &Context<'_>,
    bounce: u32,
    vertices: &Stream,
    asking: &mut Stream,
    slots: &mut Slots,
) {
    asking.clear();
    asking.reserve(vertices.len());
    for at in (0..vertices.len()).step_by(L::WIDTH) {
        // What comes by another diffuse vertex is in the map as well, or behind a final gather.
        let first = vertices.active(l, at) & l.eq(vertices.pdf(l, at), l.f(0.0));
        if !l.any(first) {
            continue;
        }
        let counts = counts(l, vertices, at);
        let prim = l.select_u(first, vertices.u(l, PRIM, at), l.u(0));
        let expected = context.pilot.expected(l, prim, vertices.v3(l, ORIGIN, at));
        let chance = expected * counts.max_component(l) * l.f(1.0 / (CERTAIN * context.reference));
        let chance = l.min(l.max(chance, l.f(LEAST_CHANCE)), l.f(1.0));
        let (u, _) = pair(l, context.sampler, vertices.keys(l, at), bounce, Purpose::Gather);
        let asks = first & l.lt(u, chance);
        if l.any(asks) {
            ask(l, (vertices, at), asks, counts.scale(l.f(1.0) / chance), asking);
        }
    }
    answer(l, context, asking, slots);
}

/// Ends the paths whose last bounces were not all specular: adds all light that their vertices reflect. The others stay
/// in `vertices`. `asking` and `first` are streams to work with.
#[inline(always)]
pub fn last<L: Lanes>(
    l: L,
    context: &Context<'_>,
    vertices: &mut Stream,
    (asking, first): (&mut Stream, &mut Stream),
    slots: &mut Slots,
) {
    for stream in [&mut *asking, &mut *first] {
        stream.clear();
        stream.reserve(vertices.len());
    }
    for at in (0..vertices.len()).step_by(L::WIDTH) {
        let (active, seen) = (vertices.active(l, at), l.eq(vertices.pdf(l, at), l.f(0.0)));
        if l.any(active & seen) {
            first.push_from(l, vertices, at, active & seen);
        }
        if l.any(active & !seen) {
            ask(l, (vertices, at), active & !seen, counts(l, vertices, at), asking);
        }
    }
    core::mem::swap(vertices, first);
    answer(l, context, asking, slots);
}

/// Ends all paths at their vertices: adds what `quantity` says of the photons there. Each asks one of the map's `trees`,
/// and what it says counts `factor` times.
#[inline(always)]
pub fn shown<L: Lanes>(
    l: L,
    context: &Context<'_>,
    (quantity, trees, factor): (Quantity, u32, f32),
    vertices: &Stream,
    slots: &mut Slots,
) {
    for at in (0..vertices.len()).step_by(L::WIDTH) {
        let asks = vertices.active(l, at);
        let own = query(l, context, vertices, at, asks);
        let query = Query { sub_map: l.shr_by(own.sub_map, (SUB_MAPS / trees).ilog2()), ..own };
        let counts = match quantity {
            Quantity::Radiance => counts(l, vertices, at).scale(l.f(factor)),
            Quantity::Count => V3::splat(l, [factor; 3]),
        };
        slots.add(l, asks, vertices.u(l, SLOT, at), counts * context.gather.irradiance(l, &query).irradiance);
    }
}

/// What irradiance at the vertices of a packet counts for in their slots.
#[inline(always)]
fn counts<L: Lanes>(l: L, vertices: &Stream, at: usize) -> V3<L> {
    vertices.v3(l, THROUGHPUT, at).scale(vertices.eta(l, at) * l.f(FRAC_1_PI))
}

/// Pushes vertices that ask, with what irradiance counts for.
#[inline(always)]
fn ask<L: Lanes>(l: L, (vertices, at): (&Stream, usize), asks: L::M, counts: V3<L>, asking: &mut Stream) {
    let (point, normal) = (vertices.v3(l, ORIGIN, at), vertices.v3(l, DIRECTION, at));
    let mut push = asking.push(l, asks);
    push.v3(ORIGIN, point).v3(DIRECTION, normal).v3(THROUGHPUT, counts);
    push.u(PRIM, vertices.u(l, PRIM, at)).u(SLOT, vertices.u(l, SLOT, at));
}

/// Asks the map for all of them.
#[inline(always)]
fn answer<L: Lanes>(l: L, context: &Context<'_>, asking: &Stream, slots: &mut Slots) {
    for at in (0..asking.len()).step_by(L::WIDTH) {
        let (slot, asks) = (asking.u(l, SLOT, at), asking.active(l, at));
        let query = query(l, context, asking, at, asks);
        let (found, counts) = (context.gather.irradiance(l, &query), asking.v3(l, THROUGHPUT, at));
        slots.add(l, asks, slot, counts * found.irradiance);
        slots.add_shift(l, asks, slot, counts * (found.irradiance - found.inner));
    }
}

/// A packet of vertices as the map sees it.
#[inline(always)]
fn query<L: Lanes>(l: L, context: &Context<'_>, vertices: &Stream, at: usize, asks: L::M) -> Query<L> {
    let prim = vertices.u(l, PRIM, at);
    let inside = l.select_u(asks, prim, l.u(0));
    Query {
        // Rays start beside the surface, by more than the smallest radii.
        point: surface::beneath(l, context.scene, inside, vertices.v3(l, ORIGIN, at)),
        normal: vertices.v3(l, DIRECTION, at),
        prim,
        asks,
        // The upper bits are the number of the sample in its round, in some order.
        sub_map: l.shr::<28>(vertices.u(l, SLOT, at)),
    }
}
