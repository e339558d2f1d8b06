//! Live bars: one frame after the other in the same place.
//!
//! Each line of a frame ends by itself, and what is right of it is cleared, not filled: where the terminal becomes
//! narrower, only lines that no longer fit are broken, and it is known into how many rows.

use std::io;

use console::measure_text_width;
use smalti_scheduler::Event;

use super::frame::{self, Frame, Size};
use super::numbers;
use super::picture::{Look, Picture};
use super::screen::{Screen, Surface};
use super::tally::Tally;
use super::terminal::Palette;
use super::{Title, View};

/// Frames on a surface.
pub struct Bars<S> {
    title: Title,
    look: Look,
    picture: Option<Picture>,
    surface: S,
    drawn: Option<Drawn>,
}

/// The frame on the surface, with the cursor behind its last line.
struct Drawn {
    /// The size of the surface.
    size: Size,
    /// Columns of each line.
    widths: Vec<usize>,
}

impl Bars<Screen> {
    /// Frames on the terminal.
    pub fn on_stderr(title: Title, palette: Palette) -> Self {
        Self::new(title, palette, Screen::default())
    }
}

impl<S: Surface> Bars<S> {
    fn new(title: Title, palette: Palette, surface: S) -> Self {
        let look = Look { palette, exposure: title.exposure };
        Self { title, look, picture: None, surface, drawn: None }
    }

    /// The picture so far, where it is to be seen.
    fn picture(&self) -> Option<&Picture> {
        self.picture.as_ref().filter(|_| self.title.pictures)
    }

    /// The size of the surface now.
    fn measure(&self) -> Size {
        self.surface.measure();
        (usize::from(self.surface.width()), usize::from(self.surface.height()))
    }

    fn draw(&mut self, tally: &Tally) -> io::Result<()> {
        let size = self.measure();
        let frame = frame::live(&self.title, tally, self.picture(), self.look, size);
        let lines = lines(frame, tally, size.0, self.look.palette);
        let widths: Vec<usize> = lines.iter().map(|line| measure_text_width(line)).collect();
        // A frame of the same shape is overwritten: a terminal without synchronised output does not flicker.
        match self.drawn.take() {
            Some(drawn) if drawn.size == size && drawn.widths.len() == lines.len() => {
                self.rise(&drawn, size)?;
            }
            Some(drawn) => self.wipe(&drawn, size)?,
            None => {}
        }
        for (index, (line, width)) in lines.iter().zip(&widths).enumerate() {
            self.surface.write_str(if index > 0 { "\r\n" } else { "" })?;
            self.surface.write_str(line)?;
            // Behind a full line the cursor still stands on its last column.
            self.surface.write_str(if *width < size.0 { "\x1b[K" } else { "" })?;
        }
        self.drawn = Some(Drawn { size, widths });
        self.surface.flush()
    }

    /// Moves the cursor to the start of what was drawn, now that the surface has `size`; returns the rows of it that are
    /// on the surface.
    fn rise(&self, drawn: &Drawn, size: Size) -> io::Result<usize> {
        let rows = rows(&drawn.widths, size.0).min(size.1);
        self.surface.move_cursor_up(rows.saturating_sub(1))?;
        self.surface.write_str("\r")?;
        Ok(rows)
    }

    /// Wipes what was drawn, row by row: where all is cleared at once, some terminals put it into their scroll-back.
    fn wipe(&self, drawn: &Drawn, size: Size) -> io::Result<()> {
        let rows = self.rise(drawn, size)?;
        for row in 0..rows {
            self.surface.clear_line()?;
            self.surface.move_cursor_down(usize::from(row + 1 < rows))?;
        }
        self.surface.move_cursor_up(rows.saturating_sub(1))
    }

    fn leave(&mut self, tally: &Tally) -> io::Result<()> {
        let size = self.measure();
        if let Some(drawn) = self.drawn.take() {
            self.wipe(&drawn, size)?;
        }
        for line in frame::last(&self.title, tally, self.picture(), self.look, size) {
            self.surface.write_line(&line)?;
        }
        self.surface.flush()
    }
}

impl<S: Surface> View for Bars<S> {
    fn hear(&mut self, event: &Event, _: &Tally) {
        match (event, &mut self.picture) {
            (Event::Started { area, .. }, _) => self.picture = Some(Picture::new(*area)),
            (Event::TileFinished { area, pixels: Some(pixels), .. }, Some(picture)) => picture.put(*area, pixels),
            _ => {}
        }
    }

    fn tick(&mut self, tally: &Tally) {
        if self.picture.is_some() {
            let _ = self.draw(tally);
        }
    }

    fn end(&mut self, tally: &Tally) {
        let _ = self.leave(tally);
    }
}

/// Rows that lines of these widths take where a row has so many columns: what does not fit goes on in the next row.
fn rows(widths: &[usize], columns: usize) -> usize {
    widths.iter().map(|width| width.div_ceil(columns.max(1)).max(1)).sum()
}

/// A frame line by line, none wider than so many columns: the bar fills what the text beside it leaves.
fn lines(Frame { above, text, below }: Frame, tally: &Tally, columns: usize, palette: Palette) -> Vec<String> {
    let beside = if below { 0 } else { measure_text_width(&text) + 1 };
    let (done, all) = part(tally);
    let bar = numbers::bar(done, all, columns.saturating_sub(beside));
    let bar = if palette == Palette::Mono { bar } else { format!("\x1b[36m{bar}\x1b[0m") };
    let mut lines = above;
    match columns > beside {
        true if below => lines.extend([bar, text]),
        true => lines.push(format!("{bar} {text}")),
        false => lines.push(text),
    }
    lines
}

/// How much is done of how much; nothing where the end cannot be foreseen.
fn part(tally: &Tally) -> (u64, u64) {
    match tally.total {
        Some(0) => (1, 1),
        Some(total) => (tally.done, total),
        None => (0, 1),
    }
}

#[cfg(test)]
mod tests {
    use indicatif::{InMemoryTerm, TermLike};

    use super::*;
    use crate::frontend::fixture;

    impl Surface for InMemoryTerm {}

    /// Hears the first pass and draws `frames` frames half-way.
    fn drawn(size: (u16, u16), workers: usize, palette: Palette, frames: usize) -> (Bars<InMemoryTerm>, Tally) {
        let mut bars = Bars::new(fixture::title(), palette, InMemoryTerm::new(size.1, size.0));
        let tally = fixture::half_way(workers);
        bars.tick(&Tally::default());
        fixture::first_pass(workers).iter().for_each(|fact| bars.hear(fact, &tally));
        (0..frames).for_each(|_| bars.tick(&tally));
        (bars, tally)
    }

    #[test]
    fn frames_are_drawn_in_the_same_place_at_every_size() {
        for palette in [Palette::Mono, Palette::Indexed, Palette::True] {
            for size in [(20, 5), (20, 24), (40, 3), (40, 10), (59, 24), (60, 24), (80, 24), (200, 50), (7, 2), (2, 1)]
            {
                let once = drawn(size, 9, palette, 1).0.surface.contents();
                let often = drawn(size, 9, palette, 4).0.surface.contents();
                assert_eq!(once, often, "{size:?}");
                assert!(once.lines().count() <= usize::from(size.1 - 1).max(1), "{size:?}\n{once}");
                assert!(size.0 < 7 || once.contains("50 %"), "{size:?}\n{once}");
            }
        }
    }

    #[test]
    fn a_wide_frame_has_title_picture_workers_and_bar() {
        let contents = drawn((80, 24), 2, Palette::Mono, 1).0.surface.contents();
        let lines: Vec<_> = contents.lines().collect();
        assert!(lines[0].starts_with("scenes/a room"), "{contents}");
        assert_eq!(lines[1].trim(), "#".repeat(38));
        assert!(lines[20].starts_with("0 ▕██████▌      ▏   45.0 ms"), "{contents}");
        assert_eq!(lines[21], "1 waiting");
        assert!(lines[22].starts_with("████") && lines[22].ends_with("18-22 s left"), "{contents}");
    }

    #[test]
    fn the_picture_is_in_true_colour() {
        let formatted = drawn((80, 24), 2, Palette::True, 1).0.surface.contents_formatted();
        let formatted = String::from_utf8(formatted).unwrap();
        assert!(formatted.contains("38;2;188;188;188") && formatted.contains('▀'), "{formatted:?}");
    }

    #[test]
    fn the_end_leaves_the_picture_and_the_summary() {
        let (mut bars, mut tally) = drawn((80, 24), 2, Palette::Mono, 2);
        tally.hear(&fixture::finished(false));
        bars.end(&tally);
        let contents = bars.surface.contents();
        assert!(!contents.contains("waiting") && !contents.contains("left"), "{contents}");
        assert!(contents.contains("####") && contents.lines().last().unwrap().starts_with("idle"), "{contents}");
    }

    #[test]
    fn a_render_that_failed_leaves_nothing() {
        let (mut bars, tally) = drawn((80, 24), 2, Palette::True, 2);
        bars.end(&tally);
        assert_eq!(bars.surface.contents(), "");
    }

    #[test]
    fn a_frame_of_another_shape_replaces_the_last() {
        let (mut bars, tally) = drawn((80, 24), 9, Palette::Mono, 2);
        let few = fixture::half_way(2);
        bars.tick(&few);
        assert_eq!(bars.surface.contents(), drawn((80, 24), 2, Palette::Mono, 1).0.surface.contents());
        bars.tick(&tally);
        assert_eq!(bars.surface.contents(), drawn((80, 24), 9, Palette::Mono, 1).0.surface.contents());
    }

    #[test]
    fn lines_are_broken_where_they_no_longer_fit() {
        assert_eq!(rows(&[80, 38, 38, 0, 79], 80), 5);
        assert_eq!(rows(&[80, 38, 38, 0, 79], 79), 6);
        assert_eq!(rows(&[80, 38, 38, 0, 79], 40), 7);
        assert_eq!(rows(&[80, 38, 38, 0, 79], 19), 5 + 2 + 2 + 1 + 5);
        assert_eq!(rows(&[80, 40], 200), 2, "wider terminals join nothing");
        assert_eq!(rows(&[3, 0], 0), 4);
    }

    #[test]
    fn no_line_is_wider_than_the_terminal() {
        for columns in [1, 2, 7, 20, 59, 60, 80, 200] {
            let frame =
                |below| Frame { above: vec!["title".into()], text: "50 %".chars().take(columns).collect(), below };
            for below in [false, true] {
                let lines = lines(frame(below), &fixture::half_way(2), columns, Palette::True);
                let widths: Vec<usize> = lines[1..].iter().map(|line| measure_text_width(line)).collect();
                assert!(widths.iter().all(|width| *width <= columns), "{columns}: {lines:?}");
                assert_eq!(widths.len(), if below { 2 } else { 1 });
            }
        }
    }

    #[test]
    fn a_frame_that_was_broken_anew_is_wiped_as_a_whole() {
        for (before, after) in [(80, 40), (80, 79), (80, 61), (100, 60), (40, 80)] {
            let (mut bars, tally) = drawn((before, 30), 2, Palette::Mono, 1);
            let lines = bars.surface.contents();
            // What such a terminal does: a shell's line above, then the frame at the new width.
            let narrow = InMemoryTerm::new(60, after);
            narrow.write_line("$ smalti render").unwrap();
            narrow.write_str(&lines.replace('\n', "\r\n")).unwrap();
            bars.surface = narrow;
            bars.tick(&tally);
            let contents = bars.surface.contents();
            let alone = drawn((after, 60), 2, Palette::Mono, 1).0.surface.contents();
            assert_eq!(contents, format!("$ smalti render\n{alone}"), "{before} to {after}");
        }
    }
}
