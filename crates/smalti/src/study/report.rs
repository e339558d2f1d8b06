//! The report's Table 1, and what its figures and claims compare, as a plan.

use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Settings};

use super::combine::turned;
use super::knobs::Knob;
use super::naming::Named;
use super::plan::{Plan, Planned, REPETITIONS};
use super::way::{Way, cores};
use crate::exit::Failure;
use crate::parse::Size;

/// One render: the comparison image with something changed.
struct Row {
    /// Name of its files.
    name: &'static str,
    /// What it is called.
    title: &'static str,
    /// What it belongs to.
    group: &'static str,
    /// Whether the image is half as wide and high.
    half: bool,
    /// Knobs that are turned, with their values.
    turned: &'static [(&'static str, &'static str)],
    /// Repetitions where none were asked for.
    repetitions: u32,
}

const fn row(name: &'static str, title: &'static str, group: &'static str) -> Row {
    Row { name, title, group, half: false, turned: &[], repetitions: REPETITIONS }
}

/// The rows of Table 1 in its order, then what its sections 3 and 4 claim: what more threads would bring (4.1), other
/// algorithms (4.2), fewer samples of a larger image that is scaled down (4.1), and shadow rays (Figure 4).
const ROWS: &[Row] = &[
    row("comparison", "Comparison image", "Table 1"),
    Row { half: true, ..row("figure1", "Figure 1", "Table 1") },
    Row { turned: &[("spp", "1")], ..row("figure2", "Figure 2", "Table 1") },
    Row { turned: &[("jitter", "off")], ..row("figure3", "Figure 3", "Table 1") },
    Row { turned: &[("shadow-rays", "5")], ..row("figure4", "Figure 4", "Table 1") },
    Row { turned: &[("spp", "30"), ("shadow-rays", "20")], repetitions: 2, ..row("figure5", "Figure 5", "Table 1") },
    Row { turned: &[("threads", "1")], ..row("one-thread", "One thread", "Threads") },
    Row { turned: &[("threads", "2")], ..row("two-threads", "Two threads", "Threads") },
    Row { turned: &[("integrator", "auto")], ..row("auto", "Caustics by photons", "Integrators") },
    Row { turned: &[("integrator", "photon")], ..row("photon", "Photon mapping", "Integrators") },
    Row { half: true, turned: &[("downsample", "2")], ..row("scaled-down", "Scaled down", "Down-sampling") },
    Row { half: true, turned: &[("spp", "20")], ..row("not-scaled", "As many samples, not scaled", "Down-sampling") },
    Row { turned: &[("shadow-rays", "1")], ..row("shadow-rays-1", "1 shadow ray", "Shadow rays") },
    Row { turned: &[("shadow-rays", "20")], ..row("shadow-rays-20", "20 shadow rays", "Shadow rays") },
];

/// The plan for a scene whose own settings are `scene`; the comparison image has `size`.
///
/// # Errors
/// A size that has no half.
pub fn plan(scene: &Way, size: Size, world: &World) -> Result<Plan, Failure> {
    let Size { width, height } = size;
    if !width.is_multiple_of(2) || !height.is_multiple_of(2) {
        let message =
            format!("--size {width}x{height}: some images are half as wide and high; both sides must be even");
        return Err(Failure::user(message));
    }
    let comparison = comparison(scene, size);
    let mut arms: Vec<Planned> = Vec::new();
    for row in ROWS.iter().filter(|row| is_possible(row)) {
        let way = turn(row, &comparison)?;
        let told = turned(&way, world);
        if arms.iter().all(|arm| turned(&arm.way, world) != told) {
            arms.push(planned(row, way));
        }
    }
    Ok(Plan { arms, reference_share: 0.5, ..Plan::of("report", Vec::new(), Some(0)) })
}

/// The report's comparison image.
fn comparison(scene: &Way, Size { width, height }: Size) -> Way {
    let integrator = Integrator::Path;
    let image = Settings { integrator, width, height, spp: 5, shadow_rays: 10, jitter: true, ..scene.image.clone() };
    Way { image, downsample: 1, threads: cores() }
}

/// Two threads on one core bring nothing.
fn is_possible(row: &Row) -> bool {
    row.turned != [("threads", "2")] || cores() > 1
}

fn turn(row: &Row, comparison: &Way) -> Result<Way, Failure> {
    let mut way = comparison.clone();
    if row.half {
        (way.image.width, way.image.height) = (way.image.width / 2, way.image.height / 2);
    }
    for (name, value) in row.turned {
        (Knob::named(name).set)(&mut way, value).map_err(Failure::bug)?;
    }
    Ok(way)
}

fn planned(row: &Row, way: Way) -> Planned {
    let usual = [("downsample", "1"), ("jitter", "on"), ("threads", &cores().to_string())];
    let told = ["integrator", "size", "downsample", "spp", "shadow-rays", "jitter", "threads"].map(Knob::named);
    let differs = |knob: &&Knob| !usual.contains(&(knob.name, &(knob.get)(&way)));
    let words: Vec<String> = told.into_iter().filter(differs).map(|knob| knob.in_words(&(knob.get)(&way))).collect();
    let label = format!("{}: {}", row.title, words.join(", "));
    let named = Named { name: row.name.into(), label, group: row.group.into() };
    Planned { named: Some(named), repetitions: row.repetitions, ..Planned::new(way) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::combine::tests::base;

    const FULL: Size = Size { width: 800, height: 800 };

    #[test]
    fn table_1_is_as_printed() {
        let plan = plan(&base(), FULL, &World::default()).unwrap();
        let told = |arm: &Planned| {
            let Settings { width, height, spp, shadow_rays, jitter, .. } = arm.way.image;
            (width, height, spp, shadow_rays, jitter)
        };
        let table: Vec<_> = plan.arms.iter().take(6).map(told).collect();
        let expected = [
            (800, 800, 5, 10, true),
            (400, 400, 5, 10, true),
            (800, 800, 1, 10, true),
            (800, 800, 5, 10, false),
            (800, 800, 5, 5, true),
            (800, 800, 30, 20, true),
        ];
        assert_eq!(table, expected);
        assert!(plan.arms.iter().take(6).all(|arm| arm.way.image.integrator == Integrator::Path));
        let label = &plan.arms[0].named.as_ref().unwrap().label;
        assert!(label.starts_with("Comparison image: path, 800x800, 5 spp, 10 shadow rays"), "{label}");
    }

    #[test]
    fn scaling_down_takes_as_many_samples() {
        let plan = plan(&base(), FULL, &World::default()).unwrap();
        let pair: Vec<_> =
            plan.arms.iter().filter(|arm| arm.named.as_ref().unwrap().group == "Down-sampling").collect();
        assert_eq!(pair.len(), 2);
        assert_eq!((pair[0].way.size(), pair[0].way.samples()), (pair[1].way.size(), pair[1].way.samples()));
        assert_eq!(pair[0].way.rendered().unwrap().width, 800);
    }

    #[test]
    fn no_arm_is_there_twice_and_odd_sizes_are_refused() {
        let found = plan(&base(), FULL, &World::default()).unwrap();
        let keys: std::collections::BTreeSet<_> = found.turned(&World::default()).into_iter().collect();
        assert_eq!(keys.len(), found.arms.len());
        assert!(plan(&base(), Size { width: 9, height: 8 }, &World::default()).is_err());
    }
}
