//! The page of a study in a real browser: it asks nobody for anything, and everything in it works.

mod browser;
mod chart;
mod compare;
mod quiet;
mod reach;
mod table;

use std::path::Path;
use std::process::Command;

use browser::Browser;

/// The study whose page is tested: nine arms with three repetitions each.
const STUDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/study");

/// Arms of the study.
const ARMS: f64 = 9.0;

/// A browser that shows the page of the study, if there is a browser.
fn opened() -> Option<Browser> {
    let browser = Browser::start()?;
    let page = browser.folder.path().join("page.html");
    write(&page);
    browser.open(&page);
    Some(browser)
}

fn write(page: &Path) {
    let mut program = Command::new(env!("CARGO_BIN_EXE_smalti"));
    let status = program.args(["report", STUDY, "-q", "-o"]).arg(page).status().unwrap();
    assert!(status.success());
}
