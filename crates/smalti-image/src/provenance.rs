//! Where an image came from: key and value pairs that the program collects and the files carry.

/// An ordered list of (key, value) pairs: version, scene, hash, the command that reproduces the image ...
///
/// Files hold each pair under the name `smalti.KEY`: PNG as a text chunk, EXR as a text attribute, HDR as a header
/// line. PFM has no place for them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Provenance {
    entries: Vec<(&'static str, String)>,
}

impl Provenance {
    /// No entries.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an entry at the end. Control characters in `value` are written as escapes (`\n`, `\u{7}`), since not every
    /// format can hold them.
    ///
    /// # Panics
    /// If `key` is not 1 to 24 characters out of `a-z`, `0-9` and `_`, or is there already.
    pub fn push(&mut self, key: &'static str, value: impl ToString) {
        let allowed = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_';
        assert!((1..=24).contains(&key.len()) && key.bytes().all(allowed), "'{key}' is no key of provenance");
        assert!(self.entries.iter().all(|(taken, _)| *taken != key), "'{key}' is there already");
        self.entries.push((key, printable(&value.to_string())));
    }

    /// The entries in order.
    pub fn entries(&self) -> &[(&'static str, String)] {
        &self.entries
    }

    /// The entries as files name them.
    pub(crate) fn named(&self) -> impl Iterator<Item = (String, &str)> {
        self.entries.iter().map(|(key, value)| (format!("smalti.{key}"), value.as_str()))
    }
}

fn printable(value: &str) -> String {
    let mut text = String::with_capacity(value.len());
    for c in value.chars() {
        match c.is_control() {
            true => text.extend(c.escape_default()),
            false => text.push(c),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_keep_their_order_and_lose_control_characters() {
        let mut provenance = Provenance::new();
        provenance.push("scene", "a\nb\0.toml");
        provenance.push("seed", 7);
        assert_eq!(provenance.entries(), [("scene", "a\\nb\\u{0}.toml".into()), ("seed", "7".into())]);
    }

    #[test]
    #[should_panic(expected = "there already")]
    fn a_key_stands_for_one_value() {
        let mut provenance = Provenance::new();
        provenance.push("seed", 7);
        provenance.push("seed", 8);
    }
}
