//! Building: binned surface area heuristic (Wald 2007), straight into nodes of eight. Large subtrees are built in
//! parallel; what comes out does not depend on the threads.

use rayon::prelude::*;

use super::{LEAF, Leaf, Node, Packet, Single, Tree, WIDTH};
use crate::scene::Scene;

/// Bins along the axis of a split.
const BINS: usize = 16;

/// Below this many primitives a subtree is built by one thread.
const PARALLEL: usize = 4096;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: [f32; 3],
    high: [f32; 3],
}

/// A primitive as the builder sees it.
#[derive(Clone, Copy, Debug)]
struct Item {
    bounds: Bounds,
    prim: u32,
}

/// A subtree before it is laid out.
enum Branch {
    Leaf(Vec<u32>),
    Inner(Vec<(Bounds, Branch)>),
}

/// The tree of these primitives.
pub fn build(scene: &Scene, prims: impl IntoIterator<Item = u32>) -> Tree {
    let bounded = |prim| {
        let (low, high) = scene.bounds(prim);
        Item { bounds: Bounds { low, high }, prim }
    };
    let mut items: Vec<Item> = prims.into_iter().map(bounded).collect();
    let mut tree = Tree { prims: items.len(), ..Tree::default() };
    let whole = around(&items);
    (tree.low, tree.high) = (whole.low, whole.high);
    if !items.is_empty() {
        let root = branch(&mut items, true);
        let root = match root {
            leaf @ Branch::Leaf(_) => Branch::Inner(vec![(whole, leaf)]),
            inner => inner,
        };
        lay_out(scene, &mut tree, root);
    }
    tree
}

/// The subtree of `items`; reorders them.
fn branch(items: &mut [Item], may_be_leaf: bool) -> Branch {
    if may_be_leaf && items.len() <= WIDTH {
        let mut prims: Vec<u32> = items.iter().map(|item| item.prim).collect();
        prims.sort_unstable();
        return Branch::Leaf(prims);
    }
    let parallel = items.len() >= PARALLEL;
    let parts = eight_parts(items);
    let grow = |part: &mut [Item]| (around(part), branch(part, true));
    Branch::Inner(if parallel {
        parts.into_par_iter().map(grow).collect()
    } else {
        parts.into_iter().map(grow).collect()
    })
}

/// Splits the part with the largest area × count until there are eight, or each fits a leaf.
fn eight_parts(items: &mut [Item]) -> Vec<&mut [Item]> {
    let mut parts = vec![items];
    while parts.len() < WIDTH {
        let cost = |part: &[Item]| if part.len() <= WIDTH { 0.0 } else { around(part).area() * part.len() as f32 };
        let costs: Vec<f32> = parts.iter().map(|part| cost(part)).collect();
        let worst = (0..parts.len()).reduce(|a, b| if costs[b] > costs[a] { b } else { a }).unwrap_or(0);
        if parts[worst].len() <= WIDTH {
            match parts.iter().position(|part| part.len() > WIDTH) {
                // Costs of 0 for parts without area: split them all the same.
                Some(flat) => split_part(&mut parts, flat),
                None => break,
            }
        } else {
            split_part(&mut parts, worst);
        }
    }
    parts
}

fn split_part(parts: &mut Vec<&mut [Item]>, which: usize) {
    let part = core::mem::take(&mut parts[which]);
    let middle = partition(part);
    let (left, right) = part.split_at_mut(middle);
    parts[which] = left;
    parts.insert(which + 1, right);
}

/// Reorders the items into two groups, neither empty, and returns the length of the first.
fn partition(items: &mut [Item]) -> usize {
    let centres = centre_bounds(items);
    match best_split(items, &centres) {
        Some((axis, bin)) => {
            let of = Binning::new(&centres, axis);
            let mut sorted: Vec<Item> = items.iter().copied().filter(|item| of.bin(item) < bin).collect();
            let middle = sorted.len();
            sorted.extend(items.iter().copied().filter(|item| of.bin(item) >= bin));
            items.copy_from_slice(&sorted);
            middle
        }
        // All centres in one place: any halves will do.
        None => items.len() / 2,
    }
}

/// Axis and first bin of the right side with the least area × count, where some split exists.
fn best_split(items: &[Item], centres: &Bounds) -> Option<(usize, usize)> {
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        if centres.high[axis] <= centres.low[axis] {
            continue;
        }
        let of = Binning::new(centres, axis);
        let mut bins = [(Bounds::EMPTY, 0usize); BINS];
        for item in items {
            let (bounds, count) = &mut bins[of.bin(item)];
            *bounds = bounds.union(&item.bounds);
            *count += 1;
        }
        for (split, cost) in costs(&bins) {
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, split));
            }
        }
    }
    best.map(|(_, axis, split)| (axis, split))
}

/// Cost of every split that leaves both sides occupied.
fn costs(bins: &[(Bounds, usize); BINS]) -> impl Iterator<Item = (usize, f32)> {
    let mut right_costs = [0.0; BINS];
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    for split in (1..BINS).rev() {
        bounds = bounds.union(&bins[split].0);
        count += bins[split].1;
        right_costs[split] = if count == 0 { f32::INFINITY } else { bounds.area() * count as f32 };
    }
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    let mut found = Vec::with_capacity(BINS);
    for split in 1..BINS {
        bounds = bounds.union(&bins[split - 1].0);
        count += bins[split - 1].1;
        if count > 0 && right_costs[split] < f32::INFINITY {
            found.push((split, bounds.area() * count as f32 + right_costs[split]));
        }
    }
    found.into_iter()
}

/// Which bin an item falls into.
struct Binning {
    axis: usize,
    low: f32,
    scale: f32,
}

impl Binning {
    fn new(centres: &Bounds, axis: usize) -> Self {
        let extent = centres.high[axis] - centres.low[axis];
        Self { axis, low: centres.low[axis], scale: BINS as f32 / extent }
    }

    fn bin(&self, item: &Item) -> usize {
        (((item.bounds.centre(self.axis) - self.low) * self.scale) as usize).min(BINS - 1)
    }
}

fn around(items: &[Item]) -> Bounds {
    items.iter().fold(Bounds::EMPTY, |so_far, item| so_far.union(&item.bounds))
}

fn centre_bounds(items: &[Item]) -> Bounds {
    items.iter().fold(Bounds::EMPTY, |so_far, item| {
        let centre = [0, 1, 2].map(|axis| item.bounds.centre(axis));
        so_far.union(&Bounds { low: centre, high: centre })
    })
}

impl Bounds {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn union(&self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(other.high[k])),
        }
    }

    /// Half the surface; 0 for an empty box.
    fn area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|k| (self.high[k] - self.low[k]).max(0.0));
        x * y + y * z + z * x
    }

    fn centre(&self, axis: usize) -> f32 {
        0.5 * (self.low[axis] + self.high[axis])
    }
}

/// Appends the branch to the tree's tables, parents before children; returns its node number.
fn lay_out(scene: &Scene, tree: &mut Tree, branch: Branch) -> u32 {
    match branch {
        Branch::Leaf(prims) => {
            let number = tree.leaves.len() as u32;
            let leaf = leaf(scene, tree, &prims);
            tree.leaves.push(leaf);
            number | LEAF
        }
        Branch::Inner(children) => {
            let number = tree.nodes.len();
            tree.nodes.push(Node {
                // No ray meets a box of NaNs: every comparison with it is false.
                low: [[f32::NAN; WIDTH]; 3],
                high: [[f32::NAN; WIDTH]; 3],
                children: [0; WIDTH],
            });
            for (slot, (bounds, child)) in children.into_iter().enumerate() {
                for axis in 0..3 {
                    tree.nodes[number].low[axis][slot] = bounds.low[axis];
                    tree.nodes[number].high[axis][slot] = bounds.high[axis];
                }
                let child = lay_out(scene, tree, child);
                tree.nodes[number].children[slot] = child;
            }
            number as u32
        }
    }
}

fn leaf(scene: &Scene, tree: &mut Tree, prims: &[u32]) -> Leaf {
    let is_triangle = |prim: &u32| scene.faces.get(*prim as usize).is_some_and(|face| face.count == 3);
    let (triangles, others): (Vec<u32>, Vec<u32>) = prims.iter().partition(|prim| is_triangle(prim));
    let first = tree.singles.len() as u32;
    tree.singles.extend(others.iter().map(|&prim| Single::new(scene, prim)));
    let packet = (!triangles.is_empty()).then(|| {
        tree.packets.push(Packet::new(scene, &triangles));
        tree.packets.len() as u32 - 1
    });
    Leaf { packet, singles: (first, tree.singles.len() as u32) }
}
