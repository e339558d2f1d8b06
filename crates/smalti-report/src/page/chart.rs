//! Error against time, and what is told of the arm that is pointed at.

use maud::{Markup, html};

use crate::figures::{ERROR, Metric, NARROW, RELMSE, WIDE, error_time, front_size};
use crate::findings::Finding;
use crate::record::Study;

pub(super) fn section(study: &Study, findings: &[Finding]) -> Markup {
    if findings.is_empty() {
        return html! {};
    }
    html! {
        section #chart {
            h2 { "Error against time" }
            fieldset.switch {
                legend { "Error as" }
                @for (metric, words) in [(&ERROR, "relative error"), (&RELMSE, "relmse")] {
                    label {
                        input type="radio" name="metric" value=(metric.name) checked[metric.name == ERROR.name];
                        (words)
                    }
                }
            }
            @for metric in [&ERROR, &RELMSE] { (plots(study, findings, metric)) }
            p.note {
                "Both axes are logarithmic; down and left is better. A marker is the median, its lines are the 95 % interval of the mean "
                "over repetitions (with fewer than three their range). The broad line is the Pareto front: below it nothing was found. "
                "Thin lines join arms of a group that differ in one knob. Hollow: biased." (of_size(study))
            }
            div #about aria-live="polite" { p.note.live { "Point at a marker, or reach it with Tab, for its settings and command." } }
        }
    }
}

/// The plot for wide and for narrow screens; style shows one.
fn plots(study: &Study, findings: &[Finding], metric: &Metric) -> Markup {
    html! {
        figure class={ "plot " (metric.name) } {
            div.wide { (error_time(study, findings, metric, WIDE)) }
            div.narrow { (error_time(study, findings, metric, NARROW)) }
        }
    }
}

/// Errors of pixels of different sizes do not compare: each size has a front of its own.
fn of_size(study: &Study) -> String {
    let [width, height] = front_size(study);
    match study.arms.iter().all(|arm| arm.size == [width, height]) {
        true => String::new(),
        false => format!(" The line is that of images of {width} × {height}; each size has a front of its own."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    #[test]
    fn fronts_of_several_sizes_are_told_apart() {
        let mut study = fixture::sweep();
        let told = |study: &Study| section(study, &findings(study)).into_string().contains("a front of its own");
        assert!(!told(&study));
        study.arms[1].size = [8, 8];
        assert!(told(&study));
    }
}
