//! Radiance of emitters that paths hit.
//!
//! After a diffuse bounce the same light could have been found by a shadow ray, so the hit is weighed by the balance
//! heuristic (Veach and Guibas 1995): pdf / (pdf + N · pdf of the light samples). After the camera or a specular bounce
//! only a hit finds it, and it counts whole; unless it is in the caustic map, which has what a diffuse and then only
//! specular bounces lead to. Emission is counted once in every case; what is in the map is noted as found by paths.

use super::slots::Way;
use super::{DIRECTION, DISTANCE, ORIGIN, PRIM, SLOT, Slots, Stream, THROUGHPUT};
use crate::lanes::{Lanes, V3};
use crate::light::sample::pdf_of_hit;
use crate::mutant::mutant;
use crate::scene::{Class, Scene};

/// Adds what the emitters of this stream send back along their rays.
#[inline(always)]
pub fn run<L: Lanes>(
    l: L,
    scene: &Scene,
    (shadow_rays, in_map): (u32, Option<&[u32]>),
    hits: &Stream,
    slots: &mut Slots,
) {
    for at in (0..hits.len()).step_by(L::WIDTH) {
        let prim = hits.u(l, PRIM, at);
        let code = l.gather_u(&scene.classes, prim);
        let active = hits.active(l, at);
        let number = l.select_u(active, l.add_u(l.shr::<{ Class::BITS }>(code), l.u(u32::MAX)), l.u(0));
        let emitter = l.gather_record(&scene.lights.emitters, number);
        let [x, y, z, w, _, _, _, surface] = l.gather_record(&scene.shades, prim);
        let is_sphere = !l.lt_u(l.bits(surface), l.u(scene.planes));
        let (origin, wi, t) = (hits.v3(l, ORIGIN, at), hits.v3(l, DIRECTION, at), hits.f(l, DISTANCE, at));
        let geometry = V3::new(x, y, z);
        let normal = V3::select(l, is_sphere, origin.along(l, t, wi) - geometry, geometry);
        let front = l.lt(normal.dot(l, wi), l.f(0.0));

        let by_scatter = hits.pdf(l, at);
        let outlook = scene.lights.seen_from(l, origin);
        let chance = scene.lights.chance_of(l, outlook.as_ref(), number);
        let chance = if mutant!("hits_weighed_without_the_choice") { l.f(1.0) } else { chance };
        let by_light = pdf_of_hit(l, &emitter, &[x, y, z, w], is_sphere, (origin, wi, t)) * chance;
        let balanced = by_scatter / l.mul_add(l.f(shadow_rays as f32), by_light, by_scatter);
        let scattered = l.lt(l.f(0.0), by_scatter);
        // The power heuristic here and the balance heuristic there.
        let balanced = if mutant!("weights_do_not_sum_to_one") { balanced * balanced } else { balanced };
        // Report §2.5 and 2.7 together: light by shadow rays and again when it is hit.
        let balanced = if mutant!("emission_counted_twice") { l.f(1.0) } else { balanced };
        // Report §2.7: light by shadow rays alone, so that specular chains never meet a lamp.
        let whole = if mutant!("no_light_after_specular") { l.f(0.0) } else { l.f(1.0) };
        let mut weight = l.select(scattered, balanced, whole);
        if let Some(in_map) = in_map {
            let elsewhere = l.lt(by_scatter, l.f(0.0)) & l.eq_u(l.gather_u(in_map, number), l.u(1));
            weight = l.select(elsewhere, l.f(0.0), weight);
            let twice = elsewhere & active & front;
            if l.any(twice) {
                let found = V3::new(emitter[0], emitter[1], emitter[2]).scale(hits.eta(l, at));
                let found = hits.v3(l, THROUGHPUT, at) * found;
                slots.add_twice(l, twice, hits.u(l, SLOT, at), (Way::Paths, found));
            }
        }

        let radiance = V3::new(emitter[0], emitter[1], emitter[2]).scale(weight * hits.eta(l, at));
        slots.add(l, active & front, hits.u(l, SLOT, at), hits.v3(l, THROUGHPUT, at) * radiance);
    }
}
