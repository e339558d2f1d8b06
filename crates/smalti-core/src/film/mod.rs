//! The film: per-pixel sums in f64, in batches that are independent of each other, and what can be said of their error.
//!
//! Samples come in rounds of [`ROUND`] samples, each with its own randomisation (and photons), so rounds are independent.
//! They are dealt out to [`BATCHES`] batches in turn; a pixel keeps the sum of each, and the spread of the batches tells
//! its standard error. Four sums, and not a mean with its variance: an error *relative to the truth* needs to know what
//! the pixel would be without the samples that make it noisy (see `smalti-measure`). A film is cut into tiles; a tile is
//! worked on by one thread at a time and keeps its own sample count, so that interrupted renders may differ between tiles.
//!
//! Where sampling is adaptive, a tile takes ρ times as many samples as the film in the mean, and each counts 1 / ρ times. As
//! ρ is decided before they are taken, the mean has no bias, whatever it is decided by.

mod crosscheck;
mod downsample;
mod image;

pub use crosscheck::{Crosscheck, Crosschecked};
pub use image::Image;

use crate::mutant::mutant;
use crate::settings::Rect;

/// Samples in a round; a power of two.
pub const ROUND: u32 = 16;

/// Independent parts of a pixel's samples.
pub const BATCHES: usize = 4;

/// Sums over the samples of one pixel, per channel: one for each batch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Each sample times what it counts for.
    pub sums: [[f64; 3]; BATCHES],
}

impl Pixel {
    /// Adds a sample that counts `weight` times to a batch.
    pub fn add(&mut self, batch: usize, weight: f64, radiance: [f32; 3]) {
        for (sum, value) in self.sums[batch].iter_mut().zip(radiance) {
            *sum += weight * f64::from(value);
            if mutant!("film_in_f32") {
                *sum = f64::from(*sum as f32);
            }
        }
    }

    /// Mean of all samples, which `counts` counts; 0 for none.
    pub fn mean(&self, counts: &Counts) -> [f64; 3] {
        let weight = counts.weight();
        let sum = |c: usize| self.sums.iter().map(|sum| sum[c]).sum::<f64>();
        std::array::from_fn(|c| if weight == 0.0 { 0.0 } else { sum(c) / weight })
    }

    /// Variance of the mean of all samples, from the spread of the batches; `None` with fewer than two complete rounds.
    pub fn variance_of_mean(&self, counts: &Counts) -> Option<[f64; 3]> {
        let used = counts.batches();
        if used < 2 {
            return None;
        }
        let sizes: [f64; BATCHES] = std::array::from_fn(|k| counts.size(k));
        let all = sizes.iter().sum::<f64>();
        let of_channel = |c: usize| {
            let means: [f64; BATCHES] = std::array::from_fn(|k| self.batch_mean(counts, k)[c]);
            let mean = means.iter().zip(sizes).map(|(mean, size)| mean * size).sum::<f64>() / all;
            let spread = means.iter().zip(sizes).map(|(of, size)| size * (of - mean) * (of - mean)).sum::<f64>();
            let freedom = if mutant!("variance_by_batches") { used } else { used - 1 };
            spread / freedom as f64 / counts.size_of_all()
        };
        Some(std::array::from_fn(of_channel))
    }

    /// Mean of the samples of a batch; 0 for none.
    pub fn batch_mean(&self, counts: &Counts, batch: usize) -> [f64; 3] {
        let weight = counts.weights[batch];
        self.sums[batch].map(|sum| if weight == 0.0 { 0.0 } else { sum / weight })
    }
}

/// How many samples each pixel of a tile has in each batch, and what they count for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Samples that every pixel has.
    pub samples: u32,
    /// Complete rounds, or visits of more than one round.
    pub rounds: u32,
    /// Samples of even and of odd rounds.
    pub halves: [u32; 2],
    /// What the samples of each batch count for together.
    pub weights: [f64; BATCHES],
    /// The sum of the squares of what each counts for.
    squares: [f64; BATCHES],
}

impl Counts {
    /// The batch of the round that comes after the complete ones.
    pub fn batch(&self) -> usize {
        self.rounds as usize % BATCHES
    }

    /// Whether the current round is even (0) or odd (1).
    pub fn half(&self) -> usize {
        self.rounds as usize % 2
    }

    /// Counts one more sample of the current round, `weight` times.
    pub fn add(&mut self, weight: f64) {
        let batch = self.batch();
        self.samples += 1;
        self.halves[self.half()] += 1;
        self.weights[batch] += weight;
        self.squares[batch] += weight * weight;
    }

    /// Counts one more sample once; every [`ROUND`] of these end a round.
    pub fn add_plain(&mut self) {
        self.add(1.0);
        if self.samples.is_multiple_of(ROUND) {
            self.end_round();
        }
    }

    /// Ends the current round.
    pub fn end_round(&mut self) {
        self.rounds += 1;
    }

    /// Those of so many samples, in rounds of [`ROUND`], each of which counts once.
    pub fn of(samples: u32) -> Self {
        let mut counts = Self::default();
        (0..samples).for_each(|_| counts.add_plain());
        counts
    }

    /// What all samples count for together.
    pub fn weight(&self) -> f64 {
        self.weights.iter().sum()
    }

    /// Batches with a complete round.
    pub fn batches(&self) -> usize {
        BATCHES.min(self.rounds as usize)
    }

    /// How many samples of equal weight a batch is worth; 0 of a batch that is not to be judged by.
    pub fn size(&self, batch: usize) -> f64 {
        if batch < self.batches() { self.weights[batch] * self.weights[batch] / self.squares[batch] } else { 0.0 }
    }

    /// The same of all samples.
    pub fn size_of_all(&self) -> f64 {
        self.weight() * self.weight() / self.squares.iter().sum::<f64>()
    }
}

/// What is known of a pixel: its value and how sure it is. As f32, which is more than it is sure of: an image has many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    mean: [f32; 3],
    standard_error: [f32; 3],
    /// Complete rounds behind the standard error, at least 2.
    pub rounds: u32,
}

impl Estimate {
    /// From the mean of a pixel's samples and the variance of that mean by `rounds` complete rounds.
    pub fn new(mean: [f64; 3], variance: [f64; 3], rounds: u32) -> Self {
        Self { mean: mean.map(|x| x as f32), standard_error: variance.map(|x| x.sqrt() as f32), rounds }
    }

    /// Mean of the samples.
    pub fn mean(&self) -> [f64; 3] {
        self.mean.map(f64::from)
    }

    /// Variance of that mean.
    pub fn variance(&self) -> [f64; 3] {
        self.standard_error.map(|error| f64::from(error) * f64::from(error))
    }
}

/// A rectangle of the film with its own sample count.
#[derive(Clone, Debug)]
pub struct Tile {
    /// Where it lies in the whole image.
    pub area: Rect,
    /// Samples that every pixel of the tile has.
    pub counts: Counts,
    /// Its pixels, row by row from the top.
    pub pixels: Vec<Pixel>,
    /// What photon radii add to them; empty where no photons are asked.
    pub shifts: Vec<Shift>,
    /// What photons bring and paths find again; empty where nothing is found twice.
    pub crosschecks: Vec<Crosscheck>,
}

impl Tile {
    /// An empty tile.
    pub fn new(area: Rect) -> Self {
        let pixels = vec![Pixel::default(); area.pixels()];
        Self { area, counts: Counts::default(), pixels, shifts: Vec::new(), crosschecks: Vec::new() }
    }

    /// Samples that every pixel has.
    pub fn samples(&self) -> u32 {
        self.counts.samples
    }
}

/// What photon radii add to a pixel in error, as far as photons can tell: sums over the samples of even and of odd
/// rounds. Rounds have photons of their own, so the product of the two halves has no bias by their noise.
pub type Shift = [[f32; 3]; 2];

/// A pixel, and what photon radii shift it by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shifted {
    /// Mean of all samples.
    pub mean: [f64; 3],
    /// Means of the shift (half of the bias by the radius) over the samples of even and of odd rounds.
    pub halves: [[f64; 3]; 2],
}

/// The film of a render.
#[derive(Clone, Debug)]
pub struct Film {
    /// The part of the image that is rendered.
    pub area: Rect,
    /// Tiles, row by row; together they cover the area.
    pub tiles: Vec<Tile>,
}

impl Film {
    /// An empty film over `area`, in tiles of at most `tile` × `tile` pixels.
    ///
    /// # Panics
    /// With a tile size of 0.
    pub fn new(area: Rect, tile: u32) -> Self {
        let mut tiles = Vec::new();
        for y in (0..area.height).step_by(tile as usize) {
            for x in (0..area.width).step_by(tile as usize) {
                let size = Rect {
                    x: area.x + x,
                    y: area.y + y,
                    width: tile.min(area.width - x),
                    height: tile.min(area.height - y),
                };
                tiles.push(Tile::new(size));
            }
        }
        Self { area, tiles }
    }

    /// Fewest and most samples of any tile.
    pub fn samples(&self) -> (u32, u32) {
        let counts = self.tiles.iter().map(Tile::samples);
        (counts.clone().min().unwrap_or(0), counts.max().unwrap_or(0))
    }

    /// The linear image so far; pixels without samples are black.
    pub fn develop(&self) -> Image {
        let mut image = Image::black(self.area.width, self.area.height);
        for tile in &self.tiles {
            self.for_each(tile, |index, pixel| image.pixels[index] = pixel.mean(&tile.counts).map(|v| v as f32));
        }
        image
    }

    /// One estimate a pixel in image order, or `None` while some tile has fewer than two complete rounds.
    pub fn estimates(&self) -> Option<Vec<Estimate>> {
        if self.tiles.iter().any(|tile| tile.counts.batches() < 2) {
            return None;
        }
        let unknown = Estimate::new([0.0; 3], [0.0; 3], 0);
        let mut estimates = vec![unknown; self.area.pixels()];
        for tile in &self.tiles {
            self.for_each(tile, |index, pixel| {
                let variance = pixel.variance_of_mean(&tile.counts).unwrap_or_default();
                estimates[index] = Estimate::new(pixel.mean(&tile.counts), variance, tile.counts.rounds);
            });
        }
        Some(estimates)
    }

    /// The standard error of each pixel's channels, or `None` while some tile has fewer than two complete rounds.
    pub fn standard_errors(&self) -> Option<Image> {
        let pixels = self.estimates()?.iter().map(|estimate| estimate.standard_error).collect();
        Some(Image { width: self.area.width, height: self.area.height, pixels })
    }

    /// What photon radii shift each pixel by, in image order; `None` where no photons are asked, and before every tile
    /// has samples of two rounds.
    pub fn shifts(&self) -> Option<Vec<Shifted>> {
        self.noted(
            |tile| &tile.shifts,
            |pixel, [even, odd], counts| {
                let mean = |sum: &[f32; 3], count: u32| sum.map(|value| f64::from(value) / f64::from(count));
                let halves = [mean(even, counts.halves[0]), mean(odd, counts.halves[1])];
                Shifted { mean: pixel.mean(counts), halves }
            },
        )
    }

    /// Each pixel with its entry in the notes that tiles keep beside their pixels, in image order; `None` where a tile has
    /// no notes, or no samples of two rounds.
    fn noted<N, T: Clone + Default>(
        &self,
        notes: impl Fn(&Tile) -> &[N],
        made: impl Fn(&Pixel, &N, &Counts) -> T,
    ) -> Option<Vec<T>> {
        if self.tiles.iter().any(|tile| tile.counts.halves[1] == 0 || notes(tile).is_empty()) {
            return None;
        }
        let mut all = vec![T::default(); self.area.pixels()];
        for tile in &self.tiles {
            let mut notes = notes(tile).iter();
            self.for_each(tile, |index, pixel| {
                if let Some(note) = notes.next() {
                    all[index] = made(pixel, note, &tile.counts);
                }
            });
        }
        Some(all)
    }

    /// Calls `visit` with the image index and the sums of every pixel of `tile`.
    fn for_each(&self, tile: &Tile, mut visit: impl FnMut(usize, &Pixel)) {
        for (row, pixels) in tile.pixels.chunks_exact(tile.area.width as usize).enumerate() {
            let y = (tile.area.y - self.area.y) as usize + row;
            let start = y * self.area.width as usize + (tile.area.x - self.area.x) as usize;
            for (column, pixel) in pixels.iter().enumerate() {
                visit(start + column, pixel);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(samples: u32, value: impl Fn(u32) -> f32) -> (Pixel, Counts) {
        let (mut pixel, mut counts) = (Pixel::default(), Counts::default());
        for s in 0..samples {
            pixel.add(counts.batch(), 1.0, [value(s), 2.0 * value(s), 0.0]);
            counts.add_plain();
        }
        (pixel, counts)
    }

    #[test]
    fn a_pixel_takes_96_bytes_and_its_estimate_28() {
        assert_eq!((size_of::<Pixel>(), size_of::<Estimate>()), (96, 28));
    }

    #[test]
    fn variance_is_that_of_the_round_means() {
        // Rounds of constant value 1, 2, 4, 9: mean 4, sample variance 38/3, of the mean 38/12.
        let values = [1.0, 2.0, 4.0, 9.0];
        let (pixel, counts) = filled(4 * ROUND, |s| values[(s / ROUND) as usize]);
        let variance = pixel.variance_of_mean(&counts).unwrap();
        assert!((variance[0] - 38.0 / 12.0).abs() < 1e-12 && (variance[1] - 4.0 * 38.0 / 12.0).abs() < 1e-11);
        assert_eq!((variance[2], pixel.mean(&counts)[0]), (0.0, 4.0));
    }

    #[test]
    fn variance_of_uneven_batches_is_that_of_equal_samples() {
        // Rounds of 0 and 1: batches have the means 1/2, 0, 1, 0 of 2, 1, 1, 1 rounds; the mean is 2/5.
        let values = [0.0, 0.0, 1.0, 0.0, 1.0];
        let (pixel, counts) = filled(5 * ROUND, |s| values[(s / ROUND) as usize]);
        let spread = 2.0 * 0.1 * 0.1 + 2.0 * 0.4 * 0.4 + 0.6 * 0.6;
        assert!((pixel.mean(&counts)[0] - 0.4).abs() < 1e-12);
        assert!((pixel.variance_of_mean(&counts).unwrap()[0] - spread / 3.0 / 5.0).abs() < 1e-12);
    }

    #[test]
    fn samples_of_an_unfinished_round_count_for_the_mean_only() {
        let (pixel, counts) = filled(2 * ROUND + 4, |s| if s < ROUND { 1.0 } else { 3.0 });
        assert!((pixel.mean(&counts)[0] - (16.0 + 60.0) / 36.0).abs() < 1e-12);
        // Variance of the mean of two rounds (1 and 3) is 1; scaled from 32 to 36 samples.
        assert!((pixel.variance_of_mean(&counts).unwrap()[0] - 32.0 / 36.0).abs() < 1e-12);
        assert_eq!(pixel.variance_of_mean(&Counts::of(2 * ROUND - 1)), None);
    }

    #[test]
    fn what_is_sampled_seldom_counts_more() {
        let (mut pixel, mut counts) = (Pixel::default(), Counts::default());
        for (weight, value) in [(1.0, 3.0), (0.25, 5.0), (4.0, 1.0)] {
            for _ in 0..ROUND {
                pixel.add(counts.batch(), weight, [value; 3]);
                counts.add(weight);
            }
            counts.end_round();
        }
        let (sum, squares) = (5.25, 1.0 + 0.0625 + 16.0);
        assert!((pixel.mean(&counts)[0] - (3.0 + 1.25 + 4.0) / sum).abs() < 1e-12);
        assert!((counts.size_of_all() - f64::from(ROUND) * sum * sum / squares).abs() < 1e-9);
        assert_eq!((counts.samples, counts.rounds, counts.size(1)), (3 * ROUND, 3, f64::from(ROUND)));
    }

    #[test]
    fn sums_stay_exact_where_f32_would_stop_counting() {
        let mut pixel = Pixel::default();
        pixel.sums[0][0] = 16_777_216.0;
        pixel.add(0, 1.0, [1.0, 0.0, 0.0]);
        assert_eq!(pixel.sums[0][0], 16_777_217.0);
    }

    #[test]
    fn samples_are_of_even_or_odd_rounds() {
        for samples in [0, 1, ROUND, ROUND + 3, 2 * ROUND, 5 * ROUND + 7] {
            let even = (0..samples).filter(|sample| (sample / ROUND).is_multiple_of(2)).count() as u32;
            assert_eq!(Counts::of(samples).halves, [even, samples - even]);
        }
    }

    #[test]
    fn tiles_cover_the_area_once() {
        let film = Film::new(Rect { x: 3, y: 5, width: 33, height: 17 }, 8);
        let mut seen = vec![0; 33 * 17];
        for tile in &film.tiles {
            film.for_each(tile, |index, _| seen[index] += 1);
        }
        assert!(seen.iter().all(|count| *count == 1));
    }
}
