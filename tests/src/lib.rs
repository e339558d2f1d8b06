//! What the acceptance tests share.

pub mod accuracy;
pub mod arguments;
pub mod build;
pub mod closed;
pub mod documents;
pub mod draw;
pub mod estimate;
pub mod fuzz;
pub mod leaving;
pub mod oracle;
pub mod photons;
pub mod rooms;
pub mod statistics;
