//! What a world holds that is rendered as it is written and yet hardly meant: dielectrics that are open or inside out, lamps
//! that shine inwards, and what is thinner or smaller than coordinates can hold.
//!
//! Most of it is decided by edges and boxes, in time proportional to the scene; rays are followed only about what is open
//! or turned, so that a pool whose water ends at its walls, a bubble in glass and a room with glowing walls pass.

mod bodies;
mod coarse;
mod rough;
mod thin;
mod turned;
mod words;

pub use words::Names;

use super::contact::Pair;
use super::{Frame, Origin, World};

/// A surface that hangs together, of several with the same flaw the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// A face of it.
    pub face: Origin,
    /// Number of its faces.
    pub faces: usize,
    /// Number of surfaces with the flaw, at least 1.
    pub count: usize,
}

/// Something that is hardly meant: one a kind and material.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// A dielectric that light can enter without leaving it: its surface is not closed.
    Open {
        /// The first of such surfaces.
        surface: Surface,
        /// Index of its material.
        material: usize,
        /// Number of edges at which they end.
        edges: usize,
    },
    /// A closed dielectric whose inside is all the world around it.
    InsideOut {
        /// The first of such surfaces.
        surface: Surface,
        /// Index of its material.
        material: usize,
    },
    /// A closed lamp that shines into itself, where nothing is.
    ShinesInwards {
        /// The first of such surfaces.
        surface: Surface,
    },
    /// A dielectric, or a gap beside one, that is as thin as coordinates are rounded.
    Thin {
        /// The surfaces on both sides.
        of: [Origin; 2],
        /// Their materials.
        materials: [usize; 2],
        /// Metres between them.
        thickness: f64,
        /// The same, in steps of the coordinates there.
        steps: f64,
        /// Number of such places with these materials.
        places: usize,
    },
    /// Something so small for where it lies that coordinates hardly hold it.
    Coarse {
        /// A face of it, or the sphere.
        surface: Origin,
        /// Its extent, metres.
        extent: f64,
        /// The same, in steps of the coordinates there.
        steps: f64,
        /// What makes the scene as large as it is.
        largest: Origin,
        /// Extent of the scene, metres.
        scene: f64,
        /// Number of such things.
        things: usize,
    },
    /// A sphere so large that its surface is as rough, by rounding, as what is beside it.
    Rough {
        /// The sphere.
        sphere: Origin,
        /// Its diameter, metres.
        across: f64,
        /// What its surface is rounded to, metres.
        rounding: f64,
        /// The smallest thing beside it.
        beside: Origin,
        /// Extent of that, metres.
        extent: f64,
        /// Number of such things beside such spheres.
        things: usize,
    },
}

/// Everything of that kind in `world`; `pairs` are those that [`pairs`](super::contact::pairs) finds in it.
pub fn examine(world: &World, frame: &Frame, pairs: &[Pair]) -> Vec<Finding> {
    let mut found = turned::examine(world, frame);
    found.extend(thin::examine(world, frame, pairs));
    found.extend(coarse::examine(world, frame));
    found.extend(rough::examine(world, frame));
    found
}

#[cfg(test)]
mod tests;
