//! Renderers that must agree: streams and the oracle, and streams with streams under other settings.

mod adaptive;
mod oracle;
mod photons;
mod primary;
mod scales;
mod scenes;
mod settings;
mod whitted;

use smalti_tests::estimate::Rendered;
use smalti_tests::statistics::{critical, sidak};

/// Columns and rows of every picture here.
const SIZE: u32 = 32;
/// Pictures are compared in blocks of 8 × 8 pixels.
const BLOCK: u32 = 8;
/// At most as many pairs of pictures are compared; all their blocks together have level 1e-4.
const PAIRS: usize = 24;

/// Mean and variance of that mean, for each pixel and channel.
type Picture = Vec<[(f64, f64); 3]>;

fn of_streams(rendered: &Rendered) -> Picture {
    let pixels = rendered.pixels.as_ref().expect("two rounds of samples");
    pixels.iter().map(|pixel| [0, 1, 2].map(|k| (pixel.mean()[k], pixel.variance()[k]))).collect()
}

fn of_oracle(pixels: &[smalti_tests::oracle::Pixel]) -> Picture {
    pixels.iter().map(|pixel| [0, 1, 2].map(|k| (pixel.mean[k], pixel.variance[k]))).collect()
}

/// Mean of the given pixels and the variance of that mean.
fn mean_of(picture: &Picture, pixels: impl Iterator<Item = usize>, channel: usize) -> (f64, f64) {
    let (mut mean, mut variance, mut count) = (0.0, 0.0, 0.0);
    for pixel in pixels {
        mean += picture[pixel][channel].0;
        variance += picture[pixel][channel].1;
        count += 1.0;
    }
    (mean / count, variance / (count * count))
}

/// Pixels of a block.
fn block(column: u32, row: u32) -> impl Iterator<Item = usize> {
    let corner = row * BLOCK * SIZE + column * BLOCK;
    (0..BLOCK * BLOCK).map(move |k| (corner + k / BLOCK * SIZE + k % BLOCK) as usize)
}

/// Asserts that two pictures with independent noise have the same mean in every block (Welch's test) and as a whole,
/// that the whole is known to `precision`, and that the stated errors are neither too small nor too large.
fn assert_agree(name: &str, a: &Picture, b: &Picture, precision: f64) {
    let blocks = SIZE / BLOCK;
    let limit = critical(sidak(1e-4, PAIRS * 3 * (blocks * blocks) as usize));
    let (mut squares, mut tests) = (0.0, 0.0);
    for (channel, (column, row)) in
        (0..3).flat_map(|channel| (0..blocks).flat_map(move |c| (0..blocks).map(move |r| (channel, (c, r)))))
    {
        let (of_a, of_b) = (mean_of(a, block(column, row), channel), mean_of(b, block(column, row), channel));
        let error = (of_a.1 + of_b.1).sqrt();
        // Without noise (a lamp seen directly) f32 against f64 is left.
        let off = (of_a.0 - of_b.0).abs();
        if error < 1e-5 * of_a.0.abs() {
            assert!(off <= 1e-4 * of_a.0.abs(), "{name}: block {column}, {row}: {of_a:?} and {of_b:?}");
            continue;
        }
        let z = off / error;
        assert!(z < limit, "{name}: block {column}, {row}, channel {channel}: {of_a:?} and {of_b:?}, z = {z:.1}");
        squares += z * z;
        tests += 1.0;
    }
    let spread: f64 = squares / tests;
    assert!((0.35..2.5).contains(&spread), "{name}: z² is {spread:.2} in the mean, where 1 is expected");
    for channel in 0..3 {
        let (of_a, of_b) = (mean_of(a, 0..a.len(), channel), mean_of(b, 0..b.len(), channel));
        let error = (of_a.1 + of_b.1).sqrt();
        assert!(error < precision * of_a.0, "{name}: known only to {:.1e}", error / of_a.0);
        let z = (of_a.0 - of_b.0) / error;
        assert!(z.abs() < 4.5, "{name}: means {} and {}, z = {z:.1}", of_a.0, of_b.0);
    }
}
