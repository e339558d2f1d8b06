//! The error that a render states of itself.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use smalti_core::film::{Film, Tile};

use crate::compare::FLOOR;
use crate::relative::{Sums, sums};

/// The error of one image against the truth, with 95 % intervals: for this image, not for renders like it.
///
/// The upper ends are `None` where they cannot be known: too few rounds, or pixels whose statistics cannot be trusted
/// carry most of the error, so that the ends would be far apart. The statement is then a lower bound. Noise only: a bias
/// (a depth limit, a photon radius) and light that no sample met are not in it. The names of the fields are a promise:
/// summaries carry them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorStatement {
    /// Mean over pixels and channels of (x − r)² / (r² + 0.01), r the truth.
    pub relmse: f64,
    /// Lower end of its interval.
    pub relmse_low: f64,
    /// Upper end of its interval.
    pub relmse_high: Option<f64>,
    /// Root of the mean over pixels and channels of (x − r)² / (r² + 0.01 m²), m the mean of the image: does not change
    /// with exposure.
    pub relative_error: f64,
    /// Lower end of its interval.
    pub relative_error_low: f64,
    /// Upper end of its interval.
    pub relative_error_high: Option<f64>,
    /// Pixels of which a quarter or half of the samples is much brighter than the rest: nobody can say yet whether that is
    /// chance.
    pub uncertified_pixels: usize,
}

/// The error of the image that `film` develops into.
///
/// `None` if there is no pixel, one with fewer than two rounds, or one whose mean or variance is not finite.
pub fn error_statement(film: &Film) -> Option<ErrorStatement> {
    let count = (3 * film.area.pixels()) as f64;
    let batches = film.tiles.iter().map(|tile| tile.counts.batches()).min().filter(|batches| *batches >= 2)?;
    let mean = mean(film);
    let floors = [FLOOR, FLOOR * mean * mean];
    let of_tiles: Vec<[Sums; 2]> = film.tiles.par_iter().map(|tile| sums(tile, floors)).collect();
    let all = of_tiles.into_iter().reduce(|a, b| [a[0].and(b[0]), a[1].and(b[1])])?;
    let [absolute, scaled] = all.map(|sums| sums.relative(count, batches));
    let (absolute, scaled) = (absolute?, scaled?);
    Some(ErrorStatement {
        relmse: absolute.value,
        relmse_low: absolute.low,
        relmse_high: absolute.high,
        relative_error: scaled.value.sqrt(),
        relative_error_low: scaled.low.sqrt(),
        relative_error_high: scaled.high.map(f64::sqrt),
        uncertified_pixels: scaled.uncertified,
    })
}

/// For each tile of a film what one sample of each of its pixels leaves of squared relative error, summed over pixels and
/// channels: where more samples would help.
pub fn noise(film: &Film) -> Vec<f64> {
    let mean = mean(film);
    let floor = FLOOR * mean * mean;
    let of_tile = |tile: &Tile| sums(tile, [floor; 2])[0].plain() * tile.counts.size_of_all();
    film.tiles.par_iter().map(of_tile).collect()
}

/// Mean over the pixels and channels of a film, in the order of its tiles.
fn mean(film: &Film) -> f64 {
    let brightness: Vec<f64> = film.tiles.par_iter().map(brightness).collect();
    brightness.iter().sum::<f64>() / (3 * film.area.pixels()).max(1) as f64
}

/// Sum over the pixels and channels of a tile.
fn brightness(tile: &Tile) -> f64 {
    tile.pixels.iter().flat_map(|pixel| pixel.mean(&tile.counts)).sum()
}

#[cfg(test)]
mod tests {
    use smalti_core::film::{Counts, Film, ROUND};
    use smalti_core::settings::Rect;

    use super::*;

    /// A film whose pixels have batches of these means.
    fn film(width: u32, height: u32, batches: impl Fn(usize) -> [f64; 4]) -> Film {
        let mut film = Film::new(Rect { x: 0, y: 0, width, height }, width.max(height));
        film.tiles[0].counts = Counts::of(4 * ROUND);
        for (index, pixel) in film.tiles[0].pixels.iter_mut().enumerate() {
            pixel.sums = batches(index).map(|mean| [mean * f64::from(ROUND); 3]);
        }
        film
    }

    #[test]
    fn an_image_without_variance_is_exact() {
        for mean in [0.0, 0.5] {
            let statement = error_statement(&film(3, 2, |_| [mean; 4])).unwrap();
            assert_eq!((statement.relmse, statement.relmse_low, statement.relmse_high), (0.0, 0.0, Some(0.0)));
            assert_eq!((statement.relative_error, statement.relative_error_high), (0.0, Some(0.0)));
            assert_eq!(statement.uncertified_pixels, 0);
        }
    }

    /// Batches at 1 ± d: variance of the mean d² / 3.
    #[test]
    fn a_constant_image_has_its_closed_form() {
        let d = 1e-3;
        let statement = error_statement(&film(100, 100, |_| [1.0 + d, 1.0 - d, 1.0 + d, 1.0 - d])).unwrap();
        let variance = d * d / 3.0;
        assert!((statement.relmse * 1.01 / variance - 1.0).abs() < 1e-4, "{statement:?}");
        assert!((statement.relative_error / (variance / 1.01).sqrt() - 1.0).abs() < 1e-4);
        // F with 10,000 (the channels are taken to go together) and 30,000 degrees of freedom, freed of 1 + 2 / 3.
        let half_width = 1.96 * (2.0f64 / 10_000.0 * (1.0 + 1.0 / 3.0) / (1.0 + 2.0 / 3.0)).sqrt();
        assert!(((statement.relmse_high.unwrap() / statement.relmse - 1.0) / half_width - 1.0).abs() < 0.05);
        assert!(((1.0 - statement.relmse_low / statement.relmse) / half_width - 1.0).abs() < 0.05);
    }

    #[test]
    fn relative_error_does_not_change_with_exposure() {
        let batches = |scale: f64| {
            move |i: usize| [0, 1, 2, 3].map(|k: usize| scale * ((i + 1) as f64 + ((i + 3) * (k + 5) % 7) as f64))
        };
        let [plain, bright] = [1.0, 4096.0].map(|scale| error_statement(&film(20, 20, batches(scale))).unwrap());
        assert_eq!(plain.relative_error, bright.relative_error);
        assert_eq!(plain.relative_error_high, bright.relative_error_high);
        assert_eq!(plain.uncertified_pixels, bright.uncertified_pixels);
    }

    #[test]
    fn one_firefly_leaves_a_lower_bound() {
        for place in [0, 50, 98] {
            let noise = |i: usize, k: usize| 1.0 + 0.01 * ((i * 7 + k * 13) % 5) as f64;
            // One batch of four is brighter by 400.
            let batches = |i: usize| [0, 1, 2, 3].map(|k| noise(i, k) + if (i, k) == (place, 2) { 400.0 } else { 0.0 });
            let statement = error_statement(&film(99, 20, batches)).unwrap();
            assert_eq!((statement.uncertified_pixels, statement.relmse_high), (1, None), "{statement:?}");
            assert_eq!(statement.relative_error_high, None);
            assert!(statement.relmse_low < 1e4 / (99.0 * 20.0));
        }
    }

    /// Two batches of four, or one of three, are as doubtful as one of four; two of three are not told from the rest.
    #[test]
    fn two_bright_batches_are_doubted_too() {
        for (rounds, bright, uncertified) in [(4, &[1, 2][..], 1), (4, &[0, 1, 2][..], 0), (3, &[1][..], 1)] {
            let level = |i: usize, k: usize| if i == 50 && bright.contains(&k) { 400.0 } else { 0.0 };
            let used = |k: usize| if k < rounds { 1.0 } else { 0.0 };
            let batches = |i: usize| [0, 1, 2, 3].map(|k| used(k) * (1.0 + 0.01 * ((i + k) % 5) as f64 + level(i, k)));
            let mut film = film(99, 20, batches);
            film.tiles[0].counts = Counts::of(rounds as u32 * ROUND);
            let statement = error_statement(&film).unwrap();
            assert_eq!(statement.uncertified_pixels, uncertified, "{rounds} rounds, {bright:?}: {statement:?}");
            assert_eq!(statement.relmse_high.is_none(), uncertified == 1);
        }
    }

    /// The more uneven pixel is not the less doubtful one because one of its batches is doubted alone.
    #[test]
    fn doubts_grow_with_what_is_uneven() {
        let upper = |bright: [f64; 4]| {
            let batches = |i: usize| if i == 7 { bright } else { [0, 1, 2, 3].map(|k| 4.0 + ((i + k) % 3) as f64) };
            error_statement(&film(200, 200, batches)).unwrap().relmse_high.unwrap_or(f64::INFINITY)
        };
        assert!(upper([10.0, 6.0, 0.01, 0.01]) >= upper([8.0, 8.0, 0.01, 0.01]));
    }

    #[test]
    fn what_cannot_be_stated_is_not() {
        let empty = Film::new(Rect { x: 0, y: 0, width: 2, height: 1 }, 1);
        assert_eq!(error_statement(&empty), None);
        assert_eq!(error_statement(&Film { tiles: Vec::new(), ..empty }), None);
        assert_eq!(error_statement(&film(1, 1, |_| [1.0, 1.0, f64::NAN, 1.0])), None);
        assert_eq!(error_statement(&film(1, 1, |_| [1.0, 1.0, f64::INFINITY, 1.0])), None);
    }

    #[test]
    fn two_rounds_have_no_upper_end() {
        let mut film = film(30, 30, |i| [1.0, 1.0 + (i % 3) as f64, 0.0, 0.0]);
        film.tiles[0].counts = Counts::of(2 * ROUND);
        let statement = error_statement(&film).unwrap();
        assert!(statement.relmse > 0.0 && statement.relmse_high.is_none(), "{statement:?}");
    }
}
