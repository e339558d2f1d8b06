//! Rays of the picture's own paths, each against the same ray in f64.

use glam::DVec3;
use rayon::ThreadPool;
use rayon::prelude::*;
use smalti_core::render::{Renderer, Vertex};
use smalti_core::scene::double::{Hit, Ray, nearest};
use smalti_core::scene::{Origin, World};
use smalti_core::settings::{Integrator, Settings};

use crate::finding::{Finding, Verdict, counted};
use crate::turned::{moved, size};
use crate::{DoctorError, Patient};

/// Tests of a ray against a primitive in f64, in all.
const TESTS: usize = 400_000_000;

/// Rays at least and at most.
const RAYS: [usize; 2] = [500, 100_000];

/// Two points are one, and an edge is met or missed by chance, if they are so near, as part of the scene's size:
/// coordinates are rounded to 2⁻²⁴ of it, and rays leave surfaces by 24 times that.
const NEAR: f64 = 4e-6;

/// What is wrong with a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wrong {
    /// It hit nothing where there is something.
    Leak,
    /// It hit something again where it started.
    SelfHit,
    /// It hit something else.
    Else,
}

/// How the rays of some paths compare.
#[derive(Clone, Debug, Default)]
struct Tally {
    rays: usize,
    /// Rays that pass so near by an edge that both answers are right.
    edges: usize,
    /// Largest difference of hit points along the normal, by the scene's size.
    off: f64,
    leaks: usize,
    self_hits: usize,
    elsewhere: usize,
    /// The first that is wrong, in words.
    first: Option<String>,
}

impl Tally {
    fn and(mut self, other: Self) -> Self {
        self.rays += other.rays;
        self.edges += other.edges;
        self.off = self.off.max(other.off);
        self.leaks += other.leaks;
        self.self_hits += other.self_hits;
        self.elsewhere += other.elsewhere;
        self.first = self.first.or(other.first);
        self
    }
}

/// Follows paths and compares every ray of theirs.
pub fn check(patient: &Patient<'_>, pool: &ThreadPool, tell: &mut impl FnMut(Finding)) -> Result<(), DoctorError> {
    // What paths hit does not depend on the integrator; the path tracer needs no photons for it.
    let settings = Settings { integrator: Integrator::Path, ..patient.settings.clone() };
    // Beside the origin, where a metre has all the steps of f64: how coarse they are elsewhere is told apart.
    let world = patient.world.bounds().map_or(patient.world.clone(), |(low, _)| moved(patient.world, -low));
    let renderer = pool.install(|| Renderer::new(&world, settings, patient.level))?;
    let tally = pool.install(|| compared(&renderer, &world));
    let Tally { rays, edges, off, leaks, self_hits, elsewhere, first } = tally;
    let of = |count: usize, what: &str| match (count, &first) {
        (0, _) => format!("none of {rays} rays {what}"),
        (_, Some(first)) => format!("{} of {rays} {what}: {first}", counted(count, "ray")),
        (_, None) => format!("{} of {rays} {what}", counted(count, "ray")),
    };
    let mut tell_of = |case: &str, count: usize, what: &str| {
        tell(Finding::new(("rays", case), (count == 0, Verdict::Failed), count as f64, of(count, what)));
    };
    tell_of("leaks", leaks, "hit nothing where f64 hits something");
    tell_of("self-hits", self_hits, "hit again what they leave");
    tell_of("elsewhere", elsewhere, "hit something else than in f64");
    let says =
        format!("hit points are off by {off:.1e} of the scene at most; {} pass at an edge", counted(edges, "ray"));
    tell(Finding::new(("rays", "distance"), (off <= NEAR, Verdict::Failed), off, says));
    Ok(())
}

fn compared(renderer: &Renderer, world: &World) -> Tally {
    let triangles: usize = world.meshes.iter().map(|mesh| mesh.faces.len()).sum();
    let primitives = (world.polygons.len() + world.spheres.len() + triangles).max(1);
    let wanted = (TESTS / primitives).clamp(RAYS[0], RAYS[1]);
    let area = renderer.settings().area();
    let paths = area.pixels() * renderer.settings().spp as usize;
    let size = size(world);
    let mut tally = Tally::default();
    // A stride that shares no factor with most sizes: paths from all over the picture.
    let path = |number: usize| {
        let index = (number * 7919) % paths;
        let (pixel, sample) = (index % area.pixels(), (index / area.pixels()) as u32);
        of_path(&renderer.replay(area.pixel(pixel), sample).0, world, size)
    };
    let at_once = 256;
    for first in (0..paths).step_by(at_once) {
        let more: Vec<Tally> = (first..paths.min(first + at_once)).into_par_iter().map(path).collect();
        tally = more.into_iter().fold(tally, Tally::and);
        if tally.rays >= wanted {
            break;
        }
    }
    tally
}

fn of_path(vertices: &[Vertex], world: &World, size: f64) -> Tally {
    let mut tally = Tally::default();
    for vertex in vertices {
        let ray = Ray {
            origin: DVec3::from_array(vertex.origin),
            direction: DVec3::from_array(vertex.direction).normalize(),
        };
        let found = vertex.hit.zip(vertex.distance);
        let exact = nearest(world, &ray, 0.0);
        tally.rays += 1;
        match judge(world, &ray, found, exact, size) {
            Ok(Some(off)) => tally.off = tally.off.max(off),
            Ok(None) => tally.edges += 1,
            Err(wrong) => {
                match wrong {
                    Wrong::Leak => tally.leaks += 1,
                    Wrong::SelfHit => tally.self_hits += 1,
                    Wrong::Else => tally.elsewhere += 1,
                }
                tally.first.get_or_insert_with(|| described(&ray, found, exact));
            }
        }
    }
    tally
}

/// By how much of the scene's size hit points differ; `None` where the ray passes at an edge.
fn judge(
    world: &World,
    ray: &Ray,
    found: Option<(Origin, f64)>,
    exact: Option<Hit>,
    size: f64,
) -> Result<Option<f64>, Wrong> {
    if let (Some((_, distance)), Some(exact)) = (found, exact) {
        let off = (distance - exact.distance).abs() * exact.cosine / size;
        if off <= NEAR {
            return Ok(Some(off));
        }
    }
    if found.is_none() && exact.is_none() {
        return Ok(Some(0.0));
    }
    if beside(world, ray, size).any(|hit| is_same(found, hit, size)) {
        return Ok(None);
    }
    match found {
        None => Err(Wrong::Leak),
        Some((_, distance)) if distance <= NEAR * size => Err(Wrong::SelfHit),
        Some(_) => Err(Wrong::Else),
    }
}

/// What rays hit that pass beside this one by as little as cannot be told apart, or start as little farther on.
fn beside(world: &World, ray: &Ray, size: f64) -> impl Iterator<Item = Option<Hit>> {
    let (right, up) = ray.direction.any_orthonormal_pair();
    let turns = (0..8).map(move |k| {
        let (x, y) =
            [(1.0, 0.0), (0.7, 0.7), (0.0, 1.0), (-0.7, 0.7), (-1.0, 0.0), (-0.7, -0.7), (0.0, -1.0), (0.7, -0.7)][k];
        x * right + y * up
    });
    let shifted = turns.map(move |turn| Ray { origin: ray.origin + NEAR * size * turn, ..*ray });
    let farther = nearest(world, ray, NEAR * size);
    shifted.map(|ray| nearest(world, &ray, 0.0)).chain([farther])
}

fn is_same(found: Option<(Origin, f64)>, other: Option<Hit>, size: f64) -> bool {
    match (found, other) {
        (None, None) => true,
        (Some((origin, distance)), Some(hit)) => {
            let slack = 4.0 * NEAR * size / hit.cosine.max(1e-3);
            origin == hit.origin && (distance - hit.distance).abs() <= slack.max(0.01 * distance)
        }
        _ => false,
    }
}

fn described(ray: &Ray, found: Option<(Origin, f64)>, exact: Option<Hit>) -> String {
    let hit = |hit: Option<(Origin, f64)>| hit.map_or("nothing".into(), |(what, far)| format!("{what} at {far:.6e} m"));
    let [from, way] = [ray.origin, ray.direction].map(|v| format!("({:.9e}, {:.9e}, {:.9e})", v.x, v.y, v.z));
    let exact = hit(exact.map(|hit| (hit.origin, hit.distance)));
    format!("from {from} along {way} to {}, in f64 to {exact}", hit(found))
}

#[cfg(test)]
mod tests {
    use smalti_core::scene::world::Sphere;

    use super::*;

    /// Two balls on a line, the ray along it or beside.
    fn of(found: Option<(Origin, f64)>, beside: f64) -> Result<Option<f64>, Wrong> {
        let ball = |z: f64| Sphere { centre: DVec3::Z * z, radius: 1.0, material: 0, radiance: None };
        let world = World { spheres: vec![ball(3.0), ball(7.0)], ..World::default() };
        let ray = Ray { origin: DVec3::X * beside, direction: DVec3::Z };
        judge(&world, &ray, found, nearest(&world, &ray, 0.0), 6.0)
    }

    #[test]
    fn what_is_wrong_is_told_from_what_is_rounded() {
        let (near, far) = (Origin::Sphere(0), Origin::Sphere(1));
        assert_eq!(of(Some((near, 2.0)), 0.0), Ok(Some(0.0)));
        assert!(of(Some((near, 2.0 + 1e-6)), 0.0).is_ok_and(|off| off.is_some_and(|off| off > 1e-7)));
        assert_eq!(of(None, 0.0), Err(Wrong::Leak));
        assert_eq!(of(Some((far, 6.0)), 0.0), Err(Wrong::Else));
        assert_eq!(of(Some((near, 1e-7)), 0.0), Err(Wrong::SelfHit));
        assert_eq!(of(None, 2.0), Ok(Some(0.0)));
        assert_eq!(of(Some((near, 3.0)), 2.0), Err(Wrong::Else));
        // At the rim of the first ball both answers are right.
        assert_eq!(of(None, 1.0 - 1e-9), Ok(None));
        assert_eq!(of(Some((near, 3.0)), 1.0 + 1e-9), Ok(None));
    }
}
