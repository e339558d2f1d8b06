//! The picture of a room, as far as it is known.
//!
//! The smallest lamps are seen in balls as glints far below a pixel, which one path in a hundred thousand finds: of a
//! few pixels no render knows the truth. They are left out, of the truth and of what is judged by it.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use smalti_core::film::{Film, Image, Pixel, Tile};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Rect, Settings};
use smalti_image::Provenance;
use smalti_scheduler::{Cancel, pool, render};

/// Pixels whose standard error in the truth is more than this part of them are not judged.
const UNKNOWN: f64 = 0.15;

/// Side of the pictures, pixels.
pub const SIDE: u32 = 64;

/// A picture and its standard errors.
pub struct Measured {
    pub image: Image,
    errors: Image,
}

impl Measured {
    fn rendered(world: &World, settings: Settings) -> Result<Self> {
        let film = film(world, settings)?;
        let errors = film.standard_errors().context("it takes 32 samples a pixel")?;
        Ok(Self { image: film.develop(), errors })
    }

    fn read(folder: &Path, name: &str) -> Result<Self> {
        let of = |what| smalti_image::read(&folder.join(format!("{name}{what}.pfm")));
        Ok(Self { image: of("")?, errors: of("-error")? })
    }

    fn write(&self, folder: &Path, name: &str) -> Result<()> {
        for (what, image) in [("", &self.image), ("-error", &self.errors)] {
            smalti_image::write(&folder.join(format!("{name}{what}.pfm")), image, &Provenance::new(), 0.0)?;
        }
        Ok(())
    }

    /// The relative standard error of the mean of all pixels.
    pub fn error_of_mean(&self) -> f64 {
        let variance = greys(&self.errors).map(|error| error * error).sum::<f64>();
        variance.sqrt() / greys(&self.image).sum::<f64>()
    }

    /// The root of its relmse, by its own standard errors.
    pub fn relative_error(&self) -> f64 {
        let floor = 0.01 * brightness(&self.image) * brightness(&self.image);
        let pixels = greys(&self.image).zip(greys(&self.errors));
        let sum = pixels.map(|(value, error)| error * error / (value * value + floor)).sum::<f64>();
        (sum / self.image.pixels.len() as f64).sqrt()
    }
}

/// The truth of a room, and the same by paths alone.
pub struct Truth {
    pub auto: Measured,
    pub path: Measured,
    /// Pixels that are judged.
    pub judged: Vec<bool>,
}

impl Truth {
    /// The truth of a room, with as many samples a pixel by `auto` and by `path`. The folder keeps it: pictures that are
    /// there are read, others are rendered and written.
    pub fn of(number: u64, world: &World, [auto, path]: [u32; 2], folder: Option<&Path>) -> Result<Self> {
        let settings =
            |integrator, seed, spp| Settings { integrator, seed, spp, photons: Some(1 << 18), ..Settings::default() };
        let of = |name: &str, settings| {
            let name = format!("room-{number}-{name}");
            let Some(folder) = folder else { return Measured::rendered(world, settings) };
            if folder.join(format!("{name}-error.pfm")).exists() {
                return Measured::read(folder, &name);
            }
            let measured = Measured::rendered(world, settings)?;
            fs::create_dir_all(folder)?;
            measured.write(folder, &name)?;
            Ok(measured)
        };
        let auto = of("auto", settings(Integrator::Auto, 1 << 32, auto))?;
        let path = of("path", settings(Integrator::Path, 7, path))?;
        Ok(Self { judged: judged(&auto), auto, path }.cut())
    }

    /// Black wherever nothing is judged.
    fn cut(mut self) -> Self {
        for measured in [&mut self.auto, &mut self.path] {
            for image in [&mut measured.image, &mut measured.errors] {
                let pixels = image.pixels.iter_mut().zip(&self.judged);
                pixels.filter(|(_, judged)| !**judged).for_each(|(pixel, _)| *pixel = [0.0; 3]);
            }
        }
        self
    }

    /// Takes what is not judged off a film of [`film`].
    pub fn cut_film(&self, film: &mut Film) {
        let pixels = film.tiles.iter_mut().flat_map(|tile| {
            tile.shifts.resize(tile.pixels.len(), Default::default());
            tile.pixels.iter_mut().zip(&mut tile.shifts)
        });
        for ((pixel, shift), _) in pixels.zip(&self.judged).filter(|(_, judged)| !**judged) {
            (*pixel, *shift) = (Pixel::default(), Default::default());
        }
    }
}

fn judged(measured: &Measured) -> Vec<bool> {
    greys(&measured.image).zip(greys(&measured.errors)).map(|(value, error)| error <= UNKNOWN * value).collect()
}

/// A render, in tiles as wide as the image.
pub fn film(world: &World, settings: Settings) -> Result<Film> {
    let settings = Settings { width: SIDE, height: SIDE, ..settings };
    let pool = pool(0)?;
    let renderer = pool.install(|| Renderer::new(world, settings, Level::available()[0]))?;
    let area = renderer.settings().area();
    Ok(render(&renderer, bands(area), &pool, &Cancel::default(), None)?.film)
}

/// A film in tiles of the whole width and a few rows, so that pixels come in the order of the image.
fn bands(area: Rect) -> Film {
    let band = |y| Tile::new(Rect { y, height: SIDE / 16, ..area });
    Film { area, tiles: (0..area.height).step_by(SIDE as usize / 16).map(band).collect() }
}

/// The pixels of an image as greys; everything in the rooms is grey.
pub fn greys(image: &Image) -> impl Iterator<Item = f64> {
    image.pixels.iter().map(|pixel| pixel.map(f64::from).iter().sum::<f64>() / 3.0)
}

/// The mean of all pixels.
pub fn brightness(image: &Image) -> f64 {
    image.mean().iter().sum::<f64>() / 3.0
}
