//! The film: per-pixel sums in f64, samples grouped into rounds, and what can be said of their error.
//!
//! Samples come in rounds of [`ROUND`] samples; each round has its own randomisation, so round means are independent
//! and their spread tells the standard error of the pixel. A pixel keeps its sum, the M2 of its rounds (Welford) and
//! the round that is being filled: 72 bytes. A film is cut into tiles; a tile is worked on by one thread at a time and
//! keeps its own sample count, so that interrupted renders may differ between tiles.

mod image;

pub use image::Image;

use crate::settings::Rect;

/// Samples in a round; a power of two.
pub const ROUND: u32 = 16;

/// Running sums of one pixel, per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Sum of all samples.
    pub sum: [f64; 3],
    /// Sum of squared deviations of the means of the complete rounds.
    pub m2: [f64; 3],
    /// Sum of the samples of the round that is not complete yet.
    pub round: [f64; 3],
}

impl Pixel {
    /// Adds sample number `index` (from 0) of this pixel.
    pub fn add(&mut self, index: u32, radiance: [f32; 3]) {
        for (channel, value) in radiance.into_iter().enumerate() {
            self.sum[channel] += f64::from(value);
            self.round[channel] += f64::from(value);
        }
        if (index + 1).is_multiple_of(ROUND) {
            self.complete_round(f64::from(index / ROUND));
        }
    }

    /// Takes the current round, which `before` others preceded, into the spread (Welford's update).
    fn complete_round(&mut self, before: f64) {
        let size = f64::from(ROUND);
        for channel in 0..3 {
            let (sum, round) = (self.sum[channel], self.round[channel]);
            let mean = sum / (size * (before + 1.0));
            let mean_before = if before > 0.0 { (sum - round) / (size * before) } else { mean };
            self.m2[channel] += (round / size - mean_before) * (round / size - mean);
            self.round[channel] = 0.0;
        }
    }

    /// Mean of `samples` samples; 0 for none.
    pub fn mean(&self, samples: u32) -> [f64; 3] {
        self.sum.map(|sum| if samples == 0 { 0.0 } else { sum / f64::from(samples) })
    }

    /// Variance of the mean of `samples` samples, from the complete rounds; `None` with fewer than two.
    pub fn variance_of_mean(&self, samples: u32) -> Option<[f64; 3]> {
        let rounds = f64::from(samples / ROUND);
        if rounds < 2.0 {
            return None;
        }
        let scale = f64::from(ROUND) / f64::from(samples);
        Some(self.m2.map(|m2| (m2 / (rounds - 1.0)).max(0.0) * scale))
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
    pub samples: u32,
    /// Its pixels, row by row from the top.
    pub pixels: Vec<Pixel>,
    /// What photon radii add to them; empty where no photons are asked.
    pub shifts: Vec<Shift>,
}

/// What photon radii add to a pixel in error, as far as photons can tell: sums over the samples of even and of odd
/// rounds. Rounds have photons of their own, so the product of the two halves has no bias by their noise.
pub type Shift = [[f32; 3]; 2];

/// A pixel, and what photon radii shift it by.
#[derive(Clone, Copy, Debug, PartialEq)]
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
                tiles.push(Tile {
                    area: size,
                    samples: 0,
                    pixels: vec![Pixel::default(); size.pixels()],
                    shifts: Vec::new(),
                });
            }
        }
        Self { area, tiles }
    }

    /// Fewest and most samples of any tile.
    pub fn samples(&self) -> (u32, u32) {
        let counts = self.tiles.iter().map(|tile| tile.samples);
        (counts.clone().min().unwrap_or(0), counts.max().unwrap_or(0))
    }

    /// The linear image so far; pixels without samples are black.
    pub fn develop(&self) -> Image {
        let mut image = Image::black(self.area.width, self.area.height);
        for tile in &self.tiles {
            self.for_each(tile, |index, pixel| image.pixels[index] = pixel.mean(tile.samples).map(|v| v as f32));
        }
        image
    }

    /// One estimate a pixel in image order, or `None` while some tile has fewer than two complete rounds.
    pub fn estimates(&self) -> Option<Vec<Estimate>> {
        if self.samples().0 < 2 * ROUND {
            return None;
        }
        let unknown = Estimate::new([0.0; 3], [0.0; 3], 0);
        let mut estimates = vec![unknown; self.area.pixels()];
        for tile in &self.tiles {
            self.for_each(tile, |index, pixel| {
                let variance = pixel.variance_of_mean(tile.samples).unwrap_or_default();
                estimates[index] = Estimate::new(pixel.mean(tile.samples), variance, tile.samples / ROUND);
            });
        }
        Some(estimates)
    }

    /// What photon radii shift each pixel by, in image order; `None` where no photons are asked, and before every tile
    /// has samples of two rounds.
    pub fn shifts(&self) -> Option<Vec<Shifted>> {
        if self.samples().0 <= ROUND || self.tiles.iter().any(|tile| tile.shifts.is_empty()) {
            return None;
        }
        let mut shifts = vec![Shifted { mean: [0.0; 3], halves: [[0.0; 3]; 2] }; self.area.pixels()];
        for tile in &self.tiles {
            let counts = halves(tile.samples).map(f64::from);
            let mut halves = tile.shifts.iter();
            self.for_each(tile, |index, pixel| {
                let [even, odd] = halves.next().copied().unwrap_or_default();
                let mean = |sum: [f32; 3], count: f64| sum.map(|value| f64::from(value) / count);
                let halves = [mean(even, counts[0]), mean(odd, counts[1])];
                shifts[index] = Shifted { mean: pixel.mean(tile.samples), halves };
            });
        }
        Some(shifts)
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

/// How many of the first `samples` samples are of even and of odd rounds.
fn halves(samples: u32) -> [u32; 2] {
    let (pairs, rest) = (samples / (2 * ROUND), samples % (2 * ROUND));
    [pairs * ROUND + rest.min(ROUND), pairs * ROUND + rest.saturating_sub(ROUND)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(samples: u32, value: impl Fn(u32) -> f32) -> Pixel {
        let mut pixel = Pixel::default();
        (0..samples).for_each(|s| pixel.add(s, [value(s), 2.0 * value(s), 0.0]));
        pixel
    }

    #[test]
    fn a_pixel_takes_72_bytes_and_its_estimate_28() {
        assert_eq!((size_of::<Pixel>(), size_of::<Estimate>()), (72, 28));
    }

    #[test]
    fn variance_is_that_of_the_round_means() {
        // Rounds of constant value 1, 2, 4, 9: mean 4, sample variance 38/3, of the mean 38/12.
        let values = [1.0, 2.0, 4.0, 9.0];
        let pixel = filled(4 * ROUND, |s| values[(s / ROUND) as usize]);
        let variance = pixel.variance_of_mean(4 * ROUND).unwrap();
        assert!((variance[0] - 38.0 / 12.0).abs() < 1e-12 && (variance[1] - 4.0 * 38.0 / 12.0).abs() < 1e-11);
        assert_eq!((variance[2], pixel.mean(4 * ROUND)[0]), (0.0, 4.0));
    }

    #[test]
    fn samples_of_an_unfinished_round_count_for_the_mean_only() {
        let pixel = filled(2 * ROUND + 4, |s| if s < ROUND { 1.0 } else { 3.0 });
        let samples = 2 * ROUND + 4;
        assert!((pixel.mean(samples)[0] - (16.0 + 60.0) / 36.0).abs() < 1e-12);
        // Variance of the mean of two rounds (1 and 3) is 1; scaled from 32 to 36 samples.
        assert!((pixel.variance_of_mean(samples).unwrap()[0] - 32.0 / 36.0).abs() < 1e-12);
        assert_eq!(pixel.variance_of_mean(2 * ROUND - 1), None);
    }

    #[test]
    fn sums_stay_exact_where_f32_would_stop_counting() {
        let mut pixel = Pixel::default();
        pixel.sum[0] = 16_777_216.0;
        pixel.add(3, [1.0, 0.0, 0.0]);
        assert_eq!(pixel.sum[0], 16_777_217.0);
    }

    #[test]
    fn samples_are_of_even_or_odd_rounds() {
        for samples in [0, 1, ROUND, ROUND + 3, 2 * ROUND, 5 * ROUND + 7] {
            let even = (0..samples).filter(|sample| (sample / ROUND).is_multiple_of(2)).count() as u32;
            assert_eq!(halves(samples), [even, samples - even]);
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
