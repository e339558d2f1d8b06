//! How samples are spread over pixels with glints: whatever is seen there, its mean stays.

use smalti_core::glint::{Mixture, Region};

/// Places by row and by column.
const SIDE: u32 = 1024;

/// The mean of a function over the pixel, from a grid of numbers.
fn mean(mixture: &Mixture, of: impl Fn([f32; 2]) -> f64) -> f64 {
    let middle = |k: u32| (k as f32 + 0.5) / SIDE as f32;
    let numbers = (0..SIDE * SIDE).map(|k| [middle(k % SIDE), middle(k / SIDE)]);
    let samples = numbers.map(|numbers| mixture.sample(numbers));
    samples.map(|(place, weight)| of(place) * f64::from(weight)).sum::<f64>() / f64::from(SIDE * SIDE)
}

#[test]
fn samples_spread_over_glints_keep_every_mean() {
    let region = Region::rectangle;
    let tilted = Region { corner: [0.2, 0.3], edges: [[0.5, 0.45], [0.03, 0.04]] };
    let out = Region { corner: [-0.1, 0.8], edges: [[0.3, 0.1], [0.1, 0.4]] };
    let small = region([0.7, 0.1], [0.702, 0.11]);
    let mixtures = [
        vec![small],
        vec![region([0.0, 0.0], [1.0, 1.0])],
        vec![region([0.1, 0.2], [0.3, 0.25]), region([0.2, 0.22], [0.5, 0.6]), small],
        vec![small, small],
        vec![tilted],
        vec![out],
        vec![tilted, small, out],
    ];
    for regions in mixtures {
        let mixture = Mixture::new(regions);
        let inside = |place: [f32; 2]| f64::from(small.holds(place));
        let [x, y] = [0, 1].map(|k: usize| move |place: [f32; 2]| f64::from(place[k]));
        for (what, found, expected) in [
            ("1", mean(&mixture, |_| 1.0), 1.0),
            ("x", mean(&mixture, x), 0.5),
            ("y²", mean(&mixture, |place| y(place) * y(place)), 1.0 / 3.0),
            ("xy", mean(&mixture, |place| x(place) * y(place)), 0.25),
        ] {
            assert!((found / expected - 1.0).abs() < 2e-3, "{what}: {found} instead of {expected}, {mixture:?}");
        }
        if mixture.regions().contains(&small) {
            let (found, expected) = (mean(&mixture, inside), f64::from(small.area()));
            assert!((found / expected - 1.0).abs() < 5e-3, "inside: {found} instead of {expected}, {mixture:?}");
        }
    }
}
