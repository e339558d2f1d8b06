//! Table 1 of the report that smalti starts from (Larsson and Voith 2023), beside what a study measured.

use smalti_measure::Repetitions;

use crate::findings::Finding;
use crate::numbers::{percent, significant};
use crate::record::{Arm, Study};

/// A row of Table 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TableOneRow {
    /// Name of the image.
    pub image: &'static str,
    /// Width and height of the square image.
    pub side: u32,
    /// Rays per pixel.
    pub spp: u32,
    /// Shadow rays.
    pub shadow_rays: u32,
    /// Whether rays from the eye pass through random places in their pixel.
    pub ray_noise: bool,
    /// The report's time, on one thread of an AMD Ryzen 7 6800H.
    pub seconds: f64,
}

/// Table 1.
const TABLE_ONE: [TableOneRow; 6] = [
    row("Comparison image", 800, 5, 10, true, 115.46),
    row("Figure 1", 400, 5, 10, true, 29.15),
    row("Figure 2", 800, 1, 10, true, 23.64),
    row("Figure 3", 800, 5, 10, false, 117.68),
    row("Figure 4", 800, 5, 5, true, 88.93),
    row("Figure 5", 800, 30, 20, true, 1601.34),
];

const fn row(image: &'static str, side: u32, spp: u32, shadow_rays: u32, ray_noise: bool, seconds: f64) -> TableOneRow {
    TableOneRow { image, side, spp, shadow_rays, ray_noise, seconds }
}

/// Our figures for a row: of an arm of integrator `path` with its settings.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ours<'a> {
    pub row: TableOneRow,
    pub measured: Option<(&'a Arm, &'a Finding)>,
}

/// Table 1 with the arms that have its settings; the largest image of the study stands for 800 × 800.
pub(crate) fn beside<'a>(study: &'a Study, findings: &'a [Finding]) -> Vec<Ours<'a>> {
    let full = study.arms.iter().map(|arm| arm.size[0]).max().unwrap_or(0);
    let has = |row: &TableOneRow, arm: &Arm| {
        let is = |name: &str, value: &str| arm.knobs.get(name).is_some_and(|set| set == value);
        let unless = |name: &str, value: &str| arm.knobs.get(name).is_none_or(|set| set == value);
        is("integrator", "path")
            && is("spp", &row.spp.to_string())
            && is("shadow-rays", &row.shadow_rays.to_string())
            && unless("jitter", if row.ray_noise { "on" } else { "off" })
            && unless("downsample", "1")
            && u64::from(arm.size[0]) * 800 == u64::from(full) * u64::from(row.side)
    };
    let measured = |row: &TableOneRow| {
        findings.iter().map(|finding| (&study.arms[finding.arm], finding)).find(|(arm, _)| has(row, arm))
    };
    TABLE_ONE.iter().map(|row| Ours { row: *row, measured: measured(row) }).collect()
}

/// Headings of the cells of [`cells`].
pub(crate) const HEADINGS: [&str; 8] = [
    "image",
    "resolution",
    "rays per pixel",
    "shadow rays",
    "ray noise",
    "the report, s",
    "smalti, s",
    "relative error",
];

/// A row as text.
pub(crate) fn cells(ours: &Ours) -> [String; 8] {
    let row = &ours.row;
    let theirs = [row.side; 2];
    let ours_size = ours.measured.map_or(theirs, |(arm, _)| arm.size);
    let in_words = |[width, height]: [u32; 2]| format!("{width} × {height}");
    let resolution = match ours_size == theirs {
        true => in_words(theirs),
        false => format!("{} (ours {})", in_words(theirs), in_words(ours_size)),
    };
    let measured = |of: fn(&Finding) -> Repetitions, shown: fn(f64) -> String| {
        ours.measured.map_or("-".into(), |(_, finding)| with_ends(&of(finding), shown))
    };
    [
        row.image.into(),
        resolution,
        row.spp.to_string(),
        row.shadow_rays.to_string(),
        if row.ray_noise { "yes" } else { "no" }.into(),
        format!("{:.2}", row.seconds),
        measured(|finding| finding.seconds, |seconds| significant(seconds, 3)),
        measured(|finding| finding.relative_error, percent),
    ]
}

/// The median and, of several repetitions, the ends of what is known of it.
fn with_ends(found: &Repetitions, shown: fn(f64) -> String) -> String {
    match found.count {
        1 => shown(found.median),
        _ => format!("{} ({} to {})", shown(found.median), shown(found.low), shown(found.high)),
    }
}

/// The comparison as a Markdown table; `None` for a study that has none of the rows.
pub fn table_one_markdown(study: &Study) -> Option<String> {
    let findings = crate::findings::findings(study);
    let rows = beside(study, &findings);
    rows.iter().find(|ours| ours.measured.is_some())?;
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = "|---|---|---:|---:|---|---:|---:|---:|\n";
    let body: String = rows.iter().map(|ours| line(&cells(ours))).collect();
    Some(line(&HEADINGS.map(String::from)) + rule + &body)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    fn study(side: u32) -> Study {
        let mut study = fixture::study();
        let knobs =
            |spp, rays, jitter| [("integrator", "path"), ("spp", spp), ("shadow-rays", rays), ("jitter", jitter)];
        let settings = [
            (knobs("5", "10", "on"), 1),
            (knobs("5", "10", "on"), 2),
            (knobs("5", "10", "off"), 1),
            (knobs("30", "20", "on"), 1),
        ];
        for (index, (knobs, smaller)) in settings.iter().enumerate() {
            let arm = fixture::arm("path", knobs);
            study.arms.push(Arm { size: [side / smaller; 2], ..arm });
            study.runs.push(fixture::run(index, 0, 1.5 * (index + 1) as f64, 0.25));
        }
        study
    }

    #[test]
    fn rows_find_the_arms_with_their_settings() {
        let study = study(800);
        let found = crate::findings::findings(&study);
        let arms: Vec<Option<usize>> =
            beside(&study, &found).iter().map(|ours| ours.measured.map(|(_, finding)| finding.arm)).collect();
        assert_eq!(arms, [Some(0), Some(1), None, Some(2), None, Some(3)]);
    }

    #[test]
    fn markdown_shows_both() {
        let text = table_one_markdown(&study(800)).unwrap();
        assert!(text.contains("| Figure 1 | 400 × 400 | 5 | 10 | yes | 29.15 | 3.00 | 25.0 % |\n"), "{text}");
        assert!(text.contains("| Figure 4 | 800 × 800 | 5 | 5 | yes | 88.93 | - | - |\n"), "{text}");
        assert_eq!(text.lines().count(), 8);
        assert_eq!(table_one_markdown(&fixture::sweep()), None);
    }

    #[test]
    fn repetitions_have_their_ends() {
        let mut study = study(800);
        for (repetition, seconds) in [(1, 2.9), (2, 3.1)] {
            study.runs.push(fixture::run(1, repetition, seconds, 0.25));
        }
        let text = table_one_markdown(&study).unwrap();
        assert!(text.contains("| 29.15 | 3.00 (2.76 to 3.26) | 25.0 % (25.0 % to 25.0 %) |"), "{text}");
    }

    #[test]
    fn another_size_is_said() {
        let text = table_one_markdown(&study(80)).unwrap();
        assert!(text.contains("| Figure 1 | 400 × 400 (ours 40 × 40) |"), "{text}");
    }
}
