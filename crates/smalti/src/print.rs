//! Output: results on stdout, messages on stderr. A reader that has gone away is no error.

use std::io::{ErrorKind, Write};

use console::Style;
use serde::Serialize;
use serde_json::json;
use smalti_scene::{Note, Severity};

use crate::args::When;
use crate::exit::Failure;

/// Applies `--color` to both streams; `auto` leaves the choice to the terminal and NO_COLOR. JSON lines have none.
pub fn use_colour(when: When, json_lines: bool) {
    if when != When::Auto {
        console::set_colors_enabled(when == When::Always);
        console::set_colors_enabled_stderr(when == When::Always);
    }
    if json_lines {
        console::set_colors_enabled_stderr(false);
    }
}

/// Prints a result on stdout.
pub fn result(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::output(format!("cannot write to stdout: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a result on stdout as one JSON object on a line of its own. Numbers that are not finite become null.
pub fn json(value: &impl Serialize) -> Result<(), Failure> {
    result(&(serde_json::to_string(value).map_err(Failure::bug)? + "\n"))
}

/// Prints an account on stdout as was asked for: as JSON, or in words unless it is to be quiet.
pub fn account<T: Serialize>(
    value: &T,
    describe: impl Fn(&T) -> String,
    (as_json, quiet): (bool, bool),
) -> Result<(), Failure> {
    match (as_json, quiet) {
        (true, _) => json(value),
        (false, false) => result(&describe(value)),
        (false, true) => Ok(()),
    }
}

/// Messages on stderr: as text, or as JSON lines beside JSON progress.
#[derive(Clone, Copy, Debug)]
pub struct Messages {
    /// Whether stderr must hold JSON lines only.
    pub json: bool,
}

impl Messages {
    /// Something good to know.
    pub fn note(self, text: &str) {
        self.say("note", Style::new().cyan().bold(), text);
    }

    /// Something that the user should look into.
    pub fn warning(self, text: &str) {
        self.say("warning", Style::new().yellow().bold(), text);
    }

    /// Notes, each once; if it is to be `quiet`, only warnings.
    pub fn notes(self, notes: &[Note], quiet: bool) {
        for Note { severity, text } in notes {
            match severity {
                Severity::Note if quiet => {}
                Severity::Note => self.note(text),
                Severity::Warning => self.warning(text),
            }
        }
    }

    /// Why the command failed.
    pub fn error(self, text: &str) {
        self.say("error", Style::new().red().bold(), text);
    }

    /// Why the command failed, in the failure's own form.
    pub fn failure(self, failure: &Failure) {
        match failure.labelled && !self.json {
            true => write_line(&failure.message),
            false => self.error(&failure.message),
        }
    }

    fn say(self, kind: &str, style: Style, text: &str) {
        match self.json {
            true => write_line(&json!({ "event": kind, "message": text }).to_string()),
            false => write_line(&format!("{}: {text}", style.for_stderr().apply_to(kind))),
        }
    }
}

/// Writes a line to stderr, whole: other threads write there too.
pub fn write_line(line: &str) {
    // Nobody can be told that stderr is gone.
    let _ = std::io::stderr().write_all(format!("{line}\n").as_bytes());
}
