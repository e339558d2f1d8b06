//! Figures as SVG: drawn the same way for the page and, with colours of their own, as files for a paper.

mod error_time;
mod ink;
mod knobs;
mod legend;
mod marker;
mod plot;
mod tiles;

pub(crate) use error_time::{ERROR, Metric, RELMSE, error_time, front_number, front_size};
pub(crate) use knobs::knob_costs;
pub(crate) use marker::marker;
pub(crate) use tiles::{balance, heat, milliseconds, tile_map, tiles_of};

use crate::findings::findings;
use crate::record::Study;
use crate::verdict::comparisons;

/// Width of a figure for paper and desktop, in SVG units (CSS pixels).
pub(crate) const WIDE: f64 = 760.0;

/// Width of a figure for a phone.
pub(crate) const NARROW: f64 = 370.0;

/// Relative error against seconds, as a file.
pub fn figure_error_time(study: &Study) -> String {
    error_time(study, &findings(study), &ERROR, WIDE).into_string()
}

/// relmse against seconds, as a file.
pub fn figure_relmse_time(study: &Study) -> String {
    error_time(study, &findings(study), &RELMSE, WIDE).into_string()
}

/// What each knob costs, as a file; `None` if no two arms differ in one knob only.
pub fn figure_knobs(study: &Study) -> Option<String> {
    let comparisons = comparisons(study);
    Some(knob_costs(study, &comparisons, WIDE)?.into_string())
}

/// The time in each tile of an arm's first repetition, as a file; `None` where it was not kept.
pub fn figure_tiles(study: &Study, arm: usize) -> Option<String> {
    Some(tile_map(study, arm)?.into_string())
}
