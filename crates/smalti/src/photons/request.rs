//! From arguments as typed to a photon map that can be shown: every mistake that a user can make is found here.

use serde::Serialize;
use smalti_core::photon::{Kind, Show};
use smalti_core::render::Renderer;
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Settings};

use crate::args::{ImageArgs, PhotonImageArgs, PhotonsArgs};
use crate::exit::Failure;
use crate::frontend::{Step, Told};
use crate::job::Job;
use crate::memory::{self, Need};
use crate::names::{ColourArg, IntegratorArg, MapArg};

/// Photons for each light where nothing is said, as in the report.
const PHOTONS_OF_LIGHT: u32 = 1_000_000;

/// More photons than this in all must be asked for: for caustics, and of all light, where each is stored several times.
const MOST_UNASKED: [u32; 2] = [4_000_000, 1_000_000];

/// What is to be shown, checked.
#[derive(Debug)]
pub struct Request {
    /// The scene; of its settings those that a photon map has.
    pub job: Job,
    /// Which map.
    pub map: MapArg,
    /// What the colours tell.
    pub colour: ColourArg,
    /// The lights that photons leave.
    pub lights: Lights,
}

/// How many lights there are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lights {
    /// Polygons, spheres and meshes that emit.
    pub surfaces: usize,
    /// Point lights.
    pub points: usize,
}

impl Request {
    /// Reads the scene and applies the flags.
    pub fn load(args: &PhotonsArgs, told: &Told) -> Result<Self, Failure> {
        let mut job = Job::load(&args.scene, &flags(&args.image), args.run.work.simd.simd, told)?;
        let lights = Lights::of(&job.world);
        let usual = if has_casters(&job.world) { MapArg::Caustic } else { MapArg::Global };
        let map = args.image.map.unwrap_or(usual);
        let photons = args.image.photons.unwrap_or_else(|| lights.photons(map.into()));
        job.settings = settings(&job.settings, &args.image, photons);
        let photons = memory::map_bytes(map.into(), job.settings.photons_of_round());
        let shapes = memory::shapes(&job.world);
        Need { settings: &job.settings, downsample: 1, photons, shifts: false, shapes }.check(&memory::least())?;
        Ok(Self { job, map, colour: args.image.colour, lights })
    }

    /// Compiles the scene and plans what it takes.
    pub fn renderer(&self, told: &Told) -> Result<Renderer, Failure> {
        told(Step::Building { triangles: memory::triangles(&self.job.world) });
        let Job { world, settings, level, .. } = &self.job;
        let show = Show { map: self.map.into(), quantity: self.colour.quantity() };
        Renderer::showing(world, settings.clone(), show, *level).map_err(Failure::user)
    }

    /// The map in words.
    pub fn title(&self) -> &'static str {
        match self.map.into() {
            Kind::Caustic => "caustic map",
            Kind::Global => "map of all light",
            Kind::Shadow => "shadow photons",
        }
    }
}

impl Lights {
    fn of(world: &World) -> Self {
        Self { surfaces: world.emitting(), points: world.point_lights.len() }
    }

    /// Photons in all where nothing is said.
    fn photons(self, map: Kind) -> u32 {
        let lights = u32::try_from(self.surfaces + self.points).unwrap_or(u32::MAX);
        lights.max(1).saturating_mul(PHOTONS_OF_LIGHT).min(MOST_UNASKED[map as usize])
    }
}

/// Those flags that override the scene's settings.
fn flags(typed: &PhotonImageArgs) -> ImageArgs {
    ImageArgs {
        // Asks no photons of its own: how many there are is not known before the scene is.
        integrator: Some(IntegratorArg::Path),
        seed: typed.seed,
        size: typed.size,
        crop: typed.crop,
        camera: typed.camera.clone(),
        fresnel: typed.fresnel,
        ..ImageArgs::default()
    }
}

/// The settings of a photon map: what else the scene says is about a render.
fn settings(scene: &Settings, typed: &PhotonImageArgs, photons: u32) -> Settings {
    Settings {
        integrator: Integrator::Photon,
        width: scene.width,
        height: scene.height,
        crop: scene.crop,
        spp: typed.spp,
        seed: scene.seed,
        fresnel: scene.fresnel,
        camera: scene.camera,
        photons: Some(photons),
        radius: typed.radius,
        ..Settings::default()
    }
}

/// Whether something can cast caustics.
fn has_casters(world: &World) -> bool {
    let polygons = world.polygons.iter().map(|polygon| polygon.material);
    let spheres = world.spheres.iter().map(|sphere| sphere.material);
    let mut used = polygons.chain(spheres).chain(world.meshes.iter().map(|mesh| mesh.material));
    used.any(|material| world.materials[material].is_specular())
}

#[cfg(test)]
mod tests {
    use smalti_core::scene::world::{Material, Sphere};

    use super::*;

    #[test]
    fn every_light_has_a_million_photons_up_to_a_limit() {
        let photons = |surfaces, points| Lights { surfaces, points }.photons(Kind::Caustic);
        assert_eq!(photons(0, 0), 1_000_000);
        assert_eq!(photons(1, 0), 1_000_000);
        assert_eq!(photons(1, 2), 3_000_000);
        assert_eq!(photons(5000, usize::MAX - 5000), 4_000_000);
        assert_eq!(Lights { surfaces: 0, points: 3 }.photons(Kind::Global), 1_000_000);
    }

    #[test]
    fn materials_that_nothing_is_made_of_cast_no_caustics() {
        let ball = Sphere { centre: [0.0; 3].into(), radius: 1.0, material: 0, radiance: None };
        let materials = vec![Material::Lambert { albedo: [0.5; 3] }, Material::clear(1.5)];
        let world = World { materials, spheres: vec![ball], ..World::default() };
        assert!(!has_casters(&world));
        assert!(has_casters(&World { spheres: vec![Sphere { material: 1, ..ball }], ..world }));
    }
}
