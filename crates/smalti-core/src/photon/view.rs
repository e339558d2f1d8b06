//! Photons by area where the map itself is seen: the points of a packet are neighbours in the picture, so they walk
//! down a tree together. A leaf that few of them have to look at, each of these looks at by itself, all photons at once;
//! at the others all points look together, photon by photon.
//!
//! A point adds the photons that count in the order of the tree, first within a leaf, then leaf by leaf in f64 (a disc
//! may hold very many): what its packet looks at besides, and how, changes no bit.

use super::gather::{FLAT, Gather, Points, Query};
use super::kd_tree::{BLOCK, Tree};
use super::surfaces::Group;
use super::{Quantity, Tag};
use crate::lanes::{Lanes, Rgb, V3};

/// Points up to this many look at a leaf one by one.
const FEW: u32 = 4;

/// What a lane has found, channel by channel.
type Sums = [[f64; 16]; 3];

/// A packet of points as it looks at photons.
struct Viewers<'a, L: Lanes> {
    query: &'a Query<L>,
    quantity: Quantity,
    points: Points,
    group: Group<L>,
    /// Tags of photons on the points' own primitives and sides.
    own: L::U,
    /// Squared radius.
    r2: L::F,
}

impl Gather<'_> {
    /// What `quantity` says of the photons at the points of a packet, by area.
    #[inline(always)]
    pub fn shown<L: Lanes>(&self, l: L, query: &Query<L>, quantity: Quantity) -> Rgb<L> {
        let [x, y, z] = &self.view(l, query, quantity).map(|sums| sums.map(|sum| sum as f32));
        let found = V3::new(l.load(x), l.load(y), l.load(z));
        let something = query.asks & l.lt(l.f(0.0), found.max_component(l));
        if !l.any(something) {
            return found;
        }
        let part = self.surfaces.part_of_disc(l, something, query.prim, query.point, query.radius);
        found.scale(l.f(core::f32::consts::FRAC_1_PI) / (query.radius * query.radius * part))
    }

    /// Sums over the trees that the points ask.
    #[inline(always)]
    fn view<L: Lanes>(&self, l: L, query: &Query<L>, quantity: Quantity) -> Sums {
        let (group, own) = self.side(l, query);
        let points = Points::new(l, query, (group, own));
        let viewers = Viewers { query, quantity, points, group, own, r2: query.radius * query.radius };
        let mut sums = [[0.0; 16]; 3];
        let mut left = l.bitmask(query.asks);
        while left != 0 {
            let tree = viewers.points.sub_maps[left.trailing_zeros() as usize % 16];
            let here = query.asks & l.eq_u(query.sub_map, l.u(tree));
            self.walk_together(l, (&viewers, here), &self.map.trees[tree as usize], &mut sums);
            left &= !l.bitmask(here);
        }
        sums
    }

    /// Takes the lanes `asks` through a tree, from left to right, to every leaf that one of them has to look at.
    #[inline(always)]
    fn walk_together<L: Lanes>(&self, l: L, (viewers, asks): (&Viewers<'_, L>, L::M), tree: &Tree, sums: &mut Sums) {
        let leaves = tree.blocks.len();
        if leaves == 0 {
            return;
        }
        // One right child for each node above, with the lanes that have to look below.
        let (mut waiting, mut count) = ([(0, asks); usize::BITS as usize], 0);
        let (mut node, mut here) = (1, asks);
        loop {
            if node < leaves {
                let [left, right] = viewers.sides(l, here, tree.splits[node - 1]);
                let go_left = l.any(left);
                if go_left && l.any(right) {
                    waiting[count] = (2 * node + 1, right);
                    count += 1;
                }
                (node, here) = if go_left { (2 * node, left) } else { (2 * node + 1, right) };
                continue;
            }
            let leaf = (tree, node - leaves);
            if l.bitmask(here).count_ones() <= FEW {
                self.view_leaf_alone(l, (viewers, here), leaf, sums);
            } else {
                self.view_leaf(l, (viewers, here), leaf, sums);
            }
            if count == 0 {
                break;
            }
            count -= 1;
            (node, here) = waiting[count];
        }
    }

    /// Looks at the photons of a leaf from each of the points `asks`.
    #[inline(always)]
    fn view_leaf_alone<L: Lanes>(
        &self,
        l: L,
        (viewers, asks): (&Viewers<'_, L>, L::M),
        (tree, leaf): (&Tree, usize),
        sums: &mut Sums,
    ) {
        let mut left = l.bitmask(asks);
        while left != 0 {
            let lane = left.trailing_zeros() as usize % 16;
            let mut found = [0.0; 3];
            for first in (0..BLOCK).step_by(L::WIDTH) {
                let (mut seen, _) = self.seen(l, &tree.blocks[leaf], first, &viewers.points.lanes[lane]);
                while seen != 0 {
                    let at = leaf * BLOCK + first + seen.trailing_zeros() as usize % 16;
                    let what = self.says(tree.flux[at], viewers.quantity);
                    (0..3).for_each(|k| found[k] += what[k]);
                    seen &= seen - 1;
                }
            }
            (0..3).for_each(|k| sums[k][lane] += f64::from(found[k]));
            left &= left - 1;
        }
    }

    /// Looks at the photons of a leaf from all points.
    #[inline(always)]
    fn view_leaf<L: Lanes>(
        &self,
        l: L,
        (viewers, asks): (&Viewers<'_, L>, L::M),
        (tree, leaf): (&Tree, usize),
        sums: &mut Sums,
    ) {
        let [xs, ys, zs, tags] = &tree.blocks[leaf];
        let photons = xs.iter().zip(ys).zip(zs).zip(tags).zip(&tree.flux[leaf * BLOCK..]);
        let (mut found, mut something) = (V3::splat(l, [0.0; 3]), false);
        for ((((x, y), z), tag), flux) in photons {
            let away = V3::splat(l, [*x, *y, *z]) - viewers.query.point;
            let near = asks & l.lt(away.dot(l, away), viewers.r2);
            if !l.any(near) {
                continue;
            }
            let height = l.abs(away.dot(l, viewers.query.normal));
            let flat = near & l.le(height, viewers.query.radius * l.f(FLAT));
            let mut seen = flat & l.eq_u(viewers.own, l.u(tag.to_bits()));
            let others = flat & !seen;
            if l.any(others) {
                let normal = viewers.query.normal;
                seen = seen | (others & self.surfaces.alike(l, Tag(tag.to_bits()), viewers.group.number, normal));
            }
            let what = self.says(*flux, viewers.quantity).map(
                #[inline(always)]
                |x| l.keep(seen, l.f(x)),
            );
            found = found + V3::new(what[0], what[1], what[2]);
            something = true;
        }
        if something {
            let mut columns = [[0.0; 16]; 3];
            l.store(found.x, &mut columns[0]);
            l.store(found.y, &mut columns[1]);
            l.store(found.z, &mut columns[2]);
            for (sum, more) in sums.as_flattened_mut().iter_mut().zip(columns.as_flattened()) {
                *sum += f64::from(*more);
            }
        }
    }

    /// What `quantity` says of a photon.
    #[inline(always)]
    fn says(&self, [r, g, b, bounces]: [f32; 4], quantity: Quantity) -> [f32; 3] {
        let bounces = bounces.to_bits();
        match quantity {
            _ if bounces > self.most_bounces => [0.0; 3],
            Quantity::Radiance => [r, g, b],
            Quantity::Count => [bounces as f32, 1.0, 0.0],
        }
    }
}

impl<L: Lanes> Viewers<'_, L> {
    /// The lanes of `asks` that have to look below a split on its left, and on its right.
    #[inline(always)]
    fn sides(&self, l: L, asks: L::M, [split, axis]: [f32; 2]) -> [L::M; 2] {
        let place = self.query.point.components()[axis.to_bits() as usize % 3];
        let along = l.f(split) - place;
        let near = l.lt(along * along, self.r2);
        [asks & (near | l.le(l.f(0.0), along)), asks & (near | l.le(along, l.f(0.0)))]
    }
}
