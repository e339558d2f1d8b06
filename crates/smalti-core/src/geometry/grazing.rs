//! Rays that graze the plane of a face: their distance is ill-conditioned, and near the plane not even its sign is known
//! in f32.

use glam::DVec3;

use super::lone::Unpacked;
use super::polygon::{around, inverse_direction, slab};
use super::{Lone, Ray};
use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;

/// Bound on the error of a height over a plane, relative to the origin's largest coordinate or to the frame: the rounding
/// of the product with the normal, of the normal, of the plane's offset and of the corners, 2⁻²⁴ each, summed up.
const ROUNDING: f32 = 12.0 / 16_777_216.0;

/// The distance `t` of the plane n·x = d made good in the lanes `lanes`, which graze a face with these corners and bounds.
/// ∞ where the ray passes beside the face's box, or runs along the plane.
///
/// The hit cannot lie outside the box. And where the ray starts as near to the plane as rounding goes, the side is asked
/// for in f64: a ray that leaves a thin solid at a sharp edge has the other face just behind it, not before it.
#[inline(always)]
pub fn distance<L: Lanes, C: Iterator<Item = [f32; 3]>>(
    l: L,
    ray: &Ray<L>,
    (t, lanes): (L::F, L::M),
    (normal, offset): (V3<L>, L::F),
    [low, high]: [V3<L>; 2],
    corners: impl Fn(usize) -> C,
) -> L::F {
    let height = l.abs(offset - normal.dot(l, ray.origin));
    let unsure = lanes & l.lt(height, l.max(ray.origin.max_abs(l), l.f(1.0)) * l.f(ROUNDING));
    let mut t = t;
    if l.any(unsure) && !mutant!("side_of_a_plane_in_f32") {
        let rays = Unpacked::new(l, ray);
        let mut distances = [0.0; 16];
        l.store(t, &mut distances);
        let mut left = l.bitmask(unsure);
        while left != 0 {
            let lane = left.trailing_zeros() as usize % 16;
            distances[lane] = exact(&rays.lone(lane), corners(lane));
            left &= left - 1;
        }
        t = l.load(&distances);
    }
    clamp_to_box(l, ray, t, low, high)
}

/// `t` clamped to where the ray is inside the box: a grazing ray's distance is ill-conditioned, but the hit cannot lie
/// outside the face's box; ∞ where the ray passes beside the box, or runs along the plane. The same arithmetic as the
/// tree's box test, so the tree never culls a hit of the list.
#[inline(always)]
fn clamp_to_box<L: Lanes>(l: L, ray: &Ray<L>, t: L::F, low: V3<L>, high: V3<L>) -> L::F {
    let inverse = inverse_direction(l, ray.direction);
    let (near, far) = slab(l, around(l, ray.origin), inverse, low, high);
    let never = l.f(f32::INFINITY);
    l.select(l.le(near, far) & l.lt(l.abs(t), never), l.max(l.min(t, far), near), never)
}

/// Distance to the plane of these corners (Newell's, where they are more than three), in f64.
#[cold]
fn exact(ray: &Lone, mut corners: impl Iterator<Item = [f32; 3]>) -> f32 {
    let wide = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let origin = wide(ray.origin);
    let first = corners.next().map_or(DVec3::ZERO, wide) - origin;
    let (mut area, mut middle, mut count) = (DVec3::ZERO, first, 1.0);
    let mut before = first;
    for corner in corners {
        let corner = wide(corner) - origin;
        area += (before - first).cross(corner - first);
        middle += corner;
        count += 1.0;
        before = corner;
    }
    (area.dot(middle) / count / area.dot(wide(ray.direction))) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::One;

    const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn a_plane_is_before_or_behind_however_near() {
        for height in [1e-9, -1e-9, 1e-30, -1e-30f32] {
            let ray = Lone { origin: [0.25, 0.25, height], direction: [0.6, 0.8, -1e-6], leaves: 0 };
            let t = exact(&ray, CORNERS.into_iter());
            assert!((t - height * 1e6).abs() <= height.abs(), "{height}: {t}");
        }
    }

    /// A ray that left a tetrahedron a hundredth as thick as wide at one of its edges, and the face on the edge's other
    /// side: 3e-3 behind it, as its corners stand. Of the plane, with its offset rounded down or up by one step, f32 does
    /// not know the side.
    #[test]
    fn a_face_behind_a_ray_is_not_before_it() {
        let corners = [
            [-0.523_275_73, -0.079_492_25, -0.142_985_95],
            [-0.521_954, -0.085_085_48, -0.142_975_52],
            [-0.520_609_4, -0.080_310_44, -0.142_976_37],
        ];
        let [a, b, c] = corners.map(|corner| V3::<One>::splat(One, corner));
        let normal = (b - a).cross(One, c - a).normalised(One);
        let ray = Lone {
            origin: [-0.523_234_5, -0.082_878_38, -0.142_982_11],
            direction: [-0.625_966_6, -0.779_848_93, -0.001_184_430_1],
            leaves: 0,
        }
        .ray();
        let bounds = [-0.1f32, 0.1].map(|side| V3::new(a.x + side, a.y + side, a.z + side));
        for steps in [-1.0, 0.0, 1.0] {
            let offset = normal.dot(One, a) + steps / 16_777_216.0;
            let (t, grazing) = crate::geometry::polygon::distance(One, &ray, normal, offset);
            assert!(grazing);
            let made_good = distance(One, &ray, (t, true), (normal, offset), bounds, |_| corners.into_iter());
            assert!((made_good + 3.33e-3).abs() < 1e-4, "{steps}: {t} made {made_good}");
        }
    }

    #[test]
    fn what_runs_along_a_plane_meets_it_nowhere() {
        for height in [0.0, 1e-9] {
            let ray = Lone { origin: [0.25, 0.25, height], direction: [0.6, 0.8, 0.0], leaves: 0 };
            assert!(!exact(&ray, CORNERS.into_iter()).is_finite());
        }
    }
}
