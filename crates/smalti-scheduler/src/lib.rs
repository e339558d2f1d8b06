//! Performs a render on all cores through rayon and tells what happened through a crossbeam channel.
//!
//! A unit of work is one tile in one pass. Passes grow (1, 1, 2, 4 ... samples a pixel) so that a picture is there at
//! once. A tile is worked on by one thread at a time and every sample is a function of its own number, so neither the
//! number of threads nor the order of the units can change a bit of the image. Whoever watches receives facts in the
//! past tense ([`Event`]); no worker ever waits for a watcher.

mod account;
mod allot;
mod cancel;
mod course;
mod event;
mod goal;
mod look;
mod outcome;
mod pass;
mod pool;
mod progress;
mod render;
mod shelf;
mod unit;

pub use allot::SIDE as ADAPTIVE_TILE;
pub use cancel::Cancel;
pub use course::MOST_SAMPLES;
pub use event::{ErrorOf, Event, Watch};
pub use goal::{Goal, JudgeOf, Judgement, NoiseOf, Stopped, Target};
pub use look::FIRST_LOOK;
pub use outcome::{Balance, Outcome, Panicked, Photons, Rejections, Timing};
pub use pool::{PoolError, pool};
pub use progress::{Current, Progress};
pub use render::{render, render_to};
pub use shelf::Shelf;
