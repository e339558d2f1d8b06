//! The folder of a study: found or made, written so that a killed process leaves nothing half done.

use std::cell::OnceCell;
use std::fs::{self, File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

use smalti_core::film::Image;
use smalti_image::Provenance;
use smalti_report::{FORMAT, Study};

use super::question::{self, Question};
use crate::exit::Failure;

/// Where a study is kept.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    /// The folder itself, locked as long as this process works in it.
    held: OnceCell<File>,
}

/// The file with everything in it.
const RECORD: &str = "study.json";

/// The folder of each arm's first image.
const IMAGES: &str = "images";

impl Folder {
    /// The folder that was named, or one here by the names of scene and preset. Nothing is made yet.
    ///
    /// # Errors
    /// Something there that is no folder, or no place for one; a folder with something else in it than a study.
    pub fn checked(typed: Option<&Path>, scene: &Path, preset: &str) -> Result<Self, Failure> {
        let no_name = || Failure::user(format!("{} is no scene file", scene.display()));
        let path = match typed {
            Some(path) => path.to_owned(),
            None => format!("{}-study-{preset}", scene.file_stem().ok_or_else(no_name)?.to_string_lossy()).into(),
        };
        let folder = Self { path, held: OnceCell::new() };
        folder.check()?;
        Ok(folder)
    }

    fn check(&self) -> Result<(), Failure> {
        let shown = self.path.display();
        if self.path.is_dir() {
            let is_empty = fs::read_dir(&self.path).map_err(Failure::user)?.next().is_none();
            let message = format!("{shown}: the folder is not empty and has no study in it; take another one with -o");
            return if is_empty || self.file(RECORD).is_file() {
                self.check_place()
            } else {
                Err(Failure::user(message))
            };
        }
        if self.path.exists() {
            return Err(Failure::user(format!("{shown}: is there already and is not a folder")));
        }
        // Where the folder can be made a file can.
        smalti_image::check_place(&self.path).map_err(Failure::user)
    }

    fn check_place(&self) -> Result<(), Failure> {
        smalti_image::check_place(&self.file(RECORD)).map_err(Failure::user)
    }

    /// A file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Its path as typed.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The study that is there, if it answers `question`; `fresh`: whatever is there goes.
    ///
    /// # Errors
    /// A study with another question, or what is not a study of this format; another process works on it.
    pub fn open(&self, question: &Question, fresh: bool) -> Result<Option<Study>, Failure> {
        if self.path.is_dir() {
            self.hold()?;
        }
        if !self.file(RECORD).is_file() {
            return Ok(None);
        }
        let there = self.read();
        if fresh {
            there.iter().for_each(|study| self.clear(study));
            return Ok(None);
        }
        let study = there?;
        let differences = question::differences(&study.question, question);
        if differences.is_empty() {
            return Ok(Some(study));
        }
        Err(Failure::user(format!(
            "{} holds the answer to another question: {}. Take another folder with -o, or begin anew with --fresh",
            self.path.display(),
            differences.join("; ")
        )))
    }

    /// Keeps other processes out: each would write over what the others found.
    fn hold(&self) -> Result<(), Failure> {
        if self.held.get().is_some() {
            return Ok(());
        }
        // Some systems cannot lock a folder.
        let Ok(file) = File::open(&self.path) else { return Ok(()) };
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            let shown = self.path.display();
            return Err(Failure::user(format!("{shown}: another process is at work on the study that is there")));
        }
        self.held.get_or_init(|| file);
        Ok(())
    }

    fn read(&self) -> Result<Study, Failure> {
        let path = self.file(RECORD);
        let refused = |what: String| Failure::user(format!("{}: {what}; --fresh begins anew", path.display()));
        let text = fs::read_to_string(&path).map_err(|error| refused(format!("cannot be read: {error}")))?;
        let study: Study =
            serde_json::from_str(&text).map_err(|error| refused(format!("is no study of this version: {error}")))?;
        match study.format {
            FORMAT => Ok(study),
            other => Err(refused(format!("is a study of format {other}, not {FORMAT}"))),
        }
    }

    /// Removes what a study left.
    fn clear(&self, study: &Study) {
        let images = study.arms.iter().flat_map(|arm| [arm.picture.as_ref(), arm.image.as_ref()]).flatten();
        for name in images.chain(study.references.iter().map(|reference| &reference.file)) {
            // What is gone already is gone.
            let _ = fs::remove_file(self.file(name));
        }
    }

    /// Makes the folder.
    ///
    /// # Errors
    /// What the system answers; another process works in it.
    pub fn make(&self) -> Result<(), Failure> {
        fs::create_dir_all(self.file(IMAGES))
            .map_err(|error| Failure::user(format!("{}: cannot be made: {error}", self.path.display())))?;
        self.hold()
    }

    /// Writes the study in the place of the one that is there.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn save(&self, study: &Study) -> Result<(), Failure> {
        let text = serde_json::to_string(study).map_err(Failure::bug)?;
        self.write(RECORD, (text + "\n").as_bytes())
    }

    /// Writes a file whole.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        let path = self.file(name);
        smalti_image::replace(&path, |file| file.write_all(bytes))
            .map_err(|error| Failure::output(format!("{}: cannot be written: {error}", path.display())))
    }

    /// Writes an arm's image; returns the names of the picture and of the linear image.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write_image(
        &self,
        arm: &str,
        image: &Image,
        provenance: &Provenance,
        exposure: f32,
    ) -> Result<[String; 2], Failure> {
        let names = ["png", "pfm"].map(|extension| format!("{IMAGES}/{arm}.{extension}"));
        for name in &names {
            smalti_image::write(&self.file(name), image, provenance, exposure).map_err(Failure::output)?;
        }
        Ok(names)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_has_the_names_of_scene_and_preset() {
        let named = |scene: &str| Folder::checked(None, Path::new(scene), "sweep").map(|folder| folder.path);
        assert_eq!(named("far/away/room.toml"), Ok("room-study-sweep".into()));
        assert!(named("..").is_err());
    }

    #[test]
    fn a_folder_of_something_else_is_left_alone() {
        let place = tempfile::tempdir().unwrap();
        let checked = |name: &str| Folder::checked(Some(&place.path().join(name)), Path::new("a.toml"), "sweep");
        assert!(checked("new").is_ok() && checked("").is_ok());
        fs::write(place.path().join("letter.txt"), "dear").unwrap();
        assert!(checked("").unwrap_err().message.contains("not empty"));
        assert!(checked("letter.txt").unwrap_err().message.contains("not a folder"));
        assert!(checked("no/new").unwrap_err().message.contains("no folder"));
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_is_no_study_is_not_overwritten_unless_asked() {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join(RECORD), "{}").unwrap();
        let folder = Folder::checked(Some(place.path()), Path::new("a.toml"), "sweep").unwrap();
        assert!(folder.open(&Question::new(), false).unwrap_err().message.contains("--fresh"));
        assert_eq!(folder.open(&Question::new(), true), Ok(None));
    }

    /// Two of the same process are kept apart as two processes are.
    #[cfg(unix)]
    #[test]
    fn one_at_a_time_works_on_a_study() {
        let place = tempfile::tempdir().unwrap();
        let folder = || Folder::checked(Some(place.path()), Path::new("a.toml"), "sweep").unwrap();
        let (first, second) = (folder(), folder());
        first.make().unwrap();
        first.make().unwrap();
        assert!(second.make().unwrap_err().message.contains("another process"));
        fs::write(place.path().join(RECORD), "{}").unwrap();
        assert!(second.open(&Question::new(), true).unwrap_err().message.contains("another process"));
        drop(first);
        assert_eq!(second.open(&Question::new(), true), Ok(None));
    }
}
