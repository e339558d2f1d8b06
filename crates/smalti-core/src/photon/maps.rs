//! The maps of a round: emitted, traced and built, and how far their photons count.
//!
//! Rounds are independent, and their radius shrinks by r²ᵢ₊₁ = r²ᵢ (i + α) / (i + 1) (Knaus and Zwicker 2011, after
//! Hachisuka and Jensen 2009), so that noise and bias of their mean both go to zero.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::kd_tree::Tree;
use super::kernel::{Footprint, Kernels};
use super::pass::{Pass, PhotonWorkspace, Traced};
use super::{Account, Batch, Map, Photons, Pilot, SUB_MAPS, Surfaces, Visibility, pilot};
use crate::lanes::dispatch;
use crate::render::Renderer;

/// How fast the radius shrinks: of the rounds' mean, variance falls as n^−α and squared bias as n^(2α−2).
pub const ALPHA: f64 = 2.0 / 3.0;

/// The round of the photons that are sent ahead.
const AHEAD: u32 = u32::MAX;

/// What the samples of a round ask.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Maps {
    /// The round.
    pub round: u32,
    /// What radii have shrunk to since the first round.
    pub shrink: f32,
    /// Light that came by specular surfaces.
    pub caustic: Option<Layer>,
    /// All light.
    pub global: Option<Layer>,
    /// Where lights are seen and hidden; the same for all rounds.
    pub visibility: Option<Arc<Visibility>>,
}

/// A map, and what photons sent ahead say of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// How far its photons count, and what to expect of them.
    pub pilot: Arc<Pilot>,
    /// The photons.
    pub map: Map,
}

impl Maps {
    /// Where the light of all photons went.
    pub fn account(&self) -> Account {
        let mut account = Account::default();
        self.layers().for_each(|layer| account += &layer.map.account);
        account
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> u64 {
        let layers: u64 = self.layers().map(|layer| layer.map.bytes() + layer.pilot.bytes()).sum();
        layers + self.visibility.as_ref().map_or(0, |visibility| visibility.bytes())
    }

    /// The least and the largest radius of photons, in the frame; `None` without a photon.
    pub fn radii(&self) -> Option<[f32; 2]> {
        let radii = self.layers().filter_map(|layer| layer.map.radii());
        radii.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// What was sent ahead, for the maps of another round.
    pub fn pilots(&self) -> Pilots {
        let of = |layer: &Option<Layer>| layer.as_ref().map(|layer| layer.pilot.clone());
        Pilots { caustic: of(&self.caustic), global: of(&self.global), visibility: self.visibility.clone() }
    }

    fn layers(&self) -> impl Iterator<Item = &Layer> {
        self.caustic.iter().chain(&self.global)
    }
}

/// The photons of a round alone: what can be kept for another render of the same scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// The round.
    pub round: u32,
    /// Light that came by specular surfaces.
    pub caustic: Option<Map>,
    /// All light.
    pub global: Option<Map>,
}

/// What was sent ahead for each map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pilots {
    caustic: Option<Arc<Pilot>>,
    global: Option<Arc<Pilot>>,
    visibility: Option<Arc<Visibility>>,
}

impl Maps {
    /// The photons of the round alone.
    pub fn kept(&self) -> Kept {
        let of = |layer: &Option<Layer>| layer.as_ref().map(|layer| layer.map.clone());
        Kept { round: self.round, caustic: of(&self.caustic), global: of(&self.global) }
    }
}

impl Renderer {
    /// The maps of a round from what was kept of them; `None` where that is not what this render needs.
    pub fn maps_from(&self, kept: Kept, pilots: &Pilots) -> Option<Maps> {
        let photons = self.plan().photons.as_ref()?;
        let prims = self.scene().shades.len() as u32;
        let layer = |pass: &Option<Pass>, map: Option<Map>, pilot: &Option<Arc<Pilot>>| match (pass, map, pilot) {
            (None, None, _) => Some(None),
            (Some(pass), Some(map), Some(pilot)) => {
                let fits = map.kind == pass.kind && map.trees.len() == SUB_MAPS as usize && pilot.is_sound(prims);
                let sound = fits && map.trees.iter().all(|tree| tree.is_sound(prims));
                sound.then(|| Some(Layer { pilot: pilot.clone(), map }))
            }
            _ => None,
        };
        let visibility = pilots.visibility.clone();
        let sound = visibility.as_ref().is_none_or(|visibility| visibility.is_sound(prims));
        Some(Maps {
            round: kept.round,
            shrink: shrink(kept.round),
            caustic: layer(&photons.caustic, kept.caustic, &pilots.caustic)?,
            global: layer(&photons.global, kept.global, &pilots.global)?,
            visibility,
        })
        .filter(|maps| sound && maps.visibility.is_some() == photons.shadow.is_some())
    }

    /// Emits the photons of a round and builds its maps, on the threads of the current pool. `pilots` are those of
    /// another round's maps, which are the same for all; without them photons are sent ahead. `progress` counts the
    /// photons that were traced.
    pub fn maps(&self, round: u32, pilots: Pilots, progress: &AtomicU64) -> Maps {
        let Some(photons) = &self.plan().photons else { return Maps::default() };
        let layer = |pass: &Option<Pass>, pilot: Option<Arc<Pilot>>| {
            let pass = pass.as_ref()?;
            let on = &photons.surfaces;
            let pilot = pilot.unwrap_or_else(|| Arc::new(self.pilot(pass, (on, photons.radius), progress)));
            let map = self.map(pass, round, (on, &pilot), progress);
            Some(Layer { pilot, map })
        };
        let (caustic, global) = (layer(&photons.caustic, pilots.caustic), layer(&photons.global, pilots.global));
        let visibility = photons.shadow.as_ref().map(|pass| match pilots.visibility {
            Some(known) => known,
            None => Arc::new(self.visibility(pass, progress)),
        });
        Maps { round, shrink: shrink(round), caustic, global, visibility }
    }

    /// Photons that the maps of a round take, with those that are sent ahead or without.
    pub fn photons_of_round(&self, ahead: bool) -> u64 {
        let Some(photons) = &self.plan().photons else { return 0 };
        let of = |pass: &Pass| u64::from(pass.of_sub_map() * SUB_MAPS) + if ahead { pilot::PHOTONS.into() } else { 0 };
        let shadow = photons.shadow.as_ref().filter(|_| ahead).map_or(0, |pass| pass.photons.into());
        photons.caustic.iter().chain(&photons.global).map(of).sum::<u64>() + shadow
    }

    fn pilot(&self, pass: &Pass, (surfaces, radius): (&Surfaces, Option<f32>), progress: &AtomicU64) -> Pilot {
        let ahead = Pass { photons: pilot::PHOTONS, ..pass.clone() };
        let mut photons = Photons::default();
        for traced in self.traced(&ahead, ahead.batches(AHEAD), None, progress) {
            photons.places.extend(traced.photons.places);
            photons.flux.extend(traced.photons.flux);
        }
        let (of_map, wanted) =
            if self.plan().shows() { (pass.photons, pilot::SEEN) } else { (pass.of_sub_map(), pilot::WANTED) };
        Pilot::new(&photons, surfaces, pilot::Target { ahead: pilot::PHOTONS, of_map, wanted }, radius)
    }

    fn visibility(&self, pass: &Pass, progress: &AtomicU64) -> Visibility {
        Visibility::new(collected(&self.traced(pass, pass.batches(AHEAD), None, progress)).0)
    }

    /// Trees are built as workers become free, so that little more is held than the trees.
    fn map(&self, pass: &Pass, round: u32, (surfaces, pilot): (&Surfaces, &Pilot), progress: &AtomicU64) -> Map {
        let quantity = self.plan().quantity();
        let footprint = match self.settings().radius {
            Some(_) => Footprint::default(),
            None => Footprint::new(&self.scene().views, self.settings().height),
        };
        let kernels = Kernels { pilot, surfaces, shrink: shrink(round), footprint, quantity };
        let trees = self.plan().trees(self.settings());
        let sub_maps = |tree: u32| tree * SUB_MAPS / trees..(tree + 1) * SUB_MAPS / trees;
        let tree = |number: u32| {
            let batches = sub_maps(number).flat_map(|sub_map| pass.sub_map(round, sub_map)).collect();
            collected(&self.traced(pass, batches, Some(&kernels), progress))
        };
        let (built, accounts): (Vec<Tree>, Vec<Account>) = (0..trees).into_par_iter().map(tree).unzip();
        let mut account = Account::default();
        accounts.iter().for_each(|of_tree| account += of_tree);
        Map::new(pass.kind, round, built, account)
    }

    /// The batches, traced in parallel, in their order; with kernels, if they are to be gathered.
    fn traced(
        &self,
        pass: &Pass,
        batches: Vec<Batch>,
        kernels: Option<&Kernels<'_>>,
        progress: &AtomicU64,
    ) -> Vec<Traced> {
        let trace = |batch: Batch| {
            // Buffers are made once and passed on: making them takes as long as tracing a small batch.
            let free = || self.photon_workspaces.lock().unwrap_or_else(PoisonError::into_inner);
            let mut workspace = free().pop().unwrap_or_else(|| PhotonWorkspace::new(self.scene()));
            let mut traced = self.trace_photons(pass, batch, &mut workspace);
            if let Some(kernels) = kernels {
                dispatch!(self.token(), l => kernels.spread(l, &mut traced.photons));
            }
            free().push(workspace);
            progress.fetch_add(batch.count.into(), Ordering::Relaxed);
            traced
        };
        batches.into_par_iter().map(trace).collect()
    }
}

/// The photons of some batches as a tree, and where their light went.
fn collected(batches: &[Traced]) -> (Tree, Account) {
    let mut account = Account::default();
    batches.iter().for_each(|traced| account += &traced.account);
    (Tree::new(batches.iter().map(|traced| &traced.photons)), account)
}

/// The radius of a round by that of the first.
fn shrink(round: u32) -> f32 {
    let squared = (1..=round).map(f64::from).fold(1.0, |squared, i| squared * (i + ALPHA) / (i + 1.0));
    squared.sqrt() as f32
}
