//! A left-balanced kd-tree of photons (Jensen 1996, 2001), with blocks of photons for leaves: a heap without pointers,
//! as deep as the number of photons demands, whatever their places.
//!
//! Nodes count from 1, and node k has the children 2k and 2k + 1. With m blocks the nodes below m split, and from m on
//! they are blocks; all are full but one. A node splits the photons across the longest side of their box; of equal
//! coordinates the photon's number decides, so photons that share one coordinate, or all three, are no special case, and
//! the tree is a function of the photons. Each node also bounds how far the kernels of the photons on both of its sides
//! reach across the split: a point descends only to photons that may count there.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Photons, Tag};
use crate::lanes::{Lanes, V3};

/// Photons of a leaf: as many as the widest level looks at together.
pub const BLOCK: usize = 16;

/// Where a node splits: the coordinate; how far up the photons on its left reach, and how far down those on its right;
/// and the axis (bits).
pub type Split = [f32; 4];

/// The photons of a leaf: three coordinates, tags (bits), and the radii of their [`kernel`](super::kernel)s. Beyond the last
/// photon coordinates are infinite.
pub type Block = [[f32; BLOCK]; 5];

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

/// A photon on its way to its leaf: its coordinates as [`ordered`] bits.
#[derive(Clone, Copy)]
struct Item {
    place: [u32; 3],
    /// Its part (upper half), and which of the part it is.
    number: u32,
    /// The radius of its kernel.
    reach: f32,
}

/// Photons of one part at most.
const PART: usize = 1 << 16;

/// Some photons of a batch.
struct Part<'a> {
    places: &'a [[f32; 4]],
    flux: &'a [[f32; 4]],
    /// None where photons have no kernels.
    radii: &'a [f32],
}

/// A leaf without photons.
const EMPTY: Block = {
    let nowhere = [f32::INFINITY; BLOCK];
    [nowhere, nowhere, nowhere, nowhere, [0.0; BLOCK]]
};

/// Subtrees of more leaves than this are worth a task of their own.
const TASK: usize = 256;

impl Tree {
    /// Orders the photons of some batches, on the threads of the current pool.
    pub fn new<'a>(batches: impl IntoIterator<Item = &'a Photons>) -> Self {
        let parts: Vec<Part<'a>> = batches.into_iter().flat_map(parts_of).collect();
        assert!(parts.len() <= PART, "photons have numbers of 32 bits");
        let mut items = items(&parts);
        let count = items.len().div_ceil(BLOCK);
        if count == 0 {
            return Self::default();
        }
        let mut splits = vec![[0.0; 4]; count - 1];
        divide(&mut items, &mut splits, count);
        items.par_chunks_mut(BLOCK).with_min_len(TASK).for_each(|leaf| leaf.sort_unstable_by_key(|item| item.number));
        let mut tree = Self {
            splits: heap(&splits, count),
            blocks: vec![EMPTY; count],
            flux: vec![[0.0; 4]; count * BLOCK],
            len: items.len(),
        };
        let leaves = tree.blocks.par_iter_mut().zip(tree.flux.par_chunks_mut(BLOCK)).enumerate();
        leaves.with_min_len(TASK).for_each(|(leaf, (block, flux))| {
            let place = BLOCK * place_of_leaf(leaf, count);
            fill((block, flux), &items[place..items.len().min(place + BLOCK)], &parts);
        });
        tree
    }

    /// Place, tag (bits) and flux of a photon by its number; `None` beyond the last one of a block.
    pub fn photon(&self, number: usize) -> Option<([f32; 4], [f32; 4])> {
        let (block, lane) = (&self.blocks[number / BLOCK], number % BLOCK);
        let place = [0, 1, 2, 3].map(|column: usize| block[column][lane]);
        place[0].is_finite().then(|| (place, self.flux[number]))
    }

    /// Lanes whose point is reached by kernels on the left of their node's split, and on its right.
    #[inline(always)]
    pub fn reached<L: Lanes>(&self, l: L, node: L::U, point: V3<L>) -> (L::M, L::M) {
        let [_, left, right, axis] = l.gather_record(&self.splits, l.add_u(node, l.u(u32::MAX)));
        let place = along(l, l.bits(axis), point);
        (l.lt(place, left), l.lt(right, place))
    }

    /// The leaf of each point.
    #[inline(always)]
    pub fn leaf<L: Lanes>(&self, l: L, point: V3<L>) -> L::U {
        descend(
            l,
            l.u(self.blocks.len() as u32),
            point,
            #[inline(always)]
            |number| {
                let [split, _, _, axis] = l.gather_record(&self.splits, number);
                (split, l.bits(axis))
            },
        )
    }

    /// Radii of all photons.
    pub fn radii(&self) -> impl Iterator<Item = f32> {
        let there = |(x, radius): (&f32, &f32)| x.is_finite().then_some(*radius);
        self.blocks.iter().flat_map(move |[xs, .., radii]| xs.iter().zip(radii).filter_map(there))
    }

    /// About how much area all photons lie on.
    pub fn area(&self) -> f32 {
        area((0..self.blocks.len() * BLOCK).filter_map(|number| self.photon(number)).map(|(place, _)| place))
    }

    /// Photons of a leaf, their flux (brightest channel), and about how much area they lie on.
    pub fn spread_of(&self, leaf: usize) -> (usize, f32, f32) {
        let photons = (leaf * BLOCK..(leaf + 1) * BLOCK).filter_map(|number| self.photon(number));
        let (places, fluxes): (Vec<[f32; 4]>, Vec<[f32; 4]>) = photons.unzip();
        let flux = fluxes.iter().map(|[r, g, b, _]| r.max(*g).max(*b)).sum();
        (places.len(), flux, area(places.into_iter()))
    }

    /// Whether it is a tree of photons on the primitives below `prims`: what walks through it goes nowhere else.
    pub fn is_sound(&self, prims: u32) -> bool {
        let axes = self.splits.iter().all(|[_, _, _, axis]| axis.to_bits() < 3);
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

/// About how much area photons lie on: that of their box. Photons along a line lie on an area too.
fn area(places: impl Iterator<Item = [f32; 4]>) -> f32 {
    let nothing = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    let [low, high] = places.map(|[x, y, z, _]| [[x, y, z]; 2]).fold(nothing, around);
    let [x, y, z] = [0, 1, 2].map(|k: usize| (high[k] - low[k]).max(0.0));
    let longest = x.max(y).max(z);
    let flat = ((x * y) * (x * y) + (y * z) * (y * z) + (z * x) * (z * x)).sqrt();
    flat.max(longest * longest / BLOCK as f32)
}

/// Leaves left of the root of a heap with `count` > 1 leaves.
fn left_leaves(count: usize) -> usize {
    // Nodes of the last full row: each is a leaf, or has two below it; those that have are on the left.
    let row = 1 << count.ilog2();
    row / 2 + (count - row).min(row / 2)
}

/// Which leaf it is from the left, of so many: the lower one of the two rows of leaves is on the left.
fn place_of_leaf(leaf: usize, count: usize) -> usize {
    let lower = (1 << (2 * count - 1).ilog2()) - count;
    if leaf < lower { leaf + count - lower } else { leaf - lower }
}

/// Orders items by the leaves, of which there are so many, from left to right. The splits are those of the left subtree
/// behind that of its root, and those of the right one behind them. Returns the box that their kernels reach.
///
/// A node splits the longest side of the box of its photons, not of what splits above it left: where photons of a floor
/// share a height, splits across it part nothing.
fn divide(items: &mut [Item], splits: &mut [Split], leaves: usize) -> Bounds {
    let Some((own, below)) = splits.split_first_mut() else { return reached(items) };
    let axis = widest(bounds(items));
    let left = left_leaves(leaves);
    let key = |item: &Item| u64::from(item.place[axis]) << 32 | u64::from(item.number);
    let (_, middle, _) = items.select_nth_unstable_by_key(left * BLOCK, key);
    let split = unordered(middle.place[axis]);
    let (of_left, of_right) = items.split_at_mut(left * BLOCK);
    let (splits_left, splits_right) = below.split_at_mut(left - 1);
    let mut go_left = || divide(of_left, splits_left, left);
    let mut go_right = || divide(of_right, splits_right, leaves - left);
    let (a, b) = if leaves > TASK { rayon::join(go_left, go_right) } else { (go_left(), go_right()) };
    *own = [split, a[1][axis], b[0][axis], f32::from_bits(axis as u32)];
    around(a, b)
}

/// The splits of a tree with so many leaves in the order of its nodes, from those in the order of [`divide`].
fn heap(splits: &[Split], leaves: usize) -> Vec<Split> {
    let mut ordered = vec![[0.0; 4]; splits.len()];
    let mut waiting = vec![(1, splits, leaves)];
    while let Some((node, splits, leaves)) = waiting.pop() {
        let Some((own, below)) = splits.split_first() else { continue };
        ordered[node - 1] = *own;
        let left = left_leaves(leaves);
        let (of_left, of_right) = below.split_at(left - 1);
        waiting.extend([(2 * node, of_left, left), (2 * node + 1, of_right, leaves - left)]);
    }
    ordered
}

/// The photons of a batch in parts.
fn parts_of(photons: &Photons) -> impl Iterator<Item = Part<'_>> {
    (0..photons.len()).step_by(PART).map(|first| {
        let range = first..photons.len().min(first + PART);
        let radii = photons.radii.get(range.clone()).unwrap_or_default();
        Part { places: &photons.places[range.clone()], flux: &photons.flux[range], radii }
    })
}

/// The photons of all parts.
fn items(parts: &[Part<'_>]) -> Vec<Item> {
    let mut items = Vec::with_capacity(parts.iter().map(|part| part.places.len()).sum());
    for (number, part) in (0u32..).zip(parts) {
        let reach = |at: u32| part.radii.get(at as usize).copied().unwrap_or(0.0);
        let item = |(at, &[x, y, z, _]): (u32, &[f32; 4])| Item {
            place: [x, y, z].map(ordered),
            number: number << 16 | at,
            reach: reach(at),
        };
        items.extend((0..).zip(part.places).map(item));
    }
    items
}

/// Puts photons into a leaf.
fn fill((block, fluxes): (&mut Block, &mut [[f32; 4]]), items: &[Item], parts: &[Part<'_>]) {
    for (lane, item) in items.iter().enumerate() {
        let (part, at) = (&parts[(item.number >> 16) as usize], item.number as usize % PART);
        (0..4).for_each(|k| block[k][lane] = part.places[at][k]);
        block[4][lane] = part.radii.get(at).copied().unwrap_or(0.0);
        fluxes[lane] = part.flux[at];
    }
}

/// Bits that are ordered as finite f32 are, −0 below 0.
fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The f32 that [`ordered`] made these bits of.
fn unordered(bits: u32) -> f32 {
    f32::from_bits(if bits >> 31 == 1 { bits & !(1 << 31) } else { !bits })
}

/// Low and high corner of a box.
type Bounds = [[f32; 3]; 2];

/// The box of some photons, at least one.
fn bounds(items: &[Item]) -> Bounds {
    let wider = |[low, high]: [[u32; 3]; 2], place: [u32; 3]| {
        [[0, 1, 2].map(|k: usize| low[k].min(place[k])), [0, 1, 2].map(|k: usize| high[k].max(place[k]))]
    };
    let corners = items.iter().fold([items[0].place; 2], |so_far, item| wider(so_far, item.place));
    corners.map(|corner| corner.map(unordered))
}

/// The box that the kernels of some photons reach, at least one.
fn reached(items: &[Item]) -> Bounds {
    let of = |item: &Item| {
        let place = item.place.map(unordered);
        [place.map(|x| (x - item.reach).next_down()), place.map(|x| (x + item.reach).next_up())]
    };
    items[1..].iter().map(of).fold(of(&items[0]), around)
}

/// The box about two boxes.
fn around([a, b]: Bounds, [c, d]: Bounds) -> Bounds {
    [[0, 1, 2].map(|k: usize| a[k].min(c[k])), [0, 1, 2].map(|k: usize| b[k].max(d[k]))]
}

/// The leaf that holds each point, in a tree of `leaves` leaves for each lane. The function `split` gives the coordinate and
/// the axis of a split by its number in the heap, from 0 on; a lane that has reached its leaf reads number 0.
#[inline(always)]
pub fn descend<L: Lanes>(l: L, leaves: L::U, point: V3<L>, split: impl Fn(L::U) -> (L::F, L::U)) -> L::U {
    let mut node = l.u(1);
    loop {
        let down = l.lt_u(node, leaves);
        if !l.any(down) {
            break;
        }
        let (split, axis) = split(l.select_u(down, l.add_u(node, l.u(u32::MAX)), l.u(0)));
        let high = l.select_u(l.lt(split, along(l, axis, point)), l.u(1), l.u(0));
        node = l.select_u(down, l.shl::<1>(node) | high, node);
    }
    l.add_u(node, l.add_u(!leaves, l.u(1)))
}

/// A point's coordinate along an axis.
#[inline(always)]
fn along<L: Lanes>(l: L, axis: L::U, point: V3<L>) -> L::F {
    let y_or_z = l.select(l.eq_u(axis, l.u(1)), point.y, point.z);
    l.select(l.eq_u(axis, l.u(0)), point.x, y_or_z)
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

    #[test]
    fn leaves_from_the_left_are_those_of_a_heap() {
        for count in 1..300 {
            // A leaf's way down from the root, as the digits of a binary fraction.
            let way = |leaf: &usize| (leaf + count) << (20 - (leaf + count).ilog2());
            let mut leaves: Vec<usize> = (0..count).collect();
            leaves.sort_by_key(way);
            assert!((0..count).all(|place| place_of_leaf(leaves[place], count) == place), "{count}");
        }
    }

    #[test]
    fn ordered_bits_are_ordered_as_numbers_are() {
        let values = [f32::MIN, -1.0, -f32::MIN_POSITIVE, -1e-45, -0.0, 0.0, 1e-45, 0.5, 1.0, f32::MAX];
        assert!(values.is_sorted_by(|a, b| ordered(*a) < ordered(*b)));
        assert!(values.iter().all(|x| unordered(ordered(*x)).to_bits() == x.to_bits()));
    }
}
