//! What a study was asked, so that its folder holds the answer to one question.

use std::collections::BTreeMap;

use super::args::{CommonArgs, Preset};
use super::knobs::KNOBS;
use super::plan::{Budget, Plan};
use super::way::{Way, cores};
use crate::exit::Failure;
use crate::job::Job;

/// What was asked, by the names of flags and of what else matters. Repetitions are not in it: more of them extend a study.
pub type Question = BTreeMap<String, String>;

/// The question of a plan for the scene of `job`, whose own settings are `scene`.
///
/// # Errors
/// A reference that cannot be read.
pub fn of(preset: &Preset, plan: &Plan, job: &Job, scene: &Way, tile: u32) -> Result<Question, Failure> {
    let common = preset.common();
    let lists = preset.lists();
    let value = |text: &dyn ToString| text.to_string();
    let mut question: Question = KNOBS
        .iter()
        .map(|knob| (knob.name.into(), lists.of(knob).map_or_else(|| (knob.get)(scene), |values| values.join(","))))
        .collect();
    if let Preset::Report(args) = preset {
        question.insert("size".into(), format!("{}x{}", args.size.width, args.size.height));
    }
    let others = [
        ("preset", value(&plan.preset)),
        ("version", value(&env!("CARGO_PKG_VERSION"))),
        ("estimator", value(&smalti_core::ESTIMATOR)),
        ("scene", value(&job.scene_hash)),
        ("camera", value(&job.camera())),
        ("seed", value(&scene.image.seed)),
        ("tile", value(&tile)),
        ("simd", value(&job.level.name())),
        ("cores", value(&cores())),
        ("reference", reference(common)?),
    ];
    question.extend(others.map(|(name, value)| (name.to_owned(), value)));
    let (error, seconds) = match plan.budget {
        Budget::Samples => (None, None),
        Budget::Seconds(seconds) => (None, Some(seconds)),
        Budget::Error { error, seconds } => (Some(error), Some(seconds)),
    };
    let budget = [("error", error), ("seconds", seconds)];
    question.extend(budget.into_iter().filter_map(|(name, of)| Some((name.to_owned(), of?.to_string()))));
    Ok(question)
}

fn reference(common: &CommonArgs) -> Result<String, Failure> {
    match (&common.reference, common.reference_spp) {
        (Some(path), _) => {
            let image = smalti_image::read(path).map_err(Failure::user)?;
            Ok(format!("an image with hash {}", smalti_image::hash(&image)))
        }
        (None, Some(spp)) => Ok(format!("{spp} spp")),
        (None, None) => Ok("as good as needed".into()),
    }
}

/// In what two questions differ, in words: `spp is 4,8 there and 4,16 here`.
pub fn differences(there: &Question, here: &Question) -> Vec<String> {
    let names: std::collections::BTreeSet<&String> = there.keys().chain(here.keys()).collect();
    let said = |question: &Question, name: &String| {
        question.get(name).map_or("not asked".into(), |said| match said {
            empty if empty.is_empty() => "empty".to_owned(),
            said => said.clone(),
        })
    };
    let differs = |name: &&&String| there.get(**name) != here.get(**name);
    let words = |name: &String| format!("{name} is {} there and {} here", said(there, name), said(here, name));
    names.iter().filter(differs).map(|name| words(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_name_both_sides() {
        let question = |pairs: &[(&str, &str)]| pairs.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
        let there = question(&[("seed", "0"), ("spp", "4,8")]);
        let here = question(&[("seed", "0"), ("spp", "4,16"), ("error", "0.03")]);
        let expected = ["error is not asked there and 0.03 here", "spp is 4,8 there and 4,16 here"];
        assert_eq!(differences(&there, &here), expected);
        assert!(differences(&there, &there).is_empty());
    }
}
