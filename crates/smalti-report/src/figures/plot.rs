//! The area of a plot with two logarithmic axes: where a value stands, ticks, lines, titles.

use maud::{Markup, html};

use super::ink::{Anchor, faint_line, strong_line, text, upright};
use crate::axis::{Axis, Tick};
use crate::numbers::significant;

/// Room beside the area for labels, and its height by its width within bounds.
const LEFT: f64 = 66.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 46.0;
const ASPECT: f64 = 0.56;
const LOWEST: f64 = 300.0;

/// The area between two axes.
pub(super) struct Plot {
    pub x: Axis,
    pub y: Axis,
    width: f64,
    height: f64,
}

impl Plot {
    /// A plot so wide, labels included.
    pub fn new(x: Axis, y: Axis, width: f64) -> Self {
        Self { x, y, width, height: (ASPECT * width).max(LOWEST) }
    }

    /// Its height, labels included.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// Where the values stand; what cannot be shown stands at the edge.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (across, up) = (self.width - LEFT - RIGHT, self.height - TOP - BOTTOM);
        [LEFT + self.x.place(x) * across, TOP + (1.0 - self.y.place(y)) * up]
    }

    /// Lines, labels and titles.
    pub fn frame(&self, titles: [&str; 2]) -> Markup {
        let [left, bottom] = self.place([0.0, 0.0]);
        let [right, top] = [self.width - RIGHT, TOP];
        let middle = [(left + right) / 2.0, (top + bottom) / 2.0];
        html! {
            @for tick in self.x.ticks() { (self.tick_below(tick)) }
            @for tick in self.y.ticks() { (self.tick_beside(tick)) }
            (strong_line([left, bottom], [right, bottom]))
            (strong_line([left, top], [left, bottom]))
            (text(middle[0], self.height - 6.0, Anchor::Middle, titles[0]))
            (upright(14.0, middle[1], titles[1]))
        }
    }

    fn tick_below(&self, Tick { value, labelled }: Tick) -> Markup {
        let [x, bottom] = self.place([value, 0.0]);
        html! {
            @if labelled {
                (faint_line([x, TOP], [x, bottom]))
                (text(x, bottom + 18.0, Anchor::Middle, &label(value)))
            }
            (strong_line([x, bottom], [x, bottom + if labelled { 5.0 } else { 3.0 }]))
        }
    }

    fn tick_beside(&self, Tick { value, labelled }: Tick) -> Markup {
        let [left, y] = self.place([0.0, value]);
        html! {
            @if labelled {
                (faint_line([left, y], [self.width - RIGHT, y]))
                (text(left - 8.0, y + 4.0, Anchor::End, &label(value)))
            }
            (strong_line([left - if labelled { 5.0 } else { 3.0 }, y], [left, y]))
        }
    }
}

/// A tick's value; it has one digit.
pub(super) fn label(value: f64) -> String {
    significant(value, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_the_axes_are_corners_of_the_area() {
        let axis = Axis { low: 0.1, high: 10.0 };
        let plot = Plot::new(axis, axis, 580.0);
        assert_eq!(plot.place([0.1, 0.1]), [66.0, plot.height() - 46.0]);
        assert_eq!(plot.place([10.0, 10.0]), [566.0, 14.0]);
        assert_eq!(plot.place([1.0, 0.0])[0], 316.0);
    }

    #[test]
    fn every_labelled_tick_has_its_value() {
        let axis = Axis { low: 0.1, high: 10.0 };
        let frame = Plot::new(axis, axis, 500.0).frame(["seconds", "error"]).into_string();
        for label in [">0.1<", ">0.2<", ">1<", ">5<", ">10<", ">seconds<", ">error<"] {
            assert!(frame.contains(label), "{label}");
        }
    }
}
