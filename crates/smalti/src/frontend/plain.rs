//! Plain lines for a log: one every tenth of the work or every few seconds, whichever comes first.

use std::io::Write;
use std::time::Duration;

use smalti_scheduler::Event;

use super::tally::Tally;
use super::{Title, View, frame, summary};

/// The longest silence.
const SILENCE: Duration = Duration::from_secs(5);
/// Long enough for every field of a line.
const COLUMNS: usize = 200;

/// Lines on `out`.
pub struct Plain<W> {
    title: Title,
    out: W,
    cadence: Cadence,
}

/// When the last line was, in time and in tenths of the work.
#[derive(Clone, Copy, Debug, Default)]
struct Cadence {
    at: Duration,
    tenths: u64,
}

impl Cadence {
    /// Whether a line is due.
    fn due(&mut self, at: Duration, done: u64, total: u64) -> bool {
        let tenths = (u128::from(done) * 10).checked_div(u128::from(total)).unwrap_or(0) as u64;
        let due = tenths > self.tenths || at >= self.at + SILENCE;
        if due {
            *self = Self { at, tenths };
        }
        due
    }
}

impl<W: Write> Plain<W> {
    /// Lines on `out`.
    pub fn new(title: Title, out: W) -> Self {
        Self { title, out, cadence: Cadence::default() }
    }

    fn say(&mut self, line: &str) {
        let _ = self.out.write_all(format!("{line}\n").as_bytes());
    }
}

impl<W: Write> View for Plain<W> {
    fn hear(&mut self, event: &Event, _: &Tally) {
        match event {
            Event::Started { .. } => self.say(&frame::heading(&self.title)),
            // Every round has its own; the first tells what they are like.
            Event::PhotonsStored { round: 0, photons } => self.say(&frame::photons(photons)),
            _ => {}
        }
    }

    fn tick(&mut self, tally: &Tally) {
        // The summary tells of the end.
        if tally.total.is_none_or(|total| tally.done < total)
            && self.cadence.due(tally.elapsed, tally.done, tally.total.unwrap_or(u64::MAX))
        {
            self.say(&frame::status(&self.title, tally, COLUMNS));
        }
    }

    fn end(&mut self, tally: &Tally) {
        if let Some(end) = &tally.end {
            summary::lines(&self.title, tally, end).iter().for_each(|line| self.say(line));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontend::fixture;

    fn seconds(seconds: u64) -> Duration {
        Duration::from_secs(seconds)
    }

    #[test]
    fn a_line_every_tenth_when_it_goes_fast() {
        let mut cadence = Cadence::default();
        let lines = (0..=1000).filter(|done| cadence.due(Duration::from_millis(*done), *done, 1000));
        assert_eq!(lines.collect::<Vec<_>>(), [100, 200, 300, 400, 500, 600, 700, 800, 900, 1000]);
    }

    #[test]
    fn a_line_every_few_seconds_when_it_goes_slowly() {
        let mut cadence = Cadence::default();
        let lines = (0..=23).filter(|second| cadence.due(seconds(*second), *second, 1_000_000));
        assert_eq!(lines.collect::<Vec<_>>(), [5, 10, 15, 20]);
    }

    #[test]
    fn a_line_of_either_kind_starts_the_wait_anew() {
        let mut cadence = Cadence::default();
        let due = [(4, 10), (8, 11), (9, 11), (13, 20), (14, 29), (18, 29)]
            .map(|(at, done)| cadence.due(seconds(at), done, 100));
        assert_eq!(due, [true, false, true, true, false, true]);
        assert!(!Cadence::default().due(seconds(0), 0, 0));
    }

    #[test]
    fn a_log_has_a_heading_lines_and_a_summary() {
        let mut plain = Plain::new(fixture::title(), Vec::new());
        let mut tally = fixture::half_way(2);
        plain.hear(&fixture::first_pass(2)[0], &tally);
        plain.tick(&tally);
        plain.tick(&tally);
        tally.done = tally.total.unwrap();
        plain.tick(&tally);
        tally.hear(&fixture::finished(false));
        plain.end(&tally);
        let log = String::from_utf8(plain.out).unwrap();
        let lines: Vec<_> = log.lines().collect();
        assert_eq!(lines[0], "scenes/a room with a rather long name.toml  64x64  64 spp  path  2 threads  avx2");
        assert_eq!(lines[1], "50 %  1 of 64 spp  0.08 Mrays/s  error 2.1 % at 1 spp  18-22 s left");
        assert!(lines[2].starts_with("done: ") && lines.len() == 5, "{log}");
        assert!(log.is_ascii() && !log.contains('\x1b'));
    }

    #[test]
    fn a_render_that_failed_has_no_summary() {
        let mut plain = Plain::new(fixture::title(), Vec::new());
        plain.end(&fixture::half_way(2));
        assert!(plain.out.is_empty());
    }
}
