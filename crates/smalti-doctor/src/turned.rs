//! The same scene in another unit, in another place, or turned.

use glam::{DQuat, DVec3};
use smalti_core::scene::World;
use smalti_core::settings::Settings;

/// The largest extent of a scene; 1 where there is nothing, or a point.
pub fn size(world: &World) -> f64 {
    let extent = world.bounds().map_or(0.0, |(low, high)| (high - low).max_element());
    if extent > 0.0 { extent } else { 1.0 }
}

/// Extent of the smallest polygon that emits; `None` if there is none. (A sphere is as large wherever it is.)
pub fn smallest_lamp(world: &World) -> Option<f64> {
    let lamps = world.polygons.iter().filter(|polygon| polygon.radiance.is_some());
    let extent = |corners: &[DVec3]| {
        let low = corners.iter().copied().reduce(DVec3::min)?;
        Some((corners.iter().copied().reduce(DVec3::max)? - low).max_element())
    };
    lamps.filter_map(|polygon| extent(&polygon.vertices)).reduce(f64::min)
}

/// Lengths `factor` times as large, with the settings that are lengths.
pub fn scaled(world: &World, settings: &Settings, factor: f64) -> (World, Settings) {
    let settings = Settings { radius: settings.radius.map(|radius| radius * factor), ..settings.clone() };
    (world.placed(factor, |point| point * factor), settings)
}

/// Moved by a vector.
pub fn moved(world: &World, by: DVec3) -> World {
    world.placed(1.0, |point| point + by)
}

/// Turned about its middle.
pub fn turned(world: &World, by: DQuat) -> World {
    let middle = world.bounds().map_or(DVec3::ZERO, |(low, high)| (low + high) / 2.0);
    let mut turned = world.placed(1.0, |point| middle + by * (point - middle));
    turned.cameras.iter_mut().for_each(|camera| camera.up = by * camera.up);
    turned
}

#[cfg(test)]
mod tests {
    use smalti_core::scene::world::{Camera, Sphere};

    use super::*;

    #[test]
    fn a_turn_keeps_what_the_camera_sees() {
        let camera = Camera { name: String::new(), eye: DVec3::X * 5.0, look_at: DVec3::ZERO, up: DVec3::Z, fov: 1.0 };
        let ball = Sphere { centre: DVec3::new(1.0, 2.0, 3.0), radius: 0.5, material: 0, radiance: None };
        let world = World { spheres: vec![ball], cameras: vec![camera], ..World::default() };
        let after = turned(&world, DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.0));
        let seen = |world: &World| {
            let camera = &world.cameras[0];
            let (ahead, to) = ((camera.look_at - camera.eye).normalize(), world.spheres[0].centre - camera.eye);
            [to.dot(ahead), to.dot(camera.up), to.dot(ahead.cross(camera.up))]
        };
        for (a, b) in seen(&world).into_iter().zip(seen(&after)) {
            assert!((a - b).abs() < 1e-12, "{a} and {b}");
        }
        assert_eq!((size(&world), size(&World::default())), (1.0, 1.0));
    }
}
