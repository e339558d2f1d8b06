//! From knobs with values to ways to render: all combinations, or one knob at a time.

use std::collections::{BTreeMap, BTreeSet};

use smalti_core::scene::World;

use super::knobs::KNOBS;
use super::lists::KnobLists;
use super::way::Way;
use crate::exit::Failure;

/// The knobs that make a difference to a way, by name, with their resolved values.
pub type Turned = BTreeMap<String, String>;

/// Arms of a study, at most: more are a slip.
const MOST: usize = 10_000;

/// What makes a way different from others.
pub fn turned(way: &Way, world: &World) -> Turned {
    let applying = KNOBS.iter().filter(|knob| (knob.applies)(way, world));
    applying.map(|knob| (knob.name.to_owned(), (knob.get)(way))).collect()
}

/// All combinations of the values, around `base`; the last knob of the table turns fastest. Knobs that make no difference
/// to a way do not multiply it.
///
/// # Errors
/// A value that cannot be set, or more than [`MOST`] combinations.
pub fn combinations(base: &Way, lists: &KnobLists, world: &World) -> Result<Vec<Way>, Failure> {
    let counts = KNOBS.iter().filter_map(|knob| lists.of(knob)).map(<[String]>::len);
    let all = counts.fold(1, usize::saturating_mul);
    if all > MOST {
        return Err(Failure::user(format!("that are {all} combinations; a study has at most {MOST} arms")));
    }
    let mut ways = vec![base.clone()];
    for knob in KNOBS {
        let Some(values) = lists.of(knob) else { continue };
        let mut more = Vec::with_capacity(ways.len() * values.len());
        for way in &ways {
            for value in values {
                let mut turned = way.clone();
                (knob.set)(&mut turned, value).map_err(Failure::user)?;
                more.push(turned);
            }
        }
        ways = more;
    }
    Ok(distinct(ways, world))
}

/// `base`, and every way that differs from it in one knob; with the name of that knob. Values are those of the lists, or
/// what is worth trying around those of `base`.
///
/// # Errors
/// A value that cannot be set.
pub fn one_at_a_time(
    base: &Way,
    lists: &KnobLists,
    world: &World,
) -> Result<Vec<(Way, Option<&'static str>)>, Failure> {
    let mut ways = vec![(base.clone(), None)];
    for knob in KNOBS.iter().filter(|knob| (knob.applies)(base, world)) {
        for value in lists.of(knob).map_or_else(|| (knob.around)(base), <[String]>::to_vec) {
            let mut way = base.clone();
            (knob.set)(&mut way, &value).map_err(Failure::user)?;
            if ways.iter().all(|(other, _)| turned(other, world) != turned(&way, world)) {
                ways.push((way, Some(knob.name)));
            }
        }
    }
    Ok(ways)
}

/// The first of those that render the same.
fn distinct(ways: Vec<Way>, world: &World) -> Vec<Way> {
    let mut seen = BTreeSet::new();
    ways.into_iter().filter(|way| seen.insert(turned(way, world))).collect()
}

#[cfg(test)]
pub mod tests {
    use smalti_core::settings::{Integrator, SamplerKind, Settings};

    use super::*;

    /// `path` with 8 spp and 4 shadow rays on two threads.
    pub fn base() -> Way {
        let image = Settings { width: 8, height: 8, spp: 8, shadow_rays: 4, ..Settings::default() };
        Way { image, downsample: 1, threads: 2 }
    }

    #[test]
    fn combinations_are_all_of_them_the_last_knob_fastest() {
        let lists = KnobLists::new(&[("integrator", &["path", "whitted"]), ("spp", &["1", "2", "3"])]);
        let ways = combinations(&base(), &lists, &World::default()).unwrap();
        let found: Vec<_> = ways.iter().map(|way| (way.image.integrator.name(), way.image.spp)).collect();
        let expected = [("path", 1), ("path", 2), ("path", 3), ("whitted", 1), ("whitted", 2), ("whitted", 3)];
        assert_eq!(found, expected);
        assert!(ways.iter().all(|way| way.image.shadow_rays == 4));
        assert_eq!(combinations(&base(), &KnobLists::default(), &World::default()).unwrap(), [base()]);
    }

    #[test]
    fn photons_multiply_those_who_ask_them() {
        let lists = KnobLists::new(&[
            ("integrator", &["path", "auto"]),
            ("fresnel", &["exact", "schlick"]),
            ("photons", &["100", "200"]),
        ]);
        let ways = combinations(&base(), &lists, &World::default()).unwrap();
        let found: Vec<_> = ways.iter().map(|way| turned(way, &World::default())).collect();
        assert_eq!(found.len(), 3);
        assert!(!found[0].contains_key("photons") && !found[0].contains_key("fresnel"));
        assert_eq!((found[1]["photons"].as_str(), found[2]["photons"].as_str()), ("100", "200"));
    }

    #[test]
    fn no_value_counts_twice() {
        let lists = KnobLists::new(&[("spp", &["4", "4", "8"])]);
        assert_eq!(combinations(&base(), &lists, &World::default()).unwrap().len(), 2);
    }

    #[test]
    fn more_combinations_than_anyone_can_want_are_refused() {
        let many: Vec<String> = (1..=101).map(|n| n.to_string()).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let lists = |rays| KnobLists::new(&[("spp", &many[1..]), ("shadow-rays", rays)]);
        assert_eq!(combinations(&base(), &lists(&many[1..]), &World::default()).unwrap().len(), MOST);
        let message = combinations(&base(), &lists(&many), &World::default()).unwrap_err().message;
        assert!(message.contains("10100 combinations"), "{message}");
    }

    #[test]
    fn one_knob_at_a_time_leaves_the_others_alone() {
        let ways = one_at_a_time(&base(), &KnobLists::default(), &World::default()).unwrap();
        assert_eq!(ways[0], (base(), None));
        let first = turned(&base(), &World::default());
        for (way, name) in &ways[1..] {
            let other = turned(way, &World::default());
            let differs = |name: &&String| first.get(*name) != other.get(*name);
            let mut names: Vec<_> = first.keys().filter(differs).collect();
            names.retain(|name| other.contains_key(*name));
            assert_eq!(names, [name.unwrap()], "{other:?}");
        }
        let tried = |name| ways.iter().filter(move |(_, of)| *of == Some(name)).map(|(way, _)| way.clone());
        assert_eq!(tried("spp").map(|way| way.image.spp).collect::<Vec<_>>(), [4, 16]);
        assert_eq!(tried("sampler").map(|way| way.image.sampler).collect::<Vec<_>>(), [SamplerKind::Independent]);
        assert_eq!(tried("integrator").count(), 3);
        assert_eq!(tried("fresnel").count(), 0);
    }

    #[test]
    fn a_list_says_what_is_tried() {
        let lists = KnobLists::new(&[("spp", &["8", "9"]), ("integrator", &["path"])]);
        let ways = one_at_a_time(&base(), &lists, &World::default()).unwrap();
        let of = |name| ways.iter().filter(move |(_, of)| *of == Some(name)).count();
        assert_eq!((of("spp"), of("integrator")), (1, 0));
        assert!(ways.iter().all(|(way, _)| way.image.integrator == Integrator::Path));
    }
}
