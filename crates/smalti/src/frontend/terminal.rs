//! What the terminal can do, from what the environment says of it.

use std::env;
use std::io::{IsTerminal, stderr};

use crate::args::When;

/// What is known of the terminal.
#[derive(Clone, Debug, Default)]
pub struct Terminal {
    /// Whether stderr is a terminal at all.
    pub attended: bool,
    /// `TERM`.
    pub term: String,
    /// `COLORTERM`.
    pub colorterm: String,
    /// Whether `NO_COLOR` is set and not empty.
    pub no_color: bool,
}

/// Colours that may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Palette {
    /// None; brightness as characters.
    Mono,
    /// The 256 of xterm.
    Indexed,
    /// All of them.
    True,
}

impl Terminal {
    /// The terminal that stderr is.
    pub fn of_stderr() -> Self {
        let variable = |name| env::var(name).unwrap_or_default();
        Self {
            attended: stderr().is_terminal(),
            term: variable("TERM"),
            colorterm: variable("COLORTERM"),
            no_color: env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty()),
        }
    }

    /// Whether the cursor can be moved.
    pub fn draws(&self) -> bool {
        self.attended && !matches!(self.term.as_str(), "" | "dumb")
    }

    /// The colours to use.
    pub fn palette(&self, colour: When) -> Palette {
        let truly = matches!(self.colorterm.as_str(), "truecolor" | "24bit") || self.term.contains("direct");
        match colour {
            When::Never => Palette::Mono,
            When::Auto if self.no_color => Palette::Mono,
            _ if truly => Palette::True,
            _ if self.term.contains("256") => Palette::Indexed,
            When::Always => Palette::True,
            When::Auto => Palette::Mono,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terminal(term: &str, colorterm: &str) -> Terminal {
        Terminal { attended: true, term: term.into(), colorterm: colorterm.into(), no_color: false }
    }

    #[test]
    fn dumb_terminals_and_files_are_not_drawn_on() {
        assert!(terminal("xterm", "").draws());
        assert!(!terminal("dumb", "").draws());
        assert!(!terminal("", "").draws());
        assert!(!Terminal { attended: false, ..terminal("xterm", "") }.draws());
    }

    #[test]
    fn the_user_decides_then_no_color_then_the_terminal() {
        let rich = terminal("xterm-256color", "truecolor");
        assert_eq!(rich.palette(When::Auto), Palette::True);
        assert_eq!(rich.palette(When::Never), Palette::Mono);
        assert_eq!(terminal("screen-256color", "").palette(When::Auto), Palette::Indexed);
        assert_eq!(terminal("vt100", "").palette(When::Auto), Palette::Mono);
        assert_eq!(terminal("vt100", "").palette(When::Always), Palette::True);
        let no_color = Terminal { no_color: true, ..rich };
        assert_eq!(no_color.palette(When::Auto), Palette::Mono);
        assert_eq!(no_color.palette(When::Always), Palette::True);
    }
}
