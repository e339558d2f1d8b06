//! A face of any shape becomes triangles: with its area, and wound as it is.
//!
//! A face that the fan from its first corner covers, as every convex one, keeps that fan. All others lose their ears one
//! by one (Meisters 1975, "Polygons have ears"), on corners that were projected without rounding, by predicates that are
//! exact (Shewchuk 1997, crate `robust`). So neither the unit of length (times a power of two) nor the corner that comes
//! first decides whether a face is cut rightly.

mod crossing;
mod ears;
mod grid;
mod plane;
mod ring;

use glam::DVec3;

pub use plane::fan_covers;

/// A face in triangles.
#[derive(Debug, PartialEq)]
pub struct Cut {
    /// Indices of its corners, in the order of the face.
    pub triangles: Vec<[usize; 3]>,
    /// Whether the face crosses itself: its triangles may overlap then.
    pub crosses: bool,
}

/// Cuts a face with three corners or more, which no fan covers.
pub fn cut(corners: &[DVec3]) -> Cut {
    match plane::flat(corners) {
        Some(flat) => {
            let (triangles, forced) = ears::clip(&flat);
            Cut { triangles, crosses: forced || crossing::crosses(&flat) }
        }
        None => without_normal(corners),
    }
}

/// The fan of a face whose signed area is zero: a line, or a face whose parts cancel, as those of a bow tie do.
fn without_normal(corners: &[DVec3]) -> Cut {
    let triangles: Vec<_> = (1..corners.len() - 1).map(|i| [0, i, i + 1]).collect();
    let arm = |i: usize| corners[i] - corners[0];
    let crosses = triangles.iter().any(|&[_, b, c]| arm(b).cross(arm(c)) != DVec3::ZERO);
    Cut { triangles, crosses }
}

#[cfg(test)]
mod tests;
