//! Shows a render while it happens: live bars with the picture so far, plain lines for a log, or JSON lines.
//!
//! One thread listens to the scheduler's facts and draws a few times a second; the workers never wait for it.
//!
//! ```text
//! let (display, watch) = frontend::start(Mode::choose(typed, quiet, colour), title);
//! let outcome = smalti_scheduler::render(&renderer, film, &pool, &cancel, watch);
//! display.finish();
//! ```

mod bars;
#[cfg(test)]
mod fixture;
mod frame;
mod goal;
mod json;
pub mod numbers;
mod pace;
mod pen;
mod picture;
mod plain;
mod screen;
mod setup;
mod summary;
mod tally;
mod terminal;

use std::io::stderr;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossbeam::channel::{Receiver, RecvTimeoutError, unbounded};
use smalti_scheduler::{Event, Watch};

use crate::args::{ProgressArg, When};
use bars::Bars;
use json::Json;
use plain::Plain;
use tally::Tally;
use terminal::{Palette, Terminal};

pub use goal::Goal;
pub use screen::restore;
pub use setup::{Step, Told, set_up};

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Live bars and the picture so far.
    Bar(Palette),
    /// Plain lines.
    Plain,
    /// One JSON object a line for each fact.
    Json,
    /// Nothing.
    None,
}

impl Mode {
    /// The mode that `--progress`, `--quiet`, `--color` and the terminal come to.
    pub fn choose(typed: ProgressArg, quiet: bool, colour: When) -> Self {
        choose(typed, quiet, colour, &Terminal::of_stderr())
    }

    /// The mode of a command without these flags: nothing where nobody looks on.
    pub fn of_terminal() -> Self {
        let terminal = Terminal::of_stderr();
        if terminal.draws() { Mode::Bar(terminal.palette(When::Auto)) } else { Mode::None }
    }
}

fn choose(typed: ProgressArg, quiet: bool, colour: When, terminal: &Terminal) -> Mode {
    match typed {
        _ if quiet => Mode::None,
        ProgressArg::None => Mode::None,
        ProgressArg::Json => Mode::Json,
        ProgressArg::Auto | ProgressArg::Bar if terminal.draws() => Mode::Bar(terminal.palette(colour)),
        _ => Mode::Plain,
    }
}

/// What is rendered and on what.
#[derive(Clone, Debug)]
pub struct Title {
    /// The scene as typed.
    pub scene: String,
    /// Pixels that are rendered: width and height.
    pub size: (u32, u32),
    /// What ends it.
    pub goal: Goal,
    /// Name of the integrator.
    pub integrator: &'static str,
    /// Worker threads.
    pub threads: usize,
    /// Name of the SIMD level.
    pub level: &'static str,
    /// Time from the start of the process to now: reading, compiling, building.
    pub setup: Duration,
    /// Brightness of the picture so far, stops.
    pub exposure: f32,
    /// Whether the picture so far is one before it is done: false colours are not.
    pub pictures: bool,
}

/// The thread that shows. Whoever drops it without [`Display::finish`] no longer waits for it.
#[derive(Debug)]
pub struct Display(Option<JoinHandle<()>>);

impl Display {
    /// Waits until every fact has been shown. The [`Watch`] must be gone, or this waits for ever.
    pub fn finish(self) {
        if let Some(thread) = self.0 {
            // It shows and does nothing else: if it failed, the picture is still good.
            let _ = thread.join();
        }
    }
}

/// Starts to show; returns what the scheduler needs for it, `None` where nothing is shown. An error estimate can be
/// added to the watch.
pub fn start(mode: Mode, title: Title) -> (Display, Option<Watch>) {
    if mode == Mode::None {
        return (Display(None), None);
    }
    let (sender, events) = unbounded();
    let pictures = title.pictures && matches!(mode, Mode::Bar(_));
    let show = move || match mode {
        Mode::Bar(palette) => run(&events, &mut Bars::on_stderr(title, palette)),
        Mode::Plain => run(&events, &mut Plain::new(title, stderr())),
        Mode::Json => run(&events, &mut Json::new(title, stderr())),
        Mode::None => {}
    };
    match thread::Builder::new().name("frontend".into()).spawn(show) {
        Ok(thread) => (Display(Some(thread)), Some(Watch { pictures, ..Watch::new(sender) })),
        // No thread, no display; the render is what counts.
        Err(_) => (Display(None), None),
    }
}

/// A way of showing. What cannot be written is not shown: nobody could be told.
trait View {
    /// A fact arrived; `tally` has it already.
    fn hear(&mut self, event: &Event, tally: &Tally);
    /// A moment passed.
    fn tick(&mut self, tally: &Tally);
    /// No more facts will come.
    fn end(&mut self, tally: &Tally);
}

/// Time between two looks at the workers: 8 a second.
const PERIOD: Duration = Duration::from_millis(125);
/// The longest time between two looks.
const LONGEST: Duration = Duration::from_secs(1);

/// Time from one look to the next when a look takes `cost`: it may take half a hundredth of what `workers` do meanwhile.
fn period(cost: Duration, workers: usize) -> Duration {
    (cost * 200 / workers.max(1) as u32).clamp(PERIOD, LONGEST)
}

/// Shows `events` until the sender is gone.
fn run(events: &Receiver<Event>, view: &mut impl View) {
    let mut tally = Tally::default();
    let mut due = Instant::now();
    loop {
        match events.recv_deadline(due) {
            Ok(event) => {
                tally.hear(&event);
                view.hear(&event, &tally);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        let now = Instant::now();
        if now >= due {
            tally.look(now);
            view.tick(&tally);
            due = now + period(now.elapsed(), tally.workers.len());
        }
    }
    view.end(&tally);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mode_follows_the_user_then_the_terminal() {
        let terminal = Terminal { attended: true, term: "xterm-256color".into(), ..Terminal::default() };
        let file = Terminal { attended: false, ..terminal.clone() };
        let bar = Mode::Bar(Palette::Indexed);
        let cases = [
            (ProgressArg::Auto, &terminal, bar),
            (ProgressArg::Auto, &file, Mode::Plain),
            (ProgressArg::Bar, &terminal, bar),
            (ProgressArg::Bar, &file, Mode::Plain),
            (ProgressArg::Plain, &terminal, Mode::Plain),
            (ProgressArg::Json, &terminal, Mode::Json),
            (ProgressArg::None, &terminal, Mode::None),
        ];
        for (typed, terminal, expected) in cases {
            assert_eq!(choose(typed, false, When::Auto, terminal), expected, "{typed:?}");
            assert_eq!(choose(typed, true, When::Auto, terminal), Mode::None);
        }
        assert_eq!(choose(ProgressArg::Auto, false, When::Never, &terminal), Mode::Bar(Palette::Mono));
    }

    #[test]
    fn nothing_is_shown_at_no_cost() {
        let (display, watch) = start(Mode::None, fixture::title());
        assert!(watch.is_none());
        display.finish();
    }

    #[test]
    fn looking_costs_half_a_hundredth_at_most() {
        let ms = Duration::from_millis;
        assert_eq!(period(ms(0), 0), ms(125));
        assert_eq!(period(ms(4), 2), ms(400));
        assert_eq!(period(ms(4), 16), ms(125));
        assert_eq!(period(ms(40), 2), ms(1000));
    }

    #[test]
    fn every_fact_is_heard_before_the_end() {
        #[derive(Default)]
        struct Listener {
            heard: usize,
            ended_after: usize,
        }
        impl View for Listener {
            fn hear(&mut self, _: &Event, _: &Tally) {
                self.heard += 1;
            }
            fn tick(&mut self, _: &Tally) {}
            fn end(&mut self, tally: &Tally) {
                assert!(tally.end.is_some());
                self.ended_after = self.heard;
            }
        }
        let (sender, events) = unbounded();
        let mut facts = fixture::first_pass(2);
        facts.push(fixture::finished(false));
        let count = facts.len();
        facts.into_iter().for_each(|fact| sender.send(fact).unwrap());
        drop(sender);
        let mut listener = Listener::default();
        run(&events, &mut listener);
        assert_eq!((listener.heard, listener.ended_after), (count, count));
    }
}
