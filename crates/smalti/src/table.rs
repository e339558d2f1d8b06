//! Plain tables for the terminal: columns as wide as their widest cell.

/// How a column is aligned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Align {
    Left,
    Right,
}

/// Lays out `rows` (the first may be a heading) in columns two blanks apart, indented by two; no trailing blanks.
pub fn table(align: &[Align], rows: &[Vec<String>]) -> String {
    let widths: Vec<usize> = (0..align.len()).map(|column| widest(rows, column)).collect();
    rows.iter().map(|row| line(align, &widths, row)).collect()
}

fn widest(rows: &[Vec<String>], column: usize) -> usize {
    rows.iter().filter_map(|row| row.get(column)).map(|cell| console::measure_text_width(cell)).max().unwrap_or(0)
}

fn line(align: &[Align], widths: &[usize], row: &[String]) -> String {
    let mut line = String::new();
    for ((cell, width), align) in row.iter().zip(widths).zip(align) {
        let padding = " ".repeat(width - console::measure_text_width(cell));
        line += "  ";
        match align {
            Align::Left => line += &(cell.clone() + &padding),
            Align::Right => line += &(padding + cell),
        }
    }
    line.truncate(line.trim_end().len());
    line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let rows = [vec!["name".into(), "n".into()], vec!["a".into(), "100".into()], vec!["°".into()]];
        assert_eq!(table(&[Align::Left, Align::Right], &rows), "  name    n\n  a     100\n  °\n");
    }
}
