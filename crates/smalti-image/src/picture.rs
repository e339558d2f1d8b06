//! An image file as it was read.

use std::path::Path;

use smalti_core::film::Image;

use crate::window::{Window, Windows};

/// The image in a file, where it lies, and what is good to know of how it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The pixels that the file holds, linear.
    pub image: Image,
    /// Where they lie, if the format tells: OpenEXR does, the others do not.
    pub windows: Option<Windows>,
    /// What was chosen or left out, each in words.
    pub notes: Vec<String>,
}

impl Picture {
    /// The pixels of the display window if the file holds all of them, else those that it holds.
    pub fn shown(self) -> Image {
        match self.windows {
            Some(Windows { data, display }) if data.common(display) == Some(display) => data.cut(self.image, display),
            _ => self.image,
        }
    }

    /// The notes, each with the name of the file in front.
    pub fn named_notes(&self, path: &Path) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", path.display())).collect()
    }

    /// The window of the pixels that the file holds; it begins at 0,0 where the format tells nothing.
    pub(crate) fn data(&self) -> Window {
        self.windows.map_or(Window::of_size(self.image.width, self.image.height), |windows| windows.data)
    }
}

impl From<Image> for Picture {
    fn from(image: Image) -> Self {
        Self { image, windows: None, notes: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overscan_is_not_shown() {
        let image = Image { width: 3, height: 1, pixels: vec![[1.0; 3], [2.0; 3], [3.0; 3]] };
        let data = Window { x: -1, y: 0, width: 3, height: 1 };
        let of = |display| Picture { windows: Some(Windows { data, display }), ..image.clone().into() };
        assert_eq!(of(Window::of_size(1, 1)).shown().pixels, [[2.0; 3]]);
        // The file holds a part of what is shown.
        assert_eq!(of(Window::of_size(3, 1)).shown(), image);
        assert_eq!(Picture::from(image.clone()).shown(), image);
    }
}
