//! What stands for the truth: one image for each size that the arms have.

use std::path::Path;

use smalti_core::film::{Image, ROUND};
use smalti_core::settings::{Fresnel, Integrator, SamplerKind, Settings};
use smalti_image::Provenance;
use smalti_measure::ErrorStatement;
use smalti_report::Reference;

use super::bench::{Bench, Halt};
use super::folder::Folder;
use super::way::{Way, cores};
use crate::error_statement::SAMPLES_NEEDED;
use crate::exit::Failure;
use crate::reproduce;

/// A reference and its image.
#[derive(Debug)]
pub struct Truth {
    /// What is kept of it.
    pub record: Reference,
    /// The image.
    pub image: Image,
}

/// The truth for images of a size.
///
/// # Errors
/// There is none: a bug.
pub fn of_size(truths: &[Truth], size: [u32; 2]) -> Result<&Truth, Failure> {
    let found = truths.iter().find(|truth| truth.record.size == size);
    found.ok_or_else(|| Failure::bug("an arm has no reference of its size"))
}

/// Sizes of which the first is a whole multiple of the others: they share a render.
pub type Family = Vec<[u32; 2]>;

/// Families of all sizes, each with its largest size first.
pub fn families(mut sizes: Vec<[u32; 2]>) -> Vec<Family> {
    sizes.sort_unstable_by_key(|[width, height]| std::cmp::Reverse((u64::from(*width) * u64::from(*height), *width)));
    sizes.dedup();
    let mut families: Vec<Family> = Vec::new();
    for size in sizes {
        match families.iter_mut().find(|family| factor(family[0], size).is_some()) {
            Some(family) => family.push(size),
            None => families.push(vec![size]),
        }
    }
    families
}

/// How many pixels of the larger size become one of the smaller, in each direction; `None`: no whole number.
pub fn factor(large: [u32; 2], small: [u32; 2]) -> Option<u32> {
    let by = large[0] / small[0];
    (by > 0 && small.map(|side| u64::from(side) * u64::from(by)) == large.map(u64::from)).then_some(by)
}

/// The render that a family's images are made of: without bias, and what is best for its time.
pub fn way(scene: &Way, family: &Family, spp: u32) -> Way {
    let [width, height] = family[0];
    let image = Settings {
        integrator: Integrator::Auto,
        width,
        height,
        spp,
        shadow_rays: 1,
        max_bounces: None,
        sampler: SamplerKind::Sobol,
        fresnel: Fresnel::Exact,
        jitter: true,
        photons: None,
        radius: None,
        ..scene.image.clone()
    };
    Way { image, downsample: 1, threads: cores() }
}

/// The samples of a reference, in whole rounds: as many as are `needed`, if they are among the `affordable` ones.
pub fn samples(needed: u32, affordable: u32) -> u32 {
    let needed = needed.checked_next_multiple_of(ROUND).unwrap_or(u32::MAX);
    needed.min(affordable / ROUND * ROUND).max(SAMPLES_NEEDED)
}

/// No repetition has the seed of a reference: those count up from the study's.
pub fn seed(of_study: u64) -> u64 {
    of_study ^ 1 << 63
}

/// Renders the references of a family.
///
/// # Errors
/// It was interrupted.
pub fn made(way: &Way, family: &Family, bench: &mut Bench) -> Result<Vec<Truth>, Halt> {
    let (settings, outcome) = bench.expose(way, seed(way.image.seed))?;
    let mut truths = Vec::new();
    for size in family {
        let by = factor(family[0], *size).unwrap_or(1);
        let developed = bench.develop(way, &outcome, by)?;
        let command = reproduce::command(&bench.job.path, (&settings, by), settings.spp, bench.job.camera());
        let record = record(*size, Some(command), developed.error);
        truths.push(Truth { record, image: developed.image });
    }
    Ok(truths)
}

/// Keeps a reference in the folder.
///
/// # Errors
/// It cannot be written.
pub fn keep(truth: &Truth, folder: &Folder) -> Result<(), Failure> {
    let path = folder.file(&truth.record.file);
    smalti_image::write(&path, &truth.image, &Provenance::new(), 0.0).map_err(Failure::output)
}

fn record(size: [u32; 2], command: Option<String>, error: Option<ErrorStatement>) -> Reference {
    let [width, height] = size;
    Reference {
        size,
        file: format!("reference-{width}x{height}.pfm"),
        command,
        relmse: error.map(|error| error.relmse),
        relative_error_squared: error.map(|error| error.relative_error * error.relative_error),
    }
}

/// The references in a file that was given, down-sampled where the images are smaller. Of an EXR file with overscan the
/// display window counts. With them what is good to know of how the file was read.
///
/// # Errors
/// A file that is no image, or of another size.
pub fn given(path: &Path, sizes: &[[u32; 2]]) -> Result<(Vec<Truth>, Vec<String>), Failure> {
    let picture = smalti_image::read_picture(path).map_err(Failure::user)?;
    let notes = picture.named_notes(path);
    let image = picture.shown();
    let whole = [image.width, image.height];
    let of_size = |size: &[u32; 2]| {
        let by = factor(whole, *size).ok_or_else(|| misfit(path, whole, *size))?;
        Ok(Truth { record: record(*size, None, None), image: image.clone().downsampled(by) })
    };
    Ok((sizes.iter().map(of_size).collect::<Result<_, _>>()?, notes))
}

fn misfit(path: &Path, [width, height]: [u32; 2], small: [u32; 2]) -> Failure {
    let [w, h] = small;
    let shown = path.display();
    Failure::user(format!(
        "{shown} has {width}x{height} pixels, and images of this study {w}x{h}: a reference is as large, or a whole \
         multiple of it"
    ))
}

/// The references that a study kept, if they are all there still.
pub fn kept(records: &[Reference], sizes: &[[u32; 2]], folder: &Folder) -> Option<Vec<Truth>> {
    let read = |record: &Reference| {
        let image = smalti_image::read(&folder.file(&record.file)).ok()?;
        ([image.width, image.height] == record.size).then(|| Truth { record: record.clone(), image })
    };
    let truths: Vec<Truth> = records.iter().map(read).collect::<Option<_>>()?;
    sizes.iter().all(|size| truths.iter().any(|truth| truth.record.size == *size)).then_some(truths)
}

/// What a reference's noise may be to the best arm's, squares of both.
pub const FIFTH: f64 = 0.2;

/// What is aimed at, as pilots are a guess.
const AIM: f64 = 0.16;

/// The samples that make a reference good enough for every size: `noise` is the square of its relative error with one
/// sample, `best` that of the best arm of each size of the family.
pub fn needed(noise: f64, family: &Family, best: &[Option<f64>]) -> u32 {
    let of = |(size, best): (&[u32; 2], &Option<f64>)| {
        let by = f64::from(factor(family[0], *size).unwrap_or(1));
        best.map_or(0.0, |best| noise / (by * by * AIM * best))
    };
    family.iter().zip(best).map(of).fold(1.0, f64::max).ceil() as u32
}

#[cfg(test)]
mod tests {
    use smalti_image::{Window, Windows};

    use super::*;
    use crate::study::combine::tests::base;

    #[test]
    fn sizes_that_divide_each_other_share_a_render() {
        let found = families(vec![[400, 400], [800, 800], [400, 400], [300, 300], [200, 100]]);
        assert_eq!(found, [vec![[800, 800], [400, 400]], vec![[300, 300]], vec![[200, 100]]]);
        assert_eq!((factor([8, 6], [4, 3]), factor([8, 6], [4, 6]), factor([4, 3], [8, 6])), (Some(2), None, None));
    }

    #[test]
    fn samples_are_whole_rounds_that_can_be_afforded() {
        assert_eq!(samples(100, 1000), 112);
        assert_eq!(samples(1000, 100), 96);
        assert_eq!((samples(1, 1), samples(u32::MAX, u32::MAX)), (SAMPLES_NEEDED, u32::MAX / ROUND * ROUND));
    }

    #[test]
    fn a_reference_has_a_fifth_of_the_best_arms_squared_error() {
        let family = vec![[8, 8], [4, 4]];
        // 0.64 / 0.16 / 0.05: 80 samples; a quarter of the noise after down-sampling.
        assert_eq!(needed(0.64, &family, &[Some(0.05), None]), 80);
        assert_eq!(needed(0.64, &family, &[Some(0.05), Some(0.01)]), 100);
        assert_eq!(needed(0.64, &family, &[None, None]), 1);
    }

    #[test]
    fn a_reference_has_no_bias_and_a_seed_of_its_own() {
        let mut scene = base();
        scene.image.max_bounces = Some(2);
        scene.image.jitter = false;
        let way = way(&scene, &vec![[8, 6], [4, 3]], 64);
        assert_eq!((way.size(), way.image.max_bounces, way.image.jitter), ([8, 6], None, true));
        assert!((0..1000).all(|repetition| seed(7) != 7 + repetition));
    }

    #[test]
    fn overscan_is_no_part_of_a_given_reference() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("truth.exr");
        let image = Image { width: 4, height: 1, pixels: (0..4u8).map(|n| [f32::from(n); 3]).collect() };
        let data = Window { x: -1, y: 0, width: 4, height: 1 };
        let windows = Windows { data, display: Window::of_size(2, 1) };
        smalti_image::write_part(&path, &image, windows, &Provenance::new(), 0.0).unwrap();
        assert_eq!(given(&path, &[[2, 1]]).unwrap().0[0].image.pixels, [[1.0; 3], [2.0; 3]]);
        assert!(given(&path, &[[4, 1]]).is_err());
    }

    #[test]
    fn a_given_reference_must_fit() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("truth.pfm");
        let image = Image { width: 4, height: 2, pixels: (0..8u8).map(|n| [f32::from(n); 3]).collect() };
        smalti_image::write(&path, &image, &Provenance::new(), 0.0).unwrap();
        let (truths, notes) = given(&path, &[[4, 2], [2, 1]]).unwrap();
        assert!(notes.is_empty());
        assert_eq!((&truths[0].image, truths[1].image.pixels.as_slice()), (&image, &[[2.5; 3], [4.5; 3]][..]));
        let message = given(&path, &[[3, 2]]).unwrap_err().message;
        assert!(message.contains("4x2 pixels") && message.contains("3x2"), "{message}");
    }
}
