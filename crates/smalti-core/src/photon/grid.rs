//! Values by place, in equal boxes: one look-up tells what is about a point.

use serde::{Deserialize, Serialize};

use crate::lanes::{Lanes, V3};

/// Boxes along the longest side.
const BOXES: f32 = 64.0;

/// Equal boxes around some points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    low: [f32; 3],
    /// Boxes by length.
    inverse: f32,
    /// Boxes in each direction.
    size: [u32; 3],
    boxes: Vec<f32>,
}

impl Grid {
    /// Sums what lies at each place, over three boxes each way; by the area of a plane through them.
    pub fn densities(items: &[([f32; 3], f32)]) -> Self {
        let (low, high) = bounds(items);
        let longest = (0..3).map(|k| high[k] - low[k]).fold(0.0, f32::max);
        let side = (longest / BOXES).max(1e-6);
        let size = [0, 1, 2].map(|k: usize| ((high[k] - low[k]) / side) as u32 + 3);
        let boxes = vec![0.0; size.iter().product::<u32>() as usize];
        let mut grid = Self { low: low.map(|x| x - side), inverse: 1.0 / side, size, boxes };
        for (place, value) in items {
            let [x, y, z] = [0, 1, 2].map(|k: usize| ((place[k] - grid.low[k]) * grid.inverse).round() as u32);
            grid.boxes[((z * size[1] + y) * size[0] + x) as usize] += value;
        }
        (0..3).for_each(|axis| grid.spread(axis));
        grid.boxes.iter_mut().for_each(|sum| *sum /= 9.0 * side * side);
        grid
    }

    /// Changes every value.
    pub fn map(mut self, change: impl Fn(f32) -> f32) -> Self {
        self.boxes.iter_mut().for_each(|value| *value = change(*value));
        self
    }

    /// Whether it has as many boxes as it says.
    pub fn is_sound(&self) -> bool {
        let count = self.size.iter().try_fold(1u32, |product, side| product.checked_mul(*side));
        count.is_some_and(|count| count > 0 && count as usize == self.boxes.len())
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        size_of_val(&self.boxes[..]) as u64
    }

    /// The value at a point.
    #[inline(always)]
    pub fn at<L: Lanes>(&self, l: L, point: V3<L>) -> L::F {
        let (x, y, z) = (self.index(l, point.x, 0), self.index(l, point.y, 1), self.index(l, point.z, 2));
        let row = l.add_u(l.mul_u(z, l.u(self.size[1])), y);
        l.gather(&self.boxes, l.add_u(l.mul_u(row, l.u(self.size[0])), x))
    }

    /// Which box along an axis; the nearest for points outside.
    #[inline(always)]
    fn index<L: Lanes>(&self, l: L, x: L::F, axis: usize) -> L::U {
        let place = (x - l.f(self.low[axis])) * l.f(self.inverse);
        let place = l.max(l.min(place, l.f(self.size[axis] as f32 - 1.0)), l.f(0.0));
        // A number below 2²² plus 2²³ has its nearest integer in its lowest bits.
        l.bits(place + l.f(8_388_608.0)) & l.u(0x007f_ffff)
    }

    /// Adds to each box its two neighbours along an axis.
    fn spread(&mut self, axis: usize) {
        let step = self.size[..axis].iter().product::<u32>() as usize;
        let before = self.boxes.clone();
        for at in 0..before.len() {
            let along = (at / step) as u32 % self.size[axis];
            let lower = if along > 0 { before[at - step] } else { 0.0 };
            let upper = if along + 1 < self.size[axis] { before[at + step] } else { 0.0 };
            self.boxes[at] += lower + upper;
        }
    }
}

/// The box of some points; of none, the origin.
fn bounds(items: &[([f32; 3], f32)]) -> ([f32; 3], [f32; 3]) {
    let wider = |(low, high): ([f32; 3], [f32; 3]), place: [f32; 3]| {
        ([0, 1, 2].map(|k: usize| low[k].min(place[k])), [0, 1, 2].map(|k: usize| high[k].max(place[k])))
    };
    let Some((first, _)) = items.first() else { return ([0.0; 3], [0.0; 3]) };
    items.iter().fold((*first, *first), |so_far, (place, _)| wider(so_far, *place))
}
