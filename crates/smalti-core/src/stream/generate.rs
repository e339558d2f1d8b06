//! Camera rays: the samples of a batch of pixels, block after block of neighbours, so that the rays of a packet stay
//! close together.

use glam::DVec3;

use super::{Columns, DIRECTION, ETA, KEY, LEAVES, MEDIUM, ORIGIN, PDF, SLOT, Stream, THROUGHPUT};
use crate::film::ROUND;
use crate::glint::Mixture;
use crate::lanes::{Lanes, One, V3};
use crate::light::table::NO_SURFACE;
use crate::mutant::mutant;
use crate::sampling::{Keys, Purpose, pair, sampler::pixel_key};
use crate::scene::View;
use crate::settings::{Rect, Settings};

/// Side of a block of pixels: as many pixels as the widest level has lanes.
const BLOCK: u32 = 4;

/// The pixels of a batch, as columns.
#[derive(Clone, Debug, Default)]
pub struct Pixels {
    x: Vec<u32>,
    y: Vec<u32>,
    key: Vec<u32>,
    /// Which pixels of the area they are, counted row by row.
    numbers: Vec<u32>,
    count: usize,
    /// What [`Pixels::set`] was asked for last.
    batch: Option<(Rect, usize, usize)>,
    /// Those of them that have glints, by place in the batch.
    glints: Option<Vec<(usize, Mixture)>>,
}

impl Pixels {
    /// Pixels `from..to` of `area`, counted block by block.
    pub fn set(&mut self, area: Rect, from: usize, to: usize) {
        if self.batch == Some((area, from, to)) {
            return;
        }
        self.batch = Some((area, from, to));
        self.count = to - from;
        self.glints = None;
        self.numbers.clear();
        number_blocks(area, &mut self.numbers);
        self.numbers.truncate(to);
        self.numbers.drain(..from);
        self.x.clear();
        self.y.clear();
        self.x.extend(self.numbers.iter().map(|number| area.x + number % area.width));
        self.y.extend(self.numbers.iter().map(|number| area.y + number / area.width));
        // A packet may read past the last pixel.
        self.x.resize(self.count + 16, 0);
        self.y.resize(self.count + 16, 0);
    }

    /// Takes note of the pixels that have glints; once for each batch.
    pub fn find_glints<'g>(&mut self, at: impl Fn((u32, u32)) -> Option<&'g Mixture>) {
        if self.glints.is_some() {
            return;
        }
        let pixels = self.x.iter().copied().zip(self.y.iter().copied()).take(self.count).enumerate();
        self.glints = Some(pixels.filter_map(|(number, pixel)| Some((number, at(pixel)?.clone()))).collect());
    }

    /// Which pixels of their area they are, counted row by row.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// Keys for one round.
    pub fn enter_round(&mut self, seed: u64, round: u32) {
        self.key.clear();
        self.key.extend(self.x.iter().zip(&self.y).map(|(x, y)| pixel_key(seed, *x, *y, round)));
    }
}

/// The numbers of an area's pixels, block by block.
fn number_blocks(Rect { width, height, .. }: Rect, numbers: &mut Vec<u32>) {
    for top in (0..height).step_by(BLOCK as usize) {
        for left in (0..width).step_by(BLOCK as usize) {
            for y in top..height.min(top + BLOCK) {
                numbers.extend((left..width.min(left + BLOCK)).map(|x| y * width + x));
            }
        }
    }
}

/// Writes the camera rays of sample `sample` of all pixels to slots `first..` of `rays`; the camera is in `medium`.
#[inline(always)]
pub fn run<L: Lanes>(
    l: L,
    (view, medium, settings, used): (&View, u32, &Settings, Columns),
    pixels: &Pixels,
    (sample, first): (u32, usize),
    rays: &mut Stream,
) {
    let reversed = l.u((sample % ROUND).reverse_bits());
    let (right, up, forward) = (V3::splat(l, view.right), V3::splat(l, view.up), V3::splat(l, view.forward));
    // Square pixels: the picture is 2 high and 2 · width / height wide.
    let size = l.f(2.0 / settings.height as f32);
    let (middle_x, middle_y) = (l.f(settings.width as f32 / 2.0), l.f(settings.height as f32 / 2.0));
    for at in (0..pixels.count).step_by(L::WIDTH) {
        let key = l.load_u(&pixels.key[at..]);
        let (u, v) = place(l, settings, Keys { key, index: reversed });
        let x = (l.to_f(l.load_u(&pixels.x[at..])) + u - middle_x) * size;
        let y = (middle_y - l.to_f(l.load_u(&pixels.y[at..])) - v) * size;
        let direction = forward.along(l, x, right).along(l, y, up).normalised(l);
        let slot = l.add_u(l.u((first + at) as u32), l.iota()) & l.u(0xffff);
        let to = first + at;
        rays.set_v3(l, ORIGIN, to, V3::splat(l, view.eye));
        rays.set_v3(l, DIRECTION, to, direction);
        rays.set_v3(l, THROUGHPUT, to, V3::splat(l, [1.0; 3]));
        rays.set_u(l, LEAVES, to, l.u(NO_SURFACE));
        rays.set_u(l, KEY, to, key);
        rays.set_u(l, SLOT, to, reversed | slot);
        if used.pdf {
            rays.set_f(l, PDF, to, l.f(0.0));
        }
        if used.eta {
            rays.set_f(l, ETA, to, l.f(1.0));
        }
        if used.medium {
            rays.set_u(l, MEDIUM, to, l.u(medium));
        }
    }
    rays.set_len(first + pixels.count);
}

/// Sends the rays of pixels with glints, of those that [`run`] has written for the same sample, to where the glints are.
pub fn towards_glints(
    (view, settings): (&View, &Settings),
    pixels: &Pixels,
    (sample, first): (u32, usize),
    rays: &mut Stream,
) {
    let index = (sample % ROUND).reverse_bits();
    for (at, mixture) in pixels.glints.iter().flatten() {
        let (u, v) = place(One, settings, Keys { key: pixels.key[*at], index });
        let ([x, y], weight) = mixture.sample([u, v]);
        let place = [f64::from(pixels.x[*at]) + f64::from(x), f64::from(pixels.y[*at]) + f64::from(y)];
        rays.set_triple(DIRECTION, first + at, direction(view, settings, place));
        rays.set_value(ETA, first + at, weight.to_bits());
    }
}

/// The unit direction of the camera ray through a place of the picture, in pixels.
pub fn direction(view: &View, settings: &Settings, [x, y]: [f64; 2]) -> [f32; 3] {
    let [right, up, forward] = [view.right, view.up, view.forward].map(|v| DVec3::from_array(v.map(f64::from)));
    let (width, height) = (f64::from(settings.width), f64::from(settings.height));
    let (to_right, to_up) = ((2.0 * x - width) / height, (height - 2.0 * y) / height);
    (forward + right * to_right + up * to_up).normalize().as_vec3().to_array()
}

/// The place in the pixel.
#[inline(always)]
fn place<L: Lanes>(l: L, settings: &Settings, keys: Keys<L>) -> (L::F, L::F) {
    if mutant!("half_a_pixel_off") {
        return (l.f(0.0), l.f(0.0));
    }
    if settings.jitter { pair(l, settings.sampler, keys, 0, Purpose::Film) } else { (l.f(0.5), l.f(0.5)) }
}
