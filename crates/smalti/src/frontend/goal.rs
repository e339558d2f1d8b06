//! What ends a render, in words, and how long it will go on.

use std::time::Duration;

use super::numbers;
use super::tally::Tally;

/// What ends a render: the first of these.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goal {
    /// Samples a pixel.
    pub spp: Option<u32>,
    /// From the start of the process.
    pub time: Option<Duration>,
    /// Relative error.
    pub error: Option<f64>,
}

/// How far the samples that an error takes may be from what its last judgement foresees, by the ratio.
const SPREAD: f64 = 0.2;

impl Goal {
    /// A number of samples.
    pub fn samples(spp: u32) -> Self {
        Self { spp: Some(spp), ..Self::default() }
    }

    /// In words: `64 spp`, `until 10 s`, `until 2.0 % or 10 s or 64 spp`.
    pub fn in_words(&self) -> String {
        let spp = self.spp.map(|spp| format!("{spp} spp"));
        let ends = [self.error.map(numbers::share), self.time.map(numbers::duration), spp.clone()];
        match self {
            Self { time: None, error: None, .. } => spp.unwrap_or_default(),
            _ => format!("until {}", ends.into_iter().flatten().collect::<Vec<_>>().join(" or ")),
        }
    }

    /// The least and the most time that is left, `setup` after the start of the process; `None` while nobody can say.
    pub fn left(&self, tally: &Tally, setup: Duration) -> Option<(Duration, Duration)> {
        let deadline = self.time.map(|time| time.saturating_sub(setup + tally.elapsed));
        let work = self.work(tally).and_then(|(least, most)| {
            let (earliest, _) = tally.pace.remaining(least, tally.elapsed)?;
            Some((earliest, tally.pace.remaining(most, tally.elapsed)?.1))
        });
        match (work, deadline) {
            // Without another end the deadline is the end.
            (_, Some(deadline)) if self.error.is_none() && self.spp.is_none() => Some((deadline, deadline)),
            (Some((least, most)), Some(deadline)) => Some((least.min(deadline), most.min(deadline))),
            (work, _) => work,
        }
    }

    /// Samples over all pixels when it is done, the least and the most.
    fn work(&self, tally: &Tally) -> Option<(u64, u64)> {
        let total = tally.total?;
        if self.error.is_none() {
            return Some((total, total));
        }
        let most = self.spp.map_or(u64::MAX, |spp| u64::from(spp) * tally.area.pixels() as u64).max(total);
        let scaled = |factor: f64| (total as f64 * factor) as u64;
        Some((scaled(1.0 - SPREAD).max(tally.done), scaled(1.0 + SPREAD).min(most)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontend::fixture;

    const TIME: Option<Duration> = Some(Duration::from_secs(60));
    const SETUP: Duration = Duration::from_secs(1);

    #[test]
    fn goals_in_words() {
        let goal = |error, time, spp| Goal { spp, time, error }.in_words();
        assert_eq!(goal(None, None, Some(64)), "64 spp");
        assert_eq!(goal(None, Some(Duration::from_secs(10)), None), "until 10 s");
        assert_eq!(goal(Some(0.02), None, None), "until 2.0 %");
        assert_eq!(goal(Some(0.02), Some(Duration::from_secs(10)), Some(64)), "until 2.0 % or 10 s or 64 spp");
    }

    /// At 20 s half is done, 20 s more of the same are left, give or take 10 %, and the process is a second older.
    fn left(goal: Goal) -> (u64, u64) {
        let (least, most) = goal.left(&fixture::half_way(2), SETUP).unwrap();
        (least.as_secs_f64().round() as u64, most.as_secs_f64().round() as u64)
    }

    #[test]
    fn the_time_left_is_that_of_the_first_end() {
        assert_eq!(left(Goal::samples(64)), (18, 22));
        assert_eq!(left(Goal { time: TIME, ..Goal::default() }), (39, 39));
        assert_eq!(left(Goal { time: TIME, ..Goal::samples(64) }), (18, 22));
        // Of 40 s 20 % more or less, and the pace 10 %; but no more than there are samples or there is time.
        let error = Goal { error: Some(0.02), ..Goal::default() };
        assert_eq!(left(error), (11, 31));
        assert_eq!(left(Goal { spp: Some(64), ..error }), (11, 22));
        assert_eq!(left(Goal { time: Some(Duration::from_secs(36)), ..error }), (11, 15));
    }

    #[test]
    fn what_cannot_be_foreseen_is_left_open() {
        let mut tally = fixture::half_way(2);
        tally.total = None;
        assert_eq!(Goal { error: Some(0.02), ..Goal::default() }.left(&tally, SETUP), None);
        let timed = Goal { time: TIME, ..Goal::default() };
        assert_eq!(timed.left(&tally, SETUP), Some((Duration::from_secs(39), Duration::from_secs(39))));
    }
}
