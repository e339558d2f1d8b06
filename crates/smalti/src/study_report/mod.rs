//! A study's report in files: read the study, gather its pictures, write the page and the figures.

mod pictures;
mod read;
mod write;

pub use read::read;
pub use write::{Written, write};
