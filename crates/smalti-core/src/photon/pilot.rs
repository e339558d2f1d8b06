//! A few photons sent ahead: how far photons are spread, by place, and what a query is to expect.
//!
//! Where photons lie dense a small radius shows what is sharp, where they are few a large one is needed to find any. The
//! radius must not depend on the photons that it is used for, or the estimate is biased however many there are (as that
//! of the k nearest is); so it comes from photons of its own, and shrinks from round to round by one factor everywhere.

use core::f32::consts::PI;

use serde::{Deserialize, Serialize};

use super::forest::Forest;
use super::kd_tree::Tree;
use super::{Photons, Surfaces};
use crate::lanes::{Lanes, V3};

/// Photons that are sent ahead.
pub const PHOTONS: u32 = 1 << 15;

/// Photons of a sub-map that are to reach a point in the first round.
pub const WANTED: f32 = 2.0;

/// Photons of the whole map that are to reach a point where the map is what is seen.
pub const SEEN: f32 = 48.0;

/// The largest radius, in the frame (in which scenes are about 2 wide).
const LARGEST: f32 = 0.05;

/// The least area of a leaf's photons, in the frame: that of photons in one place is not 0, or densities were infinite.
const LEAST_AREA: f32 = 1e-30;

/// Photons that were sent ahead.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pilot {
    forest: Forest,
    /// For each leaf of the forest, and at the end for surfaces without photons: the radius in the first round, and the
    /// root of the mean square of the irradiance that a query finds, which is much more than the irradiance where photons
    /// are few and far between.
    regions: Vec<[f32; 2]>,
}

/// Photons of which map, and how many of them are to reach a point.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Photons that were sent ahead.
    pub ahead: u32,
    /// Photons of the map.
    pub of_map: u32,
    /// Photons that are to reach a point.
    pub wanted: f32,
}

impl Pilot {
    /// From photons sent ahead. The radius is the same everywhere if it is given.
    pub fn new(photons: &Photons, surfaces: &Surfaces, target: Target, radius: Option<f32>) -> Self {
        let (forest, trees) = Forest::new(photons, surfaces);
        let leaves = trees.iter().flat_map(|tree| (0..tree.blocks.len()).map(move |leaf| (tree, leaf)));
        let regions = leaves.map(|(tree, leaf)| region(tree, leaf, target, radius));
        let regions = regions.chain([[radius.unwrap_or(LARGEST), 0.0]]).collect();
        Self { forest, regions }
    }

    /// Whether its forest is sound for a scene of `prims` primitives ([`Forest::is_sound`]), with a region for each leaf.
    pub fn is_sound(&self, prims: u32) -> bool {
        self.regions.len() == self.forest.leaves() + 1 && self.forest.is_sound(prims)
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        self.forest.bytes() + size_of_val(&self.regions[..]) as u64
    }

    /// The irradiance that a query finds at each point of a packet, on the surfaces of `prim`; root mean square. A guess.
    #[inline(always)]
    pub fn expected<L: Lanes>(&self, l: L, prim: L::U, point: V3<L>) -> L::F {
        self.region(l, prim, point)[1]
    }

    /// The radius of photons at each point of a packet, in the first round.
    #[inline(always)]
    pub fn radius<L: Lanes>(&self, l: L, prim: L::U, point: V3<L>) -> L::F {
        self.region(l, prim, point)[0]
    }

    #[inline(always)]
    fn region<L: Lanes>(&self, l: L, prim: L::U, point: V3<L>) -> [L::F; 2] {
        l.gather_record(&self.regions, self.forest.leaf(l, prim, point))
    }
}

/// Radius and expectation about the photons of a leaf.
fn region(tree: &Tree, leaf: usize, target: Target, radius: Option<f32>) -> [f32; 2] {
    let (photons, flux, area) = tree.spread_of(leaf);
    // A last leaf with a single photon has no area of its own.
    let area = if area > 0.0 { area } else { tree.area() * photons as f32 / tree.len as f32 };
    let area = area.max(LEAST_AREA);
    let share = target.of_map as f32 / target.ahead as f32;
    let density = share * photons as f32 / area;
    let radius = radius.unwrap_or_else(|| (target.wanted / (PI * density)).sqrt().min(LARGEST));
    let disc = PI * radius * radius;
    // n photons reach a point; the mean square of n is the square of its mean, and its mean.
    let (found, one) = (density * disc, flux / (share * photons as f32) / disc);
    [radius, one * (found * (found + 1.0)).sqrt()]
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::lanes::One;
    use crate::photon::Tag;
    use crate::scene::world::{Material, Polygon};
    use crate::scene::{World, compile};

    const TARGET: Target = Target { ahead: 2048, of_map: 2048, wanted: WANTED };

    /// A floor at height 0 and a ceiling at 0.9, of sides 2.
    fn surfaces() -> Surfaces {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let square = |z: f64| Polygon {
            vertices: corners.map(|[x, y]| DVec3::new(x, y, z)).to_vec(),
            material: 0,
            radiance: None,
        };
        let materials = vec![Material::Lambert { albedo: [0.5; 3] }];
        Surfaces::new(&compile(
            &World { materials, polygons: vec![square(0.0), square(0.9)], ..World::default() },
            false,
        ))
    }

    /// Photons on a square of the floor of side `side` about the origin, three of four of them in its middle hundredth;
    /// and each tenth on all of the ceiling.
    fn pilot(side: f32) -> Pilot {
        let mut photons = Photons::default();
        for number in 0..2048u32 {
            let [u, v] = [number % 45, number / 45].map(|step| (step as f32 + 0.5) / 46.0 - 0.5);
            let side = if number % 4 == 0 { side } else { 0.1 * side };
            let (side, height, prim) = if number % 10 == 0 { (2.0, 0.9, 1) } else { (side, 0.0, 0) };
            photons.places.push([side * u, side * v, height, f32::from_bits(Tag::new(prim, true).0)]);
            photons.flux.push([1.0; 4]);
        }
        Pilot::new(&photons, &surfaces(), TARGET, None)
    }

    /// At the distance `x` from the middle of the floor, where rays leave it.
    fn radius(pilot: &Pilot, x: f32) -> f32 {
        let mut radii = [0.0; 16];
        One.store(pilot.radius(One, 0, V3::splat(One, [x, 0.0, 1e-7])), &mut radii);
        radii[0]
    }

    /// However small the square is beside what lies above it.
    #[test]
    fn radii_are_those_of_the_density_at_any_scale() {
        let in_middle = 2048.0 * 0.75 * 0.9;
        for side in [1.0, 1e-2, 1e-4, 1e-6] {
            let pilot = pilot(side);
            let expected = 0.1 * side * (WANTED / (PI * in_middle)).sqrt();
            let found = radius(&pilot, 0.003 * side);
            assert!((0.5..2.0).contains(&(found / expected)), "{side}: {found} instead of {expected}");
            assert!(radius(&pilot, 0.4 * side) > 3.0 * found, "{side}");
            assert!(pilot.regions.iter().all(|[radius, _]| *radius <= LARGEST));
            assert!(pilot.is_sound(2) && !pilot.is_sound(3));
        }
    }

    /// Of photons in one place, and of one alone.
    #[test]
    fn every_region_is_finite() {
        for count in [1, 2, 16, 65, 2048] {
            let mut photons = Photons::default();
            for _ in 0..count {
                photons.places.push([0.25, -0.5, 0.0, f32::from_bits(Tag::new(0, true).0)]);
                photons.flux.push([1.0; 4]);
            }
            let pilot = Pilot::new(&photons, &surfaces(), TARGET, None);
            assert!(pilot.regions.as_flattened().iter().all(|value| value.is_finite()), "{count}: {:?}", pilot.regions);
        }
    }

    #[test]
    fn without_photons_the_radius_is_the_largest() {
        assert_eq!(radius(&Pilot::new(&Photons::default(), &surfaces(), TARGET, None), 0.5), LARGEST);
    }
}
