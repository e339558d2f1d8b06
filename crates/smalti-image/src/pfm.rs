//! Portable float map: a text header, then rows of 32-bit floats, the bottom row first.

use smalti_core::film::Image;

use crate::Picture;
use crate::codec::{Broken, check_size};

/// Little-endian RGB with scale -1, every bit kept.
pub(crate) fn encode(image: &Image) -> Vec<u8> {
    let mut bytes = format!("PF\n{} {}\n-1.0\n", image.width, image.height).into_bytes();
    bytes.reserve_exact(image.pixels.len() * 12);
    for row in image.pixels.chunks(image.width as usize).rev() {
        bytes.extend(row.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
    }
    bytes
}

/// Reads `PF` (RGB) and `Pf` (grey) of either byte order; the size of the scale has no agreed meaning and is ignored.
pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, Broken> {
    let ([kind, width, height, scale], data) = header(bytes).ok_or("its header is incomplete")?;
    let channels = match kind {
        "PF" => 3,
        "Pf" => 1,
        other => return Err(format!("it starts with '{}', not PF or Pf", other.escape_default()).into()),
    };
    let (width, height) = (number(width, "width")?, number(height, "height")?);
    let little_endian = number::<f32>(scale, "scale")?.is_sign_negative();
    let pixels = check_size(width, height, data.len())?;
    let expected = pixels.checked_mul(4 * channels).ok_or("it is too large")?;
    // A header with the line ends of Windows has two bytes behind the last word.
    let data = data.strip_prefix(b"\n").filter(|data| data.len() == expected).unwrap_or(data);
    if data.len() != expected {
        return Err(format!("{width} × {height} pixels take {expected} bytes, but {} follow", data.len()).into());
    }
    let row_bytes = width as usize * 4 * channels;
    let value = |b: &[u8]| f32::from_bits(if little_endian { u32_of(b).swap_bytes() } else { u32_of(b) });
    let pixel = |b: &[u8]| std::array::from_fn(|c| value(&b[4 * (c % channels)..][..4]));
    let rows = data.chunks_exact(row_bytes).rev();
    let pixels = rows.flat_map(|row| row.chunks_exact(4 * channels)).map(pixel).collect();
    Ok(Image { width, height, pixels }.into())
}

/// The four words of the header, and what follows the one blank behind the last of them.
fn header(bytes: &[u8]) -> Option<([&str; 4], &[u8])> {
    let mut rest = bytes;
    let mut words = [""; 4];
    for word in &mut words {
        rest = rest.trim_ascii_start();
        let end = rest.iter().position(u8::is_ascii_whitespace)?;
        *word = str::from_utf8(&rest[..end]).ok()?;
        rest = &rest[end..];
    }
    Some((words, &rest[1..]))
}

fn number<T: std::str::FromStr>(word: &str, what: &str) -> Result<T, Broken> {
    word.parse().map_err(|_| format!("its {what} '{}' is no number", word.escape_default()).into())
}

fn u32_of(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0, |value, &byte| value << 8 | u32::from(byte))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::tests::{bits, extreme, sample};

    #[test]
    fn keeps_every_bit() {
        for image in [sample(7, 5), extreme()] {
            assert_eq!(bits(&decode(&encode(&image)).unwrap().image), bits(&image));
        }
    }

    #[test]
    fn bytes_are_those_of_the_format() {
        let image = Image { width: 1, height: 2, pixels: vec![[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]] };
        let zeros = [0; 8];
        let expected = [b"PF\n1 2\n-1.0\n".as_slice(), &[0, 0, 0, 0x40], &zeros, &[0, 0, 0x80, 0x3f], &zeros].concat();
        assert_eq!(encode(&image), expected);
    }

    #[test]
    fn reads_grey_and_big_endian() {
        let mut file = b"Pf 2 1\n1.0\n".to_vec();
        file.extend([1.5f32, -2.0].iter().flat_map(|v| v.to_be_bytes()));
        assert_eq!(decode(&file).unwrap().image.pixels, [[1.5; 3], [-2.0; 3]]);
    }

    #[test]
    fn a_header_may_have_the_line_ends_of_windows() {
        let file = [b"Pf\r\n1 1\r\n-1.0\r\n".as_slice(), &1.5f32.to_le_bytes()].concat();
        assert_eq!(decode(&file).unwrap().image.pixels, [[1.5; 3]]);
        // A value may begin with the byte of a line end.
        let value = f32::from_le_bytes([b'\n', 0, 0, 0x40]);
        let file = [b"Pf\n1 1\n-1.0\n".as_slice(), &value.to_le_bytes()].concat();
        assert_eq!(decode(&file).unwrap().image.pixels, [[value; 3]]);
    }

    #[test]
    fn broken_files_are_errors() {
        let file = encode(&sample(4, 4));
        for end in 0..file.len() {
            assert!(decode(&file[..end]).is_err(), "cut at {end}");
        }
        for text in
            ["PF\n0 4\n-1\n", "PF\n-1 4\n-1\n", "PF\n4294967295 4294967295\n-1\n", "P6\n1 1\n255\nabc", "PF\nx 1\n1\n"]
        {
            assert!(decode(text.as_bytes()).is_err(), "{text:?}");
        }
    }
}
