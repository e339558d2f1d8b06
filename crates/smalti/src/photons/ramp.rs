//! False colours: one number a pixel becomes a colour that grows lighter with it, for colour-blind readers too.
//!
//! The colours are those of viridis (van der Walt and Smith 2015, public domain), in ten steps.

use smalti_image::from_srgb;

/// Colours from the least to the most, sRGB.
const STEPS: [[u8; 3]; 10] = [
    [68, 1, 84],
    [72, 40, 120],
    [62, 74, 137],
    [49, 104, 142],
    [38, 130, 142],
    [31, 158, 137],
    [53, 183, 121],
    [109, 205, 89],
    [180, 222, 44],
    [253, 231, 37],
];

/// Places on the ramp, and what their colours are called.
pub const NAMES: [(f64, &str); 5] = [(0.0, "violet"), (0.25, "blue"), (0.5, "teal"), (0.75, "green"), (1.0, "yellow")];

/// The linear colour of a place on the ramp in [0, 1]; beyond, that of its ends.
pub fn colour(place: f64) -> [f32; 3] {
    let along = place.clamp(0.0, 1.0) * (STEPS.len() - 1) as f64;
    let step = (along as usize).min(STEPS.len() - 2);
    let part = (along - step as f64) as f32;
    let mix = |channel: usize| {
        let [low, high] = [step, step + 1].map(|step| from_srgb(STEPS[step][channel]));
        low + part * (high - low)
    };
    [mix(0), mix(1), mix(2)]
}

#[cfg(test)]
mod tests {
    use smalti_image::tone_map;

    use super::*;

    fn luminance([r, g, b]: [f32; 3]) -> f32 {
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    #[test]
    fn more_is_lighter() {
        let ramp: Vec<f32> = (0..=1000).map(|k| luminance(colour(f64::from(k) / 1000.0))).collect();
        assert!(ramp.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn the_ends_are_the_first_and_the_last_colour() {
        for (place, step) in [(0.0, 0), (-3.0, 0), (1.0, 9), (7.0, 9), (f64::INFINITY, 9), (4.0 / 9.0, 4)] {
            assert_eq!(tone_map(colour(place), 0.0), STEPS[step], "{place}");
        }
    }

    #[test]
    fn no_colour_is_black() {
        assert!((0..=100).all(|k| luminance(colour(f64::from(k) / 100.0)) > 0.01));
    }
}
