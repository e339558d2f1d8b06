//! A seeded scene for each feature, with the hash of its film and the means of its blocks as they were when someone last
//! looked: `tests/golden/NAME.txt` for `tests/scenes/golden/NAME.toml`.
//!
//! `SMALTI_BLESS=1 cargo test -p smalti-tests --test golden` rewrites them: look at the difference before committing it.
//! A mismatch says whether only bits moved, or the picture, and by how many standard errors.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

use smalti_core::film::{Estimate, Image};
use smalti_core::render::Level;
use smalti_image::hash;
use smalti_tests::draw::{Way, load, render, repository, scene_files};

const FOLDER: &str = "tests/golden";

/// Side of a block, pixels.
const BLOCK: usize = 8;

/// What is known of a render.
#[derive(Clone, Debug, PartialEq)]
struct Golden {
    hash: String,
    /// Blocks row by row from the top: mean and standard error of each channel.
    blocks: Vec<[f64; 6]>,
}

/// Renders the scene at a SIMD level.
fn rendered(path: &Path, level: Level) -> Golden {
    let loaded = load(path);
    let way = Way { threads: 2, tile: 16, level };
    let outcome = render(&loaded.world, &loaded.settings.settings(), way, None);
    assert_eq!(outcome.rejected.count, 0, "{} has samples that are not finite", path.display());
    let image = outcome.film.develop();
    let estimates = outcome.film.estimates().expect("at least two rounds of samples");
    Golden { hash: hash(&image), blocks: blocks(&image, &estimates) }
}

fn blocks(image: &Image, estimates: &[Estimate]) -> Vec<[f64; 6]> {
    let (width, height) = (image.width as usize, image.height as usize);
    let block = |x: usize, y: usize| {
        let rows = y..height.min(y + BLOCK);
        let places = rows.flat_map(|y| (x..width.min(x + BLOCK)).map(move |x| y * width + x));
        summary(places.map(|place| &estimates[place]))
    };
    (0..height).step_by(BLOCK).flat_map(|y| (0..width).step_by(BLOCK).map(move |x| block(x, y))).collect()
}

/// Mean of the means, and its standard error.
fn summary<'a>(pixels: impl Iterator<Item = &'a Estimate>) -> [f64; 6] {
    let mut sums = [0.0; 6];
    let mut count = 0.0;
    for pixel in pixels {
        count += 1.0;
        for channel in 0..3 {
            sums[channel] += pixel.mean()[channel];
            sums[channel + 3] += pixel.variance()[channel];
        }
    }
    [0, 1, 2, 3, 4, 5].map(|k| if k < 3 { sums[k] / count } else { sums[k].sqrt() / count })
}

impl Golden {
    /// As it stands in the file: the hash, then a line a block.
    fn to_text(&self) -> String {
        let mut text = format!("{}\n", self.hash);
        for [r, g, b, er, eg, eb] in &self.blocks {
            writeln!(text, "{r:.6} {g:.6} {b:.6}  ± {er:.6} {eg:.6} {eb:.6}").expect("a string");
        }
        text
    }

    /// What a file says; `None` if it is not such a file.
    fn from_text(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let hash = lines.next()?.to_owned();
        let block = |line: &str| {
            let numbers = line.split_whitespace().filter(|word| *word != "±").map(|word| word.parse().ok());
            <[f64; 6]>::try_from(numbers.collect::<Option<Vec<f64>>>()?).ok()
        };
        Some(Self { hash, blocks: lines.map(block).collect::<Option<_>>()? })
    }

    /// How serious it is that this is not `known`.
    fn against(&self, known: &Self) -> String {
        if self.blocks.len() != known.blocks.len() {
            return format!("{} blocks instead of {}", self.blocks.len(), known.blocks.len());
        }
        let pairs = self.blocks.iter().zip(&known.blocks).enumerate();
        let moved = pairs.flat_map(|(at, (new, old))| (0..3).map(move |channel| (at, shift(new, old, channel))));
        let moved: Vec<(usize, f64)> = moved.filter(|(_, shift)| *shift > 0.0).collect();
        let mut places: Vec<usize> = moved.iter().map(|(at, _)| *at).collect();
        places.dedup();
        match moved.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
            None => "bits moved, no block mean did: rounding".to_owned(),
            Some((at, worst)) => format!(
                "{} of {} block means moved, block {at} the most: by {worst:.2} standard errors ({})",
                places.len(),
                self.blocks.len(),
                if *worst > 5.0 { "ANOTHER PICTURE" } else { "as other noise would" },
            ),
        }
    }
}

/// By how many standard errors of the difference the mean of a channel moved; infinitely many where there is no noise.
fn shift(new: &[f64; 6], old: &[f64; 6], channel: usize) -> f64 {
    let distance = (new[channel] - old[channel]).abs();
    let error = new[channel + 3].hypot(old[channel + 3]);
    // What is within the digits of the file did not move.
    if distance <= 1.1e-6 { 0.0 } else { distance / error }
}

fn file_of(scene: &Path) -> PathBuf {
    repository().join(FOLDER).join(scene.file_stem().expect("a name")).with_extension("txt")
}

#[test]
fn every_feature_renders_what_it_did() {
    let scenes = scene_files("tests/scenes/golden");
    assert!(scenes.len() > 30, "only {} scenes were found", scenes.len());
    let bless = env::var_os("SMALTI_BLESS").is_some();
    let mut wrong = Vec::new();
    for scene in &scenes {
        let (found, file) = (rendered(scene, Level::available()[0]), file_of(scene));
        if bless {
            fs::write(&file, found.to_text()).expect("the file can be written");
        }
        let name = file.file_stem().expect("a name").to_string_lossy().into_owned();
        for level in Level::available().into_iter().skip(1) {
            if rendered(scene, level).hash != found.hash {
                wrong.push(format!("{name}: other bits with {}", level.name()));
            }
        }
        match fs::read_to_string(&file).ok().and_then(|text| Golden::from_text(&text)) {
            None => wrong.push(format!("{name}: {} is missing or damaged", file.display())),
            Some(known) if known.hash != found.hash => wrong.push(format!("{name}: {}", found.against(&known))),
            Some(known) => {
                assert_eq!(Golden::from_text(&found.to_text()), Some(known), "{name}: same hash, other means")
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {} scenes differ:\n{}", wrong.len(), scenes.len(), wrong.join("\n"));
}

#[test]
fn no_file_without_its_scene() {
    let files = fs::read_dir(repository().join(FOLDER)).expect("the folder").map(|entry| entry.expect("a file").path());
    let scenes: Vec<PathBuf> = scene_files("tests/scenes/golden").iter().map(|scene| file_of(scene)).collect();
    for file in files {
        assert!(scenes.contains(&file), "{} belongs to no scene", file.display());
    }
}

#[test]
fn every_scene_shows_something_else() {
    let mut hashes: Vec<String> =
        scene_files("tests/scenes/golden").iter().map(|scene| rendered(scene, Level::available()[0]).hash).collect();
    let scenes = hashes.len();
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), scenes);
}

#[test]
fn a_mismatch_says_how_serious_it_is() {
    let known =
        Golden { hash: "a".into(), blocks: vec![[1.0, 2.0, 3.0, 0.1, 0.1, 0.1], [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]] };
    assert_eq!(Golden::from_text(&known.to_text()), Some(known.clone()));
    let with = |block: usize, channel: usize, value: f64| {
        let mut other = Golden { hash: "b".into(), ..known.clone() };
        other.blocks[block][channel] = value;
        other.against(&known)
    };
    assert!(with(0, 0, 1.0 + 1e-7).contains("no block mean did"));
    assert!(with(0, 1, 2.2).contains("1 of 2 block means moved, block 0 the most: by 1.41 standard errors (as other"));
    assert!(with(0, 1, 3.0).contains("7.07 standard errors (ANOTHER PICTURE)"));
    assert!(with(1, 1, 1.01).contains("by inf standard errors (ANOTHER PICTURE)"));
}
