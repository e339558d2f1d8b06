//! Direct light at diffuse vertices by shadow rays (next event estimation; report eq. 13 with the cosine at the light
//! −N·d̂ and squared distance, summed over all lights by the chance of their choice).
//!
//! With f = ρ/π, one light sample of pdf p contributes f · Lₑ · cosθ · V / p, weighed by the balance heuristic against
//! the one scattering sample of pdf q = cosθ/π: N·p / (N·p + q), and divided by N: f · Lₑ · cosθ · V / (N·p + q), which
//! stays finite however near the light is.
//!
//! Most shadow rays pass everything by far: the cones of the occluders' parts tell so in a few operations, and only the
//! doubtful rest is traced, in packets of its own.

use core::f32::consts::FRAC_1_PI;

use super::{DIRECTION, LEAVES, ORIGIN, PADDING, PRIM, SLOT, Slots, Stream, THROUGHPUT};
use crate::accel::cones::{Cones, Parts};
use crate::accel::{Accel, Tracer};
use crate::geometry::Ray;
use crate::lanes::{Lanes, Rgb, V3};
use crate::light::{place::Outlook, sample::sample, table::LightTable};
use crate::mutant::mutant;
use crate::photon::visibility::{Decided, ONE_IN};
use crate::photon::{Surfaces, Visibility};
use crate::sampling::{Fan, Keys, Purpose, one_of};
use crate::scene::Media;
use crate::settings::Settings;

/// What the stage needs to know.
pub struct Context<'a> {
    /// The lights, at least one.
    pub lights: &'a LightTable,
    /// What can stand in the way.
    pub occluders: &'a Accel,
    /// The parts of what can.
    pub parts: &'a Parts,
    /// Number of shadow rays, at least 1; sampler.
    pub settings: &'a Settings,
    /// Whether a scattered ray may find the same light (path), or not (whitted).
    pub weighed: bool,
    /// What rays travel in, where some of it absorbs.
    pub media: Option<&'a Media>,
    /// What shadow photons say of the lights, and the surfaces that they lie on.
    pub decided: Option<(&'a Visibility, &'a Surfaces)>,
}

/// Shadow rays of a block of vertices (more where one packet asks for more): enough that the doubtful ones fill packets.
const RAYS_AT_ONCE: usize = 1024;

/// Sums and doubtful rays of a block of vertices.
#[derive(Clone, Debug, Default)]
pub struct Shadows {
    /// Irradiance at the vertices, one column a colour.
    sums: [Vec<f32>; 3],
    /// Shadow rays that shadow photons saved, since this was last set to 0.
    pub saved: u64,
    /// Rays that something may stop: [`ORIGIN`], [`DIRECTION`] to the light at 1, the irradiance in [`THROUGHPUT`],
    /// [`LEAVES`], the light's surface in [`PRIM`], and in [`SLOT`] the vertex.
    rays: Stream,
}

/// Adds the direct light of every vertex of the stream.
///
/// A vertex sums what nothing can stop first, then what arrives of its other rays, both in the order of their numbers:
/// a sum that does not depend on how the rays are packed.
#[inline(always)]
pub fn run<L: Lanes>(
    l: L,
    context: &Context<'_>,
    bounce: u32,
    vertices: &Stream,
    Shadows { sums, rays, saved }: &mut Shadows,
    slots: &mut Slots,
) {
    let mut tracer = Tracer::new(l, context.occluders);
    let mut cones = Cones::new(context.parts);
    let block = (RAYS_AT_ONCE / context.settings.shadow_rays as usize).next_multiple_of(PADDING).max(PADDING);
    sums.iter_mut().for_each(|column| column.resize(block + PADDING, 0.0));
    rays.clear();
    rays.reserve(block * context.settings.shadow_rays as usize);
    for first in (0..vertices.len()).step_by(block) {
        let packets = || (first..vertices.len().min(first + block)).step_by(L::WIDTH);
        rays.clear();
        for at in packets() {
            let free = unstopped(l, context, bounce, (vertices, at), &mut cones, (rays, at - first, saved));
            store(l, free, sums, at - first);
        }
        trace(l, &mut tracer, rays, sums);
        for at in packets() {
            let [x, y, z] = [0, 1, 2].map(
                #[inline(always)]
                |k: usize| l.load(&sums[k][at - first..]),
            );
            let scale = l.f(FRAC_1_PI) * vertices.eta(l, at);
            let reflected = vertices.v3(l, THROUGHPUT, at) * V3::new(x, y, z).scale(scale);
            slots.add(l, vertices.active(l, at), vertices.u(l, SLOT, at), reflected);
        }
    }
}

/// Irradiance that nothing can stop on its way, at a packet of vertices; rays that something may stop go to `doubtful`,
/// for the vertices from number `vertex` on.
#[inline(always)]
fn unstopped<L: Lanes>(
    l: L,
    context: &Context<'_>,
    bounce: u32,
    (vertices, at): (&Stream, usize),
    cones: &mut Cones<'_>,
    (doubtful, vertex, saved): (&mut Stream, usize, &mut u64),
) -> Rgb<L> {
    let receiver = Receiver::new(l, context, bounce, vertices, at);
    cones.look_from(l, receiver.point);
    let nothing = V3::splat(l, [0.0; 3]);
    let mut sum = nothing;
    let mut decided: Option<Decided<L>> = None;
    for number in 0..context.settings.shadow_rays {
        let Arriving { reach, mut irradiance, surface, counts, row } = receiver.sample(l, context, number);
        let mut doubt = counts & cones.may_stop(l, reach);
        sum = sum + V3::select(l, counts & !doubt, irradiance, nothing);
        if let Some(photons) = context.decided
            && l.any(doubt)
        {
            let here = match decided {
                Some(here) => here,
                None => receiver.decided(l, photons),
            };
            decided = Some(here);
            let known = receiver.known(l, context, &here, (number, row), doubt);
            sum = sum + V3::select(l, known.seen, irradiance.scale(known.by_photons), nothing);
            irradiance = irradiance.scale(known.by_ray);
            *saved += u64::from(l.bitmask(doubt & !known.asks).count_ones());
            doubt = known.asks;
        }
        if l.any(doubt) {
            let mut push = doubtful.push(l, doubt);
            push.v3(ORIGIN, receiver.point).v3(DIRECTION, reach).v3(THROUGHPUT, irradiance);
            push.u(LEAVES, receiver.leaves).u(PRIM, surface).u(SLOT, l.add_u(l.iota(), l.u(vertex as u32)));
        }
    }
    sum
}

/// Traces the doubtful rays and adds what arrives to the sums of their vertices.
#[inline(always)]
fn trace<L: Lanes>(l: L, tracer: &mut Tracer<'_, L>, rays: &Stream, sums: &mut [Vec<f32>; 3]) {
    for at in (0..rays.len()).step_by(L::WIDTH) {
        let active = rays.active(l, at);
        let ray = Ray::new(l, rays.v3(l, ORIGIN, at), rays.v3(l, DIRECTION, at), rays.u(l, LEAVES, at));
        let unshadowed = mutant!("shadow_rays_not_traced");
        let mut lit = l.bitmask(active & (l.m(unshadowed) | !tracer.occluded(l, &ray, rays.u(l, PRIM, at), active)));
        while lit != 0 {
            let lane = at + lit.trailing_zeros() as usize;
            let vertex = rays.value(SLOT, lane) as usize;
            for (sum, arrives) in sums.iter_mut().zip(rays.triple(THROUGHPUT, lane)) {
                sum[vertex] += arrives;
            }
            lit &= lit - 1;
        }
    }
}

/// A packet of vertices as the lights see them.
struct Receiver<L: Lanes> {
    point: V3<L>,
    normal: V3<L>,
    leaves: L::U,
    active: L::M,
    keys: Keys<L>,
    bounce: u32,
    /// The lamps as seen from here, where they are chosen by place.
    outlook: Option<Outlook<L>>,
    /// Numbers for the place on a light.
    place: Fan<L>,
    prim: L::U,
    medium: L::U,
}

/// One light sample of each vertex.
struct Arriving<L: Lanes> {
    /// From the vertex to the light point.
    reach: V3<L>,
    /// Irradiance by it, already divided by the number of samples.
    irradiance: Rgb<L>,
    /// Surface of the light.
    surface: L::U,
    /// Lanes where something arrives if nothing is in the way.
    counts: L::M,
    /// Row of the light.
    row: L::U,
}

/// What shadow photons say of one light sample of each vertex.
struct Known<L: Lanes> {
    /// Lanes in which the light is seen.
    seen: L::M,
    /// What they count for there.
    by_photons: L::F,
    /// Lanes in which a shadow ray is asked.
    asks: L::M,
    /// What it counts for.
    by_ray: L::F,
}

impl<L: Lanes> Receiver<L> {
    #[inline(always)]
    fn new(l: L, context: &Context<'_>, bounce: u32, vertices: &Stream, at: usize) -> Self {
        let Settings { sampler, shadow_rays, .. } = *context.settings;
        let keys = vertices.keys(l, at);
        let point = vertices.v3(l, ORIGIN, at);
        Self {
            point,
            outlook: context.lights.seen_from(l, point),
            normal: vertices.v3(l, DIRECTION, at),
            leaves: vertices.u(l, LEAVES, at),
            active: vertices.active(l, at),
            keys,
            bounce,
            prim: vertices.u(l, PRIM, at),
            medium: l.select_u(vertices.active(l, at), vertices.medium(l, at), l.u(0)),
            place: Fan::new(l, sampler, keys, bounce, Purpose::LightPoint, shadow_rays),
        }
    }

    /// What shadow photons say of all lights.
    #[inline(always)]
    fn decided(&self, l: L, (visibility, surfaces): (&Visibility, &Surfaces)) -> Decided<L> {
        let prim = l.select_u(self.active, self.prim, l.u(0));
        visibility.at(l, surfaces, prim, (self.point, self.normal))
    }

    /// What shadow photons say of light sample `number`, of light `row`, in the lanes `doubt`. Where they decide, one
    /// ray in [`ONE_IN`] is asked and counts as many times, less what the photons said.
    #[inline(always)]
    fn known(
        &self,
        l: L,
        context: &Context<'_>,
        decided: &Decided<L>,
        (number, row): (u32, L::U),
        doubt: L::M,
    ) -> Known<L> {
        let one = l.f(1.0);
        let Settings { sampler, shadow_rays, .. } = *context.settings;
        let (seen, hidden) = decided.of(l, row);
        let known = doubt & (seen | hidden);
        let u = one_of(l, sampler, self.keys, self.bounce, Purpose::Verify, (number, shadow_rays));
        let verified = known & l.lt(u, l.f(1.0 / ONE_IN as f32));
        Known {
            seen: known & seen,
            by_photons: l.select(verified, l.f(1.0 - ONE_IN as f32), one),
            asks: (doubt & !known) | verified,
            by_ray: if mutant!("doubt_not_made_up_for") { one } else { l.select(verified, l.f(ONE_IN as f32), one) },
        }
    }

    /// Light sample `number`: a light, a point of it, and what arrives from there.
    #[inline(always)]
    fn sample(&self, l: L, context: &Context<'_>, number: u32) -> Arriving<L> {
        let Settings { sampler, shadow_rays, .. } = *context.settings;
        let (row, chance) = if context.lights.rows.len() > 1 {
            let u = one_of(l, sampler, self.keys, self.bounce, Purpose::LightChoice, (number, shadow_rays));
            context.lights.choose(l, self.outlook.as_ref(), u)
        } else {
            (l.u(0), l.f(1.0))
        };
        let incident = sample(l, context.lights, row, (self.point, self.normal), self.place.pair(l, number));
        let cosine = self.normal.dot(l, incident.reach);
        // Lₑ · cosθ / (N·p + q) with q = cosθ/π: as cosθ / p = top / bottom, that is Lₑ · top / (N · bottom + top / π).
        let counted = if mutant!("no_cosine_at_the_receiver") { incident.reach.length(l) } else { cosine };
        let (top, bottom) = (counted * incident.spread.0, incident.spread.1 * chance);
        let by_chance = if context.weighed { l.keep(incident.by_chance, top * l.f(FRAC_1_PI)) } else { l.f(0.0) };
        let count = l.f(shadow_rays as f32);
        let irradiance = incident.radiance.scale(top / l.mul_add(count, bottom, by_chance));
        let irradiance = match context.media {
            Some(media) if !mutant!("shadow_rays_not_absorbed") => {
                irradiance * media.transmittance(l, self.medium, incident.reach.length(l))
            }
            _ => irradiance,
        };
        // A light point behind the surface, or one that shows its back, has nothing to ask; nor has 0/0 or ∞/∞.
        let brightest = irradiance.max_component(l);
        let arrives = l.lt(l.f(0.0), brightest) & l.lt(brightest, l.f(f32::INFINITY));
        let counts = self.active & l.lt(l.f(0.0), cosine) & arrives;
        Arriving { reach: incident.reach, irradiance, surface: incident.surface, counts, row }
    }
}

#[inline(always)]
fn store<L: Lanes>(l: L, radiance: Rgb<L>, to: &mut [Vec<f32>; 3], at: usize) {
    let [x, y, z] = to;
    l.store(radiance.x, &mut x[at..]);
    l.store(radiance.y, &mut y[at..]);
    l.store(radiance.z, &mut z[at..]);
}
