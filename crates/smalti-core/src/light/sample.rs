//! Sampling a light as seen from a point.

use super::table::{Kind, LightTable, NO_SURFACE, triple};
use crate::lanes::{Lanes, Rgb, V3};
use crate::mutant::mutant;
use crate::sampling::warp;

/// What arrives at a point from one sampled point of a light, were nothing in the way.
pub struct Incident<L: Lanes> {
    /// From the point to the light point; the light is at t = 1.
    pub reach: V3<L>,
    /// Radiance that arrives (for a point light its intensity).
    pub radiance: Rgb<L>,
    /// What the cosine at the point counts for, as a fraction: (normal · reach) · `spread.0` / `spread.1` is cosθ / pdf,
    /// with the solid-angle pdf of this choice and point. A fraction, because divisions are what a light sample costs
    /// most, and this way one is enough for all.
    pub spread: (L::F, L::F),
    /// Lanes where chance could also have found this light by scattering: not a point light.
    pub by_chance: L::M,
    /// Surface of the light: cannot stop the shadow ray.
    pub surface: L::U,
}

/// Samples row `row` of the table from a point with a normal. Lanes from where the light shows nothing have radiance 0 or pdf 0, inf
/// or NaN; the caller keeps a lane only where its contribution is positive and finite.
#[inline(always)]
pub fn sample<L: Lanes>(
    l: L,
    table: &LightTable,
    row: L::U,
    from: (V3<L>, V3<L>),
    (u, v): (L::F, L::F),
) -> Incident<L> {
    if let [only] = &table.rows[..] {
        let place = only.map(
            #[inline(always)]
            |x| l.f(x),
        );
        return of_kind(l, &place, table.kinds[0], l.u(table.surfaces[0]), from, (u, v));
    }
    let place = l.gather_record(&table.rows, row);
    let surface = l.gather_u(&table.surfaces, row);
    let kinds = l.gather_u(&table.kinds, row);
    let mut incident: Option<Incident<L>> = None;
    for kind in 0..5 {
        let here = l.eq_u(kinds, l.u(kind));
        if l.any(here) {
            let of_this = of_kind(l, &place, kind, surface, from, (u, v));
            incident = Some(match incident {
                None => of_this,
                Some(other) => of_this.or(l, here, other),
            });
        }
    }
    incident.expect("every row has one of these kinds")
}

impl<L: Lanes> Incident<L> {
    /// Solid-angle density of this choice and point, sr⁻¹; for a point light it has the squared distance in it.
    #[inline(always)]
    pub fn pdf(&self, l: L) -> L::F {
        self.spread.1 / (self.spread.0 * l.sqrt(self.reach.dot(l, self.reach)))
    }

    /// `self` where `mask`, else `other`.
    #[inline(always)]
    fn or(self, l: L, mask: L::M, other: Self) -> Self {
        Self {
            reach: V3::select(l, mask, self.reach, other.reach),
            radiance: V3::select(l, mask, self.radiance, other.radiance),
            spread: (l.select(mask, self.spread.0, other.spread.0), l.select(mask, self.spread.1, other.spread.1)),
            by_chance: (mask & self.by_chance) | (!mask & other.by_chance),
            surface: l.select_u(mask, self.surface, other.surface),
        }
    }
}

#[inline(always)]
fn of_kind<L: Lanes>(
    l: L,
    place: &[L::F; 16],
    kind: u32,
    surface: L::U,
    (x, normal): (V3<L>, V3<L>),
    (u, v): (L::F, L::F),
) -> Incident<L> {
    if kind == Kind::Parallelogram as u32 {
        patch(l, place, surface, x, (u, v))
    } else if kind == Kind::Triangle as u32 {
        patch(l, place, surface, x, warp::triangle(l, u, v))
    } else if kind == Kind::Sphere as u32 {
        sphere(l, place, surface, x, (u, v))
    } else if kind == Kind::Point as u32 {
        point(l, place, x)
    } else {
        sky(l, place, normal, (u, v))
    }
}

/// A planar patch, uniform by area. The density by solid angle is d² / (cosθ · area), report eq. 13 with the cosine at
/// the light corrected to −N·d̂, clamped at 0.
#[inline(always)]
fn patch<L: Lanes>(l: L, place: &[L::F; 16], surface: L::U, x: V3<L>, (u, v): (L::F, L::F)) -> Incident<L> {
    let on_light = triple(place, 0).along(l, u, triple(place, 3)).along(l, v, triple(place, 6));
    let reach = on_light - x;
    let squared = reach.dot(l, reach);
    let mut facing = -triple(place, 9).dot(l, reach);
    // Report eq. 13: +N·d, its sign mended by taking the magnitude, so that the back shines too.
    if mutant!("eq13_two_sided") {
        facing = l.abs(facing);
    }
    let front = l.lt(l.f(0.0), facing);
    let zero = V3::splat(l, [0.0; 3]);
    if mutant!("no_cosine_at_the_light") {
        facing = l.sqrt(squared);
    }
    // cosθ / pdf = (n·reach / d) · (facing / d) · area / d²: four times d, two of them to make the cosines.
    // Report eq. 13 read without the square of the distance.
    let fourth = if mutant!("eq13_distance_not_squared") { squared * l.sqrt(squared) } else { squared * squared };
    Incident {
        reach,
        radiance: V3::select(l, front, triple(place, 12), zero),
        spread: (facing * place[15], fourth),
        by_chance: l.m(true),
        surface,
    }
}

/// A sphere seen from outside, uniform in its cone; from inside it shows nothing, as it emits outward.
#[inline(always)]
fn sphere<L: Lanes>(l: L, place: &[L::F; 16], surface: L::U, x: V3<L>, (u, v): (L::F, L::F)) -> Incident<L> {
    let axis = triple(place, 0) - x;
    let (d2, r2) = (axis.dot(l, axis), place[3] * place[3]);
    let outside = l.lt(r2, d2);
    let opening = warp::sphere_opening(l, r2, d2);
    let (local, below) = warp::cone(l, opening, u, v);
    let distance = l.sqrt(d2);
    let wi = warp::about(l, axis.scale(l.f(1.0) / distance), local).normalised(l);
    let sine_squared = below * (l.f(2.0) - below);
    let to_surface = distance * (l.f(1.0) - below) - l.sqrt(l.max(l.mul_add(-d2, sine_squared, r2), l.f(0.0)));
    let zero = V3::splat(l, [0.0; 3]);
    Incident {
        reach: wi.scale(to_surface),
        radiance: V3::select(l, outside, triple(place, 12), zero),
        spread: (opening * place[15] * l.f(2.0 * core::f32::consts::PI), to_surface),
        by_chance: l.m(true),
        surface,
    }
}

#[inline(always)]
fn point<L: Lanes>(l: L, place: &[L::F; 16], x: V3<L>) -> Incident<L> {
    let reach = triple(place, 0) - x;
    let squared = reach.dot(l, reach);
    Incident {
        reach,
        radiance: triple(place, 12),
        spread: (place[15], squared * l.sqrt(squared)),
        by_chance: l.m(false),
        surface: l.u(NO_SURFACE),
    }
}

/// The environment, by the cosine. Its light point is 8 away, behind everything: the scene's size is 2.
#[inline(always)]
fn sky<L: Lanes>(l: L, place: &[L::F; 16], normal: V3<L>, (u, v): (L::F, L::F)) -> Incident<L> {
    let local = warp::cosine_hemisphere(l, u, v);
    let wi = warp::about(l, normal, local).normalised(l);
    Incident {
        reach: wi.scale(l.f(8.0)),
        radiance: triple(place, 12),
        spread: (place[15] * l.f(core::f32::consts::PI), local.z * l.f(8.0)),
        by_chance: l.m(false),
        surface: l.u(NO_SURFACE),
    }
}

/// Density with which [`sample`] at `from` would have chosen the direction that hit emitter `number` at distance `t`:
/// what multiple importance sampling weighs a chance hit against. `geometry` is the plane or sphere that was hit.
#[inline(always)]
pub fn pdf_of_hit<L: Lanes>(
    l: L,
    emitter: &[L::F; 4],
    geometry: &[L::F; 4],
    is_sphere: L::M,
    (from, wi, t): (V3<L>, V3<L>, L::F),
) -> L::F {
    let [x, y, z, w] = *geometry;
    let place = V3::new(x, y, z);
    let by_angle = emitter[3] * t * t / l.abs(place.dot(l, wi));
    let planar = if mutant!("pdf_by_area_taken_for_one_by_angle") { emitter[3] } else { by_angle };
    let axis = place - from;
    let round = warp::cone_pdf(l, warp::sphere_opening(l, w * w, axis.dot(l, axis))) * emitter[3];
    l.select(is_sphere, round, planar)
}
