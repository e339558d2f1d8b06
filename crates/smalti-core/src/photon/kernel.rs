//! The kernel of a photon: the disc of its own surface over which its flux is spread evenly.
//!
//! E(x) ≈ Σ φ / (π r² a) over the photons within whose radius r the point x lies; a is the part of a disc of that radius
//! about x that lies on the surface (Jensen 1996 divides by the whole disc, which darkens edges). The radius belongs to the
//! photon, not to the point (the sample-point estimator of Breiman, Meisel and Purcell 1977; Abramson 1982): each photon's
//! flux arrives whole, whatever radii do from place to place. With radii that belong to points, as in Jensen's query, a
//! point in the dark with a large radius counts the photons of a bright spot that the points there count as well.
//!
//! Radii come from photons sent ahead ([`Pilot`]), so the spread does not depend on the photons that it serves.

use core::f32::consts::FRAC_1_PI;

use super::{Photons, Pilot, Quantity, Surfaces, Tag};
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;
use crate::scene::View;

/// The least radius in the first round, in pixels. A spot of light that is much smaller than a pixel is met by few of its
/// samples, and is all noise.
const PIXELS: f64 = 0.5;

/// Kernels for the photons of a round.
pub struct Kernels<'a> {
    /// Radii by place.
    pub pilot: &'a Pilot,
    /// The surfaces that photons lie on.
    pub surfaces: &'a Surfaces,
    /// Radii by those of the first round.
    pub shrink: f32,
    /// The views: nothing smaller than their pixels is to be seen.
    pub footprint: Footprint,
    /// The quantity that photons are to bring: their flux, or their number.
    pub quantity: Quantity,
}

/// The size of a pixel, by place: that of the camera in which it is smallest, as photon maps serve all cameras.
#[derive(Clone, Debug, Default)]
pub struct Footprint {
    /// For each camera its pinhole, and the radius by distance from there; none: no least radius.
    cameras: Vec<([f32; 3], f32)>,
}

impl Footprint {
    /// Footprints of the cameras `views` in pictures of `rows` rows.
    pub fn new(views: &[View], rows: u32) -> Self {
        let camera = |view: &View| {
            let half_height = view.up.map(f64::from).map(|x| x * x).iter().sum::<f64>().sqrt();
            (view.eye, (PIXELS * 2.0 * half_height / f64::from(rows.max(1))) as f32)
        };
        Self { cameras: views.iter().map(camera).collect() }
    }

    /// The least radius in the first round at each point of a packet.
    #[inline(always)]
    fn radius<L: Lanes>(&self, l: L, point: V3<L>) -> L::F {
        if self.cameras.is_empty() {
            return l.f(0.0);
        }
        let mut least = l.f(f32::INFINITY);
        for (eye, by_distance) in &self.cameras {
            let away = point - V3::splat(l, *eye);
            least = l.min(least, l.sqrt(away.dot(l, away)) * l.f(*by_distance));
        }
        least
    }
}

impl Kernels<'_> {
    /// Gives every photon its radius, and turns its flux into irradiance.
    #[inline(always)]
    pub fn spread<L: Lanes>(&self, l: L, photons: &mut Photons) {
        let count = photons.len();
        photons.radii.clear();
        photons.radii.resize(count + 16, 0.0);
        for at in (0..count).step_by(L::WIDTH) {
            let here = l.first((count - at).min(L::WIDTH));
            l.store(self.radius(l, &photons.places, at, here), &mut photons.radii[at..]);
        }
        photons.radii.truncate(count);
        photons.flux.iter_mut().zip(&photons.radii).for_each(|(flux, radius)| self.weigh(flux, *radius));
    }

    /// The radii of the photons from number `at` on.
    #[inline(always)]
    fn radius<L: Lanes>(&self, l: L, places: &[[f32; 4]], at: usize, here: L::M) -> L::F {
        let number = l.select_u(here, l.add_u(l.iota(), l.u(at as u32)), l.u(0));
        let [x, y, z, tag] = l.gather_record(places, number);
        let (point, prim) = (V3::new(x, y, z), l.bits(tag) & l.u(Tag::PRIM));
        let [least, most] = self.surfaces.radii(l, prim, point);
        let radius = l.max(self.pilot.radius(l, prim, point), self.footprint.radius(l, point));
        l.max(l.min(radius * l.f(self.shrink), most), least)
    }

    /// The flux of a photon, by the area of its disc; or its number of scattering events and itself.
    fn weigh(&self, flux: &mut [f32; 4], radius: f32) {
        let [r, g, b, bounces] = *flux;
        let squared = if mutant!("gather_radius_not_squared") { radius } else { radius * radius };
        let norm = FRAC_1_PI / squared;
        let [x, y, z] = match self.quantity {
            Quantity::Radiance => [r, g, b],
            Quantity::Count => [bounces.to_bits() as f32, 1.0, 0.0],
        };
        *flux = [x * norm, y * norm, z * norm, bounces];
    }
}
