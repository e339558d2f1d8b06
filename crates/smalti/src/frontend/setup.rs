//! What is shown before a render begins: which file is read and what is built, as soon as that takes long.

use std::fmt::{self, Display, Formatter};
use std::io::{Write, stderr};
use std::thread;
use std::time::{Duration, Instant};

use console::{Term, truncate_str};
use crossbeam::channel::{Receiver, RecvError, RecvTimeoutError, unbounded};
use serde_json::{Value, json};

use super::{Mode, numbers, screen};
use crate::print;

/// Something that may take long.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// A file is read.
    Reading {
        /// As the user would name it.
        file: String,
        /// Its length; 0 where it has none, as a pipe.
        bytes: u64,
    },
    /// A scene is compiled and its tree built.
    Building {
        /// Triangles of its meshes.
        triangles: u64,
    },
}

/// Where a step is told.
pub type Told<'a> = dyn Fn(Step) + Sync + 'a;

/// Nothing is shown of what takes less.
const SOON: Duration = Duration::from_millis(100);

/// The time between two lines of a log.
const BETWEEN_LINES: Duration = Duration::from_secs(1);

impl Display for Step {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Self::Reading { file, .. } => {
                let file: String = file.chars().map(|c| if c.is_control() { '?' } else { c }).collect();
                write!(f, "reading {file}")
            }
            Self::Building { triangles: 0 } => write!(f, "building the scene"),
            Self::Building { triangles } => write!(f, "building the tree of {} triangles", numbers::count(*triangles)),
        }
    }
}

impl Step {
    fn object(&self) -> Value {
        match self {
            Self::Reading { file, bytes } => json!({ "event": "reading", "file": file, "bytes": bytes }),
            Self::Building { triangles } => json!({ "event": "building", "triangles": triangles }),
        }
    }
}

/// Does `work` and shows the steps that it tells of: JSON lines at once, in a log and on a terminal those that last. On a
/// terminal nothing of them is left at the end.
pub fn set_up<T>(mode: Mode, work: impl FnOnce(&Told) -> T) -> T {
    match mode {
        Mode::None => work(&|_| {}),
        Mode::Json => work(&|step| print::write_line(&step.object().to_string())),
        Mode::Plain => beside(|steps| lines(&steps, &mut stderr()), work),
        Mode::Bar(_) => beside(|steps| one_line(&steps), work),
    }
}

/// Does `work` while a thread shows its steps.
fn beside<T>(show: impl FnOnce(Receiver<Step>) + Send, work: impl FnOnce(&Told) -> T) -> T {
    let (sender, steps) = unbounded();
    thread::scope(|scope| {
        // No thread, no display.
        let _ = thread::Builder::new().name("set-up".into()).spawn_scoped(scope, || show(steps));
        let done = work(&|step| {
            let _ = sender.send(step);
        });
        drop(sender);
        done
    })
}

/// The steps as lines of a log.
fn lines(steps: &Receiver<Step>, out: &mut impl Write) {
    lasting(steps, BETWEEN_LINES, |step| {
        let _ = out.write_all(format!("{step}\n").as_bytes());
    });
}

/// The steps in one line of the terminal, which is empty in the end.
fn one_line(steps: &Receiver<Step>) {
    lasting(steps, SOON, |step| {
        let columns = usize::from(Term::stderr().size().1);
        screen::put_line(&truncate_str(&step.to_string(), columns.saturating_sub(1), "…"));
    });
    screen::put_line("");
}

/// Shows the latest step whenever it is due: [`SOON`] after the start, then `between` after the last one.
fn lasting(steps: &Receiver<Step>, between: Duration, mut show: impl FnMut(&Step)) {
    let mut due = Instant::now() + SOON;
    let mut latest: Option<Step> = None;
    loop {
        let heard = match latest {
            Some(_) => steps.recv_deadline(due),
            None => steps.recv().map_err(|RecvError| RecvTimeoutError::Disconnected),
        };
        match heard {
            Ok(step) => latest = Some(step),
            Err(RecvTimeoutError::Timeout) => {
                latest.take().iter().for_each(&mut show);
                due = Instant::now() + between;
            }
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reading(file: &str) -> Step {
        Step::Reading { file: file.into(), bytes: 7 }
    }

    /// What a log has of steps that take so many milliseconds each.
    fn log(steps: &[(Step, u64)]) -> String {
        let (sender, receiver) = unbounded();
        let mut out = Vec::new();
        thread::scope(|scope| {
            scope.spawn(|| lines(&receiver, &mut out));
            for (step, time) in steps {
                sender.send(step.clone()).unwrap();
                thread::sleep(Duration::from_millis(*time));
            }
            drop(sender);
        });
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn what_lasts_is_shown_and_what_does_not_is_not() {
        assert_eq!(log(&[(reading("a.obj"), 0), (reading("b.obj"), 0)]), "");
        assert_eq!(log(&[(reading("a.obj"), 400)]), "reading a.obj\n");
        // Of steps that follow each other fast a log has one now and then.
        let many: Vec<(Step, u64)> = (0..40).map(|number| (reading(&format!("{number}.obj")), 20)).collect();
        assert_eq!(log(&many).lines().count(), 1);
    }

    #[test]
    fn steps_in_words() {
        assert_eq!(reading("a\nb.obj").to_string(), "reading a?b.obj");
        assert_eq!(Step::Building { triangles: 11_760_000 }.to_string(), "building the tree of 11.8 M triangles");
        assert_eq!(Step::Building { triangles: 0 }.to_string(), "building the scene");
    }

    #[test]
    fn steps_for_machines() {
        assert_eq!(reading("a.obj").object(), json!({ "event": "reading", "file": "a.obj", "bytes": 7 }));
        assert_eq!(Step::Building { triangles: 2 }.object(), json!({ "event": "building", "triangles": 2 }));
    }

    #[test]
    fn the_work_is_done_in_every_mode() {
        for mode in [Mode::None, Mode::Plain] {
            let done = set_up(mode, |told| {
                told(Step::Building { triangles: 1 });
                7
            });
            assert_eq!(done, 7);
        }
    }
}
