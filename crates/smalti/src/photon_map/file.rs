//! The file: a line that names it, a header, and chunks (what was sent ahead, then rounds), each with its checksum; a last
//! chunk says that nothing is missing. Numbers are little-endian.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use smalti_core::photon::Maps;
use smalti_core::photon::maps::{Kept, Pilots};
use smalti_core::settings::Settings;
use xxhash_rust::xxh3::xxh3_64;

const MAGIC: &[u8] = b"smalti photon map 2\n";
/// The part of [`MAGIC`] that files of other formats share.
const NAME: &[u8] = b"smalti photon map ";
/// The chunk of what was sent ahead; rounds have their numbers.
const AHEAD: u32 = u32::MAX;
/// The chunk at the end.
const END: u32 = u32::MAX - 1;
/// Number, length and checksum of a chunk, before its bytes.
const CHUNK: usize = 20;

/// What the photons in a file depend on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// The version that traced them.
    pub version: String,
    /// The estimator that traced them: another traces others.
    pub estimator: u32,
    pub scene_hash: String,
    pub integrator: String,
    /// Photons of a round and map.
    pub photons: u32,
    /// Of the first round, metres; none: by density and the size of pixels.
    pub radius: Option<f64>,
    /// Rows of the picture, by which radii are at least a part of a pixel.
    pub rows: u32,
    pub seed: u64,
    pub sampler: String,
    pub fresnel: String,
    pub max_bounces: Option<u32>,
    /// Light samples at a vertex: without any there are no shadow photons.
    pub shadow_rays: bool,
}

impl Header {
    /// For a render of this scene with these settings.
    pub fn new(scene_hash: &str, settings: &Settings) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            estimator: smalti_core::ESTIMATOR,
            scene_hash: scene_hash.into(),
            integrator: settings.integrator.name().into(),
            photons: settings.photons_of_round(),
            radius: settings.radius,
            rows: settings.height,
            seed: settings.seed,
            sampler: settings.sampler.name().into(),
            fresnel: settings.fresnel.name().into(),
            max_bounces: settings.max_bounces,
            shadow_rays: settings.shadow_rays > 0,
        }
    }

    /// The first thing in which the file (`self`) is not what a render asks for, in words.
    fn difference(&self, asked: &Self) -> Option<String> {
        let pairs = [
            ("version of smalti", self.version.clone(), asked.version.clone()),
            ("estimator", self.estimator.to_string(), asked.estimator.to_string()),
            ("scene (by its hash)", self.scene_hash.clone(), asked.scene_hash.clone()),
            ("integrator", self.integrator.clone(), asked.integrator.clone()),
            ("number of photons", self.photons.to_string(), asked.photons.to_string()),
            ("radius", words(self.radius), words(asked.radius)),
            ("height of the picture", self.rows.to_string(), asked.rows.to_string()),
            ("seed", self.seed.to_string(), asked.seed.to_string()),
            ("sampler", self.sampler.clone(), asked.sampler.clone()),
            ("fresnel", self.fresnel.clone(), asked.fresnel.clone()),
            ("max_bounces", words(self.max_bounces), words(asked.max_bounces)),
            ("shadow rays", self.shadow_rays.to_string(), asked.shadow_rays.to_string()),
        ];
        let differs = pairs.into_iter().find(|(_, there, asked)| there != asked);
        differs.map(|(what, there, asked)| format!("its {what} is {there}, this render asks for {asked}"))
    }
}

fn words<T: ToString>(value: Option<T>) -> String {
    value.map_or("none".into(), |value| value.to_string())
}

/// A file that is not what it should be.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// It cannot be read.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// It begins otherwise.
    #[error("is no photon map of smalti")]
    Foreign,
    /// It is of another format.
    #[error("is a photon map of an older or newer smalti, whose photons do not fit. Delete it, and it is made anew")]
    OtherFormat,
    /// Bytes are missing or changed.
    #[error("is damaged: {0}. Delete it, and it is made anew")]
    Damaged(&'static str),
    /// Photons of something else.
    #[error("does not fit: {0}. Name another file, or delete this one")]
    Other(String),
}

/// The header of a file.
pub fn header(path: &Path) -> Result<Header, FileError> {
    header_of(&mut File::open(path)?)
}

fn header_of(file: &mut File) -> Result<Header, FileError> {
    let mut magic = [0; MAGIC.len()];
    match file.read_exact(&mut magic) {
        Ok(()) if magic == *MAGIC => {}
        Ok(()) if magic.starts_with(NAME) => return Err(FileError::OtherFormat),
        Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => return Err(error.into()),
        _ => return Err(FileError::Foreign),
    }
    let (number, bytes) = chunk(file)?;
    let header = postcard::from_bytes(&bytes).ok().filter(|_| number == 0);
    header.ok_or(FileError::Damaged("its header cannot be read"))
}

/// The next chunk: its number and bytes.
fn chunk(file: &mut File) -> Result<(u32, Vec<u8>), FileError> {
    const SHORT: FileError = FileError::Damaged("it ends too early");
    let mut head = [0; CHUNK];
    file.read_exact(&mut head).map_err(|_| SHORT)?;
    let number = u32::from_le_bytes(head[..4].try_into().expect("four"));
    let [length, checksum] = [4, 12].map(|at| u64::from_le_bytes(head[at..at + 8].try_into().expect("eight")));
    // A damaged length must not become an allocation.
    if length > file.metadata()?.len() {
        return Err(SHORT);
    }
    let mut bytes = vec![0; length as usize];
    file.read_exact(&mut bytes).map_err(|_| SHORT)?;
    if checksum_of(number, &bytes) != checksum {
        return Err(FileError::Damaged("its checksum is another"));
    }
    Ok((number, bytes))
}

fn checksum_of(number: u32, bytes: &[u8]) -> u64 {
    xxh3_64(bytes) ^ xxh3_64(&number.to_le_bytes()).rotate_left(1)
}

fn write_chunk(file: &mut impl Write, number: u32, bytes: &[u8]) -> io::Result<()> {
    file.write_all(&number.to_le_bytes())?;
    file.write_all(&(bytes.len() as u64).to_le_bytes())?;
    file.write_all(&checksum_of(number, bytes).to_le_bytes())?;
    file.write_all(bytes)
}

/// A file that is read.
pub struct Reader {
    file: File,
    /// Where the chunk of each round begins.
    rounds: HashMap<u32, u64>,
    pilots: Pilots,
}

impl Reader {
    /// Opens a file for a render that asks for `header`; reads all of it once.
    pub fn open(path: &Path, asked: &Header) -> Result<Self, FileError> {
        let mut file = File::open(path)?;
        let there = header_of(&mut file)?;
        if let Some(difference) = there.difference(asked) {
            return Err(FileError::Other(difference));
        }
        let mut reader = Self { file, rounds: HashMap::new(), pilots: Pilots::default() };
        loop {
            let at = reader.file.stream_position()?;
            match chunk(&mut reader.file)? {
                (END, _) => return Ok(reader),
                (AHEAD, bytes) => {
                    let pilots = postcard::from_bytes(&bytes);
                    reader.pilots = pilots.map_err(|_| FileError::Damaged("photons sent ahead cannot be read"))?;
                }
                (round, _) => {
                    reader.rounds.insert(round, at);
                }
            }
        }
    }

    /// The photons of a round; `None` where it is not there (or the file changed meanwhile).
    pub fn read(&mut self, round: u32) -> Option<(Kept, Pilots)> {
        self.file.seek(SeekFrom::Start(*self.rounds.get(&round)?)).ok()?;
        let (_, bytes) = chunk(&mut self.file).ok().filter(|(number, _)| *number == round)?;
        let kept: Kept = postcard::from_bytes(&bytes).ok().filter(|kept: &Kept| kept.round == round)?;
        Some((kept, self.pilots.clone()))
    }
}

/// A file in the making, beside its place.
pub struct Writer {
    temporary: PathBuf,
    file: BufWriter<File>,
    ahead: bool,
}

impl Writer {
    /// Begins a file that will be at `path`: a new one, or what is at `before` and more.
    pub fn new(path: &Path, header: &Header, before: Option<&PathBuf>) -> io::Result<Self> {
        let temporary = smalti_image::temporary_of(path);
        let mut file = BufWriter::new(File::create(&temporary)?);
        if let Some(before) = before {
            let old = File::open(before)?;
            let length = old.metadata()?.len() - CHUNK as u64;
            io::copy(&mut old.take(length), &mut file)?;
        } else {
            file.write_all(MAGIC)?;
            write_chunk(&mut file, 0, &encoded(header)?)?;
        }
        Ok(Self { temporary, file, ahead: before.is_some() })
    }

    /// Adds a round.
    pub fn put(&mut self, maps: &Maps) -> io::Result<()> {
        if !self.ahead {
            self.ahead = true;
            write_chunk(&mut self.file, AHEAD, &encoded(&maps.pilots())?)?;
        }
        write_chunk(&mut self.file, maps.round, &encoded(&maps.kept())?)
    }

    /// Ends it, and puts it in its place.
    pub fn finish(mut self, path: &Path) -> io::Result<()> {
        write_chunk(&mut self.file, END, &[])?;
        self.file.flush()?;
        self.file.get_ref().sync_all()?;
        fs::rename(&self.temporary, path)
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        // Once it is in its place there is nothing left to remove.
        let _ = fs::remove_file(&self.temporary);
    }
}

fn encoded(value: &impl Serialize) -> io::Result<Vec<u8>> {
    postcard::to_stdvec(value).map_err(io::Error::other)
}
