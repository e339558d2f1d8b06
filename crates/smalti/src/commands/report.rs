//! `smalti report`: what a study found, for people to look at.

use std::path::{Path, PathBuf};

use serde::Serialize;
use smalti_report::{Comparison, Finding, Study, comparisons, findings, sentence};

use crate::args::ReportArgs;
use crate::exit::{Failure, Status};
use crate::print::{self, Messages};
use crate::study_report::{self, Written};

#[derive(Serialize)]
struct Report<'a> {
    version: &'static str,
    folder: String,
    /// The page.
    page: String,
    figures: Vec<String>,
    baseline: Option<&'a str>,
    arms: Vec<ArmReport<'a>>,
    verdicts: Vec<VerdictReport<'a>>,
}

#[derive(Serialize)]
struct ArmReport<'a> {
    name: &'a str,
    #[serde(flatten)]
    finding: &'a Finding,
}

#[derive(Serialize)]
struct VerdictReport<'a> {
    arm_name: &'a str,
    other_name: &'a str,
    #[serde(flatten)]
    comparison: &'a Comparison,
    /// The same in words.
    sentence: String,
}

/// Runs the command.
pub fn run(args: &ReportArgs, messages: Messages) -> Result<Status, Failure> {
    let study = study_report::read(&args.folder)?;
    let page = args.output.clone().unwrap_or_else(|| args.folder.join("report.html"));
    let written = study_report::write(&study, &args.folder, &page)?;
    written.missing.iter().for_each(|what| messages.warning(what));
    match (args.json, args.quiet) {
        (true, _) => print_json(&study, &args.folder, &written)?,
        (false, false) => print::result(&written.describe(&study))?,
        (false, true) => {}
    }
    Ok(Status::Done)
}

fn print_json(study: &Study, folder: &Path, written: &Written) -> Result<(), Failure> {
    let (findings, comparisons) = (findings(study), comparisons(study));
    let name = |arm: usize| study.arms[arm].name.as_str();
    let verdict = |comparison| verdict(study, comparison);
    let shown = |path: &PathBuf| path.display().to_string();
    print::json(&Report {
        version: env!("CARGO_PKG_VERSION"),
        folder: folder.display().to_string(),
        page: shown(&written.page),
        figures: written.figures.iter().map(shown).collect(),
        baseline: study.baseline.map(name),
        arms: findings.iter().map(|finding| ArmReport { name: name(finding.arm), finding }).collect(),
        verdicts: comparisons.iter().map(verdict).collect(),
    })
}

fn verdict<'a>(study: &'a Study, comparison: &'a Comparison) -> VerdictReport<'a> {
    VerdictReport {
        arm_name: &study.arms[comparison.arm].name,
        other_name: &study.arms[comparison.other].name,
        comparison,
        sentence: sentence(study, comparison),
    }
}
