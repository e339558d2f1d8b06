//! The summary of a render for people: a few lines that say what was made, how long it took and how good it is.

use console::style;
use smalti_measure::{BiasStatement, ErrorStatement};

use crate::error_statement::SAMPLES_NEEDED;
use crate::memory::in_words;
use crate::quality::QualityRecord;
use crate::summary::Summary;
use crate::table::{Align, table};

/// The summary as text.
pub fn describe(summary: &Summary) -> String {
    let rows = [
        ("image", image(summary)),
        ("error", error(summary)),
        ("quality", summary.quality.as_ref().map(|of| quality(of, summary)).unwrap_or_default()),
        ("radius", summary.bias.as_ref().map(radius).unwrap_or_default()),
        ("time", time(summary)),
        ("rays", rays(summary)),
        ("photons", photons(summary)),
        ("memory", summary.peak_bytes.map(|bytes| in_words(bytes) + " at most").unwrap_or_default()),
        ("hash", summary.hash.clone()),
        ("again", summary.reproduce.clone().unwrap_or_default()),
    ];
    let mut lines: Vec<(&str, String)> = rows.into_iter().filter(|(_, text)| !text.is_empty()).collect();
    let after_error = lines.iter().position(|(name, _)| *name == "error").map_or(0, |error| error + 1);
    let biases = summary.biases.iter().map(|bias| ("bias", bias.clone()));
    let missed = summary.shortfalls.iter().map(|shortfall| ("missed", shortfall.clone()));
    lines.splice(after_error..after_error, biases.chain(missed));
    let lines: Vec<Vec<String>> = lines.into_iter().map(|(name, text)| vec![heading(name), text]).collect();
    format!("{}\n{}", style(summary.outputs.join(" ")).bold(), table(&[Align::Left, Align::Left], &lines))
}

fn heading(name: &str) -> String {
    style(name).dim().to_string()
}

fn image(summary: &Summary) -> String {
    let settings = &summary.settings;
    let [red, green, blue] = summary.mean;
    let (least, most) = (summary.samples_least, summary.samples_most);
    let spp = if least == most { least.to_string() } else { format!("{least} to {most}") };
    format!("{settings}, {spp} spp; mean {red:.5} {green:.5} {blue:.5}")
}

fn error(summary: &Summary) -> String {
    match &summary.error {
        Some(error) => stated(error),
        None => {
            format!("unknown: it takes {SAMPLES_NEEDED} samples a pixel to tell, there are {}", summary.samples_least)
        }
    }
}

fn stated(error: &ErrorStatement) -> String {
    let low = percent(error.relative_error_low);
    let range = match error.relative_error_high {
        Some(high) => format!("{low} to {}", percent(high)),
        None => format!("at least {low}"),
    };
    let uncertified = match error.uncertified_pixels {
        0 => String::new(),
        1 => "; 1 pixel is too uncertain to judge".into(),
        pixels => format!("; {pixels} pixels are too uncertain to judge"),
    };
    format!("{} ({range}), relmse {:.3e}{uncertified}", percent(error.relative_error), error.relmse)
}

/// What `--quality` chose and why, what it expected and what came of it.
fn quality(record: &QualityRecord, summary: &Summary) -> String {
    let QualityRecord { name, target_error, gain, pilots, .. } = record;
    let adaptive = if summary.settings.adaptive { "on" } else { "off" };
    let gain = match gain {
        Some(gain) if *gain > 1.0 => format!("{gain:.2} times less error² × cost than the scene's own settings"),
        Some(_) => "the scene's own settings, which had the least error² × cost".into(),
        None => "nothing could be told".into(),
    };
    let more = if record.certain { "" } else { " or more" };
    let expected = record.expected_error.zip(record.expected_spp);
    let expected = expected.map(|(error, spp)| format!("expected {}{more} at {spp} spp, ", percent(error)));
    let got = summary.error.as_ref().map_or("unknown".into(), |error| percent(error.relative_error));
    format!(
        "{name} ({}): shadow rays {}, adaptive {adaptive}; of {} short renders {gain}; {}got {got} at {} spp",
        percent(*target_error),
        summary.settings.shadow_rays,
        pilots.len(),
        expected.unwrap_or_default(),
        summary.settings.picture.spp,
    )
}

/// What photon radii add.
fn radius(bias: &BiasStatement) -> String {
    let BiasStatement { relative_bias, relative_bias_high, brightness } = bias;
    let (likely, most) = (percent(*relative_bias), percent(*relative_bias_high));
    format!("bias by photon radii {likely} (at most {most}); brightness {:+.3} %", 100.0 * brightness)
}

/// A share in percent.
pub fn percent(share: f64) -> String {
    format!("{:.3} %", 100.0 * share)
}

fn time(summary: &Summary) -> String {
    format!(
        "{:.3} s: setup {:.3}, render {:.3}, write {:.3}; {} threads, {}",
        summary.run.wall_seconds,
        summary.run.setup_seconds,
        summary.run.render_seconds,
        summary.run.write_seconds,
        summary.run.threads,
        summary.run.simd
    )
}

fn rays(summary: &Summary) -> String {
    let rays = &summary.rays;
    let per_second = rays.all() as f64 / summary.run.render_seconds;
    let speed = if per_second.is_finite() { format!("{:.1} M a second; ", per_second / 1e6) } else { String::new() };
    let length = summary.mean_path_length.map(|length| format!("; mean path length {length:.2}")).unwrap_or_default();
    format!("{speed}{} camera, {} scattered, {} shadow{length}", rays.camera, rays.scattered, rays.shadow)
}

fn photons(summary: &Summary) -> String {
    let Summary { photons_emitted: emitted, photons_stored: stored, photon_bytes, .. } = summary;
    let photon_seconds = summary.run.photon_seconds;
    let size = in_words(*photon_bytes);
    match (emitted, stored) {
        (0, 0) => String::new(),
        (0, _) => format!("{stored} read in {photon_seconds:.3} s; a round takes {size}"),
        _ => format!("{emitted} emitted, {stored} stored in {photon_seconds:.3} s; a round takes {size}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_without_an_upper_end_are_lower_bounds() {
        let error = ErrorStatement {
            relmse: 0.01,
            relmse_low: 0.005,
            relmse_high: None,
            relative_error: 0.1,
            relative_error_low: 0.08,
            relative_error_high: None,
            uncertified_pixels: 3,
        };
        let expected = "10.000 % (at least 8.000 %), relmse 1.000e-2; 3 pixels are too uncertain to judge";
        assert_eq!(stated(&error), expected);
        let known = ErrorStatement { relative_error_high: Some(0.12), uncertified_pixels: 0, ..error };
        assert_eq!(stated(&known), "10.000 % (8.000 % to 12.000 %), relmse 1.000e-2");
    }
}
