//! The program `smalti`: arguments, commands and frontends around the renderer.

mod args;
mod budget;
mod commands;
mod describe;
mod downsample;
mod error_statement;
mod exit;
mod frontend;
mod interrupt;
mod job;
mod memory;
mod names;
mod outputs;
mod parse;
mod photon_map;
mod photons;
mod print;
mod provenance;
mod quality;
mod record;
mod reproduce;
mod study;
mod study_report;
mod summary;
mod table;
mod time;

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;

fn main() -> ExitCode {
    let start = Instant::now();
    commands::run(&args::Cli::parse(), start)
}
