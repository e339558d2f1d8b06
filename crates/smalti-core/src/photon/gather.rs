//! Irradiance from the photons about a point: the query of a photon map, many at a time.
//!
//! Each photon brings its own radius and what it adds within its disc ([`kernel`](super::kernel)); a point adds up those
//! whose discs it lies in (report eq. 14 without the BSDF). As photons of other surfaces, of the other side and from above
//! a flattened disc do not count, nothing leaks through thin walls or around corners.
//!
//! A packet of points walks down a tree together, lane by lane; a point that comes to a leaf looks at all photons of the
//! leaf at once. The sum goes photon by photon, in the order of the tree: no width can change a bit.

use core::f32::consts::FRAC_1_SQRT_2;

use super::kd_tree::{BLOCK, Block, Tree};
use super::surfaces::{Group, LEAST_STEPS, STEP};
use super::{Map, Surfaces, Tag};
use crate::lanes::{Lanes, One, Rgb, V3};
use crate::mutant::mutant;

/// A point this much of a photon's radius above or below its disc does not lie in it.
const FLAT: f32 = 0.25;

/// Points for which irradiance is sought.
pub struct Query<L: Lanes> {
    /// The place on the surface.
    pub point: V3<L>,
    /// Unit normal on the side that is lit.
    pub normal: V3<L>,
    /// The primitive.
    pub prim: L::U,
    /// Lanes that count.
    pub asks: L::M,
    /// Which of the map's trees.
    pub sub_map: L::U,
}

/// Irradiance at some points.
#[derive(Clone, Copy)]
pub struct Found<L: Lanes> {
    /// Irradiance.
    pub irradiance: Rgb<L>,
    /// The same with half of each disc's area: the difference from the whole is half of the bias.
    pub inner: Rgb<L>,
}

/// A map with the surfaces that it lies on.
#[derive(Clone, Copy)]
pub struct Gather<'a> {
    /// The photons.
    pub map: &'a Map,
    /// The surfaces that they lie on.
    pub surfaces: &'a Surfaces,
    /// Most scattering events before a photon was stored.
    pub most_bounces: u32,
}

/// Irradiance of the lanes: of whole discs, and of their inner halves. In f64: very many photons may reach a point.
type Sums = [[f64; 16]; 6];

impl Gather<'_> {
    /// Irradiance at the points of a packet.
    #[inline(always)]
    pub fn irradiance<L: Lanes>(&self, l: L, query: &Query<L>) -> Found<L> {
        let [r, g, b, inner_r, inner_g, inner_b] = &self.sums(l, query).map(|sums| sums.map(|sum| sum as f32));
        let irradiance = V3::new(l.load(r), l.load(g), l.load(b));
        Found { irradiance, inner: V3::new(l.load(inner_r), l.load(inner_g), l.load(inner_b)) }
    }

    /// The surfaces that the points lie on, and the tags of photons on their own primitives and sides.
    #[inline(always)]
    fn side<L: Lanes>(&self, l: L, query: &Query<L>) -> (Group<L>, L::U) {
        let prim = l.select_u(query.asks, query.prim, l.u(0));
        self.surfaces.side(l, prim, (query.point, query.normal))
    }

    /// Sums for every lane.
    #[inline(always)]
    fn sums<L: Lanes>(&self, l: L, query: &Query<L>) -> Sums {
        let mut sums = [[0.0; 16]; 6];
        let border = self.surfaces.distance_to_border(l, query.asks, query.prim, query.point);
        let points = Points::new(l, query, self.side(l, query), border);
        let mut left = l.bitmask(query.asks);
        // Points of one packet mostly ask the same sub-map.
        while left != 0 {
            let tree = points.sub_maps[left.trailing_zeros() as usize % 16];
            let here = query.asks & l.eq_u(query.sub_map, l.u(tree));
            self.walk(l, query, here, &self.map.trees[tree as usize], &points, &mut sums);
            left &= !l.bitmask(here);
        }
        sums
    }

    /// Takes the lanes `asks` through a tree, to every leaf with a photon that may reach them.
    ///
    /// Where photons on both sides of a split may, one side waits: bit k of `waiting` is set when the sibling of the
    /// node's ancestor k levels up waits. So the whole stack of a lane is one number.
    #[inline(always)]
    fn walk<L: Lanes>(&self, l: L, query: &Query<L>, asks: L::M, tree: &Tree, points: &Points, sums: &mut Sums) {
        let leaves = tree.blocks.len() as u32;
        if leaves == 0 {
            return;
        }
        let (mut node, mut waiting, mut here) = (l.u(1), l.u(0), asks);
        while l.any(here) {
            let splits = here & l.lt_u(node, l.u(leaves));
            let mut ends = here & !splits;
            let mut left = l.bitmask(ends);
            if l.any(splits) {
                let (low, high) = tree.reached(l, l.select_u(splits, node, l.u(1)), query.point);
                let down = splits & (low | high);
                let first = l.select_u(low, l.u(0), l.u(1));
                let waits = l.select_u(low & high, l.u(1), l.u(0));
                node = l.select_u(down, l.shl::<1>(node) | first, node);
                waiting = l.select_u(down, l.shl::<1>(waiting) | waits, waiting);
                ends = ends | (splits & !down);
            }
            if !l.any(ends) {
                continue;
            }
            let mut nodes = [0; 16];
            l.store_u(node, &mut nodes);
            while left != 0 {
                let lane = left.trailing_zeros() as usize % 16;
                let leaf = (nodes[lane] - leaves) as usize;
                self.look(l, (tree, leaf), &points.lanes[lane], (sums, lane));
                left &= left - 1;
            }
            // Up to the lowest ancestor whose sibling waits, and over to it.
            let lowest = waiting & l.add_u(!waiting, l.u(1));
            let level = l.add_u(l.shr::<23>(l.bits(l.to_f(lowest))), l.u(127u32.wrapping_neg())) & l.u(31);
            here = here & !(ends & l.eq_u(lowest, l.u(0)));
            node = l.select_u(ends, l.shr_each(node, level) ^ l.u(1), node);
            waiting = l.select_u(ends, l.shr_each(waiting ^ lowest, level), waiting);
        }
    }

    /// Adds up the photons of a leaf that reach a point.
    #[inline(always)]
    fn look<L: Lanes>(&self, l: L, (tree, leaf): (&Tree, usize), point: &Point, (sums, lane): (&mut Sums, usize)) {
        let block = &tree.blocks[leaf];
        let (mut whole, mut half) = ([0.0; 3], [0.0; 3]);
        for first in (0..BLOCK).step_by(L::WIDTH) {
            let (mut seen, inner) = self.seen(l, block, first, point);
            while seen != 0 {
                let k = seen.trailing_zeros() as usize % 16;
                let [r, g, b, bounces] = tree.flux[leaf * BLOCK + first + k];
                if bounces.to_bits() <= self.most_bounces {
                    let [by_whole, by_half] = self.by_parts(point, block[4][first + k]);
                    let by_half = if inner >> k & 1 == 1 { by_half } else { 0.0 };
                    for (channel, flux) in [r, g, b].into_iter().enumerate() {
                        whole[channel] += f64::from(by_whole * flux);
                        half[channel] += f64::from(by_half * flux);
                    }
                }
                seen &= seen - 1;
            }
        }
        for channel in 0..3 {
            sums[channel][lane] += whole[channel];
            sums[3 + channel][lane] += half[channel];
        }
    }

    /// For a photon of this radius: a disc's area by that of it that lies on the surface about the point; and the same of
    /// half of the disc.
    #[inline(always)]
    fn by_parts(&self, point: &Point, radius: f32) -> [f32; 2] {
        if radius <= point.border || mutant!("edges_of_surfaces_darkened") {
            return [1.0, 2.0];
        }
        let place = V3::splat(One, point.place);
        let part = |radius: f32| self.surfaces.part_of_disc(One, true, point.own & Tag::PRIM, place, radius);
        [1.0 / part(radius), 2.0 / part(radius * FRAC_1_SQRT_2)]
    }

    /// Which of a leaf's photons from number `first` on reach a point, and which with the inner half of their disc (bits).
    #[inline(always)]
    fn seen<L: Lanes>(&self, l: L, [xs, ys, zs, tags, radii]: &Block, first: usize, point: &Point) -> (u64, u64) {
        let place = V3::new(l.load(&xs[first..]), l.load(&ys[first..]), l.load(&zs[first..]));
        let away = place - V3::splat(l, point.place);
        let (squared, radius) = (away.dot(l, away), l.load(&radii[first..]));
        let near = l.lt(squared, radius * radius);
        if !l.any(near) {
            return (0, 0);
        }
        let height = l.abs(away.dot(l, V3::splat(l, point.normal)));
        let flat = near & l.le(height, l.mul_add(radius, l.f(FLAT), l.f(point.slack)));
        let own = l.eq_u(l.bits(l.load(&tags[first..])), l.u(point.own));
        let mut seen = l.bitmask(flat & own);
        let mut others = l.bitmask(flat & !own);
        while others != 0 {
            let k = others.trailing_zeros() as usize % 16;
            let tag = Tag(tags[first + k].to_bits());
            let alike = self.surfaces.alike(One, tag, point.group, V3::splat(One, point.normal));
            seen |= u64::from(alike || mutant!("photons_of_other_surfaces")) << k;
            others &= others - 1;
        }
        (seen, l.bitmask(l.lt(squared, l.f(0.5) * radius * radius)))
    }
}

/// A point as it looks at photons.
#[derive(Clone, Copy, Default)]
struct Point {
    place: [f32; 3],
    normal: [f32; 3],
    /// The tag of photons on its own primitive and side.
    own: u32,
    /// Its surface.
    group: u32,
    /// Height above a disc that may be rounding of coordinates.
    slack: f32,
    /// Distance to the nearest border of its surface.
    border: f32,
}

/// The points of a packet, one by one.
struct Points {
    /// Lane by lane.
    lanes: [Point; 16],
    /// The tree that each asks.
    sub_maps: [u32; 16],
}

impl Points {
    /// The points of a query, on their surfaces and sides.
    #[inline(always)]
    fn new<L: Lanes>(l: L, query: &Query<L>, (group, own): (Group<L>, L::U), border: L::F) -> Self {
        let mut points = Self { lanes: [Point::default(); 16], sub_maps: [0; 16] };
        l.store_u(query.sub_map, &mut points.sub_maps);
        let (mut floats, mut words, [mut slacks, mut borders]) = ([[0.0; 16]; 6], [[0; 16]; 2], [[0.0; 16]; 2]);
        l.store(border, &mut borders);
        l.store(query.point.max_abs(l) * l.f(0.5 * LEAST_STEPS * STEP), &mut slacks);
        let values = [query.point.components(), query.normal.components()];
        for (column, value) in floats.iter_mut().zip(values.as_flattened()) {
            l.store(*value, column);
        }
        l.store_u(own, &mut words[0]);
        l.store_u(group.number, &mut words[1]);
        for (k, point) in points.lanes.iter_mut().enumerate() {
            *point = Point {
                place: [floats[0][k], floats[1][k], floats[2][k]],
                normal: [floats[3][k], floats[4][k], floats[5][k]],
                own: words[0][k],
                group: words[1][k],
                slack: slacks[k],
                border: borders[k],
            };
        }
        points
    }
}
