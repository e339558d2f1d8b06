//! Arguments of `smalti study` as typed.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::lists::KnobLists;
use crate::args::{ProgressArg, WorkArgs};
use crate::parse::{Size, parse_share, parse_size};
use crate::time;

/// Arguments of `smalti study`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct StudyArgs {
    /// What is asked.
    #[command(subcommand)]
    pub preset: Preset,
}

const EXAMPLES: &str = "\
Examples:
  smalti study report scenes/hexroom.toml         the report's Table 1 and its claims
  smalti study knobs room.toml                    what does each knob bring?
  smalti study equal-time room.toml --seconds 2   who has least error after two seconds?
  smalti study equal-error room.toml --error 3%   who is the first with an error of 3 %?
  smalti study sweep room.toml --integrator path,auto --spp 4,16,64    every combination

All arms are rendered once, then all again with another seed; nothing else is computed meanwhile.
Errors are those against a reference that the study renders too, freed of its noise.
The folder keeps:
  study.json   everything; written after every render, so that the same command goes on
  images       each arm's first image, .png and .pfm; the references lie beside the folder of them
  runs.csv     a line for each render:
    arm, repetition, seed, hash     which it was; the hash is that of the image
    seconds, photon_seconds         from the first sample to the last; the part of it for photons
    spp, rays                       samples for each pixel that is rendered; rays of all kinds
    relmse, relative_error          against the reference, freed of its own noise
    relmse_trimmed                  without the worst 0.1 % of the pixels, not freed of anything
    stated_...                      what the render said of itself, with its interval
    mean_red, mean_green, mean_blue
  arms.csv     a line for each arm:
    name, label, group, then every knob by the name of its flag, width, height, runs
    seconds, relmse, relative_error medians; _low and _high: the 95 % interval of the geometric
                                    mean from three repetitions on (none at or below 0), else the
                                    least and the most
    efficiency                      1 / (relmse x seconds), the median; empty if one is not above 0
    on_front                        whether no other arm of its size is as fast and as accurate,
                                    and better in one of the two";

/// The presets.
#[derive(Debug, Subcommand)]
pub enum Preset {
    /// Every combination of the knobs that are given lists of values
    Sweep(SweepArgs),
    /// The report's Table 1 and what its figures and claims compare
    Report(ReportArgs),
    /// Every integrator and number of shadow rays with the samples that fit into one time
    EqualTime(EqualTimeArgs),
    /// Every integrator and number of shadow rays with the samples that one error takes
    EqualError(EqualErrorArgs),
    /// One knob at a time around the scene's own settings
    Knobs(SweepArgs),
}

impl Preset {
    /// What it is called.
    pub fn name(&self) -> &'static str {
        match self {
            Preset::Sweep(_) => "sweep",
            Preset::Report(_) => "report",
            Preset::EqualTime(_) => "equal-time",
            Preset::EqualError(_) => "equal-error",
            Preset::Knobs(_) => "knobs",
        }
    }

    /// What all presets have.
    pub fn common(&self) -> &CommonArgs {
        match self {
            Preset::Sweep(args) | Preset::Knobs(args) => &args.common,
            Preset::Report(args) => &args.common,
            Preset::EqualTime(args) => &args.common,
            Preset::EqualError(args) => &args.common,
        }
    }
}

/// Arguments of `smalti study sweep` and `knobs`.
#[derive(Debug, Args)]
pub struct SweepArgs {
    #[command(flatten)]
    pub common: CommonArgs,
    #[command(flatten)]
    pub knobs: KnobLists,
}

/// Arguments of `smalti study report`.
#[derive(Debug, Args)]
pub struct ReportArgs {
    #[command(flatten)]
    pub common: CommonArgs,
    /// Size of the large images, in place of the report's; the small ones are half as wide and high
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "800x800")]
    pub size: Size,
}

/// Arguments of `smalti study equal-time`.
#[derive(Debug, Args)]
pub struct EqualTimeArgs {
    #[command(flatten)]
    pub common: CommonArgs,
    /// How long each render takes, about: 2, 500ms, 1m30s
    #[arg(long, value_name = "TIME", value_parser = time::parse, default_value = "1", allow_hyphen_values = true)]
    pub seconds: f64,
    #[command(flatten)]
    pub knobs: KnobLists,
}

/// Arguments of `smalti study equal-error`.
#[derive(Debug, Args)]
pub struct EqualErrorArgs {
    #[command(flatten)]
    pub common: CommonArgs,
    /// The relative error of each render, about: 3% or 0.03; noise alone, a bias comes on top
    #[arg(long, value_name = "E", value_parser = parse_share, default_value = "3%", allow_hyphen_values = true)]
    pub error: f64,
    /// No render takes longer than this, about: 90, 1m30s; an arm that would has a larger error
    #[arg(long, value_name = "TIME", value_parser = time::parse, default_value = "60", allow_hyphen_values = true)]
    pub seconds: f64,
    #[command(flatten)]
    pub knobs: KnobLists,
}

/// What all presets have.
#[derive(Debug, Args)]
pub struct CommonArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Where the study is kept; one that is there already goes on [default: the scene's name with -study-PRESET, here]
    #[arg(short, long = "output", value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// Renders of each arm; more than a finished study has extend it [default: 3; report: 2 of its slowest]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub reps: Option<u32>,
    /// Take this image for the truth: .pfm, .exr or .hdr, as large as the images or a whole multiple of it
    #[arg(long, value_name = "FILE", conflicts_with = "reference_spp")]
    pub reference: Option<PathBuf>,
    /// Samples of the reference [default: until it is five times as good as the best arm, or took as long as all of them]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(i64::from(crate::error_statement::SAMPLES_NEEDED)..))]
    pub reference_spp: Option<u32>,
    /// Begin anew where the folder has another study
    #[arg(long)]
    pub fresh: bool,
    /// Seed of the first repetition; the next ones count up
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Which of the scene's cameras
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    #[command(flatten)]
    pub work: WorkArgs,
    /// How progress is shown on stderr
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub progress: ProgressArg,
    /// No progress and no table; errors and warnings only
    #[arg(short, long)]
    pub quiet: bool,
    /// Print the whole study as one JSON object on stdout
    #[arg(long)]
    pub json: bool,
}
