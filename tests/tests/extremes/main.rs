//! Scenes at the edge of what can be described, and beyond: rendered right, or answered. docs/stability.md lists what each
//! of them asks for, and what other renderers do.

mod contact;
mod counts;
mod huge;
mod places;
mod shapes;
mod unsound;
mod values;

use smalti_core::render::Level;
use smalti_core::scene::World;
use smalti_core::settings::Settings;
use smalti_doctor::{Finding, Patient, Verdict, examine};

/// What the doctor finds that is not sound, in a small picture by this way.
fn troubles(world: &World, settings: &Settings) -> Vec<Finding> {
    let pool = smalti_scheduler::pool(2).expect("threads");
    let mut troubles = Vec::new();
    let patient = Patient { world, settings, level: Level::available()[0] };
    let keep = |finding: Finding| troubles.extend(Some(finding).filter(|finding| finding.verdict != Verdict::Sound));
    examine(patient, &pool, keep).expect("the settings suit the scene");
    troubles
}

/// Asserts that the doctor finds no promise broken; returns the warnings.
fn assert_sound(name: &str, world: &World) -> Vec<Finding> {
    let settings = Settings { width: 24, height: 24, spp: 16, photons: Some(2000), ..Settings::default() };
    let troubles = troubles(world, &settings);
    let failed: Vec<_> = troubles.iter().filter(|finding| finding.verdict == Verdict::Failed).collect();
    assert!(failed.is_empty(), "{name}: {failed:#?}");
    troubles
}
