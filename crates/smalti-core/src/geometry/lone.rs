//! Single rays of a packet.

use super::Ray;
use crate::lanes::{Lanes, One, V3};

/// A single ray as it comes out of a packet.
#[derive(Clone, Copy, Debug)]
pub struct Lone {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Where it goes.
    pub direction: [f32; 3],
    /// Surface that it leaves.
    pub leaves: u32,
}

impl Lone {
    /// The ray as the kernels want it.
    pub fn ray(&self) -> Ray<One> {
        Ray::new(One, V3::splat(One, self.origin), V3::splat(One, self.direction), self.leaves)
    }
}

/// The rays of a packet, one by one.
pub struct Unpacked {
    columns: [[f32; 16]; 6],
    leaves: [u32; 16],
}

impl Unpacked {
    /// Those of `ray`.
    #[inline(always)]
    pub fn new<L: Lanes>(l: L, ray: &Ray<L>) -> Self {
        let mut unpacked = Self { columns: [[0.0; 16]; 6], leaves: [0; 16] };
        let V3 { x, y, z } = ray.origin;
        let V3 { x: dx, y: dy, z: dz } = ray.direction;
        for (column, values) in unpacked.columns.iter_mut().zip([x, y, z, dx, dy, dz]) {
            l.store(values, column);
        }
        l.store_u(ray.leaves, &mut unpacked.leaves);
        unpacked
    }

    /// The ray of a lane.
    #[inline(always)]
    pub fn lone(&self, lane: usize) -> Lone {
        let [ox, oy, oz, dx, dy, dz] = [0, 1, 2, 3, 4, 5].map(
            #[inline(always)]
            |k: usize| self.columns[k][lane],
        );
        Lone { origin: [ox, oy, oz], direction: [dx, dy, dz], leaves: self.leaves[lane] }
    }
}
