//! What is small for where it lies: something else is so large, or so far away, that coordinates hardly hold it.

use glam::DVec3;

use super::Finding;
use crate::scene::contact::STEP;
use crate::scene::world::World;
use crate::scene::{Frame, Origin};

/// Fewer steps of its coordinates than this across, and a thing is drawn wrong.
pub const STEPS: f64 = 200.0;

/// Polygons, meshes and spheres that are too small; one finding for all, with the smallest.
pub fn examine(world: &World, frame: &Frame) -> Option<Finding> {
    let things = things(world);
    let steps = |(_, low, high): &(Origin, DVec3, DVec3)| {
        let reach = frame.point(*low).abs().max(frame.point(*high).abs()).max_element();
        (*high - *low).max_element() * frame.scale / (STEP * reach)
    };
    let small: Vec<f64> = things.iter().map(steps).filter(|steps| *steps > 0.0 && *steps < STEPS).collect();
    let (surface, low, high) =
        *things.iter().filter(|thing| steps(thing) > 0.0).min_by(|a, b| steps(a).total_cmp(&steps(b)))?;
    let extent = |(_, low, high): &(Origin, DVec3, DVec3)| (*high - *low).max_element();
    let scene = world.bounds().map_or(0.0, |(low, high)| (high - low).max_element());
    let largest = things.iter().max_by(|a, b| extent(a).total_cmp(&extent(b)))?.0;
    let steps = steps(&(surface, low, high));
    let extent = (high - low).max_element();
    (!small.is_empty()).then_some(Finding::Coarse { surface, extent, steps, largest, scene, things: small.len() })
}

/// Every thing with its box; a mesh without faces is nothing.
pub fn things(world: &World) -> Vec<(Origin, DVec3, DVec3)> {
    let around = |points: &[DVec3]| {
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        points.iter().fold(none, |(low, high), point| (low.min(*point), high.max(*point)))
    };
    let polygons = world.polygons.iter().enumerate().map(|(index, polygon)| {
        let (low, high) = around(&polygon.vertices);
        (Origin::Polygon(index as u32), low, high)
    });
    let meshes = world.meshes.iter().enumerate().filter(|(_, mesh)| !mesh.faces.is_empty()).map(|(index, mesh)| {
        let (low, high) = around(&mesh.vertices);
        (Origin::Mesh(index as u32, 0), low, high)
    });
    let spheres = world
        .spheres
        .iter()
        .enumerate()
        .map(|(index, ball)| (Origin::Sphere(index as u32), ball.centre - ball.radius, ball.centre + ball.radius));
    polygons.chain(meshes).chain(spheres).filter(|thing| thing.1.is_finite()).collect()
}
