//! How far photons count, by place: a few photons sent ahead tell where they lie dense.
//!
//! Where photons lie dense a small radius shows what is sharp, where they are few a large one is needed to find any. The
//! radius must not depend on the photons that it is used for, or the estimate is biased however many there are (as that
//! of the k nearest is); so it comes from photons of its own, and shrinks from round to round by one factor everywhere.
//!
//! Where a map is itself what is seen, the radius changes gradually (see [`Pilot::gradual`]): steps of it would be seen
//! too.

use core::f32::consts::PI;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::grid::Grid;
use super::kd_tree::{BLOCK, Tree};
use super::nearest::nearest;
use crate::lanes::{Lanes, V3};

/// Photons that are sent ahead.
pub const PHOTONS: u32 = 1 << 15;

/// Photons of a sub-map that a point is to find in the first round.
const WANTED: f32 = 4.0;

/// How fast the radius may grow with distance. A point in the dark with a large radius sees the photons of a bright spot
/// nearby that others, with small ones, count too: where the radius jumps, light comes from nowhere.
const SLOPE: f32 = 0.25;

/// Photons of the whole map that a point is to find where the map is what is seen.
const SEEN: f32 = 48.0;

/// The radius that is seen is by the distance of this photon sent ahead: of fewer it would be by chance.
const NEAR: usize = 16;

/// One photon in so many is asked for it; a leaf has four of these.
const ONE_IN: usize = 4;

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
    /// The same for each photon of the tree, and how much it grows by distance from there; none where the radius is that
    /// of the leaf.
    gradual: Option<(Vec<f32>, f32)>,
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
        // Squares of flux in watts may be beyond what f32 holds: the unit is about the largest flux.
        let unit = power_of_two_by(leaves.iter().map(|leaf| leaf.flux).fold(0.0, f32::max));
        let square = |number: usize| {
            let ([x, y, z, _], _) = tree.photon(number)?;
            Some(([x, y, z], leaves[number / BLOCK].square(unit)))
        };
        let squares: Vec<_> = (0..tree.flux.len()).filter_map(square).collect();
        let expected = Grid::densities(&squares).map(|mean| unit * mean.sqrt());
        let mut radii: Vec<f32> = leaves.iter().map(|leaf| leaf.radius).collect();
        if radii.is_empty() {
            radii.push(radius.unwrap_or(LARGEST));
        }
        Self { tree, radii, gradual: None, expected }
    }

    /// With a radius that changes gradually: in proportion to the distance of the `NEAR`th photon that was sent ahead.
    /// For a map of as many photons as `of_map`, when `emitted` were sent ahead.
    pub fn gradual(self, (emitted, of_map): (u32, u32)) -> Self {
        let share = of_map as f32 / emitted as f32;
        let slope = (SEEN / (share * NEAR as f32)).sqrt();
        let radius = |number: usize| {
            let asked = self.tree.photon(number).filter(|_| number.is_multiple_of(ONE_IN));
            let Some(([x, y, z, _], _)) = asked else { return f32::INFINITY };
            let near = nearest(&self.tree, [x, y, z], NEAR, |_| true);
            near.get(NEAR - 1).map_or(LARGEST, |photon| (slope * photon.0.sqrt()).clamp(SMALLEST, LARGEST))
        };
        let radii = (0..self.tree.flux.len()).into_par_iter().map(radius).collect();
        Self { gradual: Some((radii, slope)), ..self }
    }

    /// The least and the largest radius, in the frame.
    pub fn radii(&self) -> [f32; 2] {
        let radii = self.gradual.as_ref().map_or(&self.radii, |(radii, _)| radii);
        let radii = || radii.iter().copied().filter(|radius| radius.is_finite());
        let of = |pick: fn(f32, f32) -> f32| radii().reduce(pick).unwrap_or(LARGEST);
        [of(f32::min), of(f32::max)]
    }

    /// Whether it can be asked: see [`Tree::is_sound`].
    pub fn is_sound(&self, prims: u32) -> bool {
        let gradual = self.gradual.as_ref().is_none_or(|(radii, _)| radii.len() == self.tree.flux.len());
        let radii = gradual && self.radii.len() == self.tree.blocks.len().max(1);
        radii && self.tree.is_sound(prims) && self.expected.is_sound()
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        let gradual = self.gradual.as_ref().map_or(0, |(radii, _)| size_of_val(&radii[..]));
        self.tree.bytes() + self.expected.bytes() + (size_of_val(&self.radii[..]) + gradual) as u64
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
        match &self.gradual {
            None => l.gather(&self.radii, leaf),
            Some((radii, slope)) => self.by_photons(l, (radii, *slope), leaf, point),
        }
    }

    /// The least that a photon of the leaf allows, over those of each point's leaf.
    #[inline(always)]
    fn by_photons<L: Lanes>(&self, l: L, (radii, slope): (&[f32], f32), leaf: L::U, point: V3<L>) -> L::F {
        let (mut leaves, mut places, mut found) = ([0; 16], [[0.0; 16]; 3], [LARGEST; 16]);
        l.store_u(leaf, &mut leaves);
        for (column, value) in places.iter_mut().zip(point.components()) {
            l.store(value, column);
        }
        for lane in 0..L::WIDTH {
            let Some([xs, ys, zs, _]) = self.tree.blocks.get(leaves[lane] as usize) else { continue };
            let from = V3::splat(l, places.map(|column| column[lane]));
            for first in (0..BLOCK).step_by(L::WIDTH) {
                let away = V3::new(l.load(&xs[first..]), l.load(&ys[first..]), l.load(&zs[first..])) - from;
                let radius = l.load(&radii[leaves[lane] as usize * BLOCK + first..]);
                let mut allowed = [0.0; 16];
                l.store(l.mul_add(l.f(slope), l.sqrt(away.dot(l, away)), radius), &mut allowed);
                found[lane] = allowed[..L::WIDTH].iter().copied().fold(found[lane], f32::min);
            }
        }
        l.load(&found)
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

    /// Mean square of the irradiance that a query finds, in this unit of flux, times the area by photon. A query finds n
    /// photons; the mean square of n is the square of its mean, and its mean.
    fn square(&self, unit: f32) -> f32 {
        let disc = PI * self.radius * self.radius;
        let (found, one) = (self.density * disc, self.flux / unit / disc);
        one * one * found * (found + 1.0) * self.area
    }
}

/// The power of two at or below `x`; 1 where that is none.
fn power_of_two_by(x: f32) -> f32 {
    if x.is_normal() && x > 0.0 { f32::from_bits(x.to_bits() & 0x7f80_0000) } else { 1.0 }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::One;
    use crate::photon::{Photons, Tag};

    /// Photons on a unit square: most of them in its first hundredth.
    fn pilot() -> Pilot {
        let mut photons = Photons::default();
        for number in 0..2048u32 {
            let [u, v] = [number % 45, number / 45].map(|step| (step as f32 + 0.5) / 46.0);
            let side = if number % 4 == 0 { 1.0 } else { 0.1 };
            photons.places.push([side * u, side * v, 0.0, f32::from_bits(Tag::new(0, true).0)]);
            photons.flux.push([1.0; 4]);
        }
        Pilot::new(Tree::new([&photons]), (2048, 2048), None).gradual((2048, 16 * 2048))
    }

    fn radius(pilot: &Pilot, x: f32) -> f32 {
        let mut radii = [0.0; 16];
        One.store(pilot.radius(One, V3::splat(One, [x, 0.05, 0.0])), &mut radii);
        radii[0]
    }

    #[test]
    fn where_photons_lie_dense_they_do_not_count_far() {
        let pilot = pilot();
        assert!(3.0 * radius(&pilot, 0.05) < radius(&pilot, 0.6));
        let [least, most] = pilot.radii();
        assert!(least <= radius(&pilot, 0.05) && most <= LARGEST);
    }

    #[test]
    fn without_photons_the_radius_is_the_largest() {
        let pilot = Pilot::new(Tree::default(), (2048, 2048), None).gradual((2048, 2048));
        assert_eq!(radius(&pilot, 0.5), LARGEST);
    }
}
