//! A sample depends on nothing later: renders can be extended, stopped, resumed and replayed.

use std::sync::atomic::AtomicU64;

use smalti_core::film::{Counts, Film, Pixel, Tile};
use smalti_core::photon::Maps;
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::settings::{Integrator, Rect, SamplerKind, Settings};
use smalti_image::hash;
use smalti_scheduler::{Cancel, Watch, pool, render};
use smalti_tests::draw::{Way, draw, renderer, scene};

const AREA: Rect = Rect { x: 3, y: 5, width: 9, height: 7 };

fn small(integrator: Integrator, sampler: SamplerKind) -> Settings {
    let size = Settings { width: 24, height: 16, crop: Some(AREA), shadow_rays: 2, ..Settings::default() };
    Settings { integrator, sampler, ..size }
}

/// Every integrator with every sampler.
fn choices() -> [Settings; 4] {
    let [path, whitted] = [Integrator::Path, Integrator::Whitted];
    let [sobol, independent] = [SamplerKind::Sobol, SamplerKind::Independent];
    [small(path, sobol), small(path, independent), small(whitted, sobol), small(whitted, independent)]
}

/// The tile after it was advanced to each of `stops`.
fn advance(renderer: &Renderer, stops: &[u32]) -> Tile {
    let mut tile = Film::new(AREA, 64).tiles.remove(0);
    let mut workspace = renderer.workspace();
    for &stop in stops {
        renderer.advance(&mut tile, stop, &Maps::default(), &mut workspace, &AtomicU64::new(0));
    }
    tile
}

fn of(world: &World, settings: &Settings) -> Renderer {
    renderer(world, settings, Level::available()[0])
}

#[test]
fn samples_taken_at_once_or_one_after_the_other() {
    let world = scene("hexroom").world;
    for settings in choices() {
        let renderer = of(&world, &settings);
        let at_once = advance(&renderer, &[21]);
        assert_eq!(advance(&renderer, &[5, 21]).pixels, at_once.pixels, "{settings:?}");
        assert_eq!(advance(&renderer, &(1..=21).collect::<Vec<_>>()).pixels, at_once.pixels, "{settings:?}");
    }
}

#[test]
fn a_longer_render_begins_with_the_shorter_one() {
    let world = scene("hexroom").world;
    for settings in choices() {
        let mut stops = Vec::new();
        for spp in [1, 2, 3, 7, 15, 16, 17, 32, 33] {
            stops.push(spp);
            let longer = of(&world, &Settings { spp: 100, ..settings.clone() });
            let shorter = of(&world, &Settings { spp, ..settings.clone() });
            assert_eq!(advance(&longer, &stops).pixels, advance(&shorter, &[spp]).pixels, "{settings:?}");
        }
    }
}

#[test]
fn a_render_that_was_stopped_is_the_beginning_and_can_go_on() {
    let world = scene("hexroom").world;
    let settings = Settings { width: 24, height: 16, spp: 70, ..Settings::default() };
    let (renderer, pool) = (of(&world, &settings), pool(2).unwrap());
    let cancel = Cancel::default();
    let stop = cancel.clone();
    let error = move |film: &Film| {
        if film.samples().0 >= 8 {
            stop.cancel();
        }
        None
    };
    let watch = Watch { error: Some(Box::new(error)), ..Watch::new(crossbeam::channel::unbounded().0) };
    let stopped = render(&renderer, Film::new(settings.area(), 7), &pool, &cancel, Some(watch)).unwrap();
    assert!(stopped.interrupted);
    assert_eq!(stopped.film.samples(), (8, 8));
    let short = Settings { spp: 8, ..settings.clone() };
    assert_eq!(hash(&stopped.film.develop()), hash(&draw(&world, &short, Way::default())));
    let resumed = render(&renderer, stopped.film, &pool, &Cancel::default(), None).unwrap();
    assert_eq!(hash(&resumed.film.develop()), hash(&draw(&world, &settings, Way::default())));
}

#[test]
fn tiles_with_fewer_samples_are_the_beginning_of_theirs() {
    let world = scene("hexroom").world;
    let settings = Settings { width: 24, height: 16, spp: 40, ..Settings::default() };
    let renderer = of(&world, &settings);
    let uneven = |index: usize| [3, 40, 16, 17, 1, 33][index % 6];
    let mut film = Film::new(settings.area(), 7);
    let mut workspace = renderer.workspace();
    for (index, tile) in film.tiles.iter_mut().enumerate() {
        renderer.advance(tile, uneven(index), &Maps::default(), &mut workspace, &AtomicU64::new(0));
    }
    for (index, tile) in film.tiles.iter().enumerate() {
        let short = Settings { spp: uneven(index), crop: Some(tile.area), ..settings.clone() };
        let pixels: Vec<[f32; 3]> =
            tile.pixels.iter().map(|pixel| pixel.mean(&tile.counts).map(|value| value as f32)).collect();
        assert_eq!(draw(&world, &short, Way::default()).pixels, pixels, "{:?}", tile.area);
    }
    let finished = render(&renderer, film, &pool(2).unwrap(), &Cancel::default(), None).unwrap();
    assert_eq!(hash(&finished.film.develop()), hash(&draw(&world, &settings, Way::default())));
}

#[test]
fn a_replayed_sample_is_what_the_film_got() {
    for name in ["hexroom", "furnace", "blob"] {
        let world = scene(name).world;
        for settings in choices() {
            let renderer = of(&world, &settings);
            let tile = advance(&renderer, &[18]);
            for (index, expected) in tile.pixels.iter().enumerate().step_by(3) {
                let pixel = (AREA.x + index as u32 % AREA.width, AREA.y + index as u32 / AREA.width);
                let (mut replayed, mut counts) = (Pixel::default(), Counts::default());
                for sample in 0..18 {
                    replayed.add(counts.batch(), 1.0, renderer.replay(pixel, sample).1);
                    counts.add_plain();
                }
                assert_eq!(replayed, *expected, "{name} {pixel:?} {settings:?}");
            }
        }
    }
}

#[test]
fn the_last_vertex_of_a_replay_has_the_radiance_of_the_sample() {
    let world = scene("hexroom").world;
    for settings in choices() {
        let renderer = of(&world, &settings);
        for sample in 0..50 {
            let (vertices, radiance) = renderer.replay((8, 8), sample);
            assert_eq!(vertices.last().unwrap().radiance, radiance);
            assert!(vertices.windows(2).all(|pair| pair[0].bounce <= pair[1].bounce));
        }
    }
}
