//! The bias that photon radii put into an image, apart from its noise.
//!
//! Photons within a disc of radius r blur what they show: the bias goes with r², so half of the disc's area has half of
//! it, and twice the difference of the two is an estimate of it (in the spirit of Hachisuka, Jarosz and Jensen 2010, who
//! estimate the second derivative that causes it). A pixel's estimate is noisy; but rounds have photons of their own,
//! and the product of two independent estimates has the square of the bias as its mean.

use serde::Serialize;
use smalti_core::film::{Film, Shifted};

use crate::blocks::Blocks;
use crate::compare::FLOOR;
use crate::crosscheck::CrosscheckStatement;
use crate::interval::Z;

/// The upper end allows for this much more: of what is much smaller than a photon's disc, half of the disc has more than
/// half of the bias. Of the random rooms whose error is bias for the most part, 1.3 holds 95 % of the renders (`rooms`,
/// column `needed` times this).
const UNRESOLVED: f64 = 1.5;

/// The bias by photon radii. The names of the fields are a promise: summaries carry them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BiasStatement {
    /// Root of the mean over pixels and channels of b² / (x² + 0.01 m²), b the bias and m the mean of the image: what the
    /// radius adds to the relative error.
    pub relative_bias: f64,
    /// Upper end of its 95 % interval, and of what photons lack of the light that paths find.
    pub relative_bias_high: f64,
    /// By what fraction the image as a whole is too bright (or, below 0, too dark).
    pub brightness: f64,
    /// Light that photons bring against the same light by paths; `None` where paths find none of it.
    pub crosscheck: Option<CrosscheckStatement>,
}

/// The bias of the image that `film` develops into. `None` where nothing is known.
pub fn bias_statement(film: &Film) -> Option<BiasStatement> {
    let halves = of_pixels(&film.shifts()?, film.area.width)?;
    let crosscheck = film.crosschecks().and_then(|checks| CrosscheckStatement::of_pixels(&checks, film.area.width));
    let lacking = crosscheck.map_or(0.0, |check| check.lacking_high);
    Some(BiasStatement { relative_bias_high: halves.relative_bias_high.max(lacking), crosscheck, ..halves })
}

/// The same by the shifts of the pixels, in rows of `width`.
fn of_pixels(pixels: &[Shifted], width: u32) -> Option<BiasStatement> {
    let count = (3 * pixels.len()) as f64;
    let mean = pixels.iter().flat_map(|pixel| pixel.mean).sum::<f64>() / count;
    let blocks = blocks(pixels, width, FLOOR * mean * mean);
    let square = blocks.iter().map(|block| block.sum).sum::<f64>() / count;
    // Of a single block nobody can tell: not a number.
    let high = square + Z * standard_error(&blocks, square) / count;
    let shift = pixels.iter().flat_map(|pixel| pixel.halves.as_flattened()).sum::<f64>();
    let found = BiasStatement {
        relative_bias: square.max(0.0).sqrt(),
        relative_bias_high: UNRESOLVED * high.max(0.0).sqrt(),
        // Twice the shift is the bias, and it is the mean of its halves.
        brightness: shift / (count * mean),
        crosscheck: None,
    };
    (high.is_finite() && found.brightness.is_finite()).then_some(found)
}

/// What a block of pixels has of the squared bias.
#[derive(Clone, Copy, Default)]
struct Block {
    /// Sum over pixels and channels.
    sum: f64,
    /// Pixels and channels.
    values: f64,
}

fn blocks(pixels: &[Shifted], width: u32, floor: f64) -> Vec<Block> {
    let grid = Blocks::new(pixels.len(), width);
    let mut blocks = vec![Block::default(); grid.count];
    for (index, pixel) in pixels.iter().enumerate() {
        let block = &mut blocks[grid.of(index)];
        block.sum += squared_bias(pixel, floor);
        block.values += 3.0;
    }
    blocks
}

/// Sum over the channels of an estimate of b² / (x² + floor).
fn squared_bias(Shifted { mean, halves: [even, odd] }: &Shifted, floor: f64) -> f64 {
    let of_channel = |c: usize| match 4.0 * even[c] * odd[c] {
        0.0 => 0.0,
        product => product / (mean[c] * mean[c] + floor),
    };
    (0..3).map(of_channel).sum()
}

/// Standard error of the sum over the blocks, whose mean by value is `mean`.
fn standard_error(blocks: &[Block], mean: f64) -> f64 {
    let squares = blocks.iter().map(|block| block.sum - mean * block.values).map(|off| off * off).sum::<f64>();
    let count = blocks.len() as f64;
    (squares * count / (count - 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number in [-1, 1) that looks random (the mixer of SplitMix64).
    fn noise(index: usize, salt: u64) -> f64 {
        let mut x = (index as u64 ^ salt << 32).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ x >> 31) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn image(bias: impl Fn(usize) -> f64, amplitude: f64) -> Vec<Shifted> {
        let half = |index, salt| [bias(index) / 2.0 + amplitude * noise(index, salt); 3];
        let pixel = |index| Shifted { mean: [1.0; 3], halves: [half(index, 1), half(index, 2)] };
        (0..256 * 128).map(pixel).collect()
    }

    #[test]
    fn a_bias_is_found_under_noise_much_larger() {
        let alternating = |index: usize| if index.is_multiple_of(2) { 0.01 } else { -0.01 };
        let found = of_pixels(&image(alternating, 0.02), 256).unwrap();
        let truth = 0.01 / 1.01f64.sqrt();
        assert!((found.relative_bias / truth - 1.0).abs() < 0.1, "{found:?}");
        assert!(
            found.relative_bias_high > found.relative_bias && found.relative_bias_high < 1.3 * UNRESOLVED * truth,
            "{found:?}"
        );
        assert!(found.brightness.abs() < 1e-3);
    }

    #[test]
    fn noise_alone_is_no_bias() {
        let found = of_pixels(&image(|_| 0.0, 0.02), 256).unwrap();
        assert!(found.relative_bias < 0.002 && found.relative_bias_high < 0.004 * UNRESOLVED, "{found:?}");
    }

    #[test]
    fn what_darkens_everything_is_told_with_its_sign() {
        let found = of_pixels(&image(|_| -0.02, 0.0), 256).unwrap();
        assert!((found.brightness + 0.02).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn small_images_have_an_upper_end_too() {
        let found = of_pixels(&image(|_| 0.01, 0.005)[..24 * 16], 24).unwrap();
        assert!(found.relative_bias_high > found.relative_bias && found.relative_bias > 0.005, "{found:?}");
        assert_eq!(of_pixels(&image(|_| 0.01, 0.005)[..1], 1), None);
    }

    #[test]
    fn nothing_known_is_not_stated() {
        assert_eq!(of_pixels(&[], 1), None);
        let black = Shifted { mean: [0.0; 3], halves: [[0.0; 3]; 2] };
        assert_eq!(of_pixels(&[black; 4], 2), None);
    }
}
