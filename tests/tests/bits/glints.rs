//! Where samples go to glints, no bit depends on threads, tiles, SIMD levels or crops, and every sample can be replayed.

use smalti_core::film::Image;
use smalti_core::render::Level;
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Rect, Settings};
use smalti_image::hash;
use smalti_tests::build::{at, camera, closed_box, grey, material, mirror, sphere};
use smalti_tests::draw::{Way, draw, renderer};

/// A mirror ball in a room with three small lamps.
fn world() -> World {
    let mut world = World::default();
    let (walls, silver) = (material(&mut world, grey(0.5)), material(&mut world, mirror(0.9)));
    closed_box(&mut world, at(0.0, 0.0, 1.0), at(2.0, 2.0, 1.0), walls, None);
    sphere(&mut world, at(0.0, 0.0, 0.4), 0.4, silver, None);
    for place in [at(1.0, -1.0, 1.8), at(-1.2, -0.4, 1.5), at(0.7, 0.9, 0.9)] {
        sphere(&mut world, place, 2e-3, walls, Some(4e5));
    }
    camera(&mut world, at(0.0, -1.8, 0.8), at(0.0, 0.0, 0.5), 0.9);
    world
}

fn some_settings() -> Settings {
    Settings { width: 50, height: 40, spp: 16, integrator: Integrator::Path, ..Settings::default() }
}

#[test]
fn glints_are_the_same_by_threads_tiles_and_simd_levels() {
    let (world, settings) = (world(), some_settings());
    assert_eq!(renderer(&world, &settings, Level::available()[0]).plan().glints.len(), 3);
    let one = draw(&world, &settings, Way::default());
    let bright = one.pixels.iter().filter(|pixel| pixel[0] > 20.0).count();
    assert!(bright >= 3, "{bright} glints are too few to tell");
    for level in Level::available() {
        for (threads, tile) in [(1, 7), (2, 16), (3, 64)] {
            let way = Way { threads, tile, level };
            assert_eq!(hash(&draw(&world, &settings, way)), hash(&one), "{way:?}");
        }
    }
}

#[test]
fn glints_of_a_crop_are_those_of_the_whole() {
    let (world, settings) = (world(), some_settings());
    let whole = draw(&world, &settings, Way::default());
    for (x, y, width, height) in [(0, 0, 50, 40), (13, 9, 24, 20), (24, 18, 1, 1)] {
        let crop = Some(Rect { x, y, width, height });
        let rows = (y..y + height).map(|row| (row * 50 + x) as usize);
        let pixels = rows.flat_map(|at| whole.pixels[at..at + width as usize].to_vec()).collect();
        let cropped = draw(&world, &Settings { crop, ..settings.clone() }, Way { tile: 9, ..Way::default() });
        assert_eq!(hash(&cropped), hash(&Image { width, height, pixels }), "{crop:?}");
    }
}

#[test]
fn samples_of_a_glint_can_be_replayed() {
    let (world, settings) = (world(), some_settings());
    let whole = draw(&world, &settings, Way::default());
    let renderer = renderer(&world, &settings, Level::available()[0]);
    let brightest = (0..whole.pixels.len()).max_by(|a, b| whole.pixels[*a][0].total_cmp(&whole.pixels[*b][0])).unwrap();
    let pixel = (brightest as u32 % 50, brightest as u32 / 50);
    let sum: f64 = (0..settings.spp).map(|sample| f64::from(renderer.replay(pixel, sample).1[0])).sum();
    assert_eq!((sum / f64::from(settings.spp)) as f32, whole.pixels[brightest][0], "{pixel:?}");
}
