//! An image's own squared relative error, estimated from itself.
//!
//! Wanted is E, the mean over pixels and channels of (x − r)² / (r² + a), with x the image and r the truth. The film
//! knows x and V, an unbiased estimate of x's variance v from R rounds. Then:
//!
//! - S, the mean of V / (r² + a), estimates E. The difference of the two has the variance 2 v² R / (R − 1) in each pixel,
//!   whatever the distribution of the samples: fourth cumulants cancel. So E / S follows Fisher's F, with as many
//!   degrees of freedom as there are pixels that matter, and R − 1 times as many.
//! - r is not known. With x in its place, S is too small where large samples raise x and V together, by as much as the
//!   distribution is skewed. A neighbour's x is as good a guess of r, and is independent of V: the **gap** between sums
//!   with neighbours' and own weights measures that bias, without any assumption on the distribution. Neighbours that
//!   differ by more than noise are left out; what the others differ beyond noise is **structure**, which may account
//!   for a part of the gap, so that one end of the interval is corrected by the whole and the other by the rest.
//! - 1 / (x² + a) is on average not 1 / (r² + a): the **curvature** is corrected to first order.
//! - Where a pixel's standard error is above half its value, a single bright round may dominate it, and more such
//!   light may not have been met at all: the pixel is **uncertified**. Once such pixels carry more than a tenth of the
//!   error, or the gap exceeds what it corrects, there is no upper end.

use smalti_core::film::Estimate;

use crate::interval::ratio_95;
use crate::neighbours::Grid;

/// A pixel is certified up to this standard error, by its value plus the root of the floor.
const CERTIFIED: f64 = 0.5;

/// The largest part of the error that uncertified pixels may carry.
const CARRIED: f64 = 0.1;

/// Neighbours that differ by more standard errors do not stand for each other.
const ALIKE: f64 = 3.0;

/// What is taken off for structure, by what is found: pixels that are alike by chance hide some of it.
const STRUCTURE: f64 = 1.5;

/// A squared relative error with its 95 % interval.
pub(crate) struct Relative {
    pub value: f64,
    pub low: f64,
    pub high: Option<f64>,
    pub uncertified: usize,
}

/// Sums over pixels and channels; see the module's description for the terms.
#[derive(Default)]
struct Sums {
    own: f64,
    curvature: f64,
    alike: f64,
    gap: f64,
    gap_squares: f64,
    structure: f64,
    carried: f64,
    carried_by_uncertified: f64,
    uncertified: usize,
}

/// The mean of (x − r)² / (r² + `floor`), r the truth. `None` if it is not finite.
pub(crate) fn relative(grid: &Grid, correlation: &[[f64; 3]; 3], floor: f64) -> Option<Relative> {
    let mut sums = Sums::default();
    for (pixel, partner) in grid.pairs() {
        sums.add(pixel, partner, floor);
    }
    if sums.own == 0.0 {
        return Some(Relative { value: 0.0, low: 0.0, high: Some(0.0), uncertified: 0 });
    }
    let count = (3 * grid.estimates.len()) as f64;
    let curvature = (sums.curvature / sums.own).clamp(-0.5, 1.0);
    let straight = sums.own / count / (1.0 + curvature);
    let certified = sums.carried_by_uncertified <= CARRIED * sums.carried && sums.gap <= sums.alike;
    let [least, most] = sums.gaps(certified);
    // A correction of first order leaves out what is of the order of its square.
    let left_out = curvature * curvature;
    let spread = if certified { sums.gap_spread(most) + left_out * left_out } else { 0.0 };
    let (low, high) = interval(grid, correlation, floor, spread);
    let value = straight * (1.0 + (least + most) / 2.0);
    let high = high.filter(|_| certified).map(|high| straight * (1.0 + most) * high);
    let found = Relative { value, low: straight * (1.0 + least) * low, high, uncertified: sums.uncertified };
    value.is_finite().then_some(found)
}

impl Sums {
    fn add(&mut self, pixel: &Estimate, partner: Option<&Estimate>, floor: f64) {
        let weights = weights(pixel, floor);
        let own = terms(pixel, &weights);
        let (total, rounds): (f64, _) = (own.iter().sum(), f64::from(pixel.rounds));
        self.own += total;
        for (c, term) in own.iter().enumerate() {
            let part = pixel.mean()[c] * pixel.mean()[c] * weights[c];
            // The mean of V² is not v² but (R + 1) / (R − 1) times that.
            self.curvature += term * term * (4.0 * part - 1.0) * (rounds - 1.0) / (rounds + 1.0);
        }
        let alike = partner.filter(|partner| alike(pixel, partner));
        let carried = alike.map_or(total, |partner| self.add_pair([pixel, partner], weights, total, floor));
        let certified = is_certified(pixel, floor);
        self.carried += carried;
        self.carried_by_uncertified += if certified { 0.0 } else { carried };
        self.uncertified += usize::from(!certified);
    }

    /// Compares a pixel with one that is alike. Returns the pixel's squared error relative to that one's value.
    fn add_pair(&mut self, pair: [&Estimate; 2], own: [f64; 3], total: f64, floor: f64) -> f64 {
        let other = weights(pair[1], floor);
        let gap = gap(pair, [&own, &other]);
        self.alike += total;
        self.gap += gap;
        self.gap_squares += gap * gap;
        self.structure += structure(pair, [&own, &other]);
        terms(pair[0], &other).iter().sum()
    }

    /// The least and the most that the gap may add to the error, as a fraction of it.
    fn gaps(&self, certified: bool) -> [f64; 2] {
        if self.alike == 0.0 {
            return [0.0; 2];
        }
        let gap = (self.gap / self.alike).clamp(-0.5, 1.0);
        let structure = if certified { STRUCTURE * self.structure / self.alike } else { f64::INFINITY };
        [gap.min((gap - structure.max(0.0)).max(0.0)), gap]
    }

    /// The relative variance that the gap's own uncertainty adds. Both pixels of a pair have the same gap.
    fn gap_spread(&self, gap: f64) -> f64 {
        if self.alike == 0.0 {
            return 0.0;
        }
        let relative = 1.0 / (self.alike * (1.0 + gap));
        2.0 * self.gap_squares * relative * relative
    }
}

/// The interval of the ratio of the true error to the estimated one, `extra` the relative variance that comes on top of
/// that of the squares.
fn interval(grid: &Grid, correlation: &[[f64; 3]; 3], floor: f64, extra: f64) -> (f64, Option<f64>) {
    let (mut count, mut total, mut roots, mut above, mut below) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for rows in grid.estimates.chunks(grid.width * grid.shared) {
        for square in squares(grid, rows, floor) {
            let [plain, centred] = square.products(correlation);
            count += 1.0;
            total += square.terms.iter().sum::<f64>();
            roots += plain.sqrt();
            above += centred;
            below += centred / square.freedom;
        }
    }
    // Squares of few estimates cannot be centred; they are no less than the square of the mean.
    let scale = (roots * roots / count / above).max(1.0);
    (above, below) = (above * scale, below * scale);
    let variance = 2.0 * (above + below) / (total * total);
    let certain = variance / (variance + extra);
    ratio_95(certain * total * total / above, certain * total * total / below)
}

/// Pixels whose errors may go together, taken as if they did entirely.
#[derive(Clone)]
struct Square {
    terms: [f64; 3],
    freedom: f64,
}

impl Square {
    /// The squared sum of the terms, as far as the channels go together; and without what the terms' own uncertainty
    /// adds to it.
    fn products(&self, correlation: &[[f64; 3]; 3]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (i, row) in correlation.iter().enumerate() {
            for (j, squared) in row.iter().enumerate() {
                let product = squared * self.terms[i] * self.terms[j];
                sums[0] += product;
                sums[1] += product / (1.0 + 2.0 * squared / self.freedom);
            }
        }
        sums
    }
}

/// The squares of one row of them.
fn squares(grid: &Grid, rows: &[Estimate], floor: f64) -> Vec<Square> {
    let mut squares = vec![Square { terms: [0.0; 3], freedom: f64::INFINITY }; grid.width.div_ceil(grid.shared)];
    for row in rows.chunks(grid.width) {
        for (column, pixel) in row.iter().enumerate() {
            let square = &mut squares[column / grid.shared];
            let terms = terms(pixel, &weights(pixel, floor));
            (0..3).for_each(|c| square.terms[c] += terms[c]);
            square.freedom = square.freedom.min(f64::from(pixel.rounds) - 1.0);
        }
    }
    squares
}

/// The estimated squared errors of a pixel's channels, with the weights of its own or another value.
fn terms(pixel: &Estimate, weights: &[f64; 3]) -> [f64; 3] {
    // A black image has infinite weights where the floor is 0, and no error.
    std::array::from_fn(|c| if pixel.variance()[c] == 0.0 { 0.0 } else { pixel.variance()[c] * weights[c] })
}

fn weights(pixel: &Estimate, floor: f64) -> [f64; 3] {
    pixel.mean().map(|mean| 1.0 / (mean * mean + floor))
}

/// Whether no channel differs by more than noise can explain.
fn alike(pixel: &Estimate, partner: &Estimate) -> bool {
    let noise = |c: usize| pixel.variance()[c] + partner.variance()[c];
    (0..3).all(|c| distance([pixel, partner], c) <= ALIKE * ALIKE * noise(c))
}

fn distance([pixel, partner]: [&Estimate; 2], channel: usize) -> f64 {
    let difference = pixel.mean()[channel] - partner.mean()[channel];
    difference * difference
}

/// Half of what the squared errors of a pair grow by when each is taken relative to the other's value.
fn gap([pixel, partner]: [&Estimate; 2], [own, other]: [&[f64; 3]; 2]) -> f64 {
    let of_channel = |c: usize| match pixel.variance()[c] - partner.variance()[c] {
        0.0 => 0.0,
        change => 0.5 * change * (other[c] - own[c]),
    };
    (0..3).map(of_channel).sum()
}

/// What the gap of a pair would be if the values differed by what noise does not explain, and the variances with the
/// square of the value.
fn structure(pair: [&Estimate; 2], [own, other]: [&[f64; 3]; 2]) -> f64 {
    let rounds = f64::from(pair[0].rounds);
    let of_channel = |c: usize| match pair.map(|pixel| pixel.variance()[c]) {
        [0.0, _] => 0.0,
        // The last term of the excess: V and V² go together.
        [v, w] => 2.0 * v * own[c] * other[c] * (distance(pair, c) - v - w + 2.0 * v / (rounds + 1.0)),
    };
    (0..3).map(of_channel).sum()
}

fn is_certified(pixel: &Estimate, floor: f64) -> bool {
    let base = floor.sqrt();
    let bound = |mean: &f64| (mean.abs() + base) * (mean.abs() + base);
    pixel.variance().iter().sum::<f64>() <= CERTIFIED * CERTIFIED * pixel.mean().iter().map(bound).sum::<f64>()
}
