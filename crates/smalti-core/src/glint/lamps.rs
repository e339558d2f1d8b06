//! Which lamps may be seen as glints: those whose image may be far smaller than a pixel.

use glam::DVec3;

use crate::light::lamps::around_emitters;
use crate::scene::{Class, Scene, View};
use crate::settings::Settings;

/// Lamps beyond which none is looked for: every pixel that may see one goes through all of them.
const MOST: usize = 32;

/// Share of a pixel up to which an image is a glint: larger ones 64 samples find 8 times.
pub const LARGEST: f64 = 0.125;

/// A lamp that is looked for, and the sphere around it.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its emitter number.
    pub emitter: u32,
    /// Centre, in the frame.
    pub centre: DVec3,
    /// Radius, in the frame.
    pub radius: f64,
}

/// The lamps that the camera may see far smaller than a pixel; none where there are too many lamps, where samples lie on
/// the pixels' centres, or without a camera.
pub fn targets(scene: &Scene, settings: &Settings) -> Vec<Target> {
    let spheres = around_emitters(&scene.lights);
    let Some(view) = scene.views.get(settings.camera).filter(|_| settings.jitter && spheres.len() <= MOST) else {
        return Vec::new();
    };
    let targets = (0..).zip(spheres).map(|(emitter, [x, y, z, radius])| {
        let [x, y, z, radius] = [x, y, z, radius].map(f64::from);
        Target { emitter, centre: DVec3::new(x, y, z), radius }
    });
    let casters = casters(scene);
    targets.filter(|target| smallest_image((view, settings), &casters, target) < LARGEST).collect()
}

/// Centre, radius and curvature radius (infinite if flat) of what is specular.
fn casters(scene: &Scene) -> Vec<(DVec3, f64)> {
    let specular = |prim: &u32| matches!(scene.class(*prim), Some(Class::Mirror | Class::Dielectric));
    let prims = (0..scene.shades.len() as u32).filter(specular);
    prims
        .map(|prim| match scene.spheres.get((prim as usize).wrapping_sub(scene.faces.len())) {
            Some([x, y, z, r]) => (DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z)), f64::from(*r)),
            None => {
                let [low, high] = <[_; 2]>::from(scene.bounds(prim)).map(|c| DVec3::from_array(c.map(f64::from)));
                (low.midpoint(high), f64::INFINITY)
            }
        })
        .collect()
}

/// Area of the smallest image that the camera sees of a lamp, roughly, in pixels: directly, or reflected by one caster.
///
/// A ball of radius R shows a lamp of radius ρ at distance D as a disc of radius ρ R / 2 D (its focal length is R / 2), a
/// flat one as what it is, farther away.
fn smallest_image((view, settings): (&View, &Settings), casters: &[(DVec3, f64)], target: &Target) -> f64 {
    let [eye, up] = [view.eye, view.up].map(|v| DVec3::from_array(v.map(f64::from)));
    let pixel = 2.0 * up.length() / f64::from(settings.height);
    let direct = target.radius / target.centre.distance(eye);
    let seen = casters.iter().map(|(centre, radius)| {
        let (to, from) = (centre.distance(eye), centre.distance(target.centre));
        if radius.is_finite() { target.radius * radius / (2.0 * from * to) } else { target.radius / (to + from) }
    });
    let angle = seen.fold(direct, f64::min);
    core::f64::consts::PI * (angle / pixel) * (angle / pixel)
}
