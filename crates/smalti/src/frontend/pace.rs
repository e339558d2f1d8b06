//! How fast it goes, and how long it will go on: a range, as tiles and passes do not all take the same.

use std::collections::VecDeque;
use std::time::Duration;

/// The past over which the pace is judged.
const MEMORY: Duration = Duration::from_secs(20);
/// Two marks are at least this far apart.
const STEP: Duration = Duration::from_millis(250);
/// The pace of what is to come may be this much quicker or slower than that of what was, by the ratio: a quarter into 24
/// renders of seconds, what was left was 3 to 6 % less than foreseen.
const SPREAD: f64 = 1.1;
/// Less than this says nothing.
const LEAST: Duration = Duration::from_millis(500);

/// Work done at several times since the start.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    marks: VecDeque<(Duration, u64)>,
}

impl Pace {
    /// Notes that `done` of the work was done at time `at` after the start.
    pub fn note(&mut self, at: Duration, done: u64) {
        if self.marks.back().is_some_and(|last| at < last.0 + STEP) {
            return;
        }
        self.marks.push_back((at, done));
        while self.marks.front().is_some_and(|first| first.0 + MEMORY < at) {
            self.marks.pop_front();
        }
    }

    /// When the rest of `total` will be done, counted from the time `at`: somewhat before and after what the quickest and the
    /// slowest say of the pace overall, over the last twenty seconds and over the last five. `None` while too little is
    /// known.
    pub fn remaining(&self, total: u64, at: Duration) -> Option<(Duration, Duration)> {
        let &(now, done) = self.marks.back().filter(|last| last.0 >= LEAST)?;
        let recent = self.marks.iter().find(|mark| mark.0 + Duration::from_secs(5) >= now);
        let since = [Some(&(Duration::ZERO, 0)), self.marks.front(), recent];
        let rates = since.into_iter().flatten().filter_map(|mark| rate(*mark, (now, done)));
        let rest = total.saturating_sub(done) as f64;
        let fastest = rates.clone().fold(0.0, f64::max);
        let slowest = rates.fold(f64::INFINITY, f64::min);
        let since_mark = at.saturating_sub(now);
        let time = |rate: f64| Some(Duration::try_from_secs_f64(rest / rate).ok()?.saturating_sub(since_mark));
        Some((time(fastest * SPREAD)?, time(slowest / SPREAD)?))
    }
}

/// Work a second between two marks; `None` when they are too near or nothing was done.
fn rate(from: (Duration, u64), to: (Duration, u64)) -> Option<f64> {
    let time = to.0.saturating_sub(from.0);
    let rate = to.1.saturating_sub(from.1) as f64 / time.as_secs_f64();
    (time >= LEAST && rate > 0.0).then_some(rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(seconds: f64) -> Duration {
        Duration::from_secs_f64(seconds)
    }

    fn pace(done: impl Fn(f64) -> u64, until: u32) -> Pace {
        let mut pace = Pace::default();
        for quarter in 0..=4 * until {
            let at = f64::from(quarter) / 4.0;
            pace.note(seconds(at), done(at));
        }
        pace
    }

    fn assert_near((low, high): (Duration, Duration), expected: (f64, f64)) {
        let off = [low.as_secs_f64() - expected.0, high.as_secs_f64() - expected.1];
        assert!(off.iter().all(|off| off.abs() < 0.01), "{low:?} {high:?} instead of {expected:?}");
    }

    #[test]
    fn a_steady_pace_is_a_narrow_range() {
        let left = pace(|at| (at * 100.0) as u64, 30).remaining(10_000, seconds(30.0)).unwrap();
        assert_near(left, (70.0 / SPREAD, 70.0 * SPREAD));
    }

    #[test]
    fn a_pace_that_halved_is_a_wide_one() {
        // 100 a second for 10 s, then 50 a second for 10 s: 1500 in 20 s, 75 a second overall.
        let slowing = |at: f64| (at.min(10.0) * 100.0 + (at - 10.0).max(0.0) * 50.0) as u64;
        assert_near(pace(slowing, 20).remaining(3000, seconds(20.0)).unwrap(), (20.0 / SPREAD, 30.0 * SPREAD));
    }

    /// Rounds of a second, of which photons take the first 0.6 and 16 samples of 100 pixels the rest: 80 rounds.
    #[test]
    fn photons_between_samples_are_foreseen() {
        let round = |at: f64| 1600.0 * (at.floor() + ((at.fract() - 0.6) / 0.4).max(0.0));
        let (low, high) = pace(|at| round(at) as u64, 20).remaining(80 * 1600, seconds(20.0)).unwrap();
        let middle = (low + high).as_secs_f64() / 2.0;
        assert!((middle / 60.0 - 1.0).abs() < 0.2, "{low:?} {high:?}");
        // The worst moment: photons are on their way.
        let mut late = Pace::default();
        for step in 0..=82 {
            late.note(seconds(f64::from(step) / 4.0), round(f64::from(step) / 4.0) as u64);
        }
        let (low, high) = late.remaining(80 * 1600, seconds(20.5)).unwrap();
        assert!(((low + high).as_secs_f64() / 2.0 / 59.5 - 1.0).abs() < 0.2, "{low:?} {high:?}");
    }

    #[test]
    fn time_goes_on_after_the_last_mark() {
        let left = pace(|at| (at * 100.0) as u64, 30).remaining(10_000, seconds(31.0)).unwrap();
        assert_near(left, (70.0 / SPREAD - 1.0, 70.0 * SPREAD - 1.0));
    }

    #[test]
    fn nothing_is_invented() {
        assert_eq!(Pace::default().remaining(10, seconds(9.0)), None);
        assert_eq!(pace(|_| 0, 9).remaining(10, seconds(9.0)), None);
        let mut early = Pace::default();
        early.note(seconds(0.4), 5);
        assert_eq!(early.remaining(10, seconds(0.4)), None);
    }

    #[test]
    fn what_is_done_takes_no_time() {
        assert_eq!(pace(|at| at as u64, 9).remaining(9, seconds(9.0)), Some((Duration::ZERO, Duration::ZERO)));
    }

    #[test]
    fn long_renders_take_little_memory() {
        assert!(pace(|at| at as u64, 1000).marks.len() <= 82);
    }
}
