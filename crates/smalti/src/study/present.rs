//! What is told of a study at its end.

use smalti_report::{Arm, Reference, Study};

use super::folder::Folder;
use super::reference::FIFTH;
use super::results::{self, ArmResult, Spread};
use crate::exit::Failure;
use crate::table::{Align, table};

/// Writes what people look at into the folder, and returns what is told on stdout.
///
/// # Errors
/// Something cannot be written.
pub fn present(study: &Study, folder: &Folder) -> Result<String, Failure> {
    super::tables::write(study, folder)?;
    Ok(text(study, folder))
}

fn text(study: &Study, folder: &Folder) -> String {
    let (arms, renders) = (study.arms.len(), study.runs.len());
    let place = folder.path().display();
    let heading = format!("{place}: {} of {}, {arms} arms, {renders} renders\n", study.preset, study.scene);
    heading + &arms_table(study) + &compared(study) + &references(study)
}

fn arms_table(study: &Study) -> String {
    let base = study.baseline.and_then(|arm| results::of(study, arm));
    let headings = ["arm", "seconds", "relmse", "", "error", "", "efficiency", "x time", "x efficiency"];
    let row = |(index, arm): (usize, &Arm)| Some(row(&arm.label, &results::of(study, index)?, base.as_ref()));
    let mut rows = vec![headings.map(String::from).to_vec()];
    rows.extend(study.arms.iter().enumerate().filter_map(row));
    let columns = if base.is_some() { headings.len() } else { headings.len() - 2 };
    rows.iter_mut().for_each(|row| row.truncate(columns));
    let align: Vec<Align> = [Align::Left].into_iter().chain([Align::Right; 8]).take(columns).collect();
    table(&align, &rows)
}

fn compared(study: &Study) -> String {
    let by = study.baseline.map(|arm| format!("; x is by {}", study.arms[arm].label)).unwrap_or_default();
    format!("  ranges are those of the repetitions; efficiency is 1 / (relmse x seconds){by}\n")
}

/// What the references leave uncertain.
fn references(study: &Study) -> String {
    let line = |reference: &Reference| {
        let [width, height] = reference.size;
        let best = best(study, reference.size);
        let words = match (reference.relmse, best) {
            (None, _) => "nothing is known of its own error".into(),
            (Some(own), Some(best)) => {
                let more = if own > FIFTH * best { " (--reference-spp N for more)" } else { "" };
                format!("its own relmse, {own:.2e}, is taken off; {:.2} of the best arm's{more}", own / best)
            }
            (Some(own), None) => format!("its own relmse, {own:.2e}, is taken off"),
        };
        format!("  reference of {width}x{height}: {words}\n")
    };
    study.references.iter().map(line).collect()
}

/// The least relmse of the arms of a size.
fn best(study: &Study, size: [u32; 2]) -> Option<f64> {
    let of_size = (0..study.arms.len()).filter(|arm| study.arms[*arm].size == size);
    let errors = of_size.filter_map(|arm| Some(results::of(study, arm)?.relmse.middle));
    errors.reduce(f64::min).filter(|best| *best > 0.0)
}

fn row(label: &str, found: &ArmResult, base: Option<&ArmResult>) -> Vec<String> {
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    let range = |spread: Spread, say: fn(f64) -> String| match found.runs {
        1 => String::new(),
        _ => format!("{} to {}", say(spread.least), say(spread.most)),
    };
    let ratio = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.2}"));
    let time = base.and_then(|base| smalti_measure::speed_up(found.seconds.middle, base.seconds.middle));
    let efficiency = base.and_then(|base| Some(found.efficiency? / base.efficiency?));
    vec![
        label.to_owned(),
        format!("{:.3}", found.seconds.middle),
        format!("{:.3e}", found.relmse.middle),
        range(found.relmse, |value| format!("{value:.2e}")),
        percent(found.relative_error.middle),
        range(found.relative_error, |value| format!("{:.2}", 100.0 * value)),
        found.efficiency.map_or("-".into(), |value| format!("{value:.3e}")),
        ratio(time),
        ratio(efficiency),
    ]
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::study::results::tests::study;

    #[test]
    fn arms_are_told_beside_the_baseline() {
        let folder = Folder::checked(None, Path::new("a.toml"), "sweep").unwrap();
        let told = text(&study(), &folder);
        let line = told.lines().find(|line| line.contains("auto, 4 spp")).unwrap();
        let words: Vec<_> = line.split_whitespace().collect();
        // Twice the time, a quarter of the squared error.
        assert_eq!(words[3..], ["2.400", "1.000e-2", "10.00", "%", "4.167e1", "2.00", "2.00"]);
        assert!(told.contains("; x is by path, 4 spp\n"), "{told}");
        let mut alone = study();
        alone.baseline = None;
        assert!(!text(&alone, &folder).contains("x time"));
    }

    #[test]
    fn references_are_told_by_what_they_leave_uncertain() {
        let mut study = study();
        let (size, file) = ([8, 8], "reference-8x8.pfm".to_owned());
        let reference = Reference { size, file, command: None, relmse: Some(0.002), relative_error_squared: None };
        study.references = vec![reference.clone(), Reference { relmse: None, size: [4, 4], ..reference }];
        let told = references(&study);
        assert!(
            told.contains("reference of 8x8: its own relmse, 2.00e-3, is taken off; 0.20 of the best arm's"),
            "{told}"
        );
        assert!(told.contains("reference of 4x4: nothing is known"), "{told}");
    }
}
