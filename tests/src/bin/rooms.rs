//! Is the light that is there in the picture, and is what renders state of their error true, in rooms of unlike scales?
//!
//! ```text
//! rooms [--seeds 40] [--first 0] [--rooms 30] [--spp 64] [--photons N] [--truth-spp 1024] [--path-spp 4096] [--write FOLDER]
//! ```
//! Renders each random room (see `smalti_tests::rooms`) with `auto` at 64 × 64 pixels, 64 samples and default settings
//! (or others), many times, each time with another seed. The truth is a render by `auto` with many more samples and photons; its mean
//! stands beside that of a render by `path`. Prints a line of CSV for each room. With `--write FOLDER` the rooms are
//! written as scene files instead.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use smalti_core::film::{Film, Image};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Settings};
use smalti_measure::{BiasStatement, ErrorStatement, bias_statement, compare, error_statement};
use smalti_scheduler::{Cancel, pool, render};
use smalti_tests::rooms::{self, room};

/// Pixels this much brighter by photons than the whole picture are those of a caustic.
const CAUSTIC: f64 = 3.0;

struct Arguments {
    seeds: u64,
    first: u64,
    rooms: u64,
    spp: u32,
    photons: Option<u32>,
    truth_spp: u32,
    path_spp: u32,
    write: Option<PathBuf>,
}

fn main() -> Result<()> {
    let arguments = read()?;
    let numbers = arguments.first..arguments.first + arguments.rooms;
    if let Some(folder) = &arguments.write {
        fs::create_dir_all(folder)?;
        for number in numbers {
            fs::write(folder.join(format!("room-{number}.toml")), rooms::scene_file(&room(number)))?;
        }
        return Ok(());
    }
    println!(
        "room,decades,covered,open,above,median_high_by_true,true_error,stated,bias_high,mean_off,mean_se,\
         caustic_off,caustic_se,path_off,path_error"
    );
    for number in numbers {
        let line = study(number, &arguments).with_context(|| format!("room {number}"))?;
        println!("{number},{},{line}", rooms::decades(number));
    }
    Ok(())
}

fn read() -> Result<Arguments> {
    let mut read = Arguments {
        seeds: 40,
        first: 0,
        rooms: rooms::ROOMS,
        spp: 64,
        photons: None,
        truth_spp: 1024,
        path_spp: 4096,
        write: None,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let value = words.next().with_context(|| format!("{word} needs a value"))?;
        match word.as_str() {
            "--seeds" => read.seeds = value.parse()?,
            "--first" => read.first = value.parse()?,
            "--rooms" => read.rooms = value.parse()?,
            "--spp" => read.spp = value.parse()?,
            "--photons" => read.photons = Some(value.parse()?),
            "--truth-spp" => read.truth_spp = value.parse()?,
            "--write" => read.write = Some(value.into()),
            "--path-spp" => read.path_spp = value.parse()?,
            _ => bail!("unknown flag {word}"),
        }
    }
    Ok(read)
}

/// A render, and what it states.
struct Rendered {
    image: Image,
    error: ErrorStatement,
    bias: Option<BiasStatement>,
}

fn rendered(world: &World, settings: Settings) -> Result<Rendered> {
    let settings = Settings { width: 64, height: 64, ..settings };
    let pool = pool(0)?;
    let renderer = pool.install(|| Renderer::new(world, settings, Level::available()[0]))?;
    let film = Film::new(renderer.settings().area(), 32);
    let film = render(&renderer, film, &pool, &Cancel::default(), None)?.film;
    let error = error_statement(&film).context("it takes 32 samples a pixel")?;
    Ok(Rendered { image: film.develop(), error, bias: bias_statement(&film) })
}

impl Rendered {
    /// Its pixels as greys; everything in the rooms is grey.
    fn greys(&self) -> impl Iterator<Item = f64> {
        self.image.pixels.iter().map(|pixel| pixel.map(f64::from).iter().sum::<f64>() / 3.0)
    }

    fn brightness(&self) -> f64 {
        self.image.mean().iter().sum::<f64>() / 3.0
    }
}

fn study(number: u64, arguments: &Arguments) -> Result<String> {
    let world = room(number);
    let auto = |seed, spp| Settings { integrator: Integrator::Auto, seed, spp, ..Settings::default() };
    let photons = Some(1 << 20);
    let truth = rendered(&world, Settings { photons, ..auto(1 << 32, arguments.truth_spp) })?;
    let path = rendered(
        &world,
        Settings { integrator: Integrator::Path, spp: arguments.path_spp, seed: 7, ..Settings::default() },
    )?;
    let brightness = truth.brightness();
    let is_caustic = |pixel: f64| pixel > CAUSTIC * brightness;
    let mut room = Room::default();
    for seed in 0..arguments.seeds {
        let image = rendered(&world, Settings { photons: arguments.photons, ..auto(seed, arguments.spp) })?;
        let error = compare(&image.image, &truth.image, 0)?.relative_error.context("the truth is black")?;
        // The truth has noise of its own.
        let own = truth.error.relative_error;
        room.count((error * error - own * own).max(0.0).sqrt(), &image);
        room.means.push(image.brightness() / brightness - 1.0);
        let caustic = || truth.greys().zip(image.greys()).filter(|(truth, _)| is_caustic(*truth));
        let there = caustic().map(|(truth, _)| truth).sum::<f64>();
        room.caustics.push(if there > 0.0 { caustic().map(|(_, x)| x).sum::<f64>() / there - 1.0 } else { 0.0 });
    }
    let path_off = path.brightness() / brightness - 1.0;
    Ok(format!("{},{path_off:.4},{:.4}", room.line(), path.error.relative_error))
}

/// The renders of a room.
#[derive(Default)]
struct Room {
    truths: Vec<f64>,
    stated: Vec<f64>,
    biases: Vec<f64>,
    ratios: Vec<f64>,
    below: usize,
    above: usize,
    open: usize,
    means: Vec<f64>,
    caustics: Vec<f64>,
}

impl Room {
    fn count(&mut self, truth: f64, image: &Rendered) {
        let bias = image.bias.map_or(0.0, |bias| bias.relative_bias_high.max(bias.relative_bias));
        let high = image.error.relative_error_high.map(|high| (high * high + bias * bias).sqrt());
        self.below += usize::from(truth < image.error.relative_error_low);
        self.above += usize::from(high.is_some_and(|high| truth > high));
        self.open += usize::from(high.is_none());
        self.ratios.push(high.unwrap_or(f64::INFINITY) / truth);
        self.truths.push(truth);
        self.stated.push(image.error.relative_error);
        self.biases.push(bias);
    }

    fn line(&self) -> String {
        let renders = self.truths.len();
        let covered = (renders - self.below - self.above) as f64 / renders as f64;
        let [ratio, truth, stated, bias] =
            [&self.ratios, &self.truths, &self.stated, &self.biases].map(|all| median(all));
        let [(mean_off, mean_se), (caustic_off, caustic_se)] = [&self.means, &self.caustics].map(|all| moments(all));
        let (open, above) = (self.open, self.above);
        format!(
            "{covered:.3},{open},{above},{ratio:.2},{truth:.4},{stated:.4},{bias:.4},\
             {mean_off:.4},{mean_se:.4},{caustic_off:.4},{caustic_se:.4}"
        )
    }
}

/// Mean and its standard error.
fn moments(values: &[f64]) -> (f64, f64) {
    let mean_of = values.iter().sum::<f64>() / values.len() as f64;
    let variance =
        values.iter().map(|value| (value - mean_of) * (value - mean_of)).sum::<f64>() / (values.len() - 1) as f64;
    (mean_of, (variance / values.len() as f64).sqrt())
}

fn median(values: &[f64]) -> f64 {
    smalti_measure::median(values).unwrap_or(f64::NAN)
}
