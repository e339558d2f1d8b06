//! Down-sampling: `by` × `by` pixels become one, their mean. Of a film the batches are averaged, each for itself: noise that
//! neighbours share stays what it is.

use std::borrow::Cow;

use super::{Crosscheck, Film, Image, Pixel, Shift, Tile};
use crate::settings::Rect;

impl Image {
    /// The image with `by` × `by` pixels averaged into one; rows and columns that fill no block are left out.
    ///
    /// # Panics
    /// If `by` is 0 or larger than the image.
    #[must_use]
    pub fn downsampled(self, by: u32) -> Self {
        if by == 1 {
            return self;
        }
        let part = 1.0 / (f64::from(by) * f64::from(by));
        let mean = |block: Vec<[f32; 3]>| {
            let sum = |c: usize| block.iter().map(|pixel| f64::from(pixel[c])).sum::<f64>();
            std::array::from_fn(|c| (sum(c) * part) as f32)
        };
        let pixels = blocks(&self.pixels, self.width, by).map(mean).collect();
        Self { width: self.width / by, height: self.height / by, pixels }
    }
}

impl Film {
    /// The film with `by` × `by` pixels averaged into one.
    ///
    /// # Panics
    /// Unless `by` divides the sides of all tiles.
    pub fn downsampled(&self, by: u32) -> Cow<'_, Self> {
        if by == 1 {
            return Cow::Borrowed(self);
        }
        let tiles = self.tiles.iter().map(|tile| tile.downsampled(by)).collect();
        Cow::Owned(Self { area: smaller(self.area, by), tiles })
    }
}

impl Tile {
    fn downsampled(&self, by: u32) -> Self {
        let area = smaller(self.area, by);
        let pixels = blocks(&self.pixels, self.area.width, by).map(|block| mean_pixel(&block)).collect();
        let shifts = blocks(&self.shifts, self.area.width, by).map(|block| mean_shift(&block)).collect();
        let checks = blocks(&self.crosschecks, self.area.width, by);
        Self {
            area,
            counts: self.counts,
            pixels,
            shifts,
            crosschecks: checks.map(|block| mean_check(&block)).collect(),
        }
    }
}

fn smaller(area: Rect, by: u32) -> Rect {
    assert!([area.x, area.y, area.width, area.height].iter().all(|side| side.is_multiple_of(by)));
    Rect { x: area.x / by, y: area.y / by, width: area.width / by, height: area.height / by }
}

/// The blocks of `by` × `by` of `pixels`, which are in rows of `width`.
fn blocks<T: Copy>(pixels: &[T], width: u32, by: u32) -> impl Iterator<Item = Vec<T>> {
    let (width, by) = (width as usize, by as usize);
    let block = move |rows: &[T], left: usize| -> Vec<T> {
        rows.chunks_exact(width).flat_map(|row| &row[left..left + by]).copied().collect()
    };
    let strip = move |rows| (0..=width - by).step_by(by).map(move |left| block(rows, left));
    pixels.chunks_exact(width * by).flat_map(strip)
}

fn mean_pixel(block: &[Pixel]) -> Pixel {
    let part = 1.0 / block.len() as f64;
    let sum = |k: usize, c: usize| block.iter().map(|pixel| pixel.sums[k][c]).sum::<f64>();
    Pixel { sums: std::array::from_fn(|k| std::array::from_fn(|c| sum(k, c) * part)) }
}

fn mean_shift(block: &[Shift]) -> Shift {
    let part = 1.0 / block.len() as f64;
    let sum = |half: usize, c: usize| block.iter().map(|shift| f64::from(shift[half][c])).sum::<f64>();
    std::array::from_fn(|half| std::array::from_fn(|c| (sum(half, c) * part) as f32))
}

/// The squares are those of a sum of independent ones.
fn mean_check(block: &[Crosscheck]) -> Crosscheck {
    let part = 1.0 / block.len() as f64;
    let sum = |value: fn(&Crosscheck) -> f64| block.iter().map(value).sum::<f64>();
    let halves = [sum(|check| f64::from(check.by_photons[0])), sum(|check| f64::from(check.by_photons[1]))];
    Crosscheck {
        by_photons: halves.map(|half| (part * half) as f32),
        by_paths: part * sum(|check| check.by_paths),
        squares: part * part * sum(|check| check.squares),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Counts, ROUND};

    #[test]
    fn blocks_are_averaged_where_they_lie() {
        let pixels = (0..24u16).map(|n| [f32::from(n), 1.0, -f32::from(n)]).collect();
        let image = Image { width: 6, height: 4, pixels }.downsampled(2);
        assert_eq!((image.width, image.height), (3, 2));
        // 0, 1, 6 and 7 have the mean 3.5; two columns on it is 2 more, two rows on 12.
        let expected = [3.5, 5.5, 7.5, 15.5, 17.5, 19.5].map(|n| [n, 1.0, -n]);
        assert_eq!(image.pixels, expected);
    }

    #[test]
    fn what_fills_no_block_is_left_out() {
        let image = Image { width: 5, height: 4, pixels: vec![[1.0; 3]; 20] }.downsampled(3);
        assert_eq!((image.width, image.height, image.pixels.as_slice()), (1, 1, &[[1.0; 3]][..]));
        let same = Image { width: 1, height: 2, pixels: vec![[0.1; 3], [0.2; 3]] };
        assert_eq!(same.clone().downsampled(1), same);
    }

    /// A film in tiles of 4, of two rounds: `value` of (x, y, round).
    fn film(value: impl Fn(u32, u32, u32) -> f64) -> Film {
        let mut film = Film::new(Rect { x: 4, y: 8, width: 12, height: 8 }, 4);
        for tile in &mut film.tiles {
            tile.counts = Counts::of(2 * ROUND);
            for (n, pixel) in tile.pixels.iter_mut().enumerate() {
                let (x, y) = (tile.area.x + n as u32 % 4, tile.area.y + n as u32 / 4);
                (0..2).for_each(|k| pixel.sums[k] = [value(x, y, k as u32) * f64::from(ROUND); 3]);
            }
        }
        film
    }

    #[test]
    fn a_film_develops_into_the_mean_of_its_image() {
        let film = film(|x, y, round| f64::from(x * x + 100 * y + 7 * round));
        assert_eq!(film.downsampled(2).develop(), film.develop().downsampled(2));
        assert_eq!(film.downsampled(2).area, Rect { x: 2, y: 4, width: 6, height: 4 });
    }

    #[test]
    fn noise_of_its_own_averages_out_and_shared_noise_stays() {
        let own = film(|x, y, round| f64::from((x + y + round) % 2));
        let shared = film(|_, _, round| f64::from(round));
        let variance = |film: &Film| film.downsampled(4).estimates().unwrap()[0].variance()[0];
        assert_eq!((variance(&own), variance(&shared)), (0.0, 0.25));
    }
}
