//! What stands below the chart: groups with their markers, and the members of the Pareto front by number.

use maud::{Markup, html};

use super::ink::{Anchor, LINE, text, text_width};
use super::marker::marker;
use crate::findings::{Finding, front_by_time};
use crate::groups::groups;
use crate::record::Study;

/// The groups with their markers, then the front's members by number; and its height.
pub(super) fn legend(study: &Study, findings: &[Finding], width: f64, top: f64) -> (Markup, f64) {
    const INDENT: f64 = 22.0;
    let (mut x, mut y) = (INDENT, top);
    let mut entries = Vec::new();
    for (name, look) in groups(study) {
        let needed = INDENT + text_width(name) + 14.0;
        if x > INDENT && x + needed > width {
            (x, y) = (INDENT, y + LINE);
        }
        entries.push((look, name, [x, y]));
        x += needed;
    }
    let members: Vec<String> = front_by_time(findings).iter().map(|finding| front_words(study, finding)).collect();
    let head = "On the Pareto front, the fastest first:";
    let names = y + 1.4 * LINE;
    let markup = html! {
        @for (look, name, [x, y]) in entries {
            (marker(look, [x, y - 4.0], false))
            (text(x + 12.0, y, Anchor::Start, name))
        }
        (text(INDENT - 6.0, names, Anchor::Start, head))
        @for (index, member) in members.iter().enumerate() {
            (text(INDENT - 6.0, names + LINE * (index + 1) as f64, Anchor::Start, &format!("{}: {member}", index + 1)))
        }
    };
    (markup, names + LINE * members.len() as f64 + LINE - top)
}

fn front_words(study: &Study, finding: &Finding) -> String {
    let biased = if study.arms[finding.arm].biases.is_empty() { "" } else { " (biased)" };
    format!("{}{biased}", study.arms[finding.arm].label)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    #[test]
    fn the_front_is_named_from_the_fastest_on() {
        let study = fixture::sweep();
        let (drawn, _) = legend(&study, &findings(&study), 760.0, 0.0);
        let text = drawn.into_string();
        let names = ["1: path, path, 4 (biased)", "2: auto, auto, 4", "3: auto, auto, 16"];
        let places: Vec<usize> = names.iter().map(|name| text.find(name).expect(name)).collect();
        assert!(places.is_sorted());
    }

    #[test]
    fn groups_that_do_not_fit_begin_a_line() {
        let mut study = fixture::sweep();
        study.arms.iter_mut().enumerate().for_each(|(index, arm)| arm.group = format!("group number {index}"));
        let height = |width| legend(&study, &findings(&study), width, 0.0).1;
        assert!((height(200.0) - height(2000.0) - 4.0 * LINE).abs() < 1e-9);
    }
}
