//! Rays that leave a surface: do they hit it again?

use glam::DVec3;
use smalti_core::accel::{Accel, MISS, Tracer};
use smalti_core::geometry::Ray;
use smalti_core::lanes::{One, V3};
use smalti_core::light::table::NO_SURFACE;
use smalti_core::scene::{Scene, World, compile};
use smalti_core::stream::{Columns, DIRECTION, LEAVES, ORIGIN, PRIM, Stream, THROUGHPUT, intersect, surface};

use crate::build::{at, closed_box, grey, material, mesh, sphere};
use crate::oracle::Random;

/// Rays that were traced.
#[derive(Clone, Copy, Debug, Default)]
pub struct Left {
    /// Rays that left a solid to its outside.
    pub out: u64,
    /// Rays through the inside of a sphere.
    pub across: u64,
}

impl core::ops::AddAssign for Left {
    fn add_assign(&mut self, other: Self) {
        self.out += other.out;
        self.across += other.across;
    }
}

/// A tetrahedron, down to a thousandth as thin as wide, in a room at any scale: rays from `hits` hits, 20 of each.
///
/// # Errors
/// A ray that hit the tetrahedron again, or nothing.
pub fn from_tetrahedron(hits: u32, random: &mut Random) -> Result<Left, String> {
    let thin = 1.0 / log_uniform(random, 3.0);
    let scene = room(random, |world, centre, random| {
        let corners = [0; 4].map(|_| centre + random.cube() * at(1.0, 1.0, thin));
        tetrahedron(world, corners);
    });
    // Polygons come first: the six walls; then the tetrahedron.
    let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
    let accel = Accel::new(&scene, &prims);
    let mut tracer = Tracer::new(One, &accel);
    let solid = |prim: u32| (6..10).contains(&prim);
    let mut left = Left::default();
    for _ in 0..hits {
        let goal = inside_of(&scene, 6..10, random);
        let Some((hit, prim)) = shaded(&scene, &accel, in_room(&scene, random), goal) else { continue };
        if !solid(prim) || !hit.outside {
            continue;
        }
        for _ in 0..20 {
            let direction = outward(random, vector(hit.normal));
            let (_, again) = next(&mut tracer, &hit, hit.normal, direction);
            if solid(again) || again == MISS {
                return Err(format!("left {prim}, hit {again} (solid {thin} thin)"));
            }
            left.out += 1;
        }
    }
    Ok(left)
}

/// A sphere, down to a thousandth of the room's unit, in a room at any scale: rays from `hits` hits, 10 of each outward and
/// 10 through its inside.
///
/// # Errors
/// A ray that hit the sphere again where it must not, or did not where it must.
pub fn from_sphere(hits: u32, random: &mut Random) -> Result<Left, String> {
    let radius = 1.0 / log_uniform(random, 3.0);
    let scene = room(random, |world, centre, _| sphere(world, centre, radius, 0, None));
    let prims: Vec<u32> = (0..scene.shades.len() as u32).collect();
    let accel = Accel::new(&scene, &prims);
    let mut tracer = Tracer::new(One, &accel);
    let [x, y, z, r] = scene.spheres[0].map(f64::from);
    let mut left = Left::default();
    for _ in 0..hits {
        let goal = at(x, y, z) + random.cube() * r * 0.57;
        let Some((hit, 6)) = shaded(&scene, &accel, in_room(&scene, random), goal) else { continue };
        let normal = vector(hit.normal);
        for _ in 0..10 {
            let direction = outward(random, normal);
            let (_, again) = next(&mut tracer, &hit, hit.normal, direction);
            // What leaves by less than the rounding of coordinates, which are within 1, may be taken to enter.
            let cosine = direction.dot(normal);
            if again >= 6 && r * cosine >= 1.2e-7 {
                return Err(format!("left a sphere of {r} at cosine {cosine}, hit {again}"));
            }
            left.out += 1;
            // What is shorter than the offset (coordinates are within 1) cannot be told from nothing.
            let chord = 2.0 * r * cosine;
            if chord < 2e-5 {
                continue;
            }
            let (t, other_side) = next(&mut tracer, &hit, -hit.normal, -direction);
            if other_side != 6 || (f64::from(t) - chord).abs() >= 5e-6 {
                return Err(format!("into a sphere of {r}: hit {other_side} after {t} instead of 6 after {chord}"));
            }
            left.across += 1;
        }
    }
    Ok(left)
}

/// A length between 1 and 10^`decades`, even in its logarithm.
fn log_uniform(random: &mut Random, decades: f64) -> f64 {
    libm::exp10(random.between(0.0, decades))
}

/// A tetrahedron, turned so that its faces look outward.
fn tetrahedron(world: &mut World, corners: [DVec3; 4]) {
    let [a, b, c, d] = corners;
    let corners = if (b - a).cross(c - a).dot(d - a) < 0.0 { corners } else { [a, c, b, d] };
    let faces = vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
    mesh(world, (corners.to_vec(), faces), 0, None);
}

/// Where a packet of one ray hits, as shading sees it, or nothing.
pub fn shaded(scene: &Scene, accel: &Accel, from: DVec3, goal: DVec3) -> Option<(surface::Hit<One>, u32)> {
    let mut rays = Stream::new(1, Columns::default());
    let direction = (goal - from).normalize().as_vec3().to_array();
    rays.set_v3(One, ORIGIN, 0, V3::splat(One, from.as_vec3().to_array()));
    rays.set_v3(One, DIRECTION, 0, V3::splat(One, direction));
    rays.set_v3(One, THROUGHPUT, 0, V3::splat(One, [1.0; 3]));
    rays.set_u(One, LEAVES, 0, NO_SURFACE);
    rays.set_len(1);
    intersect::run(One, accel, &mut rays);
    let prim = rays.value(PRIM, 0);
    (prim != MISS).then(|| (surface::hit(One, scene, &rays, 0), prim))
}

/// What a ray from a hit, along `direction` to the side of `side`, hits next.
pub fn next(tracer: &mut Tracer<'_, One>, hit: &surface::Hit<One>, side: V3<One>, direction: DVec3) -> (f32, u32) {
    let direction = V3::splat(One, direction.as_vec3().to_array());
    let ray = Ray::new(One, hit.leave(One, side), direction, hit.surface);
    tracer.nearest(One, &ray, true)
}

/// In f64.
pub fn vector(v: V3<One>) -> DVec3 {
    DVec3::new(v.x.into(), v.y.into(), v.z.into())
}

/// A direction to the side of the normal: any, or one that grazes.
fn outward(random: &mut Random, normal: DVec3) -> DVec3 {
    // Of unit length in f64 too: else a direction next to the normal, made flat, has a share of it left.
    let normal = normal.normalize();
    let any = random.cosine_about(normal);
    let flat = (any - any.dot(normal) * normal).normalize_or(normal.any_orthonormal_vector());
    if random.unit() < 0.5 { any } else { (flat + 1e-3 * random.unit() * normal).normalize() }
}

/// A scene at any scale: one solid of about unit size, or less, somewhere in a room of 10 to 1000 units.
fn room(random: &mut Random, solid: impl FnOnce(&mut World, DVec3, &mut Random)) -> Scene {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    let scale = log_uniform(random, 12.0) * 1e-6;
    let half = log_uniform(random, 2.0) * 10.0;
    let centre = random.cube() * (half - 4.0);
    solid(&mut world, centre, random);
    closed_box(&mut world, DVec3::ZERO, DVec3::splat(half), white, None);
    let away = random.cube() * 1e3;
    compile(&world.placed(scale, |v| (v + away) * scale), false)
}

/// A point of the room, in the frame, not at its walls: the first six faces.
fn in_room(scene: &Scene, random: &mut Random) -> DVec3 {
    let corners = (0..6)
        .map(|wall| scene.bounds(wall))
        .map(|ends| [ends.0, ends.1].map(|end| DVec3::from_array(end.map(f64::from))));
    let [low, high] = corners.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]).expect("six walls");
    (low + high) / 2.0 + random.cube() * 0.45 * (high - low)
}

/// A point inside the hull of some faces' corners.
fn inside_of(scene: &Scene, faces: core::ops::Range<usize>, random: &mut Random) -> DVec3 {
    let corners: Vec<DVec3> = scene.faces[faces]
        .iter()
        .flat_map(|face| scene.face_corners(face))
        .map(|&i| DVec3::from_array(scene.vertices[i as usize].map(f64::from)))
        .collect();
    let weights: Vec<f64> = corners.iter().map(|_| -libm::log(1.0 - random.unit())).collect();
    corners.iter().zip(&weights).map(|(corner, weight)| *corner * *weight).sum::<DVec3>() / weights.iter().sum::<f64>()
}
