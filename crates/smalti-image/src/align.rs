//! Two images, pixel on pixel: each at the place that its file tells.

use smalti_core::film::Image;

use crate::picture::Picture;
use crate::window::{Window, Windows};

/// The pixels that two files have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Aligned {
    /// Those of the first file.
    pub image: Image,
    /// Those of the second.
    pub reference: Image,
    /// Where they lie.
    pub window: Window,
    /// The whole picture, as far as one of the files tells: the larger of the windows that are known.
    pub display: Window,
    /// How they were placed, in words, where that is not plain: one of the files holds more, or their windows differ.
    pub note: Option<String>,
}

/// Images of which no pixel lies on a pixel of the other.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AlignError {
    /// They are of pictures of different size.
    #[error("the image has {}, the reference {}", size_of(.image), size_of(.reference))]
    Sizes {
        /// Size of the image and of its picture, where the file tells.
        image: Sizes,
        /// The same of the reference.
        reference: Sizes,
    },
    /// They have no pixel in common.
    #[error("the image holds {image}, the reference {reference}: no pixel is in both (the windows of EXR files tell)")]
    Disjoint {
        /// Where the image lies.
        image: Window,
        /// Where the reference lies.
        reference: Window,
    },
}

/// Columns and rows of an image, and of the whole picture where the file tells of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    held: (u32, u32),
    display: Option<(u32, u32)>,
}

fn size_of(sizes: &Sizes) -> String {
    let (width, height) = sizes.held;
    match sizes.display.filter(|&display| display != sizes.held) {
        Some((w, h)) => format!("{width}×{height} pixels of a picture of {w}×{h}"),
        None => format!("{width}×{height} pixels"),
    }
}

/// Puts `image` on `reference` and cuts out what both hold.
///
/// OpenEXR files lie where their data windows are, in coordinates that they share if their display windows have one
/// size. An image of another format is the whole picture that an OpenEXR file shows if it is as large as its display
/// window, and what it holds if it is as large as its data window.
///
/// # Errors
/// Pictures of different size; no pixel in common.
pub fn align(image: Picture, reference: Picture) -> Result<Aligned, AlignError> {
    let sizes = || AlignError::Sizes { image: sizes(&image), reference: sizes(&reference) };
    let (of_image, of_reference) = places(&image, &reference).ok_or_else(sizes)?;
    let disjoint = AlignError::Disjoint { image: of_image, reference: of_reference };
    let window = of_image.common(of_reference).ok_or(disjoint)?;
    Ok(Aligned {
        note: note((&image, of_image), (&reference, of_reference), window),
        display: [&image, &reference].into_iter().filter_map(display).fold(of_image.max(of_reference), Window::max),
        image: of_image.cut(image.image, window),
        reference: of_reference.cut(reference.image, window),
        window,
    })
}

fn sizes(picture: &Picture) -> Sizes {
    Sizes { held: picture.data().size(), display: picture.windows.map(|windows| windows.display.size()) }
}

/// Where both lie, in the same coordinates; `None` if they are not of one picture.
fn places(image: &Picture, reference: &Picture) -> Option<(Window, Window)> {
    let (data, truth) = (image.data(), reference.data());
    match (image.windows, reference.windows) {
        (None, None) => (data == truth).then_some((data, truth)),
        (Some(a), Some(b)) => share_a_picture(a, b).then_some((data, truth)),
        (None, Some(windows)) => Some((beside(data, windows)?, truth)),
        (Some(windows), None) => Some((data, beside(truth, windows)?)),
    }
}

fn share_a_picture(a: Windows, b: Windows) -> bool {
    a.display.size() == b.display.size() || a.data == b.data || tells_no_whole(a) || tells_no_whole(b)
}

/// Whether a display window is that of a part: some programs write a crop's for both.
fn tells_no_whole(windows: Windows) -> bool {
    windows.data == windows.display && (windows.data.x, windows.data.y) != (0, 0)
}

/// Where an image lies whose format tells nothing, beside an OpenEXR file.
fn beside(image: Window, windows: Windows) -> Option<Window> {
    match image.size() {
        size if size == windows.display.size() => Some(windows.display),
        size if size == windows.data.size() => Some(windows.data),
        _ => (tells_no_whole(windows) && windows.data.common(image) == Some(windows.data)).then_some(image),
    }
}

fn display(picture: &Picture) -> Option<Window> {
    picture.windows.map(|windows| windows.display)
}

fn note(image: (&Picture, Window), reference: (&Picture, Window), window: Window) -> Option<String> {
    let whole = |(_, place): (&Picture, Window)| place == window;
    if !(whole(image) && whole(reference)) {
        return Some(format!(
            "compared is what both hold, {window}: the image holds {}, the reference {}",
            image.1, reference.1
        ));
    }
    match (display(image.0), display(reference.0)) {
        (Some(a), Some(b)) if a != b => Some(format!("the display windows differ: {a} and {b}")),
        (Some(shown), None) | (None, Some(shown)) if shown != window => {
            Some(format!("both hold {}x{} pixels, of a picture of {shown}", window.width, window.height))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each pixel tells its column and row in the picture.
    fn held(data: Window) -> Image {
        let at = |x: u32, y: u32| {
            [(i64::from(x) + i64::from(data.x)) as f32, (i64::from(y) + i64::from(data.y)) as f32, 1.0]
        };
        let pixels = (0..data.height).flat_map(|y| (0..data.width).map(move |x| at(x, y))).collect();
        Image { width: data.width, height: data.height, pixels }
    }

    fn window(x: i32, y: i32, width: u32, height: u32) -> Window {
        Window { x, y, width, height }
    }

    fn exr(data: Window, display: Window) -> Picture {
        Picture { windows: Some(Windows { data, display }), ..held(data).into() }
    }

    fn plain(width: u32, height: u32) -> Picture {
        held(Window::of_size(width, height)).into()
    }

    const WHOLE: Window = Window { x: 0, y: 0, width: 12, height: 9 };

    #[test]
    fn a_crop_lies_in_the_whole() {
        let crop = window(3, 2, 4, 5);
        for whole in [exr(WHOLE, WHOLE), plain(12, 9)] {
            for (a, b) in [(exr(crop, WHOLE), whole.clone()), (whole.clone(), exr(crop, WHOLE))] {
                let found = align(a, b).unwrap();
                assert_eq!((&found.image, &found.reference, found.window), (&held(crop), &held(crop), crop));
                assert!(found.note.unwrap().contains("what both hold, 4x5 pixels at 3,2"));
            }
        }
    }

    #[test]
    fn shifted_pictures_differ() {
        let shifted = window(1, 0, 12, 9);
        for display in [WHOLE, shifted] {
            // The same values, one column to the right.
            let image = Picture { image: held(WHOLE), ..exr(shifted, display) };
            let found = align(image, exr(WHOLE, WHOLE)).unwrap();
            assert_eq!(found.window, window(1, 0, 11, 9));
            let column = |image: &Image| image.pixels[0][0];
            assert_eq!((column(&found.image), column(&found.reference)), (0.0, 1.0));
            assert!(found.note.is_some());
        }
    }

    #[test]
    fn overscan_is_left_out() {
        let over = window(-2, -1, 16, 11);
        let found = align(exr(over, WHOLE), plain(12, 9)).unwrap();
        assert_eq!((found.image, found.window), (held(WHOLE), WHOLE));
        let found = align(exr(over, WHOLE), exr(over, WHOLE)).unwrap();
        assert_eq!((found.image, found.window, found.note), (held(over), over, None));
    }

    #[test]
    fn an_image_without_windows_may_be_the_crop() {
        let crop = window(3, 2, 4, 5);
        let found = align(plain(4, 5), exr(crop, WHOLE)).unwrap();
        assert_eq!((found.window, found.image), (crop, held(Window::of_size(4, 5))));
        assert_eq!(found.note.unwrap(), "both hold 4x5 pixels, of a picture of 12x9 pixels at 0,0");
    }

    #[test]
    fn a_display_window_of_a_part_tells_nothing_of_the_whole() {
        let crop = window(3, 2, 4, 5);
        for whole in [exr(WHOLE, WHOLE), plain(12, 9)] {
            assert_eq!(align(exr(crop, crop), whole).unwrap().image, held(crop));
        }
        assert!(align(exr(crop, crop), plain(5, 5)).is_err());
    }

    #[test]
    fn pictures_of_different_size_are_refused() {
        let message = |a, b| align(a, b).unwrap_err().to_string();
        let small = Window::of_size(6, 4);
        let expected = "the image has 12×9 pixels, the reference 6×4 pixels";
        assert_eq!(message(plain(12, 9), plain(6, 4)), expected);
        assert_eq!(message(exr(WHOLE, WHOLE), exr(small, small)), expected);
        assert_eq!(message(plain(12, 9), exr(small, small)), expected);
        let expected = "the image has 4×5 pixels of a picture of 12×9, the reference 6×4 pixels";
        assert_eq!(message(exr(window(3, 2, 4, 5), WHOLE), exr(small, small)), expected);
    }

    #[test]
    fn what_has_nothing_in_common_is_refused() {
        let error = align(exr(window(0, 0, 4, 9), WHOLE), exr(window(4, 0, 4, 9), WHOLE)).unwrap_err().to_string();
        assert!(error.starts_with("the image holds 4x9 pixels at 0,0, the reference 4x9 pixels at 4,0: no"), "{error}");
    }

    #[test]
    fn whole_images_are_compared_without_a_word() {
        for (a, b) in
            [(plain(12, 9), plain(12, 9)), (exr(WHOLE, WHOLE), plain(12, 9)), (exr(WHOLE, WHOLE), exr(WHOLE, WHOLE))]
        {
            assert_eq!(align(a, b).unwrap().note, None);
        }
    }
}
