//! The page on a phone, in the dark, on paper and without scripts.

use serde_json::json;

use crate::browser::Browser;
use crate::{ARMS, opened};

fn media(browser: &Browser, media: &str, scheme: &str) {
    let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
    browser.devtools("Emulation.setEmulatedMedia", &json!({ "media": media, "features": features }));
}

#[test]
fn a_phone_shows_all_within_its_width() {
    let Some(browser) = opened() else { return };
    let phone = json!({ "width": 375, "height": 800, "deviceScaleFactor": 2, "mobile": true });
    browser.devtools("Emulation.setDeviceMetricsOverride", &phone);
    assert_eq!(browser.number("innerWidth"), 375.0);
    assert!(browser.number("document.documentElement.scrollWidth") <= 375.0);
    assert_eq!((browser.visible(".narrow g.arm"), browser.visible(".wide g.arm")), (ARMS, 0.0));
    // Letters of the chart are as large as they were drawn, or nearly.
    let letters = browser.number("document.querySelector('.narrow text').getBoundingClientRect().height");
    assert!(letters > 11.0, "{letters}");
}

#[test]
fn the_scheme_is_that_of_the_reader() {
    let Some(browser) = opened() else { return };
    let ground = || browser.value("getComputedStyle(document.body).backgroundColor");
    media(&browser, "screen", "light");
    let ink = || browser.value("getComputedStyle(document.querySelector('.chart .ink')).fill");
    let light = [ground(), ink()];
    media(&browser, "screen", "dark");
    assert_eq!([light[0].as_str(), ground().as_str()], [Some("rgb(255, 255, 255)"), Some("rgb(20, 24, 27)")]);
    assert_ne!(light[1], ink());
    media(&browser, "print", "dark");
    assert_eq!([ground(), ink()], light);
}

#[test]
fn paper_has_no_controls() {
    let Some(browser) = opened() else { return };
    let controls = "select, input, .gallery, a.button";
    assert!(browser.visible(controls) > 0.0);
    media(&browser, "print", "light");
    assert_eq!(
        (browser.visible(controls), browser.visible("#arms tbody tr"), browser.visible("g.arm")),
        (0.0, ARMS, ARMS)
    );
}

#[test]
fn without_scripts_tables_chart_and_pictures_are_there() {
    let Some(browser) = opened() else { return };
    browser.devtools("Emulation.setScriptExecutionDisabled", &json!({ "value": true }));
    browser.open(&browser.folder.path().join("page.html"));
    assert_eq!((browser.visible("g.arm"), browser.visible("#arms tbody tr")), (ARMS, ARMS));
    assert_eq!((browser.visible(".live"), browser.visible("#tiles figure")), (0.0, 1.0));
    browser.click("#compare summary");
    assert_eq!(browser.visible("#compare img.picture"), ARMS + 1.0);
    assert_eq!(browser.visible("#data a.button"), 1.0);
}

#[test]
fn everything_can_be_reached_by_keys() {
    let Some(browser) = opened() else { return };
    let reachable = browser.number(
        "[...document.querySelectorAll('g.arm, .divider, .stage, select, input, button, summary, a, .scroll')]
         .filter(e => e.checkVisibility() && e.tabIndex < 0).length",
    );
    assert_eq!(reachable, 0.0);
    let nameless = browser.number(
        "[...document.querySelectorAll('img')].filter(i => !i.hasAttribute('alt')).length
         + [...document.querySelectorAll('select, input')].filter(e => !e.closest('label')).length",
    );
    assert_eq!(nameless, 0.0);
}
