//! Text in columns and lines.

/// How a column is aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

/// The least that is left of a column that is cut.
const LEAST: usize = 12;

/// Lays out `rows` in columns two blanks apart, indented by two; column `cut` is cut so that lines fit into `width`.
pub(super) fn columns(sides: &[Side], rows: &[Vec<String>], cut: usize, width: usize) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let widest = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell: &String| length(cell)).max().unwrap_or(0)
    };
    let mut widths: Vec<usize> = (0..count).map(widest).collect();
    let all: usize = widths.iter().map(|width| width + 2).sum();
    if let Some(cut) = widths.get_mut(cut) {
        *cut = cut.saturating_sub(all.saturating_sub(width)).max(LEAST.min(*cut));
    }
    rows.iter().map(|row| line(sides, &widths, row)).collect()
}

fn line(sides: &[Side], widths: &[usize], row: &[String]) -> String {
    let mut line = String::new();
    for ((cell, &width), side) in row.iter().zip(widths).zip(sides) {
        let cell = shorten(cell, width);
        let padding = " ".repeat(width - length(&cell));
        line += "  ";
        match side {
            Side::Left => line += &(cell + &padding),
            Side::Right => line += &(padding + &cell),
        }
    }
    line.truncate(line.trim_end().len());
    line + "\n"
}

/// `text` in at most `width` columns, the cut marked by an ellipsis.
fn shorten(text: &str, width: usize) -> String {
    match length(text) > width {
        true => text.chars().take(width.saturating_sub(1)).chain(['…']).collect(),
        false => text.to_owned(),
    }
}

fn length(text: &str) -> usize {
    text.chars().count()
}

/// Breaks `text` between words; lines after the first begin with `indent`.
pub(super) fn wrap(text: &str, width: usize, indent: &str) -> String {
    let lead = &text[..text.len() - text.trim_start().len()];
    let mut lines = vec![lead.to_owned()];
    for word in text.split_whitespace() {
        let last = lines.last_mut().expect("there is always a line");
        let fresh = last.trim().is_empty();
        if !fresh && length(last) + 1 + length(word) > width {
            lines.push(format!("{indent}{word}"));
            continue;
        }
        *last += if fresh { "" } else { " " };
        *last += word;
    }
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_cut_to_fit() {
        let rows = [vec!["a long name of an arm".to_owned(), "1.5".into()], vec!["×".into(), "10".into()]];
        let sides = [Side::Left, Side::Right];
        assert_eq!(columns(&sides, &rows, 0, 60), "  a long name of an arm  1.5\n  ×                       10\n");
        assert_eq!(columns(&sides, &rows, 0, 20), "  a long name …  1.5\n  ×               10\n");
        assert_eq!(columns(&sides, &rows, 0, 5), "  a long name…  1.5\n  ×              10\n");
    }

    #[test]
    fn lines_break_between_words() {
        assert_eq!(wrap("  one two three", 9, "    "), "  one two\n    three\n");
        assert_eq!(wrap("unbreakable", 4, ""), "unbreakable\n");
    }
}
