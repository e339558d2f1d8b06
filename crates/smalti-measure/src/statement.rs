//! The error that a render states of itself.

use serde::{Deserialize, Serialize};
use smalti_core::film::Estimate;

use crate::compare::FLOOR;
use crate::neighbours::Grid;
use crate::relative::relative;

/// The error of one image against the truth, with 95 % intervals: for this image, not for renders like it.
///
/// The upper ends are `None` where they cannot be known: too few rounds, or pixels whose statistics cannot be trusted
/// carry a notable part of the error. The statement is then a lower bound. Noise only: a bias (a depth limit, a photon
/// radius) and light that no sample met are not in it. The names of the fields are a promise: summaries carry them.
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
    /// Pixels with a standard error above half of their value plus a twentieth of the image's mean: a single bright
    /// round may dominate them.
    pub uncertified_pixels: usize,
}

/// The error of the image whose pixels are `estimates`, in rows of `width` from the top.
///
/// `shared` says which pixels may share samples: those within squares of so many pixels a side, wider than a photon
/// gather; 1 where each pixel has samples of its own.
///
/// `None` if there is no pixel, one with fewer than two rounds, or one whose mean or variance is not finite.
pub fn error_statement(estimates: &[Estimate], width: u32, shared: u32) -> Option<ErrorStatement> {
    if estimates.is_empty() || !estimates.iter().all(is_usable) {
        return None;
    }
    let grid = Grid { estimates, width: width.max(1) as usize, shared: (shared as usize).clamp(1, estimates.len()) };
    let correlation = grid.channel_correlation();
    let mean = estimates.iter().flat_map(Estimate::mean).sum::<f64>() / (3 * estimates.len()) as f64;
    let of = |floor: f64| relative(&grid, &correlation, floor);
    let (absolute, scaled) = rayon::join(|| of(FLOOR), || of(FLOOR * mean * mean));
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

fn is_usable(pixel: &Estimate) -> bool {
    pixel.rounds >= 2 && pixel.mean().iter().chain(&pixel.variance()).all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixel(mean: f64, variance: f64, rounds: u32) -> Estimate {
        Estimate::new([mean; 3], [variance; 3], rounds)
    }

    #[test]
    fn an_image_without_variance_is_exact() {
        for mean in [0.0, 0.5] {
            let statement = error_statement(&[pixel(mean, 0.0, 2); 6], 3, 1).unwrap();
            assert_eq!((statement.relmse, statement.relmse_low, statement.relmse_high), (0.0, 0.0, Some(0.0)));
            assert_eq!((statement.relative_error, statement.relative_error_high), (0.0, Some(0.0)));
            assert_eq!(statement.uncertified_pixels, 0);
        }
    }

    #[test]
    fn a_constant_image_has_its_closed_form() {
        let statement = error_statement(&vec![pixel(1.0, 1e-6, 64); 100 * 100], 100, 1).unwrap();
        assert!((statement.relmse * 1.01e6 - 1.0).abs() < 1e-3, "{statement:?}");
        assert!((statement.relative_error * 1.01f64.sqrt() * 1e3 - 1.0).abs() < 1e-3);
        // F with 10,000 (the channels fluctuate alike) and 630,000 degrees of freedom.
        let half_width = 1.96 * (2.0f64 / 10_000.0 * 65.0 / 63.0 * 64.0 / 63.0).sqrt();
        assert!(((statement.relmse_high.unwrap() / statement.relmse - 1.0) / half_width - 1.0).abs() < 0.05);
        assert!(((1.0 - statement.relmse_low / statement.relmse) / half_width - 1.0).abs() < 0.05);
    }

    #[test]
    fn pixels_that_share_samples_widen_the_interval() {
        let estimates = vec![pixel(1.0, 1e-6, 64); 128 * 128];
        let [alone, shared] = [1, 8].map(|shared| error_statement(&estimates, 128, shared).unwrap());
        let width = |statement: ErrorStatement| statement.relmse_high.unwrap() - statement.relmse_low;
        assert_eq!(alone.relmse, shared.relmse);
        assert!((7.0..9.0).contains(&(width(shared) / width(alone))), "{alone:?} {shared:?}");
    }

    #[test]
    fn relative_error_does_not_change_with_exposure() {
        let estimates = |scale: f64| -> Vec<_> {
            (1..=400).map(|i| pixel(scale * f64::from(i), scale * scale * f64::from(i % 7 * i), 4)).collect()
        };
        let [plain, bright] = [1.0, 4096.0].map(|scale| error_statement(&estimates(scale), 20, 1).unwrap());
        assert_eq!(plain.relative_error, bright.relative_error);
        assert_eq!(plain.relative_error_high, bright.relative_error_high);
        assert_eq!(plain.uncertified_pixels, bright.uncertified_pixels);
    }

    #[test]
    fn one_firefly_leaves_a_lower_bound() {
        for place in [0, 50, 98] {
            let mut estimates = vec![pixel(1.0, 1e-3, 8); 99 * 20];
            // One round of eight was brighter by 800.
            estimates[place] = pixel(101.0, 1e4, 8);
            let statement = error_statement(&estimates, 99, 1).unwrap();
            assert_eq!((statement.uncertified_pixels, statement.relmse_high), (1, None), "{statement:?}");
            assert_eq!(statement.relative_error_high, None);
            assert!(statement.relmse_low < 1e4 / (99.0 * 20.0));
        }
    }

    #[test]
    fn what_cannot_be_stated_is_not() {
        assert_eq!(error_statement(&[], 1, 1), None);
        assert_eq!(error_statement(&[pixel(1.0, 0.1, 8), pixel(1.0, 0.1, 1)], 2, 1), None);
        assert_eq!(error_statement(&[pixel(f64::NAN, 0.1, 8)], 1, 1), None);
        assert_eq!(error_statement(&[pixel(1.0, f64::INFINITY, 8)], 1, 1), None);
    }

    #[test]
    fn one_pixel_of_two_rounds_has_no_upper_end() {
        let statement = error_statement(&[pixel(1.0, 0.01, 2)], 1, 1).unwrap();
        assert_eq!((statement.relmse_low, statement.relmse_high), (0.0, None));
    }
}
