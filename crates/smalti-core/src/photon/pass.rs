//! A photon pass: batches of photons through the stages, from the lights to where they are stored.
//!
//! A batch is a function of (scene, settings, seed, round, batch) and of nothing else; batches are traced in any order
//! and collected by their number.

use super::emit::{self, Emission};
use super::visibility::HIDDEN;
use super::{Account, Aim, Kind, Photons, SUB_MAPS, shadow, store};
use crate::lanes::dispatch;
use crate::mutant::mutant;
use crate::render::Renderer;
use crate::sampling::sampler::photon_key;
use crate::scene::{Class, Scene};
use crate::settings::{Fresnel, SamplerKind};
use crate::stream::mirror::Ending;
use crate::stream::{Columns, MOST_SLOTS, PRIM, Stream, absorb, dielectric, diffuse, intersect, mirror, sort, surface};

/// Photons of a batch: as many as camera paths go through the stages together.
const PHOTONS: u32 = 4096;

/// Photons with one key: their numbers fit 16 bits.
const SET: u32 = 1 << 16;

/// Surfaces that a shadow photon goes through at most.
const MOST_MET: u32 = 64;

const _: () = assert!(PHOTONS as usize <= MOST_SLOTS && SET.is_multiple_of(PHOTONS));

/// Some photons of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batch {
    /// Which map.
    pub kind: Kind,
    /// The round that it serves.
    pub round: u32,
    /// The part of the map.
    pub sub_map: u32,
    /// Number of the first photon in the part.
    pub first: u32,
    /// Number of photons.
    pub count: u32,
    /// Photons of the whole part.
    pub emitted: u32,
}

/// What a photon pass is to emit.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Which map.
    pub kind: Kind,
    /// Where its photons go.
    pub aim: Aim,
    /// Photons in all, over all sub-maps; rounded up to a multiple of their number.
    pub photons: u32,
    /// Whether photons go on from a diffuse surface on which they are stored, to be stored again where they land next:
    /// all light, or of caustics the light that they send on too. Else they end there.
    pub goes_on: bool,
}

impl Pass {
    /// Photons of a sub-map.
    pub fn of_sub_map(&self) -> u32 {
        self.photons.div_ceil(SUB_MAPS)
    }

    /// The batches of a round, sub-map after sub-map.
    pub fn batches(&self, round: u32) -> Vec<Batch> {
        (0..SUB_MAPS).flat_map(|sub_map| self.sub_map(round, sub_map)).collect()
    }

    /// The batches of a sub-map.
    pub fn sub_map(&self, round: u32, sub_map: u32) -> Vec<Batch> {
        let (kind, emitted) = (self.kind, self.of_sub_map());
        let count = |first: u32| PHOTONS.min(emitted - first);
        let batch = |first| Batch { kind, round, sub_map, first, count: count(first), emitted };
        (0..emitted).step_by(PHOTONS as usize).map(batch).collect()
    }
}

/// What became of a batch.
#[derive(Clone, Debug, Default)]
pub struct Traced {
    /// The photons to keep.
    pub photons: Photons,
    /// Where the light went.
    pub account: Account,
}

/// Buffers of a worker; made once and reused.
pub struct PhotonWorkspace {
    photons: Stream,
    next: Stream,
    diffuse: Stream,
    mirror: Stream,
    dielectric: Stream,
    escaped: Stream,
    slots: emit::Slots,
}

impl PhotonWorkspace {
    /// Buffers for photons in `scene`.
    pub fn new(scene: &Scene) -> Self {
        let eta = mutant!("n_squared_for_photons");
        let columns = Columns { eta, medium: scene.media.is_some(), ..Columns::default() };
        let stream = || Stream::new(PHOTONS as usize, columns);
        Self {
            photons: stream(),
            next: stream(),
            diffuse: stream(),
            mirror: stream(),
            dielectric: stream(),
            escaped: stream(),
            slots: emit::Slots::default(),
        }
    }
}

impl Renderer {
    /// Emits a batch of photons of `pass` and follows them to where they are stored.
    pub fn trace_photons(&self, pass: &Pass, batch: Batch, workspace: &mut PhotonWorkspace) -> Traced {
        let mut traced = Traced::default();
        self.emit(pass, batch, workspace);
        traced.account.photons = batch.count.into();
        traced.account.emitted = sum(&workspace.photons, &workspace.slots.power);
        if batch.kind == Kind::Shadow {
            self.follow_through(workspace, &mut traced);
            return traced;
        }
        for bounce in 0..self.plan().max_bounces {
            traced.account.rays += workspace.photons.len() as u64;
            self.photon_bounce(pass, bounce, workspace, &mut traced);
            core::mem::swap(&mut workspace.photons, &mut workspace.next);
            workspace.next.clear();
            if workspace.photons.is_empty() {
                break;
            }
        }
        // What the limit on bounces cuts off ends where it is.
        add(&mut traced.account.absorbed, sum(&workspace.photons, &workspace.slots.power));
        traced.account.kept = traced.photons.len() as u64;
        if mutant!("flux_by_photons_stored") {
            let scale = batch.count as f32 / traced.photons.len().max(1) as f32;
            traced.photons.flux.iter_mut().for_each(|[r, g, b, _]| [r, g, b].into_iter().for_each(|x| *x *= scale));
        }
        traced
    }

    fn emit(&self, pass: &Pass, batch: Batch, workspace: &mut PhotonWorkspace) {
        let PhotonWorkspace { photons, slots, next, .. } = workspace;
        let Batch { kind, round, sub_map, first, count, emitted } = batch;
        let settings = self.settings();
        let Scene { lights, media, .. } = self.scene();
        let (media, sampler) = (media.as_ref(), settings.sampler);
        let emission = Emission { lights, aim: &pass.aim, media, sampler, emitted };
        let key = photon_key(settings.seed, kind as u32, round, sub_map, first / SET);
        next.clear();
        dispatch!(self.token(), l => emit::run(l, &emission, (key, first % SET, count), photons, slots));
    }

    /// Takes photons through one bounce.
    fn photon_bounce(&self, pass: &Pass, bounce: u32, workspace: &mut PhotonWorkspace, traced: &mut Traced) {
        let (scene, token) = (self.scene(), self.token());
        dispatch!(token, l => intersect::run(l, &self.plan().everything, &mut workspace.photons));
        self.absorb(workspace, &mut traced.account);
        self.sort_photons(workspace);
        let PhotonWorkspace { photons, next, diffuse, mirror, dielectric, escaped, slots } = workspace;
        let power = &slots.power[..];
        let account = &mut traced.account;
        add(&mut account.escaped, sum(escaped, power));
        add(&mut account.absorbed, on_black(scene, photons, power));
        let landed = sum(diffuse, power);
        // Report §2.8: "stored when their path terminates", those that come straight from the light too.
        let stores = pass.kind == Kind::Global || bounce > 0;
        if stores || mutant!("caustics_with_direct_light") {
            account.nonfinite +=
                dispatch!(token, l => store::run(l, scene, &|_| bounce, diffuse, power, &mut traced.photons));
        }
        if stores && pass.goes_on {
            dispatch!(token, l => surface::run(l, scene, diffuse));
            let sampler = self.settings().sampler;
            dispatch!(token, l => diffuse::run(l, sampler, bounce, diffuse, next));
            add(&mut account.absorbed, difference(landed, sum(next, power)));
        } else {
            add(if stores { &mut account.stored } else { &mut account.absorbed }, landed);
        }
        self.scatter_specular(bounce, (mirror, dielectric, next, power), account);
    }

    /// Takes photons through everything that they meet; stores where they land first and, marked, where they land then.
    fn follow_through(&self, workspace: &mut PhotonWorkspace, traced: &mut Traced) {
        let (scene, token) = (self.scene(), self.token());
        for met in 0..MOST_MET {
            traced.account.rays += workspace.photons.len() as u64;
            dispatch!(token, l => intersect::run(l, &self.plan().everything, &mut workspace.photons));
            self.sort_photons(workspace);
            let PhotonWorkspace { photons, next, diffuse, slots, .. } = workspace;
            let mark = if met == 0 { 0 } else { HIDDEN };
            let light = |slot: usize| slots.rows[slot] | mark;
            traced.account.nonfinite +=
                dispatch!(token, l => store::run(l, scene, &light, diffuse, &slots.power, &mut traced.photons));
            dispatch!(token, l => shadow::run(l, scene, photons, next));
            core::mem::swap(photons, next);
            next.clear();
            if photons.is_empty() {
                break;
            }
        }
        traced.account.kept = traced.photons.len() as u64;
    }

    /// Mirrors and dielectrics, as the plan has them.
    fn scatter_specular(
        &self,
        bounce: u32,
        (mirror, dielectric, next, power): (&Stream, &Stream, &mut Stream, &[f32]),
        account: &mut Account,
    ) {
        let (scene, token) = (self.scene(), self.token());
        let (fresnel, sampler): (Fresnel, SamplerKind) = (self.settings().fresnel, self.settings().sampler);
        let before = next.len();
        if !mirror.is_empty() {
            dispatch!(token, l => mirror::run(l, scene, Ending::Roulette(sampler), bounce, mirror, next));
            let went_on = (before..next.len()).map(|at| store::flux(next, at, power));
            add(&mut account.absorbed, difference(sum(mirror, power), total(went_on)));
        }
        if !dielectric.is_empty() {
            dispatch!(token, l => dielectric::run(l, scene, (fresnel, sampler), bounce, dielectric, next));
        }
    }

    /// What media take on the way.
    fn absorb(&self, PhotonWorkspace { photons, slots, .. }: &mut PhotonWorkspace, account: &mut Account) {
        let Some(media) = &self.scene().media else { return };
        let before = sum(photons, &slots.power);
        dispatch!(self.token(), l => absorb::run(l, media, photons));
        add(&mut account.absorbed, difference(before, sum(photons, &slots.power)));
    }

    fn sort_photons(&self, workspace: &mut PhotonWorkspace) {
        let PhotonWorkspace { photons, diffuse, mirror, dielectric, escaped, .. } = workspace;
        for stream in [&mut *diffuse, &mut *mirror, &mut *dielectric, &mut *escaped] {
            stream.clear();
            stream.reserve(photons.len());
        }
        let materials = [Some(diffuse), Some(mirror), Some(dielectric)];
        let mut bins = sort::Bins { emitters: None, escaped: Some(escaped), materials };
        dispatch!(self.token(), l => sort::run(l, self.scene(), false, photons, &mut bins));
    }
}

/// Flux of all photons of a stream.
fn sum(photons: &Stream, power: &[f32]) -> [f64; 3] {
    total((0..photons.len()).map(|at| store::flux(photons, at, power)))
}

/// Flux that landed where nothing is reflected.
fn on_black(scene: &Scene, photons: &Stream, power: &[f32]) -> [f64; 3] {
    if !scene.has(Class::Black) {
        return [0.0; 3];
    }
    let is_black = |at: &usize| scene.class(photons.value(PRIM, *at)) == Some(Class::Black);
    total((0..photons.len()).filter(is_black).map(|at| store::flux(photons, at, power)))
}

fn total(fluxes: impl Iterator<Item = [f32; 3]>) -> [f64; 3] {
    fluxes.fold([0.0; 3], |[r, g, b], flux| {
        let [x, y, z] = flux.map(f64::from);
        [r + x, g + y, b + z]
    })
}

fn add(to: &mut [f64; 3], more: [f64; 3]) {
    (0..3).for_each(|c| to[c] += more[c]);
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|c: usize| a[c] - b[c])
}
