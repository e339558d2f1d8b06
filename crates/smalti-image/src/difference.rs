//! The difference of two images as a picture in false colour.

use smalti_core::film::Image;

use crate::tone::srgb_to_linear;

/// Which difference a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Difference {
    /// Image minus reference: black where they agree, red to yellow where the image is brighter, blue to cyan where it
    /// is darker.
    Signed,
    /// Its size: from black where they agree over violet, red and yellow to white.
    Absolute,
}

/// Colours as the screen shows them (sRGB), at equal distances from 0 to full scale.
const BRIGHTER: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [0.9, 0.1, 0.0], [1.0, 0.95, 0.2]];
const DARKER: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [0.1, 0.25, 0.95], [0.3, 0.95, 1.0]];
const SIZE: [[f64; 3]; 5] = [[0.0, 0.0, 0.0], [0.35, 0.0, 0.55], [0.85, 0.15, 0.25], [1.0, 0.8, 0.1], [1.0, 1.0, 1.0]];

/// Not a colour of any scale: a pixel that is not finite in one of the images.
const NOT_FINITE: [f64; 3] = [1.0, 0.0, 1.0];

/// The difference of `image` and `reference`, averaged over the channels of a pixel, as a linear image whose PNG has the
/// colours of [`Difference`]. `full_scale`, in the images' units, is the difference that has the last colour; what is
/// larger has it too. Magenta: not finite in one of the images. `None` if the sizes differ.
pub fn difference(image: &Image, reference: &Image, kind: Difference, full_scale: f32) -> Option<Image> {
    let of = |difference: Option<f64>| match difference {
        Some(value) => colour(value / f64::from(full_scale).max(f64::MIN_POSITIVE), kind),
        None => NOT_FINITE,
    };
    let pixels =
        differences(image, reference, kind)?.map(|value| of(value).map(|c| srgb_to_linear(c) as f32)).collect();
    Some(Image { width: image.width, height: image.height, pixels })
}

/// A full scale that suits two images: 99 % of their pixels differ by no more, so that a few outliers do not leave the
/// rest black; 0 for equal images. `None` if the sizes differ.
pub fn difference_scale(image: &Image, reference: &Image) -> Option<f32> {
    let mut sizes: Vec<f64> = differences(image, reference, Difference::Absolute)?.flatten().collect();
    if sizes.is_empty() {
        return Some(0.0);
    }
    let rank = (sizes.len() - 1) * 99 / 100;
    Some(*sizes.select_nth_unstable_by(rank, f64::total_cmp).1 as f32)
}

/// The mean over the channels of each pixel's difference; `None` where it is not finite.
fn differences(image: &Image, reference: &Image, kind: Difference) -> Option<impl Iterator<Item = Option<f64>>> {
    if (image.width, image.height) != (reference.width, reference.height) {
        return None;
    }
    let of_channel = move |x: f32, r: f32| match kind {
        Difference::Signed => f64::from(x) - f64::from(r),
        Difference::Absolute => (f64::from(x) - f64::from(r)).abs(),
    };
    let of_pixel = move |(x, r): (&[f32; 3], &[f32; 3])| (0..3).map(|c| of_channel(x[c], r[c])).sum::<f64>() / 3.0;
    let pairs = image.pixels.iter().zip(&reference.pixels);
    Some(pairs.map(of_pixel).map(|value| value.is_finite().then_some(value)))
}

/// The colour of a difference as a fraction of full scale.
fn colour(value: f64, kind: Difference) -> [f64; 3] {
    match kind {
        Difference::Absolute => blend(&SIZE, value),
        Difference::Signed if value < 0.0 => blend(&DARKER, -value),
        Difference::Signed => blend(&BRIGHTER, value),
    }
}

fn blend(colours: &[[f64; 3]], value: f64) -> [f64; 3] {
    let place = value.min(1.0) * (colours.len() - 1) as f64;
    let index = (place as usize).min(colours.len() - 2);
    let part = place - index as f64;
    std::array::from_fn(|c| colours[index][c] + part * (colours[index + 1][c] - colours[index][c]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tone_map;

    fn row(values: &[f32]) -> Image {
        Image { width: values.len() as u32, height: 1, pixels: values.iter().map(|&v| [v; 3]).collect() }
    }

    fn shown(image: &[f32], reference: &[f32], kind: Difference) -> Vec<[u8; 3]> {
        let picture = difference(&row(image), &row(reference), kind, 2.0).unwrap();
        picture.pixels.iter().map(|&pixel| tone_map(pixel, 0.0)).collect()
    }

    #[test]
    fn signs_and_sizes_have_their_colours() {
        let (image, reference) = ([1.0, 3.0, 0.0, 2.0, f32::NAN], [1.0, 1.0, 9.0, 1.0, 1.0]);
        let signed = shown(&image, &reference, Difference::Signed);
        assert_eq!(signed, [[0, 0, 0], [255, 242, 51], [77, 242, 255], [230, 26, 0], [255, 0, 255]]);
        let absolute = shown(&image, &reference, Difference::Absolute);
        assert_eq!(absolute, [[0, 0, 0], [255, 255, 255], [255, 255, 255], [217, 38, 64], [255, 0, 255]]);
    }

    #[test]
    fn equal_images_are_black_at_any_scale() {
        let image = row(&[0.5, 2.0]);
        assert_eq!(difference_scale(&image, &image), Some(0.0));
        let picture = difference(&image, &image, Difference::Absolute, 0.0).unwrap();
        assert_eq!(picture, Image::black(2, 1));
    }

    #[test]
    fn the_scale_leaves_outliers_out() {
        let mut values: Vec<f32> = (0..=100).map(|i| i as f32).collect();
        assert_eq!(difference_scale(&row(&values), &row(&[0.0; 101])), Some(99.0));
        values[100] = 1e30;
        assert_eq!(difference_scale(&row(&values), &row(&[0.0; 101])), Some(99.0));
    }

    #[test]
    fn sizes_must_agree() {
        assert_eq!(difference(&Image::black(2, 1), &Image::black(1, 2), Difference::Signed, 1.0), None);
        assert_eq!(difference_scale(&Image::black(2, 1), &Image::black(1, 2)), None);
    }
}
