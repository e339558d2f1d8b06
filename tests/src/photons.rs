//! Photons emitted, laid out and asked in small numbers: what a renderer does with them, taken apart.

use glam::DVec3;
use rayon::prelude::*;
use smalti_core::lanes::{One, V3};
use smalti_core::photon::gather::{Gather, Query};
use smalti_core::photon::kd_tree::Tree;
use smalti_core::photon::kernel::{Footprint, Kernels};
use smalti_core::photon::pass::{Pass, PhotonWorkspace};
use smalti_core::photon::pilot::{Pilot, Target};
use smalti_core::photon::{Account, Kind, Map, Photons, Quantity, SUB_MAPS, Surfaces, Traced};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::{Origin, World};
use smalti_core::settings::{Integrator, Settings};

/// A renderer that maps all light, at the best SIMD level.
///
/// # Panics
/// Where the settings do not suit the scene.
pub fn mapper(world: &World, settings: Settings) -> Renderer {
    let settings = Settings { integrator: Integrator::Photon, ..settings };
    Renderer::new(world, settings, Level::available()[0]).expect("the settings suit the scene")
}

/// Emits `count` photons as one estimate of all the light and follows them. Every `round` has its own numbers.
pub fn trace(renderer: &Renderer, pass: &Pass, count: u32, round: u32) -> Traced {
    let pass = Pass { photons: count * SUB_MAPS, ..pass.clone() };
    let batches: Vec<Traced> = pass
        .sub_map(round, 0)
        .into_par_iter()
        .map_init(
            || PhotonWorkspace::new(renderer.scene()),
            |workspace, batch| renderer.trace_photons(&pass, batch, workspace),
        )
        .collect();
    let mut all = Traced::default();
    for batch in &batches {
        all.photons.places.extend_from_slice(&batch.photons.places);
        all.photons.flux.extend_from_slice(&batch.photons.flux);
        all.account += &batch.account;
    }
    all
}

/// A map whose first part holds these photons, with kernels that bring `quantity`, all of `radius` (in the frame); its
/// other parts are empty. Surfaces and rounding of places limit the radius.
pub fn map_of(photons: &Photons, surfaces: &Surfaces, radius: f32, quantity: Quantity) -> Map {
    let target = Target { ahead: 1, of_map: 1, wanted: 1.0 };
    let pilot = Pilot::new(&Photons::default(), surfaces, target, Some(radius));
    let kernels = Kernels { pilot: &pilot, surfaces, shrink: 1.0, footprint: Footprint::default(), quantity };
    let mut photons = photons.clone();
    kernels.spread(One, &mut photons);
    let mut trees = vec![Tree::default(); SUB_MAPS as usize];
    trees[0] = Tree::new([&photons]);
    Map::new(Kind::Global, 0, trees, Account::default())
}

/// A place on a surface, in the scene's frame.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Where.
    pub point: [f32; 3],
    /// Unit normal on the side that asks.
    pub normal: [f32; 3],
    /// The primitive.
    pub prim: u32,
}

impl Place {
    /// A point of the world on the primitive that `origin` became.
    ///
    /// # Panics
    /// If there is none.
    pub fn on(renderer: &Renderer, origin: Origin, point: DVec3, normal: DVec3) -> Self {
        let prim = renderer.scene().origins.iter().position(|other| *other == origin);
        Self::new(renderer, prim.expect("it is in the scene") as u32, point, normal)
    }

    /// A point of the world on the primitive `prim`.
    pub fn new(renderer: &Renderer, prim: u32, point: DVec3, normal: DVec3) -> Self {
        let point = renderer.scene().frame.point(point).as_vec3().to_array();
        Self { point, normal: normal.as_vec3().to_array(), prim }
    }
}

/// Irradiance at a place by one part of a map, from photons with at most `most_bounces` scattering events before.
pub fn irradiance((map, sub_map, most_bounces): (&Map, u32, u32), surfaces: &Surfaces, place: &Place) -> [f64; 3] {
    let query = Query {
        point: V3::splat(One, place.point),
        normal: V3::splat(One, place.normal),
        prim: place.prim,
        asks: true,
        sub_map,
    };
    let found = Gather { map, surfaces, most_bounces }.irradiance(One, &query).irradiance;
    [found.x, found.y, found.z].map(f64::from)
}
