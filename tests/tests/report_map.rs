//! `docs/report-map.md` names every equation, figure and table of the report, and only files and tests that exist.

use smalti_tests::documents::{self, quoted};
use smalti_tests::draw::repository;

/// A row of a table: its name and its cells for code and test.
struct Row {
    name: String,
    code: String,
    test: String,
}

fn rows() -> Vec<Row> {
    let row = |cells: Vec<String>| {
        let [name, what, code, test, corrected] = <[String; 5]>::try_from(cells).expect("five cells a row");
        assert!(!what.is_empty() && !corrected.is_empty(), "{name} says too little");
        Row { name, code, test }
    };
    documents::rows("report-map.md").into_iter().map(row).collect()
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
    let tests = documents::tests();
    for Row { name, test, .. } in &rows() {
        assert!(!quoted(test).is_empty(), "{name} names no test");
        for test in quoted(test) {
            assert!(tests.contains(test), "{name}: no test is called {test}");
        }
    }
}
