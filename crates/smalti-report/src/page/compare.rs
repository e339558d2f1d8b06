//! Two pictures side by side under one slider, and all pictures below.

use maud::{Markup, html};

use super::pictures::{ArmPictures, Pictures, png};
use crate::findings::Finding;
use crate::numbers::{percent, seconds, significant};
use crate::record::Study;

/// Steps of magnification.
const ZOOMS: [u32; 4] = [1, 2, 4, 8];

/// A picture that can be chosen.
struct Choice<'a> {
    /// Of an arm `arm-3`, of a reference `reference-0`.
    id: String,
    label: String,
    caption: String,
    size: [u32; 2],
    picture: &'a [u8],
    difference: Option<&'a [u8]>,
}

pub(super) fn section(study: &Study, findings: &[Finding], pictures: &Pictures) -> Markup {
    let choices = choices(study, findings, pictures);
    let [left, right] = defaults(study, findings, &choices);
    html! {
        @if !choices.is_empty() {
            section #compare {
                h2 { "Side by side" }
                (controls(&choices, [left, right]))
                (stage())
                p.note.live.scale-note hidden { (scale_words(study, pictures)) }
                details.gallery {
                    summary { "All pictures" }
                    div.grid { @for choice in &choices { (shown(choice)) } }
                }
            }
        }
    }
}

fn controls(choices: &[Choice], chosen: [usize; 2]) -> Markup {
    let differences = choices.iter().any(|choice| choice.difference.is_some());
    html! {
        div.controls.live {
            @for (side, chosen) in ["left", "right"].into_iter().zip(chosen) {
                label { (side) " " select name=(side) {
                    @for (index, choice) in choices.iter().enumerate() {
                        option value=(choice.id) selected[index == chosen] { (choice.label) }
                    }
                } }
            }
            fieldset.switch {
                legend { "zoom" }
                @for zoom in ZOOMS {
                    label { input type="radio" name="zoom" value=(zoom) checked[zoom == 1]; (zoom) "×" }
                }
            }
            @if differences {
                label { input type="checkbox" name="differences"; "differences from the reference" }
            }
        }
    }
}

fn stage() -> Markup {
    html! {
        div.stage.live tabindex="0" role="group"
            aria-label="Two pictures, one over the other. Arrow keys move what is enlarged, 1, 2, 4 and 8 enlarge." {
            div.layer.left { img alt=""; }
            div.layer.right { img alt=""; }
            span.caption.left {} span.caption.right {}
            div.divider tabindex="0" role="slider" aria-label="Where the right picture begins" aria-valuemin="0"
                aria-valuemax="100" aria-valuenow="50" {}
        }
    }
}

fn shown(choice: &Choice) -> Markup {
    let [width, height] = choice.size;
    html! {
        figure id=(choice.id) {
            img.picture src=(png(choice.picture)) width=(width) height=(height) alt=(choice.label);
            @if let Some(difference) = choice.difference {
                img.difference src=(png(difference)) width=(width) height=(height)
                    alt={ "difference of " (choice.label) " from the reference" };
            }
            figcaption { b { (choice.label) } " " (choice.caption) }
        }
    }
}

/// References first, then the arms in their order.
fn choices<'a>(study: &'a Study, findings: &[Finding], pictures: &'a Pictures) -> Vec<Choice<'a>> {
    let references = study.references.iter().zip(&pictures.references).enumerate();
    let of_reference = references.filter_map(|(index, (reference, picture))| {
        let [width, height] = reference.size;
        let label = format!("reference {width} × {height}");
        let (id, picture) = (format!("reference-{index}"), picture.as_deref()?);
        Some(Choice { id, label, caption: String::new(), size: reference.size, picture, difference: None })
    });
    let arms = pictures.arms.iter().take(study.arms.len()).enumerate();
    let of_arms = arms.filter_map(|(arm, pictures)| of_arm(study, findings, arm, pictures));
    of_reference.chain(of_arms).collect()
}

fn of_arm<'a>(study: &Study, findings: &[Finding], arm: usize, pictures: &'a ArmPictures) -> Option<Choice<'a>> {
    let measured = findings.iter().find(|finding| finding.arm == arm);
    let words =
        |found: &Finding| format!("{}, {}", seconds(found.seconds.median), percent(found.relative_error.median));
    Some(Choice {
        id: id(arm),
        label: study.arms[arm].label.clone(),
        caption: measured.map(words).unwrap_or_default(),
        size: study.arms[arm].size,
        picture: pictures.picture.as_deref()?,
        difference: pictures.difference.as_deref(),
    })
}

fn id(arm: usize) -> String {
    format!("picture-{arm}")
}

/// The worst and the best at first; for the report its comparison image and the best.
fn defaults(study: &Study, findings: &[Finding], choices: &[Choice]) -> [usize; 2] {
    let place = |arm: usize| choices.iter().position(|choice| choice.id == id(arm));
    let mut shown: Vec<&Finding> = findings.iter().filter(|finding| place(finding.arm).is_some()).collect();
    shown.sort_by(|a, b| a.relative_error.median.total_cmp(&b.relative_error.median));
    let best = shown.first().and_then(|finding| place(finding.arm)).unwrap_or(0);
    let worst = shown.last().and_then(|finding| place(finding.arm)).unwrap_or(0);
    let baseline = study.baseline.filter(|_| study.preset == "report").and_then(place);
    match baseline {
        Some(baseline) if baseline != best => [baseline, best],
        _ => [worst, best],
    }
}

/// What the colours of differences mean.
fn scale_words(study: &Study, pictures: &Pictures) -> String {
    let several = study.references.len() > 1;
    let scales = study.references.iter().zip(&pictures.full_scales).filter_map(|(reference, scale)| {
        let [width, height] = reference.size;
        let at = if several { format!(" at {width} × {height}") } else { String::new() };
        Some(format!("{}{at}", significant(f64::from((*scale)?), 3)))
    });
    let scales: Vec<String> = scales.collect();
    format!(
        "Black: as the reference. Red to yellow: brighter; blue to cyan: darker. The last colours begin at a radiance of {}.",
        scales.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    fn pictures() -> Pictures {
        let arm = |index: u8| ArmPictures { picture: Some(vec![index]), difference: Some(vec![index + 100]) };
        let arms = (0..5).map(arm).collect();
        Pictures { arms, references: vec![Some(vec![9])], full_scales: vec![Some(0.5)] }
    }

    fn chosen(study: &Study, pictures: &Pictures) -> [String; 2] {
        let findings = findings(study);
        let choices = choices(study, &findings, pictures);
        defaults(study, &findings, &choices).map(|index| choices[index].id.clone())
    }

    #[test]
    fn the_worst_and_the_best_are_shown_first() {
        let mut study = fixture::sweep();
        assert_eq!(chosen(&study, &pictures()), ["picture-0", "picture-4"]);
        (study.preset, study.baseline) = ("report".into(), Some(1));
        assert_eq!(chosen(&study, &pictures()), ["picture-1", "picture-4"]);
    }

    #[test]
    fn what_has_no_picture_is_no_choice() {
        let study = fixture::sweep();
        let mut pictures = pictures();
        pictures.arms[4] = ArmPictures::default();
        pictures.arms[1].difference = None;
        assert_eq!(chosen(&study, &pictures), ["picture-0", "picture-2"]);
        let text = section(&study, &findings(&study), &pictures).into_string();
        assert_eq!(
            (text.matches("img class=\"picture\"").count(), text.matches("img class=\"difference\"").count()),
            (5, 3)
        );
        assert_eq!(section(&study, &findings(&study), &Pictures::default()).into_string(), "");
    }
}
