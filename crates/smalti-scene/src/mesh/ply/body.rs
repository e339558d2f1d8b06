//! The numbers behind the header of a PLY file, row by row: in a text a row is a line, and empty lines are none.

use super::super::text::{Lines, parse, shown};
use super::header::{Encoding, Kind, Number};

/// What is still to be read.
#[derive(Clone, Debug)]
pub struct Body<'b> {
    encoding: Encoding,
    /// In a text, the rest of the row; else everything that is left.
    rest: &'b [u8],
    lines: Lines<'b>,
    /// The line of the row, in a text.
    line: Option<usize>,
}

impl<'b> Body<'b> {
    /// All that follows the header, of which `lines` are left.
    pub fn new(encoding: Encoding, lines: Lines<'b>) -> Self {
        let rest = if encoding == Encoding::Ascii { &[] } else { lines.rest() };
        Self { encoding, rest, lines, line: None }
    }

    /// Goes to the next row. Where there is none, its first number will be missing.
    pub fn begin_row(&mut self) {
        if self.encoding == Encoding::Ascii {
            let row = self.lines.by_ref().find(|(_, line)| !line.trim_ascii().is_empty());
            self.line = Some(row.map_or(self.lines.number(), |(number, _)| number));
            self.rest = row.map_or(&[], |(_, line)| line);
        }
    }

    /// The line of the row, from 1, in a text.
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// Everything behind the last row that was read.
    pub fn behind(&self) -> &'b [u8] {
        if self.encoding == Encoding::Ascii { self.lines.rest() } else { self.rest }
    }

    /// Words of the row that were not read; 0 in a binary file.
    pub fn surplus(&self) -> usize {
        if self.encoding == Encoding::Ascii { super::super::text::words(self.rest).count() } else { 0 }
    }

    /// The next number. What is no number in a text is an error; `nan` and infinities are numbers.
    pub fn number(&mut self, number: Number) -> Result<f64, String> {
        if self.encoding == Encoding::Ascii {
            let word = self.word()?;
            return written(word, number).ok_or_else(|| format!("`{}` is not a number", shown(word)));
        }
        Ok(match number {
            Number::I8 => i8::from_le_bytes(self.bytes()?).into(),
            Number::U8 => u8::from_le_bytes(self.bytes()?).into(),
            Number::I16 => i16::from_le_bytes(self.bytes()?).into(),
            Number::U16 => u16::from_le_bytes(self.bytes()?).into(),
            Number::I32 => i32::from_le_bytes(self.bytes()?).into(),
            Number::U32 => u32::from_le_bytes(self.bytes()?).into(),
            Number::F32 => f32::from_le_bytes(self.bytes()?).into(),
            Number::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    /// The number of a vertex, of whatever type.
    pub fn index(&mut self, number: Number) -> Result<i64, String> {
        let value = self.number(number)?;
        whole(value).ok_or_else(|| format!("`{value}` is not the number of a vertex"))
    }

    /// The length of a list.
    pub fn length(&mut self, number: Number) -> Result<usize, String> {
        let value = self.number(number)?;
        let length = whole(value).and_then(|length| usize::try_from(length).ok());
        length.ok_or_else(|| format!("a list has the length {value}"))
    }

    /// Goes past a property, whatever stands there.
    pub fn skip(&mut self, kind: Kind) -> Result<(), String> {
        let (count, number) = match kind {
            Kind::One(number) => (1, number),
            Kind::List { length, item } => (self.length(length)?, item),
        };
        match self.encoding {
            Encoding::Ascii => (0..count).try_for_each(|_| self.word().map(drop)),
            Encoding::Little | Encoding::Big => self.take(count.saturating_mul(number.bytes())).map(drop),
        }
    }

    fn word(&mut self) -> Result<&'b [u8], String> {
        let start = self.rest.trim_ascii_start();
        let length = start.iter().position(u8::is_ascii_whitespace).unwrap_or(start.len());
        if length == 0 {
            return Err("the row ends too early".to_owned());
        }
        let (word, rest) = start.split_at(length);
        self.rest = rest;
        Ok(word)
    }

    fn take(&mut self, count: usize) -> Result<&'b [u8], String> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or("the file ends too early: is it cut short?")?;
        self.rest = rest;
        Ok(taken)
    }

    /// The bytes of a number, the lowest first.
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        bytes.copy_from_slice(self.take(N)?);
        if self.encoding == Encoding::Big {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

/// A number without a fraction. What PLY's types hold is exact in f64.
fn whole(value: f64) -> Option<i64> {
    (value.fract() == 0.0 && value.abs() <= u32::MAX.into()).then_some(value as i64)
}

/// A number of a text: in the precision that its type has in binary, but whatever its range.
fn written(word: &[u8], number: Number) -> Option<f64> {
    match number {
        Number::F32 => parse::<f32>(word).map(f64::from),
        _ => parse(word),
    }
}
