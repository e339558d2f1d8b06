//! A ray as the intersection kernels want it.

use crate::lanes::{Lanes, V3};

/// A ray and the projection along it.
///
/// Corners are projected to the plane across the ray by a shear along the axis in which the direction is largest
/// (Woop, Benthin and Wald, JCGT 2(1), 2013). Every edge test works on these projected corners, so two faces that share
/// an edge agree about it to the last bit and no ray slips between them.
#[derive(Clone, Copy)]
pub struct Ray<L: Lanes> {
    /// Where it starts.
    pub origin: V3<L>,
    /// Where it goes; unit length, or the whole way to a light point.
    pub direction: V3<L>,
    /// The surface it leaves, which it cannot hit again when that is a plane.
    pub leaves: L::U,
    /// Rows of the shear: the projected coordinates of a vector v are (across.0 · v, across.1 · v).
    across: (V3<L>, V3<L>),
    /// Largest magnitude of a component of the direction.
    pub major: L::F,
}

impl<L: Lanes> Ray<L> {
    /// A ray from `origin` along `direction`, leaving surface `leaves`.
    #[inline(always)]
    pub fn new(l: L, origin: V3<L>, direction: V3<L>, leaves: L::U) -> Self {
        let d = direction;
        let (ax, ay, az) = (l.abs(d.x), l.abs(d.y), l.abs(d.z));
        let x_major = l.le(ay, ax) & l.le(az, ax);
        let y_major = !x_major & l.le(az, ay);
        let zero = l.f(0.0);
        let along = l.select(x_major, d.x, l.select(y_major, d.y, d.z));
        // With z major: (dz, 0, -dx) and (0, dz, -dy); the others by permutation (y, z, x) and (z, x, y). Dividing by dz
        // would scale both coordinates alike, which no sign of an edge function feels.
        let (sx, sy, sz) = (-d.x, -d.y, -d.z);
        let first = V3::new(
            l.select(x_major, sy, l.select(y_major, zero, along)),
            l.select(x_major, along, l.select(y_major, sz, zero)),
            l.select(x_major, zero, l.select(y_major, along, sx)),
        );
        let second = V3::new(
            l.select(x_major, sz, l.select(y_major, along, zero)),
            l.select(x_major, zero, l.select(y_major, sx, along)),
            l.select(x_major, along, l.select(y_major, zero, sy)),
        );
        Self { origin, direction, leaves, across: (first, second), major: l.abs(along) }
    }

    /// A corner across the ray, relative to it.
    #[inline(always)]
    pub fn project(&self, l: L, corner: V3<L>) -> (L::F, L::F) {
        let v = corner - self.origin;
        (self.across.0.dot(l, v), self.across.1.dot(l, v))
    }
}

/// Edge function of the projected edge a → b: exactly the negative of b → a, and never of the wrong sign (two rounded
/// products compared; 0 at worst), because no fused operation is used.
#[inline(always)]
pub fn edge<F: Copy + core::ops::Mul<Output = F> + core::ops::Sub<Output = F>>(a: (F, F), b: (F, F)) -> F {
    a.0 * b.1 - a.1 * b.0
}
