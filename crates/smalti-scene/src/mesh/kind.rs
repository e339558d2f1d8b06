//! Files that are no mesh although their name says so: known by how they begin, and answered with what to do.

/// What a file is instead of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stranger {
    /// What it is, as it ends the sentence 'the mesh file is ...'.
    pub is: &'static str,
    /// What to do.
    pub help: &'static str,
}

const TEXT: &str = "save it as text in UTF-8";
const UNPACK: &str = "unpack it, and name the mesh in it";
const EXPORT: &str = "meshes are read from PLY and OBJ files: export it as one of them";
const PICTURE: &str = "name a PLY or OBJ file; textures are not read";
const FETCH: &str = "fetch the file itself: `git lfs pull` in its repository";
const DOWNLOAD: &str = "fetch the file itself: a link to it often shows a page about it";

/// How files begin that are often met in place of a mesh.
const BEGINNINGS: &[(&[u8], &str, &str)] = &[
    (b"\xff\xfe", "text in UTF-16", TEXT),
    (b"\xfe\xff", "text in UTF-16", TEXT),
    (b"version https://git-lfs.github.com/spec/", "a pointer of git-lfs, not the file that it stands for", FETCH),
    (b"\x1f\x8b", "compressed (gzip)", UNPACK),
    (b"PK\x03\x04", "an archive (zip)", UNPACK),
    (b"BZh", "compressed (bzip2)", UNPACK),
    (b"\xfd7zXZ\0", "compressed (xz)", UNPACK),
    (b"\x28\xb5\x2f\xfd", "compressed (zstd)", UNPACK),
    (b"7z\xbc\xaf\x27\x1c", "an archive (7z)", UNPACK),
    (b"Rar!", "an archive (rar)", UNPACK),
    (b"solid ", "an STL file", EXPORT),
    (b"glTF", "a glTF file", EXPORT),
    (b"Kaydara FBX", "an FBX file", EXPORT),
    (b"; FBX", "an FBX file", EXPORT),
    (b"BLENDER", "a file of Blender", EXPORT),
    (b"OFF", "an OFF file", EXPORT),
    (b"#VRML", "a VRML file", EXPORT),
    (b"#usda", "a USD file", EXPORT),
    (b"PXR-USDC", "a USD file", EXPORT),
    (b"Ogawa", "an Alembic file", EXPORT),
    (b"# vtk", "a VTK file", EXPORT),
    (b"%PDF", "a PDF file", EXPORT),
    (b"\x89PNG", "a picture (PNG)", PICTURE),
    (b"\xff\xd8\xff", "a picture (JPEG)", PICTURE),
    (b"GIF8", "a picture (GIF)", PICTURE),
    (b"II*\0", "a picture (TIFF)", PICTURE),
    (b"MM\0*", "a picture (TIFF)", PICTURE),
    (b"\x76\x2f\x31\x01", "a picture (EXR)", PICTURE),
    (b"#?RADIANCE", "a picture (HDR)", PICTURE),
    (b"#?RGBE", "a picture (HDR)", PICTURE),
];

/// How texts begin behind white space, whatever their capitals.
const TEXTS: &[(&str, &str, &str)] = &[
    ("<!doctype html", "a page in HTML", DOWNLOAD),
    ("<html", "a page in HTML", DOWNLOAD),
    ("<?xml", "an XML file", EXPORT),
    ("{", "a JSON file, perhaps glTF", EXPORT),
];

/// What the file is, if it is known not to be a mesh of its kind, which `extension` names in lower case.
pub fn stranger(bytes: &[u8], extension: &str) -> Option<Stranger> {
    let by_content = if bytes.is_empty() {
        Some(("empty", "write or fetch it again"))
    } else {
        beginning(bytes).or_else(|| begins_as_text(bytes)).or_else(|| by_shape(bytes))
    };
    let (is, help) = by_content.or_else(|| other_mesh(bytes, extension))?;
    Some(Stranger { is, help })
}

fn beginning(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    BEGINNINGS.iter().find(|(start, ..)| bytes.starts_with(start)).map(|(_, is, help)| (*is, *help))
}

fn begins_as_text(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let text = super::text::without_mark(bytes).trim_ascii_start();
    let begins =
        |start: &str| text.get(..start.len()).is_some_and(|found| found.eq_ignore_ascii_case(start.as_bytes()));
    TEXTS.iter().find(|(start, ..)| begins(start)).map(|(_, is, help)| (*is, *help))
}

/// What has no beginning of its own: UTF-16 without a mark, STL in binary, nothing but zeros.
fn by_shape(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let triangles = bytes.get(80..84).map(|count| u32::from_le_bytes(count.try_into().unwrap_or_default()));
    match bytes {
        [0, letter, 0, _, ..] | [letter, 0, _, 0, ..] if *letter != 0 => Some(("text in UTF-16", TEXT)),
        _ if bytes.iter().all(|byte| *byte == 0) => Some(("nothing but zeros", "write or fetch it again")),
        _ if triangles.is_some_and(|count| bytes.len() as u64 == 84 + 50 * u64::from(count)) => {
            Some(("an STL file", EXPORT))
        }
        _ => None,
    }
}

/// A mesh of the other kind.
fn other_mesh(bytes: &[u8], extension: &str) -> Option<(&'static str, &'static str)> {
    let text = super::text::without_mark(bytes);
    let is_ply = text.starts_with(b"ply\n") || text.starts_with(b"ply\r");
    let is_obj = || {
        let mut statements = super::text::Lines::new(text, 1).map(|(_, line)| line.trim_ascii_start());
        let first = statements.find(|line| !line.is_empty() && !line.starts_with(b"#"));
        first.is_some_and(|line| [&b"v "[..], b"o ", b"g ", b"mtllib "].iter().any(|start| line.starts_with(start)))
    };
    match extension {
        "obj" if is_ply => Some(("a PLY file", "let its name end in .ply")),
        "ply" if !is_ply && is_obj() => Some(("an OBJ file", "let its name end in .obj")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is(bytes: &[u8], extension: &str) -> &'static str {
        stranger(bytes, extension).map_or("", |stranger| stranger.is)
    }

    #[test]
    fn strangers_are_known_by_how_they_begin() {
        let utf16 = |to: fn(u16) -> [u8; 2]| "v 0 0 0\n".encode_utf16().flat_map(to).collect::<Vec<u8>>();
        let mut stl = vec![b' '; 84];
        stl[80..].copy_from_slice(&2u32.to_le_bytes());
        stl.extend([7; 100]);
        for (bytes, expected) in [
            (&b""[..], "empty"),
            (&[0; 300], "nothing but zeros"),
            (&[&b"\xff\xfe"[..], &utf16(u16::to_le_bytes)].concat(), "text in UTF-16"),
            (&[&b"\xfe\xff"[..], &utf16(u16::to_be_bytes)].concat(), "text in UTF-16"),
            (&utf16(u16::to_le_bytes), "text in UTF-16"),
            (&utf16(u16::to_be_bytes), "text in UTF-16"),
            (b"\n  <!DOCTYPE html>\n<html>", "a page in HTML"),
            (b"<HTML>", "a page in HTML"),
            (
                b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n",
                "a pointer of git-lfs, not the file that it stands for",
            ),
            (b"\x1f\x8b\x08", "compressed (gzip)"),
            (b"PK\x03\x04", "an archive (zip)"),
            (b"solid bunny\n", "an STL file"),
            (&stl, "an STL file"),
            (b"glTF\x02\0\0\0", "a glTF file"),
            (b"{\"asset\": {}}", "a JSON file, perhaps glTF"),
            (b"\x89PNG\r\n", "a picture (PNG)"),
        ] {
            assert_eq!((is(bytes, "obj"), is(bytes, "ply")), (expected, expected));
        }
    }

    #[test]
    fn meshes_are_no_strangers_unless_their_name_is_wrong() {
        for mesh in [&b"# solid\nv 0 0 0\n"[..], b"\xef\xbb\xbfo thing\nv 0 0 0\n", b"v 0 0 0\n"] {
            assert_eq!((is(mesh, "obj"), is(mesh, "ply")), ("", "an OBJ file"));
        }
        for mesh in [&b"ply\nformat"[..], b"\xef\xbb\xbfply\r\n"] {
            assert_eq!((is(mesh, "obj"), is(mesh, "ply")), ("a PLY file", ""));
        }
    }
}
