//! The header of a Radiance picture: lines of text up to an empty one, and the resolution line, which says in which
//! order the pixels follow. After Radiance's manual of file formats (G. Ward, `filefmts.pdf`).

use crate::codec::Broken;

/// All of a header that matters for its pixels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    /// What pixels are divided by to be radiance: every EXPOSURE, times the channel's part of every COLORCORR.
    pub gain: [f64; 3],
    /// In which order the pixels follow.
    pub order: Order,
    /// What the header says that is not heeded, in words.
    pub notes: Vec<String>,
}

/// The order of pixels: lines of `length` pixels each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Order {
    /// Lines in the file.
    pub lines: u32,
    /// Pixels of a line.
    pub length: u32,
    /// Lines are columns of the image.
    columns: bool,
    /// The first line is at the right or, of rows, at the bottom.
    lines_back: bool,
    /// The first pixel of a line is at the right or, of columns, at the bottom.
    pixels_back: bool,
}

impl Order {
    /// Columns and rows of the image.
    pub fn size(self) -> (u32, u32) {
        if self.columns { (self.lines, self.length) } else { (self.length, self.lines) }
    }

    /// Column and row of a pixel of a line.
    pub fn place(self, line: u32, pixel: u32) -> (u32, u32) {
        let line = if self.lines_back { self.lines - 1 - line } else { line };
        let pixel = if self.pixels_back { self.length - 1 - pixel } else { pixel };
        if self.columns { (line, pixel) } else { (pixel, line) }
    }

    /// From the resolution line: `-Y 480 +X 640` is rows from the top, each from the left.
    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let [first, lines, second, length] = words[..] else { return None };
        let (first, second) = (axis(first)?, axis(second)?);
        let [lines, length] = [lines, length].map(|number| number.parse().ok());
        let order = Self {
            lines: lines?,
            length: length?,
            columns: first.0 == 'X',
            lines_back: first.1,
            pixels_back: second.1,
        };
        (first.0 != second.0).then_some(order)
    }
}

/// The letter of an axis, and whether it is run through against the order of an image: Y grows upwards.
fn axis(word: &str) -> Option<(char, bool)> {
    match word {
        "+X" => Some(('X', false)),
        "-X" => Some(('X', true)),
        "-Y" => Some(('Y', false)),
        "+Y" => Some(('Y', true)),
        _ => None,
    }
}

/// The header, and the bytes that follow it.
pub(super) fn read(bytes: &[u8]) -> Result<(Header, &[u8]), Broken> {
    let (mut gain, mut notes) = ([1.0; 3], Vec::new());
    let mut rest = bytes;
    loop {
        let line = next_line(&mut rest)?;
        if line.is_empty() {
            break;
        }
        if line.starts_with('#') {
            continue;
        }
        if let Some((name, value)) = line.split_once('=') {
            variable(name.trim(), value.trim(), &mut gain, &mut notes)?;
        }
    }
    let line = next_line(&mut rest)?;
    let unknown = || format!("its resolution line '{}' is none as '-Y 480 +X 640'", shown(&line));
    let order = Order::parse(&line).ok_or_else(unknown)?;
    Ok((Header { gain, order, notes }, rest))
}

fn next_line(rest: &mut &[u8]) -> Result<String, Broken> {
    let end = rest.iter().position(|&byte| byte == b'\n').ok_or("its header is cut short")?;
    let line = String::from_utf8_lossy(&rest[..end]).trim_end_matches('\r').to_owned();
    *rest = &rest[end + 1..];
    Ok(line)
}

/// Heeds a line of the header, or notes that it is not heeded.
fn variable(name: &str, value: &str, gain: &mut [f64; 3], notes: &mut Vec<String>) -> Result<(), Broken> {
    match name {
        "FORMAT" if value != "32-bit_rle_rgbe" => Err(format!("its FORMAT '{}' is not read", shown(value)).into()),
        "EXPOSURE" => factors::<1>(name, value).map(|[by]| gain.iter_mut().for_each(|gain| *gain *= by)),
        "COLORCORR" => factors::<3>(name, value).map(|by| (0..3).for_each(|c| gain[c] *= by[c])),
        "PRIMARIES" | "GAMMA" if !is_usual(name, value) => {
            notes.push(format!("its {name} ({}) is not heeded: colours are taken as they are", shown(value)));
            Ok(())
        }
        _ => Ok(()),
    }
}

fn numbers(value: &str) -> Vec<f64> {
    value.split_ascii_whitespace().map_while(|word| word.parse().ok()).collect()
}

/// Numbers that pixels were multiplied by.
fn factors<const N: usize>(name: &str, value: &str) -> Result<[f64; N], Broken> {
    let found: Option<[f64; N]> = numbers(value).try_into().ok();
    let found = found.filter(|found| found.iter().all(|by| *by > 0.0 && by.is_finite()));
    found.ok_or_else(|| {
        format!("its {name} '{}' must be {N} number{} above 0", shown(value), if N > 1 { "s" } else { "" }).into()
    })
}

/// Whether a value says what is assumed: primaries of Rec. 709, whose white is near D65; no gamma.
fn is_usual(name: &str, value: &str) -> bool {
    const REC_709: [f64; 8] = [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290];
    let usual: &[f64] = if name == "GAMMA" { &[1.0] } else { &REC_709 };
    let found = numbers(value);
    found.len() == usual.len() && found.iter().zip(usual).all(|(a, b)| (a - b).abs() < 1e-3)
}

/// A short piece of what the file says.
fn shown(text: &str) -> String {
    text.chars().take(60).collect::<String>().escape_debug().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(text: &str) -> Result<Header, Broken> {
        read(text.as_bytes()).map(|(header, _)| header)
    }

    #[test]
    fn exposures_and_colour_corrections_multiply() {
        let text =
            "#?RGBE\n# a comment\nEXPOSURE=2\n\tpfilt -1 -e 4\nEXPOSURE= 4.0e+00\nCOLORCORR= 1 2 0.5\n\n-Y 1 +X 1\n";
        assert_eq!(header(text).unwrap().gain, [8.0, 16.0, 4.0]);
        for wrong in ["EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=nan", "EXPOSURE=", "COLORCORR=1 2"] {
            let error = header(&format!("#?RGBE\n{wrong}\n\n-Y 1 +X 1\n")).unwrap_err();
            assert!(error.to_string().contains("above 0"), "{error}");
        }
    }

    #[test]
    fn colours_of_other_kinds_are_named() {
        let error = header("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n").unwrap_err();
        assert_eq!(error.to_string(), "its FORMAT '32-bit_rle_xyze' is not read");
        let primaries = |values: &str| header(&format!("#?RADIANCE\nPRIMARIES={values}\n\n-Y 1 +X 1\n")).unwrap().notes;
        assert!(primaries(".64 .33 .3 .6 .15 .06 .3127 .329").is_empty());
        assert!(primaries(".708 .292 .17 .797 .131 .046 .3127 .329")[0].contains("PRIMARIES (.708"));
        assert_eq!(header("#?RGBE\nGAMMA=2.2\n\n-Y 1 +X 1\n").unwrap().notes.len(), 1);
        assert!(header("#?RGBE\nGAMMA=1\n\n-Y 1 +X 1\n").unwrap().notes.is_empty());
    }

    #[test]
    fn every_orientation_has_its_place() {
        // Two columns, three rows; where the second pixel of the first line and the first of the second line lie.
        for (line, size, second, next) in [
            ("-Y 3 +X 2", (2, 3), (1, 0), (0, 1)),
            ("-Y 3 -X 2", (2, 3), (0, 0), (1, 1)),
            ("+Y 3 +X 2", (2, 3), (1, 2), (0, 1)),
            ("+Y 3 -X 2", (2, 3), (0, 2), (1, 1)),
            ("+X 2 -Y 3", (2, 3), (0, 1), (1, 0)),
            ("-X 2 -Y 3", (2, 3), (1, 1), (0, 0)),
            ("+X 2 +Y 3", (2, 3), (0, 1), (1, 2)),
            ("-X 2 +Y 3", (2, 3), (1, 1), (0, 2)),
        ] {
            let order = Order::parse(line).unwrap();
            assert_eq!((order.size(), order.place(0, 1), order.place(1, 0)), (size, second, next), "{line}");
        }
        for wrong in ["-Y 3 -Y 2", "-Y 3 +X", "-Y x +X 2", "Y 3 X 2", "", "-Y 3 +X 2 1"] {
            assert_eq!(Order::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn lines_may_end_as_on_windows() {
        let (header, rest) = read(b"#?RGBE\r\nEXPOSURE=2\r\n\r\n-Y 1 +X 1\r\nrest").unwrap();
        assert_eq!((header.gain, header.order.size(), rest), ([2.0; 3], (1, 1), b"rest".as_slice()));
    }
}
