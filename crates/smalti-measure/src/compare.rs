//! Metrics of an image against a reference.

use std::cmp::Reverse;

use smalti_core::film::Image;

/// The worst pixels that [`Comparison::relmse_trimmed`] leaves out: one in so many.
const TRIMMED: usize = 1000;

/// What floors the squared reference in relmse, so that black pixels do not count infinitely.
pub(crate) const FLOOR: f64 = 0.01;

/// How an image differs from a reference. Pixels that are not finite in one of them are left out everywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Pixels that were compared.
    pub pixels: usize,
    /// Pixels that were left out because a channel is not finite in the image or the reference.
    pub not_finite: usize,
    /// Root of the mean square difference over pixels and channels, in the images' units.
    pub rmse: f64,
    /// Mean over pixels and channels of (x − r)² / (r² + 0.01).
    pub relmse: f64,
    /// The same without the worst 0.1 % of the pixels (rounded down), by their mean over the channels.
    pub relmse_trimmed: f64,
    /// Root of the mean over pixels and channels of (x − r)² / (r² + 0.01 m²), m the reference's mean over pixels and
    /// channels: does not change with exposure. `None` if the reference is black where the image is not.
    pub relative_error: Option<f64>,
    /// Mean of the image by mean of the reference, for each channel; `None` where that of the reference is 0.
    pub mean_ratio: [Option<f64>; 3],
    /// The pixels with the largest relmse, the worst first.
    pub worst: Vec<PixelDifference>,
}

/// One pixel of an image and its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelDifference {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Mean over the channels of (x − r)² / (r² + 0.01).
    pub relmse: f64,
    /// The image's value.
    pub value: [f32; 3],
    /// The reference's value.
    pub reference: [f32; 3],
}

/// Images that cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CompareError {
    /// The sizes differ.
    #[error("the image has {}×{} pixels, the reference {}×{}", .image.0, .image.1, .reference.0, .reference.1)]
    Sizes {
        /// Width and height of the image.
        image: (u32, u32),
        /// Width and height of the reference.
        reference: (u32, u32),
    },
    /// There is no pixel that is finite in both.
    #[error("there is no pixel that is finite in the image and in the reference")]
    NothingFinite,
}

/// Compares `image` with `reference` and lists the `worst` pixels.
///
/// # Errors
/// Images of different size, or without a pixel that is finite in both.
pub fn compare(image: &Image, reference: &Image, worst: usize) -> Result<Comparison, CompareError> {
    let sizes = [image, reference].map(|image| (image.width, image.height));
    if sizes[0] != sizes[1] {
        return Err(CompareError::Sizes { image: sizes[0], reference: sizes[1] });
    }
    let pixels = finite_pixels(image, reference);
    if pixels.is_empty() {
        return Err(CompareError::NothingFinite);
    }
    let values = (pixels.len() * 3) as f64;
    let mean = |of: fn(&PixelDifference) -> [f32; 3]| [0, 1, 2].map(|c| average(&pixels, |p| f64::from(of(p)[c])));
    let (of_image, of_reference) = (mean(|p| p.value), mean(|p| p.reference));
    let square = |floor| pixels.iter().map(|p| pixel_error(p.value, p.reference, floor)).sum::<f64>();
    let brightness = of_reference.iter().sum::<f64>() / 3.0;
    let relative = square(FLOOR * brightness * brightness) / values;
    let differences = pixels.iter().flat_map(|p| (0..3).map(|c| f64::from(p.value[c]) - f64::from(p.reference[c])));
    Ok(Comparison {
        pixels: pixels.len(),
        not_finite: image.pixels.len() - pixels.len(),
        rmse: (differences.map(|d| d * d).sum::<f64>() / values).sqrt(),
        relmse: average(&pixels, |p| p.relmse),
        relmse_trimmed: trimmed(&pixels),
        relative_error: relative.is_finite().then(|| relative.sqrt()),
        mean_ratio: std::array::from_fn(|c| (of_reference[c] != 0.0).then(|| of_image[c] / of_reference[c])),
        worst: worst_of(pixels, worst),
    })
}

/// The pixels that are finite in both images, in image order.
fn finite_pixels(image: &Image, reference: &Image) -> Vec<PixelDifference> {
    let pairs = image.pixels.iter().zip(&reference.pixels).enumerate();
    let finite = pairs.filter(|(_, (value, reference))| value.iter().chain(*reference).all(|v| v.is_finite()));
    let width = image.width as usize;
    let difference = |(index, (&value, &reference)): (usize, (&[f32; 3], &[f32; 3]))| PixelDifference {
        x: (index % width) as u32,
        y: (index / width) as u32,
        relmse: pixel_error(value, reference, FLOOR) / 3.0,
        value,
        reference,
    };
    finite.map(difference).collect()
}

/// Sum over the channels of (x − r)² / (r² + floor); 0 where the image agrees with the reference.
fn pixel_error(value: [f32; 3], reference: [f32; 3], floor: f64) -> f64 {
    let of_channel = |c: usize| {
        let (x, r) = (f64::from(value[c]), f64::from(reference[c]));
        if x == r { 0.0 } else { (x - r) * (x - r) / (r * r + floor) }
    };
    (0..3).map(of_channel).sum()
}

fn average(pixels: &[PixelDifference], of: impl Fn(&PixelDifference) -> f64) -> f64 {
    pixels.iter().map(of).sum::<f64>() / pixels.len() as f64
}

fn trimmed(pixels: &[PixelDifference]) -> f64 {
    let mut errors: Vec<f64> = pixels.iter().map(|pixel| pixel.relmse).collect();
    errors.sort_unstable_by(f64::total_cmp);
    let kept = errors.len() - errors.len() / TRIMMED;
    errors[..kept].iter().sum::<f64>() / kept as f64
}

/// The `count` worst, of equal ones the first in image order.
fn worst_of(mut pixels: Vec<PixelDifference>, count: usize) -> Vec<PixelDifference> {
    // Errors are not negative: their bits are in their order.
    let order = |pixel: &PixelDifference| (Reverse(pixel.relmse.to_bits()), pixel.y, pixel.x);
    if count < pixels.len() {
        pixels.select_nth_unstable_by_key(count, order);
        pixels.truncate(count);
    }
    pixels.sort_unstable_by_key(order);
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: u32, values: &[f32]) -> Image {
        Image { width, height: values.len() as u32 / width, pixels: values.iter().map(|&v| [v; 3]).collect() }
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * b.abs()
    }

    #[test]
    fn metrics_have_their_closed_forms() {
        let image = Image { width: 1, height: 2, pixels: vec![[1.5, 2.0, 0.0], [1.0, 2.0, 0.5]] };
        let reference = Image { width: 1, height: 2, pixels: vec![[1.0, 2.0, 0.0], [1.0, 2.0, 0.0]] };
        let found = compare(&image, &reference, 1).unwrap();
        assert!(close(found.rmse, (0.5f64 / 6.0).sqrt()));
        assert!(close(found.relmse, (0.25 / 1.01 + 0.25 / 0.01) / 6.0));
        // The reference's mean is 1, so that the floor is the same.
        assert!(close(found.relative_error.unwrap(), found.relmse.sqrt()));
        assert_eq!(found.mean_ratio, [Some(1.25), Some(1.0), None]);
        let worst = found.worst[0];
        assert_eq!((worst.x, worst.y, worst.value, worst.reference), (0, 1, [1.0, 2.0, 0.5], [1.0, 2.0, 0.0]));
    }

    #[test]
    fn relative_error_does_not_change_with_exposure() {
        let values = [0.1, 0.7, 2.0, 0.0];
        let reference = [0.2, 0.6, 2.5, 0.1];
        let brighter = |values: [f32; 4]| grey(2, &values.map(|v| v * 1024.0));
        let plain = compare(&grey(2, &values), &grey(2, &reference), 0).unwrap();
        let bright = compare(&brighter(values), &brighter(reference), 0).unwrap();
        assert!(close(plain.relative_error.unwrap(), bright.relative_error.unwrap()));
        assert!(bright.relmse > 1.01 * plain.relmse);
    }

    #[test]
    fn the_worst_in_a_thousand_are_trimmed() {
        let reference = vec![1.0; 2500];
        let mut values = vec![1.1; 2500];
        (values[7], values[99]) = (1e6, 1e5);
        let found = compare(&grey(50, &values), &grey(50, &reference), 3).unwrap();
        let one = (f64::from(1.1f32) - 1.0) * (f64::from(1.1f32) - 1.0) / 1.01;
        assert!((found.relmse_trimmed - one).abs() < 1e-12);
        assert!(found.relmse > 1e5);
        let places: Vec<_> = found.worst.iter().map(|pixel| (pixel.x, pixel.y)).collect();
        assert_eq!(places, [(7, 0), (49, 1), (0, 0)]);
    }

    #[test]
    fn what_is_not_finite_is_counted_and_left_out() {
        let image = grey(1, &[1.0, f32::NAN, 3.0, f32::INFINITY]);
        let reference = grey(1, &[1.0, 2.0, f32::NEG_INFINITY, 4.0]);
        let found = compare(&image, &reference, 9).unwrap();
        assert_eq!((found.pixels, found.not_finite, found.relmse, found.worst.len()), (1, 3, 0.0, 1));
        assert_eq!(compare(&image, &grey(1, &[f32::NAN; 4]), 0), Err(CompareError::NothingFinite));
    }

    #[test]
    fn a_black_reference_has_no_relative_error() {
        let black = grey(1, &[0.0, 0.0]);
        assert_eq!(compare(&black, &black, 0).unwrap().relative_error, Some(0.0));
        let found = compare(&grey(1, &[0.0, 1.0]), &black, 0).unwrap();
        assert_eq!((found.relative_error, found.mean_ratio), (None, [None; 3]));
    }

    #[test]
    fn sizes_that_differ_are_named() {
        let error = compare(&Image::black(2, 3), &Image::black(3, 2), 0).unwrap_err();
        assert_eq!(error.to_string(), "the image has 2×3 pixels, the reference 3×2");
        assert_eq!(compare(&Image::default(), &Image::default(), 0), Err(CompareError::NothingFinite));
    }

    #[test]
    fn the_largest_values_do_not_overflow() {
        let found = compare(&grey(1, &[f32::MAX]), &grey(1, &[f32::MIN]), 1).unwrap();
        assert!(found.rmse.is_finite() && close(found.relmse, 4.0));
    }
}
