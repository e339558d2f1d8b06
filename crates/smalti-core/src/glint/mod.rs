//! Glints: lamps that the camera sees far smaller than a pixel, directly or by specular surfaces alone.
//!
//! Shadow rays cannot find this light, and photons never meet a pinhole: only a camera ray that happens to hit the lamp
//! brings it, one in hundreds, as a rare bright sample. But where in its pixel such a glint lies can be found before any
//! sample is taken: rays through a pixel and their neighbours tell by how much a chain of reflections and refractions
//! misses the lamp, and Newton's method leads to where it does not (`search.rs`). Half of the samples of such a pixel then
//! go to small parallelograms around its glints, and each sample counts by the density of its place ([`Mixture`]).
//!
//! The search changes where samples go, never what they are worth: a glint that it misses is found by chance as before.

mod chain;
mod lamps;
mod search;

pub use lamps::{Target, targets};

use std::sync::OnceLock;

use crate::mutant::mutant;
use crate::render::Renderer;
use crate::settings::Rect;

/// Side of the blocks of pixels that are searched at a time.
const BLOCK: u32 = 16;

/// Share of a pixel's samples that is spread over all of it, where it has glints.
const SPREAD: f32 = 0.5;

/// A parallelogram that covers a glint, in pixels from the upper left corner of its pixel: `corner` + u `edges[0]` +
/// v `edges[1]`, u and v in [0, 1). It may reach out of the pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Where it begins.
    pub corner: [f32; 2],
    /// Its edges, not parallel.
    pub edges: [[f32; 2]; 2],
}

impl Region {
    /// The rectangle from `low` to `high`.
    pub fn rectangle(low: [f32; 2], high: [f32; 2]) -> Self {
        Self { corner: low, edges: [[high[0] - low[0], 0.0], [0.0, high[1] - low[1]]] }
    }

    /// Its size as a share of the pixel's.
    pub fn area(&self) -> f32 {
        cross(self.edges[0], self.edges[1]).abs()
    }

    /// Whether a place is in it.
    pub fn holds(&self, place: [f32; 2]) -> bool {
        let [e1, e2] = self.edges;
        let to = [0, 1].map(|k: usize| place[k] - self.corner[k]);
        let size = cross(e1, e2);
        [cross(to, e2) / size, cross(e1, to) / size].iter().all(|x| (0.0..1.0).contains(x))
    }

    /// The place in it that a place in the unit square goes to.
    pub fn place(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|k: usize| self.corner[k] + (self.edges[0][k] * u + self.edges[1][k] * v))
    }
}

fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

/// How samples are spread over a pixel that has glints.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture(Vec<Region>);

impl Mixture {
    /// At least one region, each of some extent.
    pub fn new(regions: Vec<Region>) -> Self {
        Self(regions)
    }

    /// The parts of the pixel that have glints in them.
    pub fn regions(&self) -> &[Region] {
        &self.0
    }

    /// The place that two numbers in [0, 1) lead to, and what a sample there counts for: 1 / its density, and nothing where
    /// it is out of the pixel.
    pub fn sample(&self, [u, v]: [f32; 2]) -> ([f32; 2], f32) {
        let count = self.0.len() as f32;
        let (place, chosen) = if u < SPREAD {
            ([u / SPREAD, v], None)
        } else {
            let scaled = (u - SPREAD) / (1.0 - SPREAD) * count;
            let number = (scaled as usize).min(self.0.len() - 1);
            (self.0[number].place([scaled - number as f32, v]), Some(number))
        };
        // The region that was chosen holds the place, whatever rounding has done to it.
        let holds = |(number, region): &(usize, &Region)| chosen == Some(*number) || region.holds(place);
        let focused: f32 = self.0.iter().enumerate().filter(holds).map(|(_, region)| 1.0 / region.area()).sum();
        let weight = 1.0 / (SPREAD + (1.0 - SPREAD) / count * focused);
        let weight = if place.iter().all(|x| (0.0..1.0).contains(x)) { weight } else { 0.0 };
        (place, if mutant!("glints_not_weighed") { 1.0 } else { weight })
    }
}

/// The glints of a picture, searched for block by block as they are asked for.
pub struct Glints {
    /// Blocks in a row.
    across: u32,
    blocks: Vec<OnceLock<Vec<(u32, u32, Mixture)>>>,
}

impl Glints {
    /// None searched for yet, of a picture of this size.
    pub fn new(width: u32, height: u32) -> Self {
        let (across, down) = (width.div_ceil(BLOCK), height.div_ceil(BLOCK));
        Self { across, blocks: (0..across * down).map(|_| OnceLock::new()).collect() }
    }

    /// How samples are spread over pixel (x, y) of the whole image; `None` where it has no glint.
    pub fn at(&self, renderer: &Renderer, (x, y): (u32, u32)) -> Option<&Mixture> {
        let block = (x / BLOCK, y / BLOCK);
        let found = self.blocks[(block.1 * self.across + block.0) as usize].get_or_init(|| {
            let corner = (block.0 * BLOCK, block.1 * BLOCK);
            let settings = renderer.settings();
            let (width, height) = (settings.width - corner.0, settings.height - corner.1);
            let area = Rect { x: corner.0, y: corner.1, width: width.min(BLOCK), height: height.min(BLOCK) };
            search::search(renderer, area)
        });
        found.iter().find(|(of_x, of_y, _)| (*of_x, *of_y) == (x, y)).map(|(_, _, mixture)| mixture)
    }
}
