//! Error against time in characters: curves in dots of Braille patterns, arms as the letters of their groups.

use crate::axis::Axis;
use crate::findings::Finding;
use crate::groups::{curves, groups, look};
use crate::numbers::significant;
use crate::record::Study;

/// Rows of characters.
const ROWS: usize = 14;

/// Columns for the labels of the error.
const LABEL: usize = 8;

/// The plot in lines of at most `width` columns, with what its letters mean.
pub(super) fn plot(study: &Study, findings: &[Finding], width: usize) -> String {
    let x = Axis::around(findings.iter().map(|finding| finding.seconds.median));
    let y = Axis::around(findings.iter().map(|finding| 100.0 * finding.relative_error.median));
    let mut area = Area::new(width - LABEL - 2);
    let place = |finding: &Finding| [x.place(finding.seconds.median), y.place(100.0 * finding.relative_error.median)];
    for curve in curves(study, findings) {
        curve.windows(2).for_each(|pair| area.line(place(pair[0]), place(pair[1])));
    }
    for finding in findings {
        let letter = look(study, finding.arm).letter();
        area.put(place(finding), if finding.on_front { letter.to_ascii_uppercase() } else { letter });
    }
    let legend = groups(study).into_iter().map(|(name, look)| format!("{} {name}", look.letter()));
    let legend = legend.collect::<Vec<_>>().join("   ");
    let title = "relative error, % (capitals: on the Pareto front)";
    format!("  {title}\n{}{}  {legend}\n", body(&area, &y), below(&x, area.columns))
}

/// The rows with the labels of the vertical axis.
fn body(area: &Area, y: &Axis) -> String {
    let mut labels = vec![String::new(); ROWS];
    for tick in y.ticks().into_iter().filter(|tick| tick.labelled) {
        labels[row(y.place(tick.value))] = significant(tick.value, 1);
    }
    let line = |(label, row): (&String, &Vec<char>)| {
        let mark = if label.is_empty() { '│' } else { '┤' };
        let text = format!("{label:>LABEL$} {mark}{}", row.iter().collect::<String>());
        text.trim_end().to_owned() + "\n"
    };
    labels.iter().zip(&area.cells).map(line).collect()
}

/// The horizontal axis with its labels.
fn below(x: &Axis, columns: usize) -> String {
    let mut axis = vec!['─'; columns];
    let mut labels = String::new();
    for tick in x.ticks().into_iter().filter(|tick| tick.labelled) {
        let column = (x.place(tick.value) * (columns - 1) as f64).round() as usize;
        axis[column] = '┬';
        let label = significant(tick.value, 1);
        let start = column.saturating_sub(label.len() / 2);
        let used = labels.chars().count();
        if (labels.is_empty() || used < start) && start + label.len() <= columns {
            labels += &(" ".repeat(start - used) + &label);
        }
    }
    let indent = " ".repeat(LABEL + 1);
    let axis: String = axis.into_iter().collect();
    format!("{indent}└{axis}\n{indent} {labels}\n{indent} render time, seconds\n")
}

/// The row of a place from 0 at the bottom to 1 on top.
fn row(up: f64) -> usize {
    ((1.0 - up) * (ROWS - 1) as f64).round() as usize
}

/// What is drawn on: characters, each with 2 × 4 dots.
struct Area {
    columns: usize,
    cells: Vec<Vec<char>>,
}

impl Area {
    fn new(columns: usize) -> Self {
        Self { columns, cells: vec![vec![' '; columns]; ROWS] }
    }

    fn put(&mut self, [x, y]: [f64; 2], letter: char) {
        let column = (x * (self.columns - 1) as f64).round() as usize;
        self.cells[row(y)][column] = letter;
    }

    /// A dotted line; it is drawn before any letter.
    fn line(&mut self, from: [f64; 2], to: [f64; 2]) {
        let [a, b] = [from, to].map(|place| self.dot(place));
        let steps = (b[0] - a[0]).abs().max((b[1] - a[1]).abs()).max(1.0);
        for step in 0..=steps as usize {
            let part = step as f64 / steps;
            self.mark([0, 1].map(|axis| (a[axis] + part * (b[axis] - a[axis])).round() as usize));
        }
    }

    /// The dot in the middle of the character where a letter would stand.
    fn dot(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [2.0 * (x * (self.columns - 1) as f64) + 0.5, 4.0 * ((1.0 - y) * (ROWS - 1) as f64) + 1.5]
    }

    fn mark(&mut self, [x, y]: [usize; 2]) {
        /// Bits of a Braille pattern, by row and column.
        const BITS: [[u32; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        let cell = &mut self.cells[y / 4][x / 2];
        let dots = if *cell == ' ' { 0 } else { u32::from(*cell) - 0x2800 };
        *cell = char::from_u32(0x2800 + (dots | BITS[y % 4][x % 2])).unwrap_or(' ');
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    #[test]
    fn every_arm_has_its_letter() {
        let study = fixture::sweep();
        let text = plot(&study, &findings(&study), 70);
        let area: String =
            text.lines().skip(1).take(ROWS).map(|line| line.chars().skip(LABEL + 2).collect::<String>()).collect();
        let count = |letter| area.matches(letter).count();
        assert_eq!(['A', 'a', 'B', 'b'].map(count), [1, 2, 2, 0], "{text}");
        assert!(text.ends_with("  a path   b auto\n"), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 70), "{text}");
    }

    #[test]
    fn lines_are_dots() {
        let mut area = Area::new(4);
        area.line([0.0, 1.0], [1.0, 1.0]);
        let top: String = area.cells[0].iter().collect();
        assert_eq!(top, "⠠⠤⠤⠤");
    }
}
