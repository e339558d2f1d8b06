//! `smalti study`: checks what was asked, then sees it through.

use smalti_report::Study;

use crate::args::{ImageArgs, ProgressArg, When};
use crate::exit::{Failure, Status};
use crate::frontend::{self, Mode};
use crate::interrupt::{self, Farewell, Interrupt};
use crate::job::Job;
use crate::print::{self, Messages};
use crate::reproduce::quoted;
use crate::study::args::{CommonArgs, StudyArgs};
use crate::study::{self, Bench, Folder, Halt, Performance, Pilots, Plan, Progress, Question, Truth, Way};

/// Runs the command.
pub fn run(args: &StudyArgs, colour: When) -> Result<Status, Failure> {
    let common = args.preset.common();
    let messages = Messages { json: common.progress == ProgressArg::Json };
    let flags = ImageArgs { seed: common.seed, camera: common.camera.clone(), ..ImageArgs::default() };
    let mode = Mode::choose(common.progress, common.quiet, colour);
    let job = frontend::set_up(mode, |told| Job::read(&common.scene, &flags, common.work.simd.simd, told))?;
    let scene = own_way(&job);
    let tile = job.tile(common.work.tile);
    let plan = args.preset.plan(&scene, &job.world)?;
    plan.arms.iter().try_for_each(|arm| study::check(&arm.way))?;
    let given = given(common, &plan, messages)?;
    let folder = Folder::checked(common.output.as_deref(), &common.scene, plan.preset)?;
    let question = study::question(&args.preset, &plan, &job, &scene, tile)?;
    let there = folder.open(&question, common.fresh)?;
    messages.notes(&job.notes, common.quiet);
    if job.settings.crop.is_some() {
        messages.note("the scene's crop is left out: a study renders whole images");
    }
    let interrupt = interrupt::listen(Farewell { restore: frontend::restore, messages }).map_err(Failure::bug)?;
    interrupt.keep();

    let repetitions = plan.repetitions(common.reps);
    let (total, done) = (study::interleaved(&repetitions).len(), there.as_ref().map_or(0, |study| study.runs.len()));
    let mut performance = Performance {
        plan,
        repetitions,
        reference_spp: common.reference_spp,
        given,
        folder: &folder,
        bench: Bench::new(&job, tile, &interrupt),
        progress: Progress::new(mode, total.max(done), done),
        pilots: Pilots::default(),
        exposure: job.exposure(None),
    };
    let ended = perform(&mut performance, there, question);
    drop(performance.progress);
    match ended {
        Ok((study, text)) => tell(common, &study, &text).map(|()| Status::Done),
        Err(Halt::Failed(failure)) => Err(failure),
        Err(Halt::Interrupted) => Ok(interrupted(&interrupt, &folder, messages)),
    }
}

/// How the scene itself asks to be rendered, on all cores.
fn own_way(job: &Job) -> Way {
    let image = smalti_core::settings::Settings { crop: None, ..job.settings.clone() };
    Way { image, downsample: 1, threads: study::cores() }
}

fn given(common: &CommonArgs, plan: &Plan, messages: Messages) -> Result<Option<Vec<Truth>>, Failure> {
    let mut sizes: Vec<[u32; 2]> = plan.arms.iter().map(|arm| arm.way.size()).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let Some(path) = &common.reference else { return Ok(None) };
    let (truths, notes) = study::given(path, &sizes)?;
    notes.iter().for_each(|note| messages.note(note));
    Ok(Some(truths))
}

/// Does what is missing of a study; returns it with what is told of it.
fn perform(performance: &mut Performance, there: Option<Study>, question: Question) -> Result<(Study, String), Halt> {
    let (arms, renders) = (performance.plan.arms.len(), study::interleaved(&performance.repetitions).len());
    let done = there.as_ref().map_or(0, |study| study.runs.len());
    let before = if done > 0 { format!("; {done} are there already") } else { String::new() };
    performance.progress.say(&format!("{arms} arms, {renders} renders{before}"));
    let mut study = there.map_or_else(|| performance.begin(question, typed()), Ok)?;
    let text = performance.perform(&mut study)?;
    Ok((study, text))
}

/// The command as typed, without what belongs to one start of it.
fn typed() -> String {
    let arguments = std::env::args().skip(1).filter(|argument| argument != "--fresh");
    std::iter::once("smalti".to_owned())
        .chain(arguments.map(|argument| quoted(&argument)))
        .collect::<Vec<_>>()
        .join(" ")
}

fn tell(common: &CommonArgs, study: &Study, text: &str) -> Result<(), Failure> {
    print::account(study, |_| text.to_owned(), (common.json, common.quiet))
}

fn interrupted(interrupt: &Interrupt, folder: &Folder, messages: Messages) -> Status {
    let signal = interrupt.signal();
    let by = signal.map_or("a signal", interrupt::name);
    let kept = folder.path().display();
    messages.warning(&format!("interrupted by {by}: what is done is kept in {kept}; the same command goes on"));
    Status::of(true, signal)
}
