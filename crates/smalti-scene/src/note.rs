//! Notes: what is worth knowing about a scene or a render, and stops neither. Any stage may add one; commands print each
//! once, on stderr, and list all of them under `notes` in their JSON.

use std::fmt;

/// How much a note matters.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Severity {
    /// Good to know; the picture is that of what was written. Printed as `note:`.
    Note,
    /// Perhaps not what was meant. Printed as `warning:`, with `--quiet` too.
    Warning,
}

/// One sentence without a full stop, and how much it matters. It names the file, table or setting that it is about.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Note {
    /// How much it matters.
    pub severity: Severity,
    /// The sentence.
    pub text: String,
}

impl Note {
    /// Something good to know.
    pub fn new(text: impl Into<String>) -> Self {
        Self { severity: Severity::Note, text: text.into() }
    }

    /// Something that is perhaps not meant.
    pub fn warning(text: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, text: text.into() }
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Note => "note",
            Self::Warning => "warning",
        })
    }
}

/// `warning: nothing in the scene emits light`.
impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.severity, self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_reads_with_its_severity() {
        assert_eq!(Note::new("a").to_string(), "note: a");
        assert_eq!(Note::warning("b").to_string(), "warning: b");
    }
}
