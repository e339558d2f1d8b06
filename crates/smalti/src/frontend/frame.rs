//! What is on the screen at a moment, line by line, for any size of terminal.

use std::iter::once;

use console::{measure_text_width, truncate_str};
use smalti_scheduler::Photons;

use super::picture::{Look, Picture};
use super::tally::{Tally, Worker};
use super::{Title, numbers};
use crate::memory;

/// Columns and lines of the terminal.
pub type Size = (usize, usize);

/// A frame: lines of text, then the bar over everything with a text beside it or below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Lines above the bar.
    pub above: Vec<String>,
    /// What stands at the bar.
    pub text: String,
    /// Whether the text has a line of its own below the bar.
    pub below: bool,
}

/// Columns from which text and bar share a line.
const WIDE: usize = 60;
/// Columns of the bar that shares a line, at least.
const BAR: usize = 12;

/// The frame while it renders.
pub fn live(title: &Title, tally: &Tally, picture: Option<&Picture>, look: Look, (columns, lines): Size) -> Frame {
    // The line below stays free, so that the terminal never scrolls.
    let lines = lines.saturating_sub(1);
    let below = columns < WIDE && lines > 1;
    let room = lines.saturating_sub(if below { 2 } else { 1 });
    let heading = (room > 0).then(|| cut(&heading(title), columns));
    let room = room.saturating_sub(1);
    let workers = workers(tally, columns, room.div_ceil(2));
    let mut above: Vec<String> = heading.into_iter().collect();
    above.extend(painted(tally, picture, look, (columns, room - workers.len())));
    above.extend(workers);
    let text = status(title, tally, if columns < WIDE { columns } else { columns - BAR - 1 });
    Frame { above, text, below }
}

/// What stays on the screen at the end.
pub fn last(
    title: &Title,
    tally: &Tally,
    picture: Option<&Picture>,
    look: Look,
    (columns, lines): Size,
) -> Vec<String> {
    let Some(end) = &tally.end else {
        return Vec::new();
    };
    let summary = super::summary::lines(title, tally, end);
    let room = lines.saturating_sub(summary.len() + 2);
    let painted = painted(tally, picture, look, (columns, room));
    once(heading(title)).chain(painted).chain(summary).collect()
}

/// What is rendered and on what.
pub fn heading(title: &Title) -> String {
    let Title { scene, size: (width, height), goal, integrator, threads, level, .. } = title;
    let goal = goal.in_words();
    let scene: String = scene.chars().map(|c| if c.is_control() { '?' } else { c }).collect();
    let threads = if *threads == 1 { "1 thread".to_owned() } else { format!("{threads} threads") };
    format!("{scene}  {width}x{height}  {goal}  {integrator}  {threads}  {level}")
}

/// What became of the photons of a round.
pub fn photons(photons: &Photons) -> String {
    let Photons { emitted, stored, bytes, elapsed, .. } = photons;
    let (emitted, stored) = (numbers::count(*emitted), numbers::count(*stored));
    let (bytes, elapsed) = (memory::in_words(*bytes), numbers::duration(*elapsed));
    format!("photons of a round: {emitted} emitted, {stored} stored, {bytes}, {elapsed}")
}

fn painted(tally: &Tally, picture: Option<&Picture>, look: Look, (columns, lines): Size) -> Vec<String> {
    let fitted = picture.filter(|_| lines > 0).and_then(|picture| Some((picture, picture.fit(columns, lines)?)));
    let busy =
        tally.workers.iter().filter_map(|worker| worker.current).filter_map(|current| tally.tiles.get(current.tile));
    let busy: Vec<_> = busy.copied().collect();
    fitted.map_or(Vec::new(), |(picture, size)| picture.paint(size, look, &busy))
}

/// A line for each worker, `room` lines at most.
fn workers(tally: &Tally, columns: usize, room: usize) -> Vec<String> {
    let all = tally.workers.len();
    let shown = if all <= room { all } else { room.saturating_sub(1) };
    let lines = tally.workers[..shown].iter().enumerate();
    let mut lines: Vec<_> = lines.map(|(index, worker)| cut(&line(index, worker, tally, columns), columns)).collect();
    if shown < all && room > 0 {
        lines.push(cut(&format!("and {} more workers", all - shown), columns));
    }
    lines
}

fn line(index: usize, worker: &Worker, tally: &Tally, columns: usize) -> String {
    let digits = tally.workers.len().to_string().len();
    let Some(current) = worker.current else {
        return format!("{index:digits$} waiting");
    };
    let bar = numbers::bar(current.done, current.total, (columns / 6).clamp(4, 24));
    let mut line = format!("{index:digits$} ▕{bar}▏");
    let tile = format!("tile {} of {}", current.tile + 1, tally.tiles.len());
    let rate = worker.rays_per_second.map(|rate| format!("{:>13}", numbers::rays(rate)));
    let elapsed = format!("{:>8}", numbers::duration(current.elapsed));
    for field in once(elapsed).chain(rate).chain(once(tile)) {
        if measure_text_width(&line) + 2 + field.len() <= columns {
            line = line + "  " + &field;
        }
    }
    line
}

/// How far it is and how long it takes, as much of it as fits: the last fields in the list of ranks go first.
pub fn status(title: &Title, tally: &Tally, columns: usize) -> String {
    let remaining = title.goal.left(tally, title.setup);
    let (samples, until) = (tally.samples, tally.until);
    let fields = [
        (0, tally.total.map(|total| numbers::done(tally.done, total))),
        (5, Some(until.map_or(format!("{samples} spp"), |until| format!("{samples} of {until} spp")))),
        (2, Some(numbers::rays(tally.rays_per_second()))),
        (4, tally.error.map(|(error, spp)| format!("error {} at {spp} spp", numbers::share(error)))),
        (3, (tally.rejected > 0).then(|| format!("{} not finite", numbers::count(tally.rejected)))),
        (1, tally.photons.map(|(done, all)| format!("photons {}", numbers::done(done, all)))),
        (1, remaining.map(|(low, high)| numbers::range(low, high) + " left")),
    ];
    let kept = |rank: usize| {
        let kept = fields.iter().filter(|field| field.0 <= rank).filter_map(|field| field.1.as_deref());
        kept.collect::<Vec<_>>().join("  ")
    };
    let fitting = (0..fields.len()).rev().map(kept).find(|text| text.len() <= columns);
    fitting.unwrap_or_else(|| cut(&kept(0), columns))
}

/// `text` in at most `columns` columns.
fn cut(text: &str, columns: usize) -> String {
    truncate_str(text, columns, "…").into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontend::fixture::{self, AREA};
    use crate::frontend::terminal::Palette;

    const LOOK: Look = Look { palette: Palette::Mono, exposure: 0.0 };

    fn frame(workers: usize, size: Size) -> Frame {
        live(&fixture::title(), &fixture::half_way(workers), Some(&Picture::new(AREA)), LOOK, size)
    }

    #[test]
    fn every_frame_fits_its_terminal() {
        for workers in [1, 2, 9, 64] {
            for columns in [1, 2, 5, 20, 40, 59, 60, 80, 200] {
                for lines in [1, 2, 3, 4, 6, 10, 24, 60] {
                    let Frame { above, text, below } = frame(workers, (columns, lines));
                    let height = above.len() + if below { 2 } else { 1 };
                    assert!(height <= (lines - 1).max(1), "{height} lines of {lines}, {columns} columns");
                    let widest = above.iter().map(|line| measure_text_width(line)).max().unwrap_or(0);
                    let beside = if below || columns < WIDE { 0 } else { BAR + 1 };
                    assert!(widest.max(measure_text_width(&text) + beside) <= columns, "{columns}: {above:?} {text}");
                }
            }
        }
    }

    #[test]
    fn a_roomy_terminal_shows_everything() {
        let Frame { above, text, below } = frame(2, (100, 40));
        assert!(!below && above[0].starts_with("scenes/a room") && above[0].ends_with("avx2"));
        assert_eq!(above[1], " ".repeat(64));
        assert_eq!(above[33], "0 ▕████████        ▏   45.0 ms   10.0 Mrays/s  tile 6 of 16");
        assert_eq!(above[34..], ["1 waiting"]);
        assert_eq!(text, "50 %  1 of 64 spp  0.08 Mrays/s  error 2.1 % at 1 spp  18-22 s left");
    }

    #[test]
    fn narrow_terminals_lose_the_least_important_first() {
        let tally = fixture::half_way(2);
        let texts = [60, 50, 40, 28, 12, 4].map(|columns| status(&fixture::title(), &tally, columns));
        let expected = [
            "50 %  0.08 Mrays/s  error 2.1 % at 1 spp  18-22 s left",
            "50 %  0.08 Mrays/s  18-22 s left",
            "50 %  0.08 Mrays/s  18-22 s left",
            "50 %  18-22 s left",
            "50 %",
            "50 %",
        ];
        assert_eq!(texts, expected);
    }

    #[test]
    fn workers_that_do_not_fit_are_counted() {
        let tally = fixture::half_way(9);
        assert_eq!(workers(&tally, 80, 9).len(), 9);
        let lines = workers(&tally, 80, 4);
        assert_eq!((lines.len(), lines[3].as_str()), (4, "and 6 more workers"));
        assert_eq!(workers(&tally, 80, 0), Vec::<String>::new());
    }

    #[test]
    fn names_of_scenes_cannot_move_the_cursor() {
        let title = Title { scene: "a\x1b[2Jb\nc".into(), ..fixture::title() };
        assert!(heading(&title).starts_with("a?[2Jb?c  64x64"));
    }

    #[test]
    fn the_last_frame_has_the_picture_and_the_summary() {
        let mut tally = fixture::half_way(2);
        assert_eq!(last(&fixture::title(), &tally, None, LOOK, (80, 24)), Vec::<String>::new());
        tally.hear(&fixture::finished(false));
        let lines = last(&fixture::title(), &tally, Some(&Picture::new(AREA)), LOOK, (80, 24));
        assert_eq!(lines.len(), 1 + 19 + 3);
        assert!(lines[20].starts_with("done: "));
    }
}
