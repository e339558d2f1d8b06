//! Files as bytes and as text, with limits, and the words for what can go wrong.

use std::fs::{self, File, FileType};
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
        Err(error) => {
            let (title, help) = unreadable("scene", path, &error);
            Err(Fault::of_file(title).maybe_help(help))
        }
        Ok(_) if bytes.len() as u64 > SCENE_BYTES => {
            Err(Fault::of_file(format!("the scene file is longer than {SCENE_BYTES} bytes"))
                .help("large geometry belongs into mesh files: `[[mesh]] file = \"...\"`"))
        }
        Ok(_) => Ok(bytes),
    }
}

/// The bytes of a mesh file, or why there are none and a file that was perhaps meant.
pub fn mesh_bytes(path: &Path) -> Result<Vec<u8>, Answer> {
    let read =
        fs::metadata(path).and_then(|about| if about.is_file() { fs::read(path).map(Ok) } else { Ok(Err(about)) });
    match read {
        Ok(Ok(bytes)) => Ok(bytes),
        Ok(Err(about)) => Err(not_a_file("mesh", about.file_type())),
        Err(error) => Err(unreadable("mesh", path, &error)),
    }
}

/// Why there is no file to read, and what was perhaps meant.
type Answer = (String, Option<String>);

fn unreadable(what: &str, path: &Path, error: &io::Error) -> Answer {
    if path.is_dir() {
        return (format!("the {what} file is a folder"), Some("name a file in it".to_owned()));
    }
    if let Some(target) =
        fs::read_link(path).ok().filter(|_| !path.exists() && error.kind() != io::ErrorKind::PermissionDenied)
    {
        let help = format!("it leads to `{}`, which is not there", target.display());
        return (format!("the {what} file is a link to nothing"), Some(help));
    }
    match error.kind() {
        io::ErrorKind::NotFound => (format!("there is no such {what} file"), similar(path)),
        io::ErrorKind::PermissionDenied => (format!("the {what} file may not be read"), None),
        io::ErrorKind::NotADirectory => (format!("there is no such {what} file: part of its path is no folder"), None),
        _ => (format!("the {what} file cannot be read: {error}"), None),
    }
}

/// Meshes are read from files only: a pipe might never end.
fn not_a_file(what: &str, kind: FileType) -> Answer {
    if kind.is_dir() {
        return (format!("the {what} file is a folder"), Some("name a file in it".to_owned()));
    }
    (format!("the {what} file is {}, not a file", special(kind)), Some("write it to a file, and name that".to_owned()))
}

#[cfg(unix)]
fn special(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "a pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn special(_: FileType) -> &'static str {
    "a device"
}

/// Advice that names the file in the same folder whose name is nearest, or the folder that is missing.
fn similar(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = fs::read_dir(folder) else {
        return Some(format!("there is no folder `{}`", folder.display())).filter(|_| !folder.exists());
    };
    let files = entries.filter_map(Result::ok).filter(|entry| entry.path().is_file());
    let mut names: Vec<String> = files.filter_map(|entry| entry.file_name().into_string().ok()).collect();
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
    fn what_is_not_a_file_is_answered_as_what_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("folder.obj")).unwrap();
        fs::write(path("a.obj"), "").unwrap();
        let answer = |name: &str| {
            let (mesh, help) = mesh_bytes(&path(name)).unwrap_err();
            let (scene, _) = text(&path(name)).unwrap_err();
            assert_eq!((scene.title.replace("scene", "mesh"), &scene.help), (mesh.clone(), &help), "{name}");
            (mesh, help.unwrap_or_default())
        };
        assert_eq!(answer("folder.obj"), ("the mesh file is a folder".to_owned(), "name a file in it".to_owned()));
        assert_eq!(answer("folder.ob").1, "", "no folder is meant where a file is");
        assert_eq!(answer("b.obj").1, "did you mean `a.obj`?");
        let no_folder = format!("there is no folder `{}`", path("no").display());
        assert_eq!(answer("no/a.obj"), ("there is no such mesh file".to_owned(), no_folder));
        assert_eq!(answer("a.obj/b.obj").0, "there is no such mesh file: part of its path is no folder");
    }

    #[cfg(unix)]
    #[test]
    fn links_to_nothing_and_pipes_are_answered_as_what_they_are() {
        use std::os::unix::{fs::symlink, net::UnixListener};
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        symlink("nowhere.obj", path("link.obj")).unwrap();
        symlink("loop.obj", path("loop.obj")).unwrap();
        symlink(".", path("folder.obj")).unwrap();
        let nothing = "the mesh file is a link to nothing".to_owned();
        let help = "it leads to `nowhere.obj`, which is not there".to_owned();
        assert_eq!(mesh_bytes(&path("link.obj")), Err((nothing.clone(), Some(help.clone()))));
        assert_eq!(mesh_bytes(&path("loop.obj")).unwrap_err().0, nothing);
        assert_eq!(mesh_bytes(&path("folder.obj")).unwrap_err().0, "the mesh file is a folder");
        assert_eq!(text(&path("link.obj")).unwrap_err().0.help, Some(help));
        let _listener = UnixListener::bind(path("socket.obj")).unwrap();
        assert_eq!(mesh_bytes(&path("socket.obj")).unwrap_err().0, "the mesh file is a socket, not a file");
        assert_eq!(mesh_bytes(Path::new("/dev/null")).unwrap_err().0, "the mesh file is a device, not a file");
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
