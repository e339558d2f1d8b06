//! Does the error that renders state of themselves hold the truth as often as they claim? Renders scenes many times, each
//! time with another seed, and counts.
//!
//! ```text
//! coverage [--seeds 200] [--spp 64] [--size 200] [--integrator NAME,...] [--films FOLDER] SCENE...
//! ```
//! Prints a line of CSV for each scene and integrator. The truth is the mean of as many other renders: by `auto` for
//! `path` and `auto`, by the integrator itself for `photon` and `whitted`, which leave light out or have a bias of their
//! own in every render. Where photon radii put a bias into an image that its statement names, the truth may be above the
//! interval by the upper end of that, squares added; `noise` counts without it. (What all renders share of that bias is in
//! the truth as well; what differs from seed to seed, as radii follow photons sent ahead, is not.) With `--films` the
//! estimates of all renders are kept in a folder and taken from there the next time, so that another statement can be
//! judged without rendering again.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use smalti_core::film::{BATCHES, Counts, Film};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Rect, Settings};
use smalti_measure::{ErrorStatement, bias_statement, error_statement};
use smalti_scheduler::{Cancel, pool, render};

struct Arguments {
    seeds: u64,
    spp: u32,
    side: u32,
    integrators: Vec<Integrator>,
    films: Option<PathBuf>,
    scenes: Vec<PathBuf>,
}

fn main() -> Result<()> {
    let arguments = Arguments::read()?;
    println!("scene,integrator,spp,renders,metric,covered,noise,below,above,open,median_ratio,truth,stated,bias");
    for path in &arguments.scenes {
        let scene = path.file_stem().context("a scene is a file")?.to_string_lossy().into_owned();
        let world = smalti_scene::load(path)?.world;
        for &integrator in &arguments.integrators {
            let cell = Cell { arguments: &arguments, world: &world, scene: &scene, integrator };
            cell.run().with_context(|| format!("{scene}, {}", integrator.name()))?;
        }
    }
    Ok(())
}

impl Arguments {
    fn read() -> Result<Self> {
        let mut read = Self {
            seeds: 200,
            spp: 64,
            side: 200,
            integrators: Integrator::ALL.into(),
            films: None,
            scenes: Vec::new(),
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().with_context(|| format!("{word} needs a value"));
            match word.as_str() {
                "--seeds" => read.seeds = value()?.parse()?,
                "--spp" => read.spp = value()?.parse()?,
                "--size" => read.side = value()?.parse()?,
                "--integrator" => read.integrators = value()?.split(',').map(integrator).collect::<Result<_>>()?,
                "--films" => read.films = Some(value()?.into()),
                flag if flag.starts_with("--") => bail!("unknown flag {flag}"),
                scene => read.scenes.push(scene.into()),
            }
        }
        if read.seeds < 2 || read.scenes.is_empty() {
            bail!("it takes a scene and at least 2 seeds");
        }
        Ok(read)
    }
}

fn integrator(name: &str) -> Result<Integrator> {
    let known = Integrator::ALL.into_iter().find(|integrator| integrator.name() == name);
    known.with_context(|| format!("no integrator is called {name}"))
}

/// A scene and an integrator.
struct Cell<'a> {
    arguments: &'a Arguments,
    world: &'a World,
    scene: &'a str,
    integrator: Integrator,
}

/// What images are compared with.
struct Truth {
    mean: Vec<[f64; 3]>,
    /// Variance of that mean.
    noise: Vec<[f64; 3]>,
    /// Mean over pixels and channels.
    brightness: f64,
}

impl Cell<'_> {
    fn run(&self) -> Result<()> {
        let truth = self.truth()?;
        let mut outcomes = [Outcome::default(), Outcome::default()];
        for seed in 0..self.arguments.seeds {
            let (film, bias) = self.film(self.integrator, seed)?;
            let stated = error_statement(&film).context("it takes 32 samples a pixel")?;
            let truths = self.errors(&film, &truth);
            // A squared bias relative to r² + 0.01 m² is at most so much larger relative to r² + 0.01.
            let scale = truth.brightness.max(1.0);
            let squared = bias * bias * scale * scale;
            outcomes[0].count(truths[0], relmse(&stated), |noise| noise + squared, squared);
            outcomes[1].count(truths[1], relative_error(&stated), |noise| (noise * noise + bias * bias).sqrt(), bias);
        }
        for (metric, outcome) in ["relmse", "relative_error"].into_iter().zip(outcomes) {
            let Arguments { spp, seeds, .. } = self.arguments;
            println!("{},{},{spp},{seeds},{metric},{}", self.scene, self.integrator.name(), outcome.line());
        }
        Ok(())
    }

    /// The mean of renders with other seeds.
    fn truth(&self) -> Result<Truth> {
        let unbiased = matches!(self.integrator, Integrator::Path | Integrator::Auto);
        let integrator = if unbiased { Integrator::Auto } else { self.integrator };
        let (mut sums, mut squares) = (Vec::new(), Vec::new());
        let seeds = self.arguments.seeds as f64;
        for seed in self.arguments.seeds..2 * self.arguments.seeds {
            let image = pixels(&self.film(integrator, seed)?.0);
            sums.resize(image.len(), [0.0; 3]);
            squares.resize(image.len(), [0.0; 3]);
            for ((sum, square), pixel) in sums.iter_mut().zip(&mut squares).zip(image) {
                (0..3).for_each(|c| sum[c] += pixel[c] / seeds);
                (0..3).for_each(|c| square[c] += pixel[c] * pixel[c] / seeds);
            }
        }
        let variance = |(sum, square): (&[f64; 3], &[f64; 3])| {
            std::array::from_fn(|c| (square[c] - sum[c] * sum[c]).max(0.0) / (seeds - 1.0))
        };
        let noise = sums.iter().zip(&squares).map(variance).collect();
        let brightness = sums.as_flattened().iter().sum::<f64>() / (3 * sums.len()) as f64;
        Ok(Truth { mean: sums, noise, brightness })
    }

    /// The film of a render, a kept one or a new one, and its bias by photon radii at most, relative.
    fn film(&self, integrator: Integrator, seed: u64) -> Result<(Film, f64)> {
        let Some(folder) = &self.arguments.films else { return self.render(integrator, seed) };
        let Arguments { spp, side, .. } = *self.arguments;
        let file = folder.join(format!("{}-{}-{spp}-{side}-{seed}.batches", self.scene, integrator.name()));
        if file.exists() {
            let bytes = fs::read(&file)?;
            let expected = size_of::<f32>() * (1 + 3 * BATCHES * (side * side) as usize);
            anyhow::ensure!(bytes.len() == expected, "{}: is not of this size", file.display());
            return Ok(unpacked(&bytes, side, spp));
        }
        let (made, bias) = self.render(integrator, seed)?;
        fs::create_dir_all(folder)?;
        fs::write(&file, packed(&made, bias))?;
        Ok((made, bias))
    }

    fn render(&self, integrator: Integrator, seed: u64) -> Result<(Film, f64)> {
        let Arguments { spp, side, .. } = *self.arguments;
        let settings = Settings { integrator, seed, spp, width: side, height: side, ..Settings::default() };
        let pool = pool(0)?;
        let renderer = pool.install(|| Renderer::new(self.world, settings, Level::available()[0]))?;
        let film = Film::new(renderer.settings().area(), 32);
        let film = render(&renderer, film, &pool, &Cancel::default(), None)?.film;
        let bias = bias_statement(&film);
        Ok((film, bias.map_or(0.0, |bias| bias.relative_bias_high.max(bias.relative_bias))))
    }

    /// True relmse and relative error, freed of the noise that the truth has of its own.
    fn errors(&self, film: &Film, truth: &Truth) -> [f64; 2] {
        let count = (3 * truth.mean.len()) as f64;
        let image = pixels(film);
        let error = |floor: f64| {
            let of_channel = |x: f64, r: f64, v: f64| ((x - r) * (x - r) - v) / (r * r + floor);
            let pixels = image.iter().zip(&truth.mean).zip(&truth.noise);
            pixels.map(|((x, r), v)| (0..3).map(|c| of_channel(x[c], r[c], v[c])).sum::<f64>()).sum::<f64>() / count
        };
        [error(0.01), error(0.01 * truth.brightness * truth.brightness).max(0.0).sqrt()]
    }
}

/// Means of a film, in image order.
fn pixels(film: &Film) -> Vec<[f64; 3]> {
    film.develop().pixels.iter().map(|pixel| pixel.map(f64::from)).collect()
}

fn relmse(stated: &ErrorStatement) -> [Option<f64>; 3] {
    [Some(stated.relmse_low), Some(stated.relmse), stated.relmse_high]
}

fn relative_error(stated: &ErrorStatement) -> [Option<f64>; 3] {
    [Some(stated.relative_error_low), Some(stated.relative_error), stated.relative_error_high]
}

/// What came of the statements of one cell.
#[derive(Default)]
struct Outcome {
    below: u64,
    above: u64,
    /// Above what is stated of noise alone.
    above_noise: u64,
    open: u64,
    biases: Vec<f64>,
    ratios: Vec<f64>,
    truths: Vec<f64>,
    stated: Vec<f64>,
}

impl Outcome {
    /// `biased`: what noise comes to together with the bias.
    fn count(&mut self, truth: f64, [low, value, noise]: [Option<f64>; 3], biased: impl Fn(f64) -> f64, bias: f64) {
        let high = noise.map(biased);
        self.below += u64::from(low.is_some_and(|low| truth < low));
        self.above += u64::from(high.is_some_and(|high| truth > high));
        self.above_noise += u64::from(noise.is_some_and(|noise| truth > noise));
        self.biases.push(bias);
        self.open += u64::from(high.is_none());
        self.ratios.push(high.zip(low).map_or(f64::INFINITY, |(high, low)| if high == 0.0 { 1.0 } else { high / low }));
        self.truths.push(truth);
        self.stated.push(value.unwrap_or(f64::NAN));
    }

    fn line(&self) -> String {
        let renders = self.truths.len() as u64;
        let [covered, noise] =
            [self.above, self.above_noise].map(|above| (renders - self.below - above) as f64 / renders as f64);
        let Self { below, above, open, .. } = self;
        let [ratio, truth, stated, bias] =
            [&self.ratios, &self.truths, &self.stated, &self.biases].map(|values| median(values));
        format!("{covered:.4},{noise:.4},{below},{above},{open},{ratio:.4},{truth:.6},{stated:.6},{bias:.6}")
    }
}

fn median(values: &[f64]) -> f64 {
    smalti_measure::median(values).unwrap_or(f64::NAN)
}

/// The bias, then the sums of all pixels, in image order, as f32.
fn packed(film: &Film, bias: f64) -> Vec<u8> {
    let width = film.area.width as usize;
    let mut sums = vec![[[0.0f32; 3]; BATCHES]; film.area.pixels()];
    for tile in &film.tiles {
        for (number, pixel) in tile.pixels.iter().enumerate() {
            let (x, y) = (number as u32 % tile.area.width, number as u32 / tile.area.width);
            let index = (tile.area.y + y) as usize * width + (tile.area.x + x) as usize;
            sums[index] = pixel.sums.map(|sum| sum.map(|value| value as f32));
        }
    }
    let values = [bias as f32].into_iter().chain(sums.as_flattened().as_flattened().iter().copied());
    values.flat_map(f32::to_le_bytes).collect()
}

fn unpacked(bytes: &[u8], side: u32, spp: u32) -> (Film, f64) {
    let values: Vec<f64> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]).into()).collect();
    let mut film = Film::new(Rect { x: 0, y: 0, width: side, height: side }, side);
    film.tiles[0].counts = Counts::of(spp);
    for (pixel, sums) in film.tiles[0].pixels.iter_mut().zip(values[1..].chunks_exact(3 * BATCHES)) {
        pixel.sums = std::array::from_fn(|batch| std::array::from_fn(|c| sums[3 * batch + c]));
    }
    (film, values[0])
}
