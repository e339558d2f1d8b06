//! From a preset to a plan.

use smalti_core::scene::World;

use super::args::{Preset, ReportArgs, SweepArgs};
use super::combine::{self, turned};
use super::knobs::Knob;
use super::lists::KnobLists;
use super::naming::Named;
use super::plan::{Budget, Plan, Planned};
use super::report;
use super::way::Way;
use crate::exit::Failure;

/// Why samples cannot be given where the study chooses them.
const CHOSEN: &str = "the study chooses the samples of each arm";

impl Preset {
    /// The plan for a scene whose own settings are `scene`.
    ///
    /// # Errors
    /// Values that cannot be set, or that the preset chooses itself.
    pub fn plan(&self, scene: &Way, world: &World) -> Result<Plan, Failure> {
        match self {
            Preset::Sweep(args) => sweep(args, scene, world),
            Preset::Report(ReportArgs { size, .. }) => report::plan(scene, *size, world),
            Preset::EqualTime(args) => equal(self.name(), Budget::Seconds(args.seconds), &args.knobs, scene, world),
            Preset::EqualError(args) => {
                let budget = Budget::Error { error: args.error, seconds: args.seconds };
                equal(self.name(), budget, &args.knobs, scene, world)
            }
            Preset::Knobs(args) => knobs(args, scene, world),
        }
    }

    /// Knobs that were named.
    pub fn lists(&self) -> KnobLists {
        match self {
            Preset::Sweep(args) | Preset::Knobs(args) => args.knobs.clone(),
            Preset::EqualTime(args) => args.knobs.clone(),
            Preset::EqualError(args) => args.knobs.clone(),
            Preset::Report(_) => KnobLists::default(),
        }
    }
}

fn sweep(args: &SweepArgs, scene: &Way, world: &World) -> Result<Plan, Failure> {
    let ways = combine::combinations(scene, &args.knobs, world)?;
    let own = turned(scene, world);
    let baseline = ways.iter().position(|way| turned(way, world) == own);
    Ok(Plan::of("sweep", ways, baseline))
}

/// Every integrator with one light sample and the scene's own number of them, unless something else is asked.
fn equal(preset: &'static str, budget: Budget, lists: &KnobLists, scene: &Way, world: &World) -> Result<Plan, Failure> {
    lists.refuse("spp", CHOSEN)?;
    let own = scene.image.shadow_rays;
    let rays = if own > 1 { vec!["1".into(), own.to_string()] } else { vec!["1".into(), "4".into()] };
    let integrators = (Knob::named("integrator").around)(scene);
    let lists = lists.clone().or("integrator", integrators).or("shadow-rays", rays);
    let mut plan = Plan { budget, ..Plan::of(preset, combine::combinations(scene, &lists, world)?, None) };
    for arm in &mut plan.arms {
        arm.group = Some(arm.way.image.integrator.name().into());
    }
    Ok(plan)
}

fn knobs(args: &SweepArgs, scene: &Way, world: &World) -> Result<Plan, Failure> {
    let base = args.knobs.first(scene)?;
    let ways = combine::one_at_a_time(&base, &args.knobs, world)?;
    let arms = ways.into_iter().map(|(way, knob)| turned_once(way, knob)).collect();
    Ok(Plan { arms, ..Plan::of("knobs", Vec::new(), Some(0)) })
}

/// An arm that differs from the baseline in a knob, called by its value; or the baseline itself.
fn turned_once(way: Way, knob: Option<&'static str>) -> Planned {
    let told = ["integrator", "spp", "shadow-rays"].map(Knob::named);
    let named = match knob.map(Knob::named) {
        None => {
            let words: Vec<String> = told.iter().map(|knob| knob.in_words(&(knob.get)(&way))).collect();
            Named {
                name: "baseline".into(),
                label: format!("baseline: {}", words.join(", ")),
                group: "baseline".into(),
            }
        }
        Some(knob) => {
            let value = (knob.get)(&way);
            Named { name: knob.in_short(&value), label: knob.in_words(&value), group: knob.name.into() }
        }
    };
    Planned { named: Some(named), ..Planned::new(way) }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::Parser;

    use super::*;
    use crate::args::{Cli, Command};
    use crate::study::combine::tests::base;

    fn plan(line: &str) -> Result<Plan, Failure> {
        match Cli::try_parse_from(line.split(' ')).unwrap().command {
            Command::Study(args) => args.preset.plan(&base(), &World::default()),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_sweep_is_compared_with_the_scenes_own_settings_where_it_has_them() {
        let found = plan("smalti study sweep a.toml --spp 4,8,16").unwrap();
        assert_eq!((found.arms.len(), found.baseline), (3, Some(1)));
        assert_eq!(plan("smalti study sweep a.toml --spp 4,16").unwrap().baseline, None);
    }

    #[test]
    fn equal_budgets_choose_the_samples() {
        let found = plan("smalti study equal-time a.toml --seconds 0.5 --integrator path,auto").unwrap();
        assert_eq!((found.arms.len(), found.budget), (4, Budget::Seconds(0.5)));
        let rays: Vec<_> = found.arms.iter().map(|arm| arm.way.image.shadow_rays).collect();
        assert_eq!(rays, [1, 4, 1, 4]);
        assert_eq!(
            plan("smalti study equal-error a.toml --error 2%").unwrap().budget,
            Budget::Error { error: 0.02, seconds: 60.0 }
        );
        assert!(plan("smalti study equal-time a.toml --spp 4").unwrap_err().message.contains("chooses"));
    }

    #[test]
    fn knobs_are_turned_around_the_first_values() {
        let found = plan("smalti study knobs a.toml --spp 16,2 --integrator auto").unwrap();
        let group = |arm: &Planned| arm.named.as_ref().unwrap().group.clone();
        assert_eq!((found.baseline, group(&found.arms[0]).as_str()), (Some(0), "baseline"));
        assert_eq!((found.arms[0].way.image.spp, found.arms[0].way.image.integrator.name()), (16, "auto"));
        let spp = found.arms.iter().filter(|arm| group(arm) == "spp");
        assert_eq!(spp.map(|arm| arm.way.image.spp).collect::<Vec<_>>(), [2]);
        assert!(found.arms.iter().any(|arm| group(arm) == "photons"));
        let names: BTreeSet<_> = found.arms.iter().map(|arm| &arm.named.as_ref().unwrap().name).collect();
        assert_eq!(names.len(), found.arms.len());
    }
}
