//! Rays against primitives, robustly: no absolute epsilon anywhere.

pub mod grazing;
pub mod lone;
pub mod offset;
pub mod polygon;
pub mod ray;
pub mod sphere;

pub use lone::Lone;
pub use ray::Ray;
