//! What is told of a study at its end.

use smalti_report::{Reference, Study, findings};

use super::folder::Folder;
use super::reference::FIFTH;
use crate::exit::Failure;
use crate::study_report;

/// Writes what people look at into the folder, and returns what is told on stdout.
///
/// # Errors
/// Something cannot be written.
pub fn present(study: &Study, folder: &Folder) -> Result<String, Failure> {
    super::tables::write(study, folder)?;
    let written = study_report::write(study, folder.path(), &folder.file("report.html"))?;
    let missing: String = written.missing.iter().map(|what| format!("  {what}\n")).collect();
    Ok(written.describe(study) + &references(study) + &missing)
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
    let found = findings(study);
    let of_size = found.iter().filter(|found| study.arms[found.arm].size == size);
    of_size.map(|found| found.relmse.median).reduce(f64::min).filter(|best| *best > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fixture::study;

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
