//! What pixels that lie close together, but whose noise is independent, say of each other.

use smalti_core::film::Estimate;

/// Pixels in rows; squares of `shared` × `shared` pixels may share samples, others do not.
pub(crate) struct Grid<'a> {
    pub estimates: &'a [Estimate],
    pub width: usize,
    pub shared: usize,
}

impl Grid<'_> {
    /// Each pixel, with the nearest one in its row that shares nothing with it, if there is one.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (&Estimate, Option<&Estimate>)> {
        let partners = |row| (0..self.width).map(move |column| (row, column));
        let rows = self.estimates.chunks(self.width).flat_map(partners);
        rows.map(|(row, column): (&[Estimate], usize)| (&row[column], self.partner(column).map(|other| &row[other])))
    }

    /// Columns of squares 0 and 1 belong together, 2 and 3, and so on; a last one without a partner looks back.
    fn partner(&self, column: usize) -> Option<usize> {
        let right = column + self.shared;
        let is_left = (column / self.shared).is_multiple_of(2);
        if is_left && right < self.width { Some(right) } else { column.checked_sub(self.shared) }
    }

    /// Squared correlation of the noise of each two channels, in [0, 1].
    ///
    /// Estimated variances fluctuate, and those of two channels do so with the squared correlation of the noise itself.
    /// What changes from pixel to pixel for other reasons looks like correlation, which widens intervals: the safe side.
    pub(crate) fn channel_correlation(&self) -> [[f64; 3]; 3] {
        let mut products = [[0.0; 3]; 3];
        for (pixel, partner) in self.pairs() {
            let Some(partner) = partner else { continue };
            let change: [f64; 3] = std::array::from_fn(|c| contrast(pixel.variance()[c], partner.variance()[c]));
            for (i, row) in products.iter_mut().enumerate() {
                (0..3).for_each(|j| row[j] += change[i] * change[j]);
            }
        }
        let correlation = |i: usize, j: usize| products[i][j] / (products[i][i] * products[j][j]).sqrt();
        // Without any fluctuation nothing is known.
        let known = |value: f64| if value.is_nan() { 1.0 } else { value.clamp(0.0, 1.0) };
        std::array::from_fn(|i| std::array::from_fn(|j| known(correlation(i, j))))
    }
}

fn contrast(a: f64, b: f64) -> f64 {
    if a + b > 0.0 { (a - b) / (a + b) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(variance: [f64; 3]) -> Estimate {
        Estimate::new([1.0; 3], variance, 4)
    }

    #[test]
    fn partners_share_nothing_and_lie_in_the_row() {
        for (width, shared) in [(1, 1), (2, 1), (7, 1), (16, 4), (19, 4), (5, 8)] {
            let grid = Grid { estimates: &[], width, shared };
            for column in 0..width {
                let partner = grid.partner(column);
                assert!(partner.is_none_or(|other| other < width && other.abs_diff(column) == shared));
                assert!(partner.is_some() || width < 2 * shared, "{column} of {width}, {shared}");
            }
        }
    }

    #[test]
    fn channels_that_fluctuate_together_are_correlated() {
        let fluctuation = |i: usize, c: usize| 1.0 + ((i * (c + 3) * 2_654_435_761) % 97) as f64 / 100.0;
        let together = |i| estimate([0.1, 0.5, 20.0].map(|scale| scale * fluctuation(i, 0)));
        let apart = |i| estimate([0, 1, 2].map(|c| fluctuation(i, c)));
        let correlation = |of: &dyn Fn(usize) -> Estimate| {
            let estimates: Vec<_> = (0..1000).map(of).collect();
            Grid { estimates: &estimates, width: 50, shared: 1 }.channel_correlation()
        };
        assert!(correlation(&together).as_flattened().iter().all(|&value| value > 0.999));
        let apart = correlation(&apart);
        assert!(apart[0][1] < 0.2 && apart[0][2] < 0.2 && apart[1][2] < 0.2 && apart[2][2] > 0.999, "{apart:?}");
    }

    #[test]
    fn nothing_known_is_full_correlation() {
        let estimates = [estimate([0.0; 3]); 4];
        assert_eq!(Grid { estimates: &estimates, width: 2, shared: 1 }.channel_correlation(), [[1.0; 3]; 3]);
    }
}
