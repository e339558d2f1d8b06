//! What of the geometry asks for trouble: no area, slivers, things twice, gaps and things too small for the scene, a scene
//! too far from the origin, a camera on a surface.

use std::collections::HashSet;

use glam::DVec3;
use smalti_core::scene::double::{Ray, nearest};
use smalti_core::scene::soundness::{Finding as Unsound, Names, examine};
use smalti_core::scene::{Frame, Origin, World, compile, contact, newell};

use crate::Patient;
use crate::finding::{Finding, Verdict, counted};
use crate::turned::size;

/// A triangle whose height is this small beside its longest edge is a sliver.
const SLIVER: f64 = 1e-6;

/// Smaller than this beside the scene, and a thing has few coordinates left to be described by.
const SMALL: f64 = 1e-5;

/// Farther than so many sizes of the scene, and the camera sees a point.
const FAR: f64 = 1e4;

/// Rounding of coordinates in the frame, by the scene's size.
const STEP: f64 = 1.0 / (1 << 24) as f64;

/// Gaps of fewer steps may close: points on spheres are known to some 6 steps of the frame, in which the scene is 1 to 2
/// wide.
const STEPS: f64 = 7.5;

/// Things that are named one by one.
const NAMED: usize = 3;

/// Looks at the geometry.
pub fn check(patient: &Patient<'_>, tell: &mut impl FnMut(Finding)) {
    let dropped = compile(patient.world, false).dropped;
    let mut warn = |case: &'static str, figure: f64, says: Result<String, String>| {
        let is_sound = says.is_ok();
        let says = says.unwrap_or_else(|wrong| wrong);
        tell(Finding::new(("geometry", case), (is_sound, Verdict::Warning), figure, says));
    };
    let none_or = |count: usize, none: &str, some: String| if count == 0 { Ok(none.to_owned()) } else { Err(some) };
    let surfaces = surfaces(patient.world);
    let without = format!("{} without area: left out", counted(dropped, "surface"));
    warn("degenerate", dropped as f64, none_or(dropped, "every surface has an area", without));
    listed("slivers", slivers(&surfaces), "a million times as long as high", &mut warn);
    listed("twice", twice(&surfaces), "there twice, so that the first one counts", &mut warn);
    listed("small", small(patient.world, &surfaces), "less than 1e-5 of the scene", &mut warn);
    listed("gaps", gaps(patient.world), "so near another that rounding may join them", &mut warn);
    unsound(patient.world, &mut warn);
    coordinates(patient.world, &mut warn);
    cameras(patient.world, &mut warn);
}

/// Tells how many things `are` so, and which.
fn listed(
    case: &'static str,
    things: Vec<String>,
    are: &str,
    warn: &mut impl FnMut(&'static str, f64, Result<String, String>),
) {
    let count = things.len();
    let more = if count > NAMED { format!(" and {} more", count - NAMED) } else { String::new() };
    let says = match count {
        0 => Ok("none".to_owned()),
        _ => Err(format!("{are}: {}{more}", things[..count.min(NAMED)].join(", "))),
    };
    warn(case, count as f64, says);
}

/// Every polygon and triangle.
fn surfaces(world: &World) -> Vec<(Origin, Vec<DVec3>)> {
    let polygons = world.polygons.iter().enumerate();
    let polygons = polygons.map(|(index, polygon)| (Origin::Polygon(index as u32), polygon.vertices.clone()));
    let triangles = world.meshes.iter().enumerate().flat_map(|(index, mesh)| {
        mesh.faces.iter().enumerate().map(move |(number, face)| {
            (Origin::Mesh(index as u32, number as u32), face.map(|corner| mesh.vertices[corner as usize]).to_vec())
        })
    });
    polygons.chain(triangles).collect()
}

fn slivers(surfaces: &[(Origin, Vec<DVec3>)]) -> Vec<String> {
    let is_sliver = |corners: &[DVec3]| {
        let next = corners.iter().cycle().skip(1);
        let longest = corners.iter().zip(next).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let area = newell(corners).length();
        area > 0.0 && area < SLIVER * longest * longest
    };
    surfaces.iter().filter(|surface| is_sliver(&surface.1)).map(|surface| surface.0.to_string()).collect()
}

/// Surfaces with the corners of an earlier one, in whatever order.
fn twice(surfaces: &[(Origin, Vec<DVec3>)]) -> Vec<String> {
    let mut seen = HashSet::new();
    let key = |corners: &[DVec3]| {
        let mut key: Vec<[u64; 3]> = corners.iter().map(|c| c.to_array().map(|x| (x + 0.0).to_bits())).collect();
        key.sort_unstable();
        key
    };
    surfaces.iter().filter(|surface| !seen.insert(key(&surface.1))).map(|surface| surface.0.to_string()).collect()
}

/// Polygons, spheres and whole meshes too small for the scene; those that emit are called lights.
fn small(world: &World, surfaces: &[(Origin, Vec<DVec3>)]) -> Vec<String> {
    let size = size(world);
    let extent = |points: &mut dyn Iterator<Item = DVec3>| {
        let box_of = points.map(|point| (point, point)).reduce(|(low, high), (p, _)| (low.min(p), high.max(p)));
        box_of.map_or(0.0, |(low, high)| (high - low).max_element())
    };
    let polygons = world.polygons.iter().zip(surfaces).map(|(polygon, (origin, corners))| {
        (origin.to_string(), polygon.radiance.is_some(), extent(&mut corners.iter().copied()))
    });
    let meshes = world.meshes.iter().enumerate().map(|(index, mesh)| {
        (format!("mesh {index}"), mesh.radiance.is_some(), extent(&mut mesh.vertices.iter().copied()))
    });
    let spheres =
        world.spheres.iter().enumerate().map(|(index, ball)| {
            (Origin::Sphere(index as u32).to_string(), ball.radiance.is_some(), 2.0 * ball.radius)
        });
    let named = |(name, emits, extent): (String, bool, f64)| {
        let light = if emits { "the light " } else { "" };
        (extent < SMALL * size).then(|| format!("{light}{name} ({:.0e} of the scene)", extent / size))
    };
    polygons.chain(meshes).chain(spheres).filter_map(named).collect()
}

/// Spheres whose surface is nearer to that of another than coordinates can tell, without touching it.
fn gaps(world: &World) -> Vec<String> {
    let least = STEPS * STEP * size(world);
    let mut near = Vec::new();
    for (index, ball) in world.spheres.iter().enumerate() {
        for (other, another) in world.spheres[..index].iter().enumerate() {
            let apart = ball.centre.distance(another.centre);
            let beside = (apart - ball.radius - another.radius).abs();
            let inside = ((ball.radius - another.radius).abs() - apart).abs();
            let gap = beside.min(inside);
            if gap < least {
                near.push(format!("sphere {index} and sphere {other} ({gap:.0e} m)"));
            }
        }
    }
    near
}

/// The names of a world, which has none.
struct Numbered;

impl Names for Numbered {
    fn surface(&self, surface: Origin) -> String {
        surface.to_string()
    }

    fn material(&self, material: usize) -> String {
        format!("material {material}")
    }
}

/// Dielectrics and lamps that are hardly meant as they are wound, and what is too thin or too small for coordinates.
fn unsound(world: &World, warn: &mut impl FnMut(&'static str, f64, Result<String, String>)) {
    let frame = Frame::of(world);
    let found = examine(world, &frame, &contact::pairs(world, &frame));
    for (case, none) in [
        ("open", "every dielectric is closed"),
        ("turned round", "every dielectric and lamp shows its outside"),
        ("thin", "no dielectric is as thin as coordinates are rounded"),
        ("coarse", "everything has coordinates enough where it lies"),
    ] {
        let says: Vec<String> =
            found.iter().filter(|finding| case_of(finding) == case).map(|finding| finding.says(&Numbered)).collect();
        let count = says.len();
        warn(case, count as f64, if count == 0 { Ok(none.to_owned()) } else { Err(says.join("; ")) });
    }
}

fn case_of(finding: &Unsound) -> &'static str {
    match finding {
        Unsound::Open { .. } => "open",
        Unsound::InsideOut { .. } | Unsound::ShinesInwards { .. } => "turned round",
        Unsound::Thin { .. } => "thin",
        Unsound::Coarse { .. } | Unsound::Rough { .. } => "coarse",
    }
}

/// How coarse f64 is where the scene lies.
fn coordinates(world: &World, warn: &mut impl FnMut(&'static str, f64, Result<String, String>)) {
    let size = size(world);
    let largest = world.bounds().map_or(0.0, |(low, high)| low.abs().max(high.abs()).max_element());
    let step = largest * f64::EPSILON;
    let says = match step > STEP * size {
        false => Ok(format!("known to {:.0e} of the scene, rounded to {STEP:.0e} of it", step / size)),
        true => Err(format!(
            "so far from the origin that coordinates are quantised to {step:.1e} m: the scene is {size:.1e} m"
        )),
    };
    warn("coordinates", step / size, says);
}

/// Cameras that see a point, or stand in a surface.
fn cameras(world: &World, warn: &mut impl FnMut(&'static str, f64, Result<String, String>)) {
    let size = size(world);
    let middle = world.bounds().map_or(DVec3::ZERO, |(low, high)| (low + high) / 2.0);
    for camera in &world.cameras {
        let name = if camera.name.is_empty() { "the camera".into() } else { format!("camera {}", camera.name) };
        let away = camera.eye.distance(middle) / size;
        let says = match away > FAR {
            true => Err(format!("{name} is {away:.0e} times the scene's size away from it")),
            false => Ok(format!("{name} is {away:.2} times the scene's size from its middle")),
        };
        warn("camera", away, says);
        // Rays that start a little behind the eye find what it is on.
        let least = STEPS * STEP * size;
        let ways = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|way| [way, -way]);
        let near = ways.filter_map(|direction| nearest(world, &Ray { origin: camera.eye, direction }, -least));
        let near = near.map(|hit| hit.distance.abs() * hit.cosine).fold(f64::INFINITY, f64::min) / size;
        if near * size < least {
            warn("camera", near, Err(format!("{name} is on a surface: it sees what is on the side that it looks to")));
        }
    }
}

#[cfg(test)]
mod tests {
    use smalti_core::render::Level;
    use smalti_core::scene::world::{Camera, Material, Polygon, Sphere};
    use smalti_core::settings::Settings;

    use super::*;

    fn verdicts(world: &World) -> Vec<(String, Verdict, String)> {
        let settings = Settings::default();
        let mut found = Vec::new();
        let patient = Patient { world, settings: &settings, level: Level::available()[0] };
        check(&patient, &mut |finding| found.push((finding.case, finding.verdict, finding.says)));
        found
    }

    fn ball(z: f64, radius: f64) -> Sphere {
        Sphere { centre: DVec3::Z * z, radius, material: 0, radiance: None }
    }

    fn world() -> World {
        let camera = Camera { name: String::new(), eye: DVec3::X * 5.0, look_at: DVec3::ZERO, up: DVec3::Z, fov: 1.0 };
        World {
            materials: vec![Material::Lambert { albedo: [0.5; 3] }],
            spheres: vec![ball(0.0, 1.0)],
            cameras: vec![camera],
            ..World::default()
        }
    }

    fn triangle(corners: [[f64; 3]; 3]) -> Polygon {
        Polygon { vertices: corners.map(DVec3::from_array).to_vec(), material: 0, radiance: None }
    }

    #[test]
    fn a_ball_is_sound() {
        assert!(verdicts(&world()).iter().all(|(_, verdict, _)| *verdict == Verdict::Sound));
    }

    type Change = fn(&mut World);

    #[test]
    fn each_trouble_is_named() {
        let cases: [(&str, &str, Change); 8] = [
            ("degenerate", "1 surface", |w| w.polygons.push(triangle([[0.0; 3], [1.0; 3], [2.0; 3]]))),
            ("slivers", "polygon 0", |w| {
                w.polygons.push(triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1e-8, 0.0]]));
            }),
            ("twice", "polygon 1", |w| {
                let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
                let [a, b, c] = corners;
                w.polygons.extend([triangle(corners), triangle([b, c, a])]);
            }),
            ("small", "the light sphere 1", |w| w.spheres.push(Sphere { radiance: Some([1.0; 3]), ..ball(0.5, 1e-7) })),
            ("gaps", "sphere 1 and sphere 0", |w| w.spheres.push(ball(0.0, 1.0 + 1e-9))),
            ("gaps", "sphere 1 and sphere 0", |w| w.spheres.push(ball(2.0 + 1e-9, 1.0))),
            ("coordinates", "quantised", |w| w.spheres[0].centre.x = 1e10),
            ("camera", "on a surface", |w| w.cameras[0].eye = DVec3::X),
        ];
        for (case, says, change) in cases {
            let mut changed = world();
            change(&mut changed);
            let found = verdicts(&changed);
            let warned: Vec<_> = found.iter().filter(|(_, verdict, _)| *verdict == Verdict::Warning).collect();
            assert!(warned.iter().any(|(of, _, what)| of == case && what.contains(says)), "{case}: {warned:?}");
        }
    }
}
