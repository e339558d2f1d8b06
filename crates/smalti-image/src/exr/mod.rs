//! OpenEXR: linear floats, layers, windows, provenance.

mod choice;
mod read;
mod refusal;
#[cfg(test)]
mod tests;
mod write;

pub(crate) use read::decode;
pub(crate) use write::encode;
