//! From linear radiance to what a screen shows: exposure, a plain clip to [0, 1] and the sRGB curve.
//!
//! There is no film-like curve on purpose: a value on the screen can be computed by hand from the radiance.

use std::sync::LazyLock;

/// `STEPS[k]` is the lowest linear value that rounds to k + 1 of 255.
static STEPS: LazyLock<[f32; 255]> =
    LazyLock::new(|| std::array::from_fn(|k| srgb_to_linear((k as f64 + 0.5) / 255.0) as f32));

/// The linear values of the 256 sRGB levels.
static LEVELS: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|k| srgb_to_linear(k as f64 / 255.0) as f32));

/// The sRGB pixel (IEC 61966-2-1, 8 bits a channel) of linear radiance, `exposure_ev` stops brighter.
///
/// Each channel is multiplied by 2^`exposure_ev`, clipped to [0, 1], encoded and rounded to the nearest level. Negative
/// values and NaN become 0, +∞ becomes 255.
pub fn tone_map(pixel: [f32; 3], exposure_ev: f32) -> [u8; 3] {
    let gain = gain(exposure_ev);
    pixel.map(|value| level(value * gain))
}

/// The linear value in [0, 1] of an sRGB level of 8 bits; the inverse of [`tone_map`] without exposure.
pub fn from_srgb(level: u8) -> f32 {
    LEVELS[usize::from(level)]
}

/// The factor of `exposure_ev` stops.
pub(crate) fn gain(exposure_ev: f32) -> f32 {
    libm::exp2f(exposure_ev)
}

/// The sRGB level of a linear value: how many steps it has reached.
pub(crate) fn level(value: f32) -> u8 {
    STEPS.partition_point(|&step| value >= step) as u8
}

/// The inverse of the sRGB curve; `encoded` in [0, 1].
pub(crate) fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The curve as the standard prints it, from linear to sRGB.
    fn encode(linear: f64) -> f64 {
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
    }

    #[test]
    fn follows_the_curve_of_the_standard() {
        for i in 0..=100_000 {
            let linear = i as f32 / 100_000.0;
            let exact = 255.0 * encode(f64::from(linear));
            let [level, ..] = tone_map([linear; 3], 0.0);
            assert!((f64::from(level) - exact).abs() <= 0.5001, "{linear}: {level} for {exact}");
        }
    }

    #[test]
    fn every_level_survives_the_round_trip() {
        for k in 0..=255 {
            assert_eq!(tone_map([from_srgb(k); 3], 0.0), [k; 3]);
        }
    }

    #[test]
    fn clips_and_never_shows_garbage() {
        assert_eq!(tone_map([-1.0, f32::NAN, f32::NEG_INFINITY], 0.0), [0; 3]);
        assert_eq!(tone_map([1.0, f32::MAX, f32::INFINITY], 0.0), [255; 3]);
        assert_eq!(tone_map([f32::MAX, 0.0, 1e-45], 200.0), [255, 0, 255]);
        assert_eq!(tone_map([f32::MAX, f32::INFINITY, 1.0], -200.0), [0; 3]);
    }

    #[test]
    fn exposure_counts_stops() {
        assert_eq!(tone_map([0.25; 3], 1.0), tone_map([0.5; 3], 0.0));
        assert_eq!(tone_map([0.25; 3], -2.0), tone_map([0.0625; 3], 0.0));
        assert_eq!(tone_map([0.5; 3], 0.0), [188; 3]);
    }
}
