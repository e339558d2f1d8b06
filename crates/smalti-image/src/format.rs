//! The image formats that are known, told apart by the file name's extension.

use std::path::{Path, PathBuf};

/// An image format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable float map: 32-bit linear floats, exact; holds no provenance.
    Pfm,
    /// 8-bit sRGB, tone mapped.
    Png,
    /// OpenEXR: 32-bit linear floats, exact.
    Exr,
    /// Radiance RGBE: linear, 8 bits of mantissa with an exponent that the channels share.
    Hdr,
}

/// A file name whose extension says no known format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FormatError {
    /// The name has no extension.
    #[error("{}: the file name has no extension to tell the image format; known are {}", .path.display(), known())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// The extension is none of the known ones.
    #[error("{}: unknown image format '.{extension}'{}; known are {}", .path.display(), perhaps(.nearest), known())]
    Unknown {
        /// The file.
        path: PathBuf,
        /// Its extension.
        extension: String,
        /// The known extension that was perhaps meant.
        nearest: Option<&'static str>,
    },
}

impl Format {
    /// Every format.
    pub const ALL: [Format; 4] = [Format::Png, Format::Exr, Format::Pfm, Format::Hdr];

    /// The extension, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Pfm => "pfm",
            Format::Png => "png",
            Format::Exr => "exr",
            Format::Hdr => "hdr",
        }
    }

    /// The format that the extension of `path` names, in upper or lower case.
    ///
    /// # Errors
    /// An extension that is missing or unknown.
    pub fn from_path(path: &Path) -> Result<Self, FormatError> {
        let Some(extension) = path.extension() else {
            return Err(FormatError::Missing { path: path.into() });
        };
        let extension = extension.to_string_lossy().to_lowercase();
        let known = Self::ALL.into_iter().find(|format| format.extension() == extension);
        known.ok_or_else(|| FormatError::Unknown { path: path.into(), nearest: nearest(&extension), extension })
    }
}

/// The known extension that a slip of the finger may have turned into `extension`.
fn nearest(extension: &str) -> Option<&'static str> {
    let slips = |known: &str| strsim::damerau_levenshtein(known, extension);
    Format::ALL.map(Format::extension).into_iter().filter(|known| slips(known) <= 1).min_by_key(|known| slips(known))
}

fn perhaps(nearest: &Option<&'static str>) -> String {
    nearest.map(|known| format!(" (perhaps '.{known}' was meant)")).unwrap_or_default()
}

/// The extensions that are known, in words.
pub(crate) fn known() -> String {
    Format::ALL.map(|format| format!(".{}", format.extension())).join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_name_formats_in_any_case() {
        for format in Format::ALL {
            assert_eq!(Format::from_path(&Path::new("a.b").with_extension(format.extension())), Ok(format));
        }
        assert_eq!(Format::from_path(Path::new("room.PNG")), Ok(Format::Png));
    }

    #[test]
    fn a_slip_is_answered_with_what_was_meant() {
        let error = Format::from_path(Path::new("room.pgn")).unwrap_err().to_string();
        assert_eq!(
            error,
            "room.pgn: unknown image format '.pgn' (perhaps '.png' was meant); known are .png, .exr, .pfm, .hdr"
        );
    }

    #[test]
    fn a_far_extension_is_not_guessed_at() {
        let error = Format::from_path(Path::new("room.jpeg")).unwrap_err().to_string();
        assert_eq!(error, "room.jpeg: unknown image format '.jpeg'; known are .png, .exr, .pfm, .hdr");
        let error = Format::from_path(Path::new("dir.d/room")).unwrap_err().to_string();
        assert!(error.contains("no extension"), "{error}");
    }
}
