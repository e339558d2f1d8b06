//! The course of a render: which pass is next, and whether there is one.
//!
//! A pass is chosen by numbers of samples and by what they say, so that the same course can be taken again; time alone
//! decides how far it is followed.

use std::mem::replace;
use std::time::{Duration, Instant};

use smalti_core::film::{Film, ROUND};

use crate::account::Record;
use crate::allot::{AHEAD, Need, Stage};
use crate::goal::{Goal, Stopped};
use crate::look::Looks;
use crate::pass;

/// Samples a pixel at most where only time or an error ends a render: as many as no render comes to.
pub const MOST_SAMPLES: u32 = 1 << 24;

/// With a deadline a pass takes at most this part of the time that there is.
const PART: f64 = 0.02;

/// What is to be done next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Every tile gets samples until it has so many.
    Until(u32),
    /// Every tile gets so many more, as a round, each of which counts once.
    More(u32),
    /// Every tile gets its rounds of this pass of the stage.
    Visit(u32),
}

/// Where a render stands.
pub(crate) struct Course<'a> {
    goal: &'a Goal<'a>,
    /// Samples a pixel at most.
    spp: u32,
    /// Whether each round has photons of its own.
    photons: bool,
    /// When it began.
    start: Instant,
    /// Samples a pixel in the mean, and the time that tiles took for them, after each pass.
    marks: Vec<(u32, Duration)>,
    /// Time for the photons of a round.
    emission: Duration,
    /// When the error is judged.
    looks: Looks,
    stage: Stage,
    /// Whether less than a round came last: what would come then would be grouped otherwise than if it came at once.
    ends: bool,
}

impl<'a> Course<'a> {
    /// A render to `goal` of at most `spp` samples a pixel, which begins now with `from`.
    pub fn new(goal: &'a Goal<'a>, spp: u32, photons: bool, (from, start): (u32, Instant)) -> Self {
        let marks = vec![(from, Duration::ZERO)];
        let looks = Looks::new(from);
        Self { goal, spp, photons, start, marks, emission: Duration::ZERO, looks, stage: Stage::default(), ends: false }
    }

    /// Samples a pixel so far, in the mean.
    pub fn samples(&self) -> u32 {
        self.marks.last().map_or(0, |mark| mark.0)
    }

    /// The next step; or why there is none.
    pub fn next(&mut self, film: &Film, records: &[Record]) -> Result<Step, Stopped> {
        let done = self.samples();
        if let Some(target) = &self.goal.target
            && done == self.looks.next()
            && self.looks.is_reached(target, film)
        {
            return Err(Stopped::Error);
        }
        let look = self.goal.target.as_ref().map_or(u32::MAX, |_| self.looks.next());
        let longest = pass::next(done, self.spp.min(look), self.photons);
        let longest = longest.ok_or(Stopped::Samples)? - done;
        let fitting = self.fitting(done)?;
        if self.goal.noise.is_none() || done < AHEAD * ROUND {
            return Ok(Step::Until(done + longest.min(fitting)));
        }
        let left = (self.spp - done).min(fitting);
        if left < ROUND {
            return if replace(&mut self.ends, true) { Err(Stopped::Time) } else { Ok(Step::More(left)) };
        }
        let pass = done / ROUND;
        if !self.stage.has(pass) {
            self.stage = Stage::new(pass, &self.needs(film, records));
        }
        Ok(Step::Visit(pass))
    }

    /// Notes what a step took, photons apart.
    pub fn note(&mut self, step: Step, tiles: Duration, emission: Option<Duration>) {
        let (done, so_far) = *self.marks.last().expect("there is a first mark");
        let now = match step {
            Step::Until(until) => until,
            Step::More(more) => done + more,
            Step::Visit(_) => done + ROUND,
        };
        self.marks.push((now, so_far + tiles));
        self.emission = emission.unwrap_or(self.emission);
    }

    /// Rounds that `tile` takes of pass `pass`, and how often each sample counts.
    pub fn rounds(&self, tile: usize, pass: u32) -> (u32, f64) {
        self.stage.rounds(tile, pass)
    }

    /// Samples a pixel that it will come to; `None` while nothing can be foreseen.
    pub fn foreseen(&self) -> Option<u32> {
        let done = self.samples();
        let most = (self.spp < MOST_SAMPLES).then_some(self.spp);
        let wanted = self.looks.wanted().map(|wanted| wanted.max(done));
        [most, wanted, self.in_time(done)].into_iter().flatten().min()
    }

    /// Samples a pixel when the time is up; `None` without a deadline, and before the first sample.
    fn in_time(&self, done: u32) -> Option<u32> {
        let emission = self.emission.as_secs_f64() / f64::from(ROUND);
        let each = self.seconds_a_sample()? + emission;
        Some(done.saturating_add((self.left()? / each) as u32))
    }

    /// Samples a pixel that there is time for, at most [`PART`] of all the time, at least 1. One that takes more than that
    /// part is begun only if it fits as a whole; smaller ones are rounded.
    fn fitting(&self, done: u32) -> Result<u32, Stopped> {
        let Some(left) = self.left() else { return Ok(u32::MAX) };
        // How long a sample takes is not known before the first one.
        let Some(each) = self.seconds_a_sample() else { return Ok(1) };
        let photons = if self.photons && done.is_multiple_of(ROUND) { self.emission.as_secs_f64() } else { 0.0 };
        let all = self.goal.deadline.map_or(0.0, |deadline| seconds_to(self.start, deadline));
        let fitting = (left - photons) / each;
        let fitting = if each > all * PART { fitting.floor() } else { fitting.round() };
        if fitting < 1.0 {
            return Err(Stopped::Time);
        }
        let part = (all * PART / each).max(if self.goal.noise.is_some() { f64::from(ROUND) } else { 1.0 });
        Ok(fitting.min(part) as u32)
    }

    /// Seconds that are left; `None` without a deadline.
    fn left(&self) -> Option<f64> {
        self.goal.deadline.map(|deadline| seconds_to(Instant::now(), deadline))
    }

    /// Seconds that tiles take for a sample a pixel, over the last half of the samples.
    fn seconds_a_sample(&self) -> Option<f64> {
        let &(now, time) = self.marks.last()?;
        let from = self.marks.iter().rev().find(|mark| mark.0 <= now / 2).or(self.marks.first())?;
        (now > from.0).then(|| (time - from.1).as_secs_f64() / f64::from(now - from.0))
    }

    fn needs(&self, film: &Film, records: &[Record]) -> Vec<Need> {
        let noise = self.goal.noise.as_ref().map(|noise| noise(film)).unwrap_or_default();
        let tiles = film.tiles.iter().zip(records).zip(noise);
        tiles.map(|((tile, record), noise)| Need { area: tile.area, noise, cost: record.rays_a_sample(tile) }).collect()
    }
}

/// Seconds from one instant to another; below 0 if it is past.
fn seconds_to(from: Instant, to: Instant) -> f64 {
    match to.checked_duration_since(from) {
        Some(left) => left.as_secs_f64(),
        None => -from.duration_since(to).as_secs_f64(),
    }
}

#[cfg(test)]
mod tests {
    use smalti_core::settings::Rect;

    use super::*;

    fn film() -> Film {
        Film::new(Rect { x: 0, y: 0, width: 1, height: 1 }, 1)
    }

    /// The ends of the passes of a render, and why it stopped.
    fn ends(course: &mut Course) -> (Vec<u32>, Stopped) {
        let mut ends = Vec::new();
        loop {
            match course.next(&film(), &[]) {
                Ok(step) => course.note(step, Duration::from_millis(1), None),
                Err(why) => return (ends, why),
            }
            ends.push(course.samples());
        }
    }

    #[test]
    fn samples_alone_make_the_passes_of_before() {
        let goal = Goal::default();
        let mut course = Course::new(&goal, 100, false, (0, Instant::now()));
        assert_eq!(ends(&mut course), (vec![1, 2, 4, 8, 16, 32, 64, 96, 100], Stopped::Samples));
    }

    #[test]
    fn a_deadline_that_is_past_stops_after_one_sample() {
        let goal = Goal { deadline: Some(Instant::now()), ..Goal::default() };
        let mut course = Course::new(&goal, MOST_SAMPLES, false, (0, Instant::now()));
        assert_eq!(course.foreseen(), None);
        assert_eq!(ends(&mut course), (vec![1], Stopped::Time));
    }

    /// The next step of a render of 10 s of which `left` seconds are left, after `samples` samples a pixel that took `each`
    /// seconds each, and photons that took `emission` seconds a round.
    fn next_in_time(samples: u32, each: f64, emission: Option<f64>, left: f64) -> Result<Step, Stopped> {
        let now = Instant::now();
        let start = now.checked_sub(Duration::from_secs_f64(10.0 - left)).unwrap();
        let goal = Goal { deadline: Some(start + Duration::from_secs(10)), ..Goal::default() };
        let mut course = Course::new(&goal, MOST_SAMPLES, emission.is_some(), (0, start));
        let tiles = Duration::from_secs_f64(f64::from(samples) * each);
        course.note(Step::Until(samples), tiles, emission.map(Duration::from_secs_f64));
        course.next(&film(), &[])
    }

    #[test]
    fn a_sample_that_takes_long_is_begun_only_if_it_fits() {
        assert_eq!(next_in_time(1, 9.9, None, 0.1), Err(Stopped::Time));
        assert_eq!(next_in_time(1, 6.0, None, 4.0), Err(Stopped::Time), "two thirds of one are none");
        assert_eq!(next_in_time(1, 3.0, None, 7.0), Ok(Step::Until(2)));
        assert_eq!(next_in_time(2, 3.0, None, 4.0), Ok(Step::Until(3)), "one and a third are one");
        assert_eq!(next_in_time(100, 0.099, None, 0.098), Ok(Step::Until(101)), "what is short is rounded");
        assert_eq!(next_in_time(100, 0.1, None, 0.01), Err(Stopped::Time));
    }

    #[test]
    fn photons_of_a_round_take_their_part_of_the_time() {
        assert_eq!(next_in_time(16, 0.1, Some(5.0), 4.0), Err(Stopped::Time));
        assert!(matches!(next_in_time(16, 0.1, Some(2.0), 6.0), Ok(Step::Until(17..))));
        // Within a round there are photons already.
        assert!(matches!(next_in_time(15, 0.1, Some(5.0), 4.0), Ok(Step::Until(16))));
    }

    #[test]
    fn passes_are_short_beside_the_time_that_there_is() {
        let start = Instant::now();
        let goal = Goal { deadline: Some(start + Duration::from_secs(1000)), ..Goal::default() };
        let mut course = Course::new(&goal, MOST_SAMPLES, false, (0, start));
        // A second a sample: 2 % of the time are 20 samples, also when the next pass would take 32.
        while course.samples() < 200 {
            let step = course.next(&film(), &[]).unwrap();
            let before = course.samples();
            let Step::Until(until) = step else { panic!("{step:?}") };
            assert!(until - before <= 20);
            course.note(step, Duration::from_secs((until - before).into()), None);
        }
        assert!(course.foreseen().is_some_and(|foreseen| (900..=1300).contains(&foreseen)), "{:?}", course.foreseen());
    }
}
