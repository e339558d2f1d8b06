//! A tree of boxes with eight children a node, for one ray at a time: eight boxes or eight triangles in one go.
//!
//! It finds exactly what the [`list`](super::list) finds. The arithmetic on faces is the same; a box test is monotone in
//! the box; a distance that grazes is clamped to its face's box, and any other is off by less than
//! [`SLACK`](super::SLACK), by which the search looks past the nearest hit. Ties go to the lower primitive number.

mod build;
mod leaf;
mod search;

pub use build::build;
use leaf::{Packet, Single};

/// Children of a node.
const WIDTH: usize = 8;

/// In a child reference: a leaf, whose number is in the other bits.
const LEAF: u32 = 1 << 31;

/// A node: the boxes of its children, axis by axis, and what they are.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
struct Node {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
    children: [u32; WIDTH],
}

/// Primitives of a leaf: triangles together, the rest one by one.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    /// Number of the packet of triangles, if there is one.
    packet: Option<u32>,
    /// Range of singles.
    singles: (u32, u32),
}

/// The tree.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    packets: Vec<Packet>,
    singles: Vec<Single>,
    low: [f32; 3],
    high: [f32; 3],
    prims: usize,
}

impl Tree {
    /// Number of primitives in it.
    pub fn len(&self) -> usize {
        self.prims
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        self.prims == 0
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> u64 {
        (self.nodes.len() * size_of::<Node>()
            + self.leaves.len() * size_of::<Leaf>()
            + self.packets.len() * size_of::<Packet>()
            + self.singles.len() * size_of::<Single>()) as u64
    }
}
