//! Light transport: a [`World`](scene::World) becomes radiance. No files, no clock, no terminal.

pub mod accel;
pub mod bsdf;
pub mod film;
pub mod geometry;
pub mod hunt;
pub mod lanes;
pub mod light;
mod mutant;
pub mod photon;
pub mod plan;
pub mod render;
mod replay;
pub mod sampling;
pub mod scene;
pub mod settings;
pub mod stream;
