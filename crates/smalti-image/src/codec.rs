//! Below all codecs: the flaws that they find, in words, and the check of a size before memory is taken.

/// A flaw in the content of a file, or an image that a file cannot hold; in our words, not a library's.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct Broken(pub(crate) String);

impl From<String> for Broken {
    fn from(what: String) -> Self {
        Self(what)
    }
}

impl From<&str> for Broken {
    fn from(what: &str) -> Self {
        Self(what.into())
    }
}

/// The number of pixels, if a file of `file_size` bytes can hold them. Readers check it before they take memory.
pub(crate) fn check_size(width: u32, height: u32, file_size: usize) -> Result<usize, Broken> {
    /// More than any codec reaches: deflate makes 1032 of one byte, DWA's blocks of zeros hold 64 pixels.
    const PIXELS_PER_BYTE: u64 = 1032 * 64;
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 {
        return Err("it has no pixels".into());
    }
    if pixels > PIXELS_PER_BYTE.saturating_mul(file_size as u64) {
        return Err(format!("it is too short for {width} × {height} pixels").into());
    }
    usize::try_from(pixels).map_err(|_| "it is too large".into())
}
