//! The table of arms, and the data to take away.

use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

use serde_json::Value;
use smalti_report::Study;

use crate::browser::Browser;
use crate::{ARMS, STUDY, opened};

/// The figures of a column, from top to bottom; what has none is infinite.
fn column(browser: &Browser, index: usize) -> Vec<f64> {
    let of = format!(
        "[...document.querySelectorAll('#arms tbody tr')].map(r => Number(r.cells[{index}].dataset.value ?? 1e300))"
    );
    serde_json::from_value(browser.value(&of)).unwrap()
}

fn sort(browser: &Browser, index: usize) -> Value {
    let heading = format!("#arms thead tr:last-child th:nth-child({})", index + 1);
    browser.click(&format!("{heading} button"));
    browser.value(&format!("document.querySelector('{heading}').ariaSort"))
}

#[test]
fn headings_sort_both_ways() {
    let Some(browser) = opened() else { return };
    for index in [1, 2, 4, 7] {
        let before = column(&browser, index);
        assert_eq!(before.len(), ARMS as usize);
        assert_eq!(sort(&browser, index), "ascending");
        let up = column(&browser, index);
        assert!(up.is_sorted() && up != before, "{up:?}");
        assert_eq!(sort(&browser, index), "descending");
        assert!(column(&browser, index).iter().rev().is_sorted());
    }
    assert_eq!(browser.number("document.querySelectorAll('#arms [aria-sort$=cending]').length"), 1.0);
}

#[test]
fn what_has_no_figure_stays_below() {
    let Some(browser) = opened() else { return };
    // Four samples are too few to state an error: five arms have no figure.
    for _ in 0..2 {
        sort(&browser, 8);
        let stated = column(&browser, 8);
        assert!(
            stated[..4].iter().all(|&value| value < 1e300) && stated[4..].iter().all(|&v| v == 1e300),
            "{stated:?}"
        );
    }
}

#[test]
fn names_sort_as_text() {
    let Some(browser) = opened() else { return };
    sort(&browser, 0);
    let names = browser.texts("#arms tbody .label");
    assert!(names.is_sorted() && names[0].starts_with("auto") && names[8].starts_with("whitted"), "{names:?}");
}

#[test]
fn the_study_can_be_saved() {
    let Some(browser) = opened() else { return };
    browser.click("#data a.button");
    let saved = browser.folder.path().join("study.json");
    let read = |path: &Path| serde_json::from_str::<Study>(&fs::read_to_string(path).unwrap()).unwrap();
    for _ in 0..100 {
        if saved.is_file() {
            break;
        }
        thread::sleep(Duration::from_millis(100));
    }
    assert_eq!(read(&saved), read(&Path::new(STUDY).join("study.json")));
}
