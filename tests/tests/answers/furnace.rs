//! Closed rooms in which radiance is the same everywhere: nothing may be lost, and nothing gained.

use core::f64::consts::PI;

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::Material;
use smalti_core::settings::{SamplerKind, Settings};
use smalti_tests::build::{
    at, camera, closed_box, globe, grey, hexagon_room, material, mesh, point_light, quad, sphere,
};
use smalti_tests::estimate::{render, settings};

/// Rooms whose inside reflects by `material` and emits 1.
fn rooms(lambert: Material) -> [(&'static str, World); 3] {
    [("box", 0), ("hexagon room", 1), ("mesh", 2)].map(|(name, shape)| {
        let mut world = World::default();
        let wall = material(&mut world, lambert);
        match shape {
            0 => closed_box(&mut world, DVec3::ZERO, at(1.0, 1.3, 0.8), wall, Some(1.0)),
            1 => hexagon_room(&mut world, wall, Some(1.0)),
            _ => {
                let (vertices, faces) = globe(7, 5, |_, _| 1.0);
                // Turned inside out: the inside emits.
                let faces = faces.into_iter().map(|[a, b, c]| [a, c, b]).collect();
                mesh(&mut world, (vertices, faces), wall, Some(1.0));
            }
        }
        camera(&mut world, at(0.1, 0.2, 0.3), at(-0.5, 1.0, 0.0), 1.4);
        (name, world)
    })
}

#[test]
fn radiance_in_a_grey_furnace_is_the_series_of_its_albedo() {
    for (albedo, spp) in [(0.5, 512), (0.8, 1024)] {
        for (name, world) in rooms(grey(albedo)) {
            for shadow_rays in [0, 1, 4] {
                let settings = Settings { shadow_rays, ..settings(32, 32, spp) };
                let name = format!("{name}, albedo {albedo}, {shadow_rays} shadow rays");
                let rendered = render(&world, &settings);
                rendered.assert_mean(&name, 1.0 / (1.0 - albedo), 0.005);
                assert_eq!(rendered.capped, 0, "{name}");
            }
        }
    }
}

#[test]
fn white_furnaces_lose_nothing_over_many_bounces() {
    let [_, (name, world), _] = rooms(grey(0.95));
    let often = Settings { shadow_rays: 0, ..settings(32, 32, 640) };
    render(&world, &often).assert_mean(name, 20.0, 0.0075);
    let [(name, world), ..] = rooms(grey(0.99));
    let often = Settings { sampler: SamplerKind::Independent, shadow_rays: 0, ..settings(32, 32, 320) };
    render(&world, &often).assert_mean(name, 100.0, 0.01);
}

#[test]
fn every_channel_of_a_coloured_furnace_has_its_own_series() {
    let coloured = Material::Lambert { albedo: [0.2, 0.5, 0.8] };
    for (name, world) in rooms(coloured) {
        for shadow_rays in [0, 1] {
            let settings = Settings { shadow_rays, ..settings(32, 32, 1024) };
            let rendered = render(&world, &settings);
            rendered.assert_rgb(&format!("{name}, {shadow_rays} shadow rays"), [1.25, 2.0, 5.0], 0.005);
        }
    }
}

#[test]
fn a_depth_limit_takes_exactly_the_tail_of_the_series() {
    let [(_, world), ..] = rooms(grey(0.8));
    for bounces in [0u32, 1, 2, 8] {
        let series: f64 = (0..=bounces).map(|k| libm::pow(0.8, f64::from(k))).sum();
        let limited = Settings { max_bounces: Some(bounces), ..settings(32, 32, 512) };
        render(&world, &limited).assert_mean(&format!("{bounces} bounces"), series, 0.005);
    }
}

#[test]
fn a_sphere_lit_from_its_centre_is_a_furnace() {
    for lights in [1, 4] {
        let mut world = World::default();
        let wall = material(&mut world, grey(0.5));
        sphere(&mut world, DVec3::ZERO, 1.0, wall, None);
        for _ in 0..lights {
            point_light(&mut world, DVec3::ZERO, PI / f64::from(lights));
        }
        camera(&mut world, at(0.2, -0.3, 0.1), DVec3::X, 1.5);
        let all = render(&world, &settings(32, 32, 512));
        all.assert_mean(&format!("{lights} lights"), 1.0, 0.005);
        let once = render(&world, &Settings { max_bounces: Some(1), ..settings(32, 32, 32) });
        once.assert_every_pixel("direct light alone", 0.5, 1e-5);
    }
}

/// A sphere with a port: everything above the plane z = 1 − 2f is cut off by a black plane, which takes the fraction f
/// of what leaves any point of the wall.
#[test]
fn an_integrating_sphere_multiplies_by_its_port_fraction() {
    for (albedo, port) in [(0.9, 0.1), (0.98, 0.02), (0.6, 0.4)] {
        let mut world = World::default();
        let (wall, black) = (material(&mut world, grey(albedo)), material(&mut world, grey(0.0)));
        sphere(&mut world, DVec3::ZERO, 1.0, wall, None);
        quad(&mut world, at(0.0, 0.0, 1.0 - 2.0 * port), (DVec3::X * 1.1, DVec3::Y * 1.1), black, None);
        point_light(&mut world, DVec3::ZERO, PI);
        camera(&mut world, at(0.2, 0.1, 0.1), at(0.1, 0.0, -1.0), 1.0);
        let expected = albedo / (1.0 - albedo * (1.0 - port));
        let name = format!("albedo {albedo}, port {port}");
        render(&world, &settings(32, 32, 768)).assert_mean(&name, expected, 0.0075);
    }
}
