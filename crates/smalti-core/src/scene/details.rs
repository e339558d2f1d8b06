//! Where a scene has its details: the place about which coordinates should be finest.
//!
//! Each primitive counts by the inverse of its size, and the median of their places is taken axis by axis: among all
//! places it has the least sum of distances to the primitives, each in units of the primitive's own size. In a room whose
//! things are all about alike that is somewhere among them; a marble in a hall draws it to itself.

use glam::DVec3;

use super::world::World;

/// Triangles of a mesh that are looked at, evenly among all of them; each stands for those that are left out.
const MOST_TRIANGLES: usize = 4096;

/// The box of a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Its lower corner.
    pub low: DVec3,
    /// Its extent.
    pub extent: DVec3,
}

/// A primitive, and its weight in the median.
struct Detail {
    place: Place,
    weight: f64,
}

/// The middle of the details of a world, axis by axis that of one of its primitives; `corner` is the lower corner of the
/// world's box. A world with nothing that has a size is a place without extent at its corner.
pub fn middle(world: &World, corner: DVec3) -> Place {
    let details = details(world);
    let half = details.iter().map(|detail| detail.weight).sum::<f64>() / 2.0;
    let mut middle = Place { low: corner, extent: DVec3::ZERO };
    for axis in 0..3 {
        // From the corner of the box, so that translations which are exact in f64 change nothing.
        let centre = |Detail { place, .. }: &Detail| (place.low[axis] - corner[axis]) + place.extent[axis] / 2.0;
        let mut in_order: Vec<&Detail> = details.iter().collect();
        in_order.sort_by(|a, b| centre(a).total_cmp(&centre(b)));
        let mut so_far = 0.0;
        let reached = in_order.iter().find(|detail| {
            so_far += detail.weight;
            so_far >= half
        });
        if let Some(Detail { place, .. }) = reached {
            (middle.low[axis], middle.extent[axis]) = (place.low[axis], place.extent[axis]);
        }
    }
    middle
}

/// The primitives of a world, without those that have no size.
fn details(world: &World) -> Vec<Detail> {
    let polygons = world.polygons.iter().map(|polygon| detail(&polygon.vertices, 1.0));
    let spheres = world.spheres.iter().map(|sphere| {
        // A sphere's ends are rounded, its centre is not.
        let place = Place { low: sphere.centre, extent: DVec3::ZERO };
        Some(Detail { place, weight: 0.5 / sphere.radius })
    });
    let triangles = world.meshes.iter().flat_map(|mesh| {
        let step = mesh.faces.len() / MOST_TRIANGLES + 1;
        mesh.faces.iter().step_by(step).map(move |face| {
            let corners = face.map(|corner| mesh.vertices[corner as usize]);
            detail(&corners, step as f64)
        })
    });
    polygons.chain(spheres).chain(triangles).flatten().collect()
}

/// What lies between these corners, and stands for `count` of its kind.
fn detail(corners: &[DVec3], count: f64) -> Option<Detail> {
    let (low, high) = corners.iter().fold((corners[0], corners[0]), |(low, high), at| (low.min(*at), high.max(*at)));
    let extent = high - low;
    let size = extent.max_element();
    (size > 0.0).then(|| Detail { place: Place { low, extent }, weight: count / size })
}
