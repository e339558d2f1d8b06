//! What photons a scene requires, and which lights they come from.

use crate::accel::cones::Parts;
use crate::photon::pass::Pass;
use crate::photon::{Aim, Kind, Surfaces, visibility};
use crate::scene::{Class, Scene};
use crate::settings::{Integrator, Settings};

/// Caustics are left to paths where what a chance hit brings, times this, is less than what chance brings in the mean:
/// for a single light, where its area is at least this part of that of the scene's box.
const FOUND_BY_CHANCE: f64 = 0.05;

/// The photon maps of a plan.
#[derive(Clone, Debug)]
pub struct Photons {
    /// Light that goes by specular surfaces to diffuse ones.
    pub caustic: Option<Pass>,
    /// All light.
    pub global: Option<Pass>,
    /// Where lights are seen and hidden.
    pub shadow: Option<Pass>,
    /// What the photons lie on.
    pub surfaces: Surfaces,
    /// For each emitter 1 where its caustics are in the map.
    pub in_map: Vec<u32>,
    /// A brightness that is typical of the scene: that of its box, were all power on it once.
    pub reference: f32,
    /// Radius of the first round, in the frame, where the settings say it.
    pub radius: Option<f32>,
}

impl Photons {
    /// The maps that this scene requires with these settings, if any.
    pub fn new(scene: &Scene, settings: &Settings, occluded: bool) -> Option<Self> {
        let asked = settings.integrator.asks_photons() && settings.photons_of_round() > 0;
        if !asked || !scene.has(Class::Lambert) {
            return None;
        }
        let all = settings.integrator == Integrator::Photon;
        let in_map = if all { vec![1; scene.lights.emitters.len()] } else { hard_to_find(scene) };
        let global =
            (all && !lacks_sky(scene, settings)).then(|| global(scene, settings)).filter(|pass| !pass.aim.is_empty());
        // A final gather finds what caustics send on; without one, photons do.
        let goes_on = global.is_none();
        let caustic = caustic(scene, settings, &in_map).map(|pass| Pass { goes_on, ..pass });
        (caustic.is_some() || global.is_some()).then(|| Self {
            in_map,
            // Shadow photons tell where shadow rays need not be asked: only where something may stop them.
            shadow: (all && occluded).then(|| shadow(scene)),
            ..Self::of(scene, settings, caustic, global)
        })
    }

    /// The one map that is to be seen, from all lights.
    ///
    /// # Errors
    /// Why the map would be empty, and what can be done.
    pub fn showing(scene: &Scene, settings: &Settings, map: Kind) -> Result<Self, String> {
        if let Some(why) = nothing_to_show(scene, map) {
            return Err(why.into());
        }
        let in_map = vec![1; scene.lights.emitters.len()];
        match map {
            Kind::Global | Kind::Shadow => Ok(Self::of(scene, settings, None, Some(global(scene, settings)))),
            Kind::Caustic => match caustic(scene, settings, &in_map) {
                Some(pass) => Ok(Self::of(scene, settings, Some(pass), None)),
                None => Err("no light reaches what is specular, so there are no caustics to see".into()),
            },
        }
    }

    /// These passes, with what photons need to know of the scene.
    fn of(scene: &Scene, settings: &Settings, caustic: Option<Pass>, global: Option<Pass>) -> Self {
        Self {
            caustic,
            shadow: None,
            global,
            surfaces: Surfaces::new(scene),
            in_map: vec![1; scene.lights.emitters.len()],
            reference: reference(scene),
            radius: settings.radius.map(|radius| (radius * scene.frame.scale) as f32),
        }
    }
}

/// Why a map would be empty, and what can be done; `None` where it is not.
fn nothing_to_show(scene: &Scene, map: Kind) -> Option<&'static str> {
    let specular = scene.has(Class::Mirror) || scene.has(Class::Dielectric);
    if scene.lights.rows.is_empty() {
        Some("the scene has no light with a place, so there is nothing that photons could leave")
    } else if !scene.has(Class::Lambert) {
        Some("no surface is diffuse, and photons are stored on diffuse surfaces alone")
    } else if map == Kind::Caustic && !specular {
        Some("nothing in the scene is specular, so there are no caustics to see; `--map global` shows all light")
    } else {
        None
    }
}

/// Whether a map of all light is asked for and left out, since no photons come from the sky: paths that end at such a map
/// would not find it.
pub fn lacks_sky(scene: &Scene, settings: &Settings) -> bool {
    settings.integrator == Integrator::Photon && scene.environment.is_some()
}

/// Why a scene requires no photon map.
pub fn missing(scene: &Scene, settings: &Settings) -> &'static str {
    let specular = scene.has(Class::Mirror) || scene.has(Class::Dielectric);
    if settings.photons_of_round() == 0 {
        "none are asked for"
    } else if !scene.has(Class::Lambert) {
        "no surface is diffuse"
    } else if scene.lights.rows.is_empty() {
        "no light has a place"
    } else if !specular {
        "nothing is specular: there are no caustics"
    } else {
        "chance finds the lights, or no light reaches what is specular"
    }
}

/// Shadow photons.
fn shadow(scene: &Scene) -> Pass {
    Pass { kind: Kind::Shadow, aim: Aim::everywhere(&scene.lights), photons: visibility::PHOTONS, goes_on: false }
}

/// The caustic pass, where light can go from a light to a specular caster and on to a diffuse receiver.
fn caustic(scene: &Scene, settings: &Settings, in_map: &[u32]) -> Option<Pass> {
    let specular = |prim: &u32| matches!(scene.class(*prim), Some(Class::Mirror | Class::Dielectric));
    let casters: Vec<u32> = (0..scene.shades.len() as u32).filter(specular).collect();
    let rows = 0..scene.lights.rows.len();
    let emits: Vec<bool> =
        rows.map(|row| scene.lights.emitter_of(row).is_none_or(|emitter| in_map[emitter as usize] == 1)).collect();
    let aim = Aim::at(&scene.lights, Parts::new(scene, &casters).spheres(), &emits);
    (!aim.is_empty()).then(|| Pass { kind: Kind::Caustic, aim, photons: settings.photons_of_round(), goes_on: false })
}

/// The pass of all light.
fn global(scene: &Scene, settings: &Settings) -> Pass {
    Pass {
        kind: Kind::Global,
        aim: Aim::everywhere(&scene.lights),
        photons: settings.photons_of_round(),
        goes_on: true,
    }
}

/// For each emitter 1 where chance hardly finds it, or finds it with much more than it finds in the mean.
fn hard_to_find(scene: &Scene) -> Vec<u32> {
    let brightest = |[r, g, b, _]: &[f32; 4]| f64::from(r.max(*g).max(*b));
    let emitters = || scene.lights.emitters.iter().map(brightest);
    let mean =
        emitters().zip(scene.lights.areas()).map(|(radiance, area)| radiance * area).sum::<f64>() / area_of_box(scene);
    emitters().map(|radiance| u32::from(radiance * FOUND_BY_CHANCE > mean)).collect()
}

/// Area of the scene's bounding box, in the frame.
fn area_of_box(scene: &Scene) -> f64 {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for prim in 0..scene.shades.len() as u32 {
        let (from, to) = scene.bounds(prim);
        for k in 0..3 {
            low[k] = low[k].min(from[k]);
            high[k] = high[k].max(to[k]);
        }
    }
    let [x, y, z] = [0, 1, 2].map(|k: usize| f64::from(high[k] - low[k]).max(0.0));
    2.0 * (x * y + y * z + z * x)
}

/// Radiance of the scene's box, were it white and lit once by all lights with a place; plus that of the environment.
fn reference(scene: &Scene) -> f32 {
    let power: f64 = (0..scene.lights.rows.len()).map(|row| scene.lights.power(row)).sum();
    let sky = scene.environment.map_or(0.0, |[r, g, b]| (r + g + b) / 3.0);
    (power / (core::f64::consts::PI * area_of_box(scene))) as f32 + sky
}
