//! Path tracing as a loop over the vertices of one path.

use core::f64::consts::FRAC_1_PI;

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;

use super::light::{self, Light};
use super::optics::{reflectance, reflected, refracted};
use super::{Hit, Random, Ray, nearest};

/// How the light of emitters is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finds {
    /// Only when a path happens to hit them. Point lights are never found.
    ByChance,
    /// By one shadow ray at each diffuse vertex; a path that comes from there counts none that it hits.
    ByShadowRay,
}

/// A scattering event: where the path goes on, and by what the radiance from there is multiplied.
struct Scattering {
    direction: DVec3,
    weight: DVec3,
    diffuse: bool,
}

/// An estimate of the radiance that arrives along `ray`.
pub fn radiance(world: &World, lights: &[Light], finds: Finds, mut ray: Ray, random: &mut Random) -> DVec3 {
    let (mut sum, mut throughput, mut emission_counts) = (DVec3::ZERO, DVec3::ONE, true);
    let mut inside = balls_around(world, ray.origin);
    while let Some(hit) = nearest(world, &ray) {
        let absorption = inside.last().copied().unwrap_or_default();
        throughput *= light::transmittance(absorption, hit.point.distance(ray.origin));
        if emission_counts {
            sum += throughput * hit.emitted(&ray);
        }
        if let (Material::Lambert { albedo }, Finds::ByShadowRay) = (hit.material, finds) {
            let place = (hit.point, hit.facing(&ray));
            let irradiance = light::irradiance(world, lights, place, absorption, random);
            sum += throughput * DVec3::from_array(albedo) * FRAC_1_PI * irradiance;
        }
        let scattering = scatter(&hit, &ray, random);
        // Roulette by what this one event reflects; refraction's change of radiance does not count.
        let chance = match hit.material {
            Material::Dielectric { .. } => 1.0,
            _ => scattering.weight.max_element(),
        };
        if random.unit() >= chance {
            return sum;
        }
        throughput *= scattering.weight / chance;
        if let Material::Dielectric { absorption, .. } = hit.material {
            let enters = hit.normal.dot(scattering.direction) < 0.0;
            match (hit.normal.dot(ray.direction) < 0.0, enters) {
                (true, true) => inside.push(DVec3::from_array(absorption)),
                (false, false) => drop(inside.pop()),
                _ => {}
            }
        }
        emission_counts = finds == Finds::ByChance || !scattering.diffuse;
        ray = Ray { origin: hit.point, direction: scattering.direction };
    }
    sum + throughput * DVec3::from_array(world.environment.unwrap_or_default())
}

/// What the dielectric balls around a place absorb, from the largest to the smallest. (Other dielectrics have nothing in
/// them at the start of a path.)
fn balls_around(world: &World, place: DVec3) -> Vec<DVec3> {
    let mut balls: Vec<_> = world.spheres.iter().filter(|ball| ball.centre.distance(place) < ball.radius).collect();
    balls.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    let absorption = |material: &Material| match material {
        Material::Dielectric { absorption, .. } => Some(DVec3::from_array(*absorption)),
        _ => None,
    };
    balls.iter().filter_map(|ball| absorption(&world.materials[ball.material])).collect()
}

fn scatter(hit: &Hit, ray: &Ray, random: &mut Random) -> Scattering {
    let normal = hit.facing(ray);
    let mirrored = reflected(ray.direction, normal);
    match hit.material {
        Material::Lambert { albedo } => {
            let direction = random.cosine_about(normal);
            Scattering { direction, weight: DVec3::from_array(albedo), diffuse: true }
        }
        Material::Mirror { reflectance } => {
            Scattering { direction: mirrored, weight: DVec3::from_array(reflectance), diffuse: false }
        }
        Material::Dielectric { ior, .. } => {
            let (n1, n2) = sides(hit, ray, ior);
            let chance = reflectance(-ray.direction.dot(normal), n1, n2);
            match refracted(ray.direction, normal, n1, n2).filter(|_| random.unit() >= chance) {
                // Radiance / n² is what refraction keeps.
                Some(direction) => {
                    Scattering { direction, weight: DVec3::splat((n1 / n2) * (n1 / n2)), diffuse: false }
                }
                None => Scattering { direction: mirrored, weight: DVec3::ONE, diffuse: false },
            }
        }
    }
}

/// Indices on the side that the ray comes from and on the other.
pub fn sides(hit: &Hit, ray: &Ray, ior: f64) -> (f64, f64) {
    if hit.normal.dot(ray.direction) < 0.0 { (1.0, ior) } else { (ior, 1.0) }
}
