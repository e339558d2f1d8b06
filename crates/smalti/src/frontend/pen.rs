//! Two dots in one character: half blocks in colour, or brightness as a character.

use std::fmt::Write;

use super::terminal::Palette;

/// Brightness as characters, dark to bright.
const RAMP: &[u8] = b" .:-=+*#%@";

/// Two dots as one character.
pub fn glyph(upper: Option<[u8; 3]>, lower: Option<[u8; 3]>) -> char {
    let luma = |[r, g, b]: [u8; 3]| (2126 * usize::from(r) + 7152 * usize::from(g) + 722 * usize::from(b)) / 10_000;
    let dots = [upper, lower].into_iter().flatten().map(luma);
    let mean = dots.clone().sum::<usize>() / dots.count().max(1);
    char::from(RAMP[mean * RAMP.len() / 256])
}

/// The colours that the terminal has at the moment.
#[derive(Default)]
pub struct Pen {
    ink: Option<[u8; 3]>,
    paper: Option<[u8; 3]>,
}

impl Pen {
    /// Draws two dots, one above the other.
    pub fn draw(&mut self, text: &mut String, upper: Option<[u8; 3]>, lower: Option<[u8; 3]>, palette: Palette) {
        let (glyph, ink, paper) = match (upper, lower) {
            (None, None) => (' ', self.ink, None),
            (None, lower) => ('▄', lower, None),
            (upper, lower) => ('▀', upper, lower),
        };
        if paper.is_none() && self.paper.is_some() {
            self.lift(text);
        }
        if let Some(ink) = ink.filter(|_| ink != self.ink) {
            escape(text, 38, ink, palette);
        }
        if let Some(paper) = paper.filter(|_| paper != self.paper) {
            escape(text, 48, paper, palette);
        }
        (self.ink, self.paper) = (ink, paper);
        text.push(glyph);
    }

    /// Back to the terminal's own colours.
    pub fn lift(&mut self, text: &mut String) {
        if self.ink.is_some() || self.paper.is_some() {
            *text += "\x1b[0m";
            *self = Self::default();
        }
    }
}

/// Sets a colour; `target` 38 is ink, 48 is paper.
fn escape(text: &mut String, target: u8, [r, g, b]: [u8; 3], palette: Palette) {
    let written = match palette {
        Palette::Indexed => write!(text, "\x1b[{target};5;{}m", indexed([r, g, b])),
        _ => write!(text, "\x1b[{target};2;{r};{g};{b}m"),
    };
    written.expect("a string takes everything");
}

/// The nearest of xterm's colours: of its 24 greys for a grey, else of its 6 × 6 × 6 cube.
fn indexed([r, g, b]: [u8; 3]) -> u8 {
    let level = |value: u8| match value {
        0..48 => 0,
        48..115 => 1,
        value => (value - 35) / 40,
    };
    if r.abs_diff(g).max(g.abs_diff(b)).max(r.abs_diff(b)) < 8 && (4..243).contains(&g) {
        return 232 + (g.saturating_sub(3) / 10).min(23);
    }
    16 + 36 * level(r) + 6 * level(g) + level(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indexed_colours_are_the_nearest() {
        assert_eq!(
            [[0, 0, 0], [8, 8, 8], [128, 128, 128], [255, 0, 0], [95, 135, 175]].map(indexed),
            [16, 232, 244, 196, 67]
        );
    }

    #[test]
    fn glyphs_follow_brightness() {
        assert_eq!(
            (glyph(None, None), glyph(Some([0; 3]), None), glyph(Some([255; 3]), Some([255; 3]))),
            (' ', ' ', '@')
        );
        assert_eq!(glyph(Some([255; 3]), Some([0; 3])), '=');
        assert_eq!(glyph(Some([0, 0, 255]), None), ' ');
        assert_eq!(glyph(Some([0, 255, 0]), None), '#');
    }

    #[test]
    fn colours_are_set_only_where_they_change() {
        let (red, blue) = (Some([255, 0, 0]), Some([0, 0, 255]));
        let mut text = String::new();
        let mut pen = Pen::default();
        for (upper, lower) in [(red, blue), (red, blue), (red, red), (None, red), (None, None)] {
            pen.draw(&mut text, upper, lower, Palette::True);
        }
        pen.lift(&mut text);
        let (ink, paper) = ("\x1b[38;2;255;0;0m", "\x1b[48;2;0;0;255m");
        assert_eq!(text, format!("{ink}{paper}▀▀\x1b[48;2;255;0;0m▀\x1b[0m{ink}▄ \x1b[0m"));
    }
}
