//! Where files go: checked before rendering, replaced atomically after it.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use xxhash_rust::xxh3::xxh3_64;

use crate::{Format, FormatError};

/// A destination that cannot be written, found before there is anything to write.
#[derive(Debug, thiserror::Error)]
pub enum DestinationError {
    /// The file name says no known format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The folder does not exist.
    #[error("{}: there is no folder '{}'", .path.display(), .folder.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The folder that it would lie in.
        folder: PathBuf,
    },
    /// There is something else than a file.
    #[error("{}: is there already and is not a file", .path.display())]
    NotAFile {
        /// The destination.
        path: PathBuf,
    },
    /// The file system has no such long names.
    #[error("{}: the file name is too long: it has {} bytes, and most file systems take 255", .path.display(), length(.path))]
    NameTooLong {
        /// The file.
        path: PathBuf,
    },
    /// No file can be made in the folder.
    #[error("{}: the folder '{}' cannot be written: {error}", .path.display(), .folder.display())]
    NotWritable {
        /// The file.
        path: PathBuf,
        /// The folder that it would lie in.
        folder: PathBuf,
        /// What the system says.
        error: io::Error,
    },
}

/// Whether an image can be written to `path`, and in which format. Makes and removes an empty file beside it.
///
/// # Errors
/// An unknown extension, a missing or read-only folder, or something at `path` that is no file.
pub fn check_destination(path: &Path) -> Result<Format, DestinationError> {
    let format = Format::from_path(path)?;
    check_place(path)?;
    Ok(format)
}

/// Whether a file can be written to `path`. Makes and removes an empty file beside it.
///
/// # Errors
/// A missing or read-only folder, or something at `path` that is no file.
pub fn check_place(path: &Path) -> Result<(), DestinationError> {
    let target = resolve(path);
    let folder = folder_of(&target);
    if !folder.is_dir() {
        return Err(DestinationError::NoFolder { path: path.into(), folder: folder.into() });
    }
    match fs::metadata(&target) {
        Ok(there) if !there.is_file() => return Err(DestinationError::NotAFile { path: path.into() }),
        Err(error) if error.kind() == io::ErrorKind::InvalidFilename => {
            return Err(DestinationError::NameTooLong { path: path.into() });
        }
        Ok(_) | Err(_) => {}
    }
    let trial = temporary_of(&target);
    match create(&trial).and_then(|_| fs::remove_file(&trial)) {
        Ok(()) => Ok(()),
        Err(error) => Err(DestinationError::NotWritable { path: path.into(), folder: folder.into(), error }),
    }
}

/// Puts what `fill` writes in the place of `path`. Whatever goes wrong, and whenever the process is killed, `path` is
/// what it was or the whole new file, and no other file is left unless it is killed.
///
/// # Errors
/// What the system or `fill` answers.
pub fn replace(path: &Path, fill: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let target = resolve(path);
    let temporary = temporary_of(&target);
    let result = write_through(&temporary, fill).and_then(|()| fs::rename(&temporary, &target));
    if result.is_err() {
        // It may not even exist: the first error is the one to tell.
        let _ = fs::remove_file(&temporary);
        return result;
    }
    sync_folder(folder_of(&target));
    Ok(())
}

fn write_through(path: &Path, fill: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let mut file = create(path)?;
    fill(&mut file)?;
    file.flush()?;
    file.sync_all()
}

/// Makes a file that was not there; one of a killed process that had our number is removed first.
fn create(path: &Path) -> io::Result<File> {
    match File::create_new(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            fs::remove_file(path)?;
            File::create_new(path)
        }
        result => result,
    }
}

/// The file behind `path`: a link is followed, so that it stays a link.
fn resolve(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.into())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// `.NAME.PID.tmp` beside `path`: in the same folder, hence on the same disk, so that a rename suffices.
///
/// Where NAME is long, a piece of it and its hash stand for it: what the file system takes for the name it takes for
/// this too.
pub fn temporary_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default();
    let ending = format!(".{}.tmp", std::process::id());
    let mut temporary = OsString::from(".");
    match 1 + name.len() + ending.len() <= ALWAYS_TAKEN.max(name.len()) {
        true => temporary.push(name),
        false => temporary.push(shortened(name)),
    }
    temporary.push(ending);
    path.with_file_name(temporary)
}

/// Bytes of a name that every file system takes.
const ALWAYS_TAKEN: usize = 64;

fn shortened(name: &OsStr) -> String {
    let piece: String = name.to_string_lossy().chars().filter(char::is_ascii_alphanumeric).take(20).collect();
    format!("{piece}.{:016x}", xxh3_64(name.as_encoded_bytes()))
}

/// Bytes of the name of a file.
fn length(path: &Path) -> usize {
    path.file_name().unwrap_or_default().len()
}

/// Makes the rename last through a power cut, where folders can be synchronised; the file is in place in any case.
fn sync_folder(folder: &Path) {
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_failed_write_keeps_the_old_file_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pfm");
        fs::write(&path, "old").unwrap();
        let error = replace(&path, |file| {
            file.write_all(b"half of the n")?;
            Err(io::Error::other("disk full"))
        });
        assert_eq!(error.unwrap_err().to_string(), "disk full");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.pfm"]);
    }

    #[test]
    fn a_failed_rename_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("a.pfm/full")).unwrap();
        assert!(replace(&folder.path().join("a.pfm"), |file| file.write_all(b"new")).is_err());
        assert_eq!(names(folder.path()), ["a.pfm"]);
    }

    #[test]
    fn the_old_file_stands_until_the_new_one_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pfm");
        fs::write(&path, "old").unwrap();
        let fill = |file: &mut File| {
            file.write_all(b"new")?;
            assert_eq!(fs::read(&path)?, b"old");
            assert_eq!(names(folder.path()), [format!(".a.pfm.{}.tmp", std::process::id()), "a.pfm".into()]);
            Ok(())
        };
        replace(&path, fill).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names(folder.path()), ["a.pfm"]);
    }

    #[test]
    fn the_remains_of_a_killed_process_are_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pfm");
        fs::write(temporary_of(&path), "remains that are longer").unwrap();
        replace(&path, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a.pfm"), folder.path().join("b.pfm"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        replace(&link, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }

    #[test]
    fn what_cannot_be_written_is_found_before() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        assert!(matches!(check_destination(&at("a.jpg")), Err(DestinationError::Format(_))));
        assert!(matches!(check_destination(&at("no/a.png")), Err(DestinationError::NoFolder { .. })));
        fs::create_dir(at("folder.png")).unwrap();
        assert!(matches!(check_destination(&at("folder.png")), Err(DestinationError::NotAFile { .. })));
        let too_long = check_destination(&at(&format!("{}.png", "a".repeat(252)))).unwrap_err();
        assert!(matches!(too_long, DestinationError::NameTooLong { .. }));
        assert!(too_long.to_string().ends_with("it has 256 bytes, and most file systems take 255"), "{too_long}");
        assert_eq!(names(folder.path()), ["folder.png"]);
    }

    #[test]
    fn a_long_name_is_a_good_name() {
        let folder = tempfile::tempdir().unwrap();
        for letter in ["a", "\u{e9}"] {
            for length in [30, 60, 100, 246, 251] {
                let name = letter.repeat(length / letter.len()) + ".png";
                let path = folder.path().join(&name);
                assert_eq!(check_destination(&path).unwrap(), Format::Png);
                replace(&path, |file| file.write_all(b"new")).unwrap();
                assert_eq!((fs::read(&path).unwrap(), names(folder.path())), (b"new".to_vec(), vec![name]));
                assert!(length < 60 || super::length(&temporary_of(&path)) <= super::length(&path).max(64));
                fs::remove_file(path).unwrap();
            }
        }
    }

    #[test]
    fn long_names_that_begin_alike_do_not_share_a_temporary() {
        let [a, b] = ["1", "2"].map(|end| temporary_of(Path::new(&format!("{}{end}.png", "a".repeat(240)))));
        assert_ne!(a, b);
    }

    #[test]
    fn a_good_destination_is_left_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        assert_eq!(check_destination(&path).unwrap(), Format::Exr);
        fs::write(&path, "old").unwrap();
        assert_eq!(check_destination(&path).unwrap(), Format::Exr);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.exr"]);
    }
}
