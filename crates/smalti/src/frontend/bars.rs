//! Live bars: one frame after the other in the same place, drawn by indicatif.

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use smalti_scheduler::Event;

use super::frame::{self, Frame, Size};
use super::picture::{Look, Picture};
use super::screen::{Screen, Surface};
use super::tally::Tally;
use super::terminal::Palette;
use super::{Title, View};

/// The length of a bar: what is foreseen changes, its bar does not.
const WHOLE: u64 = 1 << 16;

/// Frames on a surface.
pub struct Bars<S> {
    title: Title,
    look: Look,
    picture: Option<Picture>,
    surface: S,
    drawn: Option<Drawn>,
}

/// The frame on the surface.
struct Drawn {
    /// Where indicatif draws; it holds one bar, with everything else of the frame as that bar's text.
    place: MultiProgress,
    bar: ProgressBar,
    shape: Shape,
}

/// What must not change for a frame to be drawn over the last one.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Shape {
    /// The size of the surface.
    size: Size,
    /// The lines of the frame.
    lines: usize,
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

    /// The bar of a frame of that shape. Where the last frame had another, it is wiped and a new bar is begun.
    fn bar(&mut self, shape: Shape) -> Drawn {
        match self.drawn.take() {
            Some(drawn) if drawn.shape == shape => return drawn,
            Some(drawn) => self.wipe(&drawn, shape.size),
            None => {}
        }
        let target = ProgressDrawTarget::term_like(Box::new(self.surface.clone()));
        let place = MultiProgress::with_draw_target(target);
        // Lines are overwritten, not cleared first: a terminal without synchronised output does not flicker.
        place.set_move_cursor(true);
        let bar = place.add(ProgressBar::with_draw_target(Some(WHOLE), ProgressDrawTarget::hidden()));
        Drawn { place, bar, shape }
    }

    /// Wipes what was drawn before the surface became `size`.
    fn wipe(&self, drawn: &Drawn, size: Size) {
        drawn.place.set_draw_target(ProgressDrawTarget::hidden());
        let lines = broken_anew(drawn.shape.lines, drawn.shape.size.0, size.0).min(size.1);
        let _ = self.surface.move_cursor_up(lines.saturating_sub(1));
        let _ = self.surface.write_str("\r\x1b[J");
    }

    fn draw(&mut self, tally: &Tally) {
        let size = self.measure();
        let Frame { above, text, below } = frame::live(&self.title, tally, self.picture(), self.look, size);
        let style = style(!above.is_empty(), below, self.look.palette);
        let lines = above.len() + if below { 2 } else { 1 };
        let drawn = self.bar(Shape { size, lines });
        let bar = drawn.bar.clone().with_style(style).with_prefix(above.join("\n")).with_message(text);
        bar.with_position(part(tally)).tick();
        self.drawn = Some(drawn);
    }

    fn leave(&mut self, tally: &Tally) {
        let size = self.measure();
        match self.drawn.take() {
            Some(drawn) if drawn.shape.size == size => drawn.bar.finish_and_clear(),
            Some(drawn) => self.wipe(&drawn, size),
            None => {}
        }
        for line in frame::last(&self.title, tally, self.picture(), self.look, size) {
            let _ = self.surface.write_line(&line);
        }
        let _ = self.surface.flush();
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
            self.draw(tally);
        }
    }

    fn end(&mut self, tally: &Tally) {
        self.leave(tally);
    }
}

/// Lines that `lines` lines of `from` columns become when the terminal has `to` columns. Indicatif fills every line to
/// its end and lets the terminal break it, so to a terminal that breaks lines anew the whole frame is one long line.
fn broken_anew(lines: usize, from: usize, to: usize) -> usize {
    (lines * from).div_ceil(to)
}

/// How much of the bar is done; nothing where the end cannot be foreseen.
fn part(tally: &Tally) -> u64 {
    let part =
        |total: u64| (u128::from(tally.done) * u128::from(WHOLE)).checked_div(total.into()).map(|part| part as u64);
    tally.total.map_or(0, |total| part(total).unwrap_or(WHOLE))
}

/// Where text and bar stand.
fn style(above: bool, below: bool, palette: Palette) -> ProgressStyle {
    let head = if above { "{prefix}\n" } else { "" };
    let bar = if palette == Palette::Mono { "{wide_bar}" } else { "\x1b[36m{wide_bar}\x1b[0m" };
    let tail = if below { "\n{msg}" } else { " {msg}" };
    let style = ProgressStyle::with_template(&[head, bar, tail].concat()).expect("a fixed template");
    style.progress_chars("█▉▊▋▌▍▎▏ ")
}

#[cfg(test)]
mod tests {
    use indicatif::InMemoryTerm;

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
    fn lines_are_broken_anew() {
        assert_eq!(broken_anew(10, 80, 40), 20);
        assert_eq!(broken_anew(10, 80, 79), 11);
        assert_eq!(broken_anew(10, 80, 200), 4);
    }
}
