//! The picture so far, small enough for a terminal.
//!
//! Tiles are averaged into cells as they arrive, so a huge image takes no more memory here than a small one. A cell
//! belongs to the tile that holds its middle.

use smalti_core::settings::Rect;
use smalti_image::tone_map;

use super::pen::{Pen, glyph};
use super::terminal::Palette;

/// Cells in each direction at most; more than any terminal shows.
const SIDE: u32 = 512;
/// What the tiles in hand are tinted with.
const AMBER: [u8; 3] = [255, 176, 0];

/// A reduced image; cells that no tile has reached yet are unknown.
#[derive(Clone, Debug)]
pub struct Picture {
    area: Rect,
    /// Image pixels a cell, in each direction.
    step: u32,
    columns: u32,
    cells: Vec<Option<[f32; 3]>>,
}

/// How to show linear radiance.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Colours that may be used.
    pub palette: Palette,
    /// Brightness, stops.
    pub exposure: f32,
}

impl Picture {
    /// An unknown picture of `area`.
    pub fn new(area: Rect) -> Self {
        let step = area.width.max(area.height).div_ceil(SIDE).max(1);
        let (columns, rows) = (area.width.div_ceil(step), area.height.div_ceil(step));
        Self { area, step, columns, cells: vec![None; columns as usize * rows as usize] }
    }

    /// Puts a tile's linear `pixels` where they belong.
    pub fn put(&mut self, tile: Rect, pixels: &[[f32; 3]]) {
        let local = Rect { x: tile.x - self.area.x, y: tile.y - self.area.y, ..tile };
        for row in self.owned(local.y, local.height, self.area.height) {
            for column in self.owned(local.x, local.width, self.area.width) {
                let cell = Rect { x: column * self.step, y: row * self.step, width: self.step, height: self.step };
                self.cells[(row * self.columns + column) as usize] = Some(mean(local, pixels, cell));
            }
        }
    }

    /// The cells whose middle lies within `length` pixels from `start`, in an image of `whole` pixels.
    fn owned(&self, start: u32, length: u32, whole: u32) -> impl Iterator<Item = u32> + use<> {
        let step = self.step;
        let cells = start / step..(start + length).div_ceil(step);
        cells.filter(move |cell| (start..start + length).contains(&(cell * step + step / 2).min(whole - 1)))
    }

    /// Columns and dots that show the whole picture undistorted within `columns` × `lines` of text, two dots a line;
    /// `None` where that is too small to see anything.
    pub fn fit(&self, columns: usize, lines: usize) -> Option<(usize, usize)> {
        let (width, height) = (f64::from(self.area.width), f64::from(self.area.height));
        let scale = (width / columns as f64).max(height / (2 * lines) as f64).max(1.0);
        let fitted = ((width / scale).round() as usize, (height / scale).round() as usize);
        (fitted.0.min(columns) >= 4 && fitted.1.min(2 * lines) >= 4).then_some(fitted)
    }

    /// Lines of text with the picture at `size` (columns and dots); the tiles in `busy` are tinted.
    pub fn paint(&self, size: (usize, usize), look: Look, busy: &[Rect]) -> Vec<String> {
        (0..size.1.div_ceil(2)).map(|line| self.line(line, size, look, busy)).collect()
    }

    fn line(&self, line: usize, size: (usize, usize), look: Look, busy: &[Rect]) -> String {
        let mut text = String::new();
        let mut pen = Pen::default();
        for column in 0..size.0 {
            let upper = self.dot(column, 2 * line, size, look, busy);
            let lower = self.dot(column, 2 * line + 1, size, look, busy);
            match look.palette {
                Palette::Mono => text.push(glyph(upper, lower)),
                palette => pen.draw(&mut text, upper, lower, palette),
            }
        }
        pen.lift(&mut text);
        text
    }

    /// The colour of a dot, `None` where nothing is known.
    fn dot(&self, x: usize, y: usize, size: (usize, usize), look: Look, busy: &[Rect]) -> Option<[u8; 3]> {
        let (left, right) = span(x, size.0, self.area.width)?;
        let (top, bottom) = span(y, size.1, self.area.height)?;
        let mut sum = [0.0; 3];
        let mut known = 0.0;
        for row in top / self.step..=(bottom - 1) / self.step {
            for column in left / self.step..=(right - 1) / self.step {
                if let Some(cell) = self.cells[(row * self.columns + column) as usize] {
                    sum = std::array::from_fn(|channel| sum[channel] + cell[channel]);
                    known += 1.0;
                }
            }
        }
        let colour = (known > 0.0).then(|| tone_map(sum.map(|sum| sum / known), look.exposure));
        let middle = (self.area.x + (left + right) / 2, self.area.y + (top + bottom) / 2);
        if look.palette != Palette::Mono && busy.iter().any(|tile| holds(tile, middle)) {
            return Some(tint(colour.unwrap_or_default()));
        }
        colour
    }
}

/// The pixels behind dot number `index` of `count`, of `whole` pixels in all.
fn span(index: usize, count: usize, whole: u32) -> Option<(u32, u32)> {
    let edge = |index: usize| (index as u64 * u64::from(whole) / count as u64) as u32;
    (index < count).then(|| (edge(index), edge(index + 1).max(edge(index) + 1)))
}

fn holds(rect: &Rect, (x, y): (u32, u32)) -> bool {
    (rect.x..rect.x + rect.width).contains(&x) && (rect.y..rect.y + rect.height).contains(&y)
}

/// Mean of the pixels that lie in both `tile` and `cell`.
fn mean(tile: Rect, pixels: &[[f32; 3]], cell: Rect) -> [f32; 3] {
    let mut sum = [0.0; 3];
    let mut count = 0.0;
    for y in cell.y.max(tile.y)..(cell.y + cell.height).min(tile.y + tile.height) {
        for x in cell.x.max(tile.x)..(cell.x + cell.width).min(tile.x + tile.width) {
            let pixel = pixels[((y - tile.y) * tile.width + x - tile.x) as usize];
            sum = std::array::from_fn(|channel| sum[channel] + pixel[channel]);
            count += 1.0;
        }
    }
    sum.map(|sum| sum / count)
}

fn tint(colour: [u8; 3]) -> [u8; 3] {
    std::array::from_fn(|channel| ((3 * u16::from(colour[channel]) + u16::from(AMBER[channel])) / 4) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MONO: Look = Look { palette: Palette::Mono, exposure: 0.0 };
    const TRUE: Look = Look { palette: Palette::True, exposure: 0.0 };

    fn rect(x: u32, y: u32, width: u32, height: u32) -> Rect {
        Rect { x, y, width, height }
    }

    /// A picture whose left half is black and whose right half is white.
    fn halves(area: Rect) -> Picture {
        let mut picture = Picture::new(area);
        let row = |_| (0..area.width).map(|x| if x < area.width / 2 { [0.0; 3] } else { [1.0; 3] });
        picture.put(area, &(0..area.height).flat_map(row).collect::<Vec<_>>());
        picture
    }

    #[test]
    fn fits_without_distortion() {
        assert_eq!(Picture::new(rect(0, 0, 800, 800)).fit(80, 20), Some((40, 40)));
        assert_eq!(Picture::new(rect(0, 0, 800, 400)).fit(80, 40), Some((80, 40)));
        assert_eq!(Picture::new(rect(0, 0, 20, 10)).fit(80, 40), Some((20, 10)));
        assert_eq!(Picture::new(rect(0, 0, 800, 800)).fit(80, 1), None);
        assert_eq!(Picture::new(rect(0, 0, 10_000, 10)).fit(80, 40), None);
    }

    #[test]
    fn every_line_is_as_wide_as_asked() {
        for size in [(40, 40), (37, 11), (5, 4)] {
            let lines = halves(rect(0, 0, 64, 64)).paint(size, TRUE, &[rect(8, 8, 8, 8)]);
            assert_eq!(lines.len(), size.1.div_ceil(2));
            assert!(lines.iter().all(|line| console::measure_text_width(line) == size.0));
        }
    }

    #[test]
    fn halves_stay_halves() {
        assert_eq!(halves(rect(5, 9, 64, 64)).paint((8, 4), MONO, &[]), ["    @@@@"; 2]);
        assert_eq!(
            halves(rect(0, 0, 64, 64)).paint((4, 2), TRUE, &[]),
            ["\x1b[38;2;0;0;0m\x1b[48;2;0;0;0m▀▀\x1b[38;2;255;255;255m\x1b[48;2;255;255;255m▀▀\x1b[0m"]
        );
    }

    #[test]
    fn what_is_unknown_stays_empty() {
        let mut picture = Picture::new(rect(0, 0, 8, 8));
        picture.put(rect(4, 4, 4, 4), &[[1.0; 3]; 16]);
        assert_eq!(picture.paint((8, 8), MONO, &[]), ["        ", "        ", "    @@@@", "    @@@@"]);
        assert_eq!(picture.paint((2, 2), TRUE, &[]), [" \x1b[38;2;255;255;255m▄\x1b[0m"]);
    }

    #[test]
    fn tiles_of_a_huge_image_fill_every_cell() {
        let area = rect(3, 5, 3001, 1999);
        let mut picture = Picture::new(area);
        for y in (0..area.height).step_by(32) {
            for x in (0..area.width).step_by(32) {
                let tile = rect(area.x + x, area.y + y, (area.width - x).min(32), (area.height - y).min(32));
                picture.put(tile, &vec![[0.5; 3]; tile.pixels()]);
            }
        }
        assert!(picture.cells.len() <= (SIDE * SIDE) as usize);
        assert!(picture.cells.iter().all(|cell| *cell == Some([0.5; 3])));
    }

    #[test]
    fn exposure_brightens() {
        let mut picture = Picture::new(rect(0, 0, 4, 4));
        picture.put(rect(0, 0, 4, 4), &[[0.25; 3]; 16]);
        let white = picture.paint((1, 2), Look { palette: Palette::Indexed, exposure: 2.0 }, &[]);
        assert_eq!(white, ["\x1b[38;5;231m\x1b[48;5;231m▀\x1b[0m"]);
    }

    #[test]
    fn tiles_in_hand_are_tinted() {
        let mut picture = Picture::new(rect(0, 0, 4, 4));
        picture.put(rect(0, 0, 4, 4), &[[0.0; 3]; 16]);
        let line = picture.paint((1, 2), TRUE, &[rect(0, 0, 4, 4)]);
        assert_eq!(line, ["\x1b[38;2;63;44;0m\x1b[48;2;63;44;0m▀\x1b[0m"]);
    }
}
