//! Light that photons bring, found a second time by paths.
//!
//! Paths that leave a diffuse vertex and meet a lamp after specular bounces alone find light that the caustic map holds
//! already, and the image leaves those hits out. What they would have brought is noted here, beside what the map brings
//! to the same samples: two estimates of the same light that share neither photons nor radii. Greys, the means of three
//! channels.

use super::{Counts, Film, Pixel};

/// What both ways found in the samples of a pixel, each sample times what it counts for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crosscheck {
    /// Sums of what photons bring, over even and over odd rounds, which have photons of their own.
    pub by_photons: [f32; 2],
    /// Sum of what paths find.
    pub by_paths: f64,
    /// Sum of the squares of what paths find.
    pub squares: f64,
}

impl Crosscheck {
    /// Adds a sample of an even (0) or odd (1) round that counts `weight` times. A sample that is not finite is left out.
    pub fn add(&mut self, half: usize, weight: f64, [by_photons, by_paths]: [f32; 2]) {
        if !(by_photons.is_finite() && by_paths.is_finite()) {
            return;
        }
        let by_paths = weight * f64::from(by_paths);
        self.by_photons[half] += (weight * f64::from(by_photons)) as f32;
        self.by_paths += by_paths;
        self.squares += by_paths * by_paths;
    }
}

/// A pixel as both ways found it, in units of its radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crosschecked {
    /// The pixel's mean, with all other light.
    pub mean: f64,
    /// What photons bring.
    pub by_photons: f64,
    /// Half the difference of what the photons of even and of odd rounds bring: its square is an estimate of the
    /// variance of `by_photons`.
    pub spread: f64,
    /// What paths find.
    pub by_paths: f64,
    /// At most the variance of `by_paths`, in the mean.
    pub variance: f64,
}

impl Crosschecked {
    fn new(pixel: &Pixel, check: &Crosscheck, counts: &Counts) -> Self {
        let weight = counts.weight();
        let [even, odd] = check.by_photons.map(f64::from);
        Self {
            mean: pixel.mean(counts).iter().sum::<f64>() / 3.0,
            by_photons: (even + odd) / weight,
            spread: (even - odd) / weight,
            by_paths: check.by_paths / weight,
            variance: check.squares / (weight * weight),
        }
    }
}

impl Film {
    /// What photons bring and paths find again, in image order; `None` where nothing was found twice, and before every
    /// tile has samples of two rounds.
    pub fn crosschecks(&self) -> Option<Vec<Crosschecked>> {
        self.noted(|tile| &tile.crosschecks, Crosschecked::new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::ROUND;
    use crate::settings::Rect;

    #[test]
    fn both_ways_are_means_and_their_variance_is_that_of_the_mean() {
        let mut film = Film::new(Rect { x: 0, y: 0, width: 1, height: 1 }, 1);
        assert_eq!(film.crosschecks(), None);
        let tile = &mut film.tiles[0];
        let mut check = Crosscheck::default();
        for sample in 0..4 * ROUND {
            // Photons bring 1 in even and 3 in odd rounds; paths find 32 in one sample of sixteen.
            let half = tile.counts.half();
            let by_paths = if sample % ROUND == 5 { 32.0 } else { 0.0 };
            check.add(half, 1.0, [if half == 0 { 1.0 } else { 3.0 }, by_paths]);
            tile.counts.add_plain();
        }
        tile.crosschecks = vec![check];
        let [found] = film.crosschecks().unwrap()[..] else { unreachable!("there is one pixel") };
        assert_eq!((found.by_photons, found.spread, found.by_paths), (2.0, -1.0, 2.0));
        // Four of 64 samples with 32: 4 · 32² / 64².
        assert_eq!(found.variance, 1.0);
    }

    #[test]
    fn samples_that_are_not_finite_are_left_out() {
        let mut check = Crosscheck::default();
        check.add(0, 1.0, [f32::NAN, 1.0]);
        check.add(1, 1.0, [1.0, f32::INFINITY]);
        assert_eq!(check, Crosscheck::default());
    }
}
