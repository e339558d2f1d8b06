//! The short version for a terminal: a table, a small plot, what each knob costs.

mod columns;
mod plot;

use crate::findings::{Finding, by_efficiency, findings};
use crate::knobs::sentence;
use crate::numbers::{counted, percent, significant};
use crate::record::Study;
use crate::verdict::{compare, comparisons};
use columns::{Side, columns, wrap};
use plot::plot;

/// Narrower than this, lines are broken or cut no further.
const NARROWEST: usize = 60;

/// Wider than this, a plot only spreads.
const WIDEST_PLOT: usize = 76;

/// What a study found, in lines of at most `width` columns where words allow it, without colours.
pub fn words(study: &Study, width: usize) -> String {
    let width = width.max(NARROWEST);
    let findings = findings(study);
    if findings.is_empty() {
        return format!("{}: no run is finished yet\n", study.scene);
    }
    let parts = [
        heading(study, width),
        table(study, &findings, width),
        plot(study, &findings, width.min(WIDEST_PLOT)),
        verdicts(study, width),
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
}

fn heading(study: &Study, width: usize) -> String {
    let machine = &study.machine;
    let runs = counted(study.runs.len(), "render");
    let text = format!(
        "{}: {runs} on {}, {}, {}; error against {}",
        study.scene,
        counted(machine.cores, "core"),
        machine.simd,
        machine.system,
        study.references.iter().map(|reference| reference.file.as_str()).collect::<Vec<_>>().join(", ")
    );
    wrap(&text, width, "  ")
}

/// A column of the table.
struct Column {
    title: &'static str,
    side: Side,
    /// The least width of lines in which it has room.
    from: usize,
    cell: fn(&Study, &Finding) -> String,
}

const COLUMNS: [Column; 6] = [
    Column { title: "", side: Side::Left, from: 0, cell: |_, finding| if finding.on_front { "*" } else { "" }.into() },
    Column { title: "arm", side: Side::Left, from: 0, cell: label },
    Column { title: "seconds", side: Side::Right, from: 0, cell: |_, found| significant(found.seconds.median, 3) },
    Column { title: "error", side: Side::Right, from: 0, cell: |_, found| percent(found.relative_error.median) },
    Column { title: "relmse × s", side: Side::Right, from: 66, cell: |_, found| relmse_seconds(found) },
    Column { title: "error² × time", side: Side::Right, from: 60, cell: against },
];

/// Arms from the most efficient on.
fn table(study: &Study, findings: &[Finding], width: usize) -> String {
    let has_room =
        |column: &&Column| column.from <= width && (column.title != "error² × time" || study.baseline.is_some());
    let shown: Vec<&Column> = COLUMNS.iter().filter(has_room).collect();
    let mut rows = vec![shown.iter().map(|column| column.title.to_owned()).collect::<Vec<_>>()];
    let row = |finding| shown.iter().map(|column| (column.cell)(study, finding)).collect();
    rows.extend(by_efficiency(findings).into_iter().map(row));
    let sides: Vec<Side> = shown.iter().map(|column| column.side).collect();
    let note = "  * on the Pareto front: nothing is faster and as accurate\n";
    columns(&sides, &rows, 1, width) + note + &biased_note(study, findings)
}

fn label(study: &Study, finding: &Finding) -> String {
    let arm = &study.arms[finding.arm];
    let biased = if arm.biases.is_empty() { "" } else { " (biased)" };
    format!("{}{biased}", arm.label)
}

fn relmse_seconds(finding: &Finding) -> String {
    finding.efficiency.map_or("-".into(), |found| significant(1.0 / found.median, 3))
}

/// Error² × time by the baseline's.
fn against(study: &Study, finding: &Finding) -> String {
    let compared = study.baseline.and_then(|baseline| compare(study, finding.arm, baseline, ""));
    compared.and_then(|found| found.cost).map_or("-".into(), |cost| format!("× {}", significant(cost.median, 3)))
}

fn biased_note(study: &Study, findings: &[Finding]) -> String {
    let biased = findings.iter().filter(|finding| !study.arms[finding.arm].biases.is_empty()).count();
    match biased {
        0 => String::new(),
        _ => "  biased: more samples do not remove all of the error\n".into(),
    }
}

fn verdicts(study: &Study, width: usize) -> String {
    let line = |comparison| wrap(&format!("  {}", sentence(study, &comparison)), width, "      ");
    comparisons(study).into_iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_table_begins_with_the_most_efficient() {
        let study = fixture::sweep();
        let text = table(&study, &findings(&study), 100);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("     arm") && lines[0].ends_with("error² × time"), "{text}");
        assert!(lines[1].starts_with("  *  auto, auto, 4 ") && lines[1].ends_with("0.00200        × 0.125"), "{text}");
        assert_eq!(lines.len(), 8);
        assert!(text.contains("path, path, 4 (biased)"));
    }

    #[test]
    fn no_line_is_wider_than_asked() {
        let mut study = fixture::sweep();
        study.arms[1].label = "a label that is so long that no terminal of a usual width has room for all of it".into();
        for width in [60, 72, 120] {
            let text = words(&study, width);
            let widest = text.lines().map(|line| line.chars().count()).max().unwrap();
            assert!(widest <= width, "{widest} of {width}:\n{text}");
        }
    }

    #[test]
    fn a_study_that_has_just_begun_says_so() {
        assert_eq!(words(&fixture::study(), 80), "room.toml: no run is finished yet\n");
    }

    #[test]
    fn without_a_baseline_each_verdict_names_its_arm() {
        let mut study = fixture::sweep();
        study.baseline = None;
        assert!(verdicts(&study, 200).contains("not worth it here (path, path, 16)"), "{}", verdicts(&study, 200));
    }
}
