//! `docs/report-map.md` names every equation, figure and table of the report, and only files and tests that exist.

use std::collections::HashSet;
use std::fs;
use std::path::Path;

use smalti_tests::draw::repository;

/// A row of a table: its name and its cells for code and test.
struct Row {
    name: String,
    code: String,
    test: String,
}

fn rows() -> Vec<Row> {
    let text = fs::read_to_string(repository().join("docs/report-map.md")).expect("the map");
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let tables = text.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| |")).map(cells);
    let row = |cells: Vec<String>| {
        let [name, what, code, test, corrected] = <[String; 5]>::try_from(cells).expect("five cells a row");
        assert!(!what.is_empty() && !corrected.is_empty(), "{name} says too little");
        Row { name, code, test }
    };
    tables.map(row).collect()
}

/// What stands in backticks.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// The names of all tests in the Rust files of `folder`.
fn collect_tests(folder: &Path, names: &mut HashSet<String>) {
    for entry in fs::read_dir(folder).expect("a folder of the repository") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect_tests(&path, names);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).expect("a source");
            let after = text.split("#[test]").skip(1).filter_map(|rest| rest.split_once("fn ")?.1.split_once('('));
            names.extend(after.map(|(name, _)| name.to_owned()));
        }
    }
}

#[test]
fn everything_in_the_report_has_its_row() {
    let names: Vec<String> = rows().into_iter().map(|row| row.name).collect();
    let expected = (1..=21).map(|number| format!("Eq. {number}")).chain((1..=6).map(|number| format!("Fig. {number}")));
    for name in expected.chain(["Table 1".to_owned()]) {
        assert_eq!(names.iter().filter(|row| **row == name).count(), 1, "{name}");
    }
}

#[test]
fn every_file_exists() {
    for Row { name, code, .. } in &rows() {
        assert!(!quoted(code).is_empty(), "{name} names no file");
        for file in quoted(code) {
            assert!(repository().join(file).is_file(), "{name}: {file} does not exist");
        }
    }
}

#[test]
fn every_test_exists() {
    let mut tests = HashSet::new();
    for folder in ["crates", "tests"] {
        collect_tests(&repository().join(folder), &mut tests);
    }
    for Row { name, test, .. } in &rows() {
        assert!(!quoted(test).is_empty(), "{name} names no test");
        for test in quoted(test) {
            assert!(tests.contains(test), "{name}: no test is called {test}");
        }
    }
}
