//! Threads, tiles, SIMD levels, watchers, the size of the image and its crops change no bit.

use std::collections::HashSet;

use crossbeam::channel::unbounded;
use smalti_core::film::Image;
use smalti_core::render::Level;
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Rect, SamplerKind, Settings};
use smalti_image::hash;
use smalti_scheduler::{Event, Watch};
use smalti_tests::draw::{Way, draw, render, scene};

/// Both integrators with both samplers and several numbers of shadow rays.
fn choices() -> Vec<Settings> {
    let mut choices = Vec::new();
    for sampler in [SamplerKind::Sobol, SamplerKind::Independent] {
        for (integrator, shadow_rays) in [
            (Integrator::Path, 0),
            (Integrator::Path, 1),
            (Integrator::Path, 3),
            (Integrator::Whitted, 1),
            (Integrator::Whitted, 3),
        ] {
            let size = Settings { width: 48, height: 32, spp: 5, ..Settings::default() };
            choices.push(Settings { integrator, sampler, shadow_rays, ..size });
        }
    }
    choices
}

fn hash_of(world: &World, settings: &Settings, way: Way) -> String {
    hash(&draw(world, settings, way))
}

#[test]
fn threads_and_tiles_of_any_size() {
    let world = scene("hexroom").world;
    for settings in choices() {
        let one = hash_of(&world, &settings, Way::default());
        for (threads, tile) in [(1, 1), (1, 7), (2, 32), (8, 7), (1, 64), (3, 1), (2, 1000)] {
            let way = Way { threads, tile, ..Way::default() };
            assert_eq!(hash_of(&world, &settings, way), one, "{way:?} {settings:?}");
        }
    }
}

#[test]
fn every_simd_level() {
    for name in ["hexroom", "cornell", "furnace"] {
        let world = scene(name).world;
        for settings in choices() {
            let [width, height] = [33, 21];
            let settings = Settings { width, height, ..settings };
            let best = hash_of(&world, &settings, Way::default());
            for level in Level::available() {
                let way = Way { level, ..Way::default() };
                assert_eq!(hash_of(&world, &settings, way), best, "{name} {way:?} {settings:?}");
            }
        }
    }
}

#[test]
fn every_simd_level_with_a_tree() {
    let world = scene("blob").world;
    let settings = Settings { width: 32, height: 24, spp: 2, ..Settings::default() };
    let best = hash_of(&world, &settings, Way::default());
    for level in Level::available() {
        assert_eq!(hash_of(&world, &settings, Way { level, ..Way::default() }), best, "{level:?}");
    }
}

#[test]
fn odd_sizes() {
    let world = scene("hexroom").world;
    for (width, height) in [(1, 1), (1, 17), (17, 1), (65, 33), (70, 61)] {
        let settings = Settings { width, height, spp: 3, ..Settings::default() };
        let whole = draw(&world, &settings, Way { tile: 128, ..Way::default() });
        assert_eq!((whole.width, whole.height), (width, height));
        for (tile, level) in [(1, Level::available()[0]), (16, Level::Scalar), (32, Level::available()[0])] {
            let way = Way { tile, level, threads: 2 };
            assert_eq!(hash_of(&world, &settings, way), hash(&whole), "{width}×{height} {way:?}");
        }
    }
}

/// The pixels of `image` inside `area`.
fn cut(image: &Image, area: Rect) -> Vec<[f32; 3]> {
    let row = |y: u32| {
        let start = (y * image.width + area.x) as usize;
        image.pixels[start..start + area.width as usize].to_vec()
    };
    (area.y..area.y + area.height).flat_map(row).collect()
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let world = scene("hexroom").world;
    for settings in choices() {
        let whole = draw(&world, &settings, Way::default());
        for (x, y, width, height) in [(0, 0, 48, 32), (0, 0, 1, 1), (47, 31, 1, 1), (5, 7, 23, 11), (31, 0, 17, 32)] {
            let area = Rect { x, y, width, height };
            let cropped = Settings { crop: Some(area), ..settings.clone() };
            let expected = Image { width, height, pixels: cut(&whole, area) };
            let way = Way { tile: 9, ..Way::default() };
            assert_eq!(hash_of(&world, &cropped, way), hash(&expected), "{cropped:?}");
        }
    }
}

#[test]
fn watchers_change_nothing() {
    let world = scene("hexroom").world;
    let settings = Settings { width: 48, height: 32, spp: 40, ..Settings::default() };
    let alone = draw(&world, &settings, Way::default());
    let (sender, events) = unbounded();
    let error = Some(Box::new(|film: &smalti_core::film::Film| film.estimates().map(|all| all.len() as f64)) as _);
    let watch = Watch { pictures: true, error, ..Watch::new(sender) };
    let watched = render(&world, &settings, Way { threads: 2, tile: 16, ..Way::default() }, Some(watch));
    assert_eq!(hash(&watched.film.develop()), hash(&alone));
    let judged = events.try_iter().any(|event| matches!(event, Event::PassFinished { error: Some(_), .. }));
    assert!(judged, "nobody watched");
}

#[test]
fn whatever_may_change_the_image_does() {
    let world = scene("hexroom").world;
    let base = Settings { width: 24, height: 16, spp: 2, ..Settings::default() };
    let mut different =
        choices().into_iter().map(|s| Settings { width: 24, height: 16, spp: 2, ..s }).collect::<Vec<_>>();
    different.push(Settings { seed: 1, ..base.clone() });
    different.push(Settings { seed: 1 << 63, ..base.clone() });
    different.push(Settings { spp: 3, ..base.clone() });
    different.push(Settings { jitter: false, ..base.clone() });
    different.push(Settings { max_bounces: Some(1), ..base });
    let hashes: HashSet<String> = different.iter().map(|s| hash_of(&world, s, Way::default())).collect();
    assert_eq!(hashes.len(), different.len());
}
