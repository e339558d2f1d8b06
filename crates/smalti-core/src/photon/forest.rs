//! Photons sent ahead, sorted by surface and place: a point finds the few that lie about it on its own surface.
//!
//! Each surface with enough photons has a tree of its own. In one tree of all, the floor of a room and its ceiling are
//! parted at a height at which photons lie, and a point that rounding put above the floor is taken for one of the ceiling.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::kd_tree::{Tree, descend};
use super::{Photons, Surfaces, Tag};
use crate::lanes::{Lanes, V3};

/// Photons that a surface has at least in a tree of its own; the others share one.
const ENOUGH: usize = 64;

/// Trees of photons, by surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Forest {
    /// Coordinate and axis (bits) of the splits, tree after tree.
    splits: Vec<[f32; 2]>,
    /// For each tree its first split, its first leaf and the number of its leaves (bits).
    trees: Vec<[f32; 4]>,
    /// For each primitive the tree of its surface; the shared one stands first.
    tree_of: Vec<u32>,
    leaves: u32,
}

impl Forest {
    /// Sorts photons. Returns the trees too, in the order of their leaves.
    pub fn new(photons: &Photons, surfaces: &Surfaces) -> (Self, Vec<Tree>) {
        let mut by_surface: BTreeMap<u32, Photons> = BTreeMap::new();
        for (place, flux) in photons.places.iter().zip(&photons.flux) {
            let of_surface = by_surface.entry(surfaces.number(Tag(place[3].to_bits()).prim())).or_default();
            of_surface.places.push(*place);
            of_surface.flux.push(*flux);
        }
        let (many, few): (Vec<_>, Vec<_>) = by_surface.into_iter().partition(|(_, photons)| photons.len() >= ENOUGH);
        let shared = Tree::new(few.iter().map(|(_, photons)| photons));
        let numbers: BTreeMap<u32, u32> = many.iter().zip(1..).map(|((surface, _), tree)| (*surface, tree)).collect();
        let own = many.iter().map(|(_, photons)| Tree::new([photons]));
        let trees: Vec<Tree> = std::iter::once(shared).chain(own).collect();
        let tree = |prim: u32| numbers.get(&surfaces.number(prim)).copied().unwrap_or(0);
        let mut forest = Self { tree_of: (0..surfaces.len() as u32).map(tree).collect(), ..Self::default() };
        trees.iter().for_each(|tree| forest.plant(tree));
        (forest, trees)
    }

    fn plant(&mut self, tree: &Tree) {
        let leaves = tree.blocks.len() as u32;
        let record = [self.splits.len() as u32, self.leaves, leaves, 0];
        self.trees.push(record.map(f32::from_bits));
        self.splits.extend(tree.splits.iter().map(|[split, _, _, axis]| [*split, *axis]));
        self.leaves += leaves;
    }

    /// The leaf of each point on the surface of `prim`; the number of all leaves where that surface has none.
    #[inline(always)]
    pub fn leaf<L: Lanes>(&self, l: L, prim: L::U, point: V3<L>) -> L::U {
        let [splits, first, leaves, _] = l.gather_record(&self.trees, l.gather_u(&self.tree_of, prim));
        let (splits, first, leaves) = (l.bits(splits), l.bits(first), l.bits(leaves));
        // A tree of one leaf has no split, and those behind it may have none either.
        let several = l.lt_u(l.u(1), leaves);
        let leaf = descend(
            l,
            leaves,
            point,
            #[inline(always)]
            |number| {
                let at = l.select_u(several, l.add_u(splits, number), l.u(0));
                let [split, axis] = l.gather_record(&self.splits, at);
                (split, l.bits(axis))
            },
        );
        let leaf = l.add_u(first, leaf);
        l.select_u(l.eq_u(leaves, l.u(0)), l.u(self.leaves), leaf)
    }

    /// Number of leaves.
    pub fn leaves(&self) -> usize {
        self.leaves as usize
    }

    /// Whether every tree and split that a point meets is there, for a scene of `prims` primitives. A file that is damaged
    /// or of another scene fails.
    pub fn is_sound(&self, prims: u32) -> bool {
        let tree_of =
            self.tree_of.len() == prims as usize && self.tree_of.iter().all(|tree| (*tree as usize) < self.trees.len());
        let (mut splits, mut leaves) = (0u64, 0u64);
        let in_order = self.trees.iter().all(|record| {
            let [first_split, first_leaf, count, _] = record.map(|part| u64::from(part.to_bits()));
            let fits = first_split == splits && first_leaf == leaves;
            splits += count.saturating_sub(1);
            leaves += count;
            fits
        });
        let axes = self.splits.iter().all(|[_, axis]| axis.to_bits() < 3);
        tree_of && in_order && axes && splits == self.splits.len() as u64 && leaves == u64::from(self.leaves)
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.splits[..]) + size_of_val(&self.trees[..]) + size_of_val(&self.tree_of[..])) as u64
    }
}
