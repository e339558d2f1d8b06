//! A left-balanced kd-tree of photons (Jensen 1996, 2001), with blocks of photons for leaves: a heap without pointers,
//! as deep as the number of photons demands, whatever their places.
//!
//! Nodes count from 1, and node k has the children 2k and 2k + 1. With m blocks the nodes below m split, and from m on
//! they are blocks; all are full but one. A node splits the photons across the longest side of its box; of equal coordinates
//! the photon's number decides, so photons that share one coordinate, or all three, are no special case, and the tree
//! is a function of the photons.

use serde::{Deserialize, Serialize};

use super::{Photons, Tag};
use crate::lanes::{Lanes, V3};

/// Photons of a leaf: as many as the widest level looks at together.
pub const BLOCK: usize = 16;

/// Where a node splits: the coordinate, and the axis (bits).
pub type Split = [f32; 2];

/// The photons of a leaf, coordinate by coordinate, and their tags (bits). Beyond the last photon everything is infinite.
pub type Block = [[f32; BLOCK]; 4];

/// A tree.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tree {
    /// Splits of the nodes from 1 on.
    pub splits: Vec<Split>,
    /// The leaves.
    pub blocks: Vec<Block>,
    /// Flux and scattering events of the photons, block by block.
    pub flux: Vec<[f32; 4]>,
    /// Number of photons.
    pub len: usize,
}

/// A photon on its way to its leaf.
#[derive(Clone, Copy)]
struct Item {
    place: [f32; 3],
    number: u32,
}

impl Tree {
    /// Orders photons.
    pub fn new(photons: &Photons) -> Self {
        let place = |&[x, y, z, _]: &[f32; 4]| [x, y, z];
        let mut items: Vec<Item> =
            (0..).zip(&photons.places).map(|(number, photon)| Item { place: place(photon), number }).collect();
        let count = items.len().div_ceil(BLOCK);
        let mut tree = Self {
            splits: vec![[0.0; 2]; count.saturating_sub(1)],
            blocks: vec![[[f32::INFINITY; BLOCK]; 4]; count],
            flux: vec![[0.0; 4]; count * BLOCK],
            len: items.len(),
        };
        if count > 0 {
            let bounds = bounds(&items);
            tree.fill(&mut items, (1, count), bounds, photons);
        }
        tree
    }

    /// Makes the subtree of `node`, which has so many leaves, of photons within `bounds`.
    fn fill(&mut self, items: &mut [Item], (node, leaves): (usize, usize), bounds: Bounds, photons: &Photons) {
        if leaves == 1 {
            return self.put(node - self.blocks.len(), items, photons);
        }
        let axis = widest(bounds);
        let left = left_leaves(leaves);
        let order = |a: &Item, b: &Item| a.place[axis].total_cmp(&b.place[axis]).then(a.number.cmp(&b.number));
        let (_, middle, _) = items.select_nth_unstable_by(left * BLOCK, order);
        let split = middle.place[axis];
        self.splits[node - 1] = [split, f32::from_bits(axis as u32)];
        let (mut low, mut high) = (bounds, bounds);
        low[1][axis] = split;
        high[0][axis] = split;
        let (below, above) = items.split_at_mut(left * BLOCK);
        self.fill(below, (2 * node, left), low, photons);
        self.fill(above, (2 * node + 1, leaves - left), high, photons);
    }

    fn put(&mut self, leaf: usize, items: &mut [Item], photons: &Photons) {
        items.sort_unstable_by_key(|item| item.number);
        for (lane, item) in items.iter().enumerate() {
            let photon = photons.places[item.number as usize];
            (0..4).for_each(|k| self.blocks[leaf][k][lane] = photon[k]);
            self.flux[leaf * BLOCK + lane] = photons.flux[item.number as usize];
        }
    }

    /// Place, tag (bits) and flux of a photon by its number; `None` beyond the last one of a block.
    pub fn photon(&self, number: usize) -> Option<([f32; 4], [f32; 4])> {
        let (block, lane) = (&self.blocks[number / BLOCK], number % BLOCK);
        let place = block.map(|column| column[lane]);
        place[0].is_finite().then(|| (place, self.flux[number]))
    }

    /// The child of each node on the point's side of its split, and the point's distance to the split.
    #[inline(always)]
    pub fn child<L: Lanes>(&self, l: L, node: L::U, point: V3<L>) -> (L::U, L::F) {
        let [split, axis] = l.gather_record(&self.splits, l.add_u(node, l.u(u32::MAX)));
        let axis = l.bits(axis);
        let y_or_z = l.select(l.eq_u(axis, l.u(1)), point.y, point.z);
        let along = split - l.select(l.eq_u(axis, l.u(0)), point.x, y_or_z);
        let first = l.shl::<1>(node);
        (l.select_u(l.lt(along, l.f(0.0)), l.add_u(first, l.u(1)), first), along)
    }

    /// The leaf of each point.
    #[inline(always)]
    pub fn leaf<L: Lanes>(&self, l: L, point: V3<L>) -> L::U {
        let leaves = l.u(self.blocks.len() as u32);
        let mut node = l.u(1);
        loop {
            let down = l.lt_u(node, leaves);
            if !l.any(down) {
                break;
            }
            let child = self.child(l, l.select_u(down, node, l.u(1)), point).0;
            node = l.select_u(down, child, node);
        }
        l.add_u(node, l.add_u(!leaves, l.u(1)))
    }

    /// Photons of a leaf, their flux (brightest channel), and about how much area they lie on.
    pub fn spread_of(&self, leaf: usize) -> (usize, f32, f32) {
        let photons = (leaf * BLOCK..(leaf + 1) * BLOCK).filter_map(|number| self.photon(number));
        let (places, fluxes): (Vec<[f32; 4]>, Vec<[f32; 4]>) = photons.unzip();
        let flux = fluxes.iter().map(|[r, g, b, _]| r.max(*g).max(*b)).sum();
        let extent = |k: usize| {
            let along = || places.iter().map(|place| place[k]);
            along().fold(f32::NEG_INFINITY, f32::max) - along().fold(f32::INFINITY, f32::min)
        };
        let [x, y, z] = [extent(0), extent(1), extent(2)];
        (places.len(), flux, ((x * y) * (x * y) + (y * z) * (y * z) + (z * x) * (z * x)).sqrt())
    }

    /// The mean of the photons' places in a leaf.
    pub fn middle_of(&self, leaf: usize) -> [f32; 3] {
        let photons: Vec<[f32; 4]> = (leaf * BLOCK..(leaf + 1) * BLOCK)
            .filter_map(|number| self.photon(number))
            .map(|(place, _)| place)
            .collect();
        [0, 1, 2].map(|k: usize| photons.iter().map(|place| place[k]).sum::<f32>() / photons.len() as f32)
    }

    /// Whether it is a tree of photons on the primitives below `prims`: what walks through it goes nowhere else.
    pub fn is_sound(&self, prims: u32) -> bool {
        let axes = self.splits.iter().all(|[_, axis]| axis.to_bits() < 3);
        let tags = self.blocks.iter().flat_map(|block| block[3]).filter(|tag| tag.is_finite());
        let tags = tags.map(|tag| Tag(tag.to_bits())).all(|tag| tag.prim() < prims);
        let counts = self.flux.len() == self.blocks.len() * BLOCK && self.len <= self.flux.len();
        axes && tags && counts && self.splits.len() == self.blocks.len().saturating_sub(1)
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.splits[..]) + size_of_val(&self.blocks[..]) + size_of_val(&self.flux[..])) as u64
    }
}

/// Leaves left of the root of a heap with `count` > 1 leaves.
fn left_leaves(count: usize) -> usize {
    // Nodes of the last full row: each is a leaf, or has two below it; those that have are on the left.
    let row = 1 << count.ilog2();
    row / 2 + (count - row).min(row / 2)
}

/// Low and high corner of a box.
type Bounds = [[f32; 3]; 2];

/// The box of some photons, at least one.
fn bounds(items: &[Item]) -> Bounds {
    let around = |[low, high]: Bounds, place: [f32; 3]| {
        [[0, 1, 2].map(|k: usize| low[k].min(place[k])), [0, 1, 2].map(|k: usize| high[k].max(place[k]))]
    };
    items.iter().fold([items[0].place; 2], |so_far, item| around(so_far, item.place))
}

/// The longest side of a box; the first of equals.
fn widest([low, high]: Bounds) -> usize {
    let extent = [0, 1, 2].map(|k: usize| high[k] - low[k]);
    if extent[0] >= extent[1] && extent[0] >= extent[2] {
        0
    } else if extent[1] >= extent[2] {
        1
    } else {
        2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_left_of_the_root_are_those_of_a_heap() {
        for count in 2..300 {
            // Of the leaves count..2 count, those that have node 2 above them.
            let below_two = (count..2 * count).filter(|leaf: &usize| leaf >> (leaf.ilog2() - 1) == 2);
            assert_eq!(left_leaves(count), below_two.count(), "{count}");
        }
    }
}
