//! Replaying one sample: the same stages over a stream that begins with one path, looked at after every bounce.

use std::ops::ControlFlow;

use std::sync::atomic::AtomicU64;

use crate::accel::MISS;
use crate::film::ROUND;
use crate::photon::maps::Pilots;
use crate::plan::Stage;
use crate::render::{Renderer, Workspace};
use crate::scene::{Class, Origin};
use crate::settings::Rect;
use crate::stream::{DIRECTION, DISTANCE, ORIGIN, PRIM, THROUGHPUT};

/// One ray of a replayed path, in the user's units.
#[derive(Clone, Debug, PartialEq)]
pub struct Vertex {
    /// Scattering events before this ray.
    pub bounce: u32,
    /// Where the ray starts, metres.
    pub origin: [f64; 3],
    /// Its direction, unit length.
    pub direction: [f64; 3],
    /// What it hit; `None`: nothing.
    pub hit: Option<Origin>,
    /// Distance to the hit, metres.
    pub distance: Option<f64>,
    /// Kind of the material at the hit.
    pub material: Option<&'static str>,
    /// What radiance at the end of this ray counts for in the sample.
    pub throughput: [f32; 3],
    /// Radiance of the sample once all rays of this bounce are shaded, emission and direct light included.
    pub radiance: [f32; 3],
}

impl Renderer {
    /// Replays one sample: its rays bounce by bounce (all branches of a bounce together), and its radiance,
    /// which is bit for bit what the film gets.
    pub fn replay(&self, pixel: (u32, u32), sample: u32) -> (Vec<Vertex>, [f32; 3]) {
        let mut workspace = self.workspace();
        workspace.pixels.set(Rect { x: pixel.0, y: pixel.1, width: 1, height: 1 }, 0, 1);
        self.generate(&mut workspace, sample..sample + 1);
        let maps = self.maps(sample / ROUND, Pilots::default(), &AtomicU64::new(0));
        let mut vertices = Vec::new();
        for bounce in 0..=self.plan().max_bounces {
            let first = vertices.len();
            let next = self.bounce(bounce, &maps, &mut workspace, |stage, workspace| {
                if stage == Stage::Intersect {
                    vertices.extend((0..workspace.rays.len()).map(|at| self.vertex(bounce, workspace, at)));
                }
            });
            let radiance = workspace.slots.radiance()[0];
            vertices[first..].iter_mut().for_each(|vertex| vertex.radiance = radiance);
            if next == ControlFlow::Break(()) {
                break;
            }
        }
        (vertices, workspace.slots.radiance()[0])
    }

    /// Ray `at` of the stream that was just intersected.
    fn vertex(&self, bounce: u32, workspace: &Workspace, at: usize) -> Vertex {
        let (rays, scene) = (&workspace.rays, self.scene());
        let prim = rays.value(PRIM, at);
        let hit = (prim != MISS).then_some(prim as usize);
        let distance = f64::from(f32::from_bits(rays.value(DISTANCE, at)));
        Vertex {
            bounce,
            origin: scene.frame.to_world(rays.triple(ORIGIN, at)),
            direction: rays.triple(DIRECTION, at).map(f64::from),
            hit: hit.map(|prim| scene.origins[prim]),
            distance: hit.map(|_| distance / scene.frame.scale),
            material: hit.map(|prim| Class::of(scene.classes[prim]).name()),
            throughput: rays.triple(THROUGHPUT, at),
            radiance: [0.0; 3],
        }
    }
}

impl Class {
    /// The name that users read.
    fn name(self) -> &'static str {
        match self {
            Class::Black => "black",
            Class::Lambert => "lambert",
            Class::Mirror => "mirror",
            Class::Dielectric => "dielectric",
        }
    }
}

/// As in `polygon 3`, `sphere 1`, `mesh 0 triangle 17`.
impl core::fmt::Display for Origin {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Origin::Polygon(polygon) => write!(f, "polygon {polygon}"),
            Origin::Mesh(mesh, triangle) => write!(f, "mesh {mesh} triangle {triangle}"),
            Origin::Sphere(sphere) => write!(f, "sphere {sphere}"),
        }
    }
}
