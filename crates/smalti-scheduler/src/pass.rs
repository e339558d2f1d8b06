//! How samples are cut into passes. For display only: the image does not depend on it.

/// Samples that a pass adds at most: a multiple of the film's round, so that rounds are complete between passes.
const LONGEST: u32 = 32;

/// The samples a pixel has after the pass that follows on `done`; `None` when all `spp` are there. Passes double what
/// is there until they are [`LONGEST`].
pub(crate) fn next(done: u32, spp: u32) -> Option<u32> {
    (done < spp).then(|| done.saturating_add(done.clamp(1, LONGEST)).min(spp))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(from: u32, spp: u32) -> Vec<u32> {
        std::iter::successors(next(from, spp), |&done| next(done, spp)).collect()
    }

    #[test]
    fn passes_grow_then_stay() {
        assert_eq!(ends(0, 100), [1, 2, 4, 8, 16, 32, 64, 96, 100]);
        assert_eq!(ends(5, 12), [10, 12]);
        assert_eq!(ends(7, 7), []);
        assert_eq!(next(u32::MAX - 1, u32::MAX), Some(u32::MAX));
    }

    #[test]
    fn passes_end_between_rounds() {
        assert!(ends(0, 4096).iter().all(|end| *end <= 16 || end % smalti_core::film::ROUND == 0));
    }
}
