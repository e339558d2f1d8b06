//! Photons that lie: trees hold each once and find what brute force finds, no light leaks through a wall, and none is
//! missing where a surface ends.

use core::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use smalti_core::lanes::{One, V3};
use smalti_core::photon::kd_tree::{BLOCK, Tree};
use smalti_core::photon::{Account, Kind, Map, Photons, Quantity, Surfaces, Tag};
use smalti_core::scene::{Scene, World, compile};
use smalti_core::settings::Settings;
use smalti_tests::build::{at, closed_box, globe, grey, material, mesh, point_light, polygon, quad};
use smalti_tests::oracle::Random;
use smalti_tests::photons::{Place, irradiance, map_of, mapper, trace};

/// Names and places of sets that trees have gone wrong with, and of random ones.
fn sets() -> Vec<(String, Vec<[f32; 3]>)> {
    let mut random = Random::new(51);
    let mut sets = Vec::new();
    for n in 0..=70 {
        sets.push((format!("{n} random"), (0..n).map(|_| somewhere(&mut random)).collect()));
    }
    for set in 0..50 {
        let n = 1 + random.below(3000);
        let places: Vec<_> = (0..n).map(|_| somewhere(&mut random)).collect();
        // Some lie in the same place, some in the same plane.
        let flat = |k: usize, [x, y, z]: [f32; 3]| if k.is_multiple_of(3) { [x, y, 0.125] } else { [x, y, z] };
        let places: Vec<_> = (0..n).map(|k| flat(k, places[if k % 7 == 0 { k / 2 } else { k }])).collect();
        sets.push((format!("random set {set}"), places));
    }
    let along = |k: usize| k as f32 / 256.0 - 0.25;
    let zero = |k: usize| if k.is_multiple_of(2) { 0.0 } else { -0.0 };
    let tiny = |k: usize| f32::from_bits(k as u32 % 5) * if k.is_multiple_of(3) { -1.0 } else { 1.0 };
    let of = |name: &str, n: usize, place: &dyn Fn(usize) -> [f32; 3]| (name.to_owned(), (0..n).map(place).collect());
    sets.push(of("identical", 1000, &|_| [0.1, -0.2, 0.05]));
    sets.push(of("collinear", 129, &|k| [0.1, along(k), -0.05]));
    sets.push(of("collinear, backwards", 129, &|k| [along(128 - k); 3]));
    sets.push(of("coplanar", 1024, &|k| [along(k % 32 * 4), along(k / 32 * 4), 0.0]));
    sets.push(of("lattice with ties", 4096, &|k| [along(k % 16 * 8), along(k / 16 % 16 * 8), along(k / 256 * 8)]));
    sets.push(of("lattice, everything twice", 1024, &|k| {
        [along(k % 8 * 16), along(k / 8 % 8 * 16), along(k / 128 * 16)]
    }));
    sets.push(of("zeros of both signs", 100, &|k| [zero(k), zero(k / 2), zero(k / 4)]));
    sets.push(of("subnormal", 200, &|k| [tiny(k), tiny(k / 5), tiny(k / 25)]));
    sets.push(of("subnormal and not", 200, &|k| [tiny(k), along(k % 64 * 2), zero(k)]));
    sets
}

fn somewhere(random: &mut Random) -> [f32; 3] {
    (random.cube() * 0.3).as_vec3().to_array()
}

/// Photons at these places: flux is a number of its own, bounces and sides are mixed.
fn photons(places: &[[f32; 3]]) -> Photons {
    let mut photons = Photons::default();
    for (k, [x, y, z]) in places.iter().enumerate() {
        photons.places.push([*x, *y, *z, f32::from_bits(Tag::new(0, k % 5 > 0).0)]);
        photons.flux.push([1.0 + (k % 64) as f32, 1.0, 0.5, f32::from_bits(k as u32 % 3)]);
    }
    photons
}

/// Every number of the photons of a tree, bit by bit, and sorted.
fn listed(photons: impl Iterator<Item = ([f32; 4], [f32; 4])>) -> Vec<[u32; 8]> {
    let bits = |(place, flux): ([f32; 4], [f32; 4])| {
        let [x, y, z, tag] = place.map(f32::to_bits);
        let [r, g, b, bounces] = flux.map(f32::to_bits);
        [x, y, z, tag, r, g, b, bounces]
    };
    let mut listed: Vec<_> = photons.map(bits).collect();
    listed.sort_unstable();
    listed
}

#[test]
fn every_photon_is_in_its_tree_once() {
    for (name, places) in sets() {
        let photons = photons(&places);
        let tree = Tree::new([&photons]);
        let in_tree = (0..tree.blocks.len() * BLOCK).filter_map(|number| tree.photon(number));
        let given = photons.places.iter().copied().zip(photons.flux.iter().copied());
        assert_eq!(tree.len, places.len(), "{name}");
        assert_eq!(listed(in_tree), listed(given), "{name}");
        assert_eq!(tree.blocks.len(), places.len().div_ceil(BLOCK), "{name}: the blocks are full");
    }
}

/// Points from where a set is looked at: its own places, beside them, and far away.
fn looks(places: &[[f32; 3]], random: &mut Random) -> Vec<[f32; 3]> {
    let mut looks = vec![[0.0; 3], [-0.0; 3], [0.9, 0.9, 0.9], somewhere(random), somewhere(random)];
    if !places.is_empty() {
        for _ in 0..4 {
            let [x, y, z] = places[random.below(places.len())];
            looks.extend([[x, y, z], [x + 0.01, y - 0.02, z + 0.003]]);
        }
    }
    looks
}

/// A square that no disc of these tests reaches over.
fn plane() -> Scene {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    quad(&mut world, DVec3::ZERO, (DVec3::X, DVec3::Y), white, None);
    compile(&world, false)
}

/// Photons count that lie on the same side, nearer than the radius, not high above the disc, and scattered seldom enough.
#[test]
fn a_gather_adds_up_what_brute_force_adds_up() {
    let surfaces = Surfaces::new(&plane());
    let mut random = Random::new(53);
    let (mut asked, mut found) = (0, 0);
    for (name, places) in sets() {
        let photons = photons(&places);
        for radius in [1e-5f32, 0.015_625, 0.1, 0.4] {
            let [flux, number] =
                [Quantity::Radiance, Quantity::Count].map(|what| map_of(&photons, &surfaces, radius, what));
            let area = PI * f64::from(radius) * f64::from(radius);
            for (look, point) in looks(&places, &mut random).into_iter().enumerate() {
                let (up, most_bounces) = (look % 4 != 3, look as u32 % 3);
                let normal = [0.0, 0.0, if up { 1.0 } else { -1.0 }];
                let slack = point.into_iter().map(f32::abs).fold(0.0, f32::max) / (1 << 20) as f32;
                let counts = |(place, flux): &(&[f32; 4], &[f32; 4])| {
                    let [dx, dy, dz] = [0, 1, 2].map(|k: usize| place[k] - point[k]);
                    let near = dx * dx + (dy * dy + dz * dz) < radius * radius && dz.abs() <= 0.25 * radius + slack;
                    near && Tag(place[3].to_bits()).outside() == up && flux[3].to_bits() <= most_bounces
                };
                let pairs = || photons.places.iter().zip(&photons.flux).filter(counts);
                let (sum, count) = (pairs().map(|(_, flux)| f64::from(flux[0])).sum::<f64>(), pairs().count() as f64);
                let place = Place { point, normal, prim: 0 };
                let [r, ..] = irradiance((&flux, 0, most_bounces), &surfaces, &place);
                assert!((r * area - sum).abs() <= 1e-5 * sum, "{name}: {r} for {sum} at {point:?} within {radius}");
                let [_, n, _] = irradiance((&number, 0, most_bounces), &surfaces, &place);
                assert!((n * area - count).abs() <= 1e-5 * count, "{name}: {n} for {count} photons at {point:?}");
                asked += 1;
                found += u32::from(sum > 0.0);
            }
            let elsewhere = Place { point: [0.0; 3], normal: [0.0, 0.0, 1.0], prim: 0 };
            assert_eq!(irradiance((&flux, 5, 9), &surfaces, &elsewhere), [0.0; 3], "{name}: another part of the map");
        }
    }
    assert!(found > asked / 8, "of {asked} questions only {found} have an answer");
}

/// The flux of a photon arrives whole, whatever the radii of its neighbours: photons along a line, each with four thirds of
/// the radius of the last, and a fine grid of points that adds up their irradiance by area.
#[test]
fn no_flux_is_lost_or_made_where_radii_change() {
    let scene = plane();
    let surfaces = Surfaces::new(&scene);
    let mut photons = Photons::default();
    let mut radius = 0.008;
    for k in 0..12 {
        photons.places.push([0.03 * k as f32 - 0.2, 0.01, 0.0, f32::from_bits(Tag::new(0, true).0)]);
        photons.flux.push([1.0, 0.0, 0.0, 0.0]);
        photons.radii.push(radius);
        radius *= 4.0f32 / 3.0;
    }
    let total = photons.len() as f64;
    photons.flux.iter_mut().zip(&photons.radii).for_each(|(flux, radius)| {
        flux[0] = 1.0 / (core::f32::consts::PI * radius * radius);
    });
    let mut trees = vec![Tree::default(); 16];
    trees[0] = Tree::new([&photons]);
    let map = Map::new(Kind::Global, 0, trees, Account::default());
    let steps = 1000;
    let at = |k: u32| (f64::from(k) + 0.5) / f64::from(steps) - 0.5;
    let sum: f64 = (0..steps * steps)
        .map(|k| {
            let point = [at(k % steps) as f32, at(k / steps) as f32, 0.0];
            irradiance((&map, 0, 0), &surfaces, &Place { point, normal: [0.0, 0.0, 1.0], prim: 0 })[0]
        })
        .sum();
    let found = sum / f64::from(steps * steps);
    assert!((found / total - 1.0).abs() < 4e-3, "{found} of {total} arrive");
}

/// Walls in the plane z = 0, each with the primitive that is lit from above and the one that is dark from below.
fn walls() -> Vec<(&'static str, World, [u32; 2])> {
    let build = |build: &dyn Fn(&mut World, usize)| {
        let mut world = World::default();
        let white = material(&mut world, grey(0.8));
        build(&mut world, white);
        point_light(&mut world, at(0.0, 0.0, 0.5), 1.0);
        world
    };
    let edges = (DVec3::X, DVec3::Y);
    let thin = at(0.0, 0.0, 1e-4);
    let (top, bottom) = ([at(-1.0, -1.0, 0.0), at(1.0, -1.0, 0.0), at(0.0, 1.0, 0.0)], at(0.0, 1.0, -1e-3));
    let blade = move |w: &mut World, m| {
        // Two faces that meet in an edge, like a blade.
        polygon(w, &top, m, None);
        polygon(w, &[top[1], top[0], bottom], m, None);
    };
    let shell = |w: &mut World, m| {
        let (vertices, faces) = globe(4, 2, |_, _| 1.0);
        mesh(w, (vertices.into_iter().map(|v| v * at(1.0, 1.0, 1e-4)).collect(), faces), m, None);
    };
    vec![
        ("a sheet", build(&|w, m| quad(w, DVec3::ZERO, edges, m, None)), [0, 0]),
        ("a sheet seen from behind", build(&|w, m| quad(w, DVec3::ZERO, (DVec3::Y, DVec3::X), m, None)), [0, 0]),
        (
            "two sheets",
            build(&|w, m| {
                quad(w, DVec3::ZERO, edges, m, None);
                quad(w, -thin, (DVec3::Y, DVec3::X), m, None);
            }),
            [0, 1],
        ),
        ("a thin box", build(&|w, m| closed_box(w, -thin, at(1.0, 1.0, 1e-4), m, None)), [5, 4]),
        ("a blade", build(&blade), [0, 1]),
        ("a thin shell", build(&shell), [6, 7]),
    ]
}

/// P5. The lit side is as bright as its lamp makes it, and the other side dark.
#[test]
fn no_light_leaks_through_a_wall() {
    for (name, world, [lit, dark]) in walls() {
        let renderer = mapper(&world, Settings::default());
        let photons = renderer.plan().photons.as_ref().unwrap();
        let pass = photons.global.as_ref().unwrap();
        let traced = trace(&renderer, pass, 400_000, 0);
        let scale = renderer.scene().frame.scale;
        let map = |radius: f64| map_of(&traced.photons, &photons.surfaces, (radius * scale) as f32, Quantity::Radiance);
        let maps = [0.03, 0.1, 0.3].map(map);
        for (x, y) in [(0.2, -0.2), (0.05, -0.3), (0.3, -0.5)] {
            let at_side = |prim, side: f64, map: &Map| {
                let place = Place::new(&renderer, prim, at(x, y, 0.0), DVec3::Z * side);
                irradiance((map, 0, 9), &photons.surfaces, &place)[0]
            };
            let squared = x * x + y * y + 0.25;
            let expected = 0.5 / (squared * squared.sqrt());
            let bright = at_side(lit, 1.0, &maps[1]);
            assert!((bright / expected - 1.0).abs() < 0.05, "{name}: {bright} instead of {expected} at {x}, {y}");
            for map in &maps {
                let behind = at_side(dark, -1.0, map);
                assert!(behind <= 1e-6 * bright, "{name}: {behind} leaks to {x}, {y}, where {bright} is in front");
            }
        }
    }
}

/// Photons of flux 1 on the faces of one plane, `side`² on the square of the frame.
fn uniform(scene: &Scene, inside: impl Fn(DVec2) -> Option<u32>, side: u32) -> (Photons, f64) {
    let mut photons = Photons::default();
    // A rank-1 lattice of points: even, and along no edge.
    let (a, b) = (0.754_877_666_246_692_8, 0.569_840_290_998_053_2);
    let count = side * side;
    for k in 0..count {
        let place = DVec2::new((a * f64::from(k)).fract(), (b * f64::from(k)).fract()) * 2.0 - 1.0;
        if let Some(prim) = inside(place) {
            let place = scene.frame.point(place.extend(0.0)).as_vec3();
            photons.places.push([place.x, place.y, place.z, f32::from_bits(Tag::new(prim, true).0)]);
            photons.flux.push([1.0, 1.0, 1.0, 0.0]);
        }
    }
    let scale = scene.frame.scale;
    (photons, f64::from(count) / (4.0 * scale * scale))
}

/// A uniformly lit polygon is as bright at its edges and in its corners as in its middle; also where another face turns
/// back from an edge, as at a blade.
#[test]
fn surfaces_are_as_bright_where_they_end() {
    let ring = |n: u32, turn: f64| (0..n).map(move |k| TAU * f64::from(k) / f64::from(n) + turn);
    let round = |n, turn| ring(n, turn).map(|a| at(libm::cos(a), libm::sin(a), 0.0)).collect::<Vec<_>>();
    let rectangle = vec![at(-0.9, -0.6, 0.0), at(0.9, -0.6, 0.0), at(0.9, 0.6, 0.0), at(-0.9, 0.6, 0.0)];
    for (name, corners, blade) in [
        ("rectangle", rectangle.clone(), false),
        ("blade", rectangle, true),
        ("turned square", round(4, 0.3), false),
        ("octagon", round(8, 0.0), false),
    ] {
        let mut world = World::default();
        let white = material(&mut world, grey(0.5));
        polygon(&mut world, &corners, white, None);
        if blade {
            polygon(&mut world, &[corners[1], corners[0], at(0.0, 0.0, -0.02)], white, None);
        }
        let scene = compile(&world, false);
        let inside = |place: DVec2| contains(&corners, place).then_some(0);
        let (photons, expected) = uniform(&scene, inside, 1000);
        let surfaces = Surfaces::new(&scene);
        let map = map_of(&photons, &surfaces, (0.12 * scene.frame.scale) as f32, Quantity::Radiance);
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let edge = (corners[0] + corners[1]) / 2.0;
        for (where_, point) in [
            ("in the middle", middle),
            ("at an edge", edge),
            ("near an edge", edge.lerp(middle, 0.1)),
            ("in a corner", corners[1]),
            ("near a corner", corners[1].lerp(middle, 0.07)),
            ("along an edge near a corner", corners[1].lerp(edge, 0.15)),
        ] {
            let place =
                Place { point: scene.frame.point(point).as_vec3().to_array(), normal: [0.0, 0.0, 1.0], prim: 0 };
            let [r, ..] = irradiance((&map, 0, 0), &surfaces, &place);
            let off = r / expected - 1.0;
            assert!(off.abs() < 0.02, "{name}, {where_}: off by {off:.4}");
        }
    }
}

/// Whether a convex polygon, anticlockwise in the plane z = 0, contains a point.
fn contains(corners: &[DVec3], place: DVec2) -> bool {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).all(|(a, b)| (b.truncate() - a.truncate()).perp_dot(place - a.truncate()) >= 0.0)
}

/// A random convex polygon: corners on an ellipse, anticlockwise.
fn convex(random: &mut Random) -> Vec<DVec3> {
    let corners = 3 + random.below(5);
    let (width, height, turn) = (random.between(0.4, 1.0), random.between(0.4, 1.0), random.unit() * TAU);
    let part = TAU / corners as f64;
    let angles = (0..corners).map(|k| (k as f64 + random.between(0.0, 0.7)) * part).collect::<Vec<_>>();
    let on = |angle: f64| DVec2::new(width * libm::cos(angle), height * libm::sin(angle));
    angles.into_iter().map(|angle| DVec2::from_angle(turn).rotate(on(angle)).extend(0.0)).collect()
}

/// A random rectangle.
fn rectangle(random: &mut Random) -> Vec<DVec3> {
    let (width, height, turn) = (random.between(0.3, 0.7), random.between(0.3, 0.7), random.unit() * TAU);
    let corners = [(-width, -height), (width, -height), (width, height), (-width, height)];
    corners.map(|(x, y)| DVec2::from_angle(turn).rotate(DVec2::new(x, y)).extend(0.0)).to_vec()
}

/// Distances from a point to the lines of the edges.
fn distances(corners: &[DVec3], place: DVec2) -> Vec<f64> {
    let next = corners.iter().cycle().skip(1);
    let edge = |(a, b): (&DVec3, &DVec3)| {
        let along = (b - a).truncate().normalize();
        along.perp_dot(place - a.truncate())
    };
    corners.iter().zip(next).map(edge).collect()
}

/// The part of a disc that a convex polygon contains: the mean over directions of the squared reach.
fn part(corners: &[DVec3], place: DVec2, radius: f64) -> f64 {
    let steps = 20_000;
    let reach = |k: u32| {
        let way = DVec2::from_angle(TAU * (f64::from(k) + 0.5) / f64::from(steps));
        let next = corners.iter().cycle().skip(1);
        let ends = corners.iter().zip(next).map(|(a, b)| {
            let along = (b - a).truncate().normalize();
            let towards = -along.perp_dot(way);
            if towards > 0.0 { along.perp_dot(place - a.truncate()) / towards } else { f64::INFINITY }
        });
        (ends.fold(radius, f64::min) / radius).max(0.0)
    };
    (0..steps).map(reach).map(|reach| reach * reach).sum::<f64>() / f64::from(steps)
}

/// The part of a disc about a point of polygon `corners`, as the surface has it.
fn measured(corners: &[DVec3], place: DVec2, radius: f64) -> f64 {
    let mut world = World::default();
    let white = material(&mut world, grey(0.5));
    polygon(&mut world, corners, white, None);
    let scene = compile(&world, false);
    let point = V3::splat(One, scene.frame.point(place.extend(0.0)).as_vec3().to_array());
    f64::from(Surfaces::new(&scene).part_of_disc(One, true, 0, point, (radius * scene.frame.scale) as f32))
}

/// A random point of a polygon within [-1, 1]².
fn inside(corners: &[DVec3], random: &mut Random) -> DVec2 {
    loop {
        let place = random.cube().truncate();
        if contains(corners, place) {
            return place;
        }
    }
}

/// Errors of discs that reach over several edges.
#[derive(Default)]
struct Errors {
    count: u32,
    squares: f64,
    worst: f64,
}

impl Errors {
    fn add(&mut self, off: f64) {
        self.count += 1;
        self.squares += off * off;
        self.worst = self.worst.max(off.abs());
    }

    fn assert(&self, name: &str, typical: f64, worst: f64) {
        assert!(self.count > 500, "{name}: {} discs are few", self.count);
        let found = (self.squares / f64::from(self.count)).sqrt();
        assert!(found <= typical, "{name}: typically off by {found:.4}");
        assert!(self.worst <= worst, "{name}: once off by {:.4}", self.worst);
    }
}

/// A disc that reaches over one edge is measured exactly; over several it is looked at along a few directions.
#[test]
fn the_part_of_a_disc_is_its_area_on_the_polygon() {
    let mut random = Random::new(54);
    let (mut whole, mut single) = (0, 0);
    let (mut of_squares, mut of_any) = (Errors::default(), Errors::default());
    for number in 0..4000 {
        let square = number % 2 == 0;
        let corners = if square { rectangle(&mut random) } else { convex(&mut random) };
        let place = inside(&corners, &mut random);
        let radius = 0.02 + 0.5 * inside(&corners, &mut random).distance(place);
        let found = measured(&corners, place, radius);
        let reached: Vec<f64> = distances(&corners, place).into_iter().filter(|d| *d < radius).collect();
        match reached[..] {
            [] => {
                assert_eq!(found, 1.0);
                whole += 1;
            }
            [distance] => {
                let t = distance / radius;
                let exact = 1.0 - (libm::acos(t) - t * (1.0 - t * t).sqrt()) / PI;
                assert!((found - exact).abs() < 1e-4, "{found} instead of {exact} at {t} of the radius");
                single += 1;
            }
            _ => {
                let off = found / part(&corners, place, radius) - 1.0;
                if square { of_squares.add(off) } else { of_any.add(off) }
            }
        }
    }
    assert!(whole > 500 && single > 500, "{whole} whole discs and {single} with one edge are few");
    of_squares.assert("rectangles", 0.01, 0.06);
    of_any.assert("any polygons", 0.0125, 0.12);
}
