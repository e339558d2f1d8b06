//! The pictures of a study: read from its folder, references tone-mapped, differences in false colour.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use smalti_core::film::Image;
use smalti_image::{Difference, difference, difference_scale};
use smalti_report::{ArmPictures, Pictures, Reference, Study, findings};

/// What a PNG file begins with.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Bytes of pictures that a page takes at most: more, and it is slow to open.
const MOST_BYTES: usize = 48 << 20;

/// The pictures, and what is missing, in words.
pub fn gather(study: &Study, folder: &Path) -> (Pictures, Vec<String>) {
    Gathering { study, folder, left: MOST_BYTES, missing: BTreeSet::new() }.all()
}

struct Gathering<'a> {
    study: &'a Study,
    folder: &'a Path,
    /// Bytes that may still be taken.
    left: usize,
    missing: BTreeSet<String>,
}

impl Gathering<'_> {
    fn all(mut self) -> (Pictures, Vec<String>) {
        let study = self.study;
        let references: Vec<Option<Image>> = study.references.iter().map(|r| self.image(&r.file)).collect();
        let mut pictures = Pictures { arms: vec![ArmPictures::default(); study.arms.len()], ..Pictures::default() };
        let encoded = references.iter().map(|image| smalti_image::encode_png(image.as_ref()?, study.exposure as f32));
        pictures.references = encoded.map(|png| self.take(png)).collect();
        let order = by_importance(study);
        for &arm in &order {
            let file = study.arms[arm].picture.as_deref();
            let png = file.and_then(|file| self.picture(file));
            pictures.arms[arm].picture = self.take(png);
        }
        for (reference, truth) in study.references.iter().zip(&references) {
            let scale = truth.as_ref().and_then(|truth| self.differences(&order, reference, truth, &mut pictures));
            pictures.full_scales.push(scale);
        }
        (pictures, self.missing.into_iter().collect())
    }

    /// The differences of all arms of a reference's size, on one scale, so that they can be compared; returns the scale.
    fn differences(&mut self, order: &[usize], of: &Reference, truth: &Image, pictures: &mut Pictures) -> Option<f32> {
        let study = self.study;
        let of_size = order.iter().filter(|&&arm| study.arms[arm].size == of.size);
        let images: Vec<(usize, Image)> =
            of_size.filter_map(|&arm| Some((arm, self.image(study.arms[arm].image.as_deref()?)?))).collect();
        let scales = images.iter().filter_map(|(_, image)| difference_scale(image, truth));
        let full_scale = smalti_measure::median(&scales.map(f64::from).collect::<Vec<_>>())? as f32;
        for (arm, image) in images {
            let shown = difference(&image, truth, Difference::Signed, full_scale);
            let png = shown.and_then(|shown| smalti_image::encode_png(&shown, 0.0));
            pictures.arms[arm].difference = self.take(png);
        }
        Some(full_scale)
    }

    /// `png` if there is room for it.
    fn take(&mut self, png: Option<Vec<u8>>) -> Option<Vec<u8>> {
        let png = png?;
        match self.left.checked_sub(png.len()) {
            Some(left) => self.left = left,
            None => {
                let most = crate::memory::in_words(MOST_BYTES as u64);
                self.missing.insert(format!("some pictures are left out of the page: together they have over {most}"));
                return None;
            }
        }
        Some(png)
    }

    fn picture(&mut self, file: &str) -> Option<Vec<u8>> {
        let path = self.path(file);
        match fs::read(&path) {
            Ok(bytes) if bytes.starts_with(SIGNATURE) => Some(bytes),
            Ok(_) => self.miss(format!("{}: is no PNG file; the page goes without it", path.display())),
            Err(error) => self.miss(format!("{}: cannot be read: {error}; the page goes without it", path.display())),
        }
    }

    fn image(&mut self, file: &str) -> Option<Image> {
        match smalti_image::read(&self.path(file)) {
            Ok(image) => Some(image),
            Err(error) => self.miss(format!("{error}; the page goes without its differences")),
        }
    }

    fn miss<T>(&mut self, what: String) -> Option<T> {
        self.missing.insert(what);
        None
    }

    /// A file of the study; one that is not in its folder was named from here.
    fn path(&self, file: &str) -> PathBuf {
        let inside = self.folder.join(file);
        if inside.exists() || !Path::new(file).exists() { inside } else { file.into() }
    }
}

/// Arms, those first that the page shows first: the baseline, the Pareto front, the rest.
fn by_importance(study: &Study) -> Vec<usize> {
    let front: BTreeSet<usize> =
        findings(study).iter().filter(|finding| finding.on_front).map(|finding| finding.arm).collect();
    let mut order: Vec<usize> = (0..study.arms.len()).collect();
    let rank = |arm: usize| (study.baseline != Some(arm), !front.contains(&arm));
    order.sort_by_key(|&arm| rank(arm));
    order
}
