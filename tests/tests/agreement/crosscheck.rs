//! Light that photons bring, found again by paths in the same render.

use smalti_core::film::Film;
use smalti_core::render::Level;
use smalti_core::settings::{Integrator, Settings};
use smalti_measure::{BiasStatement, CrosscheckStatement, bias_statement};
use smalti_tests::draw::{Way, film, scene};

fn settings(integrator: Integrator, radius: Option<f64>, seed: u64) -> Settings {
    Settings { integrator, radius, seed, width: 64, height: 64, spp: 64, ..Settings::default() }
}

fn rendered(name: &str, settings: &Settings) -> Film {
    film(&scene(name).world, settings, Way::default())
}

fn stated(name: &str, settings: &Settings) -> BiasStatement {
    bias_statement(&rendered(name, settings)).expect("there are photons and two rounds")
}

fn checked(name: &str, settings: &Settings) -> CrosscheckStatement {
    stated(name, settings).crosscheck.expect("paths find some of that light")
}

#[test]
fn paths_find_again_what_photons_bring() {
    for (name, integrator) in
        [("hexroom", Integrator::Auto), ("tinted", Integrator::Auto), ("hexroom", Integrator::Photon)]
    {
        let checks: Vec<_> = (0..8).map(|seed| checked(name, &settings(integrator, None, seed))).collect();
        let mean = |of: &dyn Fn(&CrosscheckStatement) -> f64| checks.iter().map(of).sum::<f64>() / 8.0;
        let (photons, off) = (mean(&|check| check.by_photons), mean(&|check| check.by_paths - check.by_photons));
        let spread =
            mean(&|check| (check.by_paths - check.by_photons - off) * (check.by_paths - check.by_photons - off));
        let error = (spread / 7.0).sqrt();
        assert!(off.abs() < 5.4 * error && error < 0.03 * photons, "{name}: {off} ± {error} of {photons}");
        // The stated interval is that of the spread over seeds.
        let half = mean(&|check| check.interval.map_or(f64::NAN, |[low, high]| (high - low) / 2.0)) / 1.96;
        assert!((0.4..2.5).contains(&(half / (8.0 * error * error).sqrt())), "{name}: {half} and {error}");
        assert!(checks.iter().all(|check| check.lacking == 0.0 && check.finds > 100.0), "{name}: {checks:?}");
    }
}

/// Radii as wide as the room: half of the disc says little of the bias, paths still find the light where it belongs.
#[test]
fn light_that_photons_put_elsewhere_is_stated() {
    let wide = stated("tinted", &settings(Integrator::Auto, Some(3.0), 0));
    let check = wide.crosscheck.expect("paths find some of that light");
    assert!(check.lacking > 0.04 && check.lacking_high > check.lacking, "{wide:?}");
    assert!(wide.relative_bias_high >= check.lacking_high, "{wide:?}");
    assert!(check.interval.is_some_and(|[low, _]| low > 1.5 * check.by_photons), "{wide:?}");
}

#[test]
fn the_check_is_the_same_by_threads_tiles_and_simd_levels() {
    let settings = Settings { spp: 32, ..settings(Integrator::Auto, None, 0) };
    let of = |way| bias_statement(&film(&scene("tinted").world, &settings, way)).expect("there are photons");
    let one = of(Way::default());
    for (threads, tile) in [(2, 7), (3, 1000)] {
        assert_eq!(of(Way { threads, tile, ..Way::default() }), one, "{threads} {tile}");
    }
    for level in Level::available() {
        assert_eq!(of(Way { level, ..Way::default() }), one, "{level:?}");
    }
}

/// Lamps without area are met by no path, and without photons there is nothing to check.
#[test]
fn nothing_is_noted_where_nothing_is_found_twice() {
    let points = rendered("hexroom-points", &settings(Integrator::Auto, None, 0));
    assert!(points.crosschecks().is_none() && points.shifts().is_some());
    assert!(rendered("tinted", &settings(Integrator::Path, None, 0)).crosschecks().is_none());
}
