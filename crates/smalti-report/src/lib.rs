//! What a study of speed and accuracy found, for people to look at. Pure: a [`Study`] becomes text; nothing here renders
//! or knows the time.

mod record;

pub use record::{Arm, FORMAT, Machine, Reference, Run, Study, TileTime};
