//! What lines and letters of all figures have in common. Colours stand in the drawing itself, for a figure may leave the
//! page; by the classes a page gives them those of its own scheme.

use maud::{Markup, html};

/// Height of letters.
pub(super) const LETTER: f64 = 12.0;

/// Distance of lines of text.
pub(super) const LINE: f64 = 18.0;

const INK: &str = "#1d2429";
const FAINT: &str = "#dfe4e8";
const STRONG: &str = "#98a3ab";

/// How text stands to its place.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    fn name(self) -> &'static str {
        match self {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        }
    }
}

/// A figure of this size that is called `label`.
pub(super) fn svg(width: f64, height: f64, label: &str, class: &str, content: &Markup) -> Markup {
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (round(width)) " " (round(height)) }
            width=(round(width)) height=(round(height)) class=(class) role="group" aria-label=(label)
            font-family="system-ui, 'Segoe UI', Helvetica, Arial, sans-serif" font-size=(LETTER) {
            (content)
        }
    }
}

pub(super) fn text(x: f64, y: f64, anchor: Anchor, content: &str) -> Markup {
    html! {
        text class="ink" x=(round(x)) y=(round(y)) text-anchor=(anchor.name()) fill=(INK) { (content) }
    }
}

/// Text that is read from bottom to top.
pub(super) fn upright(x: f64, y: f64, content: &str) -> Markup {
    html! {
        text class="ink" transform={ "translate(" (round(x)) " " (round(y)) ") rotate(-90)" }
            text-anchor="middle" fill=(INK) { (content) }
    }
}

pub(super) fn faint_line(from: [f64; 2], to: [f64; 2]) -> Markup {
    line(from, to, "faint", FAINT)
}

pub(super) fn strong_line(from: [f64; 2], to: [f64; 2]) -> Markup {
    line(from, to, "strong", STRONG)
}

fn line([x1, y1]: [f64; 2], [x2, y2]: [f64; 2], class: &str, colour: &str) -> Markup {
    html! {
        line class=(class) x1=(round(x1)) y1=(round(y1)) x2=(round(x2)) y2=(round(y2)) stroke=(colour) {}
    }
}

/// A coordinate to a tenth of a pixel, as short as can be.
pub(super) fn round(value: f64) -> String {
    let text = format!("{value:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Points as `x,y x,y`.
pub(super) fn points(points: &[[f64; 2]]) -> String {
    points.iter().map(|[x, y]| format!("{},{}", round(*x), round(*y))).collect::<Vec<_>>().join(" ")
}

/// About how wide text is.
pub(super) fn text_width(text: &str) -> f64 {
    0.56 * LETTER * text.chars().count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short() {
        assert_eq!(points(&[[1.0, 2.25], [-0.04, 100.96]]), "1,2.2 -0,101");
    }

    #[test]
    fn text_cannot_become_markup() {
        let drawn = text(0.0, 0.0, Anchor::Start, "<b>&\"").into_string();
        assert!(drawn.contains("&lt;b&gt;&amp;&quot;") && !drawn.contains("<b>"), "{drawn}");
    }
}
