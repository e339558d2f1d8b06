//! What a ray meets: all primitives, one after the other.

use glam::DVec3;
use smalti_core::scene::world::{Material, Rgb, Sphere};
use smalti_core::scene::{Origin, World};

/// Hits nearer than this, in metres, are the surface that the ray leaves: scenes of the oracle are metres in size, and
/// f64 has six digits to spare.
const LEAST: f64 = 1e-9;

/// A half-line.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Along the ray, metres.
    pub distance: f64,
    /// The place.
    pub point: DVec3,
    /// Unit normal: right-hand on polygons and triangles, outward on spheres.
    pub normal: DVec3,
    /// Of the surface.
    pub material: Material,
    /// What its front emits.
    pub radiance: Rgb,
    /// Which primitive.
    pub origin: Origin,
}

impl Hit {
    /// Radiance that the surface sends back along the ray: only the front emits.
    pub fn emitted(&self, ray: &Ray) -> DVec3 {
        if self.normal.dot(ray.direction) < 0.0 { DVec3::from_array(self.radiance) } else { DVec3::ZERO }
    }

    /// The normal on the side that the ray came from.
    pub fn facing(&self, ray: &Ray) -> DVec3 {
        if self.normal.dot(ray.direction) < 0.0 { self.normal } else { -self.normal }
    }
}

/// The nearest hit.
pub fn nearest(world: &World, ray: &Ray) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    let mut offer =
        |distance: Option<f64>, origin, material: usize, radiance: Option<Rgb>, normal: &dyn Fn(DVec3) -> DVec3| {
            let Some(distance) = distance.filter(|t| best.is_none_or(|best| *t < best.distance)) else { return };
            let point = ray.origin + distance * ray.direction;
            let (material, radiance) = (world.materials[material], radiance.unwrap_or_default());
            best = Some(Hit { distance, point, normal: normal(point), material, radiance, origin });
        };
    for (index, polygon) in world.polygons.iter().enumerate() {
        let v = &polygon.vertices;
        for k in 1..v.len() - 1 {
            let corners = [v[0], v[k], v[k + 1]];
            let origin = Origin::Polygon(index as u32);
            offer(triangle(ray, corners), origin, polygon.material, polygon.radiance, &|_| normal(corners));
        }
    }
    for (index, sphere) in world.spheres.iter().enumerate() {
        let outward = |point: DVec3| (point - sphere.centre).normalize();
        let origin = Origin::Sphere(index as u32);
        offer(ball(ray, sphere), origin, sphere.material, sphere.radiance, &outward);
    }
    for (index, mesh) in world.meshes.iter().enumerate() {
        for (face, corners) in mesh.faces.iter().enumerate() {
            let corners = corners.map(|i| mesh.vertices[i as usize]);
            let origin = Origin::Mesh(index as u32, face as u32);
            offer(triangle(ray, corners), origin, mesh.material, mesh.radiance, &|_| normal(corners));
        }
    }
    best
}

/// Whether something stands between two points of surfaces.
pub fn blocked(world: &World, from: DVec3, to: DVec3) -> bool {
    let reach = to - from;
    let distance = reach.length();
    let ray = Ray { origin: from, direction: reach / distance };
    nearest(world, &ray).is_some_and(|hit| hit.distance < distance - LEAST)
}

/// The unit normal of a triangle.
pub fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize()
}

/// Distance to a triangle (Möller and Trumbore 1997).
fn triangle(ray: &Ray, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (e1, e2, from) = (b - a, c - a, ray.origin - a);
    let p = ray.direction.cross(e2);
    let q = from.cross(e1);
    let determinant = p.dot(e1);
    let (u, v) = (p.dot(from) / determinant, q.dot(ray.direction) / determinant);
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    Some(q.dot(e2) / determinant).filter(|t| inside && *t > LEAST)
}

/// Distance to a sphere: the first of the quadratic's roots that lies ahead.
fn ball(ray: &Ray, sphere: &Sphere) -> Option<f64> {
    let from = ray.origin - sphere.centre;
    let b = from.dot(ray.direction);
    let discriminant = b * b - (from.length_squared() - sphere.radius * sphere.radius);
    let root = (discriminant >= 0.0).then(|| discriminant.sqrt())?;
    [-b - root, -b + root].into_iter().find(|t| *t > LEAST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{at, grey, material, quad, sphere};

    #[test]
    fn the_nearest_of_two_is_hit() {
        let mut world = World::default();
        let white = material(&mut world, grey(1.0));
        quad(&mut world, at(0.0, 0.0, 5.0), (DVec3::X, DVec3::Y), white, Some(2.0));
        sphere(&mut world, at(0.0, 0.0, 3.0), 0.5, white, None);
        let ray = Ray { origin: DVec3::ZERO, direction: DVec3::Z };
        let first = nearest(&world, &ray).unwrap();
        assert!((first.distance - 2.5).abs() < 1e-12 && first.normal.distance(-DVec3::Z) < 1e-12);
        let inside = Ray { origin: first.point, direction: DVec3::Z };
        assert!((nearest(&world, &inside).unwrap().distance - 1.0).abs() < 1e-12);
        let beside = Ray { origin: at(0.9, 0.9, 0.0), direction: DVec3::Z };
        let back = nearest(&world, &beside).unwrap();
        assert_eq!((back.distance, back.emitted(&beside)), (5.0, DVec3::ZERO));
        assert!(nearest(&world, &Ray { origin: at(1.1, 0.0, 0.0), direction: DVec3::Z }).is_none());
        assert!(blocked(&world, at(0.0, 0.0, 0.0), at(0.0, 0.0, 4.0)));
        assert!(!blocked(&world, at(0.9, 0.0, 0.0), at(0.9, 0.0, 5.0)));
    }
}
