//! An image's own squared relative error, estimated from itself.
//!
//! Wanted is E, the mean over pixels and channels of (x − r)² / (r² + a), with x the image and r the truth. A pixel's
//! batches tell x and V, an unbiased estimate of x's variance. Then:
//!
//! - The mean of V / (r² + a) estimates E. The difference of the two has the variance 2 v² (1 + 1 / f) in each pixel, f one
//!   less than the number of batches, whatever the distribution of the samples: fourth cumulants cancel. So it is the
//!   error of this image, not of images like it, and their ratio follows Fisher's F.
//! - r is not known. With x in its place, V / (x² + a) is too small where large samples raise x and V together, and too
//!   large as 1 / (x² + a) is on average not 1 / (r² + a). Both go as the inverse of the number of samples, and so the
//!   same sum over fewer batches, each left out once and each two, tells how much it is: the **jackknife of second
//!   order** (Schucany, Gray and Owen 1971).
//! - Where one batch is much brighter than the others together, or two are, nobody can say what the pixel is without
//!   them: a rare event that belongs to this pixel, or one in as many pixels as there are. In the first case the error is
//!   that of x, in the second it has to be taken relative to what the other batches say. Such pixels are **uncertified**:
//!   the lower end takes the first, the upper end the second, and where they are too far apart there is no upper end. Two
//!   batches can only be told from the others where there are four.

use smalti_core::film::{BATCHES, Counts, Pixel, Tile};

use crate::interval::ratio_95;

/// A pixel is uncertified where r² + a is so much smaller without one of its batches, or without two.
///
/// The second was measured where a sliver of the lamp is in a pixel, and two batches happen to meet it: of 200 renders of
/// the reference room (`auto`, 160 × 160, 128 samples) 22 had a relmse above the interval with the first alone, 13 with
/// both; 10 in the place of 6 finds none of them.
const DOMINATED: [f64; 2] = [3.0, 6.0];

/// An interval whose ends are so far apart, in squares, says nothing: there is no upper end then.
const WIDEST: f64 = 100.0;

/// Pixels that are computed at a time.
const AT_ONCE: usize = 4;

/// Channels of so many pixels.
const LANES: usize = 3 * AT_ONCE;

/// A squared relative error with its 95 % interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relative {
    pub value: f64,
    pub low: f64,
    pub high: Option<f64>,
    pub uncertified: usize,
}

/// Sums over pixels; each with a floor of its own.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// V / (x² + a).
    plain: f64,
    /// The same freed of its bias.
    error: f64,
    /// Squares of what pixels have of the first.
    squares: f64,
    /// Squares of what the jackknife changes.
    changes: f64,
    /// What is to be added if the brightest batch, or the two brightest, of each uncertified pixel were chance.
    doubt: f64,
    uncertified: usize,
}

impl Sums {
    /// The sums of both.
    pub fn and(self, other: Self) -> Self {
        Self {
            plain: self.plain + other.plain,
            error: self.error + other.error,
            squares: self.squares + other.squares,
            changes: self.changes + other.changes,
            doubt: self.doubt + other.doubt,
            uncertified: self.uncertified + other.uncertified,
        }
    }

    /// What x itself says of the error: less than there is where noise is skewed, but never much more.
    pub fn plain(&self) -> f64 {
        self.plain
    }

    /// The mean over `count` pixels and channels, from `batches` batches. `None` if it is not finite.
    pub fn relative(&self, count: f64, batches: usize) -> Option<Relative> {
        if self.plain == 0.0 {
            return Some(Relative { value: 0.0, low: 0.0, high: Some(0.0), uncertified: 0 });
        }
        // Where the jackknife leaves nothing it has gone too far.
        let error = self.error.max(self.plain / 2.0);
        let doubt = self.doubt.max(0.0);
        let (low, high) = self.interval(batches);
        let (low, high) = (error * low, high.map(|high| (error + doubt) * high));
        let found = Relative {
            value: (error * (error + doubt)).sqrt() / count,
            low: low / count,
            high: high.filter(|high| batches > 2 && *high <= WIDEST * low).map(|high| high / count),
            uncertified: self.uncertified,
        };
        (found.value.is_finite() && found.low.is_finite()).then_some(found)
    }

    /// The interval of the ratio of the true error to the estimated one. Channels are taken to go together.
    fn interval(&self, batches: usize) -> (f64, Option<f64>) {
        let freedom = (batches - 1) as f64;
        let total = self.plain * self.plain;
        // The mean of t² is not the square of the mean but (1 + 2 / f) times that.
        let above = self.squares / (1.0 + 2.0 / freedom);
        let below = above / freedom;
        let variance = 2.0 * (above + below) / total;
        let certain = variance / (variance + self.changes / total);
        ratio_95(certain * total / above, certain * total / below)
    }
}

/// The sums over the pixels of a tile, for two floors.
pub(crate) fn sums(tile: &Tile, floors: [f64; 2]) -> [Sums; 2] {
    let subsets = Subsets::of(&tile.counts);
    let mut looks = vec![Look::default(); subsets.0.len()];
    let mut sums = [Sums::default(); 2];
    for pixels in tile.pixels.chunks(AT_ONCE) {
        let means = means(pixels, &tile.counts);
        subsets.look(&means, &mut looks);
        for (sums, floor) in sums.iter_mut().zip(floors) {
            sums.add(&subsets.terms(&looks, floor), pixels.len());
        }
    }
    sums
}

impl Sums {
    fn add(&mut self, terms: &Terms, pixels: usize) {
        for pixel in 0..pixels {
            let of = |values: &[f64; LANES]| values[3 * pixel..3 * pixel + 3].iter().sum::<f64>();
            let (plain, error) = (of(&terms.plain), of(&terms.error));
            self.plain += plain;
            self.error += error;
            self.squares += plain * plain;
            self.changes += (error - plain) * (error - plain);
            let channels = 3 * pixel..3 * pixel + 3;
            let is_dominated = |left_out: &usize| {
                terms.dominated[*left_out][channels.clone()].iter().any(|ratio| *ratio > DOMINATED[*left_out])
            };
            let doubts = (0..2).filter(is_dominated).map(|left_out| of(&terms.without[left_out]) - error);
            if let Some(doubt) = doubts.reduce(f64::max) {
                self.uncertified += 1;
                self.doubt += doubt;
            }
        }
    }
}

/// Means of the batches of some pixels, channel by channel; 0 for pixels that are missing.
fn means(pixels: &[Pixel], counts: &Counts) -> [[f64; LANES]; BATCHES] {
    let mut means = [[0.0; LANES]; BATCHES];
    for (number, pixel) in pixels.iter().enumerate() {
        for (batch, means) in means.iter_mut().enumerate() {
            means[3 * number..3 * number + 3].copy_from_slice(&pixel.batch_mean(counts, batch));
        }
    }
    means
}

/// Some of the batches: what each counts for in the mean, and in the variance of the mean of all of them.
#[derive(Clone, Copy, Debug)]
struct Subset {
    mean: [f64; BATCHES],
    variance: [f64; BATCHES],
    /// What its term counts for in the jackknife.
    factor: f64,
    /// Batches that are left out.
    left_out: usize,
}

/// All batches; all but one; all but two.
struct Subsets(Vec<Subset>);

/// Mean and variance as some batches say them.
#[derive(Clone, Default)]
struct Look {
    mean: [f64; LANES],
    variance: [f64; LANES],
}

/// What pixels have of the sums, channel by channel.
struct Terms {
    plain: [f64; LANES],
    error: [f64; LANES],
    /// The variance relative to what the pixel is without its brightest batch, and without the two brightest.
    without: [[f64; LANES]; 2],
    /// How much smaller r² + a is without them.
    dominated: [[f64; LANES]; 2],
}

impl Subsets {
    fn of(counts: &Counts) -> Self {
        let used = counts.batches();
        // 1 / n and 1 / n² cancel: n = 4, 3, 2; of three batches 1 / n alone, of two nothing.
        let factors: [f64; 3] = match used {
            4 => [8.0, -9.0, 2.0],
            3 => [3.0, -2.0, 0.0],
            _ => [1.0, 0.0, 0.0],
        };
        let masks = || (1u32..1 << used).map(|mask| (mask, used - mask.count_ones() as usize));
        let of_size = |left_out: usize| masks().filter(move |(_, missing)| *missing == left_out);
        let subset = |(mask, missing): (u32, usize)| {
            Subset::new(counts, mask, factors[missing] / of_size(missing).count() as f64, missing)
        };
        let needed = |left_out: &usize| *left_out < 2 || factors[*left_out] != 0.0;
        Self((0..3).filter(needed).flat_map(of_size).map(subset).collect())
    }

    fn look(&self, means: &[[f64; LANES]; BATCHES], looks: &mut [Look]) {
        self.0.iter().zip(looks).for_each(|(subset, look)| *look = subset.look(means));
    }

    fn terms(&self, looks: &[Look], floor: f64) -> Terms {
        let mut least = [[f64::INFINITY; LANES]; 2];
        let (mut plain, mut error) = ([0.0; LANES], [0.0; LANES]);
        for (subset, look) in self.0.iter().zip(looks) {
            let term = look.term(floor);
            (0..LANES).for_each(|i| error[i] += subset.factor * term[i]);
            if let Some(least) = subset.left_out.checked_sub(1).map(|left_out| &mut least[left_out]) {
                (0..LANES).for_each(|i| least[i] = if look.mean[i] < least[i] { look.mean[i] } else { least[i] });
            }
        }
        let all = &looks[0];
        plain.copy_from_slice(&all.term(floor));
        let square = |mean: f64| mean * mean + floor;
        Terms {
            plain,
            error,
            without: least.map(|least| std::array::from_fn(|i| ratio(all.variance[i], square(least[i])))),
            dominated: least.map(|least| std::array::from_fn(|i| ratio(square(all.mean[i]), square(least[i])))),
        }
    }
}

impl Subset {
    /// The batches of `mask`.
    fn new(counts: &Counts, mask: u32, factor: f64, left_out: usize) -> Self {
        let size = |k: usize| if mask >> k & 1 == 1 { counts.size(k) } else { 0.0 };
        let all = (0..BATCHES).map(size).sum::<f64>();
        let freedom = f64::from(mask.count_ones()) - 1.0;
        let divisor = freedom * counts.size_of_all();
        Self {
            mean: std::array::from_fn(|k| size(k) / all),
            variance: std::array::from_fn(|k| if divisor > 0.0 { size(k) / divisor } else { 0.0 }),
            factor,
            left_out,
        }
    }

    fn look(&self, means: &[[f64; LANES]; BATCHES]) -> Look {
        let (mut mean, mut variance) = ([0.0; LANES], [0.0; LANES]);
        for (batch, share) in means.iter().zip(self.mean) {
            (0..LANES).for_each(|i| mean[i] += share * batch[i]);
        }
        for (batch, share) in means.iter().zip(self.variance) {
            (0..LANES).for_each(|i| variance[i] += share * (batch[i] - mean[i]) * (batch[i] - mean[i]));
        }
        Look { mean, variance }
    }
}

impl Look {
    fn term(&self, floor: f64) -> [f64; LANES] {
        std::array::from_fn(|i| ratio(self.variance[i], self.mean[i] * self.mean[i] + floor))
    }
}

/// A black image has a floor of 0, and no error.
fn ratio(above: f64, below: f64) -> f64 {
    if above == 0.0 { 0.0 } else { above / below }
}
