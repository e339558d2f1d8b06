//! The summary of a photon map for people.

use std::fmt::{self, Display, Formatter};

use console::style;

use super::picture::Scale;
use super::ramp;
use super::summary::{FluxRecord, Summary};
use crate::memory::in_words;
use crate::record::{PictureRecord, RunRecord};
use crate::table::{Align, table};

/// The summary as text.
pub fn describe(summary: &Summary) -> String {
    let rows = [
        ("image", image(summary)),
        ("colours", summary.scale.map(|scale| scale.to_string()).unwrap_or_default()),
        ("photons", photons(summary)),
        ("flux", flux(&summary.flux)),
        ("radius", radius(summary)),
        ("time", time(summary)),
        ("memory", summary.peak_bytes.map(|bytes| in_words(bytes) + " at most").unwrap_or_default()),
        ("hash", summary.hash.clone()),
        ("again", summary.reproduce.clone().unwrap_or_default()),
    ];
    let rows = rows.into_iter().filter(|(_, text)| !text.is_empty());
    let lines: Vec<Vec<String>> = rows.map(|(name, text)| vec![style(name).dim().to_string(), text]).collect();
    format!("{}\n{}", style(summary.outputs.join(" ")).bold(), table(&[Align::Left, Align::Left], &lines))
}

fn image(summary: &Summary) -> String {
    let Summary { map, colour, seed, mean, .. } = summary;
    let PictureRecord { width, height, crop, spp, .. } = summary.picture;
    let part = crop.map(|[x, y, w, h]| format!(" at {x},{y},{w},{h}")).unwrap_or_default();
    let mean = match summary.scale {
        Some(scale) => format!("{} {}", rounded(mean[1]), scale.unit),
        None => mean.map(|mean| format!("{mean:.5}")).join(" "),
    };
    format!("{map} map, {colour}, {width}x{height}{part}, {spp} spp, seed {seed}; mean {mean}")
}

fn photons(summary: &Summary) -> String {
    let Summary { photons_emitted: emitted, photons_stored: stored, .. } = summary;
    let lights = match summary.lights.surfaces + summary.lights.points {
        1 => "1 light".to_owned(),
        lights => format!("{lights} lights"),
    };
    format!("{emitted} emitted by {lights}, {stored} stored; the map takes {}", in_words(summary.photon_bytes))
}

fn flux(flux: &FluxRecord) -> String {
    let sum = |channels: [f64; 3]| channels.iter().sum::<f64>();
    let emitted = sum(flux.emitted);
    let share = |part: [f64; 3]| format!("{:.2} %", 100.0 * sum(part) / emitted);
    let [stored, absorbed, escaped] = [flux.stored, flux.absorbed, flux.escaped].map(share);
    let watts = flux.emitted.map(rounded).join(" ");
    format!("{watts} W emitted: {stored} stored, {absorbed} absorbed, {escaped} escaped")
}

fn radius(summary: &Summary) -> String {
    let Some(radius) = &summary.radius_metres else { return String::new() };
    if radius.least == radius.most {
        return format!("{} m", rounded(radius.least));
    }
    format!("{} to {} m, by the density of photons sent ahead", rounded(radius.least), rounded(radius.most))
}

fn time(summary: &Summary) -> String {
    let RunRecord { wall_seconds, setup_seconds, photon_seconds, render_seconds, write_seconds, threads, simd, .. } =
        summary.run;
    let picture = render_seconds - photon_seconds;
    format!(
        "{wall_seconds:.3} s: setup {setup_seconds:.3}, photons {photon_seconds:.3}, picture {picture:.3}, \
         write {write_seconds:.3}; {threads} threads, {simd}"
    )
}

/// In words: `violet 12, blue 120, ... photons/m²`.
impl Display for Scale {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let step = |(place, name): (f64, &str)| format!("{name} {}", rounded(self.figure(place)));
        let kind = if self.logarithmic { ", logarithmic" } else { "" };
        write!(f, "{} {}{kind}; black where there are none", ramp::NAMES.map(step).join(", "), self.unit)
    }
}

/// Three digits that count.
fn rounded(figure: f64) -> String {
    match figure.abs() {
        0.0 => "0".into(),
        size if !(1e-3..1e5).contains(&size) => format!("{figure:.2e}"),
        size => format!("{figure:.*}", (2 - libm::log10(size).floor() as i32).max(0) as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_count() {
        let pairs = [(0.0, "0"), (0.012_345, "0.0123"), (1.0, "1.00"), (251.3, "251"), (99_999.0, "99999")];
        for (figure, text) in pairs {
            assert_eq!(rounded(figure), text);
        }
        assert_eq!((rounded(1.5e7), rounded(2e-9)), ("1.50e7".into(), "2.00e-9".into()));
    }

    #[test]
    fn a_scale_names_its_colours() {
        let scale = Scale { least: 1.0, most: 10_000.0, logarithmic: true, unit: "photons/m²" };
        let expected = "violet 1.00, blue 10.0, teal 100, green 1000, yellow 10000 photons/m², logarithmic; \
                        black where there are none";
        assert_eq!(scale.to_string(), expected);
    }
}
