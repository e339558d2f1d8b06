//! What arms are called: short for files, in words for people, and which of them belong together.

use std::collections::BTreeSet;

use super::combine::Turned;
use super::knobs::{KNOBS, Knob};

/// What an arm is called.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Unique, good for a file name: `auto-64spp-10rays`.
    pub name: String,
    /// For people: `auto, 64 spp, 10 shadow rays`.
    pub label: String,
    /// Arms of one curve have the same.
    pub group: String,
}

/// Knobs that are told of every arm.
const TOLD: [&str; 3] = ["integrator", "spp", "shadow-rays"];

/// Along these a curve goes: the first one in which the arms differ.
const ALONG: [&str; 5] = ["spp", "shadow-rays", "photons", "downsample", "size"];

/// Names for arms by what their knobs say.
pub fn named(arms: &[Turned]) -> Vec<Named> {
    let varied = varied(arms);
    let along = ALONG.into_iter().find(|name| varied.contains(name));
    let name = |knob: &Knob| knob.name == TOLD[0] || varied.contains(knob.name);
    let label = |knob: &Knob| TOLD.contains(&knob.name) || name(knob);
    let group = |knob: &Knob| name(knob) && Some(knob.name) != along;
    let call = |turned: &Turned| Named {
        name: parts(turned, name, Knob::in_short).join("-"),
        label: parts(turned, label, Knob::in_words).join(", "),
        group: parts(turned, group, Knob::in_words).join(", "),
    };
    arms.iter().map(call).collect()
}

/// The knobs in which two arms differ that both have them.
fn varied(arms: &[Turned]) -> BTreeSet<&'static str> {
    let values = |knob: &Knob| arms.iter().filter_map(|turned| turned.get(knob.name)).collect::<BTreeSet<_>>();
    KNOBS.iter().filter(|knob| values(knob).len() > 1).map(|knob| knob.name).collect()
}

fn parts(turned: &Turned, wanted: impl Fn(&Knob) -> bool, say: fn(&Knob, &str) -> String) -> Vec<String> {
    let wanted = KNOBS.iter().filter(|knob| wanted(knob));
    wanted.filter_map(|knob| Some(say(knob, turned.get(knob.name)?))).collect()
}

/// Names of the knobs in which an arm differs from another.
pub fn differences(arm: &Turned, other: &Turned) -> Vec<String> {
    let differs = |name: &str| arm.get(name).is_some() && arm.get(name) != other.get(name);
    KNOBS.iter().filter(|knob| differs(knob.name)).map(|knob| knob.name.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use smalti_core::scene::World;

    use super::*;
    use crate::study::combine::{combinations, tests::base, turned};
    use crate::study::lists::KnobLists;

    fn arms(lists: &[(&'static str, &[&str])]) -> Vec<Turned> {
        let ways = combinations(&base(), &KnobLists::new(lists), &World::default()).unwrap();
        ways.iter().map(|way| turned(way, &World::default())).collect()
    }

    #[test]
    fn names_say_what_varies_and_are_unique() {
        let arms = arms(&[("integrator", &["path", "auto"]), ("spp", &["4", "64"]), ("photons", &["100", "200"])]);
        let named = named(&arms);
        let names: Vec<_> = named.iter().map(|named| named.name.as_str()).collect();
        let auto = ["auto-4spp-100photons", "auto-4spp-200photons", "auto-64spp-100photons", "auto-64spp-200photons"];
        assert_eq!(names, ["path-4spp", "path-64spp", auto[0], auto[1], auto[2], auto[3]]);
        assert_eq!(named[3].label, "auto, 4 spp, 4 shadow rays, 200 photons");
    }

    #[test]
    fn a_curve_goes_along_the_samples() {
        let groups = |lists| named(&arms(lists)).into_iter().map(|named| named.group).collect::<BTreeSet<_>>();
        let list: &[(_, &[&str])] = &[("spp", &["4", "8"]), ("shadow-rays", &["1", "2"])];
        assert_eq!(groups(list), ["path, 1 shadow ray", "path, 2 shadow rays"].map(String::from).into());
        assert_eq!(groups(&[("shadow-rays", &["1", "2"])]), ["path".to_owned()].into());
    }

    #[test]
    fn an_arm_alone_has_the_name_of_its_integrator() {
        assert_eq!(named(&arms(&[]))[0].name, "path");
    }

    #[test]
    fn differences_are_those_of_what_an_arm_has() {
        let arms = arms(&[("integrator", &["path", "auto"]), ("photons", &["100"])]);
        assert_eq!(differences(&arms[1], &arms[0]), ["integrator", "photons", "radius"]);
        assert_eq!(differences(&arms[0], &arms[1]), ["integrator"]);
    }
}
