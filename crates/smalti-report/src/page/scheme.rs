//! The colours of the page's two schemes, from those of the figures.

use crate::groups::COLOURS;

/// Style rules that give each look its colour, on a light and on a dark ground.
pub(super) fn colours() -> String {
    let variables = |scheme: usize| -> String {
        COLOURS.iter().enumerate().map(|(index, colours)| format!("--look-{index}:{};", colours[scheme])).collect()
    };
    let rule = |index| format!(".look-{index}{{--look:var(--look-{index})}}");
    let rules: String = (0..COLOURS.len()).map(rule).collect();
    let (light, dark) = (variables(0), variables(1));
    format!(":root{{{light}}}@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}{rules}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::groups::LOOKS;

    /// Relative luminance of `#rrggbb` (WCAG 2).
    fn luminance(colour: &str) -> f64 {
        let level = |at: usize| {
            let value = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
        };
        0.2126 * level(1) + 0.7152 * level(3) + 0.0722 * level(5)
    }

    fn contrast(one: &str, other: &str) -> f64 {
        let (one, other) = (luminance(one), luminance(other));
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    #[test]
    fn every_look_stands_out_from_both_grounds() {
        for [light, dark] in COLOURS {
            assert!(contrast(light, "#ffffff") >= 4.5, "{light}: {}", contrast(light, "#ffffff"));
            assert!(contrast(dark, "#14181b") >= 6.0, "{dark}: {}", contrast(dark, "#14181b"));
        }
    }

    #[test]
    fn every_look_has_a_rule_in_both_schemes() {
        let text = colours();
        assert_eq!(text.matches("{--look:var").count(), LOOKS);
        assert_eq!(text.matches("--look-7:#").count(), 2);
    }
}
