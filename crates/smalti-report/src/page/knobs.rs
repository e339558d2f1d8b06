//! What each knob costs, in words and drawn.

use maud::{Markup, html};

use crate::figures::{NARROW, WIDE, knob_costs};
use crate::knobs::{cost, headline, judgement, price, within};
use crate::record::Study;
use crate::verdict::{Comparison, Verdict};

pub(super) fn section(study: &Study, comparisons: &[Comparison]) -> Markup {
    if comparisons.is_empty() {
        return html! {};
    }
    html! {
        section #knobs {
            h2 { "What each knob costs" }
            p.note {
                (against(study)) " Worth it is what lowers error² × time: at the same number of seconds it has the smaller error. "
                "An interval of 95 % stands behind each verdict; one in twenty is wrong by chance."
            }
            ul.verdicts { @for comparison in comparisons { (item(study, comparison)) } }
            figure.plot {
                @for (class, width) in [("wide", WIDE), ("narrow", NARROW)] {
                    @if let Some(figure) = knob_costs(study, comparisons, width) { div class=(class) { (figure) } }
                }
            }
        }
    }
}

/// What arms are compared with.
fn against(study: &Study) -> String {
    match study.baseline.and_then(|arm| study.arms.get(arm)) {
        Some(arm) => format!("Each against {}, unless another arm is named.", arm.label),
        None => "Each arm against the best of those that differ from it in one knob.".into(),
    }
}

fn item(study: &Study, comparison: &Comparison) -> Markup {
    html! {
        li class=(class(&comparison.verdict)) {
            strong { (headline(study, comparison)) } ": " (price(comparison)) "; "
            em { (judgement(comparison)) }
            @if let Some(cost) = cost(comparison) { small { "error² × time " (cost) } }
            @if let Some(label) = within(study, comparison) { small { "of " (label) } }
        }
    }
}

fn class(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Worth => "better",
        Verdict::NotWorth => "worse",
        Verdict::Biased(_) => "biased",
        _ => "open",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::verdict::comparisons;

    #[test]
    fn every_comparison_is_said_with_its_verdict() {
        let study = fixture::sweep();
        let text = section(&study, &comparisons(&study)).into_string();
        assert_eq!(text.matches("<li class").count(), 3);
        assert!(text.contains("<li class=\"better\"><strong>auto instead of path</strong>: 2.0× the time"), "{text}");
        assert!(text.contains("Each against path, path, 4, unless"));
    }
}
