//! Reading and writing an image file of any known format.

use std::path::{Path, PathBuf};
use std::{fs, io};

use smalti_core::film::Image;

use crate::codec::Broken;
use crate::content::Content;
use crate::destination::replace;
use crate::format::known;
use crate::{Format, FormatError, Picture, Provenance, Windows, exr, pfm, png, radiance};

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
    /// Neither the content nor the file name says a known format.
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
        /// The format that it begins as, or else that of the extension.
        format: Format,
        /// What is wrong.
        what: String,
    },
    /// The content is known and of no format that is read; nor is the extension.
    #[error("{}: is {content}; images are read as {}", .path.display(), known())]
    Other {
        /// The file.
        path: PathBuf,
        /// What it holds, in words.
        content: &'static str,
    },
}

/// Writes `image`, a whole picture, to `path` in the format of its extension, atomically: other programs see the old
/// file or the whole new one.
///
/// PFM and EXR keep every bit; a PNG shows the image `exposure_ev` stops brighter (see [`tone_map`](crate::tone_map)),
/// the linear formats ignore the exposure. HDR holds NaN and negative values as 0 and what exceeds 1.7e38 as that.
///
/// # Errors
/// An unknown extension, an image without pixels or of a size that its pixels do not fill, or what the system answers.
pub fn write(path: &Path, image: &Image, provenance: &Provenance, exposure_ev: f32) -> Result<(), WriteError> {
    write_part(path, image, Windows::whole(image.width, image.height), provenance, exposure_ev)
}

/// [`write()`] of an image that may be a part of a picture: EXR says which.
///
/// # Errors
/// Those of [`write()`]; a data window of another size than the image.
pub fn write_part(
    path: &Path,
    image: &Image,
    windows: Windows,
    provenance: &Provenance,
    exposure_ev: f32,
) -> Result<(), WriteError> {
    let format = Format::from_path(path)?;
    let bytes = encode(format, image, windows, provenance, exposure_ev)
        .map_err(|Broken(what)| WriteError::Image { path: path.into(), what })?;
    replace(path, |file| io::Write::write_all(file, &bytes))
        .map_err(|error| WriteError::Io { path: path.into(), error })
}

/// The bytes of a PNG file as [`write()`] writes it, without provenance; `None` for an image without pixels or of a size that
/// its pixels do not fill.
pub fn encode_png(image: &Image, exposure_ev: f32) -> Option<Vec<u8>> {
    let windows = Windows::whole(image.width, image.height);
    encode(Format::Png, image, windows, &Provenance::new(), exposure_ev).ok()
}

/// Reads the pixels of the image at `path`: [`read_picture`] without the rest.
///
/// # Errors
/// Those of [`read_picture`].
pub fn read(path: &Path) -> Result<Image, ReadError> {
    read_picture(path).map(|picture| picture.image)
}

/// Reads the image at `path`, linear: a PNG is taken as sRGB. The content tells the format, whatever the extension says.
///
/// # Errors
/// A file that cannot be read, content that is damaged or of no format that is read.
pub fn read_picture(path: &Path) -> Result<Picture, ReadError> {
    let named = Format::from_path(path);
    let bytes = match (fs::read(path), &named) {
        (Ok(bytes), _) => bytes,
        // A slip in the name is more likely than such a file.
        (Err(error), Err(unknown)) if error.kind() == io::ErrorKind::NotFound => return Err(unknown.clone().into()),
        (Err(error), _) => return Err(ReadError::Io { path: path.into(), error }),
    };
    let broken = |format| move |Broken(what)| ReadError::Broken { path: path.into(), format, what };
    match Content::of(&bytes) {
        Content::Image(format) => {
            let mut picture = decode(format, &bytes).map_err(broken(format))?;
            let is_plain =
                named.map_or_else(|error| matches!(error, FormatError::Missing { .. }), |named| named == format);
            if !is_plain {
                picture
                    .notes
                    .insert(0, format!("its content is that of a .{} file, and is read as that", format.extension()));
            }
            Ok(picture)
        }
        Content::Other(content) => match named {
            Ok(format) => Err(broken(format)(format!("it is {content}").into())),
            Err(_) => Err(ReadError::Other { path: path.into(), content }),
        },
        Content::Unknown => {
            let format = named?;
            Err(broken(format)("it does not begin as one".into()))
        }
    }
}

fn encode(
    format: Format,
    image: &Image,
    windows: Windows,
    provenance: &Provenance,
    exposure_ev: f32,
) -> Result<Vec<u8>, Broken> {
    let pixels = u64::from(image.width) * u64::from(image.height);
    if pixels == 0 || pixels != image.pixels.len() as u64 || windows.data.size() != (image.width, image.height) {
        return Err(format!("{} × {} pixels, but {} values", image.width, image.height, image.pixels.len()).into());
    }
    match format {
        Format::Pfm => Ok(pfm::encode(image)),
        Format::Png => png::encode(image, provenance, exposure_ev),
        Format::Exr => exr::encode(image, windows, provenance),
        Format::Hdr => radiance::encode(image, provenance),
    }
}

fn decode(format: Format, bytes: &[u8]) -> Result<Picture, Broken> {
    match format {
        Format::Pfm => pfm::decode(bytes),
        Format::Png => png::decode(bytes),
        Format::Exr => exr::decode(bytes),
        Format::Hdr => radiance::decode(bytes),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::Window;

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

    /// The bytes of a whole image without provenance.
    pub(crate) fn encoded(format: Format, image: &Image) -> Result<Vec<u8>, Broken> {
        encode(format, image, Windows::whole(image.width, image.height), &Provenance::new(), 0.0)
    }

    #[test]
    fn every_format_is_written_and_read_by_its_extension() {
        let folder = tempfile::tempdir().unwrap();
        let image = sample(9, 4);
        for format in Format::ALL {
            let path = folder.path().join("image").with_extension(format.extension());
            write(&path, &image, &Provenance::new(), 0.0).unwrap();
            let picture = read_picture(&path).unwrap();
            assert_eq!(picture, decode(format, &fs::read(&path).unwrap()).unwrap());
            assert_eq!((picture.image.width, picture.notes.len()), (9, 0));
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), Format::ALL.len());
    }

    #[test]
    fn a_part_keeps_its_place_in_formats_that_have_one() {
        let folder = tempfile::tempdir().unwrap();
        let data = Window { x: 30, y: 20, width: 9, height: 4 };
        let windows = Windows { data, display: Window::of_size(100, 80) };
        for format in Format::ALL {
            let path = folder.path().join("part").with_extension(format.extension());
            write_part(&path, &sample(9, 4), windows, &Provenance::new(), 0.0).unwrap();
            let expected = (format == Format::Exr).then_some(windows);
            assert_eq!(read_picture(&path).unwrap().windows, expected);
        }
    }

    #[test]
    fn a_png_in_memory_is_that_of_a_file() {
        let image = sample(9, 4);
        let windows = Windows::whole(9, 4);
        let written = encode(Format::Png, &image, windows, &Provenance::new(), 1.0).unwrap();
        assert_eq!(encode_png(&image, 1.0), Some(written));
        assert_eq!(encode_png(&Image::black(0, 4), 0.0), None);
    }

    #[test]
    fn an_image_without_pixels_is_refused_by_every_format() {
        let torn = Image { width: 2, height: 2, pixels: vec![[0.0; 3]; 3] };
        for format in Format::ALL {
            for image in [&Image::black(0, 4), &Image::default(), &torn] {
                assert!(encoded(format, image).is_err());
            }
            let (image, windows) = (sample(2, 2), Windows::whole(2, 1));
            assert!(encode(format, &image, windows, &Provenance::new(), 0.0).is_err());
        }
    }

    /// The answer to a file of this name and content.
    fn read_as(name: &str, bytes: &[u8]) -> Result<Picture, String> {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(name), bytes).unwrap();
        let answer = |error: ReadError| error.to_string().rsplit('/').next().unwrap().to_owned();
        read_picture(&folder.path().join(name)).map_err(answer)
    }

    #[test]
    fn content_that_is_no_image_is_named() {
        for format in Format::ALL {
            let name = format!("image.{}", format.extension());
            let message = |bytes: &[u8]| read_as(&name, bytes).unwrap_err();
            let begin = format!("{name}: is no valid .{} file: ", format.extension());
            assert_eq!(message(b"smalti smalti smalti\n"), format!("{begin}it is a text"));
            assert_eq!(message(b""), format!("{begin}it is empty"));
            assert_eq!(message(b"\xff\xd8\xff\xe0"), format!("{begin}it is a JPEG image"));
            assert_eq!(message(b"\x80\x01\x02"), format!("{begin}it does not begin as one"));
        }
        let message = read_as("image.jpg", b"\xff\xd8\xff\xe0").unwrap_err();
        assert_eq!(message, "image.jpg: is a JPEG image; images are read as .png, .exr, .pfm, .hdr");
        assert!(read_as("image.pgn", b"\x80\x01\x02").unwrap_err().contains("perhaps '.png' was meant"));
        let missing = read(Path::new("no such file.pgn")).unwrap_err().to_string();
        assert!(missing.contains("perhaps '.png' was meant"), "{missing}");
    }

    #[test]
    fn an_image_is_read_by_its_content() {
        for format in Format::ALL {
            let bytes = encoded(format, &sample(5, 4)).unwrap();
            let expected = decode(format, &bytes).unwrap();
            for name in ["image.png", "image.exr", "image.pfm", "image.hdr", "image.dat", "image"] {
                let found = read_as(name, &bytes).unwrap();
                assert_eq!(found.image, expected.image);
                let is_plain = name == "image" || name.ends_with(format.extension());
                assert_eq!(found.notes.is_empty(), is_plain, "{name}: {:?}", found.notes);
            }
            let cut = read_as("image.dat", &bytes[..bytes.len() / 2]).unwrap_err();
            assert!(cut.contains(&format!("is no valid .{} file", format.extension())), "{cut}");
        }
    }

    #[test]
    fn no_word_of_a_library_is_told() {
        for format in Format::ALL {
            let bytes = encoded(format, &sample(13, 9)).unwrap();
            for at in 0..bytes.len() {
                let mut damaged = bytes.clone();
                damaged[at] ^= 0xff;
                for bytes in [&bytes[..at], &damaged] {
                    let Err(Broken(what)) = decode(format, bytes) else { continue };
                    let words = ["its ", "it ", "a run ", "a line ", "the length ", "13 ×"];
                    let is_ours = words.iter().any(|word| what.starts_with(word)) || what.ends_with("follow");
                    assert!(is_ours && !what.contains("Error") && !what.contains('('), "{what}");
                }
            }
        }
    }

    #[test]
    fn damaged_files_do_not_panic() {
        for format in Format::ALL {
            let bytes = encoded(format, &sample(13, 9)).unwrap();
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
