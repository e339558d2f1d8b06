//! Dielectrics that are open or inside out, and lamps that shine inwards.

use std::collections::HashSet;

use glam::DVec3;

use super::bodies::{Body, bodies};
use super::{Finding, Surface};
use crate::scene::double::{Hit, Ray, nearest};
use crate::scene::world::{Mesh, World};
use crate::scene::{Frame, Origin, newell};

/// Rays followed off a body, at most from as many of its faces.
const RAYS: usize = 48;

/// Tests of a ray against a primitive, for all bodies; what is left is judged by its edges alone.
const TESTS: usize = 200_000_000;

/// An edge within so much of the frame of an opaque face ends at it.
const SEALED: f64 = 1e-5;

/// The findings, of dielectrics first.
pub fn examine(world: &World, frame: &Frame) -> Vec<Finding> {
    let mut tests = TESTS;
    let clear = |material: usize| world.materials[material].is_dielectric();
    let mut found: Vec<Finding> = Vec::new();
    for body in bodies(world, frame, |material, _| clear(material)) {
        if !body.free.is_empty() || body.volume < 0.0 {
            dielectric(world, frame, &body, &mut tests).into_iter().for_each(|finding| enter(&mut found, finding));
        }
    }
    for body in bodies(world, frame, |material, emits| emits && !clear(material)) {
        if body.free.is_empty() && body.volume < 0.0 && is_empty(world, &body) {
            enter(&mut found, Finding::ShinesInwards { surface: surface(&body) });
        }
    }
    found
}

/// Adds a finding, to one of its kind and material if there is one.
fn enter(found: &mut Vec<Finding>, new: Finding) {
    for known in found.iter_mut() {
        match (known, &new) {
            (Finding::Open { surface, material, edges }, Finding::Open { material: of, edges: more, .. })
                if material == of =>
            {
                surface.count += 1;
                *edges += more;
                return;
            }
            (Finding::InsideOut { surface, material }, Finding::InsideOut { material: of, .. }) if material == of => {
                surface.count += 1;
                return;
            }
            (Finding::ShinesInwards { surface }, Finding::ShinesInwards { .. }) => {
                surface.count += 1;
                return;
            }
            _ => {}
        }
    }
    found.push(new);
}

fn surface(body: &Body) -> Surface {
    Surface { face: body.faces[0], faces: body.faces.len(), count: 1 }
}

/// What is wrong with a dielectric that is open or wound inwards.
fn dielectric(world: &World, frame: &Frame, body: &Body, tests: &mut usize) -> Option<Finding> {
    let (surface, material) = (surface(body), world.skin(body.faces[0]).0);
    let primitives =
        world.polygons.len() + world.spheres.len() + world.meshes.iter().map(|m| m.faces.len()).sum::<usize>();
    let rays = RAYS.min(*tests / primitives.max(1));
    // No more rays are followed than it takes.
    let mut behind = inward(world, body, rays).map(|ray| {
        *tests -= primitives;
        nearest(world, &ray, 0.0)
    });
    if body.free.is_empty() {
        // The inner wall of a hollow thing: behind it is the glass, which ends at its outer wall.
        let is_leaving = |hit: Hit| !hit.outside && world.materials[world.skin(hit.origin).0].is_dielectric();
        let is_inner = rays == 0 || behind.any(|hit| hit.is_some_and(is_leaving));
        return (!is_inner).then_some(Finding::InsideOut { surface, material });
    }
    // Water ends at the walls of its pool; a window in a wall does as well, but there is no end behind it.
    let meets = rays > 0 && behind.all(|hit| hit.is_some());
    let ends = meets && sealed(world, frame, &body.free, primitives, tests);
    (!ends).then_some(Finding::Open { surface, material, edges: body.free.len() })
}

/// Rays from the middle of some faces to behind them.
fn inward(world: &World, body: &Body, count: usize) -> impl Iterator<Item = Ray> {
    (0..count).map(move |k| {
        let corners = world.corners(body.faces[k * body.faces.len() / count]);
        let normal = newell(&corners).normalize_or_zero();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let size = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
        let (right, up) = normal.any_orthonormal_pair();
        // Along a spiral over the half of all directions.
        let (turn, tilt) = (2.399_963 * k as f64, 0.98 * (k as f64 + 0.5) / count as f64);
        let across = libm::cos(turn) * right + libm::sin(turn) * up;
        let direction = (across * tilt - normal * (1.0 - tilt * tilt).sqrt()).normalize();
        Ray { origin: middle - 1e-9 * size * normal, direction }
    })
}

/// Whether edges lie on opaque faces or within what these enclose, all along; some of them stand for all.
fn sealed(world: &World, frame: &Frame, edges: &[[DVec3; 2]], primitives: usize, tests: &mut usize) -> bool {
    let some = edges.iter().step_by(edges.len().div_ceil(RAYS));
    let mut points: Vec<DVec3> = some.flat_map(|[a, b]| [0.02, 0.5, 0.98].map(|share| a.lerp(*b, share))).collect();
    let opaque = |material: usize| !world.materials[material].is_dielectric();
    let mut seal = |corners: &mut dyn Iterator<Item = DVec3>| {
        let corners: Vec<DVec3> = corners.map(|corner| frame.point(corner)).collect();
        let normal = newell(&corners).normalize_or_zero();
        points.retain(|point| !is_on((&corners, normal), *point));
    };
    for polygon in world.polygons.iter().filter(|polygon| opaque(polygon.material)) {
        seal(&mut polygon.vertices.iter().copied());
    }
    for mesh in world.meshes.iter().filter(|mesh| opaque(mesh.material)) {
        mesh.faces.iter().for_each(|face| seal(&mut face.iter().map(|corner| mesh.vertices[*corner as usize])));
    }
    let within = points.len() * primitives <= *tests && points.iter().all(|point| is_enclosed(world, frame, *point));
    *tests -= if within { points.len() * primitives } else { 0 };
    within
}

/// Whether a point of the frame lies within something opaque: a wall that is a box.
fn is_enclosed(world: &World, frame: &Frame, point: DVec3) -> bool {
    let origin = DVec3::from_array(frame.to_world(point.as_vec3().to_array()));
    let ray = Ray { origin, direction: DVec3::new(0.36, 0.48, 0.8) };
    let is_opaque = |hit: &Hit| !world.materials[world.skin(hit.origin).0].is_dielectric();
    nearest(world, &ray, 0.0).is_some_and(|hit| !hit.outside && is_opaque(&hit))
}

fn is_on((corners, normal): (&[DVec3], DVec3), point: DVec3) -> bool {
    let beside = |(a, b): (&DVec3, &DVec3)| normal.cross((*b - *a).normalize_or_zero()).dot(point - *a) >= -SEALED;
    normal.dot(point - corners[0]).abs() <= SEALED && corners.iter().zip(corners.iter().cycle().skip(1)).all(beside)
}

/// Whether neither a camera nor anything else is within the box of a lamp.
fn is_empty(world: &World, body: &Body) -> bool {
    let own: HashSet<Origin> = body.faces.iter().copied().collect();
    let corners = body.faces.iter().flat_map(|face| world.corners(*face));
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = corners.fold(none, |(low, high), corner| (low.min(corner), high.max(corner)));
    let within = |point: DVec3| point.cmpgt(low).all() && point.cmplt(high).all();
    let polygons = (0..world.polygons.len() as u32).map(Origin::Polygon);
    let triangles =
        |(mesh, index): (&Mesh, u32)| (0..mesh.faces.len() as u32).map(move |face| Origin::Mesh(index, face));
    let faces = polygons.chain(world.meshes.iter().zip(0..).flat_map(triangles));
    let of_others = faces.filter(|face| !own.contains(face)).flat_map(|face| world.corners(face));
    let of_spheres = world.spheres.iter().map(|ball| ball.centre);
    let eyes = world.cameras.iter().map(|camera| camera.eye);
    !of_others.chain(of_spheres).chain(eyes).any(within)
}
