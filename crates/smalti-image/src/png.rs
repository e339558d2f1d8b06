//! PNG: 8-bit sRGB with provenance in text chunks; read back to linear values.

use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder};
use smalti_core::film::Image;

use crate::Provenance;
use crate::file::{Broken, check_size};
use crate::tone;

/// The image as [`tone_map`](crate::tone_map) shows it, marked as sRGB.
pub(crate) fn encode(
    image: &Image,
    provenance: &Provenance,
    exposure_ev: f32,
) -> Result<Vec<u8>, ::png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, image.width, image.height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(::png::Compression::Fast);
    for (name, value) in provenance.named() {
        // tEXt is Latin-1, which readers disagree about outside ASCII.
        match value.is_ascii() {
            true => encoder.add_text_chunk(name, value.to_owned())?,
            false => encoder.add_itxt_chunk(name, value.to_owned())?,
        }
    }
    let gain = tone::gain(exposure_ev);
    let levels: Vec<u8> = image.pixels.as_flattened().iter().map(|value| tone::level(value * gain)).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&levels)?;
    writer.finish()?;
    Ok(bytes)
}

/// Linear values of any PNG, taken as sRGB of 8 or 16 bits; transparency is left out.
pub(crate) fn decode(bytes: &[u8]) -> Result<Image, Broken> {
    let decoder = PngDecoder::new(std::io::Cursor::new(bytes))?;
    let (width, height) = decoder.dimensions();
    check_size(width, height, bytes.len())?;
    let pixels = match DynamicImage::from_decoder(decoder)? {
        deep @ (DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_)) => deep.into_rgb16().pixels().map(|pixel| pixel.0.map(from_srgb16)).collect(),
        shallow => shallow.into_rgb8().pixels().map(|pixel| pixel.0.map(tone::from_srgb)).collect(),
    };
    Ok(Image { width, height, pixels })
}

fn from_srgb16(level: u16) -> f32 {
    tone::srgb_to_linear(f64::from(level) / 65535.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::tests::{extreme, sample};

    fn provenance() -> Provenance {
        let mut provenance = Provenance::new();
        provenance.push("seed", 7);
        provenance.push("scene", "Räume/höhle.toml");
        provenance
    }

    #[test]
    fn a_second_trip_changes_nothing() {
        let once = decode(&encode(&sample(9, 5), &provenance(), 0.5).unwrap()).unwrap();
        let twice = decode(&encode(&once, &provenance(), 0.0).unwrap()).unwrap();
        assert_eq!(once, twice);
    }

    #[test]
    fn values_are_those_of_the_tone_map() {
        for image in [sample(9, 5), extreme()] {
            let read = decode(&encode(&image, &provenance(), 1.0).unwrap()).unwrap();
            let expected: Vec<_> = image.pixels.iter().map(|&p| crate::tone_map(p, 1.0).map(tone::from_srgb)).collect();
            assert_eq!(read.pixels, expected);
        }
    }

    #[test]
    fn carries_provenance_and_says_srgb() {
        let bytes = encode(&sample(2, 2), &provenance(), 0.0).unwrap();
        let reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let info = reader.info();
        assert!(info.srgb.is_some());
        let latin = &info.uncompressed_latin1_text[0];
        assert_eq!((latin.keyword.as_str(), latin.text.as_str()), ("smalti.seed", "7"));
        assert_eq!(info.utf8_text[0].keyword, "smalti.scene");
        assert_eq!(info.utf8_text[0].get_text().unwrap(), "Räume/höhle.toml");
    }

    #[test]
    fn reads_sixteen_bits() {
        let deep = image::ImageBuffer::<image::Luma<u16>, _>::from_vec(2, 1, vec![65535u16, 771]).unwrap();
        let mut bytes = std::io::Cursor::new(Vec::new());
        DynamicImage::from(deep).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        // 771 of 65535 is 3 of 255, on the straight part of the curve.
        let expected = (3.0 / 255.0 / 12.92) as f32;
        assert_eq!(decode(bytes.get_ref()).unwrap().pixels, [[1.0; 3], [expected; 3]]);
    }

    #[test]
    fn broken_files_are_errors() {
        let bytes = encode(&sample(9, 5), &provenance(), 0.0).unwrap();
        let data = bytes.len() - 12; // all but the end mark
        for end in 0..data {
            assert!(decode(&bytes[..end]).is_err(), "cut at {end} of {data}");
        }
    }
}
