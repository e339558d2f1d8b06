//! Numbers as the report prints them: as many digits as mean something.

/// `value` with so many significant digits, as a plain decimal where that is readable: `0.0123`, `1.50`, `1601`, `3.7e-6`.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let rounded = format!("{value:.*e}", digits.saturating_sub(1));
    let Some((_, exponent)) = rounded.split_once('e') else { return rounded };
    let (exponent, nearest) = (exponent.parse().unwrap_or(0), rounded.parse().unwrap_or(value));
    match exponent {
        -4..6 => format!("{nearest:.*}", (digits as i32 - 1 - exponent).max(0) as usize),
        _ => rounded,
    }
}

/// Seconds: `0.0123 s`.
pub(crate) fn seconds(value: f64) -> String {
    significant(value, 3) + " s"
}

/// A share as a percentage: `1.23 %`.
pub(crate) fn percent(share: f64) -> String {
    significant(100.0 * share, 3) + " %"
}

/// How many times as much: `1.7×`.
pub(crate) fn times(ratio: f64) -> String {
    significant(ratio, 2) + "×"
}

/// `1 run`, `2 runs`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_significant_ones() {
        let cases = [
            (0.0, "0"),
            (0.012_345, "0.0123"),
            (1.5, "1.50"),
            (9.999, "10.0"),
            (0.999_9, "1.00"),
            (123.4, "123"),
            (1601.34, "1600"),
            (0.000_123_4, "0.000123"),
            (0.000_012_34, "1.23e-5"),
            (-0.5, "-0.500"),
            (12_345_678.0, "1.23e7"),
        ];
        for (value, expected) in cases {
            assert_eq!(significant(value, 3), expected);
        }
    }

    #[test]
    fn units() {
        assert_eq!((seconds(0.25), percent(0.0375)), ("0.250 s".into(), "3.75 %".into()));
        assert_eq!((times(1.74), times(12.3), times(0.914)), ("1.7×".into(), "12×".into(), "0.91×".into()));
        assert_eq!((counted(1, "run"), counted(3, "run")), ("1 run".into(), "3 runs".into()));
    }
}
