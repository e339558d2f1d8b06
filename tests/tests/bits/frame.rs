//! The same scene in another unit of length, or somewhere else: the same bits, as no epsilon is absolute.

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Settings};
use smalti_image::hash;
use smalti_scene::Loaded;
use smalti_tests::draw::{Way, draw, load, scene_files};

/// The world with lengths `factor` times as large, as bright as before.
fn scaled(world: &World, factor: f64) -> World {
    world.placed(factor, |point| point * factor)
}

/// The settings in the same unit: photon radii are lengths too.
fn rescaled(settings: &Settings, factor: f64) -> Settings {
    Settings { radius: settings.radius.map(|radius| radius * factor), ..settings.clone() }
}

/// 2^k.
fn power_of_two(k: i64) -> f64 {
    f64::from_bits(((1023 + k) as u64) << 52)
}

/// Every scene of the folder, with its own settings made small, and its file's name.
fn scenes_of(folder: &str) -> Vec<(String, Loaded, Settings)> {
    let small = |path: std::path::PathBuf| {
        let loaded = load(&path);
        let settings = loaded.settings.settings();
        let settings = Settings { width: 24, height: 16, crop: None, spp: 2, ..settings };
        (path.file_name().unwrap().to_string_lossy().into_owned(), loaded, settings)
    };
    scene_files(folder).into_iter().map(small).collect()
}

/// Every scene of the repository that loads.
fn scenes() -> Vec<(String, Loaded, Settings)> {
    scenes_of("scenes").into_iter().chain(scenes_of("tests/scenes/golden")).collect()
}

/// Asserts that no bit depends on the unit of length.
fn assert_scale_free(name: &str, world: &World, settings: &Settings) {
    let expected = hash(&draw(world, settings, Way::default()));
    for k in [-40, -20, -1, 1, 20, 40] {
        let factor = power_of_two(k);
        let found = hash(&draw(&scaled(world, factor), &rescaled(settings, factor), Way::default()));
        assert_eq!(found, expected, "{name}, {} × 2^{k}", settings.integrator.name());
    }
}

#[test]
fn any_power_of_two_as_unit_of_length() {
    let scenes = scenes();
    assert!(scenes.iter().any(|(_, loaded, _)| !loaded.world.point_lights.is_empty()), "intensities are scaled");
    assert!(scenes.iter().any(|(_, loaded, _)| loaded.world.materials.iter().any(Material::absorbs)), "and absorption");
    for (name, Loaded { world, .. }, settings) in scenes {
        assert_scale_free(&name, &world, &settings);
    }
}

#[test]
fn any_power_of_two_with_every_integrator() {
    let scenes = scenes_of("scenes");
    assert!(scenes.len() >= 7);
    for (name, Loaded { world, .. }, settings) in scenes {
        for integrator in Integrator::ALL {
            let settings = Settings { integrator, shadow_rays: 2, photons: Some(20_000), ..settings.clone() };
            assert_scale_free(&name, &world, &settings);
        }
    }
}

/// The world with every coordinate rounded to a multiple of `grid`: then sums with multiples of it are exact.
fn on_grid(world: &World, grid: f64) -> World {
    let mut world = world.placed(1.0, |point| (point / grid).round() * grid);
    world.spheres.iter_mut().for_each(|sphere| sphere.radius = (sphere.radius / grid).round() * grid);
    world
}

/// The world moved by `by`, which must be exact.
fn moved(world: &World, by: DVec3) -> World {
    world.placed(1.0, |point| {
        assert_eq!((point + by) - by, point, "the translation is not exact");
        point + by
    })
}

#[test]
fn any_place_that_is_exact() {
    let grid = power_of_two(-22);
    let far = power_of_two(26);
    let places = [
        DVec3::new(1.0, 0.0, 0.0),
        DVec3::new(-5.5, 17.25, grid),
        DVec3::new(1000.0 * grid, -4096.0, 3.0 * grid),
        DVec3::new(far, -3.0 * far, far / 2.0 + grid),
    ];
    for (name, Loaded { world, .. }, settings) in scenes() {
        let world = on_grid(&world, grid);
        let expected = hash(&draw(&world, &settings, Way::default()));
        for place in places {
            let found = hash(&draw(&moved(&world, place), &settings, Way::default()));
            assert_eq!(found, expected, "{name} moved by {place}");
        }
        let both = moved(&scaled(&world, 4.0), places[3] * 4.0);
        let found = hash(&draw(&both, &rescaled(&settings, 4.0), Way::default()));
        assert_eq!(found, expected, "{name} scaled and moved");
    }
}
