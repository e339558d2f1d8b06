//! The error that a render states of its image.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use smalti_core::film::{Film, ROUND};
use smalti_measure::ErrorStatement;

/// Samples of each pixel below which nothing can be said of the error.
pub const SAMPLES_NEEDED: u32 = 2 * ROUND;

/// The error of the image that `film` develops into, down-sampled `by` so much; `None` with fewer than
/// [`SAMPLES_NEEDED`].
pub fn of(film: &Film, by: u32) -> Option<ErrorStatement> {
    smalti_measure::error_statement(&film.downsampled(by))
}

/// The workers wait while the error is judged for a display: it may cost a part in so many of the time so far.
const SHARE: u32 = 300;

/// What judging a pixel is taken to cost until it has been measured.
const GUESS: Duration = Duration::from_nanos(250);

/// The relative error of a film of `pixels` pixels, down-sampled `by` so much, that is being rendered from now on; `None`
/// also while it would cost more than a display may.
pub fn live(pixels: usize, by: u32) -> impl Fn(&Film) -> Option<f64> + Send + Sync {
    let begun = Instant::now();
    let cost = Mutex::new(Duration::from_nanos(GUESS.as_nanos() as u64 * pixels as u64));
    move |film| {
        let mut cost = cost.lock().unwrap_or_else(PoisonError::into_inner);
        if begun.elapsed() < *cost * SHARE {
            return None;
        }
        let asked = Instant::now();
        let error = of(film, by)?;
        *cost = asked.elapsed();
        Some(error.relative_error)
    }
}

#[cfg(test)]
mod tests {
    use smalti_core::settings::Rect;

    use super::*;

    fn film(samples: u32) -> Film {
        let mut film = Film::new(Rect { x: 3, y: 5, width: 6, height: 4 }, 4);
        for tile in &mut film.tiles {
            for _ in 0..samples {
                let (batch, round) = (tile.counts.batch(), tile.counts.rounds);
                tile.pixels.iter_mut().for_each(|pixel| pixel.add(batch, 1.0, [1.0 + round as f32; 3]));
                tile.counts.add_plain();
            }
        }
        film
    }

    #[test]
    fn a_film_in_the_making_is_judged_when_that_costs_little() {
        let film = film(SAMPLES_NEEDED);
        assert_eq!(live(1 << 32, 1)(&film), None);
        assert_eq!(live(0, 1)(&film), Some(of(&film, 1).unwrap().relative_error));
    }

    #[test]
    fn enough_samples_make_a_statement() {
        assert!(of(&film(SAMPLES_NEEDED - 1), 1).is_none());
        let error = of(&film(SAMPLES_NEEDED), 1).unwrap();
        assert!(error.relmse_low <= error.relmse && error.relmse > 0.0);
    }
}
