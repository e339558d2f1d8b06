//! Radiance HDR (RGBE): linear, a byte a channel and an exponent that the three share; about 1 % of the largest channel.

use image::codecs::hdr::{HdrDecoder, HdrEncoder};
use image::{DynamicImage, ImageDecoder, ImageError, Rgb};
use smalti_core::film::Image;

use crate::Provenance;
use crate::file::{Broken, check_size};

/// What can be held is rounded to nearest; negative values and NaN become 0, what is too large the largest value.
pub(crate) fn encode(image: &Image, provenance: &Provenance) -> Result<Vec<u8>, ImageError> {
    let pixels: Vec<Rgb<f32>> = image.pixels.iter().map(|&pixel| Rgb(representable(pixel))).collect();
    let mut body = Vec::new();
    HdrEncoder::new(&mut body).encode(&pixels, image.width as usize, image.height as usize)?;
    // The encoder knows no header lines but its own: ours follow the first, which says what the file is.
    let first = body.iter().position(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    let lines: String = provenance.named().map(|(name, value)| format!("{name}={value}\n")).collect();
    Ok([&body[..first], lines.as_bytes(), &body[first..]].concat())
}

/// Linear values of an HDR file.
pub(crate) fn decode(bytes: &[u8]) -> Result<Image, Broken> {
    let decoder = HdrDecoder::new(bytes)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height, bytes.len())?;
    let pixels = DynamicImage::from_decoder(decoder)?.into_rgb32f();
    Ok(Image { width, height, pixels: pixels.pixels().map(|pixel| pixel.0).collect() })
}

/// The nearest pixel that RGBE holds exactly. (The encoder truncates, and its exponent wraps around.)
fn representable(pixel: [f32; 3]) -> [f32; 3] {
    const LARGEST: f32 = 255.0 / 256.0 * f32::from_bits(254 << 23); // the exponent 2^127
    let clean = pixel.map(|value| if value > 0.0 { value.min(LARGEST) } else { 0.0 });
    let largest = clean[0].max(clean[1]).max(clean[2]);
    if largest < f32::MIN_POSITIVE {
        return [0.0; 3];
    }
    let rounded = round_to(clean, largest);
    // Rounding up may have reached the next power of two, whose steps are twice as wide.
    round_to(rounded, rounded[0].max(rounded[1]).max(rounded[2]))
}

/// Rounds to multiples of 2^-7 of the power of two at or below `largest`, a normal number.
fn round_to(pixel: [f32; 3], largest: f32) -> [f32; 3] {
    let power = f32::from_bits(largest.to_bits() & 0x7f80_0000);
    pixel.map(|value| (value / power * 128.0).round() / 128.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::tests::{extreme, sample};

    fn trip(image: &Image) -> Image {
        decode(&encode(image, &Provenance::new()).unwrap()).unwrap()
    }

    #[test]
    fn stays_within_half_a_step_of_the_largest_channel() {
        let image = sample(40, 9);
        for (read, pixel) in trip(&image).pixels.iter().zip(&image.pixels) {
            let largest = pixel.iter().fold(0.0f32, |a, &b| a.max(b));
            for (a, b) in read.iter().zip(pixel) {
                assert!((a - b.max(0.0)).abs() <= largest / 256.0, "{read:?} for {pixel:?}");
            }
        }
    }

    #[test]
    fn a_second_trip_changes_nothing() {
        let once = trip(&sample(40, 9));
        assert_eq!(trip(&once), once);
    }

    #[test]
    fn extremes_are_not_garbage() {
        let largest = representable([f32::MAX; 3])[0];
        assert!(largest > 1.6e38, "{largest}");
        let image = Image {
            width: 5,
            height: 1,
            pixels: vec![
                [f32::INFINITY, 1.0, 0.0],
                [f32::NAN, 1.0, -1.0],
                [1e-45, 0.0, 0.0],
                [0.999_999_9, 0.5, 0.25],
                [f32::MAX, 0.0, 0.0],
            ],
        };
        let expected = [[largest, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3], [1.0, 0.5, 0.25], [largest, 0.0, 0.0]];
        assert_eq!(trip(&image).pixels, expected);
        assert!(trip(&extreme()).pixels.as_flattened().iter().all(|value| value.is_finite() && *value >= 0.0));
    }

    #[test]
    fn carries_provenance() {
        let mut provenance = Provenance::new();
        provenance.push("seed", 7);
        let bytes = encode(&sample(9, 2), &provenance).unwrap();
        assert!(bytes.starts_with(b"#?RADIANCE\nsmalti.seed=7\n"));
        assert_eq!(decode(&bytes).unwrap(), trip(&sample(9, 2)));
    }

    #[test]
    fn broken_files_are_errors() {
        let bytes = encode(&sample(40, 9), &Provenance::new()).unwrap();
        for end in 0..bytes.len() {
            assert!(decode(&bytes[..end]).is_err(), "cut at {end}");
        }
    }
}
