//! Groups of arms: how each is told from the others, and which arms one curve joins.

use crate::findings::Finding;
use crate::knobs::differing;
use crate::record::Study;

/// How a group is drawn: by colour and, for those who do not see it, by shape and letter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Look {
    /// Number of the group.
    pub index: usize,
}

/// Colours that there are, and shapes. Beyond so many groups each shape has another colour than before.
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
        COLOURS[self.tone()][0]
    }

    /// The class by which a page gives it the colour of its scheme.
    pub fn class(self) -> String {
        format!("look-{}", self.tone())
    }

    /// Which of the shapes.
    pub fn shape(self) -> usize {
        self.index % LOOKS
    }

    /// A letter for the terminal.
    pub fn letter(self) -> char {
        char::from(b'a' + (self.index % 26) as u8)
    }

    fn tone(self) -> usize {
        (self.index + self.index / LOOKS) % LOOKS
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
    names.into_iter().enumerate().map(|(index, name)| (name, Look { index })).collect()
}

/// The look of an arm's group.
pub(crate) fn look(study: &Study, arm: usize) -> Look {
    let group = study.arms[arm].group.as_str();
    groups(study).into_iter().find(|(name, _)| *name == group).map_or(Look { index: 0 }, |(_, look)| look)
}

/// Knobs along which a curve may go; the first in which arms of a group differ is taken.
const ALONG: [&str; 3] = ["spp", "shadow-rays", "photons"];

/// Findings that a line joins, two at least: arms of a group that differ in one and the same knob only, in the order of its
/// values.
pub(crate) fn curves<'a>(study: &Study, findings: &'a [Finding]) -> Vec<Vec<&'a Finding>> {
    let of_group = |group: &str| -> Vec<&'a Finding> {
        findings.iter().filter(|finding| study.arms[finding.arm].group == group).collect()
    };
    groups(study).into_iter().flat_map(|(group, _)| curves_of(study, &of_group(group))).collect()
}

fn curves_of<'a>(study: &Study, group: &[&'a Finding]) -> Vec<Vec<&'a Finding>> {
    let joined = |a: &Finding, b: &Finding, knob: &str| differing(&study.arms[a.arm], &study.arms[b.arm]) == [knob];
    let differ = |knob: &&str| group.iter().any(|a| group.iter().any(|b| joined(a, b, knob)));
    let Some(along) = ALONG.into_iter().find(differ) else { return Vec::new() };
    let mut curves: Vec<Vec<&Finding>> = Vec::new();
    for finding in group {
        match curves.iter_mut().find(|curve| joined(curve[0], finding, along)) {
            Some(curve) => curve.push(finding),
            None => curves.push(vec![finding]),
        }
    }
    let value = |finding: &&Finding| study.arms[finding.arm].knobs.get(along).and_then(|value| value.parse().ok());
    curves.iter_mut().for_each(|curve| curve.sort_by_key(|finding| value(finding).unwrap_or(0u64)));
    curves.retain(|curve| curve.len() > 1);
    curves
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

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
    fn many_groups_differ_in_colour_or_shape() {
        let looks: BTreeSet<_> =
            (0..LOOKS * LOOKS).map(|index| (Look { index }.class(), Look { index }.shape())).collect();
        assert_eq!(looks.len(), LOOKS * LOOKS);
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
