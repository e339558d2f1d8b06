//! The ground as a ball, and lamps from a hundred metres to beyond the planets.

use glam::DVec3;
use smalti_core::scene::soundness::{Finding, examine};
use smalti_core::scene::{Frame, World, contact};
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, grey, material, mesh, polygon, quad, sphere};
use smalti_tests::estimate::{Rendered, render, settings};

fn by_paths(spp: u32) -> Settings {
    Settings { integrator: Integrator::Path, ..settings(16, 8, spp) }
}

/// A ball of 1 m on a ground, under a sky and a lamp; seen is the shadow beneath the ball.
fn on_a_ground(scale: f64, ground: impl Fn(&mut World, usize)) -> World {
    let mut world = World { environment: Some([1.0; 3]), ..World::default() };
    let (earth, red) = (material(&mut world, grey(0.5)), material(&mut world, grey(0.3)));
    ground(&mut world, earth);
    sphere(&mut world, at(0.0, 0.0, 0.5), 0.5, red, None);
    sphere(&mut world, at(3.0, -3.0, 5.0), 0.3, red, Some(40.0));
    camera(&mut world, at(0.0, -4.0, 1.5), at(0.1, -0.1, 0.1), 0.15);
    world.placed(scale, |point| scale * point)
}

fn is_rough(world: &World) -> bool {
    let frame = Frame::of(world);
    let found = examine(world, &frame, &contact::pairs(world, &frame));
    found.iter().any(|finding| matches!(finding, Finding::Rough { .. }))
}

/// As on a plane, as long as nobody is told that it is not: in any unit of length.
#[test]
fn the_ground_may_be_a_ball_until_it_is_noted() {
    for scale in [1e-3, 1.0, 1e3] {
        let plane = |world: &mut World, earth| quad(world, DVec3::ZERO, (DVec3::X * 1e3, DVec3::Y * 1e3), earth, None);
        let flat = on_a_ground(scale, plane);
        assert!(!is_rough(&flat));
        let truth = render(&flat, &by_paths(1024)).mean[0];
        for (radius, noted) in [(1e3, false), (1e4, false), (1e6, true), (1e8, true), (1e12, true)] {
            let round = on_a_ground(scale, |world, earth| sphere(world, at(0.0, 0.0, -radius), radius, earth, None));
            assert_eq!(is_rough(&round), noted, "{radius} × {scale}");
            let mean = render(&round, &by_paths(1024)).mean[0];
            assert!(noted || (mean / truth - 1.0).abs() < 0.02, "{radius} × {scale}: {mean} instead of {truth}");
        }
    }
}

/// A planet in the sky, and one that nothing small lies on, are none of that.
#[test]
fn a_planet_far_away_is_not_noted() {
    let plane = |world: &mut World, earth| {
        quad(world, DVec3::ZERO, (DVec3::X * 1e3, DVec3::Y * 1e3), earth, None);
        sphere(world, at(0.0, 4e8, 1e7), 1.7e6, earth, None);
    };
    assert!(!is_rough(&on_a_ground(1.0, plane)));
}

/// The four corners of a lamp of this half width that looks at the origin.
fn lamp(centre: DVec3, half: f64) -> [DVec3; 4] {
    let (right, up) = (-centre.normalize()).any_orthonormal_pair();
    [-right - up, right - up, right + up, up - right].map(|corner| centre + half * corner)
}

/// A lamp of one solid angle, at any distance: a floor has of it what the closed form says.
#[test]
fn a_lamp_may_be_as_far_as_one_likes() {
    for distance in [1e2, 1e4, 1e6, 1e8, 1e11] {
        for part in [1e-2, 1e-4] {
            for kind in 0..3 {
                let mut world = World::default();
                let white = material(&mut world, grey(0.5));
                quad(&mut world, DVec3::ZERO, (DVec3::X, DVec3::Y), white, None);
                let (centre, half) = (distance * at(0.6, 0.0, 0.8), part * distance);
                let radiance = Some(1.0 / (part * part));
                let area = match kind {
                    0 => {
                        sphere(&mut world, centre, half, white, radiance);
                        core::f64::consts::PI
                    }
                    1 => {
                        polygon(&mut world, &lamp(centre, half), white, radiance);
                        4.0
                    }
                    _ => {
                        mesh(&mut world, (lamp(centre, half).to_vec(), vec![[0, 1, 2], [0, 2, 3]]), white, radiance);
                        4.0
                    }
                };
                camera(&mut world, at(0.1, 0.2, 3.0), at(0.1, 0.2, 0.0), 0.1);
                let Rendered { mean, .. } = render(&world, &by_paths(64));
                let truth = 0.5 / core::f64::consts::PI * area * 0.8;
                let name = format!("kind {kind}, {part} of {distance}");
                assert!((mean[0] / truth - 1.0).abs() < 0.01, "{name}: {} instead of {truth}", mean[0]);
            }
        }
    }
}
