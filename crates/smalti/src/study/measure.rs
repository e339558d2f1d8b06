//! From a render to a line of the record.

use smalti_core::film::Image;
use smalti_core::render::RayCounts;
use smalti_core::settings::Rect;
use smalti_report::{Reference, Run, TileTime};

use super::bench::Rendered;
use super::reference::Truth;
use crate::exit::Failure;

/// How far an image is from the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Freed of the reference's own.
    pub relmse: f64,
    /// Not freed of anything.
    pub relmse_trimmed: f64,
    /// Freed of the reference's own; 0 where that is the larger.
    pub relative_error: f64,
}

/// Compares an image with the truth. The two have noise of their own, so that the squares add.
///
/// # Errors
/// Images of different size, or a reference that is black.
pub fn distance(image: &Image, truth: &Truth) -> Result<Distance, Failure> {
    let found = smalti_measure::compare(image, &truth.image, 0).map_err(Failure::user)?;
    let black = || Failure::user("the reference is black: there is nothing that an error could be relative to");
    let relative = found.relative_error.ok_or_else(black)?;
    let Reference { relmse, relative_error_squared, .. } = &truth.record;
    let rest = relative * relative - relative_error_squared.unwrap_or(0.0);
    Ok(Distance {
        relmse: found.relmse - relmse.unwrap_or(0.0),
        relmse_trimmed: found.relmse_trimmed,
        relative_error: rest.max(0.0).sqrt(),
    })
}

/// The record of a render.
pub fn run((arm, repetition): (usize, u32), rendered: &Rendered, distance: Distance) -> Run {
    let Rendered { settings, outcome, developed } = rendered;
    let RayCounts { camera, scattered, shadow } = outcome.rays;
    Run {
        arm,
        repetition,
        seed: settings.seed,
        seconds: outcome.timing.elapsed.as_secs_f64(),
        photon_seconds: outcome.photons.elapsed.as_secs_f64(),
        spp: outcome.samples as f64 / settings.area().pixels() as f64,
        rays: camera + scattered + shadow,
        relmse: distance.relmse,
        relmse_trimmed: distance.relmse_trimmed,
        relative_error: distance.relative_error,
        stated: developed.error,
        mean: developed.image.mean(),
        hash: smalti_image::hash(&developed.image),
        tiles: if repetition == 0 { tiles(rendered) } else { Vec::new() },
    }
}

fn tiles(rendered: &Rendered) -> Vec<TileTime> {
    let time = |(area, time): &(Rect, std::time::Duration)| {
        let Rect { x, y, width, height } = *area;
        TileTime { area: [x, y, width, height], seconds: time.as_secs_f64() }
    };
    rendered.outcome.timing.tiles.iter().map(time).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(relmse: Option<f64>, relative_error_squared: Option<f64>) -> Truth {
        let record = Reference { size: [2, 1], file: "r.pfm".into(), command: None, relmse, relative_error_squared };
        Truth { record, image: Image { width: 2, height: 1, pixels: vec![[1.0; 3]; 2] } }
    }

    #[test]
    fn errors_are_freed_of_the_references_own() {
        let image = Image { width: 2, height: 1, pixels: vec![[1.5; 3], [1.0; 3]] };
        let plain = distance(&image, &truth(None, None)).unwrap();
        // The mean of 0.25 / 1.01 and 0; the reference's mean is 1, so that both floors are 0.01.
        let square = 0.25 / 1.01 / 2.0;
        assert!((plain.relmse - square).abs() < 1e-12 && (plain.relative_error - square.sqrt()).abs() < 1e-12);
        let freed = distance(&image, &truth(Some(square / 2.0), Some(square / 4.0))).unwrap();
        assert!((freed.relmse - square / 2.0).abs() < 1e-12);
        assert!((freed.relative_error - (0.75 * square).sqrt()).abs() < 1e-12);
        assert_eq!(freed.relmse_trimmed, plain.relmse_trimmed);
    }

    #[test]
    fn what_is_nearer_than_the_reference_knows_has_no_relative_error() {
        let image = Image { width: 2, height: 1, pixels: vec![[1.01; 3]; 2] };
        let found = distance(&image, &truth(Some(0.1), Some(0.1))).unwrap();
        assert!(found.relmse < 0.0 && found.relative_error == 0.0);
    }

    #[test]
    fn a_black_reference_is_no_reference() {
        let image = Image { width: 2, height: 1, pixels: vec![[1.0; 3]; 2] };
        let black = Truth { image: Image::black(2, 1), ..truth(None, None) };
        assert!(distance(&image, &black).unwrap_err().message.contains("black"));
    }
}
