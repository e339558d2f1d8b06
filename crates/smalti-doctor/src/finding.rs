//! What a check found.

use serde::Serialize;

/// Whether a finding is as it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// As it should be.
    Sound,
    /// Nothing is wrong, but the picture may not be what was meant.
    Warning,
    /// A promise is broken.
    Failed,
}

/// What a check found. The names of the fields are a promise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The check, for example `scale`.
    pub check: &'static str,
    /// What of it, for example `2^-40`; empty where there is but one.
    pub case: String,
    /// Whether it is as it should be.
    pub verdict: Verdict,
    /// The measured figure, in the unit that `says` tells.
    pub figure: Option<f64>,
    /// What there is to say, in words.
    pub says: String,
}

impl Finding {
    /// A finding that is as it should be, or else of this verdict.
    pub(crate) fn new(
        (check, case): (&'static str, impl Into<String>),
        (is_sound, otherwise): (bool, Verdict),
        figure: impl Into<Option<f64>>,
        says: impl Into<String>,
    ) -> Self {
        let verdict = if is_sound { Verdict::Sound } else { otherwise };
        Self { check, case: case.into(), verdict, figure: figure.into(), says: says.into() }
    }
}

/// "1 ray", "2 rays".
pub(crate) fn counted(count: usize, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}
