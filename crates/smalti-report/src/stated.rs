//! What renders stated of themselves, beside what was found.

use serde::Serialize;
use smalti_measure::median;

use crate::record::Run;

/// The statements of an arm's runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stated {
    /// Median of the relative errors that were stated.
    pub relative_error: f64,
    /// Runs that stated an error.
    pub runs: usize,
    /// Runs whose stated 95 % interval holds the relative error that was found.
    pub held: usize,
    /// Runs that stated a lower bound only.
    pub lower_bounds: usize,
}

/// The statements of `runs`; `None` if none stated anything.
pub(crate) fn stated(runs: &[&Run]) -> Option<Stated> {
    let statements: Vec<_> = runs.iter().filter_map(|run| Some((run.relative_error, run.stated?))).collect();
    let errors: Vec<f64> = statements.iter().map(|(_, stated)| stated.relative_error).collect();
    let high = |found: f64, end: Option<f64>| end.is_none_or(|end| found <= end);
    let holds =
        statements.iter().filter(|(found, s)| *found >= s.relative_error_low && high(*found, s.relative_error_high));
    Some(Stated {
        relative_error: median(&errors)?,
        runs: statements.len(),
        held: holds.count(),
        lower_bounds: statements.iter().filter(|(_, stated)| stated.relative_error_high.is_none()).count(),
    })
}

#[cfg(test)]
mod tests {
    use smalti_measure::ErrorStatement;

    use super::*;
    use crate::fixture;

    fn stating(error: f64, low: f64, high: Option<f64>) -> Run {
        let stated = ErrorStatement {
            relmse: 0.01,
            relmse_low: 0.005,
            relmse_high: high,
            relative_error: 0.1,
            relative_error_low: low,
            relative_error_high: high,
            uncertified_pixels: 0,
        };
        Run { stated: Some(stated), ..fixture::run(0, 0, 1.0, error) }
    }

    #[test]
    fn intervals_hold_what_lies_between_their_ends() {
        let runs = [
            stating(0.1, 0.09, Some(0.11)),
            stating(0.08, 0.09, Some(0.11)),
            stating(0.12, 0.09, Some(0.11)),
            stating(9.0, 0.09, None),
            fixture::run(0, 1, 1.0, 0.1),
        ];
        let found = stated(&runs.iter().collect::<Vec<_>>()).unwrap();
        assert_eq!(found, Stated { relative_error: 0.1, runs: 4, held: 2, lower_bounds: 1 });
    }

    #[test]
    fn silence_is_no_statement() {
        assert_eq!(stated(&[&fixture::run(0, 0, 1.0, 0.1)]), None);
    }
}
