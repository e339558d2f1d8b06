//! Arguments as typed. Nothing here looks at the machine, the scene or the disk: [`crate::job`] does.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use smalti_core::photon::SUB_MAPS;
use smalti_core::settings::{MOST_PHOTONS, MOST_SHADOW_RAYS, Rect};

use crate::names::{ColourArg, FresnelArg, IntegratorArg, MapArg, QualityArg, SamplerArg, SimdArg, SwitchArg};
use crate::parse::{
    Size, parse_crop, parse_finite, parse_length, parse_share, parse_size, parse_threads, parse_threshold,
};
use crate::study::args::StudyArgs;

/// A physically based CPU renderer for people who work in a terminal.
#[derive(Debug, Parser)]
#[command(name = "smalti", version, propagate_version = true, max_term_width = 100, after_help = EXAMPLES)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Colours of the output; auto: on a terminal, unless NO_COLOR is set
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto", hide_possible_values = true)]
    pub color: When,
}

const EXAMPLES: &str = "\
Examples:
  smalti render scenes/hexroom.toml                        writes hexroom.png here
  smalti render scenes/hexroom.toml --spp 256 -o room.exr  linear radiance, less noise
  smalti explain scenes/hexroom.toml                       what the scene requires, and why
  smalti compare room.exr reference.exr --max-relmse 0.01  a check for scripts

Exit codes:
  0 done; 1 a check failed; 2 a mistake in arguments or scene; 74 the output could not be written;
  101 a bug in smalti; 129, 130, 143 interrupted; a picture with samples is kept";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to image files
    Render(RenderArgs),
    /// Say what a scene requires: stages, reasons, memory, SIMD levels
    Explain(ExplainArgs),
    /// Measure one thread against many: time, speed-up, efficiency, tile balance, same bits
    Scaling(ScalingArgs),
    /// Measure how far an image is from a reference
    Compare(CompareArgs),
    /// Replay one pixel, or one sample of it bounce by bounce
    Pixel(PixelArgs),
    /// Examine a scene at its numerical extremes: other units and places, every SIMD level, f64
    Doctor(DoctorArgs),
    /// Make a scene's photon map visible
    Photons(PhotonsArgs),
    /// Measure the trade between speed and accuracy: sweeps, equal time, equal error, the report
    Study(StudyArgs),
    /// Show what a study found: a page, figures, the short version
    Report(ReportArgs),
}

/// Arguments of `smalti render`.
#[derive(Debug, Args)]
#[command(after_help = RENDER_EXAMPLES)]
pub struct RenderArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Image file: .png, .exr, .pfm or .hdr; may be repeated [default: the scene's name with .png, here]
    #[arg(short, long = "output", value_name = "FILE")]
    pub outputs: Vec<PathBuf>,
    /// Brightness of PNG files in stops: every step doubles it; other formats hold linear radiance
    #[arg(long, value_name = "EV", value_parser = parse_finite, allow_negative_numbers = true)]
    pub exposure: Option<f64>,
    #[command(flatten)]
    pub run: RunArgs,
    /// Keep photon maps in this file and take them from it: renders of the same scene, with any camera, share them
    #[arg(long, value_name = "FILE")]
    pub photon_map: Option<PathBuf>,
    #[command(flatten)]
    pub budget: BudgetArgs,
    /// Write the standard error of each pixel and channel as an image too: .exr, .pfm, .hdr or .png
    #[arg(long, value_name = "FILE")]
    pub standard_error: Option<PathBuf>,
    /// Exit with 1 if a sample was not finite
    #[arg(long)]
    pub strict: bool,
    /// Print the summary as one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    /// Render NxN pixels for each one of the image and average them; --spp and --photons are of what is rendered, --size
    /// and --crop of the image
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = "Image",
          value_parser = clap::value_parser!(u32).range(1..=MOST_DOWNSAMPLE))]
    pub downsample: u32,
    #[command(flatten)]
    pub image: ImageArgs,
}

/// Pixels that become one in each direction, at most.
pub const MOST_DOWNSAMPLE: i64 = 64;
/// Arguments of `smalti report`.
#[derive(Debug, Args)]
#[command(after_help = REPORT_EXAMPLES)]
pub struct ReportArgs {
    /// Folder of a study, with its study.json
    pub folder: PathBuf,
    /// The page; figures lie beside it in the folder figures [default: report.html in the folder of the study]
    #[arg(short, long = "output", value_name = "FILE.html")]
    pub output: Option<PathBuf>,
    /// Do not print the short version
    #[arg(short, long)]
    pub quiet: bool,
    /// Print what was found as one JSON object on stdout
    #[arg(long)]
    pub json: bool,
}

const REPORT_EXAMPLES: &str = "\
Examples:
  smalti report hexroom-study-sweep                  writes report.html and figures/*.svg there
  smalti report hexroom-study-sweep -o ~/sweep.html  the page elsewhere; it needs no other file
  smalti report hexroom-study-sweep --json -q        findings and verdicts for a script";

/// When a render stops, other than by its samples.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct BudgetArgs {
    /// Use this time, from the start of the process to its end, for as many samples as it gives: 90, 500ms, 1m30s;
    /// one sample a pixel is the least, --spp the most
    #[arg(long, value_name = "TIME", value_parser = crate::time::parse, allow_negative_numbers = true)]
    pub time: Option<f64>,
    /// Stop when the relative error is at most this, with 95 % confidence: 1% or 0.01; --spp is the most samples then
    #[arg(long, value_name = "SHARE", value_parser = parse_share, allow_negative_numbers = true)]
    pub target_error: Option<f64>,
    /// Stop at the error that this stands for, with the shadow rays and the sampling that reach it at the least cost:
    /// short renders of the scene tell. What was typed stays as it was typed
    #[arg(long, value_name = "HOW", conflicts_with = "target_error")]
    pub quality: Option<QualityArg>,
}

/// How the machine is used, and what is told meanwhile.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Worker threads; 0: one for each logical core
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=MAX_THREADS))]
    pub threads: u32,
    #[command(flatten)]
    pub work: WorkArgs,
    /// How progress is shown on stderr
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub progress: ProgressArg,
    /// No progress and no summary; errors and warnings only
    #[arg(short, long)]
    pub quiet: bool,
}

/// More threads than any machine has; a number above is a slip.
pub const MAX_THREADS: i64 = 4096;

const RENDER_EXAMPLES: &str = "\
Examples:
  smalti render room.toml                            writes room.png here
  smalti render room.toml -o room.exr -o room.png    both, from one render
  smalti render room.toml --size 200x200 --spp 4     a quick look
  smalti render room.toml --downsample 2 --spp 16    2x2 pixels for each one of the image, averaged
  smalti render room.toml --crop 120,80,64,64        these pixels as in the whole image, bit for bit
  smalti render room.toml --json --progress none     for a script
  smalti render room.toml --target-error 2%          as many samples as it takes
  smalti render room.toml --quality good             an error of 3 %, with settings that suit the scene
  smalti render room.toml --time 10s --adaptive on   what ten seconds give, where it is needed

Flags override the scene's [render] table. Threads, tile size and SIMD level change no bit of the image.
Ctrl-C keeps the picture so far; twice leaves at once.";

/// Flags that change the image; each overrides its key in the scene's `[render]` table. They stand last in every
/// command, for their heading holds for all that follows.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Image")]
pub struct ImageArgs {
    /// Light transport algorithm: auto is path with photons where chance hardly finds the light; whitted has no indirect
    /// diffuse light [default: the scene's, or auto]
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<IntegratorArg>,
    /// Samples (camera paths) for each pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// Light samples at each diffuse vertex in all; 0: light is found by chance only
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=i64::from(MOST_SHADOW_RAYS)))]
    pub shadow_rays: Option<u32>,
    /// Scattering events after which a path ends (biased); without it only roulette ends a path
    #[arg(long, value_name = "N")]
    pub max_bounces: Option<u32>,
    /// Where the random numbers come from
    #[arg(long, value_name = "NAME")]
    pub sampler: Option<SamplerArg>,
    /// Another seed is another realisation of the noise
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Size of the whole image in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<Size>,
    /// Render only this part of the image: column and row of its top left pixel, width, height
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_crop)]
    pub crop: Option<Rect>,
    /// Which of the scene's cameras
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Every sample passes through its pixel's centre (edges become jagged)
    #[arg(long)]
    pub no_jitter: bool,
    /// Photons that are emitted for each round of 16 samples and each map; 0: none [default: by the size of the image]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=i64::from(MOST_PHOTONS)))]
    pub photons: Option<u32>,
    /// How far photons count in the first round, metres; it shrinks from round to round [default: by their density]
    #[arg(long, value_name = "R", value_parser = parse_length)]
    pub radius: Option<f64>,
    /// Reflectance of dielectrics
    #[arg(long, value_name = "NAME")]
    pub fresnel: Option<FresnelArg>,
    /// Whether samples go where the noise is; --spp is their mean then, and a crop has other samples than the same part of
    /// the whole image [default: the scene's, or off]
    #[arg(long, value_name = "WHETHER")]
    pub adaptive: Option<SwitchArg>,
}

/// Flags that say how the machine works; no bit of the image depends on them.
#[derive(Debug, Args)]
pub struct WorkArgs {
    /// Side of a tile in pixels [default: the scene's, or 32]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub tile: Option<u32>,
    #[command(flatten)]
    pub simd: SimdArgs,
}

/// The SIMD level.
#[derive(Debug, Args)]
pub struct SimdArgs {
    /// SIMD level; auto: the best that this machine has
    #[arg(long, value_name = "LEVEL", default_value = "auto")]
    pub simd: SimdArg,
}

/// Arguments of `smalti explain`.
#[derive(Debug, Args)]
pub struct ExplainArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    #[command(flatten)]
    pub simd: SimdArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub image: ImageArgs,
}

/// Arguments of `smalti doctor`.
#[derive(Debug, Args)]
#[command(after_help = DOCTOR_EXAMPLES)]
pub struct DoctorArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Worker threads; 0: one for each logical core
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=MAX_THREADS))]
    pub threads: u32,
    #[command(flatten)]
    pub simd: SimdArgs,
    /// Render the image as it is asked for and look at every value of every stage: stop at the first that is not finite, or
    /// negative, and replay its sample. Takes many times as long as a render
    #[arg(long)]
    pub hunt: bool,
    /// Say only what is not as it should be
    #[arg(short, long)]
    pub quiet: bool,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub image: ImageArgs,
}

const DOCTOR_EXAMPLES: &str = "\
Examples:
  smalti doctor room.toml                      some two hundred small renders, and rays against f64
  smalti doctor room.toml --integrator whitted
  smalti doctor room.toml --hunt --size 800x800 --spp 64  the first value that is not finite, or negative

The image is as small as 64x64 pixels with 32 samples unless --size and --spp say otherwise.
Exit code 1 if something failed; what only asks for trouble is a warning.";

/// Arguments of `smalti scaling`.
#[derive(Debug, Args)]
#[command(after_help = SCALING_EXAMPLES)]
pub struct ScalingArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Numbers of threads, for example 1,2,4; max: every logical core [default: 1, 2, 4 ... max]
    #[arg(long, value_name = "LIST", value_parser = parse_threads)]
    pub threads: Option<Threads>,
    /// Repetitions of each number of threads; the median counts
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    pub reps: u32,
    #[command(flatten)]
    pub work: WorkArgs,
    /// No line for each run on stderr
    #[arg(short, long)]
    pub quiet: bool,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub image: ImageArgs,
}

/// Numbers of threads as typed; 0 stands for `max`. (A type of its own, or clap takes a vector for repeated flags.)
#[derive(Clone, Debug, PartialEq)]
pub struct Threads(pub Vec<u32>);

const SCALING_EXAMPLES: &str = "\
Examples:
  smalti scaling room.toml
  smalti scaling room.toml --threads 1,max --reps 5 --size 400x400 --spp 16

The repetitions are interleaved (1, 2, 4, 1, 2, 4 ...), so that a machine that slows down slows all alike.
Exit code 1 if the images of any two runs differ in a bit.";

const COMPARE_NOTES: &str = "\
Exit code 1 if a threshold is exceeded, or if a pixel that is not finite (NaN, infinite) in one of
the images is not the same in both, with thresholds and without; else 0. Metrics are of the pixels
that are finite in both.

The content of a file tells its format, whatever its name says. EXR files are placed by their
windows: a crop lies on its part of the whole, and the part that both hold is compared. An image of
another format is placed as the whole picture of an EXR file if it has its size, or else on the
pixels that it holds. Of an EXR file's layers the one without a name is read, or else the first one
called Combined, or else the first in colour. Alpha is left out.

The object of --json; what does not exist is null, and so are numbers that are not finite:
  image, reference      the files
  width, height         of what was compared
  part                  x, y, width, height of that, if it is not plainly all of both
  notes                 how the files were read and placed, in words
  rmse                  root of the mean of (x - r)^2, over pixels and channels
  relmse                mean of (x - r)^2 / (r^2 + 0.01)
  relmse_trimmed        the same without the worst 0.1 % of the pixels
  relative_error        root of the mean of (x - r)^2 / (r^2 + 0.01 m^2), m the mean of all r
  mean_ratio            mean of the image by mean of the reference, for each channel
  nonfinite_pixels      pixels that are not finite in one of the two: they are in no metric
  nonfinite_image, nonfinite_reference, nonfinite_both
                        how many are not finite there
  nonfinite_alike       those of them that are the same in both
  worst                 x, y, relmse, value, reference, nonfinite: null, or image, reference or both
                        for pixels that are not finite and not the same, which come first; x and y
                        count from 0, or as the windows of EXR files do
  exceeded              thresholds that are exceeded: relmse, rmse
  output                the difference picture
  output_full_scale     the difference that has the last of its colours";

/// Arguments of `smalti compare`.
#[derive(Debug, Args)]
#[command(after_help = COMPARE_NOTES)]
pub struct CompareArgs {
    /// Image in question: .exr, .pfm, .hdr or .png
    pub image: PathBuf,
    /// Image that is taken as the truth
    pub reference: PathBuf,
    /// Write a difference picture
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Exit with 1 if the relmse is above this
    #[arg(long, value_name = "X", value_parser = parse_threshold, allow_negative_numbers = true)]
    pub max_relmse: Option<f64>,
    /// Exit with 1 if the root mean square error is above this
    #[arg(long, value_name = "X", value_parser = parse_threshold, allow_negative_numbers = true)]
    pub max_rmse: Option<f64>,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `smalti pixel`.
#[derive(Debug, Args)]
pub struct PixelArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Column, from 0 at the left of the whole image
    pub x: u32,
    /// Row, from 0 at the top of the whole image
    pub y: u32,
    /// Replay this sample (from 0) bounce by bounce; without it every sample's radiance is summed up
    #[arg(long, value_name = "N")]
    pub sample: Option<u32>,
    #[command(flatten)]
    pub simd: SimdArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub image: ImageArgs,
}

/// Arguments of `smalti photons`.
#[derive(Debug, Args)]
#[command(after_help = PHOTONS_EXAMPLES)]
pub struct PhotonsArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Image file: .png, .exr, .pfm or .hdr; may be repeated [default: the scene's name with -photons.png, here]
    #[arg(short, long = "output", value_name = "FILE")]
    pub outputs: Vec<PathBuf>,
    /// Brightness of PNG files in stops: every step doubles it; false colours do not change
    #[arg(long, value_name = "EV", value_parser = parse_finite, allow_negative_numbers = true)]
    pub exposure: Option<f64>,
    #[command(flatten)]
    pub run: RunArgs,
    /// Print the summary as one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub image: PhotonImageArgs,
}

/// Flags that change the picture of a photon map.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Image")]
pub struct PhotonImageArgs {
    /// Photons that are emitted in all [default: a million for each light, 4 at most; with --map global 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_PHOTONS)))]
    pub photons: Option<u32>,
    /// Which map [default: caustic where something is specular, else global]
    #[arg(long, value_name = "NAME")]
    pub map: Option<MapArg>,
    /// What the colours tell of the photons
    #[arg(long, value_name = "WHAT", default_value = "flux")]
    pub colour: ColourArg,
    /// How far photons count, metres [default: by their density]
    #[arg(long, value_name = "R", value_parser = parse_length)]
    pub radius: Option<f64>,
    /// Samples (camera paths) for each pixel
    #[arg(long, value_name = "N", default_value_t = 4,
          value_parser = clap::value_parser!(u32).range(1..=i64::from(SUB_MAPS)))]
    pub spp: u32,
    /// Another seed is another realisation of the noise
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Size of the whole image in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<Size>,
    /// Show only this part of the image: column and row of its top left pixel, width, height
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_crop)]
    pub crop: Option<Rect>,
    /// Which of the scene's cameras
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Reflectance of dielectrics
    #[arg(long, value_name = "NAME")]
    pub fresnel: Option<FresnelArg>,
}

const PHOTONS_EXAMPLES: &str = "\
Examples:
  smalti photons scenes/hexroom-points.toml --exposure 4       caustics of two glass balls, 3 million photons
  smalti photons room.toml --map global --colour density       where photons lie dense, in false colours
  smalti photons room.toml -o map.exr --photons 100000 --json  for a script

Of the scene's [render] table size, crop, seed, camera, fresnel, exposure and tile count. With false colours a PNG file has
the colours; other formats hold the figures themselves, the same in every channel. Threads, tile size and SIMD level
change no bit of the image.";

/// When to use colours.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum When {
    Auto,
    Always,
    Never,
}

/// How to show progress.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum ProgressArg {
    /// Bars on a terminal, plain lines elsewhere
    Auto,
    /// Live bars
    Bar,
    /// Plain lines for a log
    Plain,
    /// One JSON object a line
    Json,
    /// Nothing
    None,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn definitions_are_sound() {
        Cli::command().debug_assert();
    }
}
