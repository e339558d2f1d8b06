//! The Whitted integrator against the oracle's recursion.

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, globe, grey, material, mesh, mirror, point_light, quad, sphere};
use smalti_tests::estimate::{Rendered, render, settings};
use smalti_tests::oracle;

use crate::{SIZE, assert_agree, of_oracle, of_streams, scenes};

fn tree(world: &World, spp: u32) -> Rendered {
    render(world, &Settings { integrator: Integrator::Whitted, jitter: false, ..settings(SIZE, SIZE, spp) })
}

/// Mirrors and glass over the ground, lit by one point: no number is random.
fn specular() -> World {
    let mut world = World::default();
    let ground = material(&mut world, Material::Lambert { albedo: [0.7, 0.5, 0.3] });
    let (shiny, clear) = (material(&mut world, mirror(0.85)), material(&mut world, Material::clear(1.5)));
    let lamp = material(&mut world, grey(0.2));
    quad(&mut world, DVec3::ZERO, (DVec3::X * 3.0, DVec3::Y * 3.0), ground, None);
    quad(&mut world, at(0.0, 2.5, 1.5), (DVec3::X * 2.5, DVec3::Z * 1.5), shiny, None);
    quad(&mut world, at(-2.5, 0.0, 1.5), (DVec3::Y * 2.5, DVec3::Z * 1.5), shiny, None);
    sphere(&mut world, at(0.7, 0.2, 0.8), 0.8, clear, None);
    sphere(&mut world, at(-0.9, 0.6, 0.6), 0.6, shiny, None);
    let (vertices, faces) = globe(6, 4, |_, _| 0.5);
    mesh(&mut world, (vertices.into_iter().map(|v| v + at(-0.1, -0.9, 0.5)).collect(), faces), clear, None);
    mesh(&mut world, globe(5, 3, |_, _| 0.3), lamp, None);
    point_light(&mut world, at(0.5, -2.0, 3.0), 9.0);
    camera(&mut world, at(0.4, -4.0, 1.7), at(0.0, 0.0, 0.8), 0.9);
    world
}

#[test]
fn a_tree_of_mirrors_and_glass_is_the_oracles_to_rounding() {
    let world = specular();
    let (streams, reference) = (tree(&world, 1).image, oracle::render_whitted(&world, (SIZE, SIZE), 1, 1));
    let mut apart = 0;
    for (streams, reference) in streams.pixels.iter().zip(&reference) {
        let close = |k: usize| (f64::from(streams[k]) - reference.mean[k]).abs() <= 1e-3 * (reference.mean[k] + 0.05);
        apart += u32::from(!(0..3).all(close));
    }
    // A ray at an edge may fall on either side; many bounces between curved surfaces make more of rounding.
    assert!(apart <= SIZE * SIZE / 100, "{apart} of {} pixels differ", SIZE * SIZE);
}

#[test]
fn direct_light_of_lamps_and_sky_is_the_oracles() {
    for (name, world) in [
        ("lamps", scenes::lamps_of_all_kinds()),
        ("balls", scenes::room_with_balls()),
        ("mesh", scenes::mesh_in_the_open()),
        ("sky", scenes::under_the_sky()),
    ] {
        let streams = of_streams(&tree(&world, 256));
        let reference = of_oracle(&oracle::render_whitted(&world, (SIZE, SIZE), 192, 3));
        assert_agree(name, &streams, &reference, 0.01);
    }
}
