//! The plane of a face: that of Newell's normal, the sum of the cross products of a fan's arms.

use glam::DVec3;
use robust::Coord;

/// Whether the fan from the first corner covers a face of `count` corners once: all of its triangles face the way of the
/// face, and together they turn by less than a full circle about that corner.
pub fn fan_covers(count: usize, corner: impl Fn(usize) -> DVec3) -> bool {
    let unit = unit((0..count).map(&corner));
    let first = corner(0) * unit;
    let arm = |i: usize| corner(i) * unit - first;
    let normal = (1..count - 1).map(|i| arm(i).cross(arm(i + 1))).sum::<DVec3>();
    let turns = |a: DVec3, b: DVec3| normal.dot(a.cross(b));
    let mut past_half = false;
    (1..count - 1).all(|i| {
        let turned = turns(arm(1), arm(i + 1));
        let full = past_half && turned >= 0.0;
        past_half |= turned < 0.0;
        !full && turns(arm(i), arm(i + 1)) > 0.0
    })
}

/// The corners seen along the axis that is nearest to the normal, counter-clockwise. Nothing is rounded: one coordinate
/// is left out, and a power of two brings the others to about 1, so that nothing overflows. `None` without a normal.
pub fn flat(corners: &[DVec3]) -> Option<Vec<Coord<f64>>> {
    let unit = unit(corners.iter().copied());
    let [x, y, z] = newell(corners, unit).to_array();
    let (width, height) = match [x.abs(), y.abs(), z.abs()] {
        [0.0, 0.0, 0.0] => return None,
        [a, b, c] if c >= a && c >= b => (0, 1),
        [a, b, _] if a >= b => (1, 2),
        _ => (2, 0),
    };
    let ahead = [x, y, z][3 - width - height] > 0.0;
    let (width, height) = if ahead { (width, height) } else { (height, width) };
    Some(corners.iter().map(|corner| Coord { x: corner[width] * unit, y: corner[height] * unit }).collect())
}

/// Newell's normal of corners × `unit`: its length is twice the area.
fn newell(corners: &[DVec3], unit: f64) -> DVec3 {
    let first = corners[0] * unit;
    let arm = |corner: DVec3| corner * unit - first;
    corners[1..].windows(2).map(|pair| arm(pair[0]).cross(arm(pair[1]))).sum()
}

/// The power of two that brings the largest coordinate to at least 1 and below 2.
fn unit(corners: impl Iterator<Item = DVec3>) -> f64 {
    let largest = corners.map(|corner| corner.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    libm::scalbn(1.0, -libm::ilogb(largest))
}
