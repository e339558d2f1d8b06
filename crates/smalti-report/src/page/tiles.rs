//! Where the time went: the tiles of an arm's first repetition.

use maud::{Markup, html};

use crate::figures::{balance, heat, milliseconds, tile_map, tiles_of};
use crate::numbers::{counted, times};
use crate::record::Study;

pub(super) fn section(study: &Study) -> Markup {
    let arms: Vec<usize> = (0..study.arms.len()).filter(|&arm| !tiles_of(study, arm).is_empty()).collect();
    let Some(&first) = arms.first() else {
        return html! {};
    };
    let shown = study.baseline.filter(|arm| arms.contains(arm)).unwrap_or(first);
    html! {
        section #tiles {
            h2 { "Time in each tile" }
            label.live { "Of " select {
                @for &arm in &arms { option value=(arm) selected[arm == shown] { (study.arms[arm].label) } }
            } }
            @for &arm in &arms { (map(study, arm, arm == shown)) }
            p.scale { "0 " span.ramp style=(ramp()) {} " the slowest tile's time" }
        }
    }
}

fn map(study: &Study, arm: usize, shown: bool) -> Markup {
    html! {
        figure.tiles data-arm=(arm) hidden[!shown] {
            @if let Some(map) = tile_map(study, arm) { (map) }
            figcaption { b { (study.arms[arm].label) } ": " (words(study, arm)) }
        }
    }
}

/// The slowest tile, and how it stands to the others.
fn words(study: &Study, arm: usize) -> String {
    let Some(found) = balance(tiles_of(study, arm)) else { return String::new() };
    let [x, y, width, height] = found.slowest.area;
    let ratio = match found.median > 0.0 {
        true => format!(", {} the median", times(found.slowest.seconds / found.median)),
        false => String::new(),
    };
    format!(
        "the slowest of {} is the one at column {x}, row {y} ({width} × {height}, outlined): {}{ratio}; \
         least {}, median {}",
        counted(found.count, "tile"),
        milliseconds(found.slowest.seconds),
        milliseconds(found.least),
        milliseconds(found.median)
    )
}

fn ramp() -> String {
    let stops: Vec<String> = (0..=5).map(|step| heat(f64::from(step) / 5.0)).collect();
    format!("background:linear-gradient(90deg,{})", stops.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn each_arm_has_a_map_and_the_baselines_is_shown() {
        let mut study = fixture::sweep();
        study.baseline = Some(2);
        let text = section(&study).into_string();
        assert_eq!((text.matches("<figure").count(), text.matches(" hidden>").count()), (5, 4));
        assert!(text.contains("data-arm=\"2\">") && text.contains("<option value=\"2\" selected>"), "{text}");
    }

    #[test]
    fn words_name_the_slowest() {
        let expected = "the slowest of 4 tiles is the one at column 40, row 30 (40 × 30, outlined): 39.2 ms, \
                        1.6× the median; least 9.80 ms, median 24.5 ms";
        assert_eq!(words(&fixture::sweep(), 0), expected);
    }
}
