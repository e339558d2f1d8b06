//! Finding what a ray hits: a [`list`] of everything for many rays at a time, or a [`bvh`] for one ray at a time.
//! Both give the same bits: the nearest hit, at equal distance the one of the lowest primitive number.

pub mod list;
pub mod occluders;

pub use list::List;

/// No primitive.
pub const MISS: u32 = u32::MAX;

/// How far a distance that does not graze can be off, in the scene's frame (coordinates in [-1, 1]) and relative to the
/// origin's distance: the tree visits boxes that begin this much behind the nearest hit.
pub const SLACK: f32 = 1.0 / 8192.0;
