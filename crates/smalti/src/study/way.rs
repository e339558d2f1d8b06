//! A way to render a scene: one value of every knob.

use smalti_core::settings::Settings;

use crate::downsample;
use crate::exit::Failure;

/// One way to render a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Settings of the image; its seed is that of repetition 0.
    pub image: Settings,
    /// Pixels that are rendered for each one of the image, in each direction.
    pub downsample: u32,
    /// Worker threads, at least 1.
    pub threads: usize,
}

impl Way {
    /// The settings of what is rendered.
    ///
    /// # Errors
    /// A side that is too long to be rendered.
    pub fn rendered(&self) -> Result<Settings, Failure> {
        downsample::rendered(self.image.clone(), self.downsample)
    }

    /// Width and height of the image.
    pub fn size(&self) -> [u32; 2] {
        [self.image.width, self.image.height]
    }

    /// Pixels that are rendered.
    pub fn pixels(&self) -> f64 {
        self.size().map(|side| f64::from(side) * f64::from(self.downsample)).iter().product()
    }

    /// Camera paths of a render.
    pub fn samples(&self) -> f64 {
        self.pixels() * f64::from(self.image.spp)
    }

    /// Photons of a round and map.
    pub fn photons(&self) -> u32 {
        let side = |side: u32| side.saturating_mul(self.downsample);
        let (width, height) = (side(self.image.width), side(self.image.height));
        Settings { width, height, ..self.image.clone() }.photons_of_round()
    }
}

/// Threads that the machine can run at once.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_rendered_is_larger_than_the_image() {
        let image = Settings { width: 300, height: 200, spp: 4, ..Settings::default() };
        let way = Way { image, downsample: 2, threads: 1 };
        let rendered = way.rendered().unwrap();
        assert_eq!((rendered.width, rendered.height, way.size()), (600, 400, [300, 200]));
        assert_eq!((way.pixels(), way.samples()), (240_000.0, 960_000.0));
        assert_eq!(way.photons(), rendered.photons_of_round());
    }
}
