//! The interval of a ratio of two sums of squares.

/// The two-sided 95 % quantile of the normal distribution.
pub const Z: f64 = 1.959_963_984_540_054;

/// The central 95 % of Fisher's F distribution with `above` and `below` degrees of freedom, in the cube root
/// approximation of Wilson, Hilferty and Paulson; 0 to `None` where that does not hold (few degrees `below`).
pub(crate) fn ratio_95(above: f64, below: f64) -> (f64, Option<f64>) {
    let (a, b) = (2.0 / (9.0 * above), 2.0 / (9.0 * below));
    let (ca, cb) = (1.0 - a, 1.0 - b);
    let spread = Z * (ca * ca * b + cb * cb * a - Z * Z * a * b).max(0.0).sqrt();
    let scale = cb * cb - Z * Z * b;
    let cube = |root: f64| root * root * root;
    if ca <= 0.0 || cb <= 0.0 || scale <= 0.0 {
        return (0.0, None);
    }
    (cube(((ca * cb - spread) / scale).max(0.0)), Some(cube((ca * cb + spread) / scale)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_tables_of_f() {
        // 2.5 % and 97.5 % points.
        for (above, below, low, high) in [
            (10.0, 10.0, 0.269_06, 3.716_79),
            (10.0, 20.0, 0.292_49, 2.773_67),
            (60.0, 120.0, 0.632_5, 1.529_9),
            (120.0, 30.0, 0.591_7, 1.866_4),
        ] {
            let (found_low, found_high) = ratio_95(above, below);
            assert!((found_low / low - 1.0).abs() < 0.02, "{above} {below}: {found_low}");
            assert!((found_high.unwrap() / high - 1.0).abs() < 0.02, "{above} {below}: {found_high:?}");
        }
    }

    #[test]
    fn is_normal_for_many_degrees() {
        let (low, high) = ratio_95(1e6, 1e6);
        assert!((low - (1.0 - Z * 2e-3)).abs() < 1e-5 && (high.unwrap() - (1.0 + Z * 2e-3)).abs() < 1e-5);
    }

    #[test]
    fn one_degree_below_has_no_upper_end() {
        assert_eq!(ratio_95(1.0, 1.0), (0.0, None));
    }
}
