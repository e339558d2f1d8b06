//! Where samples go is decided by samples alone: adaptive images are the same whatever the machine does, too.

use smalti_core::render::Level;
use smalti_core::settings::{Integrator, Settings};
use smalti_image::hash;
use smalti_tests::draw::{Way, film, scene};

fn settings(integrator: Integrator, spp: u32) -> Settings {
    Settings { integrator, adaptive: true, spp, width: 70, height: 40, ..Settings::default() }
}

#[test]
fn threads_and_levels_with_adaptive_sampling() {
    let world = scene("hexroom").world;
    for settings in [settings(Integrator::Path, 200), settings(Integrator::Auto, 135), settings(Integrator::Path, 40)] {
        let one = film(&world, &settings, Way::default());
        let expected = hash(&one.develop());
        let (least, most) = one.samples();
        assert_eq!(least < most, settings.spp > 64, "{least} to {most}");
        for (threads, level) in [(3, Level::available()[0]), (2, Level::Scalar)] {
            let way = Way { threads, level, ..Way::default() };
            assert_eq!(hash(&film(&world, &settings, way).develop()), expected, "{way:?} {settings:?}");
        }
    }
}

/// Fewer passes are the first ones: whoever stops at a pass can say how many there were.
#[test]
fn adaptive_passes_are_a_prefix_of_more() {
    let world = scene("cornell").world;
    let samples = |spp| {
        let film = film(&world, &settings(Integrator::Path, spp), Way::default());
        film.tiles.iter().map(|tile| tile.samples()).collect::<Vec<_>>()
    };
    let [some, more] = [samples(96), samples(128)];
    assert!(some.iter().zip(&more).all(|(some, more)| some <= more), "{some:?} {more:?}");
}
