//! From arguments as typed to a job that can start: the scene is read, flags override its settings, and every mistake
//! that a user can make is found.

use std::path::{Path, PathBuf};

use rayon::ThreadPool;
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::settings::{Rect, Settings};
use smalti_scene::{Loaded, Note, Reading};

use crate::args::ImageArgs;
use crate::exit::Failure;
use crate::frontend::{Step, Told};
use crate::memory::{self, Need};
use crate::names::{SimdArg, SwitchArg};
use crate::parse::Size;
use crate::{budget, downsample};

/// A scene with the settings of its render, checked.
#[derive(Debug)]
pub struct Job {
    /// The scene file as typed.
    pub path: PathBuf,
    /// What the scene file says.
    pub world: World,
    /// What is rendered: the scene's settings, overridden by flags.
    pub settings: Settings,
    /// Pixels that become one of the image, in each direction.
    pub downsample: u32,
    /// Hash of what the scene file and its meshes say.
    pub scene_hash: String,
    /// What is worth knowing and stops nothing: the reader's notes first, then those of later stages.
    pub notes: Vec<Note>,
    /// The SIMD level to use.
    pub level: Level,
    /// What the scene suggests where no flag says otherwise: the side of a tile.
    tile: Option<u32>,
    /// The same for the brightness of tone-mapped files, stops.
    exposure: Option<f64>,
}

/// Side of a tile in pixels where neither flag nor scene says otherwise.
const TILE: u32 = 32;

impl Job {
    /// Reads `scene` and applies the flags.
    pub fn load(scene: &Path, flags: &ImageArgs, simd: SimdArg, told: &Told) -> Result<Self, Failure> {
        Self::load_downsampled(scene, (flags, 1), simd, told)
    }

    /// [`Job::load`] with `by` × `by` pixels for each one of the image that the flags ask for.
    pub fn load_downsampled(
        scene: &Path,
        (flags, by): (&ImageArgs, u32),
        simd: SimdArg,
        told: &Told,
    ) -> Result<Self, Failure> {
        let job = Self::read(scene, flags, simd, told)?;
        check_area(&job.settings)?;
        let settings = downsample::rendered(job.settings, by)?;
        // Whether photons are asked, where nothing says how many, is known when the scene is built.
        let photons = settings.photons.map_or(0, |_| memory::photon_bytes(&settings));
        let shapes = memory::shapes(&job.world);
        Need { settings: &settings, downsample: by, photons, shifts: false, shapes }.check(&memory::least())?;
        Ok(Self { settings, downsample: by, ..job })
    }

    /// Reads `scene` and applies the flags, without a look at whether what they ask for can be rendered.
    pub fn read(scene: &Path, flags: &ImageArgs, simd: SimdArg, told: &Told) -> Result<Self, Failure> {
        let level = choose_level(simd, &Level::available())?;
        let loaded = read_scene(scene, told)?;
        let settings = merge(loaded.settings.settings(), flags, &loaded.world)?;
        Ok(Self {
            path: scene.to_owned(),
            world: loaded.world,
            settings,
            downsample: 1,
            scene_hash: loaded.scene_hash,
            notes: loaded.notes,
            level,
            tile: loaded.settings.tile,
            exposure: loaded.settings.exposure,
        })
    }

    /// Refuses a render that does not fit beside its scene, now that this is built.
    pub fn check_memory(&self, renderer: &Renderer, pool: &ThreadPool) -> Result<(), Failure> {
        // The C library reserves addresses for a thread when it allocates first: they are to be counted as taken.
        pool.broadcast(|_| drop(renderer.workspace()));
        let shifts = renderer.plan().photons.is_some();
        let photons = if shifts { memory::photon_bytes(&self.settings) } else { 0 };
        let need = Need { settings: &self.settings, downsample: self.downsample, photons, shifts, shapes: 0 };
        need.check(&memory::least())
    }

    /// Side of a tile in pixels.
    pub fn tile(&self, typed: Option<u32>) -> u32 {
        budget::tile(self.settings.adaptive, self.downsample, typed.or(self.tile).unwrap_or(TILE))
    }

    /// Brightness of tone-mapped files in stops.
    pub fn exposure(&self, typed: Option<f64>) -> f32 {
        typed.or(self.exposure).unwrap_or(0.0) as f32
    }

    /// Name of the camera that is used; empty for the only one.
    pub fn camera(&self) -> &str {
        &self.world.cameras[self.settings.camera].name
    }

    /// Compiles the scene and plans the render.
    pub fn renderer(&self, told: &Told) -> Result<Renderer, Failure> {
        told(Step::Building { triangles: memory::triangles(&self.world) });
        Renderer::new(&self.world, self.settings.clone(), self.level).map_err(Failure::user)
    }
}

/// Reads the scene file and its meshes, as far as there is memory for them.
fn read_scene(scene: &Path, told: &Told) -> Result<Loaded, Failure> {
    let reading = |path: &Path, bytes| told(Step::Reading { file: path.display().to_string(), bytes });
    scene.metadata().iter().for_each(|about| reading(scene, about.len()));
    let watch = |mesh: &Reading| {
        reading(mesh.path, mesh.bytes);
        memory::check_mesh(mesh.path, mesh.bytes, &memory::least())
    };
    smalti_scene::load_watched(scene, &watch).map_err(|error| Failure::scene(&error))
}

/// The level that was asked for, if the machine has it; the best one for `auto`.
fn choose_level(typed: SimdArg, available: &[Level]) -> Result<Level, Failure> {
    let wanted = typed.level().unwrap_or(available[0]);
    if available.contains(&wanted) {
        return Ok(wanted);
    }
    let names: Vec<&str> = available.iter().map(|level| level.name()).collect();
    Err(Failure::user(format!("this machine has no {}; it has {}", wanted.name(), names.join(", "))))
}

/// The scene file's settings, overridden by flags.
fn merge(scene: Settings, flags: &ImageArgs, world: &World) -> Result<Settings, Failure> {
    let Size { width, height } = flags.size.unwrap_or(Size { width: scene.width, height: scene.height });
    let named = flags.camera.as_deref().map(|name| find_camera(name, world)).transpose()?;
    Ok(Settings {
        integrator: flags.integrator.map_or(scene.integrator, Into::into),
        width,
        height,
        crop: flags.crop.or(scene.crop),
        spp: flags.spp.unwrap_or(scene.spp),
        shadow_rays: flags.shadow_rays.unwrap_or(scene.shadow_rays),
        max_bounces: flags.max_bounces.or(scene.max_bounces),
        sampler: flags.sampler.map_or(scene.sampler, Into::into),
        seed: flags.seed.unwrap_or(scene.seed),
        fresnel: flags.fresnel.map_or(scene.fresnel, Into::into),
        jitter: scene.jitter && !flags.no_jitter,
        adaptive: flags.adaptive.map_or(scene.adaptive, |typed| typed == SwitchArg::On),
        camera: named.unwrap_or(scene.camera),
        photons: flags.photons.or(scene.photons),
        radius: flags.radius.or(scene.radius),
    })
}

/// Index of the camera called `name`.
fn find_camera(name: &str, world: &World) -> Result<usize, Failure> {
    if let Some(index) = world.cameras.iter().position(|camera| camera.name == name) {
        return Ok(index);
    }
    let names: Vec<&str> = world.cameras.iter().map(|camera| camera.name.as_str()).filter(|n| !n.is_empty()).collect();
    if names.is_empty() {
        return Err(Failure::user(format!("no camera is called '{name}': the scene's only camera has no name")));
    }
    let meant = nearest(name, &names).map_or(".".into(), |near| format!("; did you mean '{near}'?"));
    Err(Failure::user(format!("no camera is called '{name}'{meant} The scene has: {}", names.join(", "))))
}

/// The candidate most like `name`, if any is like it at all; the first of equals.
pub fn nearest<'a>(name: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let mut best = (0.75, None);
    for &candidate in candidates {
        let likeness = strsim::jaro_winkler(&name.to_lowercase(), &candidate.to_lowercase());
        if likeness > best.0 {
            best = (likeness, Some(candidate));
        }
    }
    best.1
}

/// The crop must lie inside the image.
fn check_area(settings: &Settings) -> Result<(), Failure> {
    let (Rect { x, y, width, height }, whole) = (settings.area(), (settings.width, settings.height));
    let inside = |start: u32, length: u32, end: u32| start.checked_add(length).is_some_and(|sum| sum <= end);
    if inside(x, width, whole.0) && inside(y, height, whole.1) {
        return Ok(());
    }
    Err(Failure::user(format!(
        "the crop {x},{y},{width},{height} reaches outside the image of {}x{} pixels",
        whole.0, whole.1
    )))
}

#[cfg(test)]
mod tests {
    use smalti_core::scene::world::Camera;
    use smalti_core::settings::{Fresnel, Integrator, SamplerKind};

    use super::*;
    use crate::names::{FresnelArg, IntegratorArg, SamplerArg};

    fn world(names: &[&str]) -> World {
        let camera = |name: &&str| Camera {
            name: name.to_string(),
            eye: [0.0; 3].into(),
            look_at: [1.0, 0.0, 0.0].into(),
            up: [0.0, 0.0, 1.0].into(),
            fov: 1.0,
        };
        World { cameras: names.iter().map(camera).collect(), ..World::default() }
    }

    #[test]
    fn the_scene_overrides_the_defaults() {
        assert_eq!(merge(Settings::default(), &ImageArgs::default(), &world(&[""])), Ok(Settings::default()));
        let scene = Settings { spp: 7, jitter: false, max_bounces: Some(3), ..Settings::default() };
        assert_eq!(merge(scene.clone(), &ImageArgs::default(), &world(&[""])), Ok(scene));
    }

    #[test]
    fn every_flag_overrides_its_setting() {
        let crop = Rect { x: 1, y: 2, width: 3, height: 4 };
        let flags = ImageArgs {
            integrator: Some(IntegratorArg::Whitted),
            spp: Some(11),
            shadow_rays: Some(0),
            max_bounces: Some(0),
            sampler: Some(SamplerArg::Independent),
            seed: Some(u64::MAX),
            size: Some(Size { width: 20, height: 10 }),
            crop: Some(crop),
            camera: Some("left".into()),
            no_jitter: true,
            adaptive: Some(SwitchArg::On),
            fresnel: Some(FresnelArg::Schlick),
            photons: Some(5),
            radius: Some(0.5),
        };
        let expected = Settings {
            integrator: Integrator::Whitted,
            width: 20,
            height: 10,
            crop: Some(crop),
            spp: 11,
            shadow_rays: 0,
            max_bounces: Some(0),
            sampler: SamplerKind::Independent,
            seed: u64::MAX,
            fresnel: Fresnel::Schlick,
            jitter: false,
            adaptive: true,
            camera: 1,
            photons: Some(5),
            radius: Some(0.5),
        };
        assert_eq!(merge(Settings::default(), &flags, &world(&["right", "left"])), Ok(expected));
    }

    #[test]
    fn unknown_cameras_name_the_nearest() {
        let message = find_camera("lefd", &world(&["right", "left"])).unwrap_err().message;
        assert!(message.contains("did you mean 'left'?") && message.contains("right, left"), "{message}");
        let message = find_camera("zzzzzzzz", &world(&["right"])).unwrap_err().message;
        assert!(!message.contains("did you mean"), "{message}");
        assert!(find_camera("left", &world(&[""])).unwrap_err().message.contains("no name"));
    }

    #[test]
    fn crops_must_lie_inside() {
        let cropped = |x, y, width, height| {
            let crop = Some(Rect { x, y, width, height });
            check_area(&Settings { width: 10, height: 20, crop, ..Settings::default() })
        };
        assert_eq!(cropped(0, 0, 10, 20), Ok(()));
        assert_eq!(cropped(9, 19, 1, 1), Ok(()));
        assert!(cropped(1, 0, 10, 20).is_err());
        assert!(cropped(0, 19, 1, 2).is_err());
        assert!(cropped(u32::MAX, 0, u32::MAX, 1).is_err());
    }

    #[test]
    fn levels_that_the_machine_lacks() {
        let has = [Level::Avx2, Level::Scalar];
        assert_eq!(choose_level(SimdArg::Auto, &has), Ok(Level::Avx2));
        assert_eq!(choose_level(SimdArg::Scalar, &has), Ok(Level::Scalar));
        let message = choose_level(SimdArg::Neon, &has).unwrap_err().message;
        assert_eq!(message, "this machine has no neon; it has avx2, scalar");
    }
}
