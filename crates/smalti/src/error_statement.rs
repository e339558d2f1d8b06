//! The error that a render states of its image.

use smalti_core::film::{Film, ROUND};
use smalti_measure::ErrorStatement;

/// Samples of each pixel below which nothing can be said of the error.
pub const SAMPLES_NEEDED: u32 = 2 * ROUND;

/// Pixels have samples of their own: they share none with a neighbour.
const SHARED: u32 = 1;

/// The error of the image that `film` develops into; `None` with fewer than [`SAMPLES_NEEDED`].
pub fn of(film: &Film) -> Option<ErrorStatement> {
    smalti_measure::error_statement(&film.estimates()?, film.area.width, SHARED)
}

#[cfg(test)]
mod tests {
    use smalti_core::settings::Rect;

    use super::*;

    fn film(samples: u32) -> Film {
        let mut film = Film::new(Rect { x: 3, y: 5, width: 6, height: 4 }, 4);
        for tile in &mut film.tiles {
            tile.samples = samples;
            for pixel in &mut tile.pixels {
                (0..samples).for_each(|sample| pixel.add(sample, [1.0 + (sample / ROUND) as f32; 3]));
            }
        }
        film
    }

    #[test]
    fn enough_samples_make_a_statement() {
        assert!(of(&film(SAMPLES_NEEDED - 1)).is_none());
        let error = of(&film(SAMPLES_NEEDED)).unwrap();
        assert!(error.relmse_low <= error.relmse && error.relmse > 0.0);
    }
}
