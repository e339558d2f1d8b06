//! Does the interval of an error statement hold the true error as often as it says? Images with known truth are
//! simulated from seeds, sample by sample, with noise of several kinds.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use smalti_core::film::{BATCHES, Counts, Film, Pixel, ROUND};
use smalti_core::settings::Rect;
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
    fn fill(&self, pixel: &mut Pixel, truth: [f64; 3], random: &mut Xoshiro256PlusPlus) {
        for index in 0..self.rounds * ROUND {
            let mut factor = sample(self.noise, random);
            let radiance = truth.map(|value| {
                let radiance = (value * factor) as f32;
                factor = if self.grey { factor } else { sample(self.noise, random) };
                radiance
            });
            pixel.add((index / ROUND) as usize % BATCHES, 1.0, radiance);
        }
    }

    /// The statement of one image, with the true relmse and relative error.
    fn statement(&self, seed: u64) -> (ErrorStatement, f64, f64) {
        let truths: Vec<_> = (0..SIDE * SIDE).map(|i| truth(self.scene, i % SIDE, i / SIDE)).collect();
        let mut film = Film::new(Rect { x: 0, y: 0, width: SIDE as u32, height: SIDE as u32 }, SIDE as u32);
        let tile = &mut film.tiles[0];
        tile.counts = Counts::of(self.rounds * ROUND);
        for (index, (pixel, &truth)) in tile.pixels.iter_mut().zip(&truths).enumerate() {
            self.fill(pixel, truth, &mut Xoshiro256PlusPlus::seed_from_u64(seed << 32 | index as u64));
        }
        let values = truths.as_flattened();
        let brightness = values.iter().sum::<f64>() / values.len() as f64;
        let means: Vec<[f64; 3]> = tile.pixels.iter().map(|pixel| pixel.mean(&tile.counts)).collect();
        let error = |floor: f64| {
            let pairs = means.as_flattened().iter().zip(values);
            pairs.map(|(x, r)| (x - r) * (x - r) / (r * r + floor)).sum::<f64>() / values.len() as f64
        };
        let statement = error_statement(&film).unwrap();
        (statement, error(0.01), error(0.01 * brightness * brightness).sqrt())
    }

    /// What came of relmse and of the relative error.
    fn run(&self) -> [Outcome; 2] {
        let mut outcomes = [Outcome::default(), Outcome::default()];
        for seed in 0..IMAGES {
            let (statement, relmse, relative_error) = self.statement(seed);
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
    Simulation { noise, scene, rounds, grey }.run()
}

#[test]
fn well_behaved_noise_is_covered_as_claimed() {
    for (name, outcomes) in [
        ("gaussian", simulate(Noise::Gaussian(0.3), Scene::Room, 4, true)),
        ("gaussian, uneven batches", simulate(Noise::Gaussian(0.3), Scene::Room, 6, true)),
        ("texture", simulate(Noise::Gaussian(1.0), Scene::Texture, 4, true)),
        ("exponential texture", simulate(Noise::Exponential, Scene::Texture, 4, true)),
        ("wide gaussian", simulate(Noise::Gaussian(1.0), Scene::Room, 4, true)),
        ("contrast", simulate(Noise::Gaussian(1.0), Scene::Contrast, 4, true)),
        ("exponential, 64 samples", simulate(Noise::Exponential, Scene::Room, 4, true)),
        ("exponential, 128 samples", simulate(Noise::Exponential, Scene::Room, 8, true)),
        ("log-normal", simulate(Noise::LogNormal(1.0), Scene::Room, 8, true)),
    ] {
        for outcome in outcomes {
            assert!((92.0..=98.0).contains(&outcome.coverage()), "{name}: {} % {outcome:?}", outcome.coverage());
            // A wide Gaussian has values below 0, two of which make the other two look like chance.
            let open = if name == "contrast" { 1 } else { 0 };
            assert!(outcome.open <= open, "{name}: {outcome:?}");
        }
    }
}

/// Channels are taken to go together: the interval is wider where they do not.
#[test]
fn colours_apart_are_covered() {
    for outcome in simulate(Noise::Gaussian(0.3), Scene::Room, 8, false) {
        assert!(outcome.coverage() >= 95.0 && outcome.open == 0, "{outcome:?}");
    }
}

/// Of two rounds nobody can tell what a pixel is without one of them.
#[test]
fn two_rounds_are_a_lower_bound() {
    for outcome in simulate(Noise::Gaussian(0.3), Scene::Room, 2, true) {
        assert!(outcome.open == IMAGES && outcome.coverage() >= 95.0, "{outcome:?}");
    }
}

/// The interval grows wide, and where that would say nothing there is no upper end.
#[test]
fn heavy_tails_are_covered_or_left_open() {
    for (name, noise) in [
        ("log-normal", Noise::LogNormal(2.0)),
        ("one sample in 100", Noise::Rare(0.01)),
        ("one sample in 1000", Noise::Rare(0.001)),
        ("infinite variance", Noise::Pareto(1.5)),
    ] {
        for outcome in simulate(noise, Scene::Room, 4, true) {
            assert!(outcome.below <= IMAGES / 40 && outcome.above == 0, "{name}: {outcome:?}");
            assert!(name != "one sample in 1000" || outcome.open >= IMAGES * 99 / 100, "{name}: {outcome:?}");
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
