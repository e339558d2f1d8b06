//! `smalti study`: the trade between speed and accuracy, measured on the user's scene and machine.
//!
//! ```text
//! preset + knobs ─plan─► ways to render ─calibrate─► arms ─find_truth─► references ─render─► runs ─present─► tables
//!                                 study.json is rewritten after every step and every render
//! ```
//!
//! What can be turned stands in one table, [`knobs`]: flags, names and columns follow from it.

pub mod args;
mod bench;
mod calibrate;
mod combine;
#[cfg(test)]
mod fixture;
mod folder;
mod knobs;
mod lists;
mod measure;
mod naming;
mod perform;
mod pilot;
mod plan;
mod present;
mod presets;
mod progress;
mod question;
mod reference;
mod report;
mod tables;
mod truth;
mod values;
mod way;

pub use bench::{Bench, Halt, check};
pub use folder::Folder;
pub use perform::Performance;
pub use pilot::Pilots;
pub use plan::{Plan, interleaved};
pub use progress::Progress;
pub use question::Question;
pub use reference::{Truth, given};
pub use way::{Way, cores};

/// What a plan was asked, for its folder.
pub use question::of as question;
