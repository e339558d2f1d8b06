//! Hunting for the first value that cannot be: every value of every stage is looked at, which takes many times as long as
//! a render.

use std::ops::{ControlFlow, Range};

use crate::accel::MISS;
use crate::photon::maps::Maps;
use crate::plan::Stage;
use crate::render::{Renderer, Workspace};
use crate::settings::Rect;
use crate::stream::{DIRECTION, DISTANCE, ETA, ORIGIN, PDF, PRIM, Slots, Stream, THROUGHPUT};

/// A value that cannot be.
#[derive(Clone, Debug, PartialEq)]
pub struct Impossible {
    /// The stage after which it was there.
    pub stage: String,
    /// Scattering events before it.
    pub bounce: u32,
    /// Column and row in the whole image.
    pub pixel: (u32, u32),
    /// Sample number.
    pub sample: u32,
    /// What it is, for example `throughput`.
    pub what: &'static str,
    /// Its components.
    pub value: [f32; 3],
}

/// How far the length of a direction may be from 1.
const LENGTH: f32 = 1e-5;

/// What a stream can hold that cannot be: the number of the path and what it is.
type Fault = (usize, &'static str, [f32; 3]);

impl Renderer {
    /// The first impossible value of the samples `samples`, all of one round, of the pixels of `area`: one that is not
    /// finite, a direction that is not of length 1, a distance or throughput or radiance below 0.
    ///
    /// # Panics
    /// If there are more than 4096 pixels.
    pub fn hunt(&self, area: Rect, samples: Range<u32>, maps: &Maps, workspace: &mut Workspace) -> Option<Impossible> {
        workspace.pixels.set(area, 0, area.pixels());
        samples.into_iter().find_map(|sample| {
            let (stage, bounce, (slot, what, value)) = self.first_fault(sample, maps, workspace)?;
            let pixel = area.pixel(workspace.pixels.numbers()[slot] as usize);
            Some(Impossible { stage, bounce, pixel, sample, what, value })
        })
    }

    /// The first fault of one sample of the workspace's pixels: after which stage, and after how many bounces.
    fn first_fault(&self, sample: u32, maps: &Maps, workspace: &mut Workspace) -> Option<(String, u32, Fault)> {
        self.generate(workspace, sample..sample + 1);
        if let Some((at, what, value)) = impossible_ray(&workspace.rays, false) {
            return Some(("Camera".into(), 0, (workspace.rays.slot(at), what, value)));
        }
        for bounce in 0..=self.plan().max_bounces {
            let mut first = None;
            let next = self.bounce(bounce, maps, workspace, |stage, workspace| {
                first = first.take().or_else(|| Some((format!("{stage:?}"), bounce, after(stage, workspace)?)));
            });
            if first.is_some() || next == ControlFlow::Break(()) {
                return first;
            }
        }
        None
    }
}

/// What a stage has done that cannot be, by slot.
fn after(stage: Stage, workspace: &Workspace) -> Option<Fault> {
    let hit = matches!(stage, Stage::Intersect | Stage::Absorb);
    let of = |stream: &Stream, hit: bool| {
        impossible_ray(stream, hit).map(|(at, what, value)| (stream.slot(at), what, value))
    };
    let rays = if hit { of(&workspace.rays, true) } else { None };
    let vertices = if stage == Stage::Surface { of(&workspace.diffuse, false) } else { None };
    rays.or(vertices).or_else(|| of(&workspace.next, false)).or_else(|| impossible_radiance(&workspace.slots))
}

fn impossible_ray(stream: &Stream, hit: bool) -> Option<Fault> {
    (0..stream.len()).find_map(|at| fault(stream, at, hit).map(|(what, value)| (at, what, value)))
}

/// What is wrong with ray (or vertex) `at`; with `hit` its hit is looked at too.
fn fault(stream: &Stream, at: usize, hit: bool) -> Option<(&'static str, [f32; 3])> {
    let finite = |value: &[f32; 3]| value.iter().all(|x| x.is_finite());
    let (origin, direction, throughput) =
        (stream.triple(ORIGIN, at), stream.triple(DIRECTION, at), stream.triple(THROUGHPUT, at));
    let off = direction.iter().map(|x| x * x).sum::<f32>().sqrt() - 1.0;
    let number = |column: usize| f32::from_bits(stream.value(column, at));
    let columns = stream.columns_used();
    let (pdf, eta) = (if columns.pdf { number(PDF) } else { 0.0 }, if columns.eta { number(ETA) } else { 1.0 });
    let distance = if hit && stream.value(PRIM, at) != MISS { number(DISTANCE) } else { 1.0 };
    [
        ("origin", origin, finite(&origin)),
        ("direction", direction, off.abs() <= LENGTH),
        ("throughput", throughput, finite(&throughput) && throughput.iter().all(|x| *x >= 0.0)),
        ("pdf", [pdf, 0.0, 0.0], pdf.is_finite() && (pdf >= 0.0 || pdf == -1.0)),
        ("factor of radiance", [eta, 0.0, 0.0], eta.is_finite() && eta >= 0.0),
        ("distance", [distance, 0.0, 0.0], distance.is_finite() && distance > 0.0),
    ]
    .into_iter()
    .find_map(|(what, value, is_sound)| (!is_sound).then_some((what, value)))
}

fn impossible_radiance(slots: &Slots) -> Option<Fault> {
    let is_sound = |value: &[f32; 3]| value.iter().all(|x| x.is_finite() && *x >= 0.0);
    let at = slots.radiance().iter().position(|value| !is_sound(value))?;
    Some((at, "radiance", slots.radiance()[at]))
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU64;

    use glam::DVec3;

    use super::*;
    use crate::photon::maps::Pilots;
    use crate::render::Level;
    use crate::scene::World;
    use crate::scene::world::{Camera, Material, Sphere};
    use crate::settings::{Integrator, Settings};

    /// A grey and a glass ball under a sky and a lamp of this radiance.
    fn world(lamp: f64, sky: f64) -> World {
        let ball = |x: f64, material: usize, radiance: Option<[f64; 3]>| Sphere {
            centre: DVec3::new(x, 0.0, 0.0),
            radius: 0.9,
            material,
            radiance,
        };
        let camera = Camera {
            name: String::new(),
            eye: DVec3::new(0.0, -8.0, 0.0),
            look_at: DVec3::ZERO,
            up: DVec3::Z,
            fov: 0.8,
        };
        World {
            materials: vec![Material::Lambert { albedo: [0.5; 3] }, Material::clear(1.5)],
            spheres: vec![ball(-2.0, 0, None), ball(0.0, 1, None), ball(2.0, 0, Some([lamp; 3]))],
            environment: Some([sky; 3]),
            cameras: vec![camera],
            ..World::default()
        }
    }

    fn hunted(world: &World, integrator: Integrator) -> Option<Impossible> {
        let settings =
            Settings { integrator, width: 24, height: 12, spp: 8, photons: Some(4096), ..Settings::default() };
        let renderer = Renderer::new(world, settings, Level::available()[0]).unwrap();
        let maps = renderer.maps(0, Pilots::default(), &AtomicU64::new(0));
        renderer.hunt(renderer.settings().area(), 0..8, &maps, &mut renderer.workspace())
    }

    #[test]
    fn nothing_is_found_where_all_is_well() {
        for integrator in Integrator::ALL {
            assert_eq!(hunted(&world(3.0, 0.5), integrator), None);
        }
    }

    #[test]
    fn the_stage_and_the_sample_are_named() {
        for (lamp, sky, stage) in [(f64::NAN, 0.5, "Emission"), (-1.0, 0.5, "Emission"), (3.0, -0.5, "Environment")] {
            let found = hunted(&world(lamp, sky), Integrator::Path).expect("it is there to be found");
            assert_eq!((found.stage.as_str(), found.bounce, found.what), (stage, 0, "radiance"));
            let is_right = found.pixel.0 >= 12 && found.pixel.0 < 24;
            assert!(stage == "Environment" || is_right, "the lamp is on the right: {found:?}");
            let value = if stage == "Emission" { lamp } else { sky } as f32;
            assert_eq!(found.value[0].to_bits(), value.to_bits(), "{found:?}");
        }
    }
}
