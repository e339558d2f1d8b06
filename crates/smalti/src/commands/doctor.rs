//! `smalti doctor`: a scene at its numerical extremes, or the hunt for the first value that cannot be.

use std::mem::take;
use std::sync::atomic::AtomicU64;

use console::style;
use rayon::prelude::*;
use serde::Serialize;
use smalti_core::film::ROUND;
use smalti_core::hunt::Impossible;
use smalti_core::photon::maps::Pilots;
use smalti_core::render::Renderer;
use smalti_core::settings::{Rect, Settings};
use smalti_doctor::{Finding, Patient, Verdict, examine};

use super::pixel;
use crate::args::{DoctorArgs, ImageArgs};
use crate::exit::{Failure, Status};
use crate::frontend::{self, Mode};
use crate::job::Job;
use crate::print::{self, Messages};
use crate::record::{self, Subject};

/// The longer side of the pictures, where `--size` does not say otherwise.
const SIDE: u32 = 64;

/// Samples of a pixel, where `--spp` does not say otherwise: enough for an error statement.
const SAMPLES: u32 = 2 * ROUND;

/// Side of what a worker hunts through at a time.
const AT_ONCE: u32 = 32;

#[derive(Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    subject: Subject<'a>,
    simd: &'static str,
    failed: usize,
    warnings: usize,
    findings: &'a [Finding],
}

/// The first value that cannot be.
#[derive(Serialize)]
struct Hunted<'a> {
    #[serde(flatten)]
    subject: Subject<'a>,
    /// Null if there is none.
    impossible: Option<Found>,
}

#[derive(Serialize)]
struct Found {
    stage: String,
    bounce: u32,
    pixel: [u32; 2],
    sample: u32,
    what: &'static str,
    /// As text: what is not finite is no number of JSON.
    value: [String; 3],
    /// The rays of the sample.
    replay: Vec<pixel::VertexRecord>,
}

/// Runs the command.
pub fn run(args: &DoctorArgs) -> Result<Status, Failure> {
    let job = frontend::set_up(Mode::of_terminal(), |told| Job::load(&args.scene, &args.image, args.simd.simd, told))?;
    Messages { json: false }.notes(&job.notes, args.quiet);
    if args.hunt { hunt(args, &job) } else { examination(args, job) }
}

fn examination(args: &DoctorArgs, mut job: Job) -> Result<Status, Failure> {
    job.settings = small(job.settings, &args.image);
    let pool = smalti_scheduler::pool(args.threads as usize).map_err(Failure::user)?;
    let patient = Patient { world: &job.world, settings: &job.settings, level: job.level };
    let mut findings = Vec::new();
    let mut told = Ok(());
    examine(patient, &pool, |finding| {
        if !args.json && (!args.quiet || finding.verdict != Verdict::Sound) && told.is_ok() {
            told = print::result(&line(&finding));
        }
        findings.push(finding);
    })
    .map_err(Failure::user)?;
    told?;
    let count = |verdict: Verdict| findings.iter().filter(|finding| finding.verdict == verdict).count();
    let (failed, warnings) = (count(Verdict::Failed), count(Verdict::Warning));
    match args.json {
        true => print::json(&report(&job, &findings, (failed, warnings)))?,
        false if args.quiet && failed + warnings == 0 => {}
        false => print::result(&verdict(findings.len(), failed, warnings))?,
    }
    Ok(if failed == 0 { Status::Done } else { Status::CheckFailed })
}

/// The settings of pictures that are rendered some two hundred times.
fn small(settings: Settings, typed: &ImageArgs) -> Settings {
    let spp = typed.spp.unwrap_or(SAMPLES);
    if typed.size.is_some() {
        return Settings { spp, adaptive: false, ..settings };
    }
    let Rect { width, height, .. } = settings.area();
    let by = width.max(height).div_ceil(SIDE).max(1);
    let (width, height) = ((settings.width / by).max(1), (settings.height / by).max(1));
    Settings { width, height, crop: None, spp, adaptive: false, ..settings }
}

fn report<'a>(job: &'a Job, findings: &'a [Finding], (failed, warnings): (usize, usize)) -> Report<'a> {
    Report { subject: record::subject(job), simd: job.level.name(), failed, warnings, findings }
}

fn line(finding: &Finding) -> String {
    let verdict = match finding.verdict {
        Verdict::Sound => style("sound  ").green(),
        Verdict::Warning => style("warning").yellow(),
        Verdict::Failed => style("FAILED ").red().bold(),
    };
    format!("  {verdict}  {:<9} {:<24} {}\n", finding.check, finding.case, finding.says)
}

fn verdict(checks: usize, failed: usize, warnings: usize) -> String {
    let warnings = match warnings {
        0 => "no warnings".to_owned(),
        1 => "1 warning".to_owned(),
        many => format!("{many} warnings"),
    };
    match failed {
        0 => format!("{checks} checks: none failed, {warnings}\n"),
        _ => format!("{checks} checks: {failed} failed, {warnings}\n"),
    }
}

/// Looks at every value of every stage of the whole render.
fn hunt(args: &DoctorArgs, job: &Job) -> Result<Status, Failure> {
    let pool = smalti_scheduler::pool(args.threads as usize).map_err(Failure::user)?;
    let renderer = frontend::set_up(Mode::of_terminal(), |told| pool.install(|| job.renderer(told)))?;
    let found = pool.install(|| first_impossible(&renderer));
    let replay = |found: &Impossible| pixel::replayed(&renderer, found.pixel, found.sample);
    let none = format!("{} samples: every value is finite, and none is negative\n", samples(&job.settings));
    match (args.json, &found) {
        (true, _) => print::json(&Hunted {
            subject: record::subject(job),
            impossible: found.as_ref().map(|found| Found {
                stage: found.stage.clone(),
                bounce: found.bounce,
                pixel: found.pixel.into(),
                sample: found.sample,
                what: found.what,
                value: found.value.map(|value| value.to_string()),
                replay: replay(found),
            }),
        })?,
        (false, None) if args.quiet => {}
        (false, None) => print::result(&none)?,
        (false, Some(found)) => print::result(&described(found, &replay(found)))?,
    }
    Ok(if found.is_none() { Status::Done } else { Status::CheckFailed })
}

fn samples(settings: &Settings) -> u64 {
    settings.area().pixels() as u64 * u64::from(settings.spp)
}

fn described(found: &Impossible, replay: &[pixel::VertexRecord]) -> String {
    let Impossible { stage, bounce, pixel: (x, y), sample, what, value: [a, b, c] } = found;
    let heading =
        format!("pixel {x} {y}, sample {sample}: after {bounce} bounces, stage {stage}: {what} {a} {b} {c}\n");
    heading + &pixel::vertex_table(replay)
}

/// The first one, in the order of rounds and of places in the image.
fn first_impossible(renderer: &Renderer) -> Option<Impossible> {
    let settings = renderer.settings();
    let areas = areas(settings.area());
    let mut pilots = Pilots::default();
    (0..settings.spp.div_ceil(ROUND)).find_map(|round| {
        let maps = renderer.maps(round, take(&mut pilots), &AtomicU64::new(0));
        pilots = maps.pilots();
        let samples = round * ROUND..settings.spp.min((round + 1) * ROUND);
        let look = |area: &Rect| renderer.hunt(*area, samples.clone(), &maps, &mut renderer.workspace());
        areas.par_iter().find_map_first(look)
    })
}

fn areas(whole: Rect) -> Vec<Rect> {
    let starts = |from: u32, length: u32| (from..from + length).step_by(AT_ONCE as usize);
    let rows = starts(whole.y, whole.height).flat_map(|y| starts(whole.x, whole.width).map(move |x| (x, y)));
    let (right, bottom) = (whole.x + whole.width, whole.y + whole.height);
    rows.map(|(x, y)| Rect { x, y, width: AT_ONCE.min(right - x), height: AT_ONCE.min(bottom - y) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse::Size;

    #[test]
    fn pictures_are_small_unless_their_size_is_typed() {
        let settings = Settings { width: 800, height: 200, spp: 5, ..Settings::default() };
        let of = |typed: &ImageArgs| {
            let small = small(settings.clone(), typed);
            (small.width, small.height, small.spp)
        };
        assert_eq!(of(&ImageArgs::default()), (61, 15, 32));
        let size = Some(Size { width: 3, height: 2 });
        let typed = Settings { width: 3, height: 2, ..settings.clone() };
        let small = small(typed, &ImageArgs { size, spp: Some(7), ..ImageArgs::default() });
        assert_eq!((small.width, small.height, small.spp), (3, 2, 7));
    }

    #[test]
    fn a_hunt_goes_through_every_pixel_once() {
        let whole = Rect { x: 3, y: 5, width: 70, height: 33 };
        let areas = areas(whole);
        assert_eq!(areas.iter().map(|area| area.pixels()).sum::<usize>(), whole.pixels());
        assert_eq!(areas.len(), 6);
        assert_eq!(areas[5], Rect { x: 67, y: 37, width: 6, height: 1 });
    }
}
