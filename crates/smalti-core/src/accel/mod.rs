//! Finding what a ray hits: a [`list`] of everything for many rays at a time, a [`bvh`] for one ray at a time, or both
//! together. However the primitives are divided between them, the bits are the same: the nearest hit, at equal distance
//! the one of the lowest primitive number.

pub mod bvh;
pub mod cones;
pub mod list;
pub mod occluders;

use crate::geometry::Ray;
use crate::geometry::lone::Unpacked;
use crate::lanes::Lanes;
use crate::scene::{Origin, Scene};
use bvh::Tree;
pub use list::List;

/// No primitive.
pub const MISS: u32 = u32::MAX;

/// How far a distance that does not graze can be off, in the scene's frame (coordinates in [-1, 1]) and relative to the
/// origin's distance: the tree visits boxes that begin this much behind the nearest hit.
pub const SLACK: f32 = 1.0 / 8192.0;

/// Most primitives that are tested one after the other. Measured on scattered spheres and separate triangles over a
/// floor (AVX-512): the tree takes 5.5 and 3.2 times the list's time with 30 of them, 3.5 with 120 spheres, 2.9 with 78
/// triangles. The lists end where corners no longer fit 8 bits, before the tree wins.
pub const LIST_UP_TO: usize = 128;

/// Some primitives of a scene, ready to be hit.
#[derive(Clone, Debug)]
pub struct Accel {
    /// Those tested for many rays at a time.
    pub list: List,
    /// The others.
    pub tree: Option<Tree>,
}

impl Accel {
    /// Divides the primitives: all in the list while they are few; of many, the triangles of meshes in the tree, and
    /// what was declared one by one (the walls around the mesh: large, and hit by most rays) in the list while it fits.
    pub fn new(scene: &Scene, prims: &[u32]) -> Self {
        let of_mesh = |prim: &u32| matches!(scene.origins[*prim as usize], Origin::Mesh(..));
        let few = |some: &[u32]| (some.len() <= LIST_UP_TO).then(|| List::new(scene, some.iter().copied())).flatten();
        if let Some(list) = few(prims) {
            return Self { list, tree: None };
        }
        let (meshes, declared): (Vec<u32>, Vec<u32>) = prims.iter().partition(|prim| of_mesh(prim));
        match few(&declared) {
            Some(list) => Self { list, tree: Some(bvh::build(scene, meshes)) },
            None => Self { list: List::default(), tree: Some(bvh::build(scene, prims.iter().copied())) },
        }
    }

    /// Everything in a tree: for comparisons with the list.
    pub fn tree_only(scene: &Scene, prims: &[u32]) -> Self {
        Self { list: List::default(), tree: Some(bvh::build(scene, prims.iter().copied())) }
    }

    /// Number of primitives.
    pub fn len(&self) -> usize {
        self.list.len() + self.tree.as_ref().map_or(0, Tree::len)
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A stage's view of an accelerator: its buffers, and the two questions.
pub struct Tracer<'a, L: Lanes> {
    list: Option<list::Tracer<'a, L>>,
    tree: Option<&'a Tree>,
    stack: Vec<(f32, u32)>,
}

impl<'a, L: Lanes> Tracer<'a, L> {
    /// For one stream.
    #[inline(always)]
    pub fn new(l: L, accel: &'a Accel) -> Self {
        let list = if accel.list.is_empty() { None } else { Some(list::Tracer::new(l, &accel.list)) };
        Self { list, tree: accel.tree.as_ref(), stack: Vec::new() }
    }

    /// Nearest hit in (0, ∞) of the lanes `lanes`: distance and primitive ([`MISS`] and ∞ for none).
    #[inline(always)]
    pub fn nearest(&mut self, l: L, ray: &Ray<L>, lanes: L::M) -> (L::F, L::U) {
        let (mut t, mut prim) = (l.f(f32::INFINITY), l.u(MISS));
        if let Some(list) = &mut self.list {
            (t, prim) = list.nearest(l, ray);
        }
        if let Some(tree) = self.tree {
            let asks = lanes & tree.meets(l, ray, t);
            let rays = Unpacked::new(l, ray);
            let (mut distances, mut prims) = ([0.0; 16], [0; 16]);
            l.store(t, &mut distances);
            l.store_u(prim, &mut prims);
            let mut left = l.bitmask(asks);
            while left != 0 {
                let lane = left.trailing_zeros() as usize % 16;
                let best = (distances[lane], prims[lane]);
                (distances[lane], prims[lane]) = tree.nearest(l.eight(), &rays.lone(lane), best, &mut self.stack);
                left &= left - 1;
            }
            (t, prim) = (l.load(&distances), l.load_u(&prims));
        }
        (t, prim)
    }

    /// Which of `lanes` hit something in (0, 1) that is not `target`.
    #[inline(always)]
    pub fn occluded(&mut self, l: L, ray: &Ray<L>, target: L::U, lanes: L::M) -> L::M {
        let mut stopped = l.m(false);
        if let Some(list) = &mut self.list {
            stopped = list.occluded(l, ray, target, lanes);
        }
        if let Some(tree) = self.tree {
            let asks = lanes & !stopped & tree.meets(l, ray, l.f(1.0));
            let rays = Unpacked::new(l, ray);
            let (mut targets, mut answers) = ([0; 16], [0; 16]);
            l.store_u(target, &mut targets);
            let mut left = l.bitmask(asks);
            while left != 0 {
                let lane = left.trailing_zeros() as usize % 16;
                let lone = rays.lone(lane);
                answers[lane] = u32::from(tree.occluded(l.eight(), &lone, targets[lane], &mut self.stack));
                left &= left - 1;
            }
            stopped = stopped | l.eq_u(l.load_u(&answers), l.u(1));
        }
        stopped
    }
}
