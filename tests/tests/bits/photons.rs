//! Photon maps change no promise: the same bits whatever the machine does, and samples that depend on nothing later.

use glam::DVec3;
use smalti_core::film::{Counts, Film, Image, Pixel};
use smalti_core::photon::{Kind, Quantity, Show};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{Integrator, Rect, SamplerKind, Settings};
use smalti_image::hash;
use smalti_scheduler::{Cancel, Watch, pool, render};
use smalti_tests::build::{at, camera, closed_box, grey, material, point_light};
use smalti_tests::draw::{Way, draw, renderer, scene};

const SIZE: (u32, u32) = (24, 16);

/// Both integrators that ask photons, with the samplers and radii by density and given.
fn choices() -> [Settings; 4] {
    let of = |integrator, sampler, radius, photons| Settings {
        integrator,
        sampler,
        radius,
        width: SIZE.0,
        height: SIZE.1,
        photons: Some(photons),
        spp: 18,
        ..Settings::default()
    };
    // No multiples of the 16 parts, and once more than a batch for each.
    [
        of(Integrator::Auto, SamplerKind::Sobol, None, 66_001),
        of(Integrator::Auto, SamplerKind::Independent, Some(0.3), 5003),
        of(Integrator::Photon, SamplerKind::Sobol, None, 10_007),
        of(Integrator::Photon, SamplerKind::Independent, Some(0.3), 5003),
    ]
}

/// The reference room: diffuse walls, mirror and glass.
fn room() -> World {
    let world = scene("hexroom").world;
    for settings in choices() {
        let renderer = of(&world, &settings);
        let photons = renderer.plan().photons.as_ref().expect("there are caustics");
        assert!(photons.caustic.is_some() && photons.global.is_some() == (settings.integrator == Integrator::Photon));
    }
    world
}

fn of(world: &World, settings: &Settings) -> Renderer {
    renderer(world, settings, Level::available()[0])
}

fn hash_of(world: &World, settings: &Settings, way: Way) -> String {
    hash(&draw(world, settings, way))
}

#[test]
fn threads_tiles_and_simd_levels_with_photons() {
    let world = room();
    for settings in choices() {
        let one = hash_of(&world, &settings, Way::default());
        for (threads, tile) in [(2, 7), (3, 1000)] {
            let way = Way { threads, tile, ..Way::default() };
            assert_eq!(hash_of(&world, &settings, way), one, "{way:?} {settings:?}");
        }
        for level in Level::available() {
            let way = Way { level, threads: 2, ..Way::default() };
            assert_eq!(hash_of(&world, &settings, way), one, "{way:?} {settings:?}");
        }
    }
}

/// Points of a packet look at a map together or one by one: whatever it is, and whoever else is in the packet.
#[test]
fn threads_tiles_and_simd_levels_where_a_map_is_seen() {
    let world = room();
    for (map, quantity) in [(Kind::Caustic, Quantity::Radiance), (Kind::Global, Quantity::Count)] {
        let [settings, ..] = choices();
        let settings = Settings { spp: 4, ..settings };
        let seen = |way: Way| {
            let show = Show { map, quantity };
            let renderer = Renderer::showing(&world, settings.clone(), show, way.level).expect("there are photons");
            let film = Film::new(settings.area(), way.tile);
            let pool = pool(way.threads).expect("threads");
            render(&renderer, film, &pool, &Cancel::default(), None).expect("no panic").film.develop()
        };
        let one = seen(Way::default());
        assert!(one.pixels.iter().filter(|pixel| pixel[0] > 0.0).count() > one.pixels.len() / 2);
        for (threads, tile) in [(2, 7), (3, 1000), (1, 1)] {
            let way = Way { threads, tile, ..Way::default() };
            assert_eq!(hash(&seen(way)), hash(&one), "{way:?} {map:?}");
        }
        for level in Level::available() {
            assert_eq!(hash(&seen(Way { level, ..Way::default() })), hash(&one), "{level:?} {map:?}");
        }
    }
}

/// The photons of every level are the same, one by one.
#[test]
fn every_simd_level_emits_the_same_photons() {
    let world = room();
    for settings in choices() {
        let maps = |level: Level| renderer(&world, &settings, level).maps(1, Default::default(), &Default::default());
        let best = maps(Level::available()[0]);
        for level in Level::available() {
            assert!(maps(level) == best, "{level:?} {settings:?}");
        }
    }
}

#[test]
fn a_crop_with_photons_is_a_part_of_the_whole() {
    let world = room();
    for settings in choices() {
        let whole = draw(&world, &settings, Way::default());
        for (x, y, width, height) in [(0, 0, 1, 1), (23, 15, 1, 1), (5, 7, 13, 6)] {
            let row = |y: u32| &whole.pixels[(y * whole.width + x) as usize..][..width as usize];
            let pixels: Vec<[f32; 3]> = (y..y + height).flat_map(row).copied().collect();
            let cropped = Settings { crop: Some(Rect { x, y, width, height }), ..settings.clone() };
            let way = Way { tile: 5, ..Way::default() };
            assert_eq!(hash_of(&world, &cropped, way), hash(&Image { width, height, pixels }), "{cropped:?}");
        }
    }
}

/// A film of 5 samples is continued to 40, and one is stopped in between: the same as 40 at once.
#[test]
fn a_render_with_photons_can_be_extended_and_resumed() {
    let world = room();
    let pool = pool(2).unwrap();
    let finish = |settings: &Settings, film: Film, cancel: &Cancel, watch: Option<Watch>| {
        render(&of(&world, settings), film, &pool, cancel, watch).unwrap()
    };
    for settings in choices() {
        let long = Settings { spp: 40, ..settings.clone() };
        let at_once = hash_of(&world, &long, Way::default());
        for stop in [5, 17] {
            let short = Settings { spp: stop, ..settings.clone() };
            let begun = finish(&short, Film::new(settings.area(), 7), &Cancel::default(), None);
            assert_eq!(hash(&begun.film.develop()), hash_of(&world, &short, Way::default()));
            let extended = finish(&long, begun.film, &Cancel::default(), None);
            assert_eq!(hash(&extended.film.develop()), at_once, "{stop}: {settings:?}");
        }
        let cancel = Cancel::default();
        let stop = cancel.clone();
        let error = move |film: &Film| {
            if film.samples().0 >= 16 {
                stop.cancel();
            }
            None
        };
        let watch = Watch { error: Some(Box::new(error)), ..Watch::new(crossbeam::channel::unbounded().0) };
        let stopped = finish(&long, Film::new(settings.area(), 7), &cancel, Some(watch));
        assert!(stopped.interrupted && stopped.film.samples().1 < 40);
        let resumed = finish(&long, stopped.film, &Cancel::default(), None);
        assert_eq!(hash(&resumed.film.develop()), at_once, "{settings:?}");
    }
}

#[test]
fn a_replayed_sample_with_photons_is_what_the_film_got() {
    let world = room();
    for settings in choices() {
        let renderer = of(&world, &settings);
        let film = Film::new(settings.area(), 64);
        let finished = render(&renderer, film, &pool(2).unwrap(), &Cancel::default(), None).unwrap().film;
        let (x, y) = (11, 9);
        let (mut replayed, mut counts) = (Pixel::default(), Counts::default());
        for sample in 0..settings.spp {
            replayed.add(counts.batch(), 1.0, renderer.replay((x, y), sample).1);
            counts.add_plain();
        }
        assert_eq!(replayed, finished.tiles[0].pixels[(y * SIZE.0 + x) as usize], "{settings:?}");
    }
}

#[test]
fn any_power_of_two_as_unit_of_length_with_photons() {
    let mut world = room();
    point_light(&mut world, DVec3::new(2.0, 1.0, 3.0), 4.0);
    for settings in choices() {
        let expected = hash_of(&world, &settings, Way::default());
        for k in [-40i64, -1, 40] {
            let factor = f64::from_bits(((1023 + k) as u64) << 52);
            let scaled = Settings { radius: settings.radius.map(|radius| radius * factor), ..settings.clone() };
            let world = world.placed(factor, |point| point * factor);
            assert_eq!(hash_of(&world, &scaled, Way::default()), expected, "× 2^{k} {settings:?}");
        }
    }
}

/// Where nothing is specular there are no caustics, and `auto` is `path`.
#[test]
fn without_casters_auto_is_path() {
    for name in ["cornell", "furnace"] {
        let mut world = scene(name).world;
        world.materials.iter_mut().filter(|material| !matches!(material, Material::Lambert { .. })).for_each(
            |material| {
                *material = grey(0.5);
            },
        );
        assert_same_as_path(name, &world);
    }
    let mut bare = World::default();
    let wall = material(&mut bare, grey(0.5));
    closed_box(&mut bare, DVec3::ZERO, DVec3::ONE, wall, None);
    point_light(&mut bare, at(0.2, 0.1, 0.5), 1.0);
    camera(&mut bare, at(0.0, -0.9, 0.0), DVec3::ZERO, 1.2);
    assert_same_as_path("a lit box", &bare);
}

fn assert_same_as_path(name: &str, world: &World) {
    let auto = Settings { integrator: Integrator::Auto, width: SIZE.0, height: SIZE.1, spp: 18, ..Settings::default() };
    let path = Settings { integrator: Integrator::Path, ..auto.clone() };
    assert!(of(world, &auto).plan().photons.is_none(), "{name}");
    assert_eq!(hash_of(world, &auto, Way::default()), hash_of(world, &path, Way::default()), "{name}");
}
