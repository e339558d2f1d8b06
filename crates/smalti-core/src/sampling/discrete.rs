//! Choosing one of a table's rows by its share.

use crate::lanes::Lanes;

/// The row that `u` in [0, 1) falls on, by bisection. `cumulative` holds the upper ends of the rows' shares of [0, 1), at
/// least one.
#[inline(always)]
pub fn choose<L: Lanes>(l: L, cumulative: &[f32], u: L::F) -> L::U {
    let (mut low, mut step) = (l.u(0), cumulative.len().next_power_of_two() as u32 / 2);
    let last = l.u(cumulative.len() as u32 - 1);
    while step > 0 {
        // `low + step - 1` is the last row below the upper half; rows past the end count as never reached.
        let probe = l.add_u(low, l.u(step - 1));
        let inside = l.lt_u(probe, last);
        let bound = l.gather(cumulative, l.select_u(inside, probe, last));
        let up = inside & !l.lt(u, bound);
        low = l.select_u(up, l.add_u(low, l.u(step)), low);
        step /= 2;
    }
    low
}

/// Upper ends of the shares of [0, 1) that go with `weights` (not negative, not all 0), and the shares.
pub fn shares(weights: &[f64]) -> (Vec<f32>, Vec<f64>) {
    let total: f64 = weights.iter().sum();
    let shares: Vec<f64> = weights.iter().map(|weight| if total > 0.0 { weight / total } else { 0.0 }).collect();
    let mut so_far = 0.0;
    let ends = shares.iter().map(|share| {
        so_far += share;
        so_far as f32
    });
    let mut cumulative: Vec<f32> = ends.collect();
    // The last row that has a share reaches up to 1, whatever rounding did.
    if let Some(last) = shares.iter().rposition(|share| *share > 0.0) {
        cumulative[last..].fill(1.0);
    }
    (cumulative, shares)
}
