//! The statistics that tests decide by.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

/// The level of each of `count` tests with which all together have level `alpha` (Šidák).
pub fn sidak(alpha: f64, count: usize) -> f64 {
    -libm::expm1(libm::log1p(-alpha) / count as f64)
}

/// Chance of a standard normal value at least as far from 0 as `z`.
pub fn two_sided(z: f64) -> f64 {
    libm::erfc(z.abs() / core::f64::consts::SQRT_2)
}

/// The |z| that a standard normal value passes with chance `alpha`.
pub fn critical(alpha: f64) -> f64 {
    -Normal::standard().inverse_cdf(alpha / 2.0)
}

/// The |t| that Student's t with `freedom` degrees of freedom passes with chance `alpha`.
pub fn critical_of_t(alpha: f64, freedom: f64) -> f64 {
    -StudentsT::new(0.0, 1.0, freedom).expect("some freedom").inverse_cdf(alpha / 2.0)
}

/// Pearson's χ² of counts against expected counts: the chance of a fit at least as bad. Cells that expect fewer than 5
/// are pooled, as the approximation wants; a count where nothing is expected gives 0.
pub fn chi_square(counts: &[u64], expected: &[f64]) -> f64 {
    let (mut statistic, mut cells) = (0.0, 0u32);
    let (mut pooled, mut pooled_expected) = (0.0, 0.0);
    for (&count, &expected) in counts.iter().zip(expected) {
        if expected == 0.0 && count > 0 {
            return 0.0;
        }
        if expected < 5.0 {
            pooled += count as f64;
            pooled_expected += expected;
        } else {
            statistic += (count as f64 - expected) * (count as f64 - expected) / expected;
            cells += 1;
        }
    }
    if pooled_expected >= 5.0 {
        statistic += (pooled - pooled_expected) * (pooled - pooled_expected) / pooled_expected;
        cells += 1;
    }
    assert!(cells > 1, "nothing to test");
    ChiSquared::new(f64::from(cells - 1)).expect("at least one degree of freedom").sf(statistic)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_tails_are_the_tables() {
        assert!((two_sided(1.959_963_985) - 0.05).abs() < 1e-9);
        assert!((critical(0.05) - 1.959_963_985).abs() < 1e-8);
        assert!((critical(1e-6) - 4.891_638_475).abs() < 1e-6);
    }

    #[test]
    fn tails_of_few_values_are_the_tables() {
        assert!((critical_of_t(0.05, 10.0) - 2.228_138_852).abs() < 1e-6);
        assert!((critical_of_t(0.001, 14.0) - 4.140_454_113).abs() < 1e-6);
    }

    #[test]
    fn sidaks_level_gives_the_whole_level_back() {
        let each = sidak(0.01, 40);
        assert!((libm::pow(1.0 - each, 40.0) - 0.99).abs() < 1e-12);
    }

    #[test]
    fn chi_square_tells_a_fair_die_from_a_loaded_one() {
        let fair = chi_square(&[98, 103, 101, 97, 105, 96], &[100.0; 6]);
        let loaded = chi_square(&[80, 100, 100, 100, 100, 120], &[100.0; 6]);
        assert!(fair > 0.9 && loaded < 0.2, "{fair} {loaded}");
        // The 95 % point of five degrees of freedom is 11.0705.
        assert!((ChiSquared::new(5.0).unwrap().sf(11.0705) - 0.05).abs() < 1e-5);
        assert_eq!(chi_square(&[100, 100, 1], &[100.0, 100.0, 0.0]), 0.0);
    }
}
