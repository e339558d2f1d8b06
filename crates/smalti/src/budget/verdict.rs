//! Whether a render came to what was wanted of it, and in words what it fell short of.

use std::time::Duration;

use smalti_measure::ErrorStatement;
use smalti_scheduler::Stopped;

use super::Budget;
use crate::describe::percent;
use crate::error_statement::SAMPLES_NEEDED;
use crate::frontend::numbers::duration;

/// What a render took until its last sample.
#[derive(Clone, Copy, Debug)]
pub struct Spent {
    /// From the start of the process to the start of the render.
    pub setup: Duration,
    /// The part of the render for photons.
    pub photons: Duration,
    /// From the start of the process to the last sample.
    pub total: Duration,
    /// Samples a pixel, in the mean.
    pub samples: u32,
}

/// What a render is judged by.
#[derive(Clone, Copy, Debug)]
pub struct Came<'a> {
    /// Why it stopped.
    pub stopped: Stopped,
    /// What it took.
    pub spent: Spent,
    /// Its noise; `None` with too few samples.
    pub error: Option<&'a ErrorStatement>,
    /// What its relative error is at most, bias included; `None` while nobody can say.
    pub at_most: Option<f64>,
}

/// The judgement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Whether it came to what was wanted.
    pub reached: bool,
    /// What it fell short of, though nobody stopped it; each a sentence without a full stop.
    pub shortfalls: Vec<String>,
}

/// A render with more than one sample a pixel is late from here on: a busy machine is no news.
const GRACE: Duration = Duration::from_millis(100);

/// Of a time that was exceeded, the parts below this share of it are not worth telling.
const WORTH_TELLING: f64 = 0.05;

impl Budget {
    /// Judges what a render came to.
    pub fn judge(&self, came: &Came) -> Verdict {
        if came.stopped == Stopped::Cancelled {
            return Verdict { reached: false, shortfalls: Vec::new() };
        }
        let late = self.exceeded(&came.spent);
        let reached = late.is_none() && self.is_reached(came);
        Verdict { reached, shortfalls: late.into_iter().chain(self.shortfall(came)).collect() }
    }

    fn is_reached(&self, came: &Came) -> bool {
        match self.error {
            Some(error) => came.at_most.is_some_and(|at_most| at_most <= error),
            None => came.stopped != Stopped::Samples || self.time.is_none(),
        }
    }

    /// By what the time was exceeded, if it was by more than a tenth.
    fn exceeded(&self, spent: &Spent) -> Option<String> {
        let time = self.time?;
        let grace = if spent.samples > 1 { GRACE.max(time / 10) } else { time / 10 };
        let late = spent.total > time.saturating_add(grace);
        late.then(|| format!("the time of {} was too short: {}", duration(time), took(spent)))
    }

    /// What there is to say of an error that was wanted and not reached.
    fn shortfall(&self, came: &Came) -> Option<String> {
        let wanted = self.error.filter(|_| !self.is_reached(came))?;
        let spent = if came.stopped == Stopped::Time { "in --time" } else { "in --spp" };
        let why = match (came.error, came.at_most) {
            (None, _) => format!("too few samples {spent}: it takes {SAMPLES_NEEDED} a pixel to tell the error"),
            (_, Some(at_most)) => format!("too few samples {spent}: the error is at most {}", percent(at_most)),
            (Some(error), None) => unjudged(error),
        };
        Some(format!("the error of {} was not reached: {why}", percent(wanted)))
    }
}

/// Where the time went: `photons took 4.0 s, one sample a pixel 8.0 s`.
fn took(spent: &Spent) -> String {
    let samples = match spent.samples {
        0 | 1 => "one sample a pixel".to_owned(),
        samples => format!("{samples} samples a pixel"),
    };
    let tracing = spent.total.saturating_sub(spent.setup + spent.photons);
    let parts = [("set-up".to_owned(), spent.setup), ("photons".to_owned(), spent.photons), (samples, tracing)];
    let worth_telling = |part: &&(String, Duration)| part.1 > spent.total.mul_f64(WORTH_TELLING);
    let mut told: Vec<_> = parts.iter().filter(worth_telling).map(|(what, time)| (what, duration(*time))).collect();
    let first = told.remove(0);
    let others = told.iter().map(|(what, time)| format!(", {what} {time}"));
    format!("{} took {}", first.0, first.1) + &others.collect::<String>()
}

/// Why nobody can say what an error is at most.
fn unjudged(error: &ErrorStatement) -> String {
    let pixels = match error.uncertified_pixels {
        0 => "there are too few samples".to_owned(),
        1 => "1 pixel is too uncertain to judge".to_owned(),
        pixels => format!("{pixels} pixels are too uncertain to judge"),
    };
    let low = percent(error.relative_error_low);
    format!("{pixels}, so nobody can say what the error is at most; it is at least {low}")
}

#[cfg(test)]
mod tests {
    use super::super::{at_most, fixture::statement};
    use super::*;

    const TIMED: Budget = Budget { time: Some(Duration::from_secs(1)), error: None, spp: None };
    const JUDGED: Budget = Budget { time: None, error: Some(0.01), spp: None };

    /// In time, with many samples.
    const SPENT: Spent =
        Spent { setup: Duration::ZERO, photons: Duration::ZERO, total: Duration::from_secs(1), samples: 64 };

    fn seconds(setup: f64, photons: f64, total: f64, samples: u32) -> Spent {
        let [setup, photons, total] = [setup, photons, total].map(Duration::from_secs_f64);
        Spent { setup, photons, total, samples }
    }

    #[test]
    fn what_was_wanted_is_reached_or_not() {
        let (plain, both) = (Budget::default(), Budget { time: TIMED.time, ..JUDGED });
        let came = |stopped, at_most| Came { stopped, spent: SPENT, error: None, at_most };
        let reached = |budget: &Budget, stopped| budget.judge(&came(stopped, Some(0.02))).reached;
        assert!(reached(&plain, Stopped::Samples) && reached(&TIMED, Stopped::Time));
        assert!(!reached(&plain, Stopped::Cancelled) && !reached(&TIMED, Stopped::Samples));
        for stopped in [Stopped::Samples, Stopped::Time, Stopped::Cancelled] {
            assert!(!reached(&both, stopped) && !both.judge(&came(stopped, None)).reached);
            // Whoever stopped it: an error that is small enough is.
            assert_eq!(both.judge(&came(stopped, Some(0.01))).reached, stopped != Stopped::Cancelled);
        }
    }

    #[test]
    fn shortfalls_say_what_is_missing() {
        let said = |stopped, error: Option<ErrorStatement>| {
            let (error, at_most) = (error.as_ref(), at_most(error.as_ref(), None));
            JUDGED.judge(&Came { stopped, spent: SPENT, error, at_most }).shortfalls.concat()
        };
        let few = "the error of 1.000 % was not reached: too few samples in --time: the error is at most 4.000 %";
        assert_eq!(said(Stopped::Time, Some(statement(Some(0.04), 0))), few);
        let unjudged = said(Stopped::Samples, Some(statement(None, 3)));
        assert!(unjudged.contains("3 pixels are too uncertain to judge, so nobody can say"), "{unjudged}");
        assert!(unjudged.ends_with("at least 2.000 %"), "{unjudged}");
        assert!(said(Stopped::Samples, None).contains("too few samples in --spp: it takes 32"));
        assert_eq!(said(Stopped::Cancelled, None), "");
        assert_eq!(said(Stopped::Samples, Some(statement(Some(0.01), 0))), "");
    }

    #[test]
    fn a_time_that_was_exceeded_is_not_reached_and_where_it_went_is_said() {
        let judged = |spent, stopped| TIMED.judge(&Came { stopped, spent, error: None, at_most: None });
        let cases = [
            (seconds(0.01, 0.0, 8.0, 1), "one sample a pixel took 8.0 s"),
            (seconds(3.0, 0.0, 8.0, 1), "set-up took 3.0 s, one sample a pixel 5.0 s"),
            (seconds(0.1, 4.0, 12.0, 1), "photons took 4.0 s, one sample a pixel 7.9 s"),
            (seconds(7.9, 0.0, 8.0, 1), "set-up took 7.9 s"),
            (seconds(0.0, 0.0, 1.3, 40), "40 samples a pixel took 1.3 s"),
        ];
        for (spent, where_it_went) in cases {
            for stopped in [Stopped::Time, Stopped::Samples] {
                let shortfalls = vec![format!("the time of 1.0 s was too short: {where_it_went}")];
                assert_eq!(judged(spent, stopped), Verdict { reached: false, shortfalls });
            }
            assert_eq!(judged(spent, Stopped::Cancelled).shortfalls, [""; 0]);
        }
    }

    #[test]
    fn a_little_late_is_in_time() {
        let reached = |total, samples| {
            let spent = seconds(0.0, 0.0, total, samples);
            TIMED.judge(&Came { stopped: Stopped::Time, spent, error: None, at_most: None }).reached
        };
        assert!(reached(1.09, 1) && reached(1.09, 2) && !reached(1.11, 1) && !reached(1.11, 2));
        let short = Budget { time: Some(Duration::from_millis(10)), ..TIMED };
        let late = |samples| short.exceeded(&seconds(0.0, 0.0, 0.1, samples)).is_some();
        assert!(late(1) && !late(2), "a machine that is busy for a moment");
    }

    #[test]
    fn time_and_error_that_were_missed_are_both_said() {
        let both = Budget { time: TIMED.time, ..JUDGED };
        let spent = seconds(0.0, 0.0, 8.0, 1);
        let said = both.judge(&Came { stopped: Stopped::Time, spent, error: None, at_most: None }).shortfalls;
        assert!(said.len() == 2 && said[0].contains("the time of") && said[1].contains("the error of"), "{said:?}");
    }
}
