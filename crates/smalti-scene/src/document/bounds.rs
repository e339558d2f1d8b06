//! Which numbers a quantity may have. What the core rounds to f32 must survive that.

/// Nothing lies farther out: products of three lengths stay finite in f64.
pub const FARTHEST: f64 = 1e100;

/// A set of finite numbers and its name.
#[derive(Clone, Copy)]
pub struct Bounds {
    allows: fn(f64) -> bool,
    /// Completes 'must be'.
    pub says: &'static str,
}

impl Bounds {
    /// Coordinates, and angles of rotation.
    pub const COORDINATE: Self = Self { allows: |x| x.abs() <= FARTHEST, says: "from -1e100 to 1e100" };
    /// Lengths and ratios.
    pub const POSITIVE: Self = Self { allows: |x| x > 0.0 && x <= FARTHEST, says: "greater than 0 and at most 1e100" };
    /// An exposure.
    pub const STOPS: Self = Self { allows: |x| x.abs() <= 100.0, says: "from -100 to 100 stops" };
    /// An index of refraction.
    pub const IOR: Self = Self { allows: |x| x as f32 > 0.0 && (x as f32).is_finite(), says: "greater than 0" };
    /// A fraction of light.
    pub const FRACTION: Self = Self { allows: |x| (0.0..=1.0).contains(&x), says: "from 0 to 1" };
    /// An amount of light.
    pub const LIGHT: Self = Self { allows: |x| x >= 0.0 && (x as f32).is_finite(), says: "from 0 to 3.4e38" };
    /// A field of view.
    pub const OPENING: Self =
        Self { allows: |x| x > 0.0 && x < 180.0, says: "greater than 0 and less than 180 degrees" };

    /// Whether `x` is finite and in the set.
    pub fn allow(self, x: f64) -> bool {
        x.is_finite() && (self.allows)(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_as_documented() {
        let cases: [(Bounds, &[f64], &[f64]); 5] = [
            (Bounds::COORDINATE, &[-1e100, 0.0], &[f64::NAN, f64::INFINITY, 1e101]),
            (Bounds::POSITIVE, &[1e-300, 1e100], &[0.0, -1.0, 1e101]),
            (Bounds::FRACTION, &[0.0, 1.0], &[-1e-9, 1.0 + 1e-9, f64::NAN]),
            (Bounds::LIGHT, &[0.0, 1e30], &[-1e-30, 1e39]),
            (Bounds::OPENING, &[1e-3, 179.9], &[0.0, 180.0]),
        ];
        for (bounds, good, bad) in cases {
            assert!(good.iter().all(|&x| bounds.allow(x)), "{}", bounds.says);
            assert!(bad.iter().all(|&x| !bounds.allow(x)), "{}", bounds.says);
        }
    }

    #[test]
    fn an_index_that_f32_rounds_to_nothing_is_no_index() {
        assert!(Bounds::IOR.allow(0.5) && Bounds::IOR.allow(100.0));
        assert!(!Bounds::IOR.allow(1e-60) && !Bounds::IOR.allow(1e60));
    }
}
