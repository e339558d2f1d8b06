//! Statistics of images and of measurements: metrics against a reference, the error that a render states of itself, and
//! what a series of timings says. Pure functions; no files, no clock.

mod bias;
mod blocks;
mod compare;
mod crosscheck;
mod interval;
mod not_finite;
mod relative;
mod repetitions;
mod statement;
mod timing;

pub use bias::{BiasStatement, bias_statement};
pub use compare::{CompareError, Comparison, PixelDifference, compare};
pub use crosscheck::{CrosscheckStatement, FEWEST_FINDS};
pub use not_finite::{NotFinite, NotFinitePixel, not_finite};
pub use repetitions::{Ends, REPETITIONS_FOR_INTERVAL, Repetitions, repetitions};
pub use statement::{ErrorStatement, error_statement, noise};
pub use timing::{efficiency, median, parallel_efficiency, quantile, speed_up};
