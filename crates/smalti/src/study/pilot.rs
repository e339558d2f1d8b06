//! Short renders that tell what longer ones will cost and how good they will be.
//!
//! Noise has a variance that goes with one over the samples, so that a small image tells the error of a large one, and
//! its time a path the time of all. Photons of a round cost the same whatever the image.

use smalti_core::film::ROUND;

use super::bench::{Bench, Halt, Rendered};
use super::way::Way;
use crate::error_statement::SAMPLES_NEEDED;

/// What is known of a way's cost and noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pilot {
    /// Seconds for a camera path.
    pub path: f64,
    /// Seconds for the photons of a round.
    pub round: f64,
    /// Square of the relative error of an image with one sample a pixel; `None`: nothing can be said.
    pub noise: Option<f64>,
    /// Whether that is all of it: no bright light was met so seldom that there may be more.
    pub certain: bool,
}

/// Pixels of a pilot, about.
const PIXELS: f64 = 16_384.0;

/// More samples than any study needs.
const MOST: f64 = 1e6;

impl Pilot {
    /// What a render of `way` tells.
    pub fn of(way: &Way, rendered: &Rendered) -> Self {
        let photons = rendered.outcome.photons.elapsed.as_secs_f64();
        let paths = rendered.outcome.timing.elapsed.as_secs_f64() - photons;
        let by = f64::from(way.downsample);
        let samples = by * by * f64::from(way.image.spp);
        Self {
            path: paths.max(0.0) / way.samples(),
            round: photons / rounds(way),
            noise: rendered.developed.error.map(|error| samples * error.relative_error * error.relative_error),
            certain: rendered.developed.error.is_some_and(|error| error.relative_error_high.is_some()),
        }
    }

    /// How long a render of `way` takes, seconds.
    pub fn seconds(&self, way: &Way) -> f64 {
        self.path * way.samples() + self.round * rounds(way)
    }

    /// The square of the relative error that noise gives an image of `way`.
    pub fn squared_error(&self, way: &Way) -> Option<f64> {
        let by = f64::from(way.downsample);
        Some(self.noise? / (by * by * f64::from(way.image.spp)))
    }

    /// The most samples of `way` that fit into `seconds`, at least 1.
    pub fn samples_in(&self, way: &Way, seconds: f64) -> u32 {
        let sample = self.path * way.pixels();
        let round = f64::from(ROUND) * sample + self.round;
        if sample == 0.0 {
            return MOST as u32;
        }
        let complete = (seconds / round).floor();
        let rest = (seconds - complete * round - self.round) / sample;
        let samples = f64::from(ROUND) * complete + rest.floor().clamp(0.0, f64::from(ROUND - 1));
        samples.clamp(1.0, MOST) as u32
    }

    /// The fewest samples of `way` with a relative error of at most `error`; 1 where nothing is known of its noise.
    pub fn samples_for(&self, way: &Way, error: f64) -> u32 {
        let by = f64::from(way.downsample);
        let samples = self.noise.unwrap_or_default() / (by * by * error * error);
        // What is whole must not exceed itself by a rounding.
        (samples * (1.0 - 1e-9)).ceil().clamp(1.0, MOST) as u32
    }
}

/// Rounds of a render, begun ones too.
fn rounds(way: &Way) -> f64 {
    f64::from(way.image.spp.div_ceil(ROUND))
}

/// Pilots that were rendered; ways that differ in samples and size alone have the same.
#[derive(Default)]
pub struct Pilots(Vec<(Way, Pilot)>);

impl Pilots {
    /// The pilot of a way; renders it if it is not there.
    ///
    /// # Errors
    /// What the bench answers.
    pub fn of(&mut self, way: &Way, bench: &mut Bench) -> Result<Pilot, Halt> {
        let small = small(way);
        if let Some((_, pilot)) = self.0.iter().find(|(other, _)| *other == small) {
            return Ok(*pilot);
        }
        let pilot = Pilot::of(&small, &bench.render(&small, SEED)?);
        self.0.push((small, pilot));
        Ok(pilot)
    }
}

/// The seed of pilots and trials: no repetition has it unless asked to.
pub const SEED: u64 = 0x7069_6c6f_7400_0000;

/// The way with few pixels and just enough samples to state an error; photons stay as many as they are.
fn small(way: &Way) -> Way {
    let shrink = (f64::from(way.image.width) * f64::from(way.image.height) / PIXELS).sqrt().max(1.0);
    let side = |side: u32| ((f64::from(side) / shrink) as u32).max(1);
    let mut small = way.clone();
    (small.image.width, small.image.height) = (side(way.image.width), side(way.image.height));
    small.image.spp = SAMPLES_NEEDED;
    small.image.photons = way.image.integrator.asks_photons().then(|| way.photons());
    small.downsample = 1;
    small
}

/// The samples that bring a squared error down by `ratio`, from `samples` that have it; by a factor of 16 at most, as
/// one render says only so much.
pub fn corrected(samples: u32, ratio: f64) -> u32 {
    (f64::from(samples) * ratio.clamp(1.0 / 16.0, 16.0)).round().clamp(1.0, MOST) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::combine::tests::base;

    const PILOT: Pilot = Pilot { path: 1e-3, round: 0.5, noise: Some(0.64), certain: true };

    fn way(spp: u32, downsample: u32) -> Way {
        let mut way = base();
        (way.image.width, way.image.height, way.image.spp, way.downsample) = (10, 10, spp, downsample);
        way
    }

    #[test]
    fn time_is_that_of_paths_and_rounds() {
        // A sample of 100 pixels takes 0.1 s, a round of photons 0.5 s.
        assert!((PILOT.seconds(&way(16, 1)) - 2.1).abs() < 1e-12);
        assert!((PILOT.seconds(&way(17, 1)) - 2.7).abs() < 1e-12);
        assert!((PILOT.seconds(&way(4, 2)) - 2.1).abs() < 1e-12);
    }

    #[test]
    fn samples_fill_the_time_and_no_more() {
        for spp in [1, 5, 16, 17, 31, 32, 100] {
            let seconds = PILOT.seconds(&way(spp, 1));
            assert_eq!(PILOT.samples_in(&way(1, 1), seconds + 1e-6), spp);
            assert!(PILOT.samples_in(&way(1, 1), seconds - 1e-6) < spp.max(2));
        }
        // Two more rounds would begin with photons that there is no time for.
        assert_eq!(PILOT.samples_in(&way(1, 1), 2.4), 16);
        let free = Pilot { path: 0.0, round: 0.0, noise: None, certain: false };
        assert_eq!(free.samples_in(&way(1, 1), 1.0), MOST as u32);
    }

    #[test]
    fn samples_follow_from_the_error() {
        assert_eq!(PILOT.samples_for(&way(1, 1), 0.1), 64);
        assert_eq!(PILOT.samples_for(&way(1, 2), 0.1), 16);
        assert_eq!(PILOT.samples_for(&way(1, 1), 0.099), 66);
        assert_eq!(PILOT.samples_for(&way(1, 1), 10.0), 1);
        let error = PILOT.squared_error(&way(64, 1)).unwrap().sqrt();
        assert!((error - 0.1).abs() < 1e-12);
        assert_eq!(PILOT.squared_error(&way(16, 2)), PILOT.squared_error(&way(64, 1)));
    }

    #[test]
    fn samples_are_corrected_in_proportion_to_the_squared_error() {
        assert_eq!(
            [(10, 6.76), (10, 0.5), (1, 0.01), (10, 1e9)].map(|(n, ratio)| corrected(n, ratio)),
            [68, 5, 1, 160]
        );
    }

    #[test]
    fn ways_that_differ_in_samples_and_size_share_a_pilot() {
        let mut large = way(5, 2);
        (large.image.width, large.image.height) = (4000, 2000);
        let shrunk = small(&large);
        assert_eq!((shrunk.image.spp, shrunk.downsample, shrunk.image.photons), (SAMPLES_NEEDED, 1, None));
        assert!(shrunk.image.width.abs_diff(2 * shrunk.image.height) <= 1);
        assert!((1.0 - shrunk.pixels() / PIXELS).abs() < 0.05);
        large.image.spp = 7;
        assert_eq!(small(&large), shrunk);
    }
}
