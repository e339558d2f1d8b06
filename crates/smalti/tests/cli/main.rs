//! The program as it is typed: help, mistakes and their messages, exit codes, files, JSON.

mod budget;
mod doctor;
mod images;
mod meshes;
mod mistakes;
mod notes;
mod photon_map;
mod photons;
mod quality;
mod render;
mod report;
mod room;
mod study;
#[cfg(unix)]
mod unix;
