//! The Pareto front: what is worth choosing at all.

/// For each of `points` (cost and loss, both better if smaller) whether it is on the front: no other is at least as good
/// in both and better in one. Of equal points all are. A point that is not finite never is.
pub(crate) fn front(points: &[[f64; 2]]) -> Vec<bool> {
    let beaten = |[x, y]: [f64; 2]| points.iter().any(|&[u, v]| u <= x && v <= y && (u < x || v < y));
    points.iter().map(|&point| point.iter().all(|value| value.is_finite()) && !beaten(point)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_beats_in_both_is_not_on_it() {
        let points = [[1.0, 9.0], [2.0, 9.0], [2.0, 3.0], [3.0, 4.0], [4.0, 3.0], [9.0, 1.0]];
        assert_eq!(front(&points), [true, false, true, false, false, true]);
    }

    #[test]
    fn equals_are_on_it_together() {
        assert_eq!(front(&[[1.0, 1.0], [1.0, 1.0]]), [true, true]);
    }

    #[test]
    fn what_was_not_measured_is_not_on_it() {
        assert_eq!(front(&[[f64::NAN, 0.0], [1.0, f64::INFINITY], [2.0, 2.0]]), [false, false, true]);
        assert!(front(&[]).is_empty());
    }
}
