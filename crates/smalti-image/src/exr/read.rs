//! Reading OpenEXR: flat images of any sample type, in scan lines or tiles, at their largest resolution.

use std::io::Cursor;

use ::exr::block::UncompressedBlock;
use ::exr::block::lines::LineRef;
use ::exr::block::reader::ChunksReader;
use ::exr::compression::Compression;
use ::exr::error::{Result as ExrResult, UnitResult};
use ::exr::math::Vec2;
use ::exr::meta::attribute::{Chromaticities, IntegerBounds, SampleType};
use ::exr::meta::header::Header;
use ::exr::prelude::f16;
use smalti_core::film::Image;

use super::choice::{Choice, Colour, choose};
use super::refusal;
use crate::Picture;
use crate::codec::{Broken, check_size};
use crate::window::{Window, Windows};

/// The picture in a file, with its windows.
pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, Broken> {
    let reader = ::exr::block::read(Cursor::new(bytes), false).map_err(|_| refusal::reason(bytes))?;
    for header in reader.headers() {
        check_header(header, bytes.len())?;
    }
    let Choice { part, colour, note } = choose(reader.headers())?;
    let header = reader.headers()[part].clone();
    let wanted = |layer: usize, level: Vec2<usize>| layer == part && level == Vec2(0, 0);
    let mut canvas = Canvas::new(&header, colour);
    let read = reader
        .filter_chunks(false, |_, _, block| wanted(block.layer, block.level))
        .and_then(|chunks| chunks.decompress_sequential(false, |_, block| canvas.draw(&block, &header)));
    read.map_err(|_| "its pixels are damaged or cut short")?;
    let image = canvas.finish(weights(&header))?;
    Ok(Picture { image, windows: Some(windows(&header)?), notes: note.into_iter().chain(primaries(&header)).collect() })
}

fn check_header(header: &Header, file_size: usize) -> Result<(), Broken> {
    let Vec2(width, height) = header.layer_size;
    let side = |pixels: usize| u32::try_from(pixels).map_err(|_| "it is too large");
    check_size(side(width)?, side(height)?, file_size)?;
    match header.compression {
        Compression::HTJ2K32 | Compression::HTJ2K256 => Err("its compression (HTJ2K) is not read".into()),
        _ => Ok(()),
    }
}

fn windows(header: &Header) -> Result<Windows, Broken> {
    let data = window(header.data_window())?;
    // Some programs write none.
    let display = window(header.shared_attributes.display_window)?;
    Ok(Windows { data, display: if display.width == 0 || display.height == 0 { data } else { display } })
}

fn window(bounds: IntegerBounds) -> Result<Window, Broken> {
    let side = |pixels: usize| u32::try_from(pixels).map_err(|_| "it is too large");
    let (Vec2(x, y), Vec2(width, height)) = (bounds.position, bounds.size);
    Ok(Window { x, y, width: side(width)?, height: side(height)? })
}

/// Primaries and white of Rec. 709, which are taken where a file tells nothing: x and y of red, green, blue and white.
const REC_709: [f32; 8] = [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290];

fn flat(of: &Chromaticities) -> [f32; 8] {
    let Vec2(rx, ry) = of.red;
    let (Vec2(gx, gy), Vec2(bx, by), Vec2(wx, wy)) = (of.green, of.blue, of.white);
    [rx, ry, gx, gy, bx, by, wx, wy]
}

/// What to say of primaries that are not those of sRGB.
fn primaries(header: &Header) -> Option<String> {
    let found = flat(header.shared_attributes.chromaticities.as_ref()?);
    let usual = found.iter().zip(REC_709).all(|(a, b)| (a - b).abs() < 1e-3);
    let shown = found.map(|value| value.to_string()).join(" ");
    (!usual).then(|| format!("its primaries ({shown}) are not heeded: colours are taken as they are"))
}

/// What red, green and blue are of the luminance: the middle row of the matrix to XYZ that the primaries give.
fn weights(header: &Header) -> [f64; 3] {
    let found = header.shared_attributes.chromaticities.as_ref().map_or(REC_709, flat).map(f64::from);
    let [red, green, blue, white] = [0, 2, 4, 6].map(|i| [found[i], found[i + 1], 1.0 - found[i] - found[i + 1]]);
    // Cramer's rule for the sum of primaries that is white of luminance 1.
    let target = white.map(|value| value / white[1]);
    let whole = determinant(red, green, blue);
    let parts = [determinant(target, green, blue), determinant(red, target, blue), determinant(red, green, target)];
    let [r, g, b] = parts.map(|part| part / whole);
    [r * red[1], g * green[1], b * blue[1]]
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - c[1] * b[2]) - b[0] * (a[1] * c[2] - c[1] * a[2]) + c[0] * (a[1] * b[2] - b[1] * a[2])
}

/// The image while its blocks are decoded.
struct Canvas {
    image: Image,
    colour: Colour,
    /// Values that are in place.
    filled: usize,
}

impl Canvas {
    /// `header` has a size that was checked.
    fn new(header: &Header, colour: Colour) -> Self {
        let Vec2(width, height) = header.layer_size;
        Self { image: Image::black(width as u32, height as u32), colour, filled: 0 }
    }

    fn draw(&mut self, block: &UncompressedBlock, header: &Header) -> UnitResult {
        for line in block.lines(&header.channels) {
            match header.channels.list[line.location.channel].sample_type {
                SampleType::F16 => self.draw_line(line, line.read_samples::<f16>().map(|v| v.map(f16::to_f32)))?,
                SampleType::F32 => self.draw_line(line, line.read_samples::<f32>())?,
                SampleType::U32 => self.draw_line(line, line.read_samples::<u32>().map(|v| v.map(|v| v as f32)))?,
            }
        }
        Ok(())
    }

    fn draw_line(&mut self, line: LineRef, values: impl Iterator<Item = ExrResult<f32>>) -> UnitResult {
        let places = self.colour.channels().map(|channel| channel == line.location.channel);
        if places == [false; 3] {
            return Ok(());
        }
        let Vec2(x, y) = line.location.position;
        let start = y * self.image.width as usize + x;
        for (pixel, value) in self.image.pixels.get_mut(start..).into_iter().flatten().zip(values) {
            let value = value?;
            for (place, _) in pixel.iter_mut().zip(places).filter(|(_, here)| *here) {
                *place = value;
                self.filled += 1;
            }
        }
        Ok(())
    }

    fn finish(self, weights: [f64; 3]) -> Result<Image, Broken> {
        let Self { mut image, colour, filled } = self;
        if filled != 3 * image.pixels.len() {
            return Err("it is incomplete".into());
        }
        if matches!(colour, Colour::Chroma(_)) {
            image.pixels.iter_mut().for_each(|pixel| *pixel = from_chroma(*pixel, weights));
        }
        Ok(image)
    }
}

/// Red, green and blue of luminance Y and chroma (R − Y) / Y, (B − Y) / Y.
fn from_chroma(pixel: [f32; 3], [r, g, b]: [f64; 3]) -> [f32; 3] {
    let [luminance, ry, by] = pixel.map(f64::from);
    let (red, blue) = ((ry + 1.0) * luminance, (by + 1.0) * luminance);
    [red, (luminance - r * red - b * blue) / g, blue].map(|value| value as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_has_no_chroma() {
        assert_eq!(from_chroma([0.5, 0.0, 0.0], [0.25, 0.5, 0.25]), [0.5; 3]);
        // 0.25 × 2 + 0.5 × 1 + 0.25 × 4 = 2
        assert_eq!(from_chroma([2.0, 0.0, 1.0], [0.25, 0.5, 0.25]), [2.0, 1.0, 4.0]);
    }

    #[test]
    fn weights_are_those_that_the_standard_prints() {
        let header = |chromaticities| {
            let channels = [::exr::meta::attribute::ChannelDescription::named("Y", SampleType::F32)];
            let mut header = Header::new("".into(), (1, 1), channels.into_iter().collect());
            header.shared_attributes.chromaticities = chromaticities;
            header
        };
        let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
        assert!(close(weights(&header(None)), [0.2126, 0.7152, 0.0722]));
        let xy = |x: f32, y: f32| Vec2(x, y);
        let rec_2020 = Chromaticities {
            red: xy(0.708, 0.292),
            green: xy(0.17, 0.797),
            blue: xy(0.131, 0.046),
            white: xy(0.3127, 0.329),
        };
        assert!(close(weights(&header(Some(rec_2020))), [0.2627, 0.6780, 0.0593]));
    }
}
