//! A short render: a small image of the scene, with just enough samples to tell its error.
//!
//! Noise has a variance that goes with one over the samples, whatever the size of the image. Photons of a round are as
//! many as in the whole image, and so is what they cost a sample of it.

use std::time::Instant;

use rayon::ThreadPool;
use smalti_core::film::Film;
use smalti_core::render::{RayCounts, Renderer};
use smalti_core::settings::{Rect, Settings};
use smalti_scheduler::{ADAPTIVE_TILE, Cancel, Goal, Outcome, Stopped};

use super::choice::{Candidate, Pilot};
use super::shelf::PilotMaps;
use crate::budget::Budget;
use crate::error_statement;
use crate::exit::Failure;
use crate::job::Job;

/// Samples a pixel of a pilot: four rounds, one for each batch.
const SPP: u32 = 64;

/// The same where samples go where the noise is: only after the first four rounds they do.
const ADAPTIVE_SPP: u32 = 128;

/// A pilot has one pixel in so many of the image ...
const PIXELS_FOR_ONE: f64 = 16.0;

/// ... but no fewer and no more than these.
const PIXELS: [f64; 2] = [1024.0, 4096.0];

/// What a shadow ray costs beside a ray that looks for the nearest surface and scatters there: 0.15 in the reference
/// room, 0.27 in the Cornell box and 0.42 in `scenes/blob.toml`. A constant, as no clock may have a say in the choice.
const SHADOW_RAY: f64 = 0.25;

/// Where pilots are rendered, one after the other.
pub struct Bench<'a> {
    job: &'a Job,
    pool: &'a ThreadPool,
    cancel: &'a Cancel,
    deadline: Option<Instant>,
    maps: PilotMaps,
}

impl<'a> Bench<'a> {
    /// A bench for the scene and the settings of `job`.
    pub fn new(job: &'a Job, pool: &'a ThreadPool, cancel: &'a Cancel, deadline: Option<Instant>) -> Self {
        Self { job, pool, cancel, deadline, maps: PilotMaps::default() }
    }

    /// The pilot of a candidate; `None` if it was stopped, or its time was up before it began.
    ///
    /// # Errors
    /// The scene cannot be rendered, or a worker panicked.
    pub fn render(&mut self, candidate: Candidate) -> Result<Option<Pilot>, Failure> {
        if self.cancel.is_cancelled() || self.deadline.is_some_and(|deadline| deadline <= Instant::now()) {
            return Ok(None);
        }
        let settings = small(&self.job.settings, candidate);
        let renderer = self.pool.install(|| Renderer::new(&self.job.world, settings.clone(), self.job.level));
        let renderer = renderer.map_err(Failure::user)?;
        let plain = Budget::default().goal(&settings, 1, self.pool, Instant::now());
        let goal = Goal { deadline: self.deadline, ..plain };
        // The tiles are the same whatever was typed: sums by tile, and thus errors, depend on them in their last bits.
        let film = Film::new(settings.area(), ADAPTIVE_TILE);
        let hands = (self.pool, self.cancel);
        let outcome = smalti_scheduler::render_to(&goal, &renderer, film, hands, None, Some(&self.maps));
        let outcome = outcome.map_err(Failure::bug)?;
        let photons =
            f64::from(settings.spp.div_ceil(smalti_core::film::ROUND)) * renderer.photons_of_round(false) as f64;
        Ok((outcome.stopped == Stopped::Samples).then(|| self.told(candidate, &outcome, photons)))
    }

    /// What a pilot tells that was rendered with so many `photons`.
    fn told(&self, candidate: Candidate, outcome: &Outcome, photons: f64) -> Pilot {
        let error = self.pool.install(|| error_statement::of(&outcome.film, 1));
        let spp = outcome.mean_samples;
        let RayCounts { camera, scattered, shadow } = outcome.rays;
        let paths = (camera + scattered) as f64 + SHADOW_RAY * shadow as f64;
        // A photon counts as a ray where it sets out and wherever it lands.
        let photons = photons + outcome.photons.stored as f64;
        let samples = self.job.settings.area().pixels() as f64 * f64::from(spp);
        Pilot {
            candidate,
            spp,
            cost: paths / outcome.samples.max(1) as f64 + photons / samples,
            relative_error: error.map(|error| error.relative_error),
            certain: error.is_some_and(|error| error.relative_error_high.is_some()),
        }
    }
}

/// The settings of a pilot of `candidate` for a render of `settings`.
fn small(settings: &Settings, candidate: Candidate) -> Settings {
    let area = settings.area();
    let pixels = area.pixels() as f64;
    let shrink = (pixels / (pixels / PIXELS_FOR_ONE).clamp(PIXELS[0], PIXELS[1])).sqrt().max(1.0);
    let side = |side: u32| ((f64::from(side) / shrink) as u32).max(1);
    let (width, height) = (side(settings.width), side(settings.height));
    let crop = settings.crop.map(|Rect { x, y, width: columns, height: rows }| {
        let [x, y] = [(x, width), (y, height)].map(|(from, end)| ((f64::from(from) / shrink) as u32).min(end - 1));
        Rect { x, y, width: side(columns).min(width - x), height: side(rows).min(height - y) }
    });
    Settings {
        width,
        height,
        crop,
        spp: if candidate.adaptive { ADAPTIVE_SPP } else { SPP },
        shadow_rays: candidate.shadow_rays,
        adaptive: candidate.adaptive,
        photons: Some(settings.photons_of_round()),
        ..settings.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sized(width: u32, height: u32, crop: Option<Rect>) -> Settings {
        let candidate = Candidate { shadow_rays: 3, adaptive: false };
        small(&Settings { width, height, crop, ..Settings::default() }, candidate)
    }

    #[test]
    fn pilots_are_small_and_have_the_photons_of_the_image() {
        let size = |settings: Settings| (settings.width, settings.height);
        assert_eq!(size(sized(320, 160, None)), (80, 40));
        assert_eq!(size(sized(20, 10, None)), (20, 10));
        let large = sized(8000, 2000, None);
        assert!(large.area().pixels().abs_diff(4096) < 200 && large.width.abs_diff(4 * large.height) <= 4);
        assert_eq!(large.photons, Some(1_048_576));
        assert_eq!((large.shadow_rays, large.spp), (3, SPP));
    }

    #[test]
    fn a_small_crop_is_rendered_as_it_is_and_a_large_one_stays_inside() {
        let crop = Rect { x: 390, y: 399, width: 10, height: 1 };
        assert_eq!(sized(400, 400, Some(crop)).crop, Some(crop));
        for from in [0, 1, 399, 799] {
            let crop = Rect { x: from, y: 0, width: 800 - from, height: 800 };
            let small = sized(800, 800, Some(crop));
            let Rect { x, y, width, height } = small.area();
            assert!(x + width <= small.width && y + height <= small.height && width > 0, "{small:?}");
        }
    }
}
