//! A photon map made visible: what `smalti photons` is asked for, the picture that it makes, and what it tells of it.

mod describe;
mod picture;
mod ramp;
mod request;
mod summary;

pub use describe::describe;
pub use picture::{Picture, develop};
pub use request::Request;
pub use summary::{Summary, provenance, summary};
