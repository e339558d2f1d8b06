//! Direct light by sampling the area of one light, chosen uniformly.

use core::f64::consts::PI;

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::{PointLight, Rgb, Sphere};

use super::Random;
use super::hit::{blocked, normal};

/// Something that emits and has a place.
#[derive(Clone, Copy, Debug)]
pub enum Light {
    /// One side of a triangle.
    Triangle([DVec3; 3], Rgb),
    /// The outside of a sphere.
    Ball(Sphere, Rgb),
    /// A point.
    Point(PointLight),
}

/// Every light of the world.
pub fn of(world: &World) -> Vec<Light> {
    let mut lights = Vec::new();
    for polygon in &world.polygons {
        let v = &polygon.vertices;
        let fan = (1..v.len() - 1).map(|k| [v[0], v[k], v[k + 1]]);
        lights
            .extend(polygon.radiance.iter().flat_map(|rgb| fan.clone().map(|corners| Light::Triangle(corners, *rgb))));
    }
    for mesh in &world.meshes {
        let triangles = mesh.faces.iter().map(|face| face.map(|i| mesh.vertices[i as usize]));
        lights.extend(
            mesh.radiance.iter().flat_map(|rgb| triangles.clone().map(|corners| Light::Triangle(corners, *rgb))),
        );
    }
    lights.extend(world.spheres.iter().filter_map(|ball| ball.radiance.map(|rgb| Light::Ball(*ball, rgb))));
    lights.extend(world.point_lights.iter().map(|light| Light::Point(*light)));
    lights
}

/// An estimate of the irradiance from all `lights` at a point and a normal, through what absorbs so much a metre.
pub fn irradiance(
    world: &World,
    lights: &[Light],
    (at, facing): (DVec3, DVec3),
    absorption: DVec3,
    random: &mut Random,
) -> DVec3 {
    if lights.is_empty() {
        return DVec3::ZERO;
    }
    let (place, density, intensity) = sample(lights[random.below(lights.len())], at, random);
    let reach = place - at;
    let cosine = facing.dot(reach.normalize());
    if cosine <= 0.0 || intensity == DVec3::ZERO || blocked(world, at, place) {
        return DVec3::ZERO;
    }
    let left = transmittance(absorption, reach.length());
    left * intensity * cosine * lights.len() as f64 / (reach.length_squared() * density)
}

/// What is left of light after so much of something that absorbs.
pub fn transmittance(absorption: DVec3, distance: f64) -> DVec3 {
    DVec3::from_array(absorption.to_array().map(|each| libm::exp(-each * distance)))
}

/// A place on the light, its density by area, and the intensity a unit of area in the direction of `seen_from`.
fn sample(light: Light, seen_from: DVec3, random: &mut Random) -> (DVec3, f64, DVec3) {
    match light {
        Light::Triangle([a, b, c], radiance) => {
            let (root, v) = (random.unit().sqrt(), random.unit());
            let place = a + root * (1.0 - v) * (b - a) + root * v * (c - a);
            let area = (b - a).cross(c - a).length() / 2.0;
            (place, 1.0 / area, lambertian(place, normal([a, b, c]), radiance, seen_from))
        }
        Light::Ball(ball, radiance) => {
            let outward = random.direction();
            let place = ball.centre + ball.radius * outward;
            let area = 4.0 * PI * ball.radius * ball.radius;
            (place, 1.0 / area, lambertian(place, outward, radiance, seen_from))
        }
        Light::Point(point) => (point.position, 1.0, DVec3::from_array(point.intensity)),
    }
}

/// Radiance × cosine at the light.
fn lambertian(place: DVec3, normal: DVec3, radiance: Rgb, seen_from: DVec3) -> DVec3 {
    DVec3::from_array(radiance) * normal.dot((seen_from - place).normalize()).max(0.0)
}
