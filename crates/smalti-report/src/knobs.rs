//! Knobs in words: in which two arms differ, and how that is said.

use crate::numbers::{significant, times};
use crate::record::{Arm, Study};
use crate::verdict::{Comparison, Verdict};

/// How values of a knob read: what follows a number (one, several), or what stands before a name.
enum Reading {
    Counted(&'static str, &'static str),
    Named(&'static str),
    Switched(&'static str),
}

/// Knobs by their flags' names; others read as `name value`.
const READINGS: [(&str, Reading); 13] = [
    ("spp", Reading::Counted("sample a pixel", "samples a pixel")),
    ("shadow-rays", Reading::Counted("shadow ray", "shadow rays")),
    ("max-bounces", Reading::Counted("bounce at most", "bounces at most")),
    ("threads", Reading::Counted("thread", "threads")),
    ("photons", Reading::Counted("photon a round", "photons a round")),
    ("integrator", Reading::Named("")),
    ("sampler", Reading::Named("sampler ")),
    ("fresnel", Reading::Named("Fresnel ")),
    ("size", Reading::Named("size ")),
    ("radius", Reading::Named("photon radius ")),
    ("downsample", Reading::Named("down-sampling by ")),
    ("jitter", Reading::Switched("ray noise")),
    ("adaptive", Reading::Switched("adaptive sampling")),
];

/// Names of the knobs in which two arms differ. One that only one of them has (photons, beside an integrator without them)
/// follows from another.
pub(crate) fn differing<'a>(arm: &'a Arm, other: &Arm) -> Vec<&'a str> {
    let differs = |name: &str, value: &String| other.knobs.get(name).is_some_and(|set| set != value);
    arm.knobs.iter().filter(|(name, value)| differs(name, value)).map(|(name, _)| name.as_str()).collect()
}

/// What changed: `20 shadow rays instead of 10`.
pub(crate) fn change(knob: &str, value: &str, other: &str) -> String {
    let reading = READINGS.iter().find(|(name, _)| *name == knob).map(|(_, reading)| reading);
    match reading {
        Some(Reading::Switched(what)) if value == "on" => format!("with {what} instead of without"),
        Some(Reading::Switched(what)) if value == "off" => format!("without {what} instead of with"),
        Some(Reading::Counted(one, _)) if value == "1" => format!("1 {one} instead of {other}"),
        Some(Reading::Counted(_, several)) if value.parse::<f64>().is_ok() => {
            format!("{value} {several} instead of {other}")
        }
        Some(Reading::Named(before)) => format!("{before}{value} instead of {other}"),
        _ => format!("{knob} {value} instead of {other}"),
    }
}

/// The change that a comparison is about.
pub(crate) fn headline(study: &Study, comparison: &Comparison) -> String {
    let value = |arm: usize| study.arms[arm].knobs.get(&comparison.knob).map_or("none", String::as_str);
    change(&comparison.knob, value(comparison.arm), value(comparison.other))
}

/// What it costs and brings: `1.7× the time, 0.90× the error`.
pub(crate) fn price(comparison: &Comparison) -> String {
    let error = match comparison.error {
        Some(error) => format!("{} the error", times(error.median)),
        None => "an error that cannot be told from the reference's".into(),
    };
    format!("{} the time, {error}", times(comparison.seconds.median))
}

/// Whether it is worth it, in words.
pub(crate) fn judgement(comparison: &Comparison) -> String {
    match &comparison.verdict {
        Verdict::Worth => "worth it here".into(),
        Verdict::NotWorth => "not worth it here".into(),
        Verdict::NoDifference => "no difference that these repetitions can show".into(),
        Verdict::Biased(biases) => format!("biased: {}", biases.join("; ")),
        Verdict::OtherSize => "another size of image, which errors of pixels do not weigh".into(),
        Verdict::TooFew => "too few repetitions to tell".into(),
        Verdict::ErrorUnknown => "a better reference is needed to tell".into(),
    }
}

/// The ratio of error² × time with its ends: `1.38× (1.31 to 1.45)`.
pub(crate) fn cost(comparison: &Comparison) -> Option<String> {
    let cost = comparison.cost?;
    Some(format!("{}× ({} to {})", significant(cost.median, 3), significant(cost.low, 3), significant(cost.high, 3)))
}

/// Of which arm it is said, where that is not the baseline with one knob turned.
pub(crate) fn within<'a>(study: &'a Study, comparison: &Comparison) -> Option<&'a str> {
    (study.baseline != Some(comparison.other)).then(|| study.arms[comparison.arm].label.as_str())
}

/// The whole sentence: `20 shadow rays instead of 10: 1.7× the time, 0.90× the error; not worth it here`, with the arm behind
/// it where it is not compared with the baseline.
pub fn sentence(study: &Study, comparison: &Comparison) -> String {
    let within = within(study, comparison).map(|label| format!(" ({label})")).unwrap_or_default();
    format!("{}: {}; {}{within}", headline(study, comparison), price(comparison), judgement(comparison))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::verdict::comparisons;

    #[test]
    fn changes_read_as_one_would_say_them() {
        let cases = [
            ("shadow-rays", "20", "10", "20 shadow rays instead of 10"),
            ("shadow-rays", "1", "10", "1 shadow ray instead of 10"),
            ("spp", "64", "16", "64 samples a pixel instead of 16"),
            ("integrator", "auto", "path", "auto instead of path"),
            ("sampler", "independent", "sobol", "sampler independent instead of sobol"),
            ("jitter", "off", "on", "without ray noise instead of with"),
            ("jitter", "on", "off", "with ray noise instead of without"),
            ("max-bounces", "none", "4", "max-bounces none instead of 4"),
            ("max-bounces", "4", "none", "4 bounces at most instead of none"),
            ("photons", "0", "auto", "0 photons a round instead of auto"),
            ("roulette", "0.5", "1", "roulette 0.5 instead of 1"),
        ];
        for (knob, value, other, expected) in cases {
            assert_eq!(change(knob, value, other), expected);
        }
    }

    #[test]
    fn what_only_one_has_is_no_difference() {
        let [arm, other] = [&[("spp", "4"), ("photons", "9"), ("size", "8x8")][..], &[("spp", "5"), ("size", "8x8")]]
            .map(|knobs| fixture::arm("a", knobs));
        assert_eq!((differing(&arm, &other), differing(&other, &arm)), (vec!["spp"], vec!["spp"]));
        assert!(differing(&arm, &arm).is_empty());
    }

    #[test]
    fn sentences_say_what_follows() {
        let study = fixture::sweep();
        let sentences: Vec<String> = comparisons(&study).iter().map(|found| sentence(&study, found)).collect();
        let expected = [
            "16 samples a pixel instead of 4: 4.0× the time, 0.50× the error; no difference that these repetitions can show",
            "64 samples a pixel instead of 4: 16× the time, 0.25× the error; no difference that these repetitions can show",
            "auto instead of path: 2.0× the time, 0.25× the error; worth it here",
        ];
        assert_eq!(sentences, expected);
    }
}
