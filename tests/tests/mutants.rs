//! `docs/mutants.md` names every mistake that can be made on purpose, and only tests that exist.

use std::collections::BTreeSet;

use smalti_tests::documents::{quoted, rows, sources, tests};

#[test]
fn every_mistake_has_its_row() {
    let sources = sources("crates/smalti-core/src");
    let made: BTreeSet<&str> = sources
        .iter()
        .flat_map(|text| text.split("mutant!(\"").skip(1).filter_map(|rest| Some(rest.split_once('"')?.0)))
        .collect();
    let rows = rows("mutants.md");
    let named: BTreeSet<&str> = rows.iter().flat_map(|row| quoted(&row[0])).collect();
    assert!(made.len() > 50);
    assert_eq!(made, named);
}

#[test]
fn every_mistake_is_noticed_by_a_test_that_exists() {
    let tests = tests();
    for row in rows("mutants.md") {
        assert!(!quoted(&row[2]).is_empty(), "{} is noticed by nothing", row[0]);
        for test in quoted(&row[2]) {
            assert!(tests.contains(test), "{}: no test is called {test}", row[0]);
        }
    }
}
