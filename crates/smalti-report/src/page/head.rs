//! What was asked, where, against which truth, and the answer in short.

use maud::{Markup, html};

use super::command::command;
use crate::findings::{Finding, by_efficiency};
use crate::numbers::{counted, percent, seconds};
use crate::record::{Reference, Study};

pub(super) fn head(study: &Study, findings: &[Finding]) -> Markup {
    html! {
        header {
            p.eyebrow { "smalti " (study.version) " · " (question(&study.preset)) }
            h1 { (study.scene) }
            (in_short(study, findings))
            dl.facts {
                dt { "Machine" }
                dd { (counted(study.machine.cores, "core")) ", " (study.machine.simd) ", " (study.machine.system) }
                dt { "Measured" }
                dd { (measured(study)) }
                dt { "Truth" }
                dd { @for reference in &study.references { p { (truth(reference)) } } }
                dt { "Scene" }
                dd { (study.scene) ", " span.hash { (study.scene_hash) } }
                dt { "Again" }
                dd { (command(&study.command)) }
            }
        }
    }
}

/// What a preset asks.
pub(crate) fn question(preset: &str) -> &str {
    match preset {
        "sweep" => "speed against accuracy of all combinations of knobs",
        "report" => "the report's Table 1, rendered again",
        "equal-time" => "which way is the most accurate in equal time",
        "equal-error" => "which way is the fastest to equal accuracy",
        "knobs" => "what each knob costs",
        other => other,
    }
}

fn measured(study: &Study) -> String {
    let (arms, runs) = (study.arms.len(), study.runs.len());
    let repetitions = study.runs.iter().map(|run| run.repetition + 1).max().unwrap_or(0) as usize;
    let most = if runs == arms * repetitions { "" } else { "up to " };
    let (arms, runs) = (counted(arms, "way"), counted(runs, "render"));
    format!("{arms} to render, {most}{} in turn, {runs} in all", counted(repetitions, "repetition"))
}

/// The best by time, by accuracy and by both.
fn in_short(study: &Study, findings: &[Finding]) -> Markup {
    let least = |of: fn(&Finding) -> f64| findings.iter().min_by(|a, b| of(a).total_cmp(&of(b)));
    let efficient = by_efficiency(findings).into_iter().find(|finding| finding.efficiency.is_some());
    let best = [
        ("Fastest", least(|finding| finding.seconds.median)),
        ("Most efficient", efficient),
        ("Most accurate", least(|finding| finding.relative_error.median)),
    ];
    html! {
        @if findings.is_empty() { p.short { "No run is finished yet." } }
        @else {
            ul.short {
                @for (what, finding) in best {
                    @if let Some(finding) = finding {
                        li {
                            span.what { (what) }
                            strong { (study.arms[finding.arm].label) }
                            span { (seconds(finding.seconds.median)) " at " (percent(finding.relative_error.median)) }
                        }
                    }
                }
            }
        }
    }
}

/// What a reference is, and how good.
fn truth(reference: &Reference) -> Markup {
    let [width, height] = reference.size;
    let error = reference.relative_error_squared.map(|squared| percent(squared.max(0.0).sqrt()));
    html! {
        (reference.file) ", " (width) " × " (height) "; "
        @match error {
            Some(error) => { "its own relative error is " (error) ", of which the errors here are freed" }
            None => { "nothing is known of its own error, and nothing is taken off" }
        }
        @match &reference.command {
            Some(text) => { "; " (command(text)) }
            None => { "; it was given" }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    #[test]
    fn the_best_are_named() {
        let study = fixture::sweep();
        let text = in_short(&study, &findings(&study)).into_string();
        let items: Vec<&str> = text.split("<li>").skip(1).collect();
        let expected = [("Fastest", "path, 4", "0.100 s"), ("Most efficient", "auto, 4", "10.0 %")];
        for (item, (what, label, figure)) in items.iter().zip(expected) {
            assert!(item.contains(what) && item.contains(label) && item.contains(figure), "{item}");
        }
        assert!(items[2].contains("auto, 16"), "{}", items[2]);
    }

    #[test]
    fn what_was_measured_is_counted() {
        let mut study = fixture::sweep();
        assert_eq!(measured(&study), "5 ways to render, 3 repetitions in turn, 15 renders in all");
        study.runs.pop();
        assert_eq!(measured(&study), "5 ways to render, up to 3 repetitions in turn, 14 renders in all");
    }

    #[test]
    fn references_say_what_is_known_of_them() {
        let mut reference = fixture::study().references.remove(0);
        let text = truth(&reference).into_string();
        assert!(text.contains("its own relative error is 1.00 %") && text.contains("<span>4096</span>"), "{text}");
        (reference.relative_error_squared, reference.command) = (None, None);
        let text = truth(&reference).into_string();
        assert!(text.contains("nothing is known") && text.contains("it was given"), "{text}");
    }
}
