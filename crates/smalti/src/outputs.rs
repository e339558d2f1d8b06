//! The image files that a command writes: named and checked before it begins, written one after the other at its end.

use std::path::{Path, PathBuf};

use smalti_core::settings::{Rect, Settings};
use smalti_image::{Window, Windows, WriteError};

use crate::downsample;
use crate::exit::Failure;

/// Files to write, each possible as far as can be told; unless some were typed, the name of the scene with `ending`, here.
pub fn checked(typed: &[PathBuf], scene: &Path, ending: &str) -> Result<Vec<PathBuf>, Failure> {
    let mut outputs = typed.to_vec();
    if outputs.is_empty() {
        let no_name = || Failure::user(format!("{} is no scene file", scene.display()));
        let mut name = scene.file_stem().ok_or_else(no_name)?.to_owned();
        name.push(ending);
        outputs.push(name.into());
    }
    for (index, path) in outputs.iter().enumerate() {
        smalti_image::check_destination(path).map_err(Failure::user)?;
        if outputs[..index].contains(path) {
            return Err(Failure::user(format!("{} is named twice", path.display())));
        }
    }
    Ok(outputs)
}

/// Another file beside these, possible as far as can be told and none of them.
pub fn check_beside(outputs: &[PathBuf], other: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = other else { return Ok(()) };
    smalti_image::check_destination(path).map_err(Failure::user)?;
    match outputs.iter().any(|output| output == path) {
        true => Err(Failure::user(format!("{} is named twice", path.display()))),
        false => Ok(()),
    }
}

/// Where the image of a render lies in the whole picture; `by` × `by` pixels of what `rendered` says became one of it.
pub fn windows(rendered: &Settings, by: u32) -> Windows {
    let image = downsample::image(rendered, by);
    let Rect { x, y, width, height } = image.area();
    // Sides are far below 2^31.
    let data = Window { x: x as i32, y: y as i32, width, height };
    Windows { data, display: Window::of_size(image.width, image.height) }
}

/// Writes every file that can be written and adds its name to `written`; an error names the others.
pub fn write_all(
    outputs: &[PathBuf],
    written: &mut Vec<String>,
    write: impl Fn(&Path) -> Result<(), WriteError>,
) -> Result<(), Failure> {
    let mut failures = Vec::new();
    for path in outputs {
        match write(path) {
            Ok(()) => written.push(path.display().to_string()),
            Err(error) => failures.push(error.to_string()),
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(Failure::output(failures.join("\n"))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_output_has_the_scenes_name_and_lies_here() {
        let named = |scene: &str, ending| checked(&[], Path::new(scene), ending);
        assert_eq!(named("far/away/room.v2.toml", ".png"), Ok(vec!["room.v2.png".into()]));
        assert_eq!(named("far/away/room.toml", "-photons.png"), Ok(vec!["room-photons.png".into()]));
        assert!(named("..", ".png").is_err());
    }

    #[test]
    fn a_crop_lies_in_the_whole_image() {
        let crop = Some(Rect { x: 4, y: 6, width: 8, height: 10 });
        let settings = Settings { width: 40, height: 20, crop, ..Settings::default() };
        let data = Window { x: 4, y: 6, width: 8, height: 10 };
        assert_eq!(windows(&settings, 1), Windows { data, display: Window::of_size(40, 20) });
        let data = Window { x: 2, y: 3, width: 4, height: 5 };
        assert_eq!(windows(&settings, 2), Windows { data, display: Window::of_size(20, 10) });
        assert_eq!(windows(&Settings { crop: None, ..settings }, 1), Windows::whole(40, 20));
    }

    #[test]
    fn outputs_are_checked() {
        let message = |typed: &[&str]| {
            let typed: Vec<PathBuf> = typed.iter().map(PathBuf::from).collect();
            checked(&typed, Path::new("a.toml"), ".png").unwrap_err().message
        };
        assert!(message(&["a.pgn"]).contains(".png"));
        assert!(message(&["no/such/folder/a.png"]).contains("no/such/folder"));
        assert!(message(&["a.png", "a.png"]).contains("twice"));
    }
}
