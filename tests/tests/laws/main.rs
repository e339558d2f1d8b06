//! Laws that the kernels must obey, whatever the scene: distributions, densities, energy, and geometry without gaps.

mod closed;
mod glints;
mod kernels;
mod leaving;
mod lights;
mod photon_maps;
mod photons;
mod scattering;
mod warps;

use smalti_tests::statistics::{chi_square, sidak};

/// χ² tests in this program; together they have level 0.01.
const CHI_SQUARES: usize = 24;

const COLUMNS: usize = 80;
const ROWS: usize = 40;

/// Asserts that pairs in [0, 1)² fall into 40 × 80 cells with chances proportional to `weight` of a row's two bounds.
fn assert_fits(name: &str, pairs: impl Iterator<Item = (f64, f64)>, weight: impl Fn(f64, f64) -> f64) {
    let mut counts = vec![0u64; ROWS * COLUMNS];
    let mut total = 0.0;
    for (row, column) in pairs {
        let row = ((row * ROWS as f64) as usize).min(ROWS - 1);
        let column = ((column * COLUMNS as f64) as usize).min(COLUMNS - 1);
        counts[row * COLUMNS + column] += 1;
        total += 1.0;
    }
    let bound = |row: usize| row as f64 / ROWS as f64;
    let of_row = |row: usize| weight(bound(row), bound(row + 1)) * total / COLUMNS as f64;
    let expected: Vec<f64> = (0..ROWS * COLUMNS).map(|cell| of_row(cell / COLUMNS)).collect();
    let sum: f64 = expected.iter().sum();
    assert!((sum / total - 1.0).abs() < 1e-9, "{name}: the chances must add up to 1");
    let p = chi_square(&counts, &expected);
    assert!(p > sidak(0.01, CHI_SQUARES), "{name}: p = {p:e}");
}

/// Chance of a row of equal chances.
fn uniform(low: f64, high: f64) -> f64 {
    high - low
}

/// Chance of a row of cosines under cosine-weighting.
fn of_cosine(low: f64, high: f64) -> f64 {
    high * high - low * low
}

/// The angle of (x, y) as a part of a turn, in [0, 1).
fn turn(x: f64, y: f64) -> f64 {
    (libm::atan2(y, x) / core::f64::consts::TAU).rem_euclid(1.0)
}
