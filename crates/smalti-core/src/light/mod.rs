//! Lights: how a point is chosen on them, and what arrives from there.
//!
//! A light has three verbs: *choose* (which light, by power or by what it can bring to the place), *sample* (a point of it, seen from a surface point, with
//! the solid-angle pdf of having chosen it) and *pdf* (the same pdf for a direction that hit it by chance). The three
//! agree, which is what multiple importance sampling rests on.

pub(crate) mod lamps;
pub mod place;
pub mod sample;
pub mod table;

pub use sample::Incident;
