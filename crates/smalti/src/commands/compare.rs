//! `smalti compare`: how far an image is from a reference.

use std::path::Path;

use serde::Serialize;
use smalti_core::film::Image;
use smalti_image::{Difference, Provenance};
use smalti_measure::{Comparison, PixelDifference};

use crate::args::CompareArgs;
use crate::exit::{Failure, Status};
use crate::print;
use crate::table::{Align, table};

/// Pixels that are listed one by one.
const WORST: usize = 8;

#[derive(Serialize)]
struct Report {
    version: &'static str,
    image: String,
    reference: String,
    width: u32,
    height: u32,
    rmse: f64,
    relmse: f64,
    /// Without the worst 0.1 % of the pixels.
    relmse_trimmed: f64,
    relative_error: Option<f64>,
    mean_ratio: [Option<f64>; 3],
    /// Pixels that are not finite in one of the two, left out of everything above.
    nonfinite_pixels: usize,
    worst: Vec<WorstPixel>,
    /// Thresholds that are exceeded.
    exceeded: Vec<&'static str>,
    output: Option<String>,
    /// The difference that has the brightest colours of the difference picture.
    output_full_scale: Option<f32>,
}

#[derive(Serialize)]
struct WorstPixel {
    x: u32,
    y: u32,
    relmse: f64,
    value: [f32; 3],
    reference: [f32; 3],
}

/// Runs the command.
pub fn run(args: &CompareArgs) -> Result<Status, Failure> {
    if let Some(output) = &args.output {
        smalti_image::check_destination(output).map_err(Failure::user)?;
    }
    let image = smalti_image::read(&args.image).map_err(Failure::user)?;
    let reference = smalti_image::read(&args.reference).map_err(Failure::user)?;
    let comparison = smalti_measure::compare(&image, &reference, WORST).map_err(Failure::user)?;
    let full_scale = args.output.as_ref().map(|output| write_difference(output, &image, &reference)).transpose()?;
    let report = report(args, &image, comparison, full_scale);
    match args.json {
        true => print::json(&report)?,
        false => print::result(&text(&report))?,
    }
    Ok(if report.exceeded.is_empty() { Status::Done } else { Status::CheckFailed })
}

/// Writes where the image is brighter (red, yellow) and darker (blue, cyan) than the reference; returns the difference
/// that has the last of these colours.
fn write_difference(output: &Path, image: &Image, reference: &Image) -> Result<f32, Failure> {
    let scale = smalti_image::difference_scale(image, reference).unwrap_or_default();
    let picture = smalti_image::difference(image, reference, Difference::Signed, scale);
    let picture = picture.ok_or_else(|| Failure::bug("images of one size have no difference"))?;
    let mut provenance = Provenance::new();
    provenance.push("difference_full_scale", scale);
    smalti_image::write(output, &picture, &provenance, 0.0).map_err(Failure::output)?;
    Ok(scale)
}

fn report(args: &CompareArgs, image: &Image, comparison: Comparison, output_full_scale: Option<f32>) -> Report {
    Report {
        version: env!("CARGO_PKG_VERSION"),
        image: args.image.display().to_string(),
        reference: args.reference.display().to_string(),
        width: image.width,
        height: image.height,
        rmse: comparison.rmse,
        relmse: comparison.relmse,
        relmse_trimmed: comparison.relmse_trimmed,
        relative_error: comparison.relative_error,
        mean_ratio: comparison.mean_ratio,
        nonfinite_pixels: comparison.not_finite,
        exceeded: exceeded(args, &comparison),
        worst: comparison.worst.into_iter().filter(|pixel| pixel.relmse > 0.0).map(worst_pixel).collect(),
        output: args.output.as_ref().map(|path| path.display().to_string()),
        output_full_scale,
    }
}

fn worst_pixel(pixel: PixelDifference) -> WorstPixel {
    let PixelDifference { x, y, relmse, value, reference } = pixel;
    WorstPixel { x, y, relmse, value, reference }
}

/// The thresholds that were asked for and are exceeded. Pixels that cannot be compared exceed every threshold.
fn exceeded(args: &CompareArgs, comparison: &Comparison) -> Vec<&'static str> {
    let asked = [("relmse", args.max_relmse, comparison.relmse), ("rmse", args.max_rmse, comparison.rmse)];
    let above = |limit: &Option<f64>, value: f64| limit.is_some_and(|limit| value > limit || comparison.not_finite > 0);
    asked.into_iter().filter(|(_, limit, value)| above(limit, *value)).map(|(name, ..)| name).collect()
}

fn text(report: &Report) -> String {
    let heading = format!("{} against {}, {}x{}\n", report.image, report.reference, report.width, report.height);
    let worst = match report.worst.is_empty() {
        true => "no pixel differs\n".into(),
        false => format!("The worst pixels\n{}", worst_table(&report.worst)),
    };
    format!("{heading}{}\n{worst}", facts(report))
}

fn facts(report: &Report) -> String {
    let ratio = report.mean_ratio.map(|ratio| ratio.map_or("-".into(), |ratio| format!("{ratio:.6}")));
    let facts = [
        ("rmse", Some(format!("{:.6e}", report.rmse))),
        ("relmse", Some(format!("{:.6e}", report.relmse))),
        ("relmse, worst 0.1 % trimmed", Some(format!("{:.6e}", report.relmse_trimmed))),
        ("relative error", report.relative_error.map(|error| format!("{:.4} %", 100.0 * error))),
        ("mean ratio", Some(ratio.join(" "))),
        ("pixels that are not finite", Some(report.nonfinite_pixels).filter(|&n| n > 0).map(|n| n.to_string())),
        ("full scale of the picture", report.output_full_scale.map(|scale| scale.to_string())),
        ("exceeded", Some(report.exceeded.join(", ")).filter(|names| !names.is_empty())),
    ];
    let row = |(name, value): (&str, Option<String>)| Some(vec![name.to_string(), value?]);
    table(&[Align::Left, Align::Left], &facts.into_iter().filter_map(row).collect::<Vec<_>>())
}

fn worst_table(worst: &[WorstPixel]) -> String {
    let mut rows = vec![["x", "y", "relmse", "image", "reference"].map(String::from).to_vec()];
    let triple = |values: [f32; 3]| values.map(|value| format!("{value:>10.6}")).join(" ");
    rows.extend(worst.iter().map(|pixel| {
        let relmse = format!("{:.3e}", pixel.relmse);
        vec![pixel.x.to_string(), pixel.y.to_string(), relmse, triple(pixel.value), triple(pixel.reference)]
    }));
    table(&[Align::Right, Align::Right, Align::Right, Align::Left, Align::Left], &rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(max_relmse: Option<f64>, max_rmse: Option<f64>) -> CompareArgs {
        let (image, reference) = ("a.pfm".into(), "b.pfm".into());
        CompareArgs { image, reference, output: None, max_relmse, max_rmse, json: false }
    }

    fn comparison(values: [f32; 2]) -> Comparison {
        let image = |pixels: [f32; 2]| Image { width: 2, height: 1, pixels: pixels.map(|v| [v; 3]).to_vec() };
        smalti_measure::compare(&image(values), &image([1.0, 1.0]), WORST).unwrap()
    }

    #[test]
    fn thresholds_are_limits_that_may_be_reached() {
        let off = comparison([1.0, 3.0]);
        assert!(exceeded(&args(Some(off.relmse), Some(off.rmse)), &off).is_empty());
        assert_eq!(exceeded(&args(Some(off.relmse * 0.999), Some(off.rmse * 0.999)), &off), ["relmse", "rmse"]);
        assert_eq!(exceeded(&args(None, Some(0.0)), &off), ["rmse"]);
        assert!(exceeded(&args(None, None), &off).is_empty());
    }

    #[test]
    fn what_cannot_be_compared_passes_no_check() {
        let broken = comparison([1.0, f32::NAN]);
        assert_eq!(exceeded(&args(Some(1.0), None), &broken), ["relmse"]);
    }
}
