//! When the error of a film is judged, and when it should be small enough.
//!
//! The error of n samples goes with 1 / √n, so that each look says when the next one is worth its time. What the error is
//! at most comes down to it as pixels that were in doubt become certain: their excess, in squares, goes with another 1 / n.

use smalti_core::film::{Film, ROUND};

use crate::goal::{Judgement, Target};

/// Samples a pixel at which the error is judged first.
pub const FIRST_LOOK: u32 = 4 * ROUND;

/// The next look is where the error should be this much below the target, in squares.
const MARGIN: f64 = 1.03;

/// From one look to the next samples grow by these factors, where the error is known and ...
const GROWTH: [f64; 2] = [1.1, 2.0];

/// ... where it is not.
const UNKNOWN: f64 = 1.5;

/// Looks at the error of a film.
pub(crate) struct Looks {
    next: u32,
    wanted: Option<u32>,
}

impl Looks {
    /// Looks at a film with so many samples a pixel.
    pub fn new(from: u32) -> Self {
        Self { next: FIRST_LOOK.max(from), wanted: None }
    }

    /// Samples a pixel at the next look.
    pub fn next(&self) -> u32 {
        self.next
    }

    /// Samples a pixel that the target should take, by the last look; `None` while nobody can say.
    pub fn wanted(&self) -> Option<u32> {
        self.wanted
    }

    /// Asks for the error; if it is too large, says when to ask again.
    pub fn is_reached(&mut self, target: &Target, film: &Film) -> bool {
        let judged = (target.judge)(film);
        if judged.is_some_and(|judged| judged.at_most <= target.error) {
            return true;
        }
        let factor = judged.map(|judged| growth(judged, target.error));
        let step = factor.map_or(UNKNOWN, |factor| factor.clamp(GROWTH[0], GROWTH[1]));
        self.wanted = factor.map(|factor| rounds(f64::from(self.next) * factor.max(step)));
        self.next = rounds(f64::from(self.next) * step);
        false
    }
}

/// By how much samples have to grow for the upper end to come down to `wanted`: the x of
/// (error² + (at_most² − error²) / x) / x = wanted².
fn growth(Judgement { error, at_most }: Judgement, wanted: f64) -> f64 {
    let square = |of: f64| MARGIN * (of / wanted) * (of / wanted);
    let excess = square(at_most) - square(error);
    let half = square(error) / 2.0;
    half + (half * half + excess.max(0.0)).sqrt()
}

/// As many samples, in complete rounds.
fn rounds(samples: f64) -> u32 {
    (samples.min(f64::from(1 << 30)) as u32).next_multiple_of(ROUND)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

    use smalti_core::settings::Rect;

    use super::*;

    /// Looks until an error of 8 % at 64 samples has fallen to 1 %; `noise` is that of the n-th look, the square of the
    /// upper end is `excess` times larger at 64 samples. Each look: its samples, and those that are wanted after it; in
    /// the last line those that it took.
    fn course(excess: f64, noise: impl Fn(u32) -> f64 + Send + Sync) -> (Vec<(u32, Option<u32>)>, u32) {
        let film = Film::new(Rect { x: 0, y: 0, width: 1, height: 1 }, 1);
        let (samples, number) = (AtomicU32::new(0), AtomicU32::new(0));
        let judge = |_: &Film| {
            let fallen = 64.0 / f64::from(samples.load(Relaxed));
            let error = 0.08 * fallen.sqrt() * noise(number.fetch_add(1, Relaxed));
            Some(Judgement { error, at_most: error * (1.0 + excess * fallen).sqrt() })
        };
        let target = Target { error: 0.01, judge: Box::new(judge) };
        let (mut looks, mut course) = (Looks::new(0), Vec::new());
        loop {
            let now = looks.next();
            samples.store(now, Relaxed);
            if looks.is_reached(&target, &film) {
                return (course, now);
            }
            course.push((now, looks.wanted()));
        }
    }

    #[test]
    fn an_error_is_reached_after_few_looks() {
        // 64 times as many are needed, and the margin; whatever is in doubt at 64 samples is hardly any more in the end.
        for (excess, wanted) in [(0.0, 4219u32), (3.0, 4403)] {
            let (looks, end) = course(excess, |_| 1.0);
            assert!((4096..4600).contains(&end) && looks.len() < 8, "{looks:?}");
            // The last step is not made smaller than a tenth.
            let said =
                |look: &(u32, Option<u32>)| look.1.is_some_and(|said| said + 32 > wanted && said <= wanted * 11 / 10);
            assert!(looks.iter().all(said), "{looks:?}");
        }
    }

    /// What the last look in the first quarter of the samples foresees, by what it takes.
    fn foresight(seed: u32) -> f64 {
        let noise = move |look: u32| {
            let random = (seed * 64 + look).wrapping_mul(0x9e37_79b9).wrapping_mul(0x85eb_ca6b) >> 8;
            0.95 + 0.1 * f64::from(random) / f64::from(1 << 24)
        };
        let (looks, end) = course(0.0, noise);
        let last = looks.iter().rev().find(|look| look.0 <= end / 4).unwrap();
        f64::from(last.1.unwrap()) / f64::from(end)
    }

    #[test]
    fn looks_that_are_wrong_by_five_percent_foresee_the_end() {
        let mut ratios: Vec<f64> = (0..200).map(foresight).collect();
        ratios.sort_by(f64::total_cmp);
        assert!((ratios[100] - 1.0).abs() < 0.1, "{}", ratios[100]);
        let near = ratios.iter().filter(|ratio| (0.8..1.2).contains(*ratio)).count();
        assert!(near >= 190, "{near} of 200: {} to {}", ratios[0], ratios[199]);
    }

    #[test]
    fn what_nobody_can_judge_is_not_foreseen() {
        let film = Film::new(Rect { x: 0, y: 0, width: 1, height: 1 }, 1);
        let target = Target { error: 0.01, judge: Box::new(|_| None) };
        let mut looks = Looks::new(0);
        assert!(!looks.is_reached(&target, &film));
        assert_eq!((looks.next(), looks.wanted()), (96, None));
    }
}
