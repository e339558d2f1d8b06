//! Irradiance from the photons within a radius: the query of a photon map, many at a time.
//!
//! E(x) ≈ Σ φ / A over the photons on x's own surface and side that are nearer than r, with A the part of the disc πr²
//! that lies on the surface (report eq. 14 without the BSDF; Jensen 1996 divides by the whole disc, which darkens
//! edges). As photons of other surfaces, of the other side and from above a flattened disc do not count, nothing leaks
//! through thin walls or around corners.
//!
//! A packet of points walks down a tree together, lane by lane; a point that comes to a leaf looks at all photons of the
//! leaf at once. What counts is added photon by photon, in the order of the tree: no width can change a bit. (Where a map
//! itself is seen, all points of a packet look together: [`view`](super::view).)

use super::kd_tree::{BLOCK, Block, Tree};
use super::surfaces::Group;
use super::{Map, Surfaces, Tag};
use crate::lanes::{Lanes, One, Rgb, V3};
use crate::mutant::mutant;

/// Photons this much of the radius above or below the disc do not count.
pub const FLAT: f32 = 0.25;

/// Points that ask a map.
pub struct Query<L: Lanes> {
    /// Where.
    pub point: V3<L>,
    /// Unit normal on the side that asks.
    pub normal: V3<L>,
    /// The primitive.
    pub prim: L::U,
    /// Lanes that ask.
    pub asks: L::M,
    /// Which of the map's trees.
    pub sub_map: L::U,
    /// How far photons count.
    pub radius: L::F,
}

/// What was found.
#[derive(Clone, Copy)]
pub struct Found<L: Lanes> {
    /// Irradiance.
    pub irradiance: Rgb<L>,
    /// Irradiance from half of the disc's area: what its difference from the whole says of the bias.
    pub inner: Rgb<L>,
}

/// A map with what it takes to ask it.
#[derive(Clone, Copy)]
pub struct Gather<'a> {
    /// The photons.
    pub map: &'a Map,
    /// The surfaces that they lie on.
    pub surfaces: &'a Surfaces,
    /// Most scattering events before a photon was stored.
    pub most_bounces: u32,
}

/// Flux of a lane's photons: of those that count, and of those in the inner half. In f64: a disc may hold very many.
type Sums = [[f64; 16]; 6];

impl Gather<'_> {
    /// Irradiance at the points of a packet.
    #[inline(always)]
    pub fn irradiance<L: Lanes>(&self, l: L, query: &Query<L>) -> Found<L> {
        let [r, g, b, inner_r, inner_g, inner_b] = &self.sums(l, query).map(|sums| sums.map(|sum| sum as f32));
        let irradiance = V3::new(l.load(r), l.load(g), l.load(b));
        let found = Found { irradiance, inner: V3::new(l.load(inner_r), l.load(inner_g), l.load(inner_b)) };
        let something = query.asks & l.lt(l.f(0.0), found.irradiance.max_component(l));
        if !l.any(something) {
            return found;
        }
        let Query { point, prim, .. } = *query;
        let (radius, small) = (query.radius, query.radius * l.f(core::f32::consts::FRAC_1_SQRT_2));
        let part = self.surfaces.part_of_disc(l, something, prim, point, radius);
        let cut = something & l.lt(part, l.f(1.0));
        let inner_part = if l.any(cut) { self.surfaces.part_of_disc(l, cut, prim, point, small) } else { l.f(1.0) };
        let part = if mutant!("edges_of_surfaces_darkened") { l.f(1.0) } else { part };
        let squared = if mutant!("gather_radius_not_squared") { radius } else { radius * radius };
        let (whole, half) = (squared * part, small * small * inner_part);
        let by = l.f(core::f32::consts::FRAC_1_PI);
        Found { irradiance: found.irradiance.scale(by / whole), inner: found.inner.scale(by / half) }
    }

    /// The surfaces that the points lie on, and the tags of photons on their own primitives and sides.
    #[inline(always)]
    pub fn side<L: Lanes>(&self, l: L, query: &Query<L>) -> (Group<L>, L::U) {
        let prim = l.select_u(query.asks, query.prim, l.u(0));
        self.surfaces.side(l, prim, (query.point, query.normal))
    }

    /// Sums for every lane.
    #[inline(always)]
    fn sums<L: Lanes>(&self, l: L, query: &Query<L>) -> Sums {
        let mut sums = [[0.0; 16]; 6];
        let points = Points::new(l, query, self.side(l, query));
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

    /// Takes the lanes `asks` through a tree.
    ///
    /// Where both sides of a split are near enough, one waits: bit k of `waiting` is set when the sibling of the node's
    /// ancestor k levels up waits. So the whole stack of a lane is one number.
    #[inline(always)]
    fn walk<L: Lanes>(&self, l: L, query: &Query<L>, asks: L::M, tree: &Tree, points: &Points, sums: &mut Sums) {
        let leaves = tree.blocks.len() as u32;
        if leaves == 0 {
            return;
        }
        let r2 = query.radius * query.radius;
        let (mut node, mut waiting, mut here) = (l.u(1), l.u(0), asks);
        while l.any(here) {
            let down = here & l.lt_u(node, l.u(leaves));
            if l.any(down) {
                let (child, along) = tree.child(l, l.select_u(down, node, l.u(1)), query.point);
                let waits = l.select_u(l.lt(along * along, r2), l.u(1), l.u(0));
                node = l.select_u(down, child, node);
                waiting = l.select_u(down, l.shl::<1>(waiting) | waits, waiting);
            }
            let at_leaf = here & !l.lt_u(node, l.u(leaves));
            let mut left = l.bitmask(at_leaf);
            if left == 0 {
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
            here = here & !(at_leaf & l.eq_u(lowest, l.u(0)));
            node = l.select_u(at_leaf, l.shr_each(node, level) ^ l.u(1), node);
            waiting = l.select_u(at_leaf, l.shr_each(waiting ^ lowest, level), waiting);
        }
    }

    /// Looks at the photons of a leaf from one point.
    #[inline(always)]
    fn look<L: Lanes>(&self, l: L, (tree, leaf): (&Tree, usize), point: &Point, (sums, lane): (&mut Sums, usize)) {
        let (mut whole, mut half) = ([0.0; 3], [0.0; 3]);
        for first in (0..BLOCK).step_by(L::WIDTH) {
            let (mut seen, squared) = self.seen(l, &tree.blocks[leaf], first, point);
            let inner = l.bitmask(l.lt(squared, l.f(0.5 * point.radius * point.radius)));
            while seen != 0 {
                let k = seen.trailing_zeros() as usize % 16;
                let inner = if inner >> k & 1 == 1 { 1.0 } else { 0.0 };
                let [r, g, b, bounces] = tree.flux[leaf * BLOCK + first + k];
                if bounces.to_bits() <= self.most_bounces {
                    for (channel, flux) in [r, g, b].into_iter().enumerate() {
                        whole[channel] += f64::from(flux);
                        half[channel] += inner * f64::from(flux);
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

    /// Which of a leaf's photons from number `first` on a point sees (bits), and how far each is, squared.
    #[inline(always)]
    pub fn seen<L: Lanes>(&self, l: L, [xs, ys, zs, tags]: &Block, first: usize, point: &Point) -> (u64, L::F) {
        let place = V3::new(l.load(&xs[first..]), l.load(&ys[first..]), l.load(&zs[first..]));
        let away = place - V3::splat(l, point.place);
        let squared = away.dot(l, away);
        let near = l.lt(squared, l.f(point.radius * point.radius));
        if !l.any(near) {
            return (0, squared);
        }
        let height = l.abs(away.dot(l, V3::splat(l, point.normal)));
        let flat = near & l.le(height, l.f(point.radius * FLAT));
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
        (seen, squared)
    }
}

/// A point as it looks at photons.
#[derive(Clone, Copy, Default)]
pub struct Point {
    place: [f32; 3],
    normal: [f32; 3],
    /// The tag of photons on its own primitive and side.
    own: u32,
    /// Its surface.
    group: u32,
    /// How far photons count.
    radius: f32,
}

/// The points of a packet, one by one.
pub struct Points {
    /// Lane by lane.
    pub lanes: [Point; 16],
    /// The tree that each asks.
    pub sub_maps: [u32; 16],
}

impl Points {
    /// The points of a query, on their surfaces and sides.
    #[inline(always)]
    pub fn new<L: Lanes>(l: L, query: &Query<L>, (group, own): (Group<L>, L::U)) -> Self {
        let mut points = Self { lanes: [Point::default(); 16], sub_maps: [0; 16] };
        l.store_u(query.sub_map, &mut points.sub_maps);
        let (mut floats, mut words, mut radii) = ([[0.0; 16]; 6], [[0; 16]; 2], [0.0; 16]);
        l.store(query.radius, &mut radii);
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
                radius: radii[k],
            };
        }
        points
    }
}
