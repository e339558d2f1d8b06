//! The commands, one file each, and what they have in common: how a failure is told and becomes an exit code.

mod compare;
mod doctor;
mod explain;
mod photons;
mod pixel;
mod render;
mod report;
mod scaling;
mod study;

use std::process::ExitCode;
use std::time::Instant;

use crate::args::{Cli, Command, ProgressArg};
use crate::print::{self, Messages};

/// Runs the command that was typed. `start` is when the process began.
pub fn run(cli: &Cli, start: Instant) -> ExitCode {
    let messages = Messages { json: wants_json_lines(&cli.command) };
    print::use_colour(cli.color, messages.json);
    std::panic::set_hook(Box::new(move |panic| messages.error(&format!("this is a bug in smalti: {panic}"))));
    let ended = match &cli.command {
        Command::Render(args) => render::run(args, cli.color, start),
        Command::Explain(args) => explain::run(args),
        Command::Scaling(args) => scaling::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Pixel(args) => pixel::run(args),
        Command::Doctor(args) => doctor::run(args),
        Command::Photons(args) => photons::run(args, cli.color, start),
        Command::Study(args) => study::run(args, cli.color),
        Command::Report(args) => report::run(args, messages),
    };
    match ended {
        Ok(status) => status.into(),
        Err(failure) => {
            messages.failure(&failure);
            failure.blame.into()
        }
    }
}

/// With `--progress json` stderr holds JSON lines only.
fn wants_json_lines(command: &Command) -> bool {
    match command {
        Command::Render(args) => args.run.progress == ProgressArg::Json,
        Command::Photons(args) => args.run.progress == ProgressArg::Json,
        Command::Study(args) => args.preset.common().progress == ProgressArg::Json,
        _ => false,
    }
}
