//! Direct light at diffuse vertices by shadow rays (next event estimation; report eq. 13 with the cosine at the light
//! −N·d̂ and squared distance, summed over all lights by the chance of their choice).
//!
//! With f = ρ/π, one light sample of pdf p contributes f · Lₑ · cosθ · V / p, weighed by the balance heuristic against
//! the one scattering sample of pdf q = cosθ/π: N·p / (N·p + q), and divided by N: f · Lₑ · cosθ · V / (N·p + q), which
//! stays finite however near the light is.

use core::f32::consts::FRAC_1_PI;

use super::{DIRECTION, LEAVES, ORIGIN, SLOT, Slots, Stream, THROUGHPUT};
use crate::accel::{Accel, Tracer};
use crate::geometry::Ray;
use crate::lanes::{Lanes, V3};
use crate::light::{Incident, sample::sample, table::LightTable};
use crate::sampling::{Purpose, pair};
use crate::settings::Settings;

/// What the stage needs to know.
pub struct Context<'a> {
    /// The lights, at least one.
    pub lights: &'a LightTable,
    /// What can stand in the way.
    pub occluders: &'a Accel,
    /// Number of shadow rays, sampler.
    pub settings: &'a Settings,
    /// Whether a scattered ray may find the same light (path), or not (whitted).
    pub weighed: bool,
}

/// Adds the direct light of every vertex of the stream.
#[inline(always)]
pub fn run<L: Lanes>(l: L, context: &Context<'_>, bounce: u32, vertices: &Stream, slots: &mut Slots) {
    let mut tracer = Tracer::new(l, context.occluders);
    for at in (0..vertices.len()).step_by(L::WIDTH) {
        let mut sum = V3::splat(l, [0.0; 3]);
        for number in 0..context.settings.shadow_rays {
            sum = sum + one(l, context, &mut tracer, (bounce, number), vertices, at);
        }
        let active = vertices.active(l, at);
        let reflected = vertices.v3(l, THROUGHPUT, at) * sum.scale(l.f(FRAC_1_PI) * vertices.eta(l, at));
        slots.add(l, active, vertices.u(l, SLOT, at), reflected);
    }
}

/// Irradiance by one light sample, already divided by their number.
#[inline(always)]
fn one<L: Lanes>(
    l: L,
    context: &Context<'_>,
    tracer: &mut Tracer<'_, L>,
    (bounce, number): (u32, u32),
    vertices: &Stream,
    at: usize,
) -> V3<L> {
    let (point, normal) = (vertices.v3(l, ORIGIN, at), vertices.v3(l, DIRECTION, at));
    let incident = choose(l, context, (bounce, number), vertices, at);
    let cosine = normal.dot(l, incident.reach);
    // Lₑ · cosθ / (N·p + q) with q = cosθ/π: as cosθ / p = top / bottom, that is Lₑ · top / (N · bottom + top / π).
    let (top, bottom) = (cosine * incident.spread.0, incident.spread.1);
    let by_chance = if context.weighed { l.keep(incident.by_chance, top * l.f(FRAC_1_PI)) } else { l.f(0.0) };
    let count = l.f(context.settings.shadow_rays as f32);
    let irradiance = incident.radiance.scale(top / l.mul_add(count, bottom, by_chance));
    // A light point behind the surface, or one that shows its back, has nothing to ask; nor has 0/0 or ∞/∞.
    let brightest = irradiance.max_component(l);
    let asks = vertices.active(l, at)
        & l.lt(l.f(0.0), cosine)
        & l.lt(l.f(0.0), brightest)
        & l.lt(brightest, l.f(f32::INFINITY));
    if !l.any(asks) {
        return V3::splat(l, [0.0; 3]);
    }
    let ray = Ray::new(l, point, incident.reach, vertices.u(l, LEAVES, at));
    let lit = asks & !tracer.occluded(l, &ray, incident.surface, asks);
    V3::new(l.keep(lit, irradiance.x), l.keep(lit, irradiance.y), l.keep(lit, irradiance.z))
}

/// Chooses a light and a point of it.
#[inline(always)]
fn choose<L: Lanes>(
    l: L,
    context: &Context<'_>,
    (bounce, number): (u32, u32),
    vertices: &Stream,
    at: usize,
) -> Incident<L> {
    let settings = context.settings;
    let keys = vertices.keys(l, at);
    let part = (number, settings.shadow_rays.next_power_of_two().ilog2());
    let row = if context.lights.rows.len() > 1 {
        let (u, _) = pair(l, settings.sampler, keys, bounce, Purpose::LightChoice, part);
        context.lights.choose(l, u)
    } else {
        l.u(0)
    };
    let numbers = pair(l, settings.sampler, keys, bounce, Purpose::LightPoint, part);
    sample(l, context.lights, row, (vertices.v3(l, ORIGIN, at), vertices.v3(l, DIRECTION, at)), numbers)
}
