//! `runs.csv` and `arms.csv`: the study for other programs. Their columns are described in `smalti study --help`.

use serde::Serialize;
use smalti_measure::Repetitions;
use smalti_report::{Finding, Run, Study, findings};

use super::folder::Folder;
use super::knobs::KNOBS;
use crate::exit::Failure;

/// A line of `runs.csv`.
#[derive(Serialize)]
struct RunLine<'a> {
    arm: &'a str,
    repetition: u32,
    seed: u64,
    seconds: f64,
    photon_seconds: f64,
    spp: f64,
    rays: u64,
    relmse: f64,
    relmse_trimmed: f64,
    relative_error: f64,
    /// What the render stated of itself; empty with too few samples.
    stated_relmse: Option<f64>,
    stated_relmse_low: Option<f64>,
    stated_relmse_high: Option<f64>,
    stated_relative_error: Option<f64>,
    stated_relative_error_low: Option<f64>,
    stated_relative_error_high: Option<f64>,
    mean_red: f64,
    mean_green: f64,
    mean_blue: f64,
    hash: &'a str,
}

/// Writes both.
///
/// # Errors
/// They cannot be written.
pub fn write(study: &Study, folder: &Folder) -> Result<(), Failure> {
    folder.write("runs.csv", &runs(study).map_err(Failure::bug)?)?;
    folder.write("arms.csv", &arms(study).map_err(Failure::bug)?)
}

fn runs(study: &Study) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for run in &study.runs {
        writer.serialize(line(study, run))?;
    }
    finished(writer)
}

fn line<'a>(study: &'a Study, run: &'a Run) -> RunLine<'a> {
    let stated = run.stated;
    let [mean_red, mean_green, mean_blue] = run.mean;
    RunLine {
        arm: &study.arms[run.arm].name,
        repetition: run.repetition,
        seed: run.seed,
        seconds: run.seconds,
        photon_seconds: run.photon_seconds,
        spp: run.spp,
        rays: run.rays,
        relmse: run.relmse,
        relmse_trimmed: run.relmse_trimmed,
        relative_error: run.relative_error,
        stated_relmse: stated.map(|stated| stated.relmse),
        stated_relmse_low: stated.map(|stated| stated.relmse_low),
        stated_relmse_high: stated.and_then(|stated| stated.relmse_high),
        stated_relative_error: stated.map(|stated| stated.relative_error),
        stated_relative_error_low: stated.map(|stated| stated.relative_error_low),
        stated_relative_error_high: stated.and_then(|stated| stated.relative_error_high),
        mean_red,
        mean_green,
        mean_blue,
        hash: &run.hash,
    }
}

/// Columns of `arms.csv` after those of the knobs.
const FIGURES: [&str; 14] = [
    "width",
    "height",
    "runs",
    "seconds",
    "seconds_low",
    "seconds_high",
    "relmse",
    "relmse_low",
    "relmse_high",
    "relative_error",
    "relative_error_low",
    "relative_error_high",
    "efficiency",
    "on_front",
];

fn arms(study: &Study) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let knobs = KNOBS.iter().map(|knob| knob.name).filter(|name| *name != "size");
    writer.write_record(["name", "label", "group"].into_iter().chain(knobs.clone()).chain(FIGURES))?;
    let found = findings(study);
    for (index, arm) in study.arms.iter().enumerate() {
        let mut record = vec![arm.name.clone(), arm.label.clone(), arm.group.clone()];
        record.extend(knobs.clone().map(|name| arm.knobs.get(name).cloned().unwrap_or_default()));
        record.extend(arm.size.map(|side| side.to_string()));
        record.extend(figures(found.iter().find(|found| found.arm == index)));
        writer.write_record(record)?;
    }
    finished(writer)
}

/// The figures of an arm, empty before its first run.
fn figures(found: Option<&Finding>) -> Vec<String> {
    let Some(found) = found else {
        return vec![String::new(); FIGURES.len() - 2];
    };
    let Repetitions { count, .. } = found.seconds;
    let ends = [found.seconds, found.relmse, found.relative_error].map(|of| [of.median, of.low, of.high]);
    let efficiency = found.efficiency.map(|efficiency| efficiency.median.to_string()).unwrap_or_default();
    let figures = ends.into_iter().flatten().map(|figure| figure.to_string());
    std::iter::once(count.to_string()).chain(figures).chain([efficiency, found.on_front.to_string()]).collect()
}

fn finished(writer: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, csv::Error> {
    writer.into_inner().map_err(|error| error.into_error().into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fixture::study;

    fn lines(bytes: Vec<u8>) -> Vec<Vec<String>> {
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(bytes.as_slice());
        reader.records().map(|record| record.unwrap().iter().map(String::from).collect()).collect()
    }

    #[test]
    fn every_run_has_a_line() {
        let lines = lines(runs(&study()).unwrap());
        assert_eq!(lines.len(), 5);
        let column = |name: &str| lines[0].iter().position(|column| column == name).unwrap();
        assert_eq!((&lines[4][0], &lines[4][column("seconds")]), (&"auto".to_owned(), &"2.4".to_owned()));
        assert_eq!(
            (&lines[2][column("repetition")], &lines[2][column("stated_relmse_high")]),
            (&"1".into(), &"".into())
        );
    }

    #[test]
    fn every_arm_has_its_knobs_and_figures() {
        let mut study = study();
        study.runs.pop();
        let lines = lines(arms(&study).unwrap());
        assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{lines:?}");
        let value = |line: usize, name: &str| {
            let column = lines[0].iter().position(|column| column == name).unwrap();
            lines[line][column].clone()
        };
        assert_eq!(
            (value(1, "label"), value(1, "spp"), value(1, "seconds")),
            ("path, 4 spp".into(), "4".into(), "1.2".into())
        );
        // Three repetitions have an interval, which is not their range of 1 to 3.
        let ends = ["seconds_low", "seconds", "seconds_high"].map(|name| value(1, name).parse::<f64>().unwrap());
        assert!(ends[0] < 1.0 && ends[1] == 1.2 && ends[2] > 3.0, "{ends:?}");
        assert!((value(1, "relmse").parse::<f64>().unwrap() - 0.04).abs() < 1e-15);
        assert_eq!(
            (value(1, "relative_error_high"), value(1, "on_front")),
            (value(1, "relative_error_low"), "true".into())
        );
        assert_eq!(
            (value(1, "runs"), value(2, "runs"), value(1, "photons")),
            ("3".into(), String::new(), String::new())
        );
    }
}
