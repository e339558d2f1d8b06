//! How far the kernels, which are f32, are from the truth in f64, over their whole domains and at their edges; with the
//! bound that each of them must keep. `just accuracy` prints the table that stands in docs/kernels.md.

use core::f64::consts::{FRAC_PI_4, PI, TAU};

use glam::DVec3;
use smalti_core::accel::{Accel, MISS, Tracer};
use smalti_core::bsdf::fresnel::{boundary, reflectance};
use smalti_core::geometry::polygon::{around, inverse_direction, slab};
use smalti_core::geometry::{Ray, offset};
use smalti_core::lanes::math::{disc_segment, exp_minus, leading_bits, sin_cos_quarter, sin_cos_turn};
use smalti_core::lanes::{One, V3};
use smalti_core::light::table::NO_SURFACE;
use smalti_core::photon::{Photons, Quantity, Tag};
use smalti_core::sampling::warp;
use smalti_core::scene::{Scene, World, compile};
use smalti_core::settings::{Fresnel, Settings};

use crate::build::{at, grey, material, point_light, polygon, sphere};
use crate::oracle::{Random, optics};
use crate::photons::{Place, irradiance, map_of, mapper};

/// A kernel and what it promises.
pub struct Kernel {
    /// What it computes.
    pub name: &'static str,
    /// Of what arguments.
    pub domain: &'static str,
    /// What the error is relative to.
    pub measure: &'static str,
    /// The error that it may have.
    pub bound: f64,
    /// The largest error of so many arguments, drawn from the domain with its edges.
    pub worst: fn(&mut Random, u32) -> Worst,
}

/// The largest error that was found.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    /// How large it is.
    pub error: f64,
    /// The arguments that had it.
    pub at: [f64; 3],
}

impl Worst {
    /// The larger of two; what is not a number is larger than anything.
    pub fn or(self, error: f64, at: [f64; 3]) -> Self {
        if error <= self.error { self } else { Self { error, at } }
    }
}

/// Every kernel.
pub const KERNELS: &[Kernel] = &[
    Kernel {
        name: "sine and cosine",
        domain: "turns in [0, 1)",
        measure: "absolute",
        bound: 1.5e-7,
        worst: sine_and_cosine,
    },
    Kernel {
        name: "sine and cosine of small angles",
        domain: "up to π/4 to both sides",
        measure: "absolute",
        bound: 1e-7,
        worst: of_small_angles,
    },
    Kernel {
        name: "transmittance e^(−σd)",
        domain: "σd from 0 to 80, σ from 1e-6 to 1e6",
        measure: "relative",
        bound: 4e-7,
        worst: transmittance,
    },
    Kernel {
        name: "part of a disc behind a chord",
        domain: "distances from 0 to the radius",
        measure: "absolute",
        bound: 2e-6,
        worst: segment,
    },
    Kernel {
        name: "Fresnel reflectance from outside",
        domain: "indices 1, 1 + 1.2e-7 and up to 100; cosines from 0 to 1",
        measure: "absolute",
        bound: 4e-7,
        worst: |random, n| fresnel(random, n, true, |random| libm::pow(100.0, random.unit())),
    },
    Kernel {
        name: "Fresnel reflectance from inside glass",
        domain: "index 1.5; at the critical angle its derivative is infinite",
        measure: "absolute",
        bound: 2.5e-4,
        worst: |random, n| fresnel(random, n, false, |_| 1.5),
    },
    Kernel {
        name: "Fresnel reflectance of what is hardly thinner",
        domain: "index 0.999999, from outside",
        measure: "absolute",
        bound: 1.5e-3,
        worst: |random, n| fresnel(random, n, true, |_| 0.999_999),
    },
    Kernel {
        name: "Fresnel reflectance from inside",
        domain: "indices from 1.01 to 4; at the critical angle its derivative is infinite",
        measure: "absolute",
        bound: 1e-3,
        worst: |random, n| fresnel(random, n, false, |random| random.between(1.01, 4.0)),
    },
    Kernel {
        name: "cosine of refraction",
        domain: "indices from 1.01 to 100, from outside",
        measure: "absolute",
        bound: 3e-7,
        worst: refraction,
    },
    Kernel {
        name: "cosine-distributed direction",
        domain: "the unit square",
        measure: "its length",
        bound: 4e-7,
        worst: |random, n| unit_length(random, n, |u, v| warp::cosine_hemisphere(One, u, v)),
    },
    Kernel {
        name: "direction of the whole sphere",
        domain: "the unit square",
        measure: "its length",
        bound: 4e-7,
        worst: |random, n| unit_length(random, n, |u, v| warp::sphere(One, u, v)),
    },
    Kernel {
        name: "point of a triangle",
        domain: "the unit square",
        measure: "absolute",
        bound: 1e-7,
        worst: triangle,
    },
    Kernel {
        name: "opening 1 − cosθ of a sphere's cone",
        domain: "seen from 1.03 to 1e9 radii away",
        measure: "relative",
        bound: 3e-7,
        worst: |random, n| opening(random, n, [1.03, 1e9]),
    },
    Kernel {
        name: "the same, of a sphere that is nearly touched",
        domain: "seen from 1 to 1.03 radii away",
        measure: "relative",
        bound: 1.5e-6,
        worst: |random, n| opening(random, n, [1.0, 1.03]),
    },
    Kernel {
        name: "direction in a cone",
        domain: "openings from 1e-18 to 1",
        measure: "its 1 − cosθ, relative",
        bound: 4e-7,
        worst: cone,
    },
    Kernel {
        name: "unit vector",
        domain: "lengths from 1e-15 to 1e15",
        measure: "its length",
        bound: 2.5e-7,
        worst: normalised,
    },
    Kernel {
        name: "basis about a normal",
        domain: "every normal, ±z and −0 too",
        measure: "cosine between its axes",
        bound: 5e-7,
        worst: basis,
    },
    Kernel {
        name: "distance to a triangle",
        domain: "triangles in the frame, from within 4 units",
        measure: "along the normal, frame units",
        bound: 2e-6,
        worst: to_triangle,
    },
    Kernel {
        name: "distance to a sphere",
        domain: "from 1.01 to 1e4 radii away, to 0.999 of its silhouette",
        measure: "off the surface, by the distance",
        bound: 2e-6,
        worst: to_sphere,
    },
    Kernel {
        name: "box test",
        domain: "boxes and rays in the frame, axis-parallel and in a side's plane too",
        measure: "rays through the box that miss it",
        bound: 0.0,
        worst: missed_boxes,
    },
    Kernel {
        name: "point where a ray leaves a plane",
        domain: "hits in the frame from within 4 units; 24 · 2⁻²⁴ of the largest coordinate are wanted",
        measure: "off by so much of that: below 1, it is on its side",
        bound: 0.6,
        worst: offsets,
    },
    Kernel {
        name: "density estimate of photons",
        domain: "up to 400 photons of unlike flux in a disc",
        measure: "relative",
        bound: 2e-6,
        worst: density,
    },
];

/// One of the ends of [0, 1), something near one, or anything between.
fn edgy(random: &mut Random) -> f32 {
    const LAST: f32 = 1.0 - f32::EPSILON / 2.0;
    match random.below(8) {
        0 => [0.0, LAST, 0.5, 0.25, 0.75][random.below(5)],
        1 => libm::exp2(-60.0 * random.unit()) as f32 * LAST,
        2 => (1.0 - libm::exp2(-24.0 * random.unit())) as f32 * LAST,
        _ => (random.unit() as f32).min(LAST),
    }
}

/// A number between two, even in its logarithm.
fn log_between(random: &mut Random, low: f64, high: f64) -> f64 {
    low * libm::pow(high / low, random.unit())
}

fn worst(count: u32, mut sample: impl FnMut() -> (f64, [f64; 3])) -> Worst {
    (0..count).fold(Worst::default(), |worst, _| {
        let (error, at) = sample();
        worst.or(error, at)
    })
}

fn vector(v: V3<One>) -> DVec3 {
    DVec3::new(v.x.into(), v.y.into(), v.z.into())
}

fn lanes(v: DVec3) -> V3<One> {
    V3::splat(One, v.as_vec3().to_array())
}

fn sine_and_cosine(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let u = edgy(random);
        let (s, c) = sin_cos_turn(One, u);
        let (sine, cosine) = libm::sincos(TAU * f64::from(u));
        ((f64::from(s) - sine).abs().max((f64::from(c) - cosine).abs()), [u.into(), 0.0, 0.0])
    })
}

fn of_small_angles(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let x = ((2.0 * f64::from(edgy(random)) - 1.0) * FRAC_PI_4) as f32;
        let (s, c) = sin_cos_quarter(One, x);
        let (sine, cosine) = libm::sincos(x.into());
        ((f64::from(s) - sine).abs().max((f64::from(c) - cosine).abs()), [x.into(), 0.0, 0.0])
    })
}

fn transmittance(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let absorption = log_between(random, 1e-6, 1e6);
        let distance = (f64::from(edgy(random)) * 80.0 / absorption) as f32;
        let leading = leading_bits(absorption as f32);
        let found = exp_minus(One, (leading, (absorption - f64::from(leading)) as f32), distance);
        let truth = libm::exp(-absorption * f64::from(distance));
        ((f64::from(found) / truth - 1.0).abs(), [absorption, distance.into(), 0.0])
    })
}

fn segment(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let t = edgy(random);
        let x = f64::from(t);
        let truth = (libm::acos(x) - x * (1.0 - x * x).sqrt()) / PI;
        ((f64::from(disc_segment(One, t)) - truth).abs(), [x, 0.0, 0.0])
    })
}

/// What the kernels are given of an index.
fn constants(ior: f64) -> [f32; 3] {
    [ior as f32, (1.0 / ior) as f32, ((ior - 1.0) * (ior + 1.0)) as f32]
}

fn fresnel(random: &mut Random, count: u32, outside: bool, index: fn(&mut Random) -> f64) -> Worst {
    worst(count, || {
        let ior = match random.below(8) {
            0 if outside => [1.0, 1.0 + 1.2e-7, 1.0 + 1e-6, 100.0][random.below(4)],
            _ => index(random),
        };
        // Of what bends no light both directions are one at grazing incidence: there the share does not matter.
        let cosine = edgy(random).max(if ior == 1.0 { 1e-15 } else { 0.0 });
        let found = reflectance(One, Fresnel::Exact, &boundary(One, constants(ior), outside, cosine));
        let (n1, n2) = if outside { (1.0, ior) } else { (ior, 1.0) };
        // What bends no light reflects none, at any angle.
        let truth = if ior == 1.0 { 0.0 } else { optics::reflectance(cosine.into(), n1, n2) };
        ((f64::from(found) - truth).abs(), [ior, cosine.into(), 0.0])
    })
}

fn refraction(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let (ior, cosine) = (log_between(random, 1.01, 100.0), edgy(random));
        let found = boundary(One, constants(ior), true, cosine).cosine_refracted;
        let sine = (1.0 - f64::from(cosine) * f64::from(cosine)) / (ior * ior);
        ((f64::from(found) - (1.0 - sine).sqrt()).abs(), [ior, cosine.into(), 0.0])
    })
}

fn unit_length(random: &mut Random, count: u32, direction: fn(f32, f32) -> V3<One>) -> Worst {
    worst(count, || {
        let (u, v) = (edgy(random), edgy(random));
        ((vector(direction(u, v)).length() - 1.0).abs(), [u.into(), v.into(), 0.0])
    })
}

fn triangle(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let (u, v) = (edgy(random), edgy(random));
        let (a, b) = warp::triangle(One, u, v);
        let [u, v] = [u, v].map(f64::from);
        let (x, y) = if u < v { (u / 2.0, v - u / 2.0) } else { (u - v / 2.0, v / 2.0) };
        let outside = (f64::from(a) + f64::from(b) - 1.0).max(0.0);
        ((f64::from(a) - x).abs().max((f64::from(b) - y).abs()).max(outside), [u, v, 0.0])
    })
}

fn opening(random: &mut Random, count: u32, [nearest, farthest]: [f64; 2]) -> Worst {
    worst(count, || {
        let away = log_between(random, nearest, farthest);
        let (r2, d2) = (1.0f32, ((away * away) as f32).max(1.0));
        let sine = 1.0 / f64::from(d2);
        let truth = sine / (1.0 + (1.0 - sine).sqrt());
        ((f64::from(warp::sphere_opening(One, r2, d2)) / truth - 1.0).abs(), [away, 0.0, 0.0])
    })
}

fn cone(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let (opening, u, v) = (log_between(random, 1e-18, 1.0) as f32, edgy(random), edgy(random));
        let (direction, below) = warp::cone(One, opening, u, v);
        let truth = f64::from(u) * f64::from(opening);
        let across =
            (f64::from(direction.x) * f64::from(direction.x) + f64::from(direction.y) * f64::from(direction.y)).sqrt();
        let sine = (truth * (2.0 - truth)).sqrt();
        // Products below the smallest normal number are rounded coarsely, and count for nothing.
        let off =
            if truth < 1e-36 { 0.0 } else { (f64::from(below) / truth - 1.0).abs().max((across / sine - 1.0).abs()) };
        (off, [opening.into(), u.into(), v.into()])
    })
}

fn normalised(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let v = random.direction() * log_between(random, 1e-15, 1e15);
        ((vector(lanes(v).normalised(One)).length() - 1.0).abs(), v.to_array())
    })
}

fn basis(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let normal = match random.below(8) {
            0 => [DVec3::Z, -DVec3::Z, DVec3::X, at(1.0, 0.0, -0.0), at(0.0, -1.0, -0.0)][random.below(5)],
            1 => (at(1e-4, -1e-5, -1.0) * at(random.unit(), random.unit(), 1.0)).normalize(),
            _ => random.direction(),
        };
        let n = lanes(normal);
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| vector(warp::about(One, n, lanes(axis))));
        let exact = vector(n);
        let between = [x.dot(y), y.dot(z), z.dot(x), x.length() - 1.0, y.length() - 1.0, (z - exact).length()];
        (between.into_iter().fold(0.0, |worst: f64, off| worst.max(off.abs())), normal.to_array())
    })
}

/// A scene of one triangle; its plane in f64 as f32 has its corners.
fn one_triangle(random: &mut Random) -> (Scene, DVec3, DVec3) {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    let corners = [0; 3].map(|_| random.cube() * 0.995);
    polygon(&mut world, &corners, white, None);
    // Two tiny ones keep the frame where it is.
    for corner in [DVec3::splat(-1.0), DVec3::splat(1.0)] {
        sphere(&mut world, corner * 0.999, 0.001, white, None);
    }
    let scene = compile(&world, false);
    let [a, b, c] = [0, 1, 2].map(|k| DVec3::from_array(scene.vertices[k].map(f64::from)));
    (scene, a, (b - a).cross(c - a).normalize_or_zero())
}

/// Rays from within 4 units at a triangle: what they hit there. Grazing ones are left out: they end in its box.
fn hits_of_triangles(random: &mut Random, count: u32, mut look: impl FnMut(&Scene, DVec3, DVec3, V3<One>, f64)) {
    for _ in 0..count.div_ceil(64) {
        let (scene, corner, normal) = one_triangle(random);
        let accel = Accel::new(&scene, &[0]);
        let mut tracer = Tracer::new(One, &accel);
        let corners: Vec<DVec3> = scene.vertices[..3].iter().map(|v| DVec3::from_array(v.map(f64::from))).collect();
        for _ in 0..64 {
            let (a, b) = warp::triangle(One, random.unit() as f32, random.unit() as f32);
            let goal = corners[0]
                + 0.999 * (f64::from(a) * (corners[1] - corners[0]) + f64::from(b) * (corners[2] - corners[0]));
            let origin = (random.direction() * 4.0 * random.unit()).as_vec3().as_dvec3();
            let direction = (goal - origin).normalize().as_vec3().as_dvec3();
            if direction.dot(normal).abs() < 0.02 {
                continue;
            }
            let (t, prim) = tracer.nearest(One, &Ray::new(One, lanes(origin), lanes(direction), NO_SURFACE), true);
            if prim != MISS {
                look(&scene, corner, normal, lanes(origin).along(One, t, lanes(direction)), f64::from(t));
            }
        }
    }
}

fn to_triangle(random: &mut Random, count: u32) -> Worst {
    let mut found = Worst::default();
    hits_of_triangles(random, count, |_, corner, normal, point, t| {
        found = found.or((vector(point) - corner).dot(normal).abs(), [t, 0.0, 0.0]);
    });
    found
}

fn offsets(random: &mut Random, count: u32) -> Worst {
    let mut found = Worst::default();
    hits_of_triangles(random, count, |scene, _, _, point, t| {
        let [x, y, z, distance] = scene.faces[0].plane;
        let plane = V3::splat(One, [x, y, z]);
        let on = offset::onto_plane(One, point, plane, distance);
        let scale = on.max_abs(One);
        let left = vector(offset::leave(One, on, scale, plane));
        let wanted = 24.0 / f64::from(1u32 << 24) * f64::from(scale);
        let off = left.dot(vector(plane)) - f64::from(distance);
        found = found.or((off / wanted - 1.0).abs(), [t, scale.into(), 0.0]);
    });
    found
}

fn to_sphere(random: &mut Random, count: u32) -> Worst {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    sphere(&mut world, DVec3::ZERO, 1.0, white, None);
    let scene = compile(&world, false);
    let accel = Accel::new(&scene, &[0]);
    let mut tracer = Tracer::new(One, &accel);
    worst(count, || {
        let away = log_between(random, 1.01, 1e4);
        let origin = (random.direction() * away).as_vec3().as_dvec3();
        let goal = random.direction().cross(origin).normalize() * 0.999 * random.unit();
        let direction = (goal - origin).normalize().as_vec3().as_dvec3();
        let (t, _) = tracer.nearest(One, &Ray::new(One, lanes(origin), lanes(direction), NO_SURFACE), true);
        let point = origin + f64::from(t) * direction;
        let closest = origin - origin.dot(direction) / direction.length_squared() * direction;
        // The direction itself is rounded: far away that decides whether the sphere is hit.
        let off = if closest.length() > 0.9999 { 0.0 } else { (point.length() - 1.0).abs() / away };
        (if point.dot(origin) < 0.0 { f64::INFINITY } else { off }, [away, t.into(), 0.0])
    })
}

fn missed_boxes(random: &mut Random, count: u32) -> Worst {
    worst(count, || {
        let (a, b) = (random.cube(), random.cube());
        let (low, high) = (a.min(b).as_vec3(), a.max(b).as_vec3());
        let inside = low.as_dvec3() + (random.cube() + 1.0) / 2.0 * (high - low).as_dvec3();
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][random.below(3)];
        let (from, way) = match random.below(4) {
            // Along an axis, in the plane of a side.
            0 => {
                let corner = if random.below(2) == 0 { low } else { high }.as_dvec3();
                let goal = inside + (corner - inside) * at(axis.y, axis.z, axis.x);
                (goal - 3.0 * axis, axis)
            }
            1 => (inside - 3.0 * axis, axis),
            2 => (inside, random.direction()),
            _ => (random.direction() * 3.0, DVec3::ZERO),
        };
        let from = from.as_vec3();
        let way = if way == DVec3::ZERO { (inside - from.as_dvec3()).normalize() } else { way }.as_vec3();
        let of = |v: glam::Vec3| V3::splat(One, v.to_array());
        let (near, far) = slab(One, around(One, of(from)), inverse_direction(One, of(way)), of(low), of(high));
        let missed = !(near <= far && far >= 0.0);
        (f64::from(u32::from(missed)), from.as_dvec3().to_array())
    })
}

fn density(random: &mut Random, count: u32) -> Worst {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    polygon(&mut world, &[at(-1.0, -1.0, 0.0), at(1.0, -1.0, 0.0), at(1.0, 1.0, 0.0), at(-1.0, 1.0, 0.0)], white, None);
    point_light(&mut world, at(0.0, 0.0, 1.0), 1.0);
    let renderer = mapper(&world, Settings::default());
    let surfaces = &renderer.plan().photons.as_ref().expect("it maps light").surfaces;
    worst(count.div_ceil(200), || {
        let radius = random.between(0.05, 0.3) as f32;
        let middle = Place::new(&renderer, 0, at(random.between(-0.3, 0.3), random.between(-0.3, 0.3), 0.0), DVec3::Z);
        let mut photons = Photons::default();
        let (mut sum, [x, y, z]) = (0.0, middle.point.map(f64::from));
        for _ in 0..1 + random.below(400) {
            let [px, py] = [x, y].map(|middle| (middle + random.between(-0.4, 0.4)) as f32);
            let flux = log_between(random, 1e-3, 1e3) as f32;
            photons.places.push([px, py, middle.point[2], f32::from_bits(Tag::new(0, true).0)]);
            photons.flux.push([flux, flux, flux, f32::from_bits(0)]);
            sum +=
                if at(f64::from(px) - x, f64::from(py) - y, 0.0).length() < radius.into() { flux.into() } else { 0.0 };
        }
        let map = map_of(&photons, surfaces, radius, Quantity::Radiance);
        let found = irradiance((&map, 0, 99), surfaces, &middle)[0];
        let truth = sum / (PI * f64::from(radius) * f64::from(radius));
        (if truth == 0.0 { found.abs() } else { (found / truth - 1.0).abs() }, [x, y, z])
    })
}
