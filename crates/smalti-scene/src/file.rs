//! Files as bytes and as text, with limits, and the words for what can go wrong.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use crate::document::nearest;
use crate::error::Fault;

/// Scene files are small: a longer one is not a scene, or belongs into a mesh file.
const SCENE_BYTES: u64 = 64 << 20;

/// The text of a scene file, or what is wrong with it and the text as far as it can be shown.
pub fn text(path: &Path) -> Result<String, (Box<Fault>, String)> {
    let bytes = scene_bytes(path).map_err(|fault| (fault, String::new()))?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let shown = String::from_utf8_lossy(error.as_bytes()).into_owned();
        let fault = Fault::at(at..at + '\u{fffd}'.len_utf8(), "the file is not UTF-8 text", "this byte");
        (fault.help("a scene is a TOML file in UTF-8"), shown)
    })
}

/// The bytes of a scene; from a pipe too, so the limit holds while reading.
fn scene_bytes(path: &Path) -> Result<Vec<u8>, Box<Fault>> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(SCENE_BYTES + 1).read_to_end(&mut bytes));
    match read {
        Err(error) => Err(Fault::of_file(unreadable("scene", &error)).maybe_help(similar(path))),
        Ok(_) if bytes.len() as u64 > SCENE_BYTES => {
            Err(Fault::of_file(format!("the scene file is longer than {SCENE_BYTES} bytes"))
                .help("large geometry belongs into mesh files: `[[mesh]] file = \"...\"`"))
        }
        Ok(_) => Ok(bytes),
    }
}

/// The bytes of a mesh file, or why there are none and a file that was perhaps meant.
pub fn mesh_bytes(path: &Path) -> Result<Vec<u8>, (String, Option<String>)> {
    let read = fs::metadata(path).and_then(|about| {
        if about.is_file() { fs::read(path) } else { Err(io::Error::from(io::ErrorKind::IsADirectory)) }
    });
    read.map_err(|error| (unreadable("mesh", &error), similar(path)))
}

fn unreadable(what: &str, error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => format!("there is no such {what} file"),
        io::ErrorKind::PermissionDenied => format!("the {what} file may not be read"),
        io::ErrorKind::IsADirectory => format!("the {what} file is not a file"),
        _ => format!("the {what} file cannot be read: {error}"),
    }
}

/// Advice that names the file in the same folder whose name is nearest.
fn similar(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = fs::read_dir(folder).ok()?;
    let mut names: Vec<String> = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    names.sort();
    let name = nearest(path.file_name()?.to_str()?, names.iter().map(String::as_str))?;
    Some(format!("did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_file_is_answered_with_its_neighbour() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("room.toml"), "").unwrap();
        let (fault, _) = text(&folder.path().join("rom.toml")).unwrap_err();
        assert_eq!(fault.title, "there is no such scene file");
        assert_eq!(fault.help.unwrap(), "did you mean `room.toml`?");
    }

    #[test]
    fn a_folder_is_not_a_mesh() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(mesh_bytes(folder.path()).unwrap_err().0, "the mesh file is not a file");
    }

    #[test]
    fn the_first_byte_that_is_not_utf_8_is_shown() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("latin.toml");
        fs::write(&path, b"# caf\xe9\n").unwrap();
        let (fault, shown) = text(&path).unwrap_err();
        assert_eq!(&shown[fault.span.unwrap()], "\u{fffd}");
    }
}
