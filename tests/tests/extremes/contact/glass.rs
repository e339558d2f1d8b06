//! Glass against glass.

use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Settings};
use smalti_tests::build::{at, camera, grey, material};
use smalti_tests::estimate::{assert_near, render, settings};

use super::{KINDS, Kind, by_paths, dust, elsewhere, faces_of_box, from_above, put, square, under_a_sky};

/// Radiance from a pile of plates over a black ground, each mirroring the next, for perpendicular light: of index and of what
/// light loses on the way through it.
fn pile(plates: &[(f64, f64)]) -> f64 {
    let mut below = 0.0;
    for (number, (index, passes)) in plates.iter().enumerate().rev() {
        let above = if number == 0 { 1.0 } else { plates[number - 1].0 };
        let amplitude = (index - above) / (index + above);
        let mirrored = amplitude * amplitude;
        let (passed, beneath) = (1.0 - mirrored, passes * passes * below);
        below = mirrored + passed * passed * beneath / (1.0 - mirrored * beneath);
    }
    below
}

/// Plates of these indices and absorptions, from the top, each 0.5 thick, on a black table.
fn piled(plates: &[(f64, f64)], kinds: [Kind; 2], last_first: bool) -> World {
    let mut world = under_a_sky();
    let black = material(&mut world, grey(0.0));
    let count = plates.len();
    let mut order: Vec<usize> = (0..count).collect();
    if last_first {
        order.reverse();
    }
    for number in order {
        let (ior, absorption) = plates[number];
        let glass = material(&mut world, Material::Dielectric { ior, absorption: [absorption; 3] });
        let (low, half) = (0.5 * (count - 1 - number) as f64, 20.0 + 3.0 * number as f64);
        let plate = faces_of_box(at(-half, -half, low), at(half, half, low + 0.5));
        put(&mut world, plate, kinds[number % 2], glass);
    }
    put(&mut world, square(50.0, 0.0), kinds[0], black);
    from_above(&mut world);
    world
}

#[test]
fn glass_on_glass_has_one_boundary() {
    let piles: [&[(f64, f64)]; 6] = [
        &[(1.5, 0.0), (1.5, 0.0)],
        &[(1.5, 0.0), (1.33, 0.0)],
        &[(1.33, 0.0), (2.4, 0.0)],
        &[(1.5, 0.0), (1.5, 0.0), (1.7, 0.0)],
        &[(1.5, 0.7), (2.0, 0.3)],
        &[(1.3, 0.4), (1.3, 0.0), (2.2, 1.0)],
    ];
    for plates in piles {
        let with_losses: Vec<(f64, f64)> = plates.iter().map(|(n, loss)| (*n, libm::exp(-0.5 * loss))).collect();
        let truth = pile(&with_losses);
        for kinds in [[Kind::Quads; 2], [Kind::Mesh; 2], [Kind::Quads, Kind::Mesh]] {
            for last_first in [false, true] {
                for (k, in_a_tree) in [(0, false), (0, true), (3, false), (6, true)] {
                    let mut world = piled(plates, kinds, last_first);
                    if in_a_tree {
                        dust(&mut world, 0);
                    }
                    let name = format!("{plates:?}, {kinds:?}, reversed {last_first}, place {k}, tree {in_a_tree}");
                    let whitted = Settings { integrator: Integrator::Whitted, ..settings(2, 2, 16) };
                    render(&elsewhere(&world, k), &whitted).assert_every_pixel(&name, truth, 2e-3);
                }
            }
        }
        let found = render(&piled(plates, KINDS, false), &by_paths(8192));
        assert_near(&format!("{plates:?} by paths"), (found.mean[0], found.standard_error[0]), truth, 0.02);
    }
}

/// Where glass lies on glass in part: beside the upper plate the lower one has the sky on it.
#[test]
fn each_hit_finds_out_whether_glass_is_there() {
    for (x, truth) in [(0.3, pile(&[(1.5, 1.0), (2.0, 1.0)])), (21.0, pile(&[(2.0, 1.0)]))] {
        for kinds in [[Kind::Quads; 2], [Kind::Mesh; 2], [Kind::Quads, Kind::Mesh], [Kind::Mesh, Kind::Quads]] {
            let mut world = piled(&[(1.5, 0.0), (2.0, 0.0)], kinds, false);
            world.cameras.clear();
            camera(&mut world, at(x, 0.2, 40.0), at(x, 0.2, 0.0), 0.005);
            let whitted = Settings { integrator: Integrator::Whitted, ..settings(2, 2, 16) };
            render(&world, &whitted).assert_every_pixel(&format!("at {x}, {kinds:?}"), truth, 2e-3);
        }
    }
}

/// Of one kind of glass a box in two halves is a box.
#[test]
fn two_halves_of_glass_are_one_box() {
    let halves = |parts: &[(f64, f64)], kind: Kind| {
        let mut world = under_a_sky();
        let clear = material(&mut world, Material::Dielectric { ior: 1.5, absorption: [0.8, 0.2, 0.0] });
        for (low, high) in parts {
            put(&mut world, faces_of_box(at(*low, -1.0, -1.0), at(*high, 1.0, 1.0)), kind, clear);
        }
        camera(&mut world, at(3.0, 4.0, 2.0), at(0.0, 0.0, 0.0), 0.5);
        world
    };
    let whole = render(&halves(&[(-1.0, 1.0)], Kind::Quads), &by_paths(4096)).mean;
    for kind in KINDS {
        for parts in [[(-1.0, 0.0), (0.0, 1.0)], [(0.3, 1.0), (-1.0, 0.3)]] {
            let found = render(&halves(&parts, kind), &by_paths(4096));
            for channel in 0..3 {
                assert!(
                    (found.mean[channel] / whole[channel] - 1.0).abs() < 0.004,
                    "{kind:?}: {:?} {whole:?}",
                    found.mean
                );
            }
        }
    }
}
