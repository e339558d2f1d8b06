//! The plan: what of the renderer a scene and its settings require, with the reason for each decision.
//!
//! [`Plan::new`] is pure and the only place that decides. A plan is a list of stages; the executor runs them one after
//! the other, bounce by bounce, and knows nothing else.

mod photons;
mod reasons;

pub use photons::Photons;

use crate::accel::cones::Parts;
use crate::accel::{Accel, occluders};
use crate::glint::{Target, targets};
use crate::light::table::Kind;
use crate::photon::{Quantity, SUB_MAPS, Show, show};
use crate::scene::{Class, Scene};
use crate::settings::{Fresnel, Integrator, SamplerKind, Settings};
use crate::stream::Columns;
use crate::stream::mirror::Ending;

/// Bounces after which a path is ended and counted, whatever the settings say.
pub const MOST_BOUNCES: u32 = 4096;

/// Whitted: a branch that counts for less in the picture than this is not followed (report §1.1).
pub const LEAST_CONTRIBUTION: f32 = 1.0 / 1024.0;

/// One stage of a bounce.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// What every ray hits.
    Intersect,
    /// What is absorbed on the way there.
    Absorb,
    /// Hits to the streams of the stages that follow.
    Sort,
    /// Radiance of emitters that were hit.
    Emission,
    /// Radiance from infinity.
    Environment,
    /// Diffuse vertices from diffuse hits.
    Surface,
    /// Light samples at diffuse vertices.
    Direct {
        /// Whether weighed against scattered rays.
        weighed: bool,
    },
    /// The caustic map at diffuse vertices.
    Caustic,
    /// The map of all light at the second diffuse vertex, where the path ends.
    Gather,
    /// A map at the first diffuse vertex, where the path ends: the map is what is to be seen.
    Show(Show),
    /// The diffuse bounce.
    Diffuse,
    /// Reflection.
    Mirror(Ending),
    /// Reflection or refraction, by chance.
    Dielectric(Fresnel, SamplerKind),
    /// Reflection and refraction where both carry enough, else one by chance.
    Fork(Fresnel, SamplerKind),
    /// Reflection and refraction, as a tree.
    Split(Fresnel),
}

impl Stage {
    /// Whether it is a dielectric's.
    pub fn is_dielectric(&self) -> bool {
        matches!(self, Self::Dielectric(..) | Self::Fork(..) | Self::Split(_))
    }
}

/// What cannot be planned: a contradiction between scene and settings, in the user's words.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct PlanError {
    /// What is wrong and what can be done.
    pub message: String,
}

/// One thing that the plan decided, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The part of the renderer: `accelerator`, `stage`, `occluders`, `lights` ...
    pub subject: &'static str,
    /// What is used, for example `list of 15 primitives`.
    pub choice: String,
    /// Why.
    pub reason: String,
    /// Memory that it takes in all, bytes (0 where that is nothing worth a line).
    pub bytes: u64,
}

/// What a render will do.
pub struct Plan {
    /// Stages of a bounce, in order.
    pub stages: Vec<Stage>,
    /// Optional columns of the streams.
    pub columns: Columns,
    /// Scattering events after which paths end.
    pub max_bounces: u32,
    /// Everything, as rays meet it.
    pub everything: Accel,
    /// What can stop a shadow ray.
    pub occluders: Accel,
    /// The parts it falls into.
    pub parts: Parts,
    /// Photon maps.
    pub photons: Option<Photons>,
    /// Lamps that are looked for where they may be seen far smaller than a pixel.
    pub glints: Vec<Target>,
    /// The decisions with their reasons.
    pub decisions: Vec<Decision>,
}

impl Plan {
    /// Decides what this scene with these settings requires.
    ///
    /// # Errors
    /// Settings under which part of the light could not be found.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, PlanError> {
        check(scene, settings)?;
        let in_the_way = if samples_lights(scene, settings) { occluders::of(scene) } else { Vec::new() };
        let (occluders, parts) = (Accel::new(scene, &in_the_way), Parts::new(scene, &in_the_way));
        let photons = Photons::new(scene, settings, !in_the_way.is_empty());
        let stages = stages(scene, settings, photons.as_ref());
        let glints = targets(scene, settings);
        let columns = columns(scene, settings, photons.as_ref());
        let columns = Columns { eta: columns.eta || !glints.is_empty(), ..columns };
        let plan = Self { columns, occluders, parts, photons, glints, ..Self::of(scene, settings, stages) };
        Ok(plan.reasoned(scene, settings))
    }

    /// Decides what it takes to see a photon map; of the settings the integrator and the light samples do not matter.
    ///
    /// # Errors
    /// A scene in which that map is empty.
    pub fn showing(scene: &Scene, settings: &Settings, show: Show) -> Result<Self, PlanError> {
        let photons = Photons::showing(scene, settings, show.map).map_err(|message| PlanError { message })?;
        let columns =
            Columns { eta: scene.has(Class::Dielectric), medium: scene.media.is_some(), ..Columns::default() };
        let stages = stages_that_show(scene, settings, show);
        let plan = Self { columns, photons: Some(photons), ..Self::of(scene, settings, stages) };
        Ok(plan.reasoned(scene, settings))
    }

    /// These stages alone, and what every plan has.
    fn of(scene: &Scene, settings: &Settings, stages: Vec<Stage>) -> Self {
        let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
        Self {
            stages,
            columns: Columns::default(),
            max_bounces: settings.max_bounces.unwrap_or(MOST_BOUNCES).min(MOST_BOUNCES),
            everything: Accel::new(scene, &prims),
            occluders: Accel::new(scene, &[]),
            parts: Parts::new(scene, &[]),
            photons: None,
            glints: Vec::new(),
            decisions: Vec::new(),
        }
    }

    /// The same with its reasons.
    fn reasoned(mut self, scene: &Scene, settings: &Settings) -> Self {
        self.decisions = reasons::of(&self, scene, settings);
        self
    }

    /// Trees that a photon map is built of.
    pub fn trees(&self, settings: &Settings) -> u32 {
        if self.shows() { show::trees(settings.spp) } else { SUB_MAPS }
    }

    /// Whether a photon map is what is to be seen.
    pub fn shows(&self) -> bool {
        self.has(|stage| matches!(stage, Stage::Show(_)))
    }

    /// The quantity that photons bring.
    pub fn quantity(&self) -> Quantity {
        let shown = self.stages.iter().find_map(|stage| match stage {
            Stage::Show(show) => Some(show.quantity),
            _ => None,
        });
        shown.unwrap_or(Quantity::Radiance)
    }

    /// Whether paths find again what photons bring: lamps whose caustics are in the map can be hit.
    pub fn finds_twice(&self) -> bool {
        let in_map = self.photons.as_ref().is_some_and(|photons| photons.in_map.contains(&1));
        in_map && self.has(|stage| *stage == Stage::Caustic) && self.has(|stage| *stage == Stage::Emission)
    }

    /// Whether some stage of the plan meets `test`.
    pub fn has(&self, test: impl Fn(&Stage) -> bool) -> bool {
        self.stages.iter().any(test)
    }
}

fn check(scene: &Scene, settings: &Settings) -> Result<(), PlanError> {
    if settings.shadow_rays == 0 && scene.lights.has(Kind::Point) {
        let message = "a point light can only be found by shadow rays, but `shadow_rays` is 0: \
                       set it to 1 or more, or give the light an extent";
        return Err(PlanError { message: message.into() });
    }
    if settings.shadow_rays == 0 && settings.integrator == Integrator::Whitted && !scene.lights.rows.is_empty() {
        let message = "`whitted` finds direct light by shadow rays alone, but `shadow_rays` is 0: set it to 1 or more";
        return Err(PlanError { message: message.into() });
    }
    Ok(())
}

/// Whether shadow rays are asked at all.
fn samples_lights(scene: &Scene, settings: &Settings) -> bool {
    scene.has(Class::Lambert) && settings.shadow_rays > 0 && !scene.lights.rows.is_empty()
}

/// Stages in the order in which they run.
fn stages(scene: &Scene, settings: &Settings, photons: Option<&Photons>) -> Vec<Stage> {
    let path = settings.integrator != Integrator::Whitted;
    let lambert = scene.has(Class::Lambert);
    let samples_lights = samples_lights(scene, settings);
    let fresnel = settings.fresnel;
    // Only light that a ray can hit has highlights.
    let is_hit = !scene.lights.emitters.is_empty() || scene.environment.is_some();
    let glass = match (path, is_hit) {
        (true, true) => Stage::Fork(fresnel, settings.sampler),
        (true, false) => Stage::Dielectric(fresnel, settings.sampler),
        (false, _) => Stage::Split(fresnel),
    };
    let ending = if path { Ending::Roulette(settings.sampler) } else { Ending::Threshold(LEAST_CONTRIBUTION) };
    [
        (Stage::Intersect, true),
        (Stage::Absorb, scene.media.is_some()),
        (Stage::Sort, true),
        (Stage::Emission, !scene.lights.emitters.is_empty()),
        (Stage::Environment, scene.environment.is_some()),
        (Stage::Surface, lambert && (path || samples_lights)),
        (Stage::Gather, photons.is_some_and(|photons| photons.global.is_some())),
        (Stage::Direct { weighed: path }, samples_lights),
        (Stage::Caustic, photons.is_some_and(|photons| photons.caustic.is_some())),
        (Stage::Diffuse, lambert && path),
        (Stage::Mirror(ending), scene.has(Class::Mirror)),
        (glass, scene.has(Class::Dielectric)),
    ]
    .into_iter()
    .filter_map(|(stage, needed)| needed.then_some(stage))
    .collect()
}

/// Stages that show a photon map: those of camera paths up to the first diffuse vertex.
fn stages_that_show(scene: &Scene, settings: &Settings, show: Show) -> Vec<Stage> {
    let radiance = show.quantity == Quantity::Radiance;
    [
        (Stage::Intersect, true),
        (Stage::Absorb, scene.media.is_some()),
        (Stage::Sort, true),
        (Stage::Emission, radiance && !scene.lights.emitters.is_empty()),
        (Stage::Environment, radiance && scene.environment.is_some()),
        (Stage::Surface, true),
        (Stage::Show(show), true),
        (Stage::Mirror(Ending::Roulette(settings.sampler)), scene.has(Class::Mirror)),
        (Stage::Dielectric(settings.fresnel, settings.sampler), scene.has(Class::Dielectric)),
    ]
    .into_iter()
    .filter_map(|(stage, needed)| needed.then_some(stage))
    .collect()
}

fn columns(scene: &Scene, settings: &Settings, photons: Option<&Photons>) -> Columns {
    let two_ways = settings.shadow_rays > 0 && !scene.lights.emitters.is_empty() && scene.has(Class::Lambert);
    let pdf = photons.is_some() || (two_ways && settings.integrator != Integrator::Whitted);
    let (eta, medium) = (scene.has(Class::Dielectric), scene.media.is_some());
    Columns { pdf, eta, medium, marks: photons.is_some() }
}
