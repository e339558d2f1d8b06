//! Text files as they are: a mark of the byte order before the text, line ends of three kinds, words of any encoding.

/// The bytes behind a UTF-8 byte order mark, if one stands before them.
pub fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Lines that end in `\n`, `\r\n` or `\r`, with their numbers from 1.
#[derive(Clone, Debug)]
pub struct Lines<'t> {
    rest: &'t [u8],
    number: usize,
}

impl<'t> Lines<'t> {
    /// The lines of `text`, of which the first has the number `first`.
    pub fn new(text: &'t [u8], first: usize) -> Self {
        Self { rest: text, number: first }
    }

    /// Everything behind the lines so far.
    pub fn rest(&self) -> &'t [u8] {
        self.rest
    }

    /// The number of the next line.
    pub fn number(&self) -> usize {
        self.number
    }
}

impl<'t> Iterator for Lines<'t> {
    type Item = (usize, &'t [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let length = self.rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(self.rest.len());
        let (line, end) = self.rest.split_at(length);
        self.rest = end.strip_prefix(b"\r\n").unwrap_or(end.get(1..).unwrap_or_default());
        self.number += 1;
        Some((self.number - 1, line))
    }
}

/// The words of a line.
pub fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A word as a number of any kind that Rust reads, `nan` and `inf` among them.
pub fn parse<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A word for a message, cut where it is longer than anyone reads.
pub fn shown(word: &[u8]) -> String {
    String::from_utf8_lossy(&word[..word.len().min(100)]).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways() {
        let lines: Vec<_> = Lines::new(b"a\r\nb\rc\n\nd", 1).collect();
        let expected: [&[u8]; 5] = [b"a", b"b", b"c", b"", b"d"];
        assert_eq!(lines, (1..).zip(expected).collect::<Vec<_>>());
        assert_eq!(Lines::new(b"a\r", 7).collect::<Vec<_>>(), [(7, &b"a"[..])]);
    }

    #[test]
    fn one_mark_is_taken_off() {
        assert_eq!(without_mark("\u{feff}v".as_bytes()), b"v");
        assert_eq!(without_mark(b"v"), b"v");
    }

    #[test]
    fn words_may_be_of_any_bytes() {
        assert_eq!(words(b" a\t\xe9  1").collect::<Vec<_>>(), [&b"a"[..], b"\xe9", b"1"]);
        assert_eq!((parse::<f64>(b"-1e3"), parse::<f64>(b"\xe9"), parse::<i64>(b"1.5")), (Some(-1000.0), None, None));
        assert_eq!(shown(&[b'x'; 1000]).len(), 100);
    }
}
