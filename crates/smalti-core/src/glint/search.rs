//! Where in their pixels glints lie: Newton's method on the distance by which chains of specular vertices miss a lamp.

use glam::{DMat2, DVec2};

use super::chain::{Front, Link, Turn};
use super::lamps::{LARGEST, Target};
use super::{Mixture, Region};
use crate::render::Renderer;
use crate::scene::{Class, Scene};
use crate::settings::Rect;

/// Most turns of a chain: a lamp is seen by two reflections inside of a ball.
const LONGEST: usize = 4;

/// Places in a pixel from which the search begins: (0, 0), (1, 0), (0, 1), (1, 1) of a small square.
const STARTS: [DVec2; 4] =
    [DVec2::new(0.25, 0.25), DVec2::new(0.75, 0.25), DVec2::new(0.25, 0.75), DVec2::new(0.75, 0.75)];

/// Distance between a guess and its neighbours, which tell how the distance from the lamp changes, in pixels.
const STEP: f64 = 1.0 / 32.0;

/// How far from the middle of its pixel a glint may lie on the way there, in pixels.
const REACH: f64 = 1.5;

/// How far away a lamp may seem to be where the search begins, in pixels: slopes over half a pixel are rough.
const NEAR: f64 = 3.0;

/// Newton's steps.
const STEPS: usize = 5;

/// By how much regions are larger than what the last step says of a glint: the picture of a lamp is bent.
const LARGER: f64 = 1.25;

/// Least half side of a region, in pixels: the f32 directions of a picture some thousand pixels high are not finer.
const LEAST: f64 = 2e-4;

/// Most glints of a pixel.
const MOST: usize = 4;

/// A rectangle so many times as large as the parallelogram around the same glint has that beside it.
const TILTED: f32 = 3.0;

/// A guess of where a lamp is seen.
#[derive(Clone, Copy)]
struct Guess {
    pixel: (u32, u32),
    /// In the picture.
    place: DVec2,
    target: Target,
}

/// How the pixels of `area` that have glints are sampled.
pub fn search(renderer: &Renderer, area: Rect) -> Vec<(u32, u32, Mixture)> {
    let pixels: Vec<(u32, u32)> = pixels(area).collect();
    let front = Front::begin(renderer, pixels.iter().flat_map(|pixel| STARTS.map(|start| corner(*pixel) + start)));
    let longest = (renderer.plan().max_bounces as usize).min(LONGEST);
    let mut found = Vec::new();
    explore(renderer, (&pixels, &front), (&mut Vec::new(), longest), &mut found);
    found.sort_by_key(|glint: &Glint| (glint.pixel.1, glint.pixel.0));
    let of_pixels = found.chunk_by(|a, b| a.pixel == b.pixel);
    let regions = |glint: &Glint| [Some(glint.around), glint.tilted].into_iter().flatten();
    let mixture = |of: &[Glint]| Mixture::new(of.iter().flat_map(regions).collect());
    of_pixels.map(|of| (of[0].pixel.0, of[0].pixel.1, mixture(of))).collect()
}

/// Finds what is seen by these turns, and by more.
fn explore(
    renderer: &Renderer,
    (pixels, front): (&[(u32, u32)], &Front),
    (turns, longest): (&mut Vec<Turn>, usize),
    found: &mut Vec<Glint>,
) {
    let mut guesses = first_guesses(&renderer.plan().glints, pixels, &front.links);
    for _ in 0..STEPS {
        refine(renderer, turns, &mut guesses);
    }
    met(renderer, turns, &guesses).into_iter().for_each(|glint| note(found, glint));
    if turns.len() == longest {
        return;
    }
    for turn in [Turn::Reflect, Turn::Refract] {
        let next = front.turned(renderer, turn);
        if !next.is_empty() {
            turns.push(turn);
            explore(renderer, (pixels, &next), (turns, longest), found);
            turns.pop();
        }
    }
}

/// A glint that has been found.
struct Glint {
    pixel: (u32, u32),
    emitter: u32,
    /// The way of its chain.
    way: u64,
    /// The rectangle around it, within the pixel.
    around: Region,
    /// The parallelogram around it, where that is much smaller.
    tilted: Option<Region>,
}

/// Adds a glint, unless it is known already or its pixel has enough of them.
fn note(found: &mut Vec<Glint>, glint: Glint) {
    let middle = glint.around.place([0.5; 2]);
    let of_pixel = || found.iter().filter(|other| other.pixel == glint.pixel);
    let same = |other: &Glint| (other.emitter, other.way) == (glint.emitter, glint.way);
    let known = of_pixel().any(|other| same(other) && other.around.holds(middle));
    if !known && of_pixel().count() < MOST {
        found.push(glint);
    }
}

fn pixels(area: Rect) -> impl Iterator<Item = (u32, u32)> {
    (area.y..area.y + area.height).flat_map(move |y| (area.x..area.x + area.width).map(move |x| (x, y)))
}

/// Upper left corner of a pixel, in the picture.
fn corner((x, y): (u32, u32)) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}

/// Where links from the starts of pixels seem to meet some lamp within reach.
fn first_guesses(targets: &[Target], pixels: &[(u32, u32)], links: &[Option<Link>]) -> Vec<Guess> {
    let mut guesses = Vec::new();
    for (pixel, links) in pixels.iter().zip(links.chunks(STARTS.len())) {
        for (k, start) in STARTS.into_iter().enumerate() {
            // The starts beside it and below or above it.
            let (beside, beyond) = (k ^ 1, k ^ 2);
            let step = DVec2::new(STARTS[beside].x - start.x, STARTS[beyond].y - start.y);
            for target in targets {
                let guess = Guess { pixel: *pixel, place: corner(*pixel) + start, target: *target };
                let probes = [links[k], links[beside], links[beyond]];
                // At the rim of a ball, where the starts of a pixel meet unlike things, nothing can be told from afar.
                let unlike = links[k].is_some_and(|link| link.round) && !alike(&probes);
                let near = || Miss::of(probes, step, target).is_some_and(|miss| miss.is_near());
                guesses.extend((unlike || near()).then_some(guess));
            }
        }
    }
    guesses
}

/// By how much each guess misses its lamp.
fn misses(renderer: &Renderer, turns: &[Turn], guesses: &[Guess]) -> Vec<Option<(Miss, Link)>> {
    let around = [DVec2::ZERO, DVec2::X * STEP, DVec2::Y * STEP];
    let places = guesses.iter().flat_map(|guess| around.map(|to| guess.place + to));
    let front = Front::after(renderer, places, turns);
    let links = front.links.chunks(around.len());
    let miss = |(guess, links): (&Guess, &[Option<Link>])| {
        let miss = Miss::of([links[0], links[1], links[2]], DVec2::splat(STEP), &guess.target)?;
        Some((miss, links[0]?))
    };
    guesses.iter().zip(links).map(miss).collect()
}

/// Moves every guess by one step; those that lead nowhere go.
fn refine(renderer: &Renderer, turns: &[Turn], guesses: &mut Vec<Guess>) {
    let misses = misses(renderer, turns, guesses);
    let moved = guesses.iter().zip(&misses).filter_map(|(guess, miss)| guess.moved(&miss.as_ref()?.0));
    *guesses = moved.collect();
}

/// The guesses that have met their lamps.
fn met(renderer: &Renderer, turns: &[Turn], guesses: &[Guess]) -> Vec<Glint> {
    let misses = misses(renderer, turns, guesses);
    let met = guesses.iter().zip(&misses).filter_map(|(guess, miss)| {
        let (miss, link) = miss.as_ref()?;
        let meets = miss.by.length() <= guess.target.radius && shines(renderer.scene(), guess.target, link);
        let around = guess.around(miss).filter(|_| meets)?;
        let tilted = guess.tilted(miss).filter(|tilted| tilted.area() * TILTED < around.area());
        Some(Glint { pixel: guess.pixel, emitter: guess.target.emitter, way: link.way, around, tilted })
    });
    met.collect()
}

/// Whether a ray hits the front of this lamp.
fn shines(scene: &Scene, target: Target, link: &Link) -> bool {
    let Some(code) = scene.classes.get(link.hit as usize) else { return false };
    let [x, y, z, ..] = scene.shades[link.hit as usize].map(f64::from);
    let front = scene.surface(link.hit) >= scene.planes || link.direction.dot(glam::DVec3::new(x, y, z)) < 0.0;
    code >> Class::BITS == target.emitter + 1 && front
}

impl Guess {
    /// The guess after Newton's step; `None` where that is out of reach.
    fn moved(&self, miss: &Miss) -> Option<Self> {
        let place = self.place - miss.inverse()? * miss.by;
        let within = (place - corner(self.pixel) - 0.5).abs().max_element() <= REACH;
        within.then_some(Self { place, ..*self })
    }

    /// The rectangle in the pixel from which the lamp is met, if small.
    fn around(&self, miss: &Miss) -> Option<Region> {
        let inverse = miss.inverse()?;
        let half = DVec2::new(inverse.row(0).length(), inverse.row(1).length()) * self.target.radius * LARGER;
        let half = half.max(DVec2::splat(LEAST));
        let middle = self.place - corner(self.pixel);
        let (low, high) = ((middle - half).max(DVec2::ZERO), (middle + half).min(DVec2::ONE));
        let region = Region::rectangle(low.as_vec2().to_array(), high.as_vec2().to_array());
        let small = low.cmplt(high).all() && 0.0 < region.area() && f64::from(region.area()) <= LARGEST;
        small.then_some(region)
    }

    /// The parallelogram from which the lamp is met, if it is not too thin and a good part of it is in the pixel.
    fn tilted(&self, miss: &Miss) -> Option<Region> {
        let inverse = miss.inverse()?;
        let edges = [inverse.x_axis, inverse.y_axis].map(|axis| axis * (2.0 * self.target.radius * LARGER));
        let corner = self.place - corner(self.pixel) - (edges[0] + edges[1]) / 2.0;
        let longest = edges[0].length().max(edges[1].length());
        let edges = edges.map(|edge| edge.as_vec2().to_array());
        let region = Region { corner: corner.as_vec2().to_array(), edges };
        let inside = |place: [f32; 2]| place.iter().all(|x| (0.0..1.0).contains(x));
        let within = (0..64).filter(|k| inside(region.place([k % 8, k / 8].map(|k| (k as f32 + 0.5) / 8.0)))).count();
        (within >= 16 && f64::from(region.area()) >= 2.0 * LEAST * longest).then_some(region)
    }
}

/// Whether links have met the same things on their ways.
fn alike(links: &[Option<Link>; 3]) -> bool {
    let [first, others @ ..] = links.map(|link| link.map(|link| link.way));
    first.is_some() && others == [first, first]
}

/// By how much a ray misses the centre of a lamp, across the ray, and how that changes over the picture.
struct Miss {
    by: DVec2,
    /// Change for a pixel to the right and for one down.
    slope: DMat2,
}

impl Miss {
    /// Of a link and those that began a step to the right and a step down; `None` where they have met unlike things on the
    /// way there, or lead away from the lamp.
    fn of([link, right, down]: [Option<Link>; 3], step: DVec2, target: &Target) -> Option<Self> {
        if !alike(&[link, right, down]) {
            return None;
        }
        let (link, right, down) = (link?, right?, down?);
        let (x, y) = link.direction.any_orthonormal_pair();
        let miss = |Link { origin, direction, .. }| {
            let to = target.centre - origin;
            let along = to.dot(direction);
            let across = to - direction * along;
            (along > 0.0).then(|| DVec2::new(across.dot(x), across.dot(y)))
        };
        let [by, right, down] = [miss(link)?, miss(right)?, miss(down)?];
        Some(Self { by, slope: DMat2::from_cols((right - by) / step.x, (down - by) / step.y) })
    }

    /// Whether the lamp is seen not far from here, as far as the slope tells.
    fn is_near(&self) -> bool {
        self.inverse().is_some_and(|inverse| (inverse * self.by).abs().max_element() <= NEAR)
    }

    fn inverse(&self) -> Option<DMat2> {
        let inverse = self.slope.inverse();
        (self.slope.determinant() != 0.0 && inverse.is_finite()).then_some(inverse)
    }
}
