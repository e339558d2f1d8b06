//! `smalti compare`: how far an image is from a reference.

use std::path::Path;

use serde::Serialize;
use smalti_image::{Aligned, Difference, Provenance, Window, Windows};
use smalti_measure::{CompareError, Comparison, NotFinite, NotFinitePixel, PixelDifference};

use crate::args::CompareArgs;
use crate::exit::{Failure, Status};
use crate::print::{self, Messages};
use crate::table::{Align, table};

/// Pixels that are listed one by one.
const WORST: usize = 8;

/// The account of a comparison; its field names are a promise, `smalti compare --help` lists them.
#[derive(Serialize)]
struct Report {
    version: &'static str,
    image: String,
    reference: String,
    /// Size of what was compared.
    width: u32,
    height: u32,
    /// Where that lies, if the files do not say that it is all of both.
    part: Option<Part>,
    /// How the files were read and placed, in words.
    notes: Vec<String>,
    /// Metrics of the pixels that are finite in both; null if there is none.
    rmse: Option<f64>,
    relmse: Option<f64>,
    /// Without the worst 0.1 % of the pixels.
    relmse_trimmed: Option<f64>,
    relative_error: Option<f64>,
    mean_ratio: [Option<f64>; 3],
    /// Pixels that are not finite in one of the two, left out of everything above.
    nonfinite_pixels: usize,
    nonfinite_image: usize,
    nonfinite_reference: usize,
    nonfinite_both: usize,
    /// Pixels that are not finite and the same in both; any other makes the check fail.
    nonfinite_alike: usize,
    /// Pixels that are not finite and not the same first.
    worst: Vec<WorstPixel>,
    /// Thresholds that are exceeded.
    exceeded: Vec<&'static str>,
    output: Option<String>,
    /// The difference that has the brightest colours of the difference picture.
    output_full_scale: Option<f32>,
}

#[derive(Clone, Copy, Serialize)]
struct Part {
    x: i32,
    y: i32,
    width: u32,
    height: u32,
}

#[derive(Serialize)]
struct WorstPixel {
    x: i64,
    y: i64,
    /// Null where a value is not finite.
    relmse: Option<f64>,
    value: [f32; 3],
    reference: [f32; 3],
    /// `image`, `reference` or `both`, whichever is not finite.
    nonfinite: Option<&'static str>,
}

/// All that is found of two images that lie on each other.
struct Found {
    /// `None` if no pixel is finite in both.
    comparison: Option<Comparison>,
    not_finite: NotFinite,
}

/// Runs the command.
pub fn run(args: &CompareArgs) -> Result<Status, Failure> {
    if let Some(output) = &args.output {
        smalti_image::check_destination(output).map_err(Failure::user)?;
    }
    let image = smalti_image::read_picture(&args.image).map_err(Failure::user)?;
    let reference = smalti_image::read_picture(&args.reference).map_err(Failure::user)?;
    let mut notes = image.named_notes(&args.image);
    notes.extend(reference.named_notes(&args.reference));
    let aligned = smalti_image::align(image, reference).map_err(Failure::user)?;
    notes.extend(aligned.note.clone());
    notes.iter().for_each(|note| Messages { json: false }.note(note));
    let found = find(&aligned)?;
    let full_scale = args.output.as_ref().map(|output| write_difference(output, &aligned)).transpose()?;
    let report = report(args, (&aligned, notes), found, full_scale);
    match args.json {
        true => print::json(&report)?,
        false => print::result(&text(&report))?,
    }
    let is_good = report.exceeded.is_empty() && report.nonfinite_pixels == report.nonfinite_alike;
    Ok(if is_good { Status::Done } else { Status::CheckFailed })
}

fn find(Aligned { image, reference, .. }: &Aligned) -> Result<Found, Failure> {
    let comparison = match smalti_measure::compare(image, reference, WORST) {
        Ok(comparison) => Some(comparison),
        Err(CompareError::NothingFinite) => None,
        Err(error @ CompareError::Sizes { .. }) => return Err(Failure::bug(error)),
    };
    Ok(Found { comparison, not_finite: smalti_measure::not_finite(image, reference, WORST) })
}

/// Writes where the image is brighter (red, yellow) and darker (blue, cyan) than the reference; returns the difference
/// that has the last of these colours.
fn write_difference(output: &Path, aligned: &Aligned) -> Result<f32, Failure> {
    let Aligned { image, reference, window, display, .. } = aligned;
    let scale = smalti_image::difference_scale(image, reference).unwrap_or_default();
    let picture = smalti_image::difference(image, reference, Difference::Signed, scale);
    let picture = picture.ok_or_else(|| Failure::bug("images of one size have no difference"))?;
    let mut provenance = Provenance::new();
    provenance.push("difference_full_scale", scale);
    let windows = Windows { data: *window, display: *display };
    smalti_image::write_part(output, &picture, windows, &provenance, 0.0).map_err(Failure::output)?;
    Ok(scale)
}

fn report(
    args: &CompareArgs,
    (aligned, notes): (&Aligned, Vec<String>),
    Found { comparison, not_finite }: Found,
    output_full_scale: Option<f32>,
) -> Report {
    let of = |metric: fn(&Comparison) -> f64| comparison.as_ref().map(metric);
    Report {
        version: env!("CARGO_PKG_VERSION"),
        image: args.image.display().to_string(),
        reference: args.reference.display().to_string(),
        width: aligned.window.width,
        height: aligned.window.height,
        part: aligned.note.as_ref().map(|_| part(aligned.window)),
        notes,
        rmse: of(|found| found.rmse),
        relmse: of(|found| found.relmse),
        relmse_trimmed: of(|found| found.relmse_trimmed),
        relative_error: comparison.as_ref().and_then(|found| found.relative_error),
        mean_ratio: comparison.as_ref().map_or([None; 3], |found| found.mean_ratio),
        nonfinite_pixels: not_finite.either,
        nonfinite_image: not_finite.image,
        nonfinite_reference: not_finite.reference,
        nonfinite_both: not_finite.both,
        nonfinite_alike: not_finite.alike,
        exceeded: exceeded(args, comparison.as_ref(), &not_finite),
        worst: worst(comparison, not_finite, aligned.window),
        output: args.output.as_ref().map(|path| path.display().to_string()),
        output_full_scale,
    }
}

fn part(Window { x, y, width, height }: Window) -> Part {
    Part { x, y, width, height }
}

/// Pixels that are not finite and differ, then those that are and differ most.
fn worst(comparison: Option<Comparison>, not_finite: NotFinite, window: Window) -> Vec<WorstPixel> {
    let finite = comparison.map_or(Vec::new(), |found| found.worst).into_iter().filter(|pixel| pixel.relmse > 0.0);
    let pixels = not_finite.first.into_iter().map(broken_pixel).chain(finite.map(worst_pixel)).take(WORST);
    pixels
        .map(|pixel| WorstPixel { x: pixel.x + i64::from(window.x), y: pixel.y + i64::from(window.y), ..pixel })
        .collect()
}

fn worst_pixel(pixel: PixelDifference) -> WorstPixel {
    let PixelDifference { x, y, relmse, value, reference } = pixel;
    WorstPixel { x: x.into(), y: y.into(), relmse: Some(relmse), value, reference, nonfinite: None }
}

fn broken_pixel(pixel: NotFinitePixel) -> WorstPixel {
    let NotFinitePixel { x, y, value, reference } = pixel;
    let is_finite = |values: [f32; 3]| values.iter().all(|value| value.is_finite());
    let which = match (is_finite(value), is_finite(reference)) {
        (false, false) => "both",
        (false, true) => "image",
        (true, _) => "reference",
    };
    WorstPixel { x: x.into(), y: y.into(), relmse: None, value, reference, nonfinite: Some(which) }
}

/// The thresholds that were asked for and are exceeded. Pixels that cannot be compared exceed every threshold.
fn exceeded(args: &CompareArgs, comparison: Option<&Comparison>, not_finite: &NotFinite) -> Vec<&'static str> {
    let asked = [
        ("relmse", args.max_relmse, comparison.map(|found| found.relmse)),
        ("rmse", args.max_rmse, comparison.map(|found| found.rmse)),
    ];
    let above = |limit: f64, value: Option<f64>| not_finite.unlike() > 0 || value.is_none_or(|value| value > limit);
    let is_exceeded = |(_, limit, value): &(_, Option<f64>, _)| limit.is_some_and(|limit| above(limit, *value));
    asked.into_iter().filter(is_exceeded).map(|(name, ..)| name).collect()
}

fn text(report: &Report) -> String {
    let heading = format!("{} against {}, {}x{}\n", report.image, report.reference, report.width, report.height);
    let worst = match report.worst.is_empty() {
        true => agreement(report),
        false => format!("The worst pixels\n{}", worst_table(&report.worst)),
    };
    format!("{heading}{}\n{worst}", facts(report))
}

/// How images agree of which no pixel differs.
fn agreement(report: &Report) -> String {
    match report.nonfinite_alike {
        0 => "no pixel differs\n".into(),
        count => format!("no pixel differs; {} alike in both\n", are_not_finite(count)),
    }
}

fn are_not_finite(count: usize) -> String {
    if count == 1 { "1 pixel is not finite,".into() } else { format!("{count} pixels are not finite,") }
}

/// How many pixels are not finite, where, and what that means for the rest.
fn not_finite(report: &Report) -> Option<String> {
    let Report { nonfinite_pixels: all, nonfinite_alike: alike, .. } = *report;
    let places = format!(
        "{all} ({} in the image, {} in the reference, {} in both)",
        report.nonfinite_image, report.nonfinite_reference, report.nonfinite_both
    );
    let verdict = match alike {
        _ if all == alike => "alike in both",
        0 => "none alike: the check fails",
        _ => "not all alike: the check fails",
    };
    let rest = if report.rmse.is_some() { "the metrics are of the others" } else { "no other, hence no metrics" };
    (all > 0).then(|| format!("{places}, {verdict}; {rest}"))
}

fn facts(report: &Report) -> String {
    let ratio = report.mean_ratio.map(|ratio| ratio.map_or("-".into(), |ratio| format!("{ratio:.6}")));
    let metric = |value: Option<f64>| value.map(|value| format!("{value:.6e}"));
    let facts = [
        ("part", report.part.map(|Part { x, y, width, height }| format!("{width}x{height} pixels at {x},{y}"))),
        ("rmse", metric(report.rmse)),
        ("relmse", metric(report.relmse)),
        ("relmse, worst 0.1 % trimmed", metric(report.relmse_trimmed)),
        ("relative error", report.relative_error.map(|error| format!("{:.4} %", 100.0 * error))),
        ("mean ratio", report.rmse.map(|_| ratio.join(" "))),
        ("pixels that are not finite", not_finite(report)),
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
        let relmse = pixel.relmse.map_or("-".into(), |relmse| format!("{relmse:.3e}"));
        vec![pixel.x.to_string(), pixel.y.to_string(), relmse, triple(pixel.value), triple(pixel.reference)]
    }));
    table(&[Align::Right, Align::Right, Align::Right, Align::Left, Align::Left], &rows)
}

#[cfg(test)]
mod tests {
    use smalti_core::film::Image;
    use smalti_image::Picture;

    use super::*;

    fn args(max_relmse: Option<f64>, max_rmse: Option<f64>) -> CompareArgs {
        let (image, reference) = ("a.pfm".into(), "b.pfm".into());
        CompareArgs { image, reference, output: None, max_relmse, max_rmse, json: false }
    }

    fn row(values: &[f32]) -> Image {
        Image { width: values.len() as u32, height: 1, pixels: values.iter().map(|&v| [v; 3]).collect() }
    }

    fn aligned(image: &[f32], reference: &[f32]) -> Aligned {
        smalti_image::align(row(image).into(), row(reference).into()).unwrap()
    }

    fn of(args: &CompareArgs, image: &[f32], reference: &[f32]) -> Report {
        let aligned = aligned(image, reference);
        report(args, (&aligned, Vec::new()), find(&aligned).unwrap(), None)
    }

    const NAN: f32 = f32::NAN;
    const INF: f32 = f32::INFINITY;

    #[test]
    fn thresholds_are_limits_that_may_be_reached() {
        let values: (&[f32], &[f32]) = (&[1.0, 3.0], &[1.0, 1.0]);
        let Report { relmse, rmse, .. } = of(&args(None, None), values.0, values.1);
        let exceeded = |factor: f64| {
            of(&args(relmse.map(|limit| limit * factor), rmse.map(|limit| limit * factor)), values.0, values.1).exceeded
        };
        assert!(exceeded(1.0).is_empty());
        assert_eq!(exceeded(0.999), ["relmse", "rmse"]);
        assert_eq!(of(&args(None, Some(0.0)), values.0, values.1).exceeded, ["rmse"]);
        assert!(of(&args(None, None), values.0, values.1).exceeded.is_empty());
    }

    #[test]
    fn what_cannot_be_compared_passes_no_check() {
        let exceeded = |image: &[f32], reference: &[f32]| of(&args(Some(1.0), None), image, reference).exceeded;
        assert_eq!(exceeded(&[1.0, NAN], &[1.0, 1.0]), ["relmse"]);
        assert_eq!(exceeded(&[1.0, INF], &[1.0, NAN]), ["relmse"]);
        assert_eq!(exceeded(&[NAN], &[NAN]), ["relmse"]);
        assert!(exceeded(&[1.0, NAN], &[1.0, NAN]).is_empty());
    }

    #[test]
    fn pixels_that_are_not_finite_are_told() {
        let found = of(&args(None, None), &[1.0, NAN, 3.0, INF, INF], &[1.0, 2.0, 2.0, INF, NAN]);
        let text = text(&found);
        let counts = "3 (3 in the image, 2 in the reference, 2 in both), not all alike: the check fails";
        assert!(text.contains(&format!("{counts}; the metrics are of the others")), "{text}");
        assert!(!text.contains("no pixel differs") && text.contains("NaN"), "{text}");
        let worst: Vec<_> = found.worst.iter().map(|pixel| (pixel.x, pixel.nonfinite)).collect();
        assert_eq!(worst, [(1, Some("image")), (4, Some("both")), (2, None)]);
        // The one finite pixel that differs: 1 / 2 pixels.
        assert!((found.rmse.unwrap() - 0.5f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn pixels_that_are_not_finite_alike_are_told_too() {
        let found = text(&of(&args(None, None), &[1.0, NAN, INF], &[1.0, NAN, INF]));
        assert!(found.ends_with("no pixel differs; 2 pixels are not finite, alike in both\n"), "{found}");
        let found = text(&of(&args(None, None), &[NAN], &[NAN]));
        assert!(found.contains("alike in both; no other, hence no metrics") && !found.contains("rmse"), "{found}");
        assert!(text(&of(&args(None, None), &[1.0], &[1.0])).ends_with("no pixel differs\n"));
    }

    #[test]
    fn a_part_keeps_the_coordinates_of_the_picture() {
        let display = Window { x: 0, y: 0, width: 3, height: 1 };
        let windows = Windows { data: Window { x: 1, y: 0, width: 2, height: 1 }, display };
        let crop = Picture { windows: Some(windows), ..row(&[2.0, 5.0]).into() };
        let aligned = smalti_image::align(crop, row(&[1.0, 2.0, 3.0]).into()).unwrap();
        let found = report(&args(None, None), (&aligned, Vec::new()), find(&aligned).unwrap(), None);
        assert_eq!((found.width, found.worst.len(), found.worst[0].x), (2, 1, 2));
        assert!(text(&found).contains("2x1 pixels at 1,0"), "{}", text(&found));
    }
}
