//! Light tracing as a loop over the hits of one photon.

use core::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;

use super::light::{self, Light};
use super::optics::{reflectance, reflected, refracted};
use super::path::sides;
use super::{Hit, Random, Ray, nearest};

/// Photons that one stream of random numbers serves.
const CHUNK: u32 = 1 << 16;

/// A photon on a diffuse surface.
pub struct Landed {
    /// Where.
    pub hit: Hit,
    /// What it brings, W.
    pub flux: DVec3,
    /// Specular events before.
    pub events: u32,
}

/// Sends `count` photons from the lamps everywhere and follows them by mirrors and glass to the first diffuse surface.
/// The flux in each of `bins` bins, into which `bin` sorts photons, and its variance.
pub fn fluxes(
    world: &World,
    count: u32,
    seed: u64,
    bins: usize,
    bin: impl Fn(&Landed) -> Option<usize> + Sync,
) -> Vec<(DVec3, DVec3)> {
    let lights = light::of(world);
    let chunk = |number: u32| {
        let mut random = Random::new(seed << 32 | u64::from(number));
        let mut sums = vec![(DVec3::ZERO, DVec3::ZERO); bins];
        for _ in 0..CHUNK.min(count - number * CHUNK) {
            let photon = emit(lights[random.below(lights.len())], &mut random);
            let landed = follow(world, photon, &mut random);
            if let Some((landed, number)) = landed.and_then(|landed| bin(&landed).map(|bin| (landed, bin))) {
                let flux = landed.flux * lights.len() as f64 / f64::from(count);
                sums[number].0 += flux;
                sums[number].1 += flux * flux;
            }
        }
        sums
    };
    let add = |a: Vec<(DVec3, DVec3)>, b: Vec<(DVec3, DVec3)>| {
        a.into_iter().zip(b).map(|(a, b)| (a.0 + b.0, a.1 + b.1)).collect()
    };
    let zero = || vec![(DVec3::ZERO, DVec3::ZERO); bins];
    (0..count.div_ceil(CHUNK)).into_par_iter().map(chunk).reduce(zero, add)
}

fn follow(world: &World, (mut ray, mut flux): (Ray, DVec3), random: &mut Random) -> Option<Landed> {
    for events in 0.. {
        let hit = nearest(world, &ray)?;
        let direction = match hit.material {
            Material::Lambert { .. } => return Some(Landed { hit, flux, events }),
            Material::Mirror { reflectance } => {
                flux *= DVec3::from_array(reflectance);
                reflected(ray.direction, hit.normal)
            }
            Material::Dielectric { ior, .. } => cross(&hit, &ray, ior, random),
        };
        ray = Ray { origin: hit.point, direction };
    }
    None
}

/// Where a photon goes on at a boundary; its flux stays as it is.
fn cross(hit: &Hit, ray: &Ray, ior: f64, random: &mut Random) -> DVec3 {
    let (normal, (n1, n2)) = (hit.facing(ray), sides(hit, ray, ior));
    let chance = reflectance(-ray.direction.dot(normal), n1, n2);
    let through = refracted(ray.direction, normal, n1, n2).filter(|_| random.unit() >= chance);
    through.unwrap_or_else(|| reflected(ray.direction, normal))
}

/// A photon that carries all of a light's power.
fn emit(light: Light, random: &mut Random) -> (Ray, DVec3) {
    match light {
        Light::Triangle([a, b, c], radiance) => {
            let (root, v) = (random.unit().sqrt(), random.unit());
            let origin = a + root * (1.0 - v) * (b - a) + root * v * (c - a);
            let across = (b - a).cross(c - a);
            let power = PI * across.length() / 2.0 * DVec3::from_array(radiance);
            (Ray { origin, direction: random.cosine_about(across.normalize()) }, power)
        }
        Light::Ball(ball, radiance) => {
            let outward = random.direction();
            let power = 4.0 * PI * PI * ball.radius * ball.radius * DVec3::from_array(radiance);
            let origin = ball.centre + ball.radius * outward;
            (Ray { origin, direction: random.cosine_about(outward) }, power)
        }
        Light::Point(point) => {
            let power = 4.0 * PI * DVec3::from_array(point.intensity);
            (Ray { origin: point.position, direction: random.direction() }, power)
        }
    }
}
