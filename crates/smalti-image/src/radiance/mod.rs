//! Radiance HDR (RGBE): linear, a byte a channel and an exponent that the three share; about 1 % of the largest channel.

mod header;
mod line;

use image::codecs::hdr::HdrEncoder;
use image::{ImageResult, Rgb};
use smalti_core::film::Image;

use self::header::Header;
use self::line::Rgbe;
use crate::codec::{Broken, check_size};
use crate::{Picture, Provenance};

/// What can be held is rounded to nearest; negative values and NaN become 0, what is too large the largest value.
pub(crate) fn encode(image: &Image, provenance: &Provenance) -> Result<Vec<u8>, Broken> {
    let pixels: Vec<Rgb<f32>> = image.pixels.iter().map(|&pixel| Rgb(representable(pixel))).collect();
    let body =
        encoded(&pixels, image.width as usize, image.height as usize).map_err(|_| "Radiance HDR cannot hold it")?;
    // The encoder knows no header lines but its own: ours follow the first, which says what the file is.
    let first = body.iter().position(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    let lines: String = provenance.named().map(|(name, value)| format!("{name}={value}\n")).collect();
    Ok([&body[..first], lines.as_bytes(), &body[first..]].concat())
}

/// The encoder's bytes. It gives lines of 32768 pixels run lengths, whose marker holds one pixel less: readers are lost.
/// Without run lengths how many pixels a line has stands in the header only.
fn encoded(pixels: &[Rgb<f32>], width: usize, height: usize) -> ImageResult<Vec<u8>> {
    let mut body = Vec::new();
    if width != 1 << 15 {
        HdrEncoder::new(&mut body).encode(pixels, width, height)?;
        return Ok(body);
    }
    HdrEncoder::new(&mut body).encode(pixels, 1, pixels.len())?;
    let flat = body.split_off(body.len() - 4 * pixels.len());
    body.truncate(body.len() - format!("-Y {} +X 1\n", pixels.len()).len());
    Ok([body, format!("-Y {height} +X {width}\n").into_bytes(), flat].concat())
}

/// Radiance of an RGBE file: its pixels divided by the exposure that the header tells.
pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, Broken> {
    let (Header { gain, order, mut notes }, mut rest) = header::read(bytes)?;
    let (width, height) = order.size();
    check_size(width, height, bytes.len())?;
    let mut image = Image::black(width, height);
    let mut line = vec![[0; 4]; order.length as usize];
    for number in 0..order.lines {
        line::read(&mut line, &mut rest)?;
        for (pixel, &value) in (0..).zip(&line) {
            let (x, y) = order.place(number, pixel);
            image.pixels[y as usize * width as usize + x as usize] = radiance(value, gain);
        }
    }
    if gain != [1.0; 3] {
        notes.push(format!("its exposure is divided out: {}", gain.map(|gain| gain.to_string()).join(" ")));
    }
    Ok(Picture { notes, ..image.into() })
}

/// Mantissas are taken as they are, without the half that Radiance adds as its writer cuts off: ours rounds.
fn radiance([mantissas @ .., exponent]: Rgbe, gain: [f64; 3]) -> [f32; 3] {
    if exponent == 0 {
        return [0.0; 3];
    }
    let unit = libm::ldexp(1.0, i32::from(exponent) - 136);
    std::array::from_fn(|c| (f64::from(mantissas[c]) * unit / gain[c]) as f32)
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
        decode(&encode(image, &Provenance::new()).unwrap()).unwrap().image
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
        assert_eq!(decode(&bytes).unwrap(), trip(&sample(9, 2)).into());
    }

    /// A file of the four pixels of a flat image, from the left on top to the right at the bottom.
    fn flat(header: &str, pixels: [Rgbe; 4]) -> Vec<u8> {
        [header.as_bytes(), pixels.as_flattened()].concat()
    }

    const PIXELS: [Rgbe; 4] = [[128, 64, 0, 129], [128, 128, 128, 130], [255, 1, 0, 1], [1, 2, 3, 0]];

    #[test]
    fn reads_what_other_programs_write() {
        // 128 / 256 × 2, and so on; exponent 0 is black whatever the mantissas.
        let small = [255.0 / 256.0, 1.0 / 256.0, 0.0].map(|part: f32| part * (-127.0f32).exp2());
        let expected = [[1.0, 0.5, 0.0], [2.0; 3], small, [0.0; 3]];
        for signature in ["#?RADIANCE", "#?RGBE", "#?AUTOPANO", "#?HDRGEN 1.2", "rpict -vf view room.oct"] {
            let file = flat(&format!("{signature}\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n"), PIXELS);
            let found = decode(&file).unwrap();
            assert_eq!((found.image.width, found.image.pixels.as_slice()), (2, expected.as_slice()), "{signature}");
            assert!(found.notes.is_empty() && found.windows.is_none());
        }
    }

    #[test]
    fn exposure_is_divided_out() {
        let found = decode(&flat("#?RGBE\nEXPOSURE=4\nEXPOSURE=.5\nCOLORCORR=1 2 1\n\n-Y 2 +X 2\n", PIXELS)).unwrap();
        assert_eq!(found.image.pixels[..2], [[0.5, 0.125, 0.0], [1.0, 0.5, 1.0]]);
        assert_eq!(found.notes, ["its exposure is divided out: 2 4 2"]);
    }

    #[test]
    fn an_image_may_stand_on_its_head() {
        let brightest = |line: &str| {
            let found = decode(&flat(&format!("#?RGBE\n\n{line}\n"), PIXELS)).unwrap().image;
            found.pixels.iter().position(|pixel| *pixel == [2.0; 3]).unwrap()
        };
        // The second pixel of the first line.
        let places = ["-Y 2 +X 2", "+Y 2 +X 2", "-Y 2 -X 2", "+X 2 -Y 2", "-X 2 +Y 2"].map(brightest);
        assert_eq!(places, [1, 3, 0, 2, 1]);
        let found = decode(&flat("#?RGBE\n\n+X 4 -Y 1\n", PIXELS)).unwrap().image;
        assert_eq!((found.width, found.height, found.pixels[1]), (4, 1, [2.0; 3]));
    }

    #[test]
    fn lines_of_any_length_are_read_again() {
        for width in [1, 7, 8, 127, 128, 129, 32_767, 32_768, 32_769] {
            let image = sample(width, 2);
            let once = trip(&image);
            assert_eq!((once.width, once.height, &trip(&once)), (width, 2, &once));
        }
    }

    #[test]
    fn broken_files_are_errors() {
        let bytes = encode(&sample(40, 9), &Provenance::new()).unwrap();
        for end in 0..bytes.len() {
            assert!(decode(&bytes[..end]).is_err(), "cut at {end}");
        }
    }
}
