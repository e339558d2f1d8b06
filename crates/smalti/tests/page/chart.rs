//! Error against time, and the tiles.

use crate::{ARMS, opened};

#[test]
fn every_arm_is_a_point_of_both_measures() {
    let Some(browser) = opened() else { return };
    assert_eq!(browser.visible("#chart .relative-error g.arm"), ARMS);
    assert_eq!(browser.visible("#chart g.arm"), ARMS);
    browser.click("#chart label:has([value=relmse])");
    assert_eq!(browser.visible("#chart .relmse g.arm"), ARMS);
    assert_eq!(browser.visible("#chart g.arm"), ARMS);
}

#[test]
fn points_stand_where_their_figures_say() {
    let Some(browser) = opened() else { return };
    // In the table's order of seconds the points stand from left to right.
    let order = browser.value(
        "[...document.querySelectorAll('#arms tbody tr')].sort((a, b) => \
         a.cells[1].dataset.value - b.cells[1].dataset.value).map(row => \
         document.querySelector(`.relative-error .wide [data-arm=\"${row.dataset.arm}\"] path`).getBoundingClientRect())
         .map(box => box.x + box.width / 2)",
    );
    let places: Vec<f64> = serde_json::from_value(order).unwrap();
    assert!(places.len() == ARMS as usize && places.is_sorted(), "{places:?}");
}

#[test]
fn a_point_tells_its_settings_and_command() {
    let Some(browser) = opened() else { return };
    assert!(!browser.texts("#about")[0].contains("smalti render"));
    browser.value("document.querySelector('.wide [data-arm=\"6\"]').focus()");
    let about = &browser.texts("#about")[0];
    assert!(about.contains("auto, 32 spp, 1 shadow ray") && about.contains("--integrator auto --spp 32"), "{about}");
    assert_eq!(browser.value("document.querySelector('#arms .told').id"), "arm-6");
    browser.drag(".wide [data-arm=\"8\"] path", [0, 0]);
    assert!(browser.texts("#about")[0].contains("Biased: whitted has no indirect diffuse light"));
}

#[test]
fn tiles_are_those_of_the_arm_that_is_chosen() {
    let Some(browser) = opened() else { return };
    let shown =
        || browser.value("[...document.querySelectorAll('#tiles figure:not([hidden])')].map(f => f.dataset.arm)");
    assert_eq!(shown(), serde_json::json!(["3"]));
    browser.click("#tiles option[value='7']");
    assert_eq!(shown(), serde_json::json!(["7"]));
    // 48 × 36 pixels in tiles of 16.
    assert_eq!(browser.visible("#tiles rect:not(.slowest)"), 9.0);
}
