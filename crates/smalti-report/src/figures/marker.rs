//! Markers: one shape for each look.

use maud::{Markup, html};

use super::ink::round;
use crate::groups::{LOOKS, Look};

/// Shapes around 0, 0, all of about the same area.
const SHAPES: [&str; LOOKS] = [
    "M-5 0a5 5 0 1 0 10 0a5 5 0 1 0 -10 0Z",
    "M-4.5 -4.5H4.5V4.5H-4.5Z",
    "M0 -6L5.7 4.2H-5.7Z",
    "M0 -6.3L6.3 0L0 6.3L-6.3 0Z",
    "M0 6L5.7 -4.2H-5.7Z",
    "M-2 -5.6H2V-2H5.6V2H2V5.6H-2V2H-5.6V-2H-2Z",
    "M-2.9 -5L2.9 -5L5.8 0L2.9 5L-2.9 5L-5.8 0Z",
    "M0 -6.6L1.7 -2.2L6.3 -2L2.7 0.9L3.9 5.4L0 2.8L-3.9 5.4L-2.7 0.9L-6.3 -2L-1.7 -2.2Z",
];

/// The marker of a look; hollow for what is biased.
pub(crate) fn marker(look: Look, [x, y]: [f64; 2], hollow: bool) -> Markup {
    let colour = look.colour();
    let fill = if hollow { "#ffffff" } else { colour };
    let kind = if hollow { "hollow" } else { "solid" };
    html! {
        path class={ "marker " (kind) " " (look.class()) } d=(SHAPES[look.shape()])
            transform={ "translate(" (round(x)) " " (round(y)) ")" } fill=(fill) stroke=(colour) stroke-width="1.6" {}
    }
}
