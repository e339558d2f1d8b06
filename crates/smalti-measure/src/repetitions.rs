//! What repetitions of one measurement say together: a middle, and how far it can be trusted.

use serde::Serialize;

use crate::timing::median;

/// Repetitions from which an interval can be computed; with fewer there is only their range.
pub const REPETITIONS_FOR_INTERVAL: usize = 3;

/// The two-sided 95 % quantiles of Student's t distribution with 1, 2, 3 ... degrees of freedom.
const STUDENT: [f64; 8] = [12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060];

/// The same quantile of the normal distribution.
const NORMAL: f64 = 1.959_964;

/// Repetitions of a positive quantity (a time, an error, a ratio of two).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Repetitions {
    /// Their median.
    pub median: f64,
    /// Lower end of the interval, or the least of them.
    pub low: f64,
    /// Upper end of the interval, or the greatest of them.
    pub high: f64,
    /// How many there are; at least 1.
    pub count: usize,
    /// What `low` and `high` are.
    pub ends: Ends,
}

/// What the ends of a range of repetitions are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ends {
    /// The 95 % interval of the geometric mean, by Student's t on the logarithms.
    Interval,
    /// The least and the greatest: there are fewer than three, or some are not positive.
    Range,
}

/// Looks at `values`, in any order; `None` if there are none or one is not finite.
///
/// For two ways to measure that share what disturbs them (a seed, a moment of the machine), the ratios of each pair are
/// the values to give: what is shared cancels.
pub fn repetitions(values: &[f64]) -> Option<Repetitions> {
    if !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    let (count, median) = (values.len(), median(values)?);
    let certain = count >= REPETITIONS_FOR_INTERVAL && values.iter().all(|&value| value > 0.0);
    let ((low, high), ends) = if certain { (interval(values), Ends::Interval) } else { (range(values), Ends::Range) };
    Some(Repetitions { median, low, high, count, ends })
}

fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
}

fn interval(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().map(|&value| libm::log(value)).sum::<f64>() / count;
    let square = |value: &f64| (libm::log(*value) - mean) * (libm::log(*value) - mean);
    let variance = values.iter().map(square).sum::<f64>() / (count - 1.0);
    let half = student(values.len() - 1) * (variance / count).sqrt();
    (libm::exp(mean - half), libm::exp(mean + half))
}

/// The two-sided 95 % quantile with `degrees` ≥ 1 degrees of freedom: from the table, or by Cornish and Fisher.
fn student(degrees: usize) -> f64 {
    if let Some(&quantile) = STUDENT.get(degrees - 1) {
        return quantile;
    }
    let (z, n) = (NORMAL, degrees as f64);
    let z2 = z * z;
    let second = z * (5.0 * z2 * z2 + 16.0 * z2 + 3.0) / 96.0;
    let third = z * (3.0 * z2 * z2 * z2 + 19.0 * z2 * z2 + 17.0 * z2 - 15.0) / 384.0;
    z + z * (z2 + 1.0) / (4.0 * n) + second / (n * n) + third / (n * n * n)
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{ContinuousCDF, StudentsT};

    use super::*;

    #[test]
    fn quantiles_are_those_of_students_distribution() {
        for degrees in (1..40).chain([100, 1000, 1_000_000]) {
            let exact = StudentsT::new(0.0, 1.0, degrees as f64).unwrap().inverse_cdf(0.975);
            assert!((student(degrees) / exact - 1.0).abs() < 2e-4, "{degrees}: {} for {exact}", student(degrees));
        }
    }

    #[test]
    fn three_have_the_interval_of_their_logarithms() {
        // Logarithms -1, 0, 1: mean 0, variance 1, two degrees of freedom.
        let e = std::f64::consts::E;
        let found = repetitions(&[e, 1.0 / e, 1.0]).unwrap();
        let half = 4.3027 / 3.0f64.sqrt();
        assert_eq!((found.median, found.count, found.ends), (1.0, 3, Ends::Interval));
        assert!((libm::log(found.high) - half).abs() < 1e-9 && (libm::log(found.low) + half).abs() < 1e-9);
    }

    #[test]
    fn equal_values_have_no_width() {
        let found = repetitions(&[1.0; 5]).unwrap();
        assert_eq!((found.low, found.median, found.high), (1.0, 1.0, 1.0));
    }

    #[test]
    fn fewer_than_three_and_values_without_a_logarithm_have_a_range() {
        let of = |values: &[f64]| repetitions(values).map(|found| (found.low, found.median, found.high, found.ends));
        assert_eq!(of(&[2.0]), Some((2.0, 2.0, 2.0, Ends::Range)));
        assert_eq!(of(&[3.0, 1.0]), Some((1.0, 2.0, 3.0, Ends::Range)));
        assert_eq!(of(&[3.0, 0.0, 1.0]), Some((0.0, 1.0, 3.0, Ends::Range)));
        assert_eq!(of(&[3.0, -1.0, 1.0]), Some((-1.0, 1.0, 3.0, Ends::Range)));
        assert_eq!((of(&[]), of(&[1.0, f64::NAN])), (None, None));
    }
}
