//! Times as they are typed: `90`, `1.5s`, `500ms`, `1m30s`, `1h`.

use crate::parse::parse_finite;

/// Units, the longest first, and their seconds.
const UNITS: [(&str, f64); 5] = [("d", 86_400.0), ("h", 3600.0), ("m", 60.0), ("s", 1.0), ("ms", 1e-3)];

/// What people also write for the units, in the same order.
const OTHER_NAMES: [&[&str]; 5] = [
    &["day", "days"],
    &["hr", "hrs", "hour", "hours"],
    &["min", "mins", "minute", "minutes"],
    &["sec", "secs", "second", "seconds"],
    &["msec", "msecs", "millis", "millisecond", "milliseconds"],
];

/// The longest time in seconds: 31 years. A longer one is a slip.
const LONGEST: f64 = 1e9;

/// Reads a time in seconds, greater than 0: a number alone is in seconds, a number with a unit (`d`, `h`, `m`, `s`,
/// `ms`) in that unit, and several of these, the longer unit first, are added up.
pub fn parse(text: &str) -> Result<f64, String> {
    match seconds(text) {
        Some(seconds) if seconds > LONGEST => Err("a time is at most 1e9 seconds, 31 years".into()),
        Some(seconds) if seconds > 0.0 => Ok(seconds),
        _ => Err(answer(text)),
    }
}

fn seconds(text: &str) -> Option<f64> {
    parse_finite(text).ok().or_else(|| parts(text).and_then(|parts| added_up(&parts)))
}

/// What is expected, and what was perhaps meant.
fn answer(text: &str) -> String {
    let expected = "expected a time greater than 0, for example 500ms, 10s, 1m30s or 1h; a number alone is in seconds";
    let meant = meant(text).filter(|meant| seconds(meant).is_some_and(|seconds| seconds > 0.0));
    meant.map_or(expected.to_owned(), |meant| format!("did you mean '{meant}'? {expected}"))
}

/// Numbers with the letters behind each; `None` where something else stands between them.
fn parts(text: &str) -> Option<Vec<(&str, &str)>> {
    let mut rest = text.trim();
    let mut parts = Vec::new();
    while !rest.is_empty() {
        let (number, behind) = rest.split_at(number_end(rest));
        let behind = behind.trim_start();
        let end = behind.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(behind.len());
        let (unit, behind) = behind.split_at(end);
        if number.is_empty() || (unit.is_empty() && !behind.is_empty()) {
            return None;
        }
        parts.push((number, unit));
        rest = behind.trim_start();
    }
    Some(parts)
}

/// Where the number at the start of `text` ends: digits and a point, and an exponent if digits follow.
fn number_end(text: &str) -> usize {
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let end = digits(text);
    let exponent = text[end..].strip_prefix(['e', 'E']);
    let exponent = exponent.map(|text| text.strip_prefix(['+', '-']).unwrap_or(text));
    match exponent.map(|text| (text, digits(text))) {
        Some((exponent, count)) if count > 0 => text.len() - exponent.len() + count,
        _ => end,
    }
}

/// The sum of parts whose units are the known ones, each shorter than the one before.
fn added_up(parts: &[(&str, &str)]) -> Option<f64> {
    let (mut sum, mut next) = (0.0, 0);
    for (number, unit) in parts {
        let index = UNITS.iter().position(|known| known.0 == *unit).filter(|index| *index >= next)?;
        sum += parse_finite(number).ok()? * UNITS[index].1;
        next = index + 1;
    }
    Some(sum)
}

/// The time that was perhaps meant by another way of writing: other names of units, a comma for the point, capitals,
/// `1:30`, a last unit that is missing, another order.
fn meant(text: &str) -> Option<String> {
    let text = text.trim().to_lowercase().replace(',', ".");
    if text.contains(':') {
        return of_a_clock(&text);
    }
    let mut known: Vec<(usize, &str)> = Vec::new();
    for (number, unit) in parts(&text)? {
        let next = known.last().filter(|_| unit.is_empty()).map(|(before, _)| before + 1);
        known.push((unit_index(unit).or(next)?, number));
    }
    known.sort_by_key(|part| part.0);
    known.iter().map(|(index, number)| Some(format!("{number}{}", UNITS.get(*index)?.0))).collect()
}

/// Minutes and seconds, or hours, minutes and seconds, with colons between them.
fn of_a_clock(text: &str) -> Option<String> {
    let numbers: Vec<&str> = text.split(':').collect();
    match numbers[..] {
        [minutes, seconds] => Some(format!("{minutes}m{seconds}s")),
        [hours, minutes, seconds] => Some(format!("{hours}h{minutes}m{seconds}s")),
        _ => None,
    }
}

fn unit_index(unit: &str) -> Option<usize> {
    let same = |index: &usize| UNITS[*index].0 == unit || OTHER_NAMES[*index].contains(&unit);
    (0..UNITS.len()).find(same)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_numbers_with_units() {
        let times = [
            ("90", 90.0),
            ("0.5", 0.5),
            ("1e3", 1000.0),
            ("10s", 10.0),
            ("1.5s", 1.5),
            ("500ms", 0.5),
            ("1m", 60.0),
            ("1.5h", 5400.0),
            ("2d", 172_800.0),
            ("1m30s", 90.0),
            ("1h 2m 3s 500ms", 3723.5),
            (" 2 m ", 120.0),
            ("1e2ms", 0.1),
            ("0m1s", 1.0),
        ];
        for (text, seconds) in times {
            assert!(parse(text).is_ok_and(|found| (found - seconds).abs() < 1e-9), "{text}: {:?}", parse(text));
        }
    }

    #[test]
    fn other_ways_of_writing_are_answered_with_the_right_one() {
        let pairs = [
            ("10 sec", "10s"),
            ("10S", "10s"),
            ("2 Hours", "2h"),
            ("5min", "5m"),
            ("250 millis", "250ms"),
            ("1,5s", "1.5s"),
            ("1m30", "1m30s"),
            ("1h30", "1h30m"),
            ("30s1m", "1m30s"),
            ("1:30", "1m30s"),
            ("1:02:03", "1h02m03s"),
        ];
        for (typed, meant) in pairs {
            let answer = parse(typed).unwrap_err();
            assert!(answer.contains(&format!("did you mean '{meant}'?")), "{typed}: {answer}");
            assert!(parse(meant).is_ok(), "{meant}");
        }
    }

    #[test]
    fn what_is_no_time_is_answered_with_examples() {
        for wrong in ["", "0", "-1", "0s", "s", "abc", "10x", "1s1s", "1.2.3s", "nan", "inf", "ten s", "1m-3s", "%"] {
            let answer = parse(wrong).unwrap_err();
            assert!(answer.contains("greater than 0, for example 500ms, 10s"), "{wrong}: {answer}");
            assert!(!answer.contains("did you mean"), "{wrong}: {answer}");
        }
    }

    #[test]
    fn no_time_is_longer_than_a_clock_can_count() {
        for long in ["1e10", "1e300", "300000h"] {
            assert!(parse(long).unwrap_err().contains("at most"), "{long}");
        }
        assert_eq!(parse("1e9"), Ok(1e9));
    }
}
