//! `--downsample N`: N × N pixels are rendered for each one of the image. Settings say what is rendered; users speak of
//! the image.

use smalti_core::settings::{Rect, Settings};

use crate::exit::Failure;
use crate::parse::MAX_SIDE;

/// The settings that render `by` × `by` pixels for each one that `image` asks for.
///
/// # Errors
/// A side that is too long to be rendered.
pub fn rendered(image: Settings, by: u32) -> Result<Settings, Failure> {
    let [width, height] = [image.width, image.height].map(|side| side.saturating_mul(by));
    if by > 1 && width.max(height) > MAX_SIDE {
        let message =
            format!("--downsample {by}: {width}x{height} pixels would be rendered; {MAX_SIDE} a side are the most");
        return Err(Failure::user(message));
    }
    let crop = image.crop.map(|crop| scaled(crop, |side| side * by));
    Ok(Settings { width, height, crop, ..image })
}

/// The settings of the image of which `rendered` has `by` × `by` pixels for each one.
pub fn image(rendered: &Settings, by: u32) -> Settings {
    let crop = rendered.crop.map(|crop| scaled(crop, |side| side / by));
    Settings { width: rendered.width / by, height: rendered.height / by, crop, ..rendered.clone() }
}

fn scaled(Rect { x, y, width, height }: Rect, by: impl Fn(u32) -> u32) -> Rect {
    Rect { x: by(x), y: by(y), width: by(width), height: by(height) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings() -> Settings {
        let crop = Some(Rect { x: 1, y: 2, width: 3, height: 4 });
        Settings { width: 10, height: 20, crop, ..Settings::default() }
    }

    #[test]
    fn there_and_back() {
        let rendered = rendered(settings(), 3).unwrap();
        assert_eq!((rendered.width, rendered.height), (30, 60));
        assert_eq!(rendered.crop, Some(Rect { x: 3, y: 6, width: 9, height: 12 }));
        assert_eq!(image(&rendered, 3), settings());
    }

    #[test]
    fn sides_have_a_limit() {
        let wide = Settings { width: 40_000, crop: None, ..settings() };
        assert!(rendered(wide.clone(), 2).unwrap_err().message.contains("80000x40 pixels"));
        assert_eq!(rendered(wide.clone(), 1), Ok(wide));
    }
}
