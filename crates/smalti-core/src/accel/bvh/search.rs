//! One ray through the tree.

use super::{LEAF, Leaf, Node, Tree, WIDTH};
use crate::accel::SLACK;
use crate::geometry::{Lone, Ray, polygon};
use crate::lanes::{Lanes, V3};

/// A ray prepared for the tree.
struct Probe<L: Lanes> {
    l: L,
    ray: Ray<L>,
    inverse: V3<L>,
    around: [V3<L>; 2],
    /// How far past the nearest hit the search looks, in units of the direction.
    slack: f32,
    /// What rounding can make of two box distances.
    rounding: L::F,
}

/// Subtrees still to be searched: where their box begins, and their reference.
pub type Stack = Vec<(f32, u32)>;

impl<L: Lanes> Probe<L> {
    #[inline(always)]
    fn new(l: L, lone: &Lone) -> Self {
        let (origin, direction) = (V3::splat(l, lone.origin), V3::splat(l, lone.direction));
        let largest = |v: [f32; 3]| v[0].abs().max(v[1].abs()).max(v[2].abs());
        let unit = largest(lone.origin).max(1.0) / largest(lone.direction);
        Self {
            l,
            ray: Ray::new(l, origin, direction, l.u(lone.leaves)),
            inverse: polygon::inverse_direction(l, direction),
            around: polygon::around(l, origin),
            slack: unit * SLACK,
            rounding: l.f(unit / 1_048_576.0),
        }
    }

    /// Where the boxes of a node begin, and which of them the ray meets before `limit`.
    #[inline(always)]
    fn boxes(&self, node: &Node, limit: f32) -> ([f32; WIDTH], u64) {
        let l = self.l;
        let corner = |side: &[[f32; WIDTH]; 3]| V3::<L>::new(l.load(&side[0]), l.load(&side[1]), l.load(&side[2]));
        let (near, far) = polygon::slab(l, self.around, self.inverse, corner(&node.low), corner(&node.high));
        let met = l.le(near, far + self.rounding) & l.le(near, l.f(limit + self.slack)) & l.le(l.f(-self.slack), far);
        let mut begins = [0.0; WIDTH];
        l.store(near, &mut begins);
        (begins, l.bitmask(met))
    }
}

impl Tree {
    /// Nearest hit, where it is nearer than `best` (distance, primitive) or as near with a lower number.
    #[inline(always)]
    pub fn nearest<L: Lanes>(&self, l: L, lone: &Lone, mut best: (f32, u32), stack: &mut Stack) -> (f32, u32) {
        let probe = Probe::new(l, lone);
        stack.clear();
        stack.push((f32::NEG_INFINITY, 0));
        while let Some((begins, reference)) = stack.pop() {
            if begins > best.0 + probe.slack {
                continue;
            }
            if reference & LEAF != 0 {
                best = self.nearest_in(&probe, lone, &self.leaves[(reference & !LEAF) as usize], best);
                continue;
            }
            let node = &self.nodes[reference as usize];
            let (begins, met) = probe.boxes(node, best.0);
            push_by_distance(stack, &begins, &node.children, met);
        }
        best
    }

    /// Whether something that is not `target` stops the ray in (0, 1).
    #[inline(always)]
    pub fn occluded<L: Lanes>(&self, l: L, lone: &Lone, target: u32, stack: &mut Stack) -> bool {
        let probe = Probe::new(l, lone);
        stack.clear();
        stack.push((f32::NEG_INFINITY, 0));
        while let Some((_, reference)) = stack.pop() {
            if reference & LEAF != 0 {
                if self.occluded_in(&probe, lone, &self.leaves[(reference & !LEAF) as usize], target) {
                    return true;
                }
                continue;
            }
            let node = &self.nodes[reference as usize];
            let (begins, met) = probe.boxes(node, 1.0);
            push_by_distance(stack, &begins, &node.children, met);
        }
        false
    }

    #[inline(always)]
    fn nearest_in<L: Lanes>(&self, probe: &Probe<L>, lone: &Lone, leaf: &Leaf, mut best: (f32, u32)) -> (f32, u32) {
        if let Some(packet) = leaf.packet {
            let packet = &self.packets[packet as usize];
            let (t, hits) = packet.hits(probe.l, &probe.ray, best.0, crate::light::table::NO_SURFACE);
            let mut distances = [0.0; WIDTH];
            probe.l.store(t, &mut distances);
            let mut left = probe.l.bitmask(hits);
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                best = nearer(best, (distances[lane], packet.prim(lane)));
                left &= left - 1;
            }
        }
        for single in &self.singles[leaf.singles.0 as usize..leaf.singles.1 as usize] {
            best = nearer(best, single.nearest(&lone.ray()));
        }
        best
    }

    #[inline(always)]
    fn occluded_in<L: Lanes>(&self, probe: &Probe<L>, lone: &Lone, leaf: &Leaf, target: u32) -> bool {
        let l = probe.l;
        let by_triangle = leaf.packet.is_some_and(
            #[inline(always)]
            |packet| {
                let (t, hits) = self.packets[packet as usize].hits(l, &probe.ray, 1.0, target);
                l.any(hits & l.lt(t, l.f(1.0)))
            },
        );
        by_triangle
            || self.singles[leaf.singles.0 as usize..leaf.singles.1 as usize]
                .iter()
                .any(|single| single.occludes(&lone.ray(), target))
    }

    /// Lanes whose ray meets the whole tree's box before `limit`.
    #[inline(always)]
    pub fn meets<L: Lanes>(&self, l: L, ray: &Ray<L>, limit: L::F) -> L::M {
        let inverse = polygon::inverse_direction(l, ray.direction);
        let (near, far) =
            polygon::slab(l, polygon::around(l, ray.origin), inverse, V3::splat(l, self.low), V3::splat(l, self.high));
        let unit = l.max(ray.origin.max_abs(l), l.f(1.0)) / ray.major;
        let slack = unit * l.f(SLACK);
        l.le(near, far + unit * l.f(1.0 / 1_048_576.0)) & l.le(near, limit + slack) & l.le(-slack, far)
    }
}

/// The nearer of two hits; at the same distance the one of the lower primitive.
fn nearer(a: (f32, u32), b: (f32, u32)) -> (f32, u32) {
    if b.0 < a.0 || (b.0 == a.0 && b.1 < a.1) { b } else { a }
}

/// Pushes the children of `met` so that the nearest is popped first.
#[inline(always)]
fn push_by_distance(stack: &mut Stack, begins: &[f32; WIDTH], children: &[u32; WIDTH], mut met: u64) {
    let bottom = stack.len();
    while met != 0 {
        let child = met.trailing_zeros() as usize % WIDTH;
        let entry = (begins[child], children[child]);
        let mut at = stack.len();
        stack.push(entry);
        while at > bottom && stack[at - 1].0 < entry.0 {
            stack[at] = stack[at - 1];
            at -= 1;
        }
        stack[at] = entry;
        met &= met - 1;
    }
}
