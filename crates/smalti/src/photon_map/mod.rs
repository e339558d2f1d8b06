//! `--photon-map FILE`: photon maps kept from one render to the next.
//!
//! Photons do not depend on the camera, nor on the size of the image or the number of samples: cameras of one scene ask
//! the same maps. A file holds the maps of the rounds that renders have come to; a render takes what is there and traces
//! the rest, so its image is the one that it makes without the file, bit for bit.

mod file;

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use smalti_core::photon::Maps;
use smalti_core::photon::maps::{Kept, Pilots};
use smalti_core::settings::Settings;
use smalti_scheduler::Shelf;

use crate::exit::Failure;
pub use file::Header;
use file::{Reader, Writer};

/// Photon maps in a file.
pub struct PhotonMap {
    path: PathBuf,
    header: Header,
    /// What was there.
    before: Option<Mutex<Reader>>,
    /// What comes to it; `None` until something does, an error once that failed.
    after: Mutex<Option<std::io::Result<Writer>>>,
}

/// The header of the file at `path`; `None` where there is no file.
pub fn header(path: &Path) -> Result<Option<Header>, Failure> {
    path.exists().then(|| file::header(path).map_err(|error| refused(path, &error))).transpose()
}

fn refused(path: &Path, error: &impl std::fmt::Display) -> Failure {
    Failure::user(format!("{}: {error}", path.display()))
}

impl PhotonMap {
    /// Opens what is at `path`, or a place for it, for a render of the scene with these settings. Everything that is
    /// there is checked.
    ///
    /// # Errors
    /// A file that is damaged or of something else; a place that cannot be written.
    pub fn open(path: &Path, scene_hash: &str, settings: &Settings) -> Result<Self, Failure> {
        if !settings.integrator.asks_photons() {
            let name = settings.integrator.name();
            return Err(Failure::user(format!("--photon-map: {name} asks no photons; auto and photon do")));
        }
        smalti_image::check_place(path).map_err(Failure::user)?;
        let header = Header::new(scene_hash, settings);
        let before =
            path.exists().then(|| Reader::open(path, &header)).transpose().map_err(|error| refused(path, &error))?;
        Ok(Self { path: path.to_owned(), header, before: before.map(Mutex::new), after: Mutex::new(None) })
    }

    /// Puts what came to it in the place of the file.
    ///
    /// # Errors
    /// It could not be written.
    pub fn finish(self) -> Result<(), Failure> {
        let after = self.after.into_inner().unwrap_or_else(PoisonError::into_inner);
        let written = after.map_or(Ok(()), |writer| writer.and_then(|writer| writer.finish(&self.path)));
        written.map_err(|error| Failure::output(format!("{}: {error}", self.path.display())))
    }
}

impl Shelf for PhotonMap {
    fn take(&self, round: u32) -> Option<(Kept, Pilots)> {
        lock(self.before.as_ref()?).read(round)
    }

    fn put(&self, maps: &Maps) {
        let mut after = lock(&self.after);
        let before = self.before.as_ref().map(|_| &self.path);
        let writer = after.get_or_insert_with(|| Writer::new(&self.path, &self.header, before));
        let put = writer.as_mut().map(|writer| writer.put(maps));
        if let Ok(Err(error)) = put {
            *after = Some(Err(error));
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
