//! Whitted's algorithm (1980) as a recursion, where nothing absorbs.

use core::f64::consts::FRAC_1_PI;

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;

use super::light::{self, Light};
use super::optics::{reflectance, reflected, refracted};
use super::path::sides;
use super::{Random, Ray, nearest};

/// Branches that count for less are not followed: part of what `whitted` promises.
const LEAST: f64 = 1.0 / 1024.0;

/// Radiance along `ray`, whose result counts `weight` in the picture.
pub fn radiance(world: &World, lights: &[Light], ray: Ray, weight: DVec3, random: &mut Random) -> DVec3 {
    if weight.max_element() < LEAST {
        return DVec3::ZERO;
    }
    let sky = DVec3::from_array(world.environment.unwrap_or_default());
    let Some(hit) = nearest(world, &ray) else { return sky };
    let normal = hit.facing(&ray);
    let mut follow = |direction: Option<DVec3>, share: DVec3| match direction {
        Some(direction) => {
            share * radiance(world, lights, Ray { origin: hit.point, direction }, weight * share, random)
        }
        None => DVec3::ZERO,
    };
    let mirrored = Some(reflected(ray.direction, normal));
    let scattered = match hit.material {
        Material::Mirror { reflectance } => follow(mirrored, DVec3::from_array(reflectance)),
        Material::Dielectric { ior, .. } => {
            let (n1, n2) = sides(&hit, &ray, ior);
            let share = reflectance(-ray.direction.dot(normal), n1, n2);
            let through = refracted(ray.direction, normal, n1, n2);
            let compressed = (n1 / n2) * (n1 / n2);
            follow(mirrored, DVec3::splat(share)) + compressed * follow(through, DVec3::splat(1.0 - share))
        }
        Material::Lambert { albedo } => {
            let overhead = Ray { origin: hit.point, direction: random.cosine_about(normal) };
            let from_sky = if nearest(world, &overhead).is_none() { sky } else { DVec3::ZERO };
            let from_lights = light::irradiance(world, lights, (hit.point, normal), DVec3::ZERO, random) * FRAC_1_PI;
            DVec3::from_array(albedo) * (from_sky + from_lights)
        }
    };
    hit.emitted(&ray) + scattered
}
