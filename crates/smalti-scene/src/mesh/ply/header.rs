//! The header of a PLY file: which elements follow, of which properties, and how they are written.

use super::super::soup::{Flaw, MOST};
use super::super::text::{Lines, parse, shown, words};

/// How the numbers behind the header are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// What a property holds for each item of its element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    One(Number),
    List { length: Number, item: Number },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Property {
    pub name: String,
    pub kind: Kind,
}

/// Items of one kind, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
}

impl Number {
    /// Bytes in a binary file.
    pub fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn of(word: &[u8]) -> Result<Self, String> {
        Ok(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return Err(format!("`{}` is not a type of numbers", shown(word))),
        })
    }
}

impl Kind {
    /// Fewest bytes of it: in a text a digit and what separates it from the next.
    fn least_bytes(self, encoding: Encoding) -> u128 {
        match (encoding, self) {
            (Encoding::Ascii, _) => 2,
            (_, Self::One(number) | Self::List { length: number, .. }) => number.bytes() as u128,
        }
    }
}

/// Reads the header, and the lines up to what follows it.
pub fn read<'b>(bytes: &'b [u8]) -> Result<(Header, Lines<'b>), Flaw> {
    let mut lines = Lines::new(bytes, 1);
    let first = lines.next().map(|(_, line)| line.trim_ascii());
    if first != Some(b"ply") {
        return Err(Flaw::at(1, "the first line must be `ply`"));
    }
    let (mut encoding, mut elements) = (None, Vec::new());
    loop {
        let (number, line) = lines.next().ok_or_else(|| Flaw::new("the header has no end: a line `end_header`"))?;
        let words: Vec<&[u8]> = words(line).collect();
        if words == [b"end_header"] {
            break;
        }
        statement(&words, &mut encoding, &mut elements).map_err(|wrong| Flaw::at(number, wrong))?;
    }
    let encoding = encoding.ok_or_else(|| Flaw::new("the header has no line `format`"))?;
    let header = Header { encoding, elements };
    let lines = Lines::new(behind(bytes, &lines), lines.number());
    header.check(lines.rest().len())?;
    Ok((header, lines))
}

/// What follows the header. Where its lines end in `\r` alone, a `\n` behind it is the first byte of a number.
fn behind<'b>(bytes: &'b [u8], lines: &Lines<'b>) -> &'b [u8] {
    let start = bytes.len() - lines.rest().len();
    let alone = bytes.starts_with(b"ply\r") && !bytes.starts_with(b"ply\r\n");
    let taken = alone && bytes[..start].ends_with(b"\r\n");
    &bytes[start - usize::from(taken)..]
}

fn statement(words: &[&[u8]], encoding: &mut Option<Encoding>, elements: &mut Vec<Element>) -> Result<(), String> {
    match words {
        [] | [b"comment" | b"obj_info", ..] => {}
        [b"format", name, ..] => *encoding = Some(format(name)?),
        [b"element", name, count] => {
            let name = shown(name);
            if elements.iter().any(|element| element.name == name) {
                return Err(format!("the element `{name}` stands in the header twice"));
            }
            let count = self::count(count, &name)?;
            elements.push(Element { name, count, properties: Vec::new() });
        }
        [b"property", rest @ ..] => {
            let element = elements.last_mut().ok_or("a property stands before the first element")?;
            element.properties.push(property(rest)?);
        }
        [word, ..] => return Err(format!("`{}` and what follows is not a line of a header", shown(word))),
    }
    Ok(())
}

fn format(name: &[u8]) -> Result<Encoding, String> {
    match name {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::Little),
        b"binary_big_endian" => Ok(Encoding::Big),
        _ => Err(format!("`{}` is no format: `ascii`, `binary_little_endian` or `binary_big_endian`", shown(name))),
    }
}

fn count(word: &[u8], name: &str) -> Result<usize, String> {
    let digits = !word.is_empty() && word.iter().all(u8::is_ascii_digit);
    match parse::<usize>(word) {
        Some(count) if count <= MOST => Ok(count),
        _ if digits => Err(format!("the header promises {} × `{name}`; at most {MOST} can be read", shown(word))),
        _ => Err(format!("`{}` is not a number of `{name}`", shown(word))),
    }
}

fn property(words: &[&[u8]]) -> Result<Property, String> {
    let (kind, name) = match words {
        [b"list", length, item, name] => (Kind::List { length: Number::of(length)?, item: Number::of(item)? }, name),
        [number, name] => (Kind::One(Number::of(number)?), name),
        _ => return Err("a property is `property TYPE NAME` or `property list TYPE TYPE NAME`".to_owned()),
    };
    Ok(Property { name: shown(name), kind })
}

impl Header {
    /// Refuses a header that promises more than the `left` bytes behind it can hold: it would cost memory and time.
    fn check(&self, left: usize) -> Result<(), Flaw> {
        let mut needed = 0;
        for Element { name, count, properties } in &self.elements {
            if properties.is_empty() && *count > 0 {
                return Err(Flaw::new(format!("the element `{name}` has no properties")));
            }
            let each: u128 = properties.iter().map(|property| property.kind.least_bytes(self.encoding)).sum();
            needed += each * *count as u128;
        }
        // The last line of a text may lack its end.
        if needed > left as u128 + u128::from(self.encoding == Encoding::Ascii) {
            let message = format!("the header promises at least {needed} bytes, but {left} follow: is it cut short?");
            return Err(Flaw::new(message));
        }
        Ok(())
    }
}
