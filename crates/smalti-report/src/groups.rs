//! Groups of arms: how each is told from the others, and which arms one curve joins.

use crate::findings::Finding;
use crate::knobs::differing;
use crate::record::Study;

/// How a group is drawn: by colour and, for those who do not see it, by shape and letter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Look {
    /// Which of the colours and shapes; they repeat after [`LOOKS`] groups.
    pub index: usize,
}

/// Looks that there are.
pub(crate) const LOOKS: usize = 8;

/// Colours on a light and on a dark ground, after Okabe and Ito: told apart by all kinds of eyes.
pub(crate) const COLOURS: [[&str; 2]; LOOKS] = [
    ["#0067a5", "#56b4e9"],
    ["#c44e00", "#ff9d57"],
    ["#00795a", "#2fc79c"],
    ["#a63d7c", "#ee9ac9"],
    ["#8a6a00", "#f0c93a"],
    ["#5b4bb5", "#b3a6ff"],
    ["#3f5a66", "#a9c3cf"],
    ["#8f1d2c", "#ff8f8f"],
];

impl Look {
    /// Its colour on a light ground.
    pub fn colour(self) -> &'static str {
        COLOURS[self.index][0]
    }

    /// The class by which a page gives it the colour of its scheme.
    pub fn class(self) -> String {
        format!("look-{}", self.index)
    }

    /// A letter for the terminal.
    pub fn letter(self) -> char {
        char::from(b'a' + self.index as u8)
    }
}

/// The groups in the order in which arms have them first, each with its look.
pub(crate) fn groups(study: &Study) -> Vec<(&str, Look)> {
    let mut names: Vec<&str> = Vec::new();
    for arm in &study.arms {
        if !names.contains(&arm.group.as_str()) {
            names.push(&arm.group);
        }
    }
    names.into_iter().enumerate().map(|(index, name)| (name, Look { index: index % LOOKS })).collect()
}

/// The look of an arm's group.
pub(crate) fn look(study: &Study, arm: usize) -> Look {
    let group = study.arms[arm].group.as_str();
    groups(study).into_iter().find(|(name, _)| *name == group).map_or(Look { index: 0 }, |(_, look)| look)
}

/// Knobs along which a curve may go.
const ALONG: [&str; 3] = ["spp", "shadow-rays", "photons"];

/// Findings that a line joins.
struct Curve<'a> {
    findings: Vec<&'a Finding>,
    /// The knob in which its arms differ.
    along: Option<&'a str>,
}

/// Arms that a curve joins, each with two findings at least: those of a group that differ in one and the same knob only, in
/// the order of its values.
pub(crate) fn curves<'a>(study: &'a Study, findings: &'a [Finding]) -> Vec<Vec<&'a Finding>> {
    let mut curves: Vec<Curve> = Vec::new();
    for finding in findings {
        if !curves.iter_mut().any(|curve| curve.takes(study, finding)) {
            curves.push(Curve { findings: vec![finding], along: None });
        }
    }
    curves.into_iter().filter_map(|curve| curve.sorted(study)).collect()
}

impl<'a> Curve<'a> {
    /// Takes a finding in if it belongs to the curve.
    fn takes(&mut self, study: &'a Study, finding: &'a Finding) -> bool {
        let [first, arm] = [self.findings[0], finding].map(|finding| &study.arms[finding.arm]);
        let [knob] = differing(first, arm)[..] else { return false };
        let belongs = first.group == arm.group && self.along.map_or(ALONG.contains(&knob), |along| along == knob);
        if belongs {
            self.along = Some(knob);
            self.findings.push(finding);
        }
        belongs
    }

    fn sorted(mut self, study: &Study) -> Option<Vec<&'a Finding>> {
        let along = self.along?;
        let value = |finding: &&Finding| study.arms[finding.arm].knobs.get(along).and_then(|value| value.parse().ok());
        self.findings.sort_by_key(|finding| value(finding).unwrap_or(0u64));
        Some(self.findings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::findings;
    use crate::fixture;

    #[test]
    fn groups_keep_their_order_and_look() {
        let study = fixture::sweep();
        let names: Vec<&str> = groups(&study).iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["path", "auto"]);
        assert_eq!((look(&study, 2).letter(), look(&study, 3).letter()), ('a', 'b'));
    }

    #[test]
    fn curves_follow_the_samples() {
        let mut study = fixture::sweep();
        let joined = |study: &Study| -> Vec<Vec<usize>> {
            let found = findings(study);
            curves(study, &found).iter().map(|curve| curve.iter().map(|finding| finding.arm).collect()).collect()
        };
        assert_eq!(joined(&study), [vec![0, 1, 2], vec![3, 4]]);
        // 4 samples become 32, so that the curve of path goes through its arms in another order.
        study.arms[0].knobs.insert("spp".into(), "32".into());
        study.arms[4].group = "other".into();
        assert_eq!(joined(&study), [vec![1, 0, 2]]);
    }
}
