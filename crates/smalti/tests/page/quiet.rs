//! Nothing is loaded, nothing is complained about.

use std::fs;

use crate::browser::Browser;
use crate::{opened, write};

#[test]
fn the_page_asks_nobody_and_nothing_fails() {
    let Some(browser) = opened() else { return };
    assert_eq!(browser.complaints(), Vec::<String>::new());
    let requests = browser.requests();
    let page = format!("file://{}", browser.folder.path().join("page.html").display());
    assert!(requests.contains(&page), "{requests:?}");
    // The browser's own first page is made of what begins with chrome:, which no other page can ask for.
    let inside = |url: &String| *url == page || url.starts_with("data:") || url.starts_with("chrome:");
    let foreign: Vec<_> = requests.iter().filter(|url| !inside(url)).collect();
    assert!(foreign.is_empty(), "{foreign:?}");
}

#[test]
fn the_policy_forbids_what_comes_from_elsewhere() {
    let Some(browser) = Browser::start() else { return };
    let page = browser.folder.path().join("page.html");
    write(&page);
    let foreign = "<img src=\"http://127.0.0.1:9/a.png\"><script src=\"http://127.0.0.1:9/a.js\"></script></main>";
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.contains("</main>"));
    fs::write(&page, text.replace("</main>", foreign)).unwrap();
    browser.open(&page);
    let complaints = browser.complaints();
    for part in ["a.png", "a.js"] {
        let named = |text: &&String| text.contains(part) && text.contains("Content Security Policy");
        assert!(complaints.iter().any(|text| named(&text)), "{part}: {complaints:?}");
    }
}
