//! Error against time: every arm with its intervals, curves through arms of a group, the Pareto front.

use maud::{Markup, html};
use smalti_measure::Repetitions;

use super::ink::{Anchor, LINE, points, round, svg, text};
use super::legend::legend;
use super::marker::marker;
use super::plot::Plot;
use crate::axis::Axis;
use crate::findings::{Finding, front_by_time};
use crate::front::front;
use crate::groups::{Look, curves, look};
use crate::numbers::{percent, seconds, significant};
use crate::record::Study;

/// A measure of error on the vertical axis.
pub(crate) struct Metric {
    /// Its name as a class.
    pub name: &'static str,
    /// For people.
    pub title: &'static str,
    pub of: fn(&Finding) -> Repetitions,
    pub words: fn(f64) -> String,
    /// What values are multiplied with on the axis.
    scale: f64,
}

/// Relative error in percent.
pub(crate) const ERROR: Metric = Metric {
    name: "relative-error",
    title: "relative error, %",
    of: |finding| finding.relative_error,
    words: percent,
    scale: 100.0,
};

/// relmse.
pub(crate) const RELMSE: Metric =
    Metric { name: "relmse", title: "relmse", of: |finding| finding.relmse, words: |v| significant(v, 3), scale: 1.0 };

/// The chart, `width` wide, with its legend.
pub(crate) fn error_time(study: &Study, findings: &[Finding], metric: &Metric, width: f64) -> Markup {
    let plot = Plot::new(axis(findings, |f| f.seconds, 1.0), axis(findings, metric.of, metric.scale), width);
    let chart = Chart { study, findings, metric, plot };
    let (legend, legend_height) = legend(study, findings, width, chart.plot.height() + LINE);
    let content = html! {
        (chart.plot.frame(["render time, seconds", metric.title]))
        (chart.front_line())
        @for curve in curves(study, findings) { (chart.curve(&curve)) }
        @for finding in findings { (chart.arm(finding)) }
        (legend)
    };
    let label = format!("{} against render time of {}", metric.title, study.scene);
    svg(width, chart.plot.height() + LINE + legend_height, &label, "chart", &content)
}

fn axis(findings: &[Finding], of: fn(&Finding) -> Repetitions, scale: f64) -> Axis {
    let ends = findings.iter().map(of).flat_map(|found| [found.low, found.median, found.high]);
    Axis::around(ends.map(|value| scale * value))
}

struct Chart<'a> {
    study: &'a Study,
    findings: &'a [Finding],
    metric: &'a Metric,
    plot: Plot,
}

impl Chart<'_> {
    fn place(&self, seconds: f64, error: f64) -> [f64; 2] {
        self.plot.place([seconds, self.metric.scale * error])
    }

    fn middle(&self, finding: &Finding) -> [f64; 2] {
        self.place(finding.seconds.median, (self.metric.of)(finding).median)
    }

    /// The steps below which nothing was found.
    fn front_line(&self) -> Markup {
        let same = |finding: &&Finding| self.study.arms[finding.arm].size == front_size(self.study);
        let places: Vec<[f64; 2]> = self.findings.iter().filter(same).map(|finding| self.middle(finding)).collect();
        // On the screen more error is up, and up is a smaller number.
        let on_front = front(&places.iter().map(|[x, y]| [*x, -*y]).collect::<Vec<_>>());
        let mut front: Vec<[f64; 2]> = places.into_iter().zip(on_front).filter(|(_, on)| *on).map(|(p, _)| p).collect();
        front.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut steps: Vec<[f64; 2]> = front.windows(2).flat_map(|pair| [pair[0], [pair[1][0], pair[0][1]]]).collect();
        steps.extend(front.last());
        html! {
            @if steps.len() > 1 {
                polyline class="front" points=(points(&steps)) fill="none" stroke="#c9d2d9" stroke-width="7"
                    stroke-linejoin="round" stroke-linecap="round" {}
            }
        }
    }

    fn curve(&self, curve: &[&Finding]) -> Markup {
        let look = look(self.study, curve[0].arm);
        let places: Vec<[f64; 2]> = curve.iter().map(|finding| self.middle(finding)).collect();
        html! {
            polyline class={ "curve " (look.class()) } points=(points(&places)) fill="none" stroke=(look.colour())
                stroke-width="1.3" stroke-opacity="0.75" {}
        }
    }

    fn arm(&self, finding: &Finding) -> Markup {
        let arm = &self.study.arms[finding.arm];
        let look = look(self.study, finding.arm);
        let middle = self.middle(finding);
        let number = front_number(self.findings, finding);
        html! {
            g class={ "arm " (look.class()) } data-arm=(finding.arm) tabindex="0" role="img"
                aria-label=(self.words(finding)) {
                title { (self.words(finding)) }
                // A larger place to point at.
                circle cx=(round(middle[0])) cy=(round(middle[1])) r="13" fill="#ffffff" fill-opacity="0" {}
                (self.intervals(finding, look))
                (marker(look, middle, !arm.biases.is_empty()))
                @if let Some(number) = number { (self.number(number, middle)) }
            }
        }
    }

    /// Below the marker, where nothing is; above it where the number of the member before stands there.
    fn number(&self, number: usize, [x, y]: [f64; 2]) -> Markup {
        const NEAR: f64 = 22.0;
        let before = number.checked_sub(2).map(|index| self.middle(front_by_time(self.findings)[index]));
        let crowded = before.is_some_and(|[u, v]| (x - u).abs() < NEAR && (y - v).abs() < NEAR);
        let ([right, down], anchor) = if crowded { ([8.0, -9.0], Anchor::Start) } else { ([-8.0, 17.0], Anchor::End) };
        text(x + right, y + down, anchor, &number.to_string())
    }

    /// A line in each direction, from end to end.
    fn intervals(&self, finding: &Finding, look: Look) -> Markup {
        let (seconds, error) = (finding.seconds, (self.metric.of)(finding));
        let lines = [
            [self.place(seconds.low, error.median), self.place(seconds.high, error.median)],
            [self.place(seconds.median, error.low), self.place(seconds.median, error.high)],
        ];
        html! {
            @for line in lines {
                polyline class={ "interval " (look.class()) } points=(points(&line)) fill="none" stroke=(look.colour())
                    stroke-width="2" {}
            }
        }
    }

    fn words(&self, finding: &Finding) -> String {
        let arm = &self.study.arms[finding.arm];
        let error = (self.metric.words)((self.metric.of)(finding).median);
        let biased = if arm.biases.is_empty() { "" } else { ", biased" };
        format!("{}: {}, {} {error}{biased}", arm.label, seconds(finding.seconds.median), plain_title(self.metric))
    }
}

/// The size of image whose front is drawn: that of the baseline, or of the first arm.
pub(crate) fn front_size(study: &Study) -> [u32; 2] {
    study.arms.get(study.baseline.unwrap_or(0)).map_or([0, 0], |arm| arm.size)
}

fn plain_title(metric: &Metric) -> &'static str {
    metric.title.split(',').next().unwrap_or_default()
}

/// The number that a member of the front has in figures: 1 for the fastest.
pub(crate) fn front_number(findings: &[Finding], finding: &Finding) -> Option<usize> {
    front_by_time(findings).iter().position(|member| member.arm == finding.arm).map(|index| index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    fn drawn(study: &Study) -> String {
        error_time(study, &findings(study), &ERROR, 760.0).into_string()
    }

    #[test]
    fn every_measured_arm_is_a_point() {
        let mut study = fixture::sweep();
        assert_eq!(drawn(&study).matches("data-arm").count(), 5);
        study.runs.truncate(3);
        assert_eq!(drawn(&study).matches("data-arm").count(), 3);
    }

    #[test]
    fn what_is_biased_is_hollow() {
        assert_eq!(drawn(&fixture::sweep()).matches("marker hollow").count(), 1);
    }

    #[test]
    fn twice_the_time_is_the_same_way_everywhere() {
        let study = fixture::sweep();
        let found = findings(&study);
        let plot = Plot::new(axis(&found, |f| f.seconds, 1.0), axis(&found, ERROR.of, ERROR.scale), 760.0);
        let chart = Chart { study: &study, findings: &found, metric: &ERROR, plot };
        // path: 0.1 s, 0.4 s and 1.6 s with 40 %, 20 % and 10 %.
        let [a, b, c] = [0, 1, 2].map(|index| chart.middle(&found[index]));
        assert!((b[0] - a[0] - (c[0] - b[0])).abs() < 1e-9 && (b[1] - a[1] - (c[1] - b[1])).abs() < 1e-9);
        assert!(b[0] > a[0] && b[1] > a[1]);
    }

    #[test]
    fn an_error_without_a_logarithm_stands_at_the_lower_edge() {
        let mut study = fixture::sweep();
        study.runs.iter_mut().filter(|run| run.arm == 1).for_each(|run| run.relmse = -1e-6);
        let text = error_time(&study, &findings(&study), &RELMSE, 760.0).into_string();
        assert_eq!(text.matches("data-arm").count(), 5);
        assert!(!text.contains("NaN") && !text.contains("inf"));
    }
}
