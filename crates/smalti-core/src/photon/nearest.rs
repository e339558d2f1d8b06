//! The photons nearest to a point.

use super::kd_tree::{BLOCK, Tree};

/// How far a photon is, squared, and its number in the tree.
pub type Neighbour = (f32, usize);

/// The `count` photons of a tree that are nearest to `point` among those whose tag `counts`, nearest first; of equal
/// distances the lower number. All of them when there are fewer.
pub fn nearest(tree: &Tree, point: [f32; 3], count: usize, counts: impl Fn(u32) -> bool) -> Vec<Neighbour> {
    let mut found = Vec::with_capacity(count + 1);
    let leaves = tree.blocks.len();
    // Nodes to look at, with the squared distance to their side of the split.
    let mut waiting = vec![(1, 0.0f32)];
    while let Some((node, side)) = waiting.pop() {
        if count == 0 || leaves == 0 || (found.len() == count && farthest(&found) < side) {
            continue;
        }
        if node < leaves {
            let [split, axis] = tree.splits[node - 1];
            let along = split - point[axis.to_bits() as usize];
            let near = 2 * node + usize::from(along < 0.0);
            waiting.extend([(near ^ 1, along * along), (near, side)]);
            continue;
        }
        for at in (node - leaves) * BLOCK..(node - leaves + 1) * BLOCK {
            if let Some(([x, y, z, _], _)) = tree.photon(at).filter(|(place, _)| counts(place[3].to_bits())) {
                let away = [x - point[0], y - point[1], z - point[2]];
                insert(&mut found, (away.iter().map(|d| d * d).sum(), at), count);
            }
        }
    }
    found
}

fn farthest(found: &[Neighbour]) -> f32 {
    found.last().map_or(f32::INFINITY, |last| last.0)
}

/// Keeps the `count` nearest in order.
fn insert(found: &mut Vec<Neighbour>, photon: Neighbour, count: usize) {
    let at = found.partition_point(|other| *other < photon);
    if at < count {
        found.insert(at, photon);
        found.truncate(count);
    }
}
