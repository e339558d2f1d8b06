//! What each knob costs: error² × time by that of the arm that it is compared with, each with its interval.

use maud::{Markup, html};

use super::ink::{Anchor, LINE, faint_line, points, round, strong_line, svg, text};
use super::plot::label;
use crate::axis::Axis;
use crate::knobs::headline;
use crate::record::Study;
use crate::verdict::{Comparison, Verdict};

/// Height of a row with its heading.
const ROW: f64 = 42.0;
const SIDE: f64 = 16.0;

/// A row for each comparison that has a figure; `None` if there is none.
pub(crate) fn knob_costs(study: &Study, comparisons: &[Comparison], width: f64) -> Option<Markup> {
    let rows: Vec<(&Comparison, [f64; 3])> = comparisons
        .iter()
        .filter(|found| !matches!(found.verdict, Verdict::OtherSize))
        .filter_map(|found| found.cost.map(|cost| (found, [cost.low, cost.median, cost.high])))
        .collect();
    if rows.is_empty() {
        return None;
    }
    let axis = Axis::around(rows.iter().flat_map(|(_, ends)| *ends).chain([1.0]));
    let bottom = ROW * rows.len() as f64 + 8.0;
    let x = |value: f64| SIDE + axis.place(value) * (width - 2.0 * SIDE);
    let content = html! {
        @for tick in axis.ticks().into_iter().filter(|tick| tick.labelled) {
            (faint_line([x(tick.value), 0.0], [x(tick.value), bottom]))
            (text(x(tick.value), bottom + 16.0, Anchor::Middle, &label(tick.value)))
        }
        (strong_line([x(1.0), 0.0], [x(1.0), bottom]))
        @for (index, (comparison, ends)) in rows.iter().enumerate() {
            (row(&headline(study, comparison), comparison, ends.map(x), ROW * (index + 1) as f64 - 8.0))
        }
        (text(width / 2.0, bottom + 34.0, Anchor::Middle, "error² × time by that of the other: left of 1 is better"))
    };
    Some(svg(width, bottom + 34.0 + LINE / 2.0, "What each knob costs", "costs", &content))
}

fn row(words: &str, comparison: &Comparison, [low, middle, high]: [f64; 3], y: f64) -> Markup {
    let (class, colour) = match comparison.verdict {
        Verdict::Worth => ("better", "#0067a5"),
        Verdict::NotWorth => ("worse", "#c44e00"),
        _ => ("open", "#6b7780"),
    };
    html! {
        g class={ "knob " (class) } {
            (text(SIDE, y - 14.0, Anchor::Start, words))
            polyline points=(points(&[[low, y], [high, y]])) fill="none" stroke=(colour) stroke-width="3" {}
            circle cx=(round(middle)) cy=(round(y)) r="5" fill=(colour) {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::verdict::comparisons;

    #[test]
    fn every_comparison_with_a_figure_has_a_row() {
        let mut study = fixture::sweep();
        let rows = |study: &Study| {
            let drawn = knob_costs(study, &comparisons(study), 500.0)?.into_string();
            Some((drawn.matches("knob better").count(), drawn.matches("knob open").count()))
        };
        assert_eq!(rows(&study), Some((1, 2)));
        study.runs.iter_mut().for_each(|run| run.relative_error = 0.0);
        assert_eq!(rows(&study), None);
    }
}
