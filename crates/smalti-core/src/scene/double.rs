//! What a ray hits, in f64 and on the scene as it was written: every primitive tested, no frame, no tree, no lanes.

use glam::DVec3;

use super::{Origin, World, newell};

/// A ray in the user's units.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts, metres.
    pub origin: DVec3,
    /// Where it goes, unit length.
    pub direction: DVec3,
}

/// A hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// What was hit.
    pub origin: Origin,
    /// How far it is, metres.
    pub distance: f64,
    /// The cosine between ray and normal, at least 0.
    pub cosine: f64,
    /// Whether the ray comes from the side of the normal.
    pub outside: bool,
}

/// The nearest hit farther away than `from`; the first of equals.
pub fn nearest(world: &World, ray: &Ray, from: f64) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    let mut meet = |hit: Option<Hit>| {
        if let Some(hit) = hit.filter(|hit| best.is_none_or(|best| hit.distance < best.distance)) {
            best = Some(hit);
        }
    };
    for (index, polygon) in world.polygons.iter().enumerate() {
        meet(face(&polygon.vertices, ray, from, Origin::Polygon(index as u32)));
    }
    for (index, mesh) in world.meshes.iter().enumerate() {
        for (number, corners) in mesh.faces.iter().enumerate() {
            let corners = corners.map(|corner| mesh.vertices[corner as usize]);
            meet(face(&corners, ray, from, Origin::Mesh(index as u32, number as u32)));
        }
    }
    for (index, ball) in world.spheres.iter().enumerate() {
        meet(sphere(ball.centre, ball.radius, ray, from, Origin::Sphere(index as u32)));
    }
    best
}

/// A convex planar face: its plane, and whether the point lies to the left of every edge.
fn face(corners: &[DVec3], ray: &Ray, from: f64, origin: Origin) -> Option<Hit> {
    let normal = newell(corners).normalize_or_zero();
    let slope = normal.dot(ray.direction);
    if slope == 0.0 {
        return None;
    }
    let distance = normal.dot(corners[0] - ray.origin) / slope;
    if !(distance > from && distance < f64::INFINITY) {
        return None;
    }
    let point = ray.origin + distance * ray.direction;
    let next = corners.iter().cycle().skip(1);
    let is_left = |(a, b): (&DVec3, &DVec3)| (*b - *a).cross(point - *a).dot(normal) >= 0.0;
    corners.iter().zip(next).all(is_left).then_some(Hit { origin, distance, cosine: slope.abs(), outside: slope < 0.0 })
}

fn sphere(centre: DVec3, radius: f64, ray: &Ray, from: f64, origin: Origin) -> Option<Hit> {
    let to = centre - ray.origin;
    let middle = to.dot(ray.direction);
    let beside = (to - middle * ray.direction).length();
    let half = ((radius - beside) * (radius + beside)).max(0.0).sqrt();
    if beside > radius {
        return None;
    }
    let distance = [middle - half, middle + half].into_iter().find(|distance| *distance > from)?;
    Some(Hit { origin, distance, cosine: half / radius, outside: distance < middle })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::world::{Polygon, Sphere};

    #[test]
    fn known_hits() {
        let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let polygon = Polygon { vertices: square.to_vec(), material: 0, radiance: None };
        let ball = Sphere { centre: DVec3::Z * 5.0, radius: 2.0, material: 0, radiance: None };
        let world = World { polygons: vec![polygon], spheres: vec![ball], ..World::default() };
        let hit = |x: f64, z: f64, from: f64| {
            nearest(&world, &Ray { origin: DVec3::new(x, 0.0, z), direction: DVec3::Z }, from)
                .map(|hit| (hit.origin, hit.distance))
        };
        assert_eq!(hit(0.0, -1.0, 0.0), Some((Origin::Polygon(0), 1.0)));
        assert_eq!(hit(0.0, -1.0, 1.5), Some((Origin::Sphere(0), 4.0)));
        assert_eq!(hit(0.0, 4.0, 0.0), Some((Origin::Sphere(0), 3.0)));
        assert_eq!(hit(1.5, -1.0, 0.0).map(|hit| hit.0), Some(Origin::Sphere(0)));
        assert_eq!(hit(2.5, -1.0, 0.0), None);
        assert_eq!(hit(0.0, 7.5, 0.0), None);
    }
}
