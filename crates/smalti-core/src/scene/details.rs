//! Where a scene has its details: the place about which coordinates should be finest.
//!
//! Each primitive counts by the inverse of its size, and the median of their places is taken axis by axis: among all
//! places it has the least sum of distances to the primitives, each in units of the primitive's own size. In a room whose
//! things are all about alike that is somewhere among them; a marble in a hall draws it to itself.

use glam::DVec3;

use super::world::World;

/// Triangles of a mesh that are looked at, evenly among all of them; each stands for those that are left out.
const MOST_TRIANGLES: usize = 4096;

/// Where something lies along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Its lower end.
    pub low: f64,
    /// Its extent.
    pub extent: f64,
}

/// A primitive along an axis, and what it counts for.
struct Detail {
    place: Place,
    weight: f64,
}

/// What lies in the middle of the details of a world along `axis`; `corner` is the lower corner of its box. A world with
/// nothing that has a size is a place without extent at its corner.
pub fn middle(world: &World, corner: DVec3, axis: usize) -> Place {
    let mut details = details(world, axis);
    // From the corner of the box, so that translations which are exact in f64 change nothing.
    let centre = |detail: &Detail| (detail.place.low - corner[axis]) + detail.place.extent / 2.0;
    details.sort_by(|a, b| centre(a).total_cmp(&centre(b)));
    let half = details.iter().map(|detail| detail.weight).sum::<f64>() / 2.0;
    let mut so_far = 0.0;
    let reached = details.iter().find(|detail| {
        so_far += detail.weight;
        so_far >= half
    });
    reached.map_or(Place { low: corner[axis], extent: 0.0 }, |detail| detail.place)
}

/// The primitives of a world along an axis, without those that have no size.
fn details(world: &World, axis: usize) -> Vec<Detail> {
    let polygons = world.polygons.iter().map(|polygon| detail(&polygon.vertices, axis, 1.0));
    let spheres = world.spheres.iter().map(|sphere| {
        // A sphere's ends are rounded, its centre is not.
        let place = Place { low: sphere.centre[axis], extent: 0.0 };
        Some(Detail { place, weight: 0.5 / sphere.radius })
    });
    let triangles = world.meshes.iter().flat_map(|mesh| {
        let step = mesh.faces.len() / MOST_TRIANGLES + 1;
        mesh.faces.iter().step_by(step).map(move |face| {
            let corners = face.map(|corner| mesh.vertices[corner as usize]);
            detail(&corners, axis, step as f64)
        })
    });
    polygons.chain(spheres).chain(triangles).flatten().collect()
}

/// What lies between these corners, and stands for `count` of its kind.
fn detail(corners: &[DVec3], axis: usize, count: f64) -> Option<Detail> {
    let (low, high) = corners.iter().fold((corners[0], corners[0]), |(low, high), at| (low.min(*at), high.max(*at)));
    let size = (high - low).max_element();
    let place = Place { low: low[axis], extent: high[axis] - low[axis] };
    (size > 0.0).then(|| Detail { place, weight: count / size })
}
