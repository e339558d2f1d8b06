//! Photons as they leave the lights: the first stage of a photon pass.

use super::Aim;
use crate::geometry::offset;
use crate::lanes::{Lanes, V3};
use crate::light::table::{Kind, LightTable, triple};
use crate::mutant::mutant;
use crate::sampling::{Keys, Purpose, pair, sobol, warp};
use crate::scene::Media;
use crate::settings::SamplerKind;
use crate::stream::{DIRECTION, KEY, LEAVES, MEDIUM, ORIGIN, SLOT, Stream, THROUGHPUT};

/// What the stage needs to know.
pub struct Emission<'a> {
    /// The lights.
    pub lights: &'a LightTable,
    /// Where their photons go.
    pub aim: &'a Aim,
    /// What they travel in, where some of it absorbs.
    pub media: Option<&'a Media>,
    /// Where numbers come from.
    pub sampler: SamplerKind,
    /// Photons that share the flux.
    pub emitted: u32,
}

/// What is kept of each photon of a batch, by its slot.
#[derive(Clone, Debug, Default)]
pub struct Slots {
    /// Flux that it set out with, in its brightest channel.
    pub power: Vec<f32>,
    /// Row of the light that it left.
    pub rows: Vec<u32>,
}

/// Emits photons `first..first + count` of the set `key` into `photons`. A photon's throughput has 1 as its largest
/// channel; the flux in that channel is in its slot. Photons of no flux are left out.
#[inline(always)]
pub fn run<L: Lanes>(
    l: L,
    emission: &Emission<'_>,
    (key, first, count): (u32, u32, u32),
    photons: &mut Stream,
    Slots { power, rows }: &mut Slots,
) {
    let Emission { lights, aim, sampler, emitted, .. } = *emission;
    power.clear();
    power.resize(count as usize + 16, 0.0);
    rows.clear();
    rows.resize(count as usize + 16, 0);
    photons.clear();
    photons.reserve(count as usize);
    for at in (0..count).step_by(L::WIDTH) {
        let slot = l.add_u(l.iota(), l.u(at));
        let index = sobol::reverse(l, l.add_u(slot, l.u(first)));
        let keys = Keys { key: l.u(key), index };
        let choice = pair(l, sampler, keys, 0, Purpose::LightChoice);
        let place = pair(l, sampler, keys, 0, Purpose::LightPoint);
        let way = pair(l, sampler, keys, 0, Purpose::Emission);
        let (row, target) = aim.choose(l, choice.0);
        let source = Source::new(l, lights, row, place);
        let from = (source.point, source.normal, source.is_point);
        let (direction, density) = aim.direction(l, (row, target), from, way);
        let cosine = l.select(source.is_point, l.f(1.0), source.normal.dot(l, direction));
        let brightest = source.radiance.max_component(l);
        // Report eq. 14: each photon has a fixed flux, however many there are.
        let share = if mutant!("eq14_flux_of_its_own") { 1e-4 } else { 1.0 / emitted as f32 };
        let measure = l.gather(&aim.measures, row) * l.f(share);
        let flux = brightest * measure * cosine / density;
        l.store(flux, &mut power[at as usize..]);
        l.store_u(row, &mut rows[at as usize..]);
        let leaves = l.first((count - at) as usize) & l.lt(l.f(0.0), flux) & l.lt(flux, l.f(f32::INFINITY));
        let mut push = photons.push(l, leaves);
        push.v3(ORIGIN, source.origin).v3(DIRECTION, direction).u(LEAVES, source.surface);
        push.v3(THROUGHPUT, source.radiance.scale(l.f(1.0) / brightest));
        push.u(KEY, l.u(key)).u(SLOT, (index & l.u(0xffff_0000)) | slot);
        if mutant!("n_squared_for_photons") {
            push.f(crate::stream::ETA, l.f(1.0));
        }
        if let Some(media) = emission.media {
            push.u(MEDIUM, l.gather_u(&media.lights, row));
        }
    }
}

/// A point of a light.
struct Source<L: Lanes> {
    /// On the light.
    point: V3<L>,
    /// Where rays start.
    origin: V3<L>,
    /// Unit normal; of no meaning for a point light.
    normal: V3<L>,
    is_point: L::M,
    /// Radiance, or intensity of a point light.
    radiance: V3<L>,
    surface: L::U,
}

impl<L: Lanes> Source<L> {
    #[inline(always)]
    fn new(l: L, lights: &LightTable, row: L::U, (u, v): (L::F, L::F)) -> Self {
        let place = l.gather_record(&lights.rows, row);
        let kind = l.gather_u(&lights.kinds, row);
        let (is_triangle, is_sphere) =
            (l.eq_u(kind, l.u(Kind::Triangle as u32)), l.eq_u(kind, l.u(Kind::Sphere as u32)));
        let is_point = l.eq_u(kind, l.u(Kind::Point as u32));
        let (a, b) = warp::triangle(l, u, v);
        let (a, b) = (l.select(is_triangle, a, u), l.select(is_triangle, b, v));
        let corner = triple(&place, 0);
        let on_patch = corner.along(l, a, triple(&place, 3)).along(l, b, triple(&place, 6));
        let outward = warp::sphere(l, u, v);
        let on_sphere = corner.along(l, place[3], outward);
        let scale = corner.max_abs(l) + place[3];
        let off_sphere = offset::leave(l, on_sphere, scale, outward);
        let point = V3::select(l, is_point, corner, V3::select(l, is_sphere, on_sphere, on_patch));
        let origin = V3::select(l, is_sphere, off_sphere, point);
        Self {
            point,
            origin,
            normal: V3::select(l, is_sphere, outward, triple(&place, 9)),
            is_point,
            radiance: triple(&place, 12),
            surface: l.gather_u(&lights.surfaces, row),
        }
    }
}
