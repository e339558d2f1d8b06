//! Numbers as people read them: durations, ranges, rates, shares and small bars.

use std::time::Duration;

/// A duration in two or three digits: `0.85 ms`, `45 ms`, `1.2 s`, `1 m 05 s`, `2 h 03 m`, `3 d 04 h`.
pub fn duration(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    match seconds {
        ..0.9995 => format!("{} ms", significant(seconds * 1e3)),
        ..9.95 => format!("{seconds:.1} s"),
        ..59.5 => format!("{seconds:.0} s"),
        ..3599.5 => pair(seconds.round() as u64, 60, "m", "s"),
        ..86_370.0 => pair((seconds / 60.0).round() as u64, 60, "h", "m"),
        _ => pair((seconds / 3600.0).round() as u64, 24, "d", "h"),
    }
}

/// `count` small units as large ones and the rest.
fn pair(count: u64, ratio: u64, large: &str, small: &str) -> String {
    format!("{} {large} {:02} {small}", count / ratio, count % ratio)
}

/// A time that lies between `low` and `high`, rounded outward to whole units: `12-15 s`, `3-5 m`, `2-3 h`.
pub fn range(low: Duration, high: Duration) -> String {
    let (unit, name) = match high.as_secs_f64() {
        ..=1.0 => return "1 s".to_owned(),
        ..=120.0 => (1.0, "s"),
        ..=7200.0 => (60.0, "m"),
        ..=172_800.0 => (3600.0, "h"),
        _ => (86_400.0, "d"),
    };
    let (low, high) = ((low.as_secs_f64() / unit).floor(), (high.as_secs_f64() / unit).ceil());
    if low >= high { format!("{high} {name}") } else { format!("{low}-{high} {name}") }
}

/// Rays a second: `12.3 Mrays/s`.
pub fn rays(per_second: f64) -> String {
    format!("{} Mrays/s", significant(per_second / 1e6))
}

/// A large count: `850`, `12.3 k`, `640 M`.
pub fn count(number: u64) -> String {
    let value = number as f64;
    match value {
        ..1e3 => number.to_string(),
        ..999.5e3 => format!("{} k", significant(value / 1e3)),
        ..999.5e6 => format!("{} M", significant(value / 1e6)),
        _ => format!("{} G", significant(value / 1e9)),
    }
}

/// The whole percents that are done: 100 only when all is.
pub fn done(part: u64, whole: u64) -> String {
    format!("{} %", (u128::from(part) * 100).checked_div(u128::from(whole)).unwrap_or(100))
}

/// A share in percent, with a digit more where it is small: `0.43 %`, `2.1 %`, `37 %`.
pub fn share(share: f64) -> String {
    let percent = share * 100.0;
    match percent {
        ..0.995 => format!("{percent:.2} %"),
        ..9.95 => format!("{percent:.1} %"),
        _ => format!("{percent:.0} %"),
    }
}

/// Three significant digits, at most two of them behind the point.
fn significant(value: f64) -> String {
    match value {
        ..9.995 => format!("{value:.2}"),
        ..99.95 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

/// A bar of `width` columns, filled to eighths of a column.
pub fn bar(part: u64, whole: u64, width: usize) -> String {
    const EIGHTHS: [char; 8] = [' ', '▏', '▎', '▍', '▌', '▋', '▊', '▉'];
    let all = 8 * width as u128;
    let filled = (u128::from(part) * all).checked_div(u128::from(whole)).unwrap_or(0).min(all) as usize;
    let edge = (filled < 8 * width).then(|| EIGHTHS[filled % 8]);
    let rest = " ".repeat((width - filled / 8).saturating_sub(1));
    "█".repeat(filled / 8).chars().chain(edge).chain(rest.chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: f64) -> Duration {
        Duration::from_secs_f64(ms / 1e3)
    }

    #[test]
    fn durations_keep_two_or_three_digits() {
        let cases = [
            (0.0, "0.00 ms"),
            (0.853, "0.85 ms"),
            (45.2, "45.2 ms"),
            (451.6, "452 ms"),
            (999.6, "1.0 s"),
            (1234.0, "1.2 s"),
            (9960.0, "10 s"),
            (59_400.0, "59 s"),
            (59_600.0, "1 m 00 s"),
            (65_000.0, "1 m 05 s"),
            (3_599_600.0, "1 h 00 m"),
            (7_380_000.0, "2 h 03 m"),
            (86_399_000.0, "1 d 00 h"),
            (273_600_000.0, "3 d 04 h"),
        ];
        for (input, expected) in cases {
            assert_eq!(duration(ms(input)), expected, "{input} ms");
        }
    }

    #[test]
    fn ranges_are_rounded_outward() {
        let cases = [
            (0.0, 0.3, "1 s"),
            (0.2, 1.5, "0-2 s"),
            (12.4, 14.1, "12-15 s"),
            (12.0, 12.0, "12 s"),
            (100.0, 121.0, "1-3 m"),
            (7000.0, 7300.0, "1-3 h"),
            (1.0, 1e6, "0-12 d"),
        ];
        for (low, high, expected) in cases {
            assert_eq!(range(ms(low * 1e3), ms(high * 1e3)), expected);
        }
    }

    #[test]
    fn rates_counts_and_shares() {
        assert_eq!(rays(12_340_000.0), "12.3 Mrays/s");
        assert_eq!(rays(0.0), "0.00 Mrays/s");
        assert_eq!(
            [999, 1000, 12_345, 999_600, 3_200_000_000].map(count),
            ["999", "1.00 k", "12.3 k", "1.00 M", "3.20 G"]
        );
        assert_eq!([0.00431, 0.0214, 0.0996, 0.374].map(share), ["0.43 %", "2.1 %", "10 %", "37 %"]);
        assert_eq!((done(999, 1000), done(5, 5), done(0, 0)), ("99 %".into(), "100 %".into(), "100 %".into()));
        assert_eq!(done(u64::MAX, u64::MAX), "100 %");
    }

    #[test]
    fn bars_are_exactly_as_wide_as_asked() {
        assert_eq!(bar(0, 8, 3), "   ");
        assert_eq!(bar(1, 2, 3), "█▌ ");
        assert_eq!(bar(9, 8, 3), "███");
        assert_eq!(bar(1, 0, 2), "  ");
        for part in 0..=100 {
            assert_eq!(bar(part, 100, 7).chars().count(), 7, "{part}");
        }
        assert_eq!(bar(1, 2, 0), "");
    }
}
