//! PNG: 8-bit sRGB with provenance in text chunks; read back to linear values.

use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, ImageError};
use smalti_core::film::Image;

use crate::codec::{Broken, check_size};
use crate::tone;
use crate::{Picture, Provenance};

/// The image as [`tone_map`](crate::tone_map) shows it, marked as sRGB.
pub(crate) fn encode(image: &Image, provenance: &Provenance, exposure_ev: f32) -> Result<Vec<u8>, Broken> {
    encoded(image, provenance, exposure_ev).map_err(|_| "PNG cannot hold it".into())
}

fn encoded(image: &Image, provenance: &Provenance, exposure_ev: f32) -> Result<Vec<u8>, ::png::EncodingError> {
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
pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, Broken> {
    let decoder = PngDecoder::new(std::io::Cursor::new(bytes)).map_err(fault)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height, bytes.len())?;
    let image = DynamicImage::from_decoder(decoder).map_err(fault)?;
    let notes = is_transparent(&image).then(|| "its transparency is left out".into()).into_iter().collect();
    let pixels = match image {
        deep @ (DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_)) => deep.into_rgb16().pixels().map(|pixel| pixel.0.map(from_srgb16)).collect(),
        shallow => shallow.into_rgb8().pixels().map(|pixel| pixel.0.map(tone::from_srgb)).collect(),
    };
    Ok(Picture { notes, ..Image { width, height, pixels }.into() })
}

/// Whether a pixel is not opaque.
fn is_transparent(image: &DynamicImage) -> bool {
    match image {
        DynamicImage::ImageLumaA8(image) => image.pixels().any(|pixel| pixel.0[1] < u8::MAX),
        DynamicImage::ImageRgba8(image) => image.pixels().any(|pixel| pixel.0[3] < u8::MAX),
        DynamicImage::ImageLumaA16(image) => image.pixels().any(|pixel| pixel.0[1] < u16::MAX),
        DynamicImage::ImageRgba16(image) => image.pixels().any(|pixel| pixel.0[3] < u16::MAX),
        _ => false,
    }
}

/// The library's error in our words.
fn fault(error: ImageError) -> Broken {
    match error {
        ImageError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => "it is cut short".into(),
        ImageError::Limits(_) => "it is too large".into(),
        _ => "it is damaged".into(),
    }
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
        let once = decode(&encode(&sample(9, 5), &provenance(), 0.5).unwrap()).unwrap().image;
        let twice = decode(&encode(&once, &provenance(), 0.0).unwrap()).unwrap().image;
        assert_eq!(once, twice);
    }

    #[test]
    fn values_are_those_of_the_tone_map() {
        for image in [sample(9, 5), extreme()] {
            let read = decode(&encode(&image, &provenance(), 1.0).unwrap()).unwrap().image;
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
        assert_eq!(decode(bytes.get_ref()).unwrap().image.pixels, [[1.0; 3], [expected; 3]]);
    }

    #[test]
    fn transparency_is_named() {
        let notes = |alpha: u8| {
            let image = image::ImageBuffer::<image::Rgba<u8>, _>::from_vec(1, 1, vec![255, 0, 0, alpha]).unwrap();
            let mut bytes = std::io::Cursor::new(Vec::new());
            DynamicImage::from(image).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
            decode(bytes.get_ref()).unwrap().notes
        };
        assert!(notes(255).is_empty());
        assert_eq!(notes(254), ["its transparency is left out"]);
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
