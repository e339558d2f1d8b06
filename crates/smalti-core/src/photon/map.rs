//! A photon map: [`SUB_MAPS`] sets of photons, each an estimate of all the light, and each a tree; or, where no more trees
//! are asked, several sets in one.

use serde::{Deserialize, Serialize};

use super::kd_tree::Tree;
use super::{Account, Kind, SUB_MAPS};

/// The photons that a round of samples asks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// What it holds.
    pub kind: Kind,
    /// The round that it serves.
    pub round: u32,
    /// Where the light of all its photons went.
    pub account: Account,
    /// The sub-maps, as many in each tree.
    pub trees: Vec<Tree>,
}

impl Map {
    /// A map of these trees, in their order.
    ///
    /// # Panics
    /// Unless their number divides [`SUB_MAPS`].
    pub fn new(kind: Kind, round: u32, trees: Vec<Tree>, account: Account) -> Self {
        assert!((SUB_MAPS as usize).is_multiple_of(trees.len()));
        Self { kind, round, account, trees }
    }

    /// Number of photons.
    pub fn len(&self) -> usize {
        self.trees.iter().map(|tree| tree.len).sum()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The least and the largest radius of its photons; `None` without a photon.
    pub fn radii(&self) -> Option<[f32; 2]> {
        let radii = self.trees.iter().flat_map(Tree::radii);
        radii.map(|radius| [radius; 2]).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        self.trees.iter().map(Tree::bytes).sum()
    }
}
