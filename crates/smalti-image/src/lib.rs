//! Linear images in and out (PFM, PNG, EXR, Radiance HDR), tone mapping, provenance and the hash of an image.
//!
//! What a file holds is a pure function of the image, its provenance and the exposure: the same render gives the same
//! bytes. Files are written atomically: at every moment the destination is absent, the old file or the new one.

mod align;
mod codec;
mod content;
mod destination;
mod difference;
mod exr;
mod file;
mod format;
mod hash;
mod pfm;
mod picture;
mod png;
mod provenance;
mod radiance;
mod tone;
mod window;

pub use align::{AlignError, Aligned, Sizes, align};
pub use destination::{DestinationError, check_destination, check_place, replace, temporary_of};
pub use difference::{Difference, difference, difference_scale};
pub use file::{ReadError, WriteError, encode_png, read, read_picture, write, write_part};
pub use format::{Format, FormatError};
pub use hash::hash;
pub use picture::Picture;
pub use provenance::Provenance;
pub use tone::{from_srgb, tone_map};
pub use window::{Window, Windows};
