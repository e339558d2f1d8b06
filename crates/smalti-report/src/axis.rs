//! A logarithmic axis: its range, its ticks, and where a value stands.

/// A logarithmic axis from `low` to `high`, both greater than 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    pub low: f64,
    pub high: f64,
}

/// A mark on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tick {
    pub value: f64,
    /// Whether its value is written beside it.
    pub labelled: bool,
}

/// What is left free beyond the outermost values, in powers of ten.
const MARGIN: f64 = 0.06;

/// The least length of an axis, in powers of ten: what differs less stays close together.
const SHORTEST: f64 = 0.5;

/// From so many powers of ten on only whole ones are labelled.
const WIDE: f64 = 2.6;

impl Axis {
    /// The axis that holds every positive value; from 0.1 to 1 without any.
    pub fn around(values: impl Iterator<Item = f64>) -> Self {
        let logs = values.filter(|&value| value > 0.0 && value.is_finite()).map(libm::log10);
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        if low > high {
            return Self { low: 0.1, high: 1.0 };
        }
        let missing = (SHORTEST - (high - low)).max(0.0) / 2.0;
        let [low, high] = [low - missing - MARGIN, high + missing + MARGIN].map(libm::exp10);
        Self { low, high }
    }

    /// Where `value` stands: 0 at the low end, 1 at the high end; what lies beyond stands at the end.
    pub fn place(&self, value: f64) -> f64 {
        if value <= self.low {
            return 0.0;
        }
        (libm::log10(value / self.low) / self.decades()).min(1.0)
    }

    /// 1, 2 ... 9 of each power of ten in the range; labelled are 1, 2 and 5, or only 1 on a long axis.
    pub fn ticks(&self) -> Vec<Tick> {
        let powers = libm::log10(self.low).floor() as i32..=libm::log10(self.high).floor() as i32;
        let narrow = self.decades() < WIDE;
        let tick = |power, digit: u8| {
            // Read as decimal, 3e-2 is exactly what a reader would type.
            let value = format!("{digit}e{power}").parse().unwrap_or_default();
            Tick { value, labelled: digit == 1 || (narrow && (digit == 2 || digit == 5)) }
        };
        let all = powers.flat_map(|power| (1..=9).map(move |digit| tick(power, digit)));
        all.filter(|tick| (self.low..=self.high).contains(&tick.value)).collect()
    }

    fn decades(&self) -> f64 {
        libm::log10(self.high / self.low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_are_equally_long() {
        let axis = Axis { low: 0.01, high: 100.0 };
        let places = [0.001, 0.01, 0.1, 1.0, 100.0, 1e9].map(|value| (4.0 * axis.place(value)).round() / 4.0);
        assert_eq!(places, [0.0, 0.0, 0.25, 0.5, 1.0, 1.0]);
        assert_eq!((axis.place(0.0), axis.place(-1.0)), (0.0, 0.0));
    }

    #[test]
    fn the_range_holds_all_that_has_a_logarithm() {
        let axis = Axis::around([0.02, -1.0, 5.0, 0.0].into_iter());
        assert!(axis.low < 0.02 && axis.low > 0.015 && axis.high > 5.0 && axis.high < 6.0, "{axis:?}");
        assert_eq!(Axis::around([0.0].into_iter()), Axis { low: 0.1, high: 1.0 });
    }

    #[test]
    fn a_single_value_stands_in_the_middle() {
        let axis = Axis::around([3.0].into_iter());
        assert!((axis.place(3.0) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn ticks_are_round_and_labels_sparse() {
        let labelled = |low, high| -> Vec<f64> {
            Axis { low, high }.ticks().into_iter().filter(|tick| tick.labelled).map(|tick| tick.value).collect()
        };
        assert_eq!(labelled(0.015, 3.0), [0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0]);
        assert_eq!(labelled(1e-4, 2.0), [1e-4, 1e-3, 1e-2, 1e-1, 1.0]);
        assert_eq!(Axis { low: 0.09, high: 0.41 }.ticks().len(), 5);
    }
}
