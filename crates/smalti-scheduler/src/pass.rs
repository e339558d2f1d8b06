//! How samples are cut into passes. For display only: the image does not depend on it.

use smalti_core::film::ROUND;

/// Samples that a pass adds at most: a multiple of the film's round, so that rounds are complete between passes.
const LONGEST: u32 = 32;

/// The samples a pixel has after the pass that follows on `done`; `None` when all `spp` are there. Passes double what
/// is there until they are [`LONGEST`].
///
/// With `by_rounds` a pass ends where a round does: each has photons of its own.
pub(crate) fn next(done: u32, spp: u32, by_rounds: bool) -> Option<u32> {
    let end = if by_rounds { (done / ROUND).saturating_add(1).saturating_mul(ROUND) } else { u32::MAX };
    (done < spp).then(|| done.saturating_add(done.clamp(1, LONGEST)).min(spp).min(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(from: u32, spp: u32) -> Vec<u32> {
        std::iter::successors(next(from, spp, false), |&done| next(done, spp, false)).collect()
    }

    #[test]
    fn passes_grow_then_stay() {
        assert_eq!(ends(0, 100), [1, 2, 4, 8, 16, 32, 64, 96, 100]);
        assert_eq!(ends(5, 12), [10, 12]);
        assert_eq!(ends(7, 7), []);
        assert_eq!(next(u32::MAX - 1, u32::MAX, false), Some(u32::MAX));
    }

    #[test]
    fn with_photons_no_pass_has_samples_of_two_rounds() {
        let ends: Vec<u32> = std::iter::successors(next(0, 100, true), |&done| next(done, 100, true)).collect();
        assert_eq!(ends, [1, 2, 4, 8, 16, 32, 48, 64, 80, 96, 100]);
        assert_eq!(next(20, 100, true), Some(32));
        assert_eq!(next(u32::MAX - 1, u32::MAX, true), Some(u32::MAX));
    }

    #[test]
    fn passes_end_between_rounds() {
        assert!(ends(0, 4096).iter().all(|end| *end <= 16 || end % ROUND == 0));
    }
}
