//! `smalti photons`: a photon map made visible, as the report's Figure 6 does.

use std::path::{Path, PathBuf};
use std::time::Instant;

use rayon::ThreadPool;
use smalti_core::film::Film;
use smalti_core::photon::Quantity;
use smalti_core::render::Renderer;
use smalti_image::{Format, Windows, WriteError};
use smalti_scheduler::Outcome;

use super::render;
use crate::args::{PhotonsArgs, ProgressArg, When};
use crate::exit::{Failure, Status};
use crate::frontend::{self, Mode, Title};
use crate::interrupt::{self, Farewell, Interrupt};
use crate::photons::{Picture, Request, Summary, describe, develop, provenance, summary};
use crate::print::{self, Messages};
use crate::record::Work;
use crate::{memory, outputs};

/// Runs the command. `start` is when the process began.
pub fn run(args: &PhotonsArgs, colour: When, start: Instant) -> Result<Status, Failure> {
    let messages = Messages { json: args.run.progress == ProgressArg::Json };
    let mode = Mode::choose(args.run.progress, args.run.quiet, colour);
    let interrupt = interrupt::listen(Farewell { restore: frontend::restore, messages }).map_err(Failure::bug)?;
    let outputs = outputs::checked(&args.outputs, &args.scene, "-photons.png")?;
    let request = frontend::set_up(mode, |told| Request::load(args, told))?;
    messages.notes(&request.job.notes, args.run.quiet);
    let pool = smalti_scheduler::pool(args.run.threads as usize).map_err(Failure::user)?;
    let renderer = frontend::set_up(mode, |told| pool.install(|| request.renderer(told)))?;
    let tile = request.job.tile(args.run.work.tile);
    let work = Work { threads: pool.current_num_threads(), tile, setup: start.elapsed() };

    interrupt.keep();
    let mut outcome = perform(&renderer, &pool, &interrupt, work, mode, title(args, &request, work))?;
    let samples = outcome.film.samples();
    if let Some(signal) = interrupt.signal().filter(|_| outcome.interrupted) {
        messages.warning(&render::interrupted(signal, samples, Some(request.job.settings.spp)));
    }
    if samples.1 > 0 {
        let picture = develop(outcome.film.develop(), request.colour);
        outcome.film.tiles = Vec::new();
        let mut summary = summary(&request, work, &outcome, &picture, renderer.scene().frame.scale);
        let windows = outputs::windows(&request.job.settings, request.job.downsample);
        let written = write(&outputs, (&picture, windows), &mut summary, request.job.exposure(args.exposure));
        summary.run.wall_seconds = start.elapsed().as_secs_f64();
        tell(args, &summary, messages)?;
        written?;
    }
    Ok(Status::of(outcome.interrupted, interrupt.signal()))
}

fn title(args: &PhotonsArgs, request: &Request, work: Work) -> Title {
    let pictures = request.colour.quantity() == Quantity::Radiance;
    Title { integrator: request.title(), pictures, ..render::title(&request.job, work, args.exposure) }
}

/// Emits the photons and shows them while a display tells of it.
fn perform(
    renderer: &Renderer,
    pool: &ThreadPool,
    interrupt: &Interrupt,
    work: Work,
    mode: Mode,
    title: Title,
) -> Result<Outcome, Failure> {
    let film = Film::new(renderer.settings().area(), work.tile);
    let (display, watch) = frontend::start(mode, title);
    let outcome = smalti_scheduler::render(renderer, film, pool, &interrupt.cancel, watch);
    display.finish();
    outcome.map_err(Failure::bug)
}

/// Writes every file that can be written; an error names the others.
fn write(
    outputs: &[PathBuf],
    (picture, windows): (&Picture, Windows),
    summary: &mut Summary,
    exposure: f32,
) -> Result<(), Failure> {
    let start = Instant::now();
    let provenance = provenance(summary);
    let write = |path: &Path| -> Result<(), WriteError> {
        match &picture.coloured {
            Some((coloured, _)) if Format::from_path(path) == Ok(Format::Png) => {
                smalti_image::write_part(path, coloured, windows, &provenance, 0.0)
            }
            _ => smalti_image::write_part(path, &picture.image, windows, &provenance, exposure),
        }
    };
    let written = outputs::write_all(outputs, &mut summary.outputs, write);
    summary.run.write_seconds = start.elapsed().as_secs_f64();
    summary.peak_bytes = memory::peak_bytes();
    written
}

/// Tells the user what came of it.
fn tell(args: &PhotonsArgs, summary: &Summary, messages: Messages) -> Result<(), Failure> {
    if summary.nonfinite > 0 {
        messages.warning(&format!("{} samples were not finite and count as 0", summary.nonfinite));
    }
    print::account(summary, describe, (args.json, args.run.quiet))
}
