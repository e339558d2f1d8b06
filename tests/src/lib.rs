//! What the acceptance tests share.

pub mod build;
pub mod draw;
pub mod estimate;
pub mod oracle;
pub mod photons;
pub mod statistics;
