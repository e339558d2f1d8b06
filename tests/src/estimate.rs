//! Renders a world on all cores and says what came out: the image, its mean and how sure that is.

use std::sync::atomic::AtomicU64;

use rayon::prelude::*;
use smalti_core::film::{Estimate, Film, Image, ROUND, Tile};
use smalti_core::lanes::Level;
use smalti_core::photon::maps::Pilots;
use smalti_core::render::{Renderer, Work, Workspace};
use smalti_core::scene::World;
use smalti_core::settings::Settings;

/// A finished render.
pub struct Rendered {
    /// The linear image.
    pub image: Image,
    /// Mean of each channel over all pixels.
    pub mean: [f64; 3],
    /// Standard error of that mean; infinite with fewer than two rounds.
    pub standard_error: [f64; 3],
    /// One estimate a pixel, where there are two rounds.
    pub pixels: Option<Vec<Estimate>>,
    /// Paths that the hard cap ended.
    pub capped: u64,
}

/// Settings for `width` × `height` pixels and `spp` samples; all else by default.
pub fn settings(width: u32, height: u32, spp: u32) -> Settings {
    Settings { width, height, spp, ..Settings::default() }
}

/// Renders at the best SIMD level.
///
/// # Panics
/// Where the settings do not suit the scene, and when a sample is not finite.
pub fn render(world: &World, settings: &Settings) -> Rendered {
    let renderer = Renderer::new(world, settings.clone(), Level::available()[0]).expect("the settings suit the scene");
    let mut film = Film::new(settings.area(), 8);
    let works = advance(&renderer, &mut film, settings.spp);
    for work in &works {
        assert_eq!(work.rejected, [], "samples that are not finite");
    }
    let pixels = film.estimates();
    let image = film.develop();
    let (mean, standard_error) = match &pixels {
        Some(pixels) => total(pixels),
        None => (image.mean(), [f64::INFINITY; 3]),
    };
    Rendered { image, mean, standard_error, pixels, capped: works.iter().map(|work| work.capped).sum() }
}

/// The means of some independent renders.
pub struct Repeated {
    /// Mean of each channel over all renders.
    pub mean: [f64; 3],
    /// Standard error of that mean.
    pub standard_error: [f64; 3],
}

/// Renders once with each of `count` seeds from `first` on. The spread of the renders tells the error also where pixels
/// share photons and are not independent.
pub fn repeat(world: &World, settings: &Settings, first: u64, count: u64) -> Repeated {
    let of_seed = |seed| render(world, &Settings { seed, ..settings.clone() }).mean;
    let means: Vec<[f64; 3]> = (first..first + count).map(of_seed).collect();
    let n = means.len() as f64;
    let mean = [0, 1, 2].map(|c: usize| means.iter().map(|mean| mean[c]).sum::<f64>() / n);
    let square = |c: usize| means.iter().map(|of_seed| (of_seed[c] - mean[c]) * (of_seed[c] - mean[c])).sum::<f64>();
    Repeated { mean, standard_error: [0, 1, 2].map(|c| (square(c) / (n * (n - 1.0))).sqrt()) }
}

/// Adds samples until every pixel has `spp`: round by round where each round has photons of its own.
fn advance(renderer: &Renderer, film: &mut Film, spp: u32) -> Vec<Work> {
    let by_rounds = renderer.plan().photons.is_some();
    let (progress, mut pilots, mut works) = (AtomicU64::new(0), Pilots::default(), Vec::new());
    for round in 0..if by_rounds { spp.div_ceil(ROUND) } else { 1 } {
        let maps = renderer.maps(round, pilots, &progress);
        let until = if by_rounds { spp.min((round + 1) * ROUND) } else { spp };
        let step =
            |workspace: &mut Workspace, tile: &mut Tile| renderer.advance(tile, until, &maps, workspace, &progress);
        works.par_extend(film.tiles.par_iter_mut().map_init(|| renderer.workspace(), step));
        pilots = maps.pilots();
    }
    works
}

/// Mean over pixels and its standard error; pixels are independent.
fn total(pixels: &[Estimate]) -> ([f64; 3], [f64; 3]) {
    let count = pixels.len() as f64;
    let sum = |of: fn(&Estimate) -> [f64; 3]| {
        pixels.iter().map(of).fold([0.0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    };
    let mean = sum(Estimate::mean).map(|x| x / count);
    (mean, sum(Estimate::variance).map(|x| x.sqrt() / count))
}

impl Repeated {
    /// [`assert_near`] for every channel.
    ///
    /// # Panics
    /// When it is not so.
    pub fn assert_rgb(&self, name: &str, truth: [f64; 3], tolerance: f64) {
        for (channel, truth) in truth.into_iter().enumerate() {
            assert_near(name, (self.mean[channel], self.standard_error[channel]), truth, tolerance);
        }
    }
}

/// Asserts the seeded equivalence of a mean with its standard error to a true value: the standard error is at most a
/// fifth of the tolerance (what is noisy may not pass by being noisy) and the mean within the tolerance, both relative
/// to `truth`.
///
/// # Panics
/// When it is not so.
pub fn assert_near(name: &str, (mean, error): (f64, f64), truth: f64, tolerance: f64) {
    let (off, error) = (mean / truth - 1.0, error / truth);
    assert!(error <= tolerance / 5.0, "{name}: standard error {error:.2e} needs {:.2e}", tolerance / 5.0);
    assert!(
        off.abs() <= tolerance,
        "{name}: {mean:.9} is off {truth:.9} by {off:.2e} (se {error:.1e}, tolerance {tolerance:.1e})"
    );
}

impl Rendered {
    /// [`assert_near`] for every channel.
    ///
    /// # Panics
    /// When it is not so.
    pub fn assert_rgb(&self, name: &str, truth: [f64; 3], tolerance: f64) {
        for (channel, truth) in truth.into_iter().enumerate() {
            assert_near(name, (self.mean[channel], self.standard_error[channel]), truth, tolerance);
        }
    }

    /// [`assert_rgb`](Self::assert_rgb) for a grey.
    ///
    /// # Panics
    /// When it is not so.
    pub fn assert_mean(&self, name: &str, truth: f64, tolerance: f64) {
        self.assert_rgb(name, [truth; 3], tolerance);
    }

    /// Asserts that every pixel is `truth` to a relative `tolerance`: no noise is allowed for.
    ///
    /// # Panics
    /// When it is not so.
    pub fn assert_every_pixel(&self, name: &str, truth: f64, tolerance: f64) {
        for (index, pixel) in self.image.pixels.iter().enumerate() {
            for &value in pixel {
                let off = f64::from(value) / truth - 1.0;
                assert!(off.abs() <= tolerance, "{name}: pixel {index} is {value}, off {truth} by {off:.2e}");
            }
        }
    }
}
