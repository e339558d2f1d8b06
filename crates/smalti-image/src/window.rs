//! Rectangles of pixels, and where an image file lies in the picture that it is of.

use smalti_core::film::Image;

/// A rectangle of pixels in the coordinates of a picture: columns to the right, rows downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Column of the pixels at the left.
    pub x: i32,
    /// Row of the pixels on top.
    pub y: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// The two windows of an OpenEXR file, in the same coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Windows {
    /// The pixels that the file holds.
    pub data: Window,
    /// The whole picture: what a viewer shows.
    pub display: Window,
}

impl Window {
    /// The window of an image that begins at column 0 and row 0.
    pub fn of_size(width: u32, height: u32) -> Self {
        Self { x: 0, y: 0, width, height }
    }

    /// Columns and rows.
    pub fn size(self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The one with more pixels; of equals the first.
    pub(crate) fn max(self, other: Self) -> Self {
        let pixels = |window: Self| u64::from(window.width) * u64::from(window.height);
        if pixels(other) > pixels(self) { other } else { self }
    }

    /// The pixels that are in both.
    pub fn common(self, other: Self) -> Option<Self> {
        let (x, width) = overlap((self.x, self.width), (other.x, other.width))?;
        let (y, height) = overlap((self.y, self.height), (other.y, other.height))?;
        Some(Self { x, y, width, height })
    }

    /// The pixels of `part` out of `image`, which lies here. `part` lies inside.
    pub(crate) fn cut(self, image: Image, part: Self) -> Image {
        if part == self {
            return image;
        }
        let skipped = |from: i32, to: i32| (i64::from(to) - i64::from(from)) as usize;
        let (left, top) = (skipped(self.x, part.x), skipped(self.y, part.y));
        let rows = image.pixels.chunks(self.width as usize).skip(top).take(part.height as usize);
        let pixels = rows.flat_map(|row| &row[left..left + part.width as usize]).copied().collect();
        Image { width: part.width, height: part.height, pixels }
    }
}

impl std::fmt::Display for Window {
    /// Size and place: `64x48 pixels at 10,20`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{} pixels at {},{}", self.width, self.height, self.x, self.y)
    }
}

/// Start and length of what two stretches share.
fn overlap(a: (i32, u32), b: (i32, u32)) -> Option<(i32, u32)> {
    let start = a.0.max(b.0);
    let end = |(start, length): (i32, u32)| i64::from(start) + i64::from(length);
    let length = end(a).min(end(b)) - i64::from(start);
    u32::try_from(length).ok().filter(|&length| length > 0).map(|length| (start, length))
}

impl Windows {
    /// Those of an image that is the whole picture.
    pub fn whole(width: u32, height: u32) -> Self {
        let whole = Window::of_size(width, height);
        Self { data: whole, display: whole }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(x: i32, y: i32, width: u32, height: u32) -> Window {
        Window { x, y, width, height }
    }

    #[test]
    fn windows_share_what_lies_in_both() {
        let whole = Window::of_size(10, 8);
        assert_eq!(whole.common(window(3, 2, 4, 4)), Some(window(3, 2, 4, 4)));
        assert_eq!(window(-2, -1, 5, 5).common(whole), Some(window(0, 0, 3, 4)));
        assert_eq!(whole.common(window(9, 7, 5, 5)), Some(window(9, 7, 1, 1)));
        assert_eq!(whole.common(window(10, 0, 5, 5)), None);
        assert_eq!(window(i32::MIN, 0, 1, 1).common(window(i32::MAX, 0, u32::MAX, 1)), None);
        assert_eq!(window(i32::MIN, 0, 0x7fff_ffff, 1).common(window(-9, 0, 20, 1)), Some(window(-9, 0, 8, 1)));
    }

    #[test]
    fn a_part_is_cut_out_of_an_image() {
        let image = Image { width: 3, height: 2, pixels: (0..6u8).map(|n| [f32::from(n); 3]).collect() };
        let part = window(5, -1, 3, 2).cut(image, window(6, 0, 2, 1));
        assert_eq!(part, Image { width: 2, height: 1, pixels: vec![[4.0; 3], [5.0; 3]] });
    }
}
