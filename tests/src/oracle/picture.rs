//! Pictures by the oracle.

use glam::DVec3;
use rayon::prelude::*;
use smalti_core::scene::World;

use super::{Finds, Random, Ray, light, path, whitted};

/// A pixel's mean and the variance of that mean.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Mean of its samples.
    pub mean: DVec3,
    /// Of the mean, from the spread of independent samples.
    pub variance: DVec3,
}

/// The ray of the first camera through a place of a `width` × `height` picture, in pixels from the top left corner.
pub fn camera_ray(world: &World, (width, height): (u32, u32), (x, y): (f64, f64)) -> Ray {
    let camera = &world.cameras[0];
    let forward = (camera.look_at - camera.eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let half = libm::tan(camera.fov / 2.0);
    let (width, height) = (f64::from(width), f64::from(height));
    let across = (2.0 * x - width) / height * half;
    let upward = (1.0 - 2.0 * y / height) * half;
    Ray { origin: camera.eye, direction: (forward + across * right + upward * up).normalize() }
}

/// A picture by path tracing with `spp` jittered samples a pixel.
pub fn render(world: &World, (width, height): (u32, u32), spp: u32, finds: Finds, seed: u64) -> Vec<Pixel> {
    let lights = light::of(world);
    picture((width, height), spp, seed, |place, random| {
        let ray = camera_ray(world, (width, height), place);
        path::radiance(world, &lights, finds, ray, random)
    })
}

/// A picture by Whitted's algorithm with `spp` samples a pixel, all through the pixel's centre.
pub fn render_whitted(world: &World, (width, height): (u32, u32), spp: u32, seed: u64) -> Vec<Pixel> {
    let lights = light::of(world);
    picture((width, height), spp, seed, |(x, y), random| {
        let ray = camera_ray(world, (width, height), (libm::floor(x) + 0.5, libm::floor(y) + 0.5));
        whitted::radiance(world, &lights, ray, DVec3::ONE, random)
    })
}

fn picture(
    (width, height): (u32, u32),
    spp: u32,
    seed: u64,
    sample: impl Fn((f64, f64), &mut Random) -> DVec3 + Sync,
) -> Vec<Pixel> {
    let pixel = |index: u32| {
        let mut random = Random::new(seed << 32 | u64::from(index));
        let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
        for _ in 0..spp {
            let place = (f64::from(index % width) + random.unit(), f64::from(index / width) + random.unit());
            let radiance = sample(place, &mut random);
            sum += radiance;
            squares += radiance * radiance;
        }
        let n = f64::from(spp);
        let mean = sum / n;
        Pixel { mean, variance: ((squares / n - mean * mean) / (n - 1.0).max(1.0)).max(DVec3::ZERO) }
    };
    (0..width * height).into_par_iter().map(pixel).collect()
}
