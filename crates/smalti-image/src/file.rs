//! Reading and writing an image file of any known format.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::{fs, io};

use smalti_core::film::Image;

use crate::destination::replace;
use crate::{Format, FormatError, Provenance, exr, pfm, png, radiance};

/// An image that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file name says no known format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The format cannot hold the image.
    #[error("{}: the image cannot be stored: {what}", .path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// Why.
        what: String,
    },
    /// The disk or the folder refused; what was at the destination is as it was.
    #[error("{}: cannot be written: {error}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
}

/// An image that could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file name says no known format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The file cannot be opened or read.
    #[error("{}: cannot be read: {error}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// The content is damaged, or is not what the extension says.
    #[error("{}: is no valid .{} file: {what}", .path.display(), .format.extension())]
    Broken {
        /// The file.
        path: PathBuf,
        /// What the extension says that it is.
        format: Format,
        /// What is wrong.
        what: String,
    },
}

/// Writes `image` to `path` in the format of its extension, atomically: other programs see the old file or the whole
/// new one.
///
/// PFM and EXR keep every bit; a PNG shows the image `exposure_ev` stops brighter (see [`tone_map`](crate::tone_map)),
/// the linear formats ignore the exposure. HDR holds NaN and negative values as 0 and what exceeds 1.7e38 as that.
///
/// # Errors
/// An unknown extension, an image without pixels or of a size that its pixels do not fill, or what the system answers.
pub fn write(path: &Path, image: &Image, provenance: &Provenance, exposure_ev: f32) -> Result<(), WriteError> {
    let format = Format::from_path(path)?;
    let bytes = encode(format, image, provenance, exposure_ev)
        .map_err(|Broken(what)| WriteError::Image { path: path.into(), what })?;
    replace(path, |file| io::Write::write_all(file, &bytes))
        .map_err(|error| WriteError::Io { path: path.into(), error })
}

/// The bytes of a PNG file as [`write()`] writes it, without provenance; `None` for an image without pixels or of a size that
/// its pixels do not fill.
pub fn encode_png(image: &Image, exposure_ev: f32) -> Option<Vec<u8>> {
    encode(Format::Png, image, &Provenance::new(), exposure_ev).ok()
}

/// Reads the image at `path`, linear: a PNG is taken as sRGB.
///
/// # Errors
/// An unknown extension, a file that cannot be read, or content that is damaged or not of that format.
pub fn read(path: &Path) -> Result<Image, ReadError> {
    let format = Format::from_path(path)?;
    let bytes = fs::read(path).map_err(|error| ReadError::Io { path: path.into(), error })?;
    decode(format, &bytes).map_err(|Broken(what)| ReadError::Broken { path: path.into(), format, what })
}

fn encode(format: Format, image: &Image, provenance: &Provenance, exposure_ev: f32) -> Result<Vec<u8>, Broken> {
    let pixels = u64::from(image.width) * u64::from(image.height);
    if pixels == 0 || pixels != image.pixels.len() as u64 {
        return Err(format!("{} × {} pixels, but {} values", image.width, image.height, image.pixels.len()).into());
    }
    match format {
        Format::Pfm => Ok(pfm::encode(image)),
        Format::Png => Ok(png::encode(image, provenance, exposure_ev)?),
        Format::Exr => Ok(exr::encode(image, provenance)?),
        Format::Hdr => Ok(radiance::encode(image, provenance)?),
    }
}

fn decode(format: Format, bytes: &[u8]) -> Result<Image, Broken> {
    match format {
        Format::Pfm => pfm::decode(bytes),
        Format::Png => png::decode(bytes),
        Format::Exr => exr::decode(bytes),
        Format::Hdr => radiance::decode(bytes),
    }
}

/// What is wrong with the content of a file, or with an image that a file cannot hold.
#[derive(Debug)]
pub(crate) struct Broken(String);

impl<E: Display> From<E> for Broken {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

/// The number of pixels, if a file of `file_size` bytes can hold so many: asked before memory is taken.
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

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Different positive values of several magnitudes in every pixel.
    pub(crate) fn sample(width: u32, height: u32) -> Image {
        let values = (0..width * height).map(|i| i.wrapping_mul(2_654_435_761));
        let value = |bits: u32, c: u32| (bits.rotate_left(11 * c) >> 8) as f32 / 1e6;
        Image { width, height, pixels: values.map(|bits| [0, 1, 2].map(|c| value(bits, c))).collect() }
    }

    /// Every kind of float that there is.
    pub(crate) fn extreme() -> Image {
        let nan = f32::from_bits(0x7fc0_1234);
        let values =
            [0.0, -0.0, 1e-45, f32::MIN_POSITIVE, f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, nan, -nan];
        let pixel = |i: usize| std::array::from_fn(|c| values[(i + c * (i / 10 + 1)) % 10]);
        Image { width: 10, height: 3, pixels: (0..30).map(pixel).collect() }
    }

    /// The image with floats that compare by their bits.
    pub(crate) fn bits(image: &Image) -> (u32, u32, Vec<u32>) {
        (image.width, image.height, image.pixels.as_flattened().iter().map(|value| value.to_bits()).collect())
    }

    #[test]
    fn every_format_is_written_and_read_by_its_extension() {
        let folder = tempfile::tempdir().unwrap();
        let image = sample(9, 4);
        for format in Format::ALL {
            let path = folder.path().join("image").with_extension(format.extension());
            write(&path, &image, &Provenance::new(), 0.0).unwrap();
            assert_eq!(read(&path).unwrap(), decode(format, &fs::read(&path).unwrap()).unwrap());
            assert_eq!(read(&path).unwrap().width, 9);
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), Format::ALL.len());
    }

    #[test]
    fn a_png_in_memory_is_that_of_a_file() {
        let image = sample(9, 4);
        let decoded = decode(Format::Png, &encode_png(&image, 1.0).unwrap()).unwrap();
        assert_eq!(
            decoded,
            decode(Format::Png, &encode(Format::Png, &image, &Provenance::new(), 1.0).unwrap()).unwrap()
        );
        assert_eq!(encode_png(&Image::black(0, 4), 0.0), None);
    }

    #[test]
    fn an_image_without_pixels_is_refused_by_every_format() {
        let torn = Image { width: 2, height: 2, pixels: vec![[0.0; 3]; 3] };
        for format in Format::ALL {
            for image in [&Image::black(0, 4), &Image::default(), &torn] {
                assert!(encode(format, image, &Provenance::new(), 0.0).is_err());
            }
        }
    }

    #[test]
    fn content_of_another_format_is_named() {
        let folder = tempfile::tempdir().unwrap();
        for format in Format::ALL {
            let path = folder.path().join("image").with_extension(format.extension());
            fs::write(&path, b"smalti smalti smalti smalti\n").unwrap();
            let error = read(&path).unwrap_err();
            assert!(matches!(error, ReadError::Broken { .. }), "{error}");
            assert!(error.to_string().contains(&format!("is no valid .{} file", format.extension())), "{error}");
        }
    }

    #[test]
    fn damaged_files_do_not_panic() {
        for format in Format::ALL {
            let bytes = encode(format, &sample(13, 9), &Provenance::new(), 0.0).unwrap();
            for at in 0..bytes.len() {
                for flip in [0x01, 0x10, 0x80, 0xff] {
                    let mut damaged = bytes.clone();
                    damaged[at] ^= flip;
                    let _ = decode(format, &damaged);
                }
            }
        }
    }

    #[test]
    fn a_huge_size_in_a_small_file_takes_no_memory() {
        let header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n";
        let error = decode(Format::Hdr, header.as_bytes()).unwrap_err();
        assert!(error.0.contains("too short for 60000 × 60000"), "{}", error.0);
    }
}
