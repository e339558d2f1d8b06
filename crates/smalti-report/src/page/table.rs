//! The table of arms.

use maud::{Markup, html};
use smalti_measure::Repetitions;

use super::command::command;
use crate::figures::{front_number, marker};
use crate::findings::Finding;
use crate::groups::look;
use crate::numbers::{percent, significant};
use crate::record::{Arm, Study};
use crate::verdict::{Comparison, compare};

/// One arm with all that is told of it.
struct Row<'a> {
    finding: &'a Finding,
    arm: &'a Arm,
    /// Its place on the front.
    number: Option<usize>,
    /// Against the baseline.
    against: Option<Comparison>,
}

/// A column of figures.
struct Column {
    title: &'static str,
    cell: fn(&Row) -> Option<Cell>,
}

/// A figure: to sort by, to read, and its ends.
struct Cell {
    value: f64,
    text: String,
    ends: String,
}

const FIGURES: [Column; 4] = [
    Column { title: "seconds", cell: |row| Some(cell(&row.finding.seconds, |v| significant(v, 3))) },
    Column { title: "relative error", cell: |row| Some(cell(&row.finding.relative_error, percent)) },
    Column { title: "relmse", cell: |row| Some(cell(&row.finding.relmse, |v| significant(v, 3))) },
    Column { title: "efficiency", cell: |row| Some(cell(row.finding.efficiency.as_ref()?, |v| significant(v, 3))) },
];

const AGAINST: [Column; 3] = [
    Column { title: "× time", cell: |row| Some(cell(&row.against.as_ref()?.seconds, |v| significant(v, 3))) },
    Column { title: "× error", cell: |row| Some(cell(row.against.as_ref()?.error.as_ref()?, |v| significant(v, 3))) },
    Column {
        title: "× error² × time",
        cell: |row| Some(cell(row.against.as_ref()?.cost.as_ref()?, |v| significant(v, 3))),
    },
];

const STATED: Column = Column { title: "stated", cell: stated };

pub(super) fn section(study: &Study, findings: &[Finding]) -> Markup {
    if findings.is_empty() {
        return html! {};
    }
    let columns: Vec<&Column> = match study.baseline {
        Some(_) => FIGURES.iter().chain(&AGAINST).chain([&STATED]).collect(),
        None => FIGURES.iter().chain([&STATED]).collect(),
    };
    html! {
        section #arms {
            h2 { "All arms" }
            div.scroll tabindex="0" role="region" aria-label="Table of arms" {
                table.sortable {
                    (headings(study, &columns))
                    tbody { @for finding in findings { (row(study, findings, finding, &columns)) } }
                }
            }
            p.note {
                "Medians over repetitions, with the 95 % interval of the mean below (with fewer than three repetitions their range). "
                "Efficiency is 1 / (relmse × seconds). A number in a circle: on the Pareto front, 1 the fastest. "
                "Stated: the relative error that the renders stated without the reference, and in how many of them the "
                "stated 95 % interval holds the error that was found."
            }
        }
    }
}

fn headings(study: &Study, columns: &[&Column]) -> Markup {
    let baseline = study.baseline.and_then(|arm| study.arms.get(arm));
    html! {
        thead {
            @if let Some(baseline) = baseline {
                tr.over {
                    td colspan="5" {}
                    th colspan="3" scope="colgroup" { "against " (baseline.label) }
                    td {}
                }
            }
            tr {
                th scope="col" aria-sort="none" { button type="button" { "arm" } }
                @for column in columns {
                    th.figure scope="col" aria-sort="none" { button type="button" { (column.title) } }
                }
            }
        }
    }
}

fn row(study: &Study, findings: &[Finding], finding: &Finding, columns: &[&Column]) -> Markup {
    let row = Row {
        finding,
        arm: &study.arms[finding.arm],
        number: front_number(findings, finding),
        against: study.baseline.and_then(|baseline| compare(study, finding.arm, baseline, "")),
    };
    let is_baseline = study.baseline == Some(finding.arm);
    html! {
        tr id={ "arm-" (finding.arm) } data-arm=(finding.arm) class=[is_baseline.then_some("baseline")] {
            th scope="row" data-value=(row.arm.label) {
                (name(study, &row, is_baseline))
            }
            @for column in columns {
                @match (column.cell)(&row) {
                    Some(cell) => {
                        td.figure data-value=(cell.value) { (cell.text) small { (cell.ends) } }
                    }
                    None => { td.figure { "–" } }
                }
            }
        }
    }
}

fn name(study: &Study, row: &Row, is_baseline: bool) -> Markup {
    html! {
        svg.key viewBox="-8 -8 16 16" aria-hidden="true" {
            (marker(look(study, row.finding.arm), [0.0, 0.0], !row.arm.biases.is_empty()))
        }
        span.label { (row.arm.label) }
        @if let Some(number) = row.number { span.front title="on the Pareto front" { (number) } }
        @if is_baseline { span.tag { "baseline" } }
        @if !row.arm.biases.is_empty() { span.tag.biased { "biased" } }
        (settings(row.arm))
    }
}

/// Knobs, biases and command of an arm; the chart shows the same of the marker that is pointed at.
fn settings(arm: &Arm) -> Markup {
    html! {
        details.settings {
            summary { "settings" }
            div.about {
                @for bias in &arm.biases { p.bias { "Biased: " (bias) } }
                ul.knobs { @for (name, value) in &arm.knobs { li { (name) " " b { (value) } } } }
                (command(&arm.command))
            }
        }
    }
}

fn cell(found: &Repetitions, words: fn(f64) -> String) -> Cell {
    let ends = match found.count {
        1 => "1 run".into(),
        _ => format!("{} to {}", words(found.low).trim_end_matches(" %"), words(found.high)),
    };
    Cell { value: found.median, text: words(found.median), ends }
}

fn stated(row: &Row) -> Option<Cell> {
    let stated = row.finding.stated?;
    let bounds = match stated.lower_bounds {
        0 => String::new(),
        count => format!(", {count} a lower bound"),
    };
    Some(Cell {
        value: stated.relative_error,
        text: percent(stated.relative_error),
        ends: format!("holds in {} of {}{bounds}", stated.held, stated.runs),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    #[test]
    fn every_arm_has_a_row_with_every_figure() {
        let study = fixture::sweep();
        let text = section(&study, &findings(&study)).into_string();
        assert_eq!(text.matches("<tr id=").count(), 5);
        assert_eq!(text.matches("<td class=\"figure\"").count(), 5 * 8);
        // The first of auto: 0.2 s by 0.1 s, 0.1 by 0.4, (1/4)² × 2.
        for ratio in ["2.00", "0.250", "0.125"] {
            assert!(text.contains(&format!(">{ratio}<small>{ratio} to {ratio}")), "{ratio} in {text}");
        }
        assert!(text.contains("<b>path</b>") && text.contains("paths end after 4 events"));
    }

    #[test]
    fn without_a_baseline_nothing_is_compared() {
        let mut study = fixture::sweep();
        study.baseline = None;
        let text = section(&study, &findings(&study)).into_string();
        assert!(!text.contains("× time") && text.matches("<td class=\"figure\"").count() == 5 * 5);
    }

    #[test]
    fn one_run_has_no_ends() {
        let mut study = fixture::sweep();
        study.runs.truncate(5);
        let text = section(&study, &findings(&study)).into_string();
        assert!(text.contains("0.0980<small>1 run</small>"), "{text}");
    }
}
