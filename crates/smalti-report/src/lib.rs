//! What a study of speed and accuracy found, for people to look at. Pure: a [`Study`] becomes text; nothing here renders
//! or knows the time.

mod axis;
mod figures;
mod findings;
#[cfg(test)]
mod fixture;
mod front;
mod groups;
mod knobs;
mod numbers;
mod page;
mod record;
mod stated;
mod table_one;
mod verdict;
mod words;

pub use figures::{figure_error_time, figure_knobs, figure_relmse_time, figure_tiles};
pub use findings::{Finding, findings};
pub use knobs::sentence;
pub use page::{ArmPictures, Pictures, page};
pub use record::{Arm, FORMAT, Machine, Reference, Run, Study, TileTime};
pub use stated::Stated;
pub use table_one::table_one_markdown;
pub use verdict::{Comparison, Verdict, comparisons};
pub use words::words;
