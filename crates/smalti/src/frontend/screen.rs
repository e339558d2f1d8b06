//! The terminal on stderr: a frame is collected and written in one go.
//!
//! A write hides the cursor first and shows it last, and asks the terminal to put the frame on the screen at once
//! (synchronised output). Between two writes the terminal is always in order: no panic and no signal can leave the
//! cursor hidden, so nothing has to be restored.

use std::env;
use std::io::{self, Write, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use console::Term;
use indicatif::TermLike;

/// Whether a frame is on the terminal that later output must not follow on its last line.
static DRAWN: AtomicBool = AtomicBool::new(false);

/// Puts the terminal in order for a process that leaves at once: what follows begins on a line of its own.
pub fn restore() {
    if DRAWN.load(Ordering::Relaxed) {
        let _ = stderr().write_all(b"\x1b[0m\x1b[?25h\x1b[?2026l\n");
    }
}

/// Puts `text`, which is shorter than a line, in the place of the last line.
pub fn put_line(text: &str) {
    DRAWN.store(!text.is_empty(), Ordering::Relaxed);
    let _ = stderr().write_all(format!("\r{text}\x1b[K").as_bytes());
}

/// Something that frames are drawn on.
pub trait Surface: TermLike + Clone + 'static {
    /// Finds out how large it is; width and height stay the same until the next call.
    fn measure(&self) {}
}

/// The terminal on stderr.
#[derive(Clone, Debug, Default)]
pub struct Screen(Arc<Mutex<State>>);

#[derive(Debug, Default)]
struct State {
    width: u16,
    height: u16,
    text: String,
}

impl Screen {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, text: &str) -> io::Result<()> {
        self.state().text += text;
        Ok(())
    }

    fn shift(&self, count: usize, direction: char) -> io::Result<()> {
        if count == 0 { Ok(()) } else { self.push(&format!("\x1b[{count}{direction}")) }
    }
}

impl Surface for Screen {
    fn measure(&self) {
        let (height, width) = Term::stderr().size();
        let columns = env::var("COLUMNS").ok().and_then(|columns| columns.parse::<u16>().ok());
        let narrower = columns.filter(|columns| (1..width).contains(columns));
        let mut state = self.state();
        (state.width, state.height) = (narrower.unwrap_or(width).max(2), height.max(1));
    }
}

impl TermLike for Screen {
    fn width(&self) -> u16 {
        self.state().width
    }

    fn height(&self) -> u16 {
        self.state().height
    }

    fn move_cursor_up(&self, n: usize) -> io::Result<()> {
        self.shift(n, 'A')
    }

    fn move_cursor_down(&self, n: usize) -> io::Result<()> {
        self.shift(n, 'B')
    }

    fn move_cursor_right(&self, n: usize) -> io::Result<()> {
        self.shift(n, 'C')
    }

    fn move_cursor_left(&self, n: usize) -> io::Result<()> {
        self.shift(n, 'D')
    }

    fn write_line(&self, s: &str) -> io::Result<()> {
        self.push(s)?;
        self.push("\n")
    }

    fn write_str(&self, s: &str) -> io::Result<()> {
        self.push(s)
    }

    fn clear_line(&self) -> io::Result<()> {
        self.push("\r\x1b[2K")
    }

    fn flush(&self) -> io::Result<()> {
        let text = std::mem::take(&mut self.state().text);
        if text.is_empty() {
            return Ok(());
        }
        DRAWN.store(!text.ends_with('\n'), Ordering::Relaxed);
        stderr().write_all(format!("\x1b[?2026h\x1b[?25l{text}\x1b[?25h\x1b[?2026l").as_bytes())
    }
}
