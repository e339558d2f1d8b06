//! `smalti render`: a scene becomes image files and an account of how good they are.

use std::path::{Path, PathBuf};
use std::time::Instant;

use rayon::ThreadPool;
use smalti_core::film::{Film, Image};
use smalti_core::render::Renderer;
use smalti_image::Windows;
use smalti_scheduler::{Goal, Outcome, Shelf, Watch, render_to};

use crate::args::{ProgressArg, RenderArgs, When};
use crate::budget::{self, Budget, Came, Spent};
use crate::describe::describe;
use crate::exit::{Failure, Status};
use crate::frontend::{self, Mode, Title, Told};
use crate::interrupt::{self, Farewell, Interrupt};
use crate::job::Job;
use crate::photon_map::PhotonMap;
use crate::print::{self, Messages};
use crate::record::Work;
use crate::summary::{Developed, Summary, develop, summary};
use crate::{error_statement, memory, outputs, photon_map, provenance, quality};

/// Runs the command. `start` is when the process began.
pub fn run(args: &RenderArgs, colour: When, start: Instant) -> Result<Status, Failure> {
    let messages = Messages { json: args.run.progress == ProgressArg::Json };
    let mode = Mode::choose(args.run.progress, args.run.quiet, colour);
    let interrupt = interrupt::listen(Farewell { restore: frontend::restore, messages }).map_err(Failure::bug)?;
    let outputs = outputs::checked(&args.outputs, &args.scene, ".png")?;
    outputs::check_beside(&outputs, args.standard_error.as_deref())?;
    let mut job = frontend::set_up(mode, |told| load(args, told))?;
    let photon_map = args.photon_map.as_deref().map(|path| open_photon_map(path, &mut job)).transpose()?;
    messages.notes(&job.notes, args.run.quiet);
    let pool = smalti_scheduler::pool(args.run.threads as usize).map_err(Failure::user)?;
    let budget = Budget::new(&args.budget, args.image.spp);
    let means =
        quality::Means { pool: &pool, cancel: &interrupt.cancel, deadline: budget.time.map(|time| (start, time)) };
    let told = |text: &str| tell_unless_quiet(mode, messages, text);
    let quality = quality::settle(&mut job, (&args.budget, &args.image), &means, told)?;
    let renderer = frontend::set_up(mode, |told| pool.install(|| job.renderer(told)))?;
    job.check_memory(&renderer, &pool)?;
    let work = Work { threads: pool.current_num_threads(), tile: job.tile(args.run.work.tile), setup: start.elapsed() };

    let film = Film::new(job.settings.area(), work.tile);
    let goal = budget.goal(&job.settings, job.downsample, &pool, start);
    let workers =
        Workers { pool: &pool, interrupt: &interrupt, photon_map: photon_map.as_ref(), downsample: job.downsample };
    let title = Title { goal: budget.shown(&job.settings), ..title(&job, work, args.exposure) };
    interrupt.keep();
    let mut outcome = perform(&goal, (&renderer, film), &workers, mode, title)?;
    let spent = Spent {
        setup: work.setup,
        photons: outcome.photons.elapsed,
        total: start.elapsed(),
        samples: outcome.mean_samples,
    };
    if budget.is_open() {
        job.settings.spp = outcome.mean_samples;
    }
    let kept = photon_map.map_or(Ok(()), PhotonMap::finish);
    let developed = pool.install(|| develop(&outcome.film, job.downsample));
    let errors = args.standard_error.as_deref().map(|path| (path, standard_errors(&outcome.film, &job)));
    // Encoding needs memory too: the film, six times as large as the image, makes room.
    outcome.film.tiles = Vec::new();
    if let Some(signal) = interrupt.signal().filter(|_| outcome.interrupted) {
        messages.warning(&interrupted(signal, developed.samples, budget.shown(&job.settings).spp));
    }
    if developed.samples.1 > 0 {
        let mut summary = summary(&job, work, &outcome, &developed);
        summary.quality = quality;
        judge((&budget, spent), &outcome, &developed, &mut summary);
        let windows = outputs::windows(&job.settings, job.downsample);
        let written = write(&outputs, (&developed, windows), &mut summary, job.exposure(args.exposure));
        let write_errors = |errors| write_errors(errors, windows, &mut summary, messages);
        let written = written.and(errors.map_or(Ok(()), write_errors));
        summary.run.wall_seconds = start.elapsed().as_secs_f64();
        tell(args, &summary, messages)?;
        summary.shortfalls.iter().for_each(|text| messages.warning(text));
        written.and(kept)?;
    }
    Ok(status(args.strict, &outcome, &interrupt))
}

fn load(args: &RenderArgs, told: &Told) -> Result<Job, Failure> {
    Job::load_downsampled(&args.scene, (&args.image, args.downsample), args.run.work.simd.simd, told)
}

fn tell_unless_quiet(mode: Mode, messages: Messages, text: &str) {
    if mode != Mode::None {
        messages.note(text);
    }
}

/// Notes whether what was wanted was reached, and what there is to say if it was not.
fn judge((budget, spent): (&Budget, Spent), outcome: &Outcome, developed: &Developed, summary: &mut Summary) {
    let error = developed.error.as_ref();
    let at_most = budget::at_most(error, developed.bias.as_ref());
    let verdict = budget.judge(&Came { stopped: outcome.stopped, spent, error, at_most });
    (summary.target_reached, summary.shortfalls) = (verdict.reached, verdict.shortfalls);
}

/// What a display says of a job, of which it shows the picture so far.
pub(super) fn title(job: &Job, work: Work, exposure: Option<f64>) -> Title {
    let area = job.settings.area();
    Title {
        scene: job.path.display().to_string(),
        size: (area.width, area.height),
        goal: frontend::Goal::samples(job.settings.spp),
        integrator: job.settings.integrator.name(),
        threads: work.threads,
        level: job.level.name(),
        setup: work.setup,
        exposure: job.exposure(exposure),
        pictures: true,
    }
}

/// Opens the file of photon maps. Where nothing says how many photons, those of the file are taken.
fn open_photon_map(path: &Path, job: &mut Job) -> Result<PhotonMap, Failure> {
    if let Some(there) = photon_map::header(path)?.filter(|_| job.settings.photons.is_none()) {
        job.settings.photons = Some(there.photons);
    }
    PhotonMap::open(path, &job.scene_hash, &job.settings)
}

/// Who renders, until when, with which photons, and how many pixels become one of the image.
struct Workers<'a> {
    pool: &'a ThreadPool,
    interrupt: &'a Interrupt,
    photon_map: Option<&'a PhotonMap>,
    downsample: u32,
}

/// Renders while a display shows it.
fn perform(
    goal: &Goal,
    (renderer, film): (&Renderer, Film),
    workers: &Workers,
    mode: Mode,
    title: Title,
) -> Result<Outcome, Failure> {
    let (display, watch) = frontend::start(mode, title);
    let error = error_statement::live(film.area.pixels(), workers.downsample);
    let watch = watch.map(|watch| Watch { error: Some(Box::new(error)), ..watch });
    let shelf = workers.photon_map.map(|map| map as &dyn Shelf);
    let hands = (workers.pool, &workers.interrupt.cancel);
    let outcome = render_to(goal, renderer, film, hands, watch, shelf);
    display.finish();
    outcome.map_err(Failure::bug)
}

/// What became of a render that was stopped by a signal; `spp` samples a pixel were to come.
pub(super) fn interrupted(signal: i32, (least, most): (u32, u32), spp: Option<u32>) -> String {
    let by = interrupt::name(signal);
    let samples = if least == most { least.to_string() } else { format!("{least} to {most}") };
    let of = spp.map_or(String::new(), |spp| format!(" of {spp}"));
    match most {
        0 => format!("interrupted by {by} before the first sample: nothing is written"),
        _ => format!("interrupted by {by}: the picture so far is kept, {samples}{of} samples a pixel"),
    }
}

/// Writes every file that can be written; an error names the others.
fn write(
    outputs: &[PathBuf],
    (developed, windows): (&Developed, Windows),
    summary: &mut Summary,
    exposure: f32,
) -> Result<(), Failure> {
    let start = Instant::now();
    let provenance = provenance::of(summary);
    let written = outputs::write_all(outputs, &mut summary.outputs, |path| {
        smalti_image::write_part(path, &developed.image, windows, &provenance, exposure)
    });
    summary.run.write_seconds = start.elapsed().as_secs_f64();
    summary.peak_bytes = memory::peak_bytes();
    written
}

/// The standard error of each pixel; `None` with too few samples.
fn standard_errors(film: &Film, job: &Job) -> Option<Image> {
    film.downsampled(job.downsample).standard_errors()
}

/// Writes standard errors, if there are any.
fn write_errors(
    (path, errors): (&Path, Option<Image>),
    windows: Windows,
    summary: &mut Summary,
    messages: Messages,
) -> Result<(), Failure> {
    let Some(errors) = errors else {
        let needed = error_statement::SAMPLES_NEEDED;
        messages.warning(&format!("standard errors take {needed} samples a pixel: {} is not written", path.display()));
        return Ok(());
    };
    let provenance = provenance::of(summary);
    outputs::write_all(&[path.into()], &mut summary.outputs, |path| {
        smalti_image::write_part(path, &errors, windows, &provenance, 0.0)
    })
}

/// Tells the user what came of it.
fn tell(args: &RenderArgs, summary: &Summary, messages: Messages) -> Result<(), Failure> {
    if let Some(first) = summary.nonfinite_samples.first() {
        let count = summary.nonfinite;
        messages.warning(&format!("{count} samples were not finite and count as 0; the first: {}", first.replay));
    }
    print::account(summary, describe, (args.json, args.run.quiet))
}

fn status(strict: bool, outcome: &Outcome, interrupt: &Interrupt) -> Status {
    match Status::of(outcome.interrupted, interrupt.signal()) {
        Status::Done if strict && outcome.rejected.count > 0 => Status::CheckFailed,
        status => status,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interruptions_say_how_far_it_came() {
        assert!(interrupted(2, (0, 0), Some(64)).contains("SIGINT before the first sample"));
        assert!(interrupted(15, (4, 4), Some(64)).contains("4 of 64"));
        assert!(interrupted(15, (4, 8), Some(64)).contains("4 to 8 of 64"));
        assert!(interrupted(15, (4, 8), None).contains("kept, 4 to 8 samples"));
    }
}
