//! The kind of a file by how it begins, whatever its name says.

use crate::Format;

/// What a file holds, as far as its beginning tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    /// An image of a format that is read.
    Image(Format),
    /// Something else that is known, in words.
    Other(&'static str),
    /// Nothing that is known.
    Unknown,
}

/// How the formats begin that are read.
const IMAGES: [(&[u8], Format); 5] = [
    (b"\x89PNG\r\n\x1a\n", Format::Png),
    (b"\x76\x2f\x31\x01", Format::Exr),
    (b"#?", Format::Hdr),
    (b"PF", Format::Pfm),
    (b"Pf", Format::Pfm),
];

/// Where and how other kinds of files begin.
const OTHERS: [(usize, &[u8], &str); 40] = [
    (0, b"\xff\xd8\xff", "a JPEG image"),
    (0, b"GIF8", "a GIF image"),
    (0, b"II*\0", "a TIFF image"),
    (0, b"MM\0*", "a TIFF image"),
    (0, b"II+\0", "a TIFF image"),
    (0, b"MM\0+", "a TIFF image"),
    (8, b"WEBP", "a WebP image"),
    (0, b"\xff\x0a", "a JPEG XL image"),
    (0, b"\0\0\0\x0cJXL ", "a JPEG XL image"),
    (0, b"\0\0\0\x0cjP  ", "a JPEG 2000 image"),
    (4, b"ftypavif", "an AVIF image"),
    (4, b"ftyphei", "a HEIF image"),
    (4, b"ftypmif1", "a HEIF image"),
    (4, b"ftyp", "a film"),
    (0, b"DDS ", "a DirectDraw surface"),
    (0, b"8BPS", "a Photoshop file"),
    (0, b"gimp xcf", "a GIMP file"),
    (0, b"SDPX", "a DPX image"),
    (0, b"XPDS", "a DPX image"),
    (0, b"qoif", "a QOI image"),
    (0, b"farbfeld", "a farbfeld image"),
    (0, b"\x01\xda", "an SGI image"),
    (0, b"BM", "a BMP image"),
    (0, b"\x1f\x8b", "a gzip archive: what is in it may be an image"),
    (0, b"PK\x03\x04", "a zip archive: what is in it may be an image"),
    (0, b"BZh", "a bzip2 archive: what is in it may be an image"),
    (0, b"\xfd7zXZ\0", "an xz archive: what is in it may be an image"),
    (0, b"\x28\xb5\x2f\xfd", "a zstd archive: what is in it may be an image"),
    (0, b"7z\xbc\xaf\x27\x1c", "a 7z archive: what is in it may be an image"),
    (257, b"ustar", "a tar archive: what is in it may be an image"),
    (0, b"%PDF", "a PDF document"),
    (0, b"\x93NUMPY", "a NumPy array"),
    (0, b"\x89HDF", "an HDF5 file"),
    (0, b"glTF", "a glTF scene"),
    (0, b"BLENDER", "a Blender scene"),
    (0, b"Kaydara FBX", "an FBX scene"),
    (0, b"ply\n", "a PLY mesh"),
    (0, b"ply\r", "a PLY mesh"),
    (0, b"\xff\xfe", "text in UTF-16"),
    (0, b"\xfe\xff", "text in UTF-16"),
];

/// How texts begin that are met in the place of an image; in lower case, behind blanks.
const TEXTS: [(&str, &str); 11] = [
    ("<!doctype html", "an HTML page"),
    ("<html", "an HTML page"),
    ("<svg", "an SVG drawing"),
    ("<?xml", "an XML document"),
    (
        "version https://git-lfs",
        "a Git LFS pointer, which stands for a file that was not fetched (`git lfs pull` does)",
    ),
    ("version https://hawser", "a Git LFS pointer, which stands for a file that was not fetched (`git lfs pull` does)"),
    ("/annex/objects/", "a git-annex pointer, which stands for a file that was not fetched (`git annex get` does)"),
    ("{", "a JSON document"),
    ("solid ", "an STL mesh"),
    ("mtllib ", "an OBJ mesh"),
    ("v ", "an OBJ mesh"),
];

/// Bytes that a text is known by.
const LOOKED_AT: usize = 1024;

impl Content {
    /// Of a file's bytes.
    pub(crate) fn of(bytes: &[u8]) -> Self {
        if let Some((_, format)) = IMAGES.iter().find(|(begin, _)| bytes.starts_with(begin)) {
            return Self::Image(*format);
        }
        let begins = |at: usize, begin: &[u8]| bytes.get(at..).is_some_and(|rest| rest.starts_with(begin));
        let other = OTHERS.iter().find(|(at, begin, _)| begins(*at, begin)).map(|(.., name)| *name);
        other.or_else(|| pnm(bytes)).or_else(|| nothing(bytes)).map_or_else(|| of_text(bytes), Self::Other)
    }
}

/// `P1` to `P7` and a blank.
fn pnm(bytes: &[u8]) -> Option<&'static str> {
    let [b'P', b'1'..=b'7', blank, ..] = bytes else { return None };
    blank.is_ascii_whitespace().then_some("a PNM image (PBM, PGM, PPM or PAM)")
}

fn nothing(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [] => Some("empty"),
        _ => bytes.iter().all(|&byte| byte == 0).then_some("nothing but zeros"),
    }
}

/// Text of a known kind; a picture of the first days of Radiance, which has no signature; or any text.
fn of_text(bytes: &[u8]) -> Content {
    let head = &bytes[..bytes.len().min(LOOKED_AT)];
    let text = String::from_utf8_lossy(head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head)).to_lowercase();
    if text.contains("\nformat=32-bit_rle_") {
        return Content::Image(Format::Hdr);
    }
    if let Some((_, name)) = TEXTS.iter().find(|(begin, _)| text.trim_start().starts_with(begin)) {
        return Content::Other(name);
    }
    let is_text = !head.iter().any(|&byte| byte < b' ' && !byte.is_ascii_whitespace()) && !text.contains('\u{fffd}');
    match text.lines().any(|line| line.starts_with("v ")) {
        true if is_text => Content::Other("an OBJ mesh"),
        false if is_text => Content::Other("a text"),
        _ => Content::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_known_by_how_they_begin() {
        let other = |bytes: &[u8]| match Content::of(bytes) {
            Content::Other(name) => name,
            content => panic!("{content:?} for {}", bytes.escape_ascii()),
        };
        let tar = [&[b'a'; 257][..], b"ustar\0"].concat();
        for (bytes, name) in [
            (b"".as_slice(), "empty"),
            (&[0; 50], "nothing but zeros"),
            (b"\xff\xd8\xff\xe0\0\x10JFIF", "a JPEG image"),
            (b"RIFF\x10\0\0\0WEBPVP8 ", "a WebP image"),
            (b"P6\n1 1\n255\nabc", "a PNM image (PBM, PGM, PPM or PAM)"),
            (b"\x1f\x8b\x08\0", "a gzip archive: what is in it may be an image"),
            (&tar, "a tar archive: what is in it may be an image"),
            (b"\xef\xbb\xbf\n <!DOCTYPE HTML>\n<title>404", "an HTML page"),
            (b"\n<html><body>", "an HTML page"),
            (b"ply\nformat ascii 1.0\n", "a PLY mesh"),
            (b"# Blender 4.2\no Cube\nv 1 1 1\n", "an OBJ mesh"),
            (b"[render]\nspp = 4\n", "a text"),
        ] {
            assert_eq!(other(bytes), name);
        }
        let pointer = other(b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
        assert!(pointer.contains("git lfs pull"), "{pointer}");
    }

    #[test]
    fn images_are_known_whatever_they_are_called() {
        for (bytes, format) in [
            (b"#?RGBE\n".as_slice(), Format::Hdr),
            (b"rpict -vp 0 0 0 room.oct\nFORMAT=32-bit_rle_rgbe\n\n", Format::Hdr),
            (b"Pf\n1 1\n", Format::Pfm),
            (b"\x76\x2f\x31\x01\x02\0\0\0", Format::Exr),
        ] {
            assert_eq!(Content::of(bytes), Content::Image(format));
        }
        assert_eq!(Content::of(b"\x01\x02\x03\x80"), Content::Unknown);
    }
}
