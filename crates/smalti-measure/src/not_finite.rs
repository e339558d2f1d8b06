//! Pixels that no metric can take: those with a channel that is NaN or infinite.

use smalti_core::film::Image;

/// Which pixels of an image and its reference are not finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NotFinite {
    /// In the image or the reference.
    pub either: usize,
    /// In the image.
    pub image: usize,
    /// In the reference.
    pub reference: usize,
    /// In the image and the reference.
    pub both: usize,
    /// Those of `both` that are the same in every channel: the same number, the same infinity, or NaN.
    pub alike: usize,
    /// The first that are not the same, in image order.
    pub first: Vec<NotFinitePixel>,
}

/// A pixel that is not finite in an image or its reference, and not the same in both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotFinitePixel {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// The image's value.
    pub value: [f32; 3],
    /// The reference's value.
    pub reference: [f32; 3],
}

impl NotFinite {
    /// Pixels that differ for want of being finite.
    pub fn unlike(&self) -> usize {
        self.either - self.alike
    }
}

/// Counts the pixels of two images of one size that are not finite, and lists the first of those that differ, `most` at
/// most.
pub fn not_finite(image: &Image, reference: &Image, most: usize) -> NotFinite {
    let mut found = NotFinite::default();
    for (index, (&value, &truth)) in image.pixels.iter().zip(&reference.pixels).enumerate() {
        if is_finite(value) && is_finite(truth) {
            continue;
        }
        found.either += 1;
        found.image += usize::from(!is_finite(value));
        found.reference += usize::from(!is_finite(truth));
        found.both += usize::from(!is_finite(value) && !is_finite(truth));
        let alike = value.iter().zip(truth).all(|(a, b)| *a == b || a.is_nan() && b.is_nan());
        found.alike += usize::from(alike);
        if !alike && found.first.len() < most {
            let (x, y) = (index % image.width as usize, index / image.width as usize);
            found.first.push(NotFinitePixel { x: x as u32, y: y as u32, value, reference: truth });
        }
    }
    found
}

fn is_finite(pixel: [f32; 3]) -> bool {
    pixel.iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAN: f32 = f32::NAN;
    const INF: f32 = f32::INFINITY;

    fn row(pixels: &[[f32; 3]]) -> Image {
        Image { width: 2, height: pixels.len() as u32 / 2, pixels: pixels.to_vec() }
    }

    #[test]
    fn each_pixel_is_counted_where_it_is_not_finite() {
        let image = row(&[[1.0; 3], [NAN, 1.0, 1.0], [1.0; 3], [INF; 3], [NAN; 3], [-INF; 3]]);
        let reference = row(&[[1.0; 3], [1.0; 3], [1.0, 1.0, INF], [INF; 3], [INF; 3], [INF; 3]]);
        let found = not_finite(&image, &reference, 2);
        assert_eq!((found.either, found.image, found.reference), (5, 4, 4));
        assert_eq!((found.both, found.alike, found.unlike()), (3, 1, 4));
        let places: Vec<_> = found.first.iter().map(|pixel| (pixel.x, pixel.y)).collect();
        assert_eq!(places, [(1, 0), (0, 1)]);
    }

    #[test]
    fn alike_is_the_same_in_every_channel() {
        let alike = |a, b| not_finite(&row(&[a, [1.0; 3]]), &row(&[b, [2.0; 3]]), 9).alike == 1;
        assert!(alike([NAN, 1.0, INF], [-NAN, 1.0, INF]));
        assert!(alike([NAN, 0.0, -INF], [NAN, -0.0, -INF]));
        assert!(!alike([NAN, 1.0, 1.0], [NAN, 2.0, 1.0]));
        assert!(!alike([NAN, 1.0, 1.0], [INF, 1.0, 1.0]));
        assert!(!alike([INF; 3], [-INF; 3]));
    }

    #[test]
    fn finite_images_have_none() {
        let found = not_finite(&row(&[[f32::MAX; 3]; 4]), &row(&[[f32::MIN; 3]; 4]), 9);
        assert_eq!(found, NotFinite::default());
    }
}
