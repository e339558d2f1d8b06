//! The corners of a polygon: planar, convex, distinct, with an area. All tolerances are fractions of its extent.

use std::fmt;

use glam::DVec3;

use crate::document::Node;
use crate::error::{Fault, Result};

/// How far a corner may lie off the plane or inside of its neighbours' edge, in extents of the polygon.
const FLAT: f64 = 1e-6;
/// Area in squared extents that is rounding noise.
const NO_AREA: f64 = 1e-12;
/// Most corners: the test for convexity looks at every edge and every corner.
const MAX_CORNERS: usize = 1024;

/// What is wrong with corners; corners count from 1, as people count.
#[derive(Debug, PartialEq)]
enum Flaw {
    Repeats { corner: usize, of: usize },
    NoArea,
    OffPlane { corner: usize, distance: f64 },
    Reflex { corner: usize },
    Crosses,
}

/// Reads the corners at `node`: exactly `corners` of them, or at least three.
pub fn read(node: Node, corners: Option<usize>) -> Result<Vec<DVec3>> {
    let items = match corners {
        Some(corners) => node.exactly(corners, "points")?.collect::<Vec<_>>(),
        None => node.list()?.collect(),
    };
    if !(3..=MAX_CORNERS).contains(&items.len()) {
        let wrong = format!("must be a list of 3 to {MAX_CORNERS} points");
        return Err(node.fault(&wrong, format!("{} points", items.len())));
    }
    let points = items.iter().map(|item| item.vector()).collect::<Result<Vec<_>>>()?;
    match flaw(&points) {
        None => Ok(points),
        Some(flaw) => {
            let place = flaw.corner().map_or(node.span(), |corner| items[corner - 1].span());
            Err(Fault::at(place, format!("the polygon {flaw}"), flaw.label()).maybe_help(flaw.help()))
        }
    }
}

fn flaw(points: &[DVec3]) -> Option<Flaw> {
    let extent = points.iter().map(|p| (*p - points[0]).abs().max_element()).fold(0.0, f64::max);
    if let Some(flaw) = repeated(points) {
        return Some(flaw);
    }
    // About 1 from here on, so that nothing overflows; for sizes × 2^k the same bits.
    let points: Vec<DVec3> = points.iter().map(|p| (*p - points[0]) / extent).collect();
    let area = points[1..].windows(2).map(|pair| pair[0].cross(pair[1])).sum::<DVec3>();
    if area.length() < NO_AREA {
        return Some(Flaw::NoArea);
    }
    let normal = area.normalize();
    off_plane(&points, normal, extent).or_else(|| not_convex(&points, normal))
}

fn repeated(points: &[DVec3]) -> Option<Flaw> {
    (1..points.len()).find_map(|i| {
        let of = points[..i].iter().position(|p| *p == points[i])?;
        Some(Flaw::Repeats { corner: i + 1, of: of + 1 })
    })
}

/// The corner that is farthest off the mean plane.
fn off_plane(points: &[DVec3], normal: DVec3, extent: f64) -> Option<Flaw> {
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    let distances = points.iter().map(|p| normal.dot(*p - mean).abs());
    let (corner, distance) = distances.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (distance > FLAT).then_some(Flaw::OffPlane { corner: corner + 1, distance: distance * extent })
}

/// Convex: no corner is on the outer side of any edge.
fn not_convex(points: &[DVec3], normal: DVec3) -> Option<Flaw> {
    let count = points.len();
    let outside = |i: usize, p: DVec3| {
        let edge = (points[(i + 1) % count] - points[i]).normalize();
        normal.cross(edge).dot(p - points[i]) < -FLAT
    };
    if let Some(i) = (0..count).find(|&i| outside(i, points[(i + 2) % count])) {
        return Some(Flaw::Reflex { corner: (i + 1) % count + 1 });
    }
    (0..count).any(|i| points.iter().any(|&p| outside(i, p))).then_some(Flaw::Crosses)
}

impl Flaw {
    fn corner(&self) -> Option<usize> {
        match *self {
            Flaw::Repeats { corner, .. } | Flaw::OffPlane { corner, .. } | Flaw::Reflex { corner } => Some(corner),
            Flaw::NoArea | Flaw::Crosses => None,
        }
    }

    fn label(&self) -> String {
        match *self {
            Flaw::Repeats { of, .. } => format!("the same as corner {of}"),
            Flaw::OffPlane { distance, .. } => format!("{distance:.2e} off the plane of all corners"),
            Flaw::Reflex { .. } => "turns the other way".to_owned(),
            Flaw::NoArea | Flaw::Crosses => String::new(),
        }
    }

    fn help(&self) -> Option<String> {
        let help = match self {
            Flaw::NoArea => return None,
            Flaw::Repeats { .. } => "the last corner joins the first without being repeated",
            Flaw::OffPlane { .. } => "cut it into triangles (`[[triangle]]`), which are always planar",
            Flaw::Reflex { .. } | Flaw::Crosses => {
                "list the corners in order around it; cut what is not convex into parts"
            }
        };
        Some(help.to_owned())
    }
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Flaw::Repeats { .. } => "has the same corner twice",
            Flaw::NoArea => "has no area",
            Flaw::OffPlane { .. } => "is not planar",
            Flaw::Reflex { .. } | Flaw::Crosses => "is not convex",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(corners: &[(f64, f64)]) -> Vec<DVec3> {
        corners.iter().map(|&(x, y)| DVec3::new(x, y, 2.0)).collect()
    }

    /// The flaw at any size, far from the origin and mirrored must be the same.
    fn everywhere(points: &[DVec3]) -> Option<Flaw> {
        let found = flaw(points);
        for scale in [2f64.recip(), 1024.0, f64::from_bits(0x0010_0000_0000_0000 + (983 << 52))] {
            let scaled: Vec<DVec3> = points.iter().map(|p| *p * scale).collect();
            let kind = |flaw: &Option<Flaw>| flaw.as_ref().map(std::mem::discriminant);
            assert_eq!(kind(&flaw(&scaled)), kind(&found), "at scale {scale:e}");
        }
        let backwards: Vec<DVec3> = points.iter().rev().copied().collect();
        assert_eq!(flaw(&backwards).is_some(), found.is_some());
        found
    }

    #[test]
    fn convex_polygons_pass() {
        let hexagon = [(-3.0, 0.0), (0.0, -6.0), (10.0, -6.0), (13.0, 0.0), (10.0, 6.0), (0.0, 6.0)];
        assert_eq!(everywhere(&flat(&hexagon)), None);
        assert_eq!(everywhere(&flat(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0)])), None, "a corner on an edge");
        assert_eq!(everywhere(&flat(&[(0.0, 0.0), (1.0, 0.0), (0.5, 1e-6)])), None, "a sliver");
    }

    #[test]
    fn flaws_are_told_apart() {
        let dart = flat(&[(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (0.5, 1.0)]);
        assert_eq!(everywhere(&dart), Some(Flaw::Reflex { corner: 4 }));
        let star: Vec<(f64, f64)> =
            [0, 2, 4, 1, 3].iter().map(|k| libm::sincos(f64::from(*k) * 1.256_637_061_435_917_3)).collect();
        assert_eq!(everywhere(&flat(&star)), Some(Flaw::Crosses));
        assert_eq!(everywhere(&flat(&[(0.0, 0.0), (0.1, 0.1), (0.3, 0.3)])), Some(Flaw::NoArea));
        let closed = flat(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)]);
        assert_eq!(everywhere(&closed), Some(Flaw::Repeats { corner: 4, of: 1 }));
    }

    #[test]
    fn flatness_is_a_fraction_of_the_size() {
        let lifted = |height: f64| {
            let mut quad = flat(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
            quad[2].z += height;
            everywhere(&quad)
        };
        assert_eq!(lifted(2e-6), None);
        assert!(matches!(lifted(1e-5), Some(Flaw::OffPlane { .. })));
    }
}
