//! How far photons count, by place: a few photons sent ahead tell where they lie dense.
//!
//! Where photons lie dense a small radius shows what is sharp, where they are few a large one is needed to find any. The
//! radius must not depend on the photons that it is used for, or the estimate is biased however many there are (as that
//! of the k nearest is); so it comes from photons of its own, and shrinks from round to round by one factor everywhere.

use core::f32::consts::PI;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::grid::Grid;
use super::kd_tree::{BLOCK, Tree};
use crate::lanes::{Lanes, V3};

/// Photons that are sent ahead.
pub const PHOTONS: u32 = 1 << 15;

/// Photons of a sub-map that a point is to find in the first round.
const WANTED: f32 = 4.0;

/// How fast the radius may grow with distance. A point in the dark with a large radius sees the photons of a bright spot
/// nearby that others, with small ones, count too: where the radius jumps, light comes from nowhere.
const SLOPE: f32 = 0.25;

/// The largest radius, in the frame (in which scenes are about 2 wide).
const LARGEST: f32 = 0.05;

/// The smallest radius: below it coordinates are too coarse.
pub const SMALLEST: f32 = 1e-6;

/// Photons that were sent ahead.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pilot {
    tree: Tree,
    /// For each leaf of the tree, how far photons count there in the first round; or the same for everywhere.
    radii: Vec<f32>,
    /// Root of the mean square of the irradiance that a query finds: much more than the irradiance where photons are few
    /// and far between. A guess.
    expected: Grid,
}

/// A leaf of the tree.
#[derive(Clone, Copy)]
struct Region {
    /// The middle of its photons.
    middle: [f32; 3],
    radius: f32,
    /// Photons of a sub-map by area.
    density: f32,
    /// Flux of one of them.
    flux: f32,
    /// Area by photon.
    area: f32,
}

impl Pilot {
    /// From photons sent ahead, `emitted` of them, for sub-maps of as many photons as `of_sub_map`. The radius is the
    /// same everywhere if it is given.
    pub fn new(tree: Tree, (emitted, of_sub_map): (u32, u32), radius: Option<f32>) -> Self {
        let share = of_sub_map as f32 / emitted as f32;
        let mut leaves: Vec<Region> = (0..tree.blocks.len()).map(|leaf| Region::new(&tree, leaf, share)).collect();
        match radius {
            Some(radius) => leaves.iter_mut().for_each(|leaf| leaf.radius = radius.max(SMALLEST)),
            None => soften(&mut leaves),
        }
        let square = |number: usize| {
            let ([x, y, z, _], _) = tree.photon(number)?;
            Some(([x, y, z], leaves[number / BLOCK].square()))
        };
        let squares: Vec<_> = (0..tree.flux.len()).filter_map(square).collect();
        let expected = Grid::densities(&squares).map(f32::sqrt);
        let mut radii: Vec<f32> = leaves.iter().map(|leaf| leaf.radius).collect();
        if radii.is_empty() {
            radii.push(radius.unwrap_or(LARGEST));
        }
        Self { tree, radii, expected }
    }

    /// Whether it can be asked: see [`Tree::is_sound`].
    pub fn is_sound(&self, prims: u32) -> bool {
        self.tree.is_sound(prims) && self.radii.len() == self.tree.blocks.len().max(1) && self.expected.is_sound()
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        self.tree.bytes() + self.expected.bytes() + size_of_val(&self.radii[..]) as u64
    }

    /// What a query is to expect at each point of a packet.
    #[inline(always)]
    pub fn expected<L: Lanes>(&self, l: L, point: V3<L>) -> L::F {
        self.expected.at(l, point)
    }

    /// How far photons count at each point of a packet.
    #[inline(always)]
    pub fn radius<L: Lanes>(&self, l: L, point: V3<L>) -> L::F {
        let leaf = if self.radii.len() > 1 { self.tree.leaf(l, point) } else { l.u(0) };
        l.gather(&self.radii, leaf)
    }
}

impl Region {
    /// Leaf `leaf`, of which a sub-map has so many photons for each.
    fn new(tree: &Tree, leaf: usize, share: f32) -> Self {
        let (photons, flux, area) = tree.spread_of(leaf);
        let (photons, middle) = (photons as f32, tree.middle_of(leaf));
        let density = share * photons / area;
        let radius = (WANTED / (PI * density)).sqrt().clamp(SMALLEST, LARGEST);
        Self { middle, radius, density, flux: flux / (share * photons), area: area / photons }
    }

    /// Mean square of the irradiance that a query finds, times the area by photon. A query finds n photons; the mean
    /// square of n is the square of its mean, and its mean.
    fn square(&self) -> f32 {
        let disc = PI * self.radius * self.radius;
        let (found, one) = (self.density * disc, self.flux / disc);
        one * one * found * (found + 1.0) * self.area
    }
}

/// Makes radii smaller until they grow nowhere faster than [`SLOPE`].
fn soften(leaves: &mut [Region]) {
    let before: Vec<([f32; 3], f32)> = leaves.iter().map(|leaf| (leaf.middle, leaf.radius)).collect();
    leaves.par_iter_mut().for_each(|leaf| {
        let from = |[x, y, z]: [f32; 3]| {
            let [p, q, r] = leaf.middle;
            ((x - p) * (x - p) + (y - q) * (y - q) + (z - r) * (z - r)).sqrt()
        };
        let bound = |(middle, radius): &([f32; 3], f32)| radius + SLOPE * from(*middle);
        leaf.radius = before.iter().map(bound).fold(f32::INFINITY, f32::min);
    });
}
