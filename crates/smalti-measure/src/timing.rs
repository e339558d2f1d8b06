//! What a series of measurements says: quantiles, speed-up, efficiency.

/// The median, or `None` of nothing. The values are finite, in any order.
pub fn median(values: &[f64]) -> Option<f64> {
    quantile(values, 0.5)
}

/// The value below which the fraction `p` in [0, 1] of `values` lies, interpolated linearly between the two nearest
/// ranks (0 is the least, 1 the greatest value); `None` of nothing. The values are finite, in any order.
pub fn quantile(values: &[f64], p: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let rank = p.clamp(0.0, 1.0) * sorted.len().saturating_sub(1) as f64;
    let below = *sorted.get(rank as usize)?;
    let above = *sorted.get(rank.ceil() as usize)?;
    Some(below + (above - below) * rank.fract())
}

/// How many times faster `seconds` is than `seconds_alone` (one thread, or the other program); `None` for no time.
pub fn speed_up(seconds_alone: f64, seconds: f64) -> Option<f64> {
    (seconds > 0.0).then(|| seconds_alone / seconds)
}

/// The part of `threads` threads' time that was of use: the speed-up over one thread by the number of threads.
pub fn parallel_efficiency(seconds_alone: f64, seconds: f64, threads: u32) -> Option<f64> {
    Some(speed_up(seconds_alone, seconds)? / f64::from(threads.max(1)))
}

/// Monte Carlo efficiency, 1 / (relmse × seconds): the same at any number of samples, larger is better. `None` for an
/// image without error or no time.
pub fn efficiency(relmse: f64, seconds: f64) -> Option<f64> {
    let cost = relmse * seconds;
    (cost > 0.0).then(|| 1.0 / cost)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate_between_ranks() {
        let values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(median(&values), Some(2.5));
        assert_eq!(median(&[7.0]), Some(7.0));
        assert_eq!([0.0, 0.25, 1.0, 2.0].map(|p| quantile(&values, p).unwrap()), [1.0, 1.75, 4.0, 4.0]);
        assert_eq!(median(&[]), None);
    }

    #[test]
    fn ratios_exist_where_time_passed() {
        assert_eq!(speed_up(6.0, 2.0), Some(3.0));
        assert_eq!(parallel_efficiency(6.0, 2.0, 4), Some(0.75));
        assert_eq!(efficiency(0.01, 4.0), Some(25.0));
        assert_eq!((speed_up(6.0, 0.0), efficiency(0.0, 4.0)), (None, None));
    }
}
