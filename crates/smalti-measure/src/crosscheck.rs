//! Light that photons bring against the same light by paths.
//!
//! The two estimates share neither photons nor radii, so what one of them loses the other one shows. Paths meet small
//! lamps seldom and with much light at once: what they found is at least there, but what they did not find proves
//! nothing. So only blocks of pixels where paths find more count as a bias.

use serde::Serialize;
use smalti_core::film::Crosschecked;

use crate::blocks::Blocks;
use crate::compare::FLOOR;
use crate::interval::Z;

/// So many equal finds of paths, or more, are worth a normal distribution. Fewer are no check.
pub const FEWEST_FINDS: f64 = 16.0;

/// Standard errors by which paths must find more before a bias is stated: a true image is accused once in some thousands.
const SHOWN: f64 = 3.5;

/// What paths find of the light that photons bring, as shares of the image's light. The names of the fields are a promise:
/// summaries carry them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CrosscheckStatement {
    /// What photons bring.
    pub by_photons: f64,
    /// What paths find of it.
    pub by_paths: f64,
    /// Ends of the 95 % interval of `by_paths`, with the noise of `by_photons`; `None` where paths find too little to be
    /// a check.
    pub interval: Option<[f64; 2]>,
    /// Number of equal finds that are as noisy as those of the paths.
    pub finds: f64,
    /// What the light that blocks of pixels lack adds at least to the root of the mean over pixels of b² / (x² + 0.01 m²),
    /// b the bias and m the mean of the image; 0 where noise may account for it.
    pub lacking: f64,
    /// Upper end of its 95 % interval; 0 where noise may account for it.
    pub lacking_high: f64,
}

impl CrosscheckStatement {
    /// From the pixels of an image in rows of `width`. `None` where neither way brings light.
    pub fn of_pixels(pixels: &[Crosschecked], width: u32) -> Option<Self> {
        let light = pixels.iter().map(|pixel| pixel.mean).sum::<f64>();
        let floor = FLOOR * (light / pixels.len() as f64) * (light / pixels.len() as f64);
        let blocks = blocks(pixels, width, floor);
        let all = blocks.iter().fold(Block::default(), |sum, block| sum.and(block));
        let [lacking, lacking_high] = lacking(&blocks, pixels.len() as f64);
        let found = Self {
            by_photons: all.by_photons / light,
            by_paths: all.by_paths / light,
            interval: all.is_checked().then(|| [-1.0, 1.0].map(|side| (all.by_paths + side * all.margin()) / light)),
            finds: if all.by_paths > 0.0 { all.by_paths * all.by_paths / all.variance } else { 0.0 },
            lacking,
            lacking_high,
        };
        (found.by_photons + found.by_paths > 0.0).then_some(found)
    }
}

/// Sums over a block of pixels, or over all of them.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    by_photons: f64,
    by_paths: f64,
    /// Of `by_paths`.
    variance: f64,
    /// Of `by_photons`.
    photon_variance: f64,
    /// Of all light.
    light: f64,
    /// Of x² + floor, x all light of a pixel.
    squares: f64,
    /// Pixels.
    count: f64,
}

impl Block {
    fn and(self, other: &Self) -> Self {
        Self {
            by_photons: self.by_photons + other.by_photons,
            by_paths: self.by_paths + other.by_paths,
            variance: self.variance + other.variance,
            photon_variance: self.photon_variance + other.photon_variance,
            light: self.light + other.light,
            squares: self.squares + other.squares,
            count: self.count + other.count,
        }
    }

    fn is_checked(&self) -> bool {
        self.by_paths > 0.0 && self.by_paths * self.by_paths >= FEWEST_FINDS * self.variance
    }

    fn margin(&self) -> f64 {
        Z * (self.variance + self.photon_variance).sqrt()
    }

    /// The least that the pixels of the block lack, squared and relative, without what noise brings in the mean; and its
    /// variance.
    fn lacks(&self) -> [f64; 2] {
        let (noise, lack) = (self.variance + self.photon_variance, (self.by_paths - self.by_photons).max(0.0));
        let square = lack * lack;
        // Of all ways to share out what is lacking, that in proportion to x² + floor has the least sum of squares by
        // x² + floor (Cauchy and Schwarz); in x the lacking light belongs as well.
        let part = 1.0 / (self.squares + 2.0 * lack * self.light / self.count + square / self.count);
        // Of noise alone half the blocks lack something: the mean of the squares is a half, of fourth powers 3/2.
        [part * (square - 0.5 * noise), part * part * (4.0 * square * noise + 1.25 * noise * noise)]
    }
}

fn blocks(pixels: &[Crosschecked], width: u32, floor: f64) -> Vec<Block> {
    let grid = Blocks::new(pixels.len(), width);
    let (mut blocks, mut spreads) = (vec![Block::default(); grid.count], vec![0.0; grid.count]);
    for (index, pixel) in pixels.iter().enumerate() {
        let block = &mut blocks[grid.of(index)];
        block.by_photons += pixel.by_photons;
        block.by_paths += pixel.by_paths;
        block.variance += pixel.variance;
        block.light += pixel.mean;
        block.squares += pixel.mean * pixel.mean + floor;
        block.count += 1.0;
        spreads[grid.of(index)] += pixel.spread;
    }
    for (block, spread) in blocks.iter_mut().zip(spreads) {
        block.photon_variance = spread * spread;
    }
    blocks
}

/// What pixels lack in the root of the mean square, and the upper end of its interval.
fn lacking(blocks: &[Block], pixels: f64) -> [f64; 2] {
    let [mut square, mut variance] = [0.0; 2];
    for [of_block, its_variance] in blocks.iter().filter(|block| block.is_checked()).map(Block::lacks) {
        square += of_block / pixels;
        variance += its_variance / (pixels * pixels);
    }
    let error = variance.sqrt();
    let shown = square > SHOWN * error;
    if shown { [square.sqrt(), (square + Z * error).sqrt()] } else { [0.0; 2] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 64 × 64 pixels of which photons bring half: paths find `factor` times as much, by `finds` finds a pixel.
    fn image(factor: f64, finds: f64, wobble: impl Fn(usize) -> f64) -> Vec<Crosschecked> {
        let pixel = |index| Crosschecked {
            mean: 1.0,
            by_photons: 0.5,
            spread: 0.0,
            by_paths: 0.5 * factor + wobble(index),
            variance: 0.25 / finds,
        };
        (0..64 * 64).map(pixel).collect()
    }

    #[test]
    fn equal_light_is_no_bias() {
        let found = CrosscheckStatement::of_pixels(&image(1.0, 1.0, |_| 0.0), 64).unwrap();
        let [low, high] = found.interval.unwrap();
        assert!(low < 0.5 && high > 0.5 && high - low < 0.04, "{found:?}");
        assert!((found.finds - 4096.0).abs() < 1e-6 && (found.by_photons, found.by_paths) == (0.5, 0.5));
        assert_eq!((found.lacking, found.lacking_high), (0.0, 0.0));
    }

    #[test]
    fn light_that_photons_lose_is_a_bias() {
        // Photons lose a half of the caustic: 0.5 of 1.5 in each pixel, by the floor a little less.
        let found = CrosscheckStatement::of_pixels(&image(2.0, 4.0, |_| 0.0), 64).unwrap();
        assert!((found.lacking - 0.5 / 2.26f64.sqrt()).abs() < 0.01 && found.lacking_high > found.lacking, "{found:?}");
        assert!(found.interval.unwrap()[0] > found.by_photons);
    }

    #[test]
    fn light_that_photons_put_elsewhere_is_a_bias_where_it_lacks() {
        // Half of the columns of blocks lack 0.25, the others have as much too much: the sums agree.
        let sides = |index: usize| if index % 64 < 32 { 0.25 } else { -0.25 };
        let found = CrosscheckStatement::of_pixels(&image(1.0, 4.0, sides), 64).unwrap();
        assert!((found.lacking - 0.25 / 1.5725f64.sqrt() / 2f64.sqrt()).abs() < 0.01, "{found:?}");
        assert!((found.by_paths - found.by_photons).abs() < 1e-9);
    }

    #[test]
    fn light_that_paths_did_not_find_proves_nothing() {
        let found = CrosscheckStatement::of_pixels(&image(0.5, 4.0, |_| 0.0), 64).unwrap();
        assert_eq!((found.lacking, found.lacking_high), (0.0, 0.0));
        let few = CrosscheckStatement::of_pixels(&image(4.0, 0.0001, |_| 0.0), 64).unwrap();
        assert_eq!((few.interval, few.lacking), (None, 0.0), "{few:?}");
        let none = [Crosschecked { mean: 1.0, by_photons: 0.5, ..Crosschecked::default() }; 16];
        let none = CrosscheckStatement::of_pixels(&none, 4).unwrap();
        assert_eq!((none.by_paths, none.interval, none.finds), (0.0, None, 0.0));
        assert_eq!(CrosscheckStatement::of_pixels(&[Crosschecked::default(); 4], 2), None);
    }

    #[test]
    fn noise_of_photons_is_noise_of_the_check() {
        let quiet = CrosscheckStatement::of_pixels(&image(1.2, 1.0, |_| 0.0), 64).unwrap();
        let mut noisy = image(1.2, 1.0, |_| 0.0);
        noisy.iter_mut().for_each(|pixel| pixel.spread = 0.1);
        let noisy = CrosscheckStatement::of_pixels(&noisy, 64).unwrap();
        assert!(quiet.lacking > 0.0 && noisy.lacking == 0.0, "{quiet:?} {noisy:?}");
    }
}
