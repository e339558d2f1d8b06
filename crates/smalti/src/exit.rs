//! How the program ends: statuses, failures and their exit codes.

use std::process::ExitCode;

use smalti_scene::SceneError;

/// How a command ended that did its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// All that was asked.
    Done,
    /// Done, but a check that was asked for failed.
    CheckFailed,
    /// Stopped by this signal; the work so far is kept.
    Interrupted(i32),
}

impl Status {
    /// Of work that stopped early if a signal asked for it, and ended otherwise.
    pub fn of(interrupted: bool, signal: Option<i32>) -> Self {
        signal.filter(|_| interrupted).map_or(Status::Done, Status::Interrupted)
    }

    /// The code for the shell.
    pub fn code(self) -> u8 {
        match self {
            Status::Done => 0,
            Status::CheckFailed => 1,
            Status::Interrupted(signal) => 128u8.saturating_add(signal.unsigned_abs() as u8),
        }
    }
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        ExitCode::from(status.code())
    }
}

/// Why a command could not do its work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Whose fault it is.
    pub blame: Blame,
    /// What is wrong, and what was perhaps meant.
    pub message: String,
    /// Whether the message says `error:` itself, as those with an excerpt of a scene file do.
    pub labelled: bool,
}

/// Whose fault a failure is; the value is the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// Arguments or scene.
    User = 2,
    /// The output could not be written although it looked possible (EX_IOERR).
    Output = 74,
    /// Ours.
    Bug = 101,
}

impl Failure {
    /// The user's mistake.
    pub fn user(message: impl ToString) -> Self {
        Self::unlabelled(Blame::User, message)
    }

    /// A mistake in a scene file, shown with the lines that it is about.
    pub fn scene(error: &SceneError) -> Self {
        let message = error.render(console::colors_enabled_stderr());
        Self { blame: Blame::User, message, labelled: true }
    }

    /// Output that could not be written.
    pub fn output(message: impl ToString) -> Self {
        Self::unlabelled(Blame::Output, message)
    }

    /// A bug in this program.
    pub fn bug(message: impl ToString) -> Self {
        Self::unlabelled(Blame::Bug, message)
    }

    fn unlabelled(blame: Blame, message: impl ToString) -> Self {
        Self { blame, message: message.to_string(), labelled: false }
    }
}

impl From<Blame> for ExitCode {
    fn from(blame: Blame) -> Self {
        ExitCode::from(blame as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_the_documented_ones() {
        assert_eq!(Status::Done.code(), 0);
        assert_eq!(Status::CheckFailed.code(), 1);
        assert_eq!([1, 2, 15].map(|signal| Status::Interrupted(signal).code()), [129, 130, 143]);
        assert_eq!([Blame::User, Blame::Output, Blame::Bug].map(|blame| blame as u8), [2, 74, 101]);
    }
}
