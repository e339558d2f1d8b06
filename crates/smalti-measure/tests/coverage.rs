//! Does the interval of an error statement hold the true error as often as it says? Images with known truth are
//! simulated from seeds, sample by sample, with noise of several kinds.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use smalti_core::film::{Estimate, Pixel, ROUND};
use smalti_measure::{ErrorStatement, error_statement};

const SIDE: usize = 24;
const IMAGES: u64 = 400;

/// The distribution of a sample around a pixel's true value; each has the mean 1.
#[derive(Clone, Copy)]
enum Noise {
    /// Normal with this standard deviation.
    Gaussian(f64),
    /// Exponential.
    Exponential,
    /// Exp of a normal with this standard deviation.
    LogNormal(f64),
    /// 0, but with this probability its inverse.
    Rare(f64),
    /// Power law with this exponent; infinite variance up to 2.
    Pareto(f64),
}

/// What an image shows.
#[derive(Clone, Copy)]
enum Scene {
    /// A gradient with a few edges of moderate contrast.
    Room,
    /// Patches of 12 pixels, 100 times brighter than what lies between them.
    Contrast,
    /// Each pixel unlike its neighbours.
    Texture,
}

struct Simulation {
    noise: Noise,
    scene: Scene,
    rounds: u32,
    /// Whether the channels have the same random numbers.
    grey: bool,
    /// Pixels in squares of so many a side have the same random numbers.
    shared: usize,
}

/// Statements of many images, counted.
#[derive(Debug, Default, PartialEq)]
struct Outcome {
    /// The true error was below the interval.
    below: u64,
    /// It was above the interval.
    above: u64,
    /// The interval had no upper end.
    open: u64,
}

impl Outcome {
    fn count(&mut self, truth: f64, low: f64, high: Option<f64>) {
        self.below += u64::from(truth < low);
        self.above += u64::from(high.is_some_and(|high| truth > high));
        self.open += u64::from(high.is_none());
    }

    /// Percent of the images whose true error was inside the interval.
    fn coverage(&self) -> f64 {
        100.0 * (IMAGES - self.below - self.above) as f64 / IMAGES as f64
    }
}

fn uniform(random: &mut Xoshiro256PlusPlus) -> f64 {
    ((random.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
}

fn normal(random: &mut Xoshiro256PlusPlus) -> f64 {
    let radius = (-2.0 * libm::log(uniform(random))).sqrt();
    radius * libm::cos(std::f64::consts::TAU * uniform(random))
}

fn sample(noise: Noise, random: &mut Xoshiro256PlusPlus) -> f64 {
    match noise {
        Noise::Gaussian(deviation) => 1.0 + deviation * normal(random),
        Noise::Exponential => -libm::log(uniform(random)),
        Noise::LogNormal(deviation) => libm::exp(deviation * normal(random) - deviation * deviation / 2.0),
        Noise::Rare(probability) => f64::from(u8::from(uniform(random) < probability)) / probability,
        Noise::Pareto(exponent) => (exponent - 1.0) / exponent * libm::pow(uniform(random), -1.0 / exponent),
    }
}

fn truth(scene: Scene, x: usize, y: usize) -> [f64; 3] {
    let patch = (x / 12 + y / 12).is_multiple_of(2);
    let brightness = match scene {
        Scene::Room => 0.2 + (x * y) as f64 / 1000.0 + if patch { 0.5 } else { 0.0 },
        Scene::Contrast => {
            if patch {
                3.0
            } else {
                0.03
            }
        }
        Scene::Texture => 0.3 + 0.06 * ((7 * x + 13 * y) % 5) as f64,
    };
    [1.0, 0.8, 0.6].map(|colour| colour * brightness)
}

impl Simulation {
    fn pixel(&self, truth: [f64; 3], random: &mut Xoshiro256PlusPlus) -> Estimate {
        let (mut pixel, samples) = (Pixel::default(), self.rounds * ROUND);
        for index in 0..samples {
            let mut factor = sample(self.noise, random);
            let radiance = truth.map(|value| {
                let radiance = (value * factor) as f32;
                factor = if self.grey { factor } else { sample(self.noise, random) };
                radiance
            });
            pixel.add(index, radiance);
        }
        let variance = pixel.variance_of_mean(samples).unwrap();
        Estimate::new(pixel.mean(samples), variance, self.rounds)
    }

    /// The random numbers of the pixel at (`x`, `y`).
    fn random(&self, seed: u64, x: usize, y: usize) -> Xoshiro256PlusPlus {
        let square = y / self.shared * SIDE + x / self.shared;
        Xoshiro256PlusPlus::seed_from_u64(seed << 32 | square as u64)
    }

    /// The statement of one image that takes squares of `declared` pixels a side to share samples, with the true relmse
    /// and relative error.
    fn statement(&self, seed: u64, declared: u32) -> (ErrorStatement, f64, f64) {
        let places = || (0..SIDE * SIDE).map(|i| (i % SIDE, i / SIDE));
        let truths: Vec<_> = places().map(|(x, y)| truth(self.scene, x, y)).collect();
        let pixel = |((x, y), &truth)| self.pixel(truth, &mut self.random(seed, x, y));
        let estimates: Vec<_> = places().zip(&truths).map(pixel).collect();
        let values = truths.as_flattened();
        let brightness = values.iter().sum::<f64>() / values.len() as f64;
        let error = |floor: f64| {
            let pairs = estimates.iter().flat_map(Estimate::mean).zip(values);
            pairs.map(|(x, r)| (x - r) * (x - r) / (r * r + floor)).sum::<f64>() / values.len() as f64
        };
        let statement = error_statement(&estimates, SIDE as u32, declared).unwrap();
        (statement, error(0.01), error(0.01 * brightness * brightness).sqrt())
    }

    /// What came of relmse and of the relative error.
    fn run(&self, declared: u32) -> [Outcome; 2] {
        let mut outcomes = [Outcome::default(), Outcome::default()];
        for seed in 0..IMAGES {
            let (statement, relmse, relative_error) = self.statement(seed, declared);
            let (low, high) = (statement.relative_error_low, statement.relative_error_high);
            assert!(low <= statement.relative_error, "{statement:?}");
            assert!(high.is_none_or(|high| statement.relative_error <= high), "{statement:?}");
            outcomes[0].count(relmse, statement.relmse_low, statement.relmse_high);
            outcomes[1].count(relative_error, low, high);
        }
        outcomes
    }
}

fn simulate(noise: Noise, scene: Scene, rounds: u32, grey: bool) -> [Outcome; 2] {
    Simulation { noise, scene, rounds, grey, shared: 1 }.run(1)
}

#[test]
fn well_behaved_noise_is_covered_as_claimed() {
    for (name, outcomes) in [
        ("gaussian", simulate(Noise::Gaussian(0.3), Scene::Room, 2, true)),
        ("gaussian, colours apart", simulate(Noise::Gaussian(0.3), Scene::Room, 8, false)),
        ("wide gaussian", simulate(Noise::Gaussian(1.0), Scene::Room, 4, true)),
        ("contrast", simulate(Noise::Gaussian(1.0), Scene::Contrast, 4, true)),
        ("exponential, 32 samples", simulate(Noise::Exponential, Scene::Room, 2, true)),
        ("exponential, 128 samples", simulate(Noise::Exponential, Scene::Room, 8, true)),
        ("log-normal", simulate(Noise::LogNormal(1.0), Scene::Room, 8, true)),
    ] {
        for outcome in outcomes {
            assert!((92.0..=98.0).contains(&outcome.coverage()), "{name}: {} % {outcome:?}", outcome.coverage());
            assert_eq!(outcome.open, 0, "{name}");
        }
    }
}

/// Texture of the size of a pixel cannot be told from skewed noise: the interval is wider, not wrong.
#[test]
fn texture_is_covered() {
    for noise in [Noise::Gaussian(1.0), Noise::Exponential] {
        for outcome in simulate(noise, Scene::Texture, 4, true) {
            assert!(outcome.coverage() >= 95.0 && outcome.open == 0, "{} % {outcome:?}", outcome.coverage());
        }
    }
}

#[test]
fn heavy_tails_are_flagged_and_leave_a_lower_bound() {
    for (name, noise) in [
        ("log-normal", Noise::LogNormal(2.0)),
        ("one sample in 100", Noise::Rare(0.01)),
        ("one sample in 1000", Noise::Rare(0.001)),
        ("infinite variance", Noise::Pareto(1.5)),
    ] {
        for outcome in simulate(noise, Scene::Room, 4, true) {
            assert!(outcome.open >= IMAGES * 99 / 100, "{name}: {outcome:?}");
            assert!(outcome.below <= IMAGES / 40 && outcome.above == 0, "{name}: {outcome:?}");
        }
    }
}

/// On the way from well-behaved to hopeless the upper end must go before it is wrong.
#[test]
fn what_is_stated_of_heavier_tails_holds() {
    for noise in [Noise::LogNormal(1.5), Noise::Pareto(2.5), Noise::Rare(0.05)] {
        for outcome in simulate(noise, Scene::Room, 8, true) {
            assert!(outcome.coverage() >= 95.0, "{} % {outcome:?}", outcome.coverage());
        }
    }
}

#[test]
fn pixels_that_share_samples_are_covered_when_they_are_declared() {
    let sharing = Simulation { noise: Noise::Gaussian(0.3), scene: Scene::Room, rounds: 8, grey: true, shared: 2 };
    for outcome in sharing.run(2) {
        assert!((92.0..=98.0).contains(&outcome.coverage()), "{} % {outcome:?}", outcome.coverage());
    }
    for outcome in sharing.run(1) {
        assert!(outcome.coverage() < 85.0, "{} % {outcome:?}", outcome.coverage());
    }
}
