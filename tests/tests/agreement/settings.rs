//! The path integrator against itself: neither shadow rays nor samplers may change the mean.

use smalti_core::scene::World;
use smalti_core::settings::{SamplerKind, Settings};
use smalti_tests::estimate::{render, settings};

use crate::{Picture, SIZE, assert_agree, of_streams, scenes};

/// Every variant has its own seed: the noise of two must be independent.
fn variants(world: &World, shadow_rays: &[u32]) -> Vec<(String, Picture)> {
    let mut variants = Vec::new();
    for &shadow_rays in shadow_rays {
        for sampler in [SamplerKind::Sobol, SamplerKind::Independent] {
            let seed = 100 + variants.len() as u64;
            let settings = Settings { shadow_rays, sampler, seed, ..settings(SIZE, SIZE, 256) };
            let name = format!("{shadow_rays} shadow rays, {sampler:?}");
            variants.push((name, of_streams(&render(world, &settings))));
        }
    }
    variants
}

fn assert_all_agree(scene: &str, variants: &[(String, Picture)], precision: f64) {
    let (first, reference) = &variants[0];
    for (name, picture) in &variants[1..] {
        assert_agree(&format!("{scene}: {name} against {first}"), picture, reference, precision);
    }
}

#[test]
fn shadow_rays_and_samplers_leave_a_glowing_room_as_it_is() {
    assert_all_agree("glowing", &variants(&scenes::glowing_room(), &[1, 0, 4]), 0.01);
}

#[test]
fn shadow_rays_and_samplers_leave_a_lamp_as_it_is() {
    assert_all_agree("balls", &variants(&scenes::room_with_balls(), &[4, 0, 1]), 0.015);
}

#[test]
fn shadow_rays_and_samplers_leave_many_lamps_as_they_are() {
    assert_all_agree("lamps", &variants(&scenes::lamps_of_all_kinds(), &[8, 1, 3]), 0.02);
}
