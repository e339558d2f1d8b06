//! Adaptive sampling: the mean is that of uniform sampling, the statement is as true, and the error is no larger.

use smalti_core::film::{Film, Image};
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Settings};
use smalti_measure::error_statement;
use smalti_tests::draw::{Way, film, scene};

const RENDERS: u64 = 48;
/// Columns and rows: tiles of 16 pixels.
const SIZE: u32 = 48;

fn renders(world: &World, settings: &Settings) -> Vec<Film> {
    let way = Way { threads: 2, ..Way::default() };
    (0..RENDERS).map(|seed| film(world, &Settings { seed, ..settings.clone() }, way)).collect()
}

fn settings(integrator: Integrator, adaptive: bool, spp: u32) -> Settings {
    Settings { integrator, adaptive, spp, width: SIZE, height: SIZE, ..Settings::default() }
}

/// Mean of each tile (9 of them) and channel over the renders, and its standard error.
fn tiles(films: &[Film]) -> Vec<(f64, f64)> {
    let images: Vec<Image> = films.iter().map(Film::develop).collect();
    let mean = |image: &Image, tile: usize, c: usize| {
        let (x, y) = (tile as u32 % 3 * 16, tile as u32 / 3 * 16);
        let places = (0..256).map(|n| ((y + n / 16) * SIZE + x + n % 16) as usize);
        places.map(|place| f64::from(image.pixels[place][c])).sum::<f64>() / 256.0
    };
    let of = |tile: usize, c: usize| {
        let values: Vec<f64> = images.iter().map(|image| mean(image, tile, c)).collect();
        let middle = values.iter().sum::<f64>() / values.len() as f64;
        let squares: f64 = values.iter().map(|value| (value - middle) * (value - middle)).sum();
        (middle, (squares / (RENDERS * (RENDERS - 1)) as f64).sqrt())
    };
    (0..9).flat_map(|tile| (0..3).map(move |c| of(tile, c))).collect()
}

/// Heavy tails (`path` and caustics) are where a decision by the samples that it is about would darken the image.
#[test]
fn adaptive_sampling_has_no_bias() {
    for (name, integrator) in
        [("hexroom", Integrator::Path), ("hexroom", Integrator::Auto), ("furnace", Integrator::Path)]
    {
        let world = scene(name).world;
        let [uniform, adaptive] = [false, true].map(|on| tiles(&renders(&world, &settings(integrator, on, 160))));
        for (number, (a, b)) in uniform.iter().zip(&adaptive).enumerate() {
            // 27 comparisons a scene: 4.2 by chance once in a thousand scenes.
            let z = (a.0 - b.0) / (a.1 * a.1 + b.1 * b.1 + 1e-14 * a.0 * a.0).sqrt();
            assert!(z.abs() < 4.2, "{name}, {integrator:?}, tile and channel {number}: {a:?} and {b:?}, z = {z:.1}");
        }
    }
}

/// Samples go where the noise is, and what is stated of it holds.
#[test]
fn adaptive_samples_are_counted_for_what_they_are() {
    let world = scene("cornell").world;
    let truth =
        film(&world, &settings(Integrator::Path, false, 1 << 14), Way { threads: 2, ..Way::default() }).develop();
    let mut inside = 0;
    for film in renders(&world, &settings(Integrator::Path, true, 256)) {
        let (least, most) = film.samples();
        assert!((64..256).contains(&least) && most > 256, "{least} to {most}");
        let stated = error_statement(&film).unwrap();
        let found = smalti_measure::compare(&film.develop(), &truth, 0).unwrap().relative_error.unwrap();
        let (low, high) = (stated.relative_error_low, stated.relative_error_high.unwrap());
        inside += u32::from((low..high).contains(&found));
    }
    // Of 48 with a chance of 95 % each: 40 or fewer once in a thousand; the truth has 1/64 of the noise.
    assert!(inside > 40, "{inside} of {RENDERS}");
}
