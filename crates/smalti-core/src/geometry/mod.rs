//! Rays against primitives, robustly: no absolute epsilon anywhere.

pub mod offset;
pub mod polygon;
pub mod ray;
pub mod sphere;

pub use ray::Ray;
