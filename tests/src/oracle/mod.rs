//! The oracle: a second renderer, slow and plain, that shares no code with the first.
//!
//! One ray at a time, in f64, every primitive tested, on the world as a user describes it: no frame, no lanes, no
//! streams, no multiple importance sampling. What the two agree on is not a common bug.

pub mod hit;
mod light;
pub mod optics;
mod path;
pub mod photon;
mod picture;
mod random;
mod whitted;

pub use hit::{Hit, Ray, nearest};
pub use path::Finds;
pub use picture::{Pixel, camera_ray, render, render_whitted};
pub use random::Random;
