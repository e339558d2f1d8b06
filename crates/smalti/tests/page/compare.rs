//! Two pictures under one slider.

use crate::browser::Browser;
use crate::opened;

/// Left, top, width and height of something within the stage.
fn place(browser: &Browser, selector: &str) -> [f64; 4] {
    let of = format!(
        "(() => {{ const stage = document.querySelector('.stage').getBoundingClientRect();
         const box = document.querySelector('{selector}').getBoundingClientRect();
         return [box.x - stage.x, box.y - stage.y, box.width, box.height]; }})()"
    );
    serde_json::from_value(browser.value(&of)).unwrap()
}

/// What is cut off the right picture at its left, percent.
fn clip(browser: &Browser) -> f64 {
    let path = browser.value("getComputedStyle(document.querySelector('.layer.right')).clipPath");
    let path = path.as_str().unwrap().to_owned();
    let inset = path.trim_start_matches("inset(0px 0px 0px ").trim_end_matches("%)");
    inset.parse().unwrap_or_else(|_| panic!("{path}"))
}

fn sources(browser: &Browser) -> [String; 2] {
    let of = |side| browser.value(&format!("document.querySelector('.layer.{side} img').src"));
    ["left", "right"].map(|side| of(side).as_str().unwrap().to_owned())
}

#[test]
fn the_worst_and_the_best_are_shown_at_first() {
    let Some(browser) = opened() else { return };
    let figures = browser.value(
        "[...document.querySelectorAll('#arms tbody tr')].sort((a, b) => b.cells[2].dataset.value - a.cells[2].dataset.value)
         .map(row => row.querySelector('.label').textContent)",
    );
    let captions = browser.texts(".stage .caption");
    assert_eq!((&figures[0], &figures[8]), (&captions[0].as_str().into(), &captions[1].as_str().into()));
    assert_eq!(
        browser.number("[...document.querySelectorAll('.stage img')].filter(i => i.naturalWidth === 48).length"),
        2.0
    );
}

#[test]
fn the_divider_moves_by_keys_and_clips() {
    let Some(browser) = opened() else { return };
    assert_eq!(clip(&browser), 50.0);
    browser.press(".divider", "\u{e014}\u{e014}\u{e014}");
    assert_eq!((clip(&browser), browser.value("document.querySelector('.divider').ariaValueNow")), (56.0, "56".into()));
    browser.press(".divider", "\u{e011}");
    assert_eq!(clip(&browser), 0.0);
    browser.press(".divider", "\u{e012}");
    assert_eq!(clip(&browser), 0.0);
    browser.press(".divider", "\u{e010}");
    assert_eq!(clip(&browser), 100.0);
}

#[test]
fn the_divider_follows_the_pointer() {
    let Some(browser) = opened() else { return };
    let [.., width, _] = place(&browser, ".stage");
    browser.drag(".divider", [(width / 4.0) as i32, 0]);
    assert!((clip(&browser) - 75.0).abs() < 0.5, "{}", clip(&browser));
    let [left, ..] = place(&browser, ".divider");
    assert!((left + 18.0 - 0.75 * width).abs() < 2.0, "{left} of {width}");
}

#[test]
fn both_pictures_are_enlarged_and_moved_in_step() {
    let Some(browser) = opened() else { return };
    let both = || {
        let [left, right] = ["left", "right"].map(|side| place(&browser, &format!(".layer.{side} img")));
        assert_eq!(left, right);
        left
    };
    let [x, y, width, height] = both();
    assert_eq!((x, y), (0.0, 0.0));
    browser.click("#compare label:has([name=zoom][value=\"4\"])");
    // The middle stays in the middle.
    assert_eq!(both(), [-1.5 * width, -1.5 * height, 4.0 * width, 4.0 * height]);
    // The divider gives way.
    browser.press(".divider", "\u{e011}");
    browser.drag(".stage .layer.left", [60, 40]);
    let moved = both();
    assert!(
        (moved[0] - (60.0 - 1.5 * width)).abs() < 1.0 && (moved[1] - (40.0 - 1.5 * height)).abs() < 1.0,
        "{moved:?}"
    );
    browser.press(".stage", "8\u{e012}");
    let [left, _, wide, _] = both();
    assert_eq!(wide, 8.0 * width);
    assert_eq!(browser.value("document.querySelector('[name=zoom]:checked').value"), "8");
    // Nothing but pictures is to be seen.
    browser.drag(".stage .layer.left", [400, 0]);
    browser.press(".stage", &"\u{e012}".repeat(400));
    assert!(both()[0] == 0.0 && left < 0.0);
    browser.press(".stage", "1");
    assert_eq!(both(), [0.0, 0.0, width, height]);
}

#[test]
fn pixels_stay_pixels() {
    let Some(browser) = opened() else { return };
    let rendering = browser.value("getComputedStyle(document.querySelector('.layer img')).imageRendering");
    assert_eq!(rendering, "pixelated");
}

#[test]
fn any_two_pictures_can_be_chosen_and_their_differences_shown() {
    let Some(browser) = opened() else { return };
    browser.click("select[name=left] option[value='reference-0']");
    browser.click("select[name=right] option[value='picture-7']");
    let of = |id: &str, class| {
        let found = browser.value(&format!("document.querySelector('#{id} .{class}').src"));
        found.as_str().unwrap().to_owned()
    };
    assert_eq!(sources(&browser), [of("reference-0", "picture"), of("picture-7", "picture")]);
    browser.click("[name=differences]");
    assert_eq!(sources(&browser), [of("reference-0", "picture"), of("picture-7", "difference")]);
    assert_eq!(browser.visible(".scale-note"), 1.0);
    assert!(browser.texts(".caption.right")[0].starts_with("difference: "));
}
