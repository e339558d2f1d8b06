//! The renderer as others see it: a compiled scene, a plan and the means to add samples to a tile.

use std::ops::{ControlFlow, Range};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::film::{Counts, Crosscheck, ROUND, Shift, Tile};
use crate::glint::Glints;
pub use crate::lanes::Level;
use crate::lanes::dispatch;
use crate::mutant::mutant;
use crate::photon::gather::Gather;
use crate::photon::maps::{Layer, Maps};
use crate::photon::pass::PhotonWorkspace;
use crate::photon::{Kind, Quantity, SUB_MAPS, Show};
pub use crate::plan::{Decision, PlanError};
use crate::plan::{Plan, Stage};
pub use crate::replay::Vertex;
use crate::scene::media::CLEAR;
use crate::scene::{Scene, World, compile};
use crate::settings::{Integrator, Settings};
use crate::stream::{
    Columns, MOST_SLOTS, Slots, Stream, absorb, dielectric, diffuse, direct, emission, environment, gather, generate,
    intersect, mirror, sort, surface,
};

/// Paths that go through the stages together: enough to keep lanes full, few enough to stay in the cache.
const BATCH: usize = 4096;

/// Rays that were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Rays from the camera.
    pub camera: u64,
    /// Rays that left a surface.
    pub scattered: u64,
    /// Shadow rays asked, pruned or not.
    pub shadow: u64,
}

impl core::ops::AddAssign for RayCounts {
    fn add_assign(&mut self, other: Self) {
        self.camera += other.camera;
        self.scattered += other.scattered;
        self.shadow += other.shadow;
    }
}

/// A sample that was not finite: it counts as 0 and can be replayed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rejected {
    /// Column and row in the whole image.
    pub pixel: (u32, u32),
    /// Sample number.
    pub sample: u32,
}

/// What one call of [`Renderer::advance`] did.
#[derive(Clone, Debug, Default)]
pub struct Work {
    /// Rays traced.
    pub rays: RayCounts,
    /// Samples that were not finite.
    pub rejected: Vec<Rejected>,
    /// Paths that the hard cap on bounces ended.
    pub capped: u64,
}

/// A compiled scene with its plan; shared by all workers.
pub struct Renderer {
    scene: Scene,
    plan: Plan,
    settings: Settings,
    level: Level,
    token: Option<fearless_simd::Level>,
    /// Where glints are, if the plan looks for any.
    glints: Option<Glints>,
    /// Buffers of photon passes that nobody uses at the moment.
    pub(crate) photon_workspaces: Mutex<Vec<PhotonWorkspace>>,
}

/// Buffers of one worker; made once and reused.
pub struct Workspace {
    pub(crate) pixels: generate::Pixels,
    pub(crate) slots: Slots,
    pub(crate) rays: Stream,
    pub(crate) next: Stream,
    pub(crate) diffuse: Stream,
    mirror: Stream,
    dielectric: Stream,
    emitters: Stream,
    escaped: Stream,
    shadows: direct::Shadows,
    asking: Stream,
    first: Stream,
}

impl Renderer {
    /// Compiles `world` and plans what `settings` need of it.
    ///
    /// # Errors
    /// Settings that the scene cannot meet.
    pub fn new(world: &World, settings: Settings, level: Level) -> Result<Self, PlanError> {
        let scene = compile(world, settings.integrator == Integrator::Whitted);
        let plan = Plan::new(&scene, &settings)?;
        Ok(Self::of(scene, plan, settings, level))
    }

    /// Compiles `world` and plans to show a photon map of it, instead of all the light.
    ///
    /// # Errors
    /// A scene in which that map is empty.
    pub fn showing(world: &World, settings: Settings, show: Show, level: Level) -> Result<Self, PlanError> {
        let scene = compile(world, false);
        let plan = Plan::showing(&scene, &settings, show)?;
        Ok(Self::of(scene, plan, settings, level))
    }

    fn of(scene: Scene, plan: Plan, settings: Settings, level: Level) -> Self {
        let glints = (!plan.glints.is_empty()).then(|| Glints::new(settings.width, settings.height));
        Self { scene, plan, settings, level, token: level.token(), glints, photon_workspaces: Mutex::default() }
    }

    /// Settings of this render.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The compiled scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What the render does.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The SIMD level that is used.
    pub fn level(&self) -> Level {
        self.level
    }

    /// The level's token, for the dispatch of a stage.
    pub(crate) fn token(&self) -> Option<fearless_simd::Level> {
        self.token
    }

    /// What the plan decided.
    pub fn decisions(&self) -> &[Decision] {
        &self.plan.decisions
    }

    /// Buffers for one worker. Streams that the plan has no stage for are empty.
    pub fn workspace(&self) -> Workspace {
        let stream = |needed: bool| Stream::new(if needed { BATCH } else { 0 }, self.plan.columns);
        let has = |test: fn(&Stage) -> bool| stream(self.plan.has(test));
        Workspace {
            pixels: generate::Pixels::default(),
            slots: Slots::default(),
            rays: stream(true),
            next: stream(true),
            diffuse: has(|stage| *stage == Stage::Surface),
            mirror: has(|stage| matches!(stage, Stage::Mirror(_))),
            dielectric: has(Stage::is_dielectric),
            emitters: has(|stage| *stage == Stage::Emission),
            escaped: has(|stage| *stage == Stage::Environment),
            shadows: direct::Shadows::default(),
            asking: Stream::new(if self.plan.photons.is_some() { BATCH } else { 0 }, Columns::default()),
            first: has(|stage| *stage == Stage::Gather),
        }
    }

    /// Adds samples to `tile` until every pixel of it has `until` samples. `progress` counts the samples as they are
    /// finished (relaxed), for a display.
    ///
    /// # Panics
    /// If the plan has photon maps, and a sample is not of the round that `maps` serve.
    pub fn advance(
        &self,
        tile: &mut Tile,
        until: u32,
        maps: &Maps,
        workspace: &mut Workspace,
        progress: &AtomicU64,
    ) -> Work {
        assert!(self.plan.photons.is_none() || rounds(tile.samples(), until).all(|round| round == maps.round));
        self.add(tile, until, None, (maps, workspace, progress))
    }

    /// Adds a round of `samples` samples to every pixel of `tile`, each of which counts `weight` times, with the photons of
    /// `maps`, whichever they are.
    pub fn visit(
        &self,
        tile: &mut Tile,
        (samples, weight): (u32, f64),
        maps: &Maps,
        workspace: &mut Workspace,
        progress: &AtomicU64,
    ) -> Work {
        let work = self.add(tile, tile.samples() + samples, Some(weight), (maps, workspace, progress));
        tile.counts.end_round();
        work
    }

    /// Adds samples; those of a visit count `weight` times and end no round.
    fn add(
        &self,
        tile: &mut Tile,
        until: u32,
        weight: Option<f64>,
        (maps, workspace, progress): (&Maps, &mut Workspace, &AtomicU64),
    ) -> Work {
        let mut work = Work::default();
        let pixels = tile.pixels.len();
        let at_once = pixels.min(BATCH);
        let samples_at_once = (BATCH / at_once) as u32;
        while tile.samples() < until {
            let (from, to) = (tile.samples(), until.min(tile.samples() + samples_at_once));
            let mut counts = tile.counts;
            for first in (0..pixels).step_by(at_once) {
                let batch = first..pixels.min(first + at_once);
                workspace.pixels.set(tile.area, batch.start, batch.end);
                self.trace(workspace, from..to, maps, &mut work);
                counts = deposit(workspace, tile, (from..to, weight), &mut work);
                progress.fetch_add((batch.len() * (to - from) as usize) as u64, Ordering::Relaxed);
            }
            tile.counts = counts;
        }
        work
    }

    /// Traces samples of the workspace's pixels to the end; their radiance is in its slots.
    fn trace(&self, workspace: &mut Workspace, samples: Range<u32>, maps: &Maps, work: &mut Work) {
        self.generate(workspace, samples);
        work.rays.camera += workspace.rays.len() as u64;
        let asks = self.plan.has(|stage| matches!(stage, Stage::Direct { .. }));
        for bounce in 0..=self.plan.max_bounces {
            if bounce == self.plan.max_bounces && self.settings.max_bounces.is_none() {
                work.capped += workspace.rays.len() as u64;
            }
            let next = self.bounce(bounce, maps, workspace, |_, _| {});
            if asks {
                let asked = workspace.diffuse.len() as u64 * u64::from(self.settings.shadow_rays);
                work.rays.shadow += asked - core::mem::take(&mut workspace.shadows.saved);
            }
            work.rays.scattered += workspace.rays.len() as u64;
            if next == ControlFlow::Break(()) {
                break;
            }
        }
    }

    /// Takes the stream through all stages once; what scattered is the new stream. `look` sees what each
    /// stage has done.
    pub(crate) fn bounce(
        &self,
        bounce: u32,
        maps: &Maps,
        workspace: &mut Workspace,
        mut look: impl FnMut(Stage, &Workspace),
    ) -> ControlFlow<()> {
        let ends = bounce == self.plan.max_bounces;
        for stage in &self.plan.stages {
            self.perform(*stage, (bounce, ends), maps, workspace);
            look(*stage, workspace);
        }
        core::mem::swap(&mut workspace.rays, &mut workspace.next);
        workspace.next.clear();
        if workspace.rays.is_empty() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Camera rays of some samples of the workspace's pixels, and a slot for each.
    pub(crate) fn generate(&self, workspace: &mut Workspace, samples: Range<u32>) {
        let Workspace { pixels, rays, slots, .. } = workspace;
        let view = &self.scene.views[self.settings.camera];
        if let Some(glints) = &self.glints {
            pixels.find_glints(|pixel| glints.at(self, pixel));
        }
        let mut first = 0;
        let mut round = None;
        for sample in samples {
            if round != Some(sample / ROUND) {
                round = Some(sample / ROUND);
                pixels.enter_round(self.settings.seed, sample / ROUND);
            }
            let what = (view, self.medium_of_camera(), &self.settings, self.plan.columns);
            dispatch!(self.token, l => generate::run(l, what, pixels, (sample, first), rays));
            generate::towards_glints((view, &self.settings), pixels, (sample, first), rays);
            first = rays.len();
        }
        assert!(first <= MOST_SLOTS);
        let shifts = self.plan.has(|stage| matches!(stage, Stage::Caustic | Stage::Gather));
        slots.reset(first, shifts, self.plan.finds_twice());
    }

    /// Number of the medium that the camera is in.
    pub(crate) fn medium_of_camera(&self) -> u32 {
        self.scene.media.as_ref().map_or(CLEAR, |media| media.views[self.settings.camera])
    }

    /// Runs one stage over its stream: the one place where stages are told apart.
    fn perform(&self, stage: Stage, (bounce, ends): (u32, bool), maps: &Maps, workspace: &mut Workspace) {
        let Workspace {
            slots, rays, next, diffuse, mirror, dielectric, emitters, escaped, shadows, asking, first, ..
        } = workspace;
        let (scene, settings, token) = (&self.scene, &self.settings, self.token);
        match stage {
            Stage::Intersect => dispatch!(token, l => intersect::run(l, &self.plan.everything, rays)),
            Stage::Absorb => {
                let Some(media) = &scene.media else { return };
                dispatch!(token, l => absorb::run(l, media, rays));
            }
            Stage::Sort => self.sort(ends, workspace),
            Stage::Emission => {
                let in_map = self.plan.photons.as_ref().map(|photons| &photons.in_map[..]);
                dispatch!(token, l => emission::run(l, scene, (settings.shadow_rays, in_map), emitters, slots));
            }
            Stage::Environment => {
                let radiance = scene.environment.unwrap_or_default();
                dispatch!(token, l => environment::run(l, radiance, escaped, slots));
            }
            Stage::Surface => dispatch!(token, l => surface::run(l, scene, diffuse)),
            Stage::Direct { weighed } => {
                let Plan { occluders, parts, .. } = &self.plan;
                let surfaces = self.plan.photons.as_ref().map(|photons| &photons.surfaces);
                let decided = maps.visibility.as_deref().zip(surfaces);
                let (lights, media) = (&scene.lights, scene.media.as_ref());
                let context = direct::Context { lights, occluders, parts, settings, weighed, media, decided };
                dispatch!(token, l => direct::run(l, &context, bounce, diffuse, shadows, slots));
            }
            Stage::Caustic => {
                let Some(context) = self.photons(bounce, maps.caustic.as_ref()) else { return };
                dispatch!(token, l => gather::caustic(l, &context, bounce, diffuse, asking, slots));
            }
            Stage::Gather => {
                let Some(context) = self.photons(bounce, maps.global.as_ref()) else { return };
                dispatch!(token, l => gather::last(l, &context, diffuse, (asking, first), slots));
            }
            Stage::Show(Show { map, quantity }) => {
                let layer = if map == Kind::Caustic { &maps.caustic } else { &maps.global };
                let Some(context) = self.photons(bounce, layer.as_ref()) else { return };
                let what = self.shown(quantity);
                dispatch!(token, l => gather::shown(l, &context, what, diffuse, slots));
            }
            Stage::Diffuse => dispatch!(token, l => diffuse::run(l, settings.sampler, bounce, diffuse, next)),
            Stage::Mirror(ending) => {
                dispatch!(token, l => mirror::run(l, scene, ending, bounce, mirror, next));
            }
            Stage::Dielectric(fresnel, sampler) => {
                dispatch!(token, l => dielectric::run(l, scene, (fresnel, sampler), bounce, dielectric, next));
            }
            Stage::Fork(fresnel, sampler) => {
                dispatch!(token, l => dielectric::fork(l, scene, (fresnel, sampler), bounce, dielectric, next));
            }
            Stage::Split(fresnel) => {
                let least = crate::plan::LEAST_CONTRIBUTION;
                dispatch!(token, l => dielectric::split(l, scene, fresnel, least, dielectric, next));
            }
        }
    }

    /// How a map is asked after `bounce` scattering events.
    fn photons<'a>(&'a self, bounce: u32, layer: Option<&'a Layer>) -> Option<gather::Context<'a>> {
        let photons = self.plan.photons.as_ref()?;
        let Layer { pilot, map } = layer?;
        let most_bounces = self.plan.max_bounces.checked_sub(1 + bounce)?;
        Some(gather::Context {
            gather: Gather { map, surfaces: &photons.surfaces, most_bounces },
            pilot,
            scene: &self.scene,
            reference: photons.reference,
            sampler: self.settings.sampler,
        })
    }

    /// What is shown of a map, how many trees it has, and what the figure of a tree counts for: of radiance each sub-map
    /// has all, of photons each tree its part; the frame's area is not a square metre.
    fn shown(&self, quantity: Quantity) -> (Quantity, u32, f32) {
        let trees = self.plan.trees(&self.settings);
        let scale = self.scene.frame.scale;
        let counts = match quantity {
            Quantity::Radiance => f64::from(trees) / f64::from(SUB_MAPS),
            Quantity::Count => f64::from(trees) * scale * scale,
        };
        (quantity, trees, counts as f32)
    }

    fn sort(&self, ends: bool, workspace: &mut Workspace) {
        let Workspace { rays, diffuse, mirror, dielectric, emitters, escaped, .. } = workspace;
        let waiting = rays.len();
        let mut bins = sort::Bins {
            emitters: ready(emitters, waiting, self.plan.has(|stage| *stage == Stage::Emission)),
            escaped: ready(escaped, waiting, self.plan.has(|stage| *stage == Stage::Environment)),
            materials: [
                ready(diffuse, waiting, self.plan.has(|stage| *stage == Stage::Surface)),
                ready(mirror, waiting, self.plan.has(|stage| matches!(stage, Stage::Mirror(_)))),
                ready(dielectric, waiting, self.plan.has(Stage::is_dielectric)),
            ],
        };
        dispatch!(self.token, l => sort::run(l, &self.scene, ends, rays, &mut bins));
    }
}

/// Rounds that the samples `from..until` are of.
fn rounds(from: u32, until: u32) -> impl Iterator<Item = u32> {
    from / ROUND..until.div_ceil(ROUND)
}

/// An emptied stream with room for `waiting` paths, where the plan needs it.
fn ready(stream: &mut Stream, waiting: usize, needed: bool) -> Option<&mut Stream> {
    stream.clear();
    needed.then(|| {
        stream.reserve(waiting);
        stream
    })
}

/// Adds the slots of a batch to its pixels, in sample order. Returns the counts with these samples.
fn deposit(
    workspace: &Workspace,
    tile: &mut Tile,
    (samples, weight): (Range<u32>, Option<f64>),
    work: &mut Work,
) -> Counts {
    let mut counts = tile.counts;
    for (number, sample) in samples.enumerate() {
        deposit_sample(workspace, tile, (number, sample), (&counts, weight.unwrap_or(1.0)), work);
        if mutant!("a_round_counted_twice") && sample / ROUND == 1 {
            deposit_sample(workspace, tile, (number, sample), (&counts, weight.unwrap_or(1.0)), work);
            counts.weights[counts.batch()] += 1.0;
        }
        match weight {
            Some(weight) => counts.add(weight),
            None => counts.add_plain(),
        }
    }
    counts
}

/// Adds the slots of one sample of each pixel, the batch's `number`-th.
fn deposit_sample(
    workspace: &Workspace,
    tile: &mut Tile,
    (number, sample): (usize, u32),
    (counts, weight): (&Counts, f64),
    work: &mut Work,
) {
    let pixels = workspace.pixels.numbers();
    let of_sample = number * pixels.len()..(number + 1) * pixels.len();
    let indices = pixels.iter().map(|pixel| *pixel as usize);
    for (pixel, radiance) in indices.clone().zip(&workspace.slots.radiance()[of_sample.clone()]) {
        let finite = radiance.iter().all(|x| x.is_finite());
        if !finite {
            work.rejected.push(rejected(tile, pixel, sample));
        }
        tile.pixels[pixel].add(counts.batch(), weight, if finite { *radiance } else { [0.0; 3] });
    }
    if let Some(twice) = workspace.slots.twice().get(of_sample.clone()) {
        tile.crosschecks.resize(tile.pixels.len(), Crosscheck::default());
        let checks = indices.clone().zip(twice);
        checks.for_each(|(pixel, twice)| tile.crosschecks[pixel].add(counts.half(), weight, *twice));
    }
    let Some(shifts) = workspace.slots.shift().get(of_sample) else { return };
    tile.shifts.resize(tile.pixels.len(), Shift::default());
    for (pixel, shift) in indices.zip(shifts) {
        if shift.iter().all(|x| x.is_finite()) {
            let sum = &mut tile.shifts[pixel][counts.half()];
            (0..3).for_each(|c| sum[c] += shift[c]);
        }
    }
}

fn rejected(tile: &Tile, pixel: usize, sample: u32) -> Rejected {
    Rejected { pixel: tile.area.pixel(pixel), sample }
}
