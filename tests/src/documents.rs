//! Documents that name tests, and the tests that there are.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::draw::repository;

/// The rows of all tables of a document in `docs`, without headings: their cells.
pub fn rows(document: &str) -> Vec<Vec<String>> {
    let text = fs::read_to_string(repository().join("docs").join(document)).expect("a document");
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let lines: Vec<&str> = text.lines().collect();
    let under_heading = |at: usize| lines.get(at + 1).is_some_and(|next| next.starts_with("|---"));
    let of_table = |at: &usize| lines[*at].starts_with("| ") && !under_heading(*at);
    (0..lines.len()).filter(of_table).map(|at| cells(lines[at])).collect()
}

/// What stands in backticks.
pub fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// The names of all tests of the repository.
pub fn tests() -> HashSet<String> {
    let names = |text: &String| {
        let after = text.split("#[test]").skip(1).filter_map(|rest| rest.split_once("fn ")?.1.split_once('('));
        after.map(|(name, _)| name.to_owned()).collect::<Vec<_>>()
    };
    ["crates", "tests"].iter().flat_map(|folder| sources(folder)).flat_map(|text| names(&text)).collect()
}

/// The texts of all Rust files in a folder of the repository.
pub fn sources(folder: &str) -> Vec<String> {
    let mut texts = Vec::new();
    collect(&repository().join(folder), &mut texts);
    texts.into_iter().map(|path| fs::read_to_string(path).expect("a source")).collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of the repository") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}
