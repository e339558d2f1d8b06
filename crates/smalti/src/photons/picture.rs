//! The picture of a photon map: from what the film holds to radiance, or to figures and their false colours.

use serde::Serialize;
use smalti_core::film::Image;

use super::ramp;
use crate::names::ColourArg;

/// A picture of a photon map.
#[derive(Debug)]
pub struct Picture {
    /// Linear radiance; or figures, the same in every channel, and 0 where there is no photon.
    pub image: Image,
    /// False colours and what they stand for.
    pub coloured: Option<(Image, Scale)>,
}

/// What false colours stand for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Scale {
    /// Figure of the darkest colour; black is 0, no photon.
    pub least: f64,
    /// Figure of the lightest colour.
    pub most: f64,
    /// Whether equal steps of colour are equal factors, not equal differences.
    pub logarithmic: bool,
    /// Unit of the figures.
    pub unit: &'static str,
}

/// Photons as dense as this part of the most dense ones have the darkest colour.
const RANGE: f64 = 1e-4;

/// So few of the pixels with photons may have more than the lightest colour stands for.
const ABOVE: f64 = 1e-3;

/// The picture that a developed film of photons becomes.
pub fn develop(image: Image, colour: ColourArg) -> Picture {
    let figure: fn([f32; 3]) -> f32 = match colour {
        ColourArg::Flux => return Picture { image, coloured: None },
        ColourArg::Density => |[_, photons, _]| photons,
        ColourArg::Bounces => |[events, photons, _]| if photons > 0.0 { events / photons } else { 0.0 },
    };
    let lit = sorted(image.pixels.iter().filter(|pixel| pixel[1] > 0.0).map(|pixel| figure(*pixel)));
    let scale = if colour == ColourArg::Density { Scale::densities(&lit) } else { Scale::bounces(&lit) };
    let paint = |pixel: &[f32; 3]| if pixel[1] > 0.0 { ramp::colour(scale.place(figure(*pixel))) } else { [0.0; 3] };
    let coloured = with(&image, image.pixels.iter().map(paint));
    let figures = with(&image, image.pixels.iter().map(|pixel| [figure(*pixel); 3]));
    Picture { image: figures, coloured: Some((coloured, scale)) }
}

fn with(image: &Image, pixels: impl Iterator<Item = [f32; 3]>) -> Image {
    Image { pixels: pixels.collect(), ..*image }
}

fn sorted(figures: impl Iterator<Item = f32>) -> Vec<f32> {
    let mut sorted: Vec<f32> = figures.collect();
    sorted.sort_unstable_by(f32::total_cmp);
    sorted
}

/// What all but few of the figures are at most; 0 without any.
fn most(sorted: &[f32]) -> f64 {
    let above = (sorted.len() as f64 * ABOVE) as usize;
    sorted.len().checked_sub(1 + above).map_or(0.0, |at| sorted[at].into())
}

impl Scale {
    fn densities(sorted: &[f32]) -> Self {
        let most = most(sorted);
        Self { least: RANGE * most, most, logarithmic: true, unit: "photons/m²" }
    }

    fn bounces(sorted: &[f32]) -> Self {
        let least = sorted.first().map_or(0.0, |least| f64::from(*least).floor());
        let most = most(sorted).ceil().max(least + 1.0);
        Self { least, most, logarithmic: false, unit: "scattering events" }
    }

    /// Place on the ramp of a figure, in [0, 1] for what lies on the scale.
    fn place(&self, figure: f32) -> f64 {
        let Self { least, most, logarithmic, .. } = *self;
        match logarithmic {
            true => libm::log2(f64::from(figure) / least) / libm::log2(most / least),
            false => (f64::from(figure) - least) / (most - least),
        }
    }

    /// The figure at a place on the ramp.
    pub fn figure(&self, place: f64) -> f64 {
        let Self { least, most, logarithmic, .. } = *self;
        if logarithmic { least * libm::pow(most / least, place) } else { least + place * (most - least) }
    }
}

#[cfg(test)]
mod tests {
    use smalti_image::tone_map;

    use super::*;

    fn film() -> Image {
        let pixels = vec![[0.0; 3], [20.0, 10.0, 0.0], [3000.0, 1000.0, 0.0], [2.0, 0.5, 0.0]];
        Image { width: 2, height: 2, pixels }
    }

    #[test]
    fn radiance_is_left_as_it_is() {
        let picture = develop(film(), ColourArg::Flux);
        assert!(picture.image == film() && picture.coloured.is_none());
    }

    #[test]
    fn densities_are_on_a_logarithmic_scale() {
        let Picture { image, coloured } = develop(film(), ColourArg::Density);
        assert_eq!(image.pixels, [[0.0; 3], [10.0; 3], [1000.0; 3], [0.5; 3]]);
        let (colours, scale) = coloured.unwrap();
        assert_eq!((scale.least, scale.most, scale.logarithmic), (0.1, 1000.0, true));
        assert!((scale.place(10.0) - 0.5).abs() < 1e-12 && (scale.figure(0.5) - 10.0).abs() < 1e-9);
        assert_eq!(colours.pixels[0], [0.0; 3]);
        assert_eq!(tone_map(colours.pixels[2], 0.0), [253, 231, 37]);
    }

    #[test]
    fn bounces_are_the_mean_over_photons() {
        let Picture { image, coloured } = develop(film(), ColourArg::Bounces);
        assert_eq!(image.pixels, [[0.0; 3], [2.0; 3], [3.0; 3], [4.0; 3]]);
        let (colours, scale) = coloured.unwrap();
        assert_eq!((scale.least, scale.most, scale.place(3.0), scale.figure(0.5)), (2.0, 4.0, 0.5, 3.0));
        assert_eq!(tone_map(colours.pixels[1], 0.0), [68, 1, 84]);
    }

    #[test]
    fn a_picture_without_a_photon_is_black() {
        let dark = Image::black(3, 1);
        for colour in [ColourArg::Density, ColourArg::Bounces] {
            let Picture { image, coloured } = develop(dark.clone(), colour);
            assert!(image == dark && coloured.unwrap().0 == dark);
        }
    }
}
