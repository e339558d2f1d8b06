//! What is told of a study at its end.

use smalti_report::Study;

use super::folder::Folder;
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
    let arms = study.arms.len();
    let heading = format!(
        "{}: {} of {}, {arms} arms, {} renders\n",
        folder.path().display(),
        study.preset,
        study.scene,
        study.runs.len()
    );
    let base = study.baseline.and_then(|arm| results::of(study, arm));
    let mut rows = vec![
        ["arm", "seconds", "relmse", "", "error", "", "efficiency", "time", "efficiency"].map(String::from).to_vec(),
    ];
    let row =
        |(index, arm): (usize, &smalti_report::Arm)| Some(row(&arm.label, &results::of(study, index)?, base.as_ref()));
    rows.extend(study.arms.iter().enumerate().filter_map(row));
    let compared = match study.baseline {
        Some(arm) => format!("  The last two columns are by those of {}.\n", study.arms[arm].label),
        None => {
            rows.iter_mut().for_each(|row| row.truncate(7));
            String::new()
        }
    };
    let align = [Align::Left].into_iter().chain([Align::Right; 8]).collect::<Vec<_>>();
    heading
        + &table(&align[..rows[0].len()], &rows)
        + &compared
        + "  Ranges are those of the repetitions; efficiency is 1 / (relmse x seconds).\n"
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
        assert!(told.contains("are by those of path, 4 spp"), "{told}");
        let mut alone = study();
        alone.baseline = None;
        assert!(!text(&alone, &folder).contains("by those of"));
    }
}
