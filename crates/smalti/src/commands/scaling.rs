//! `smalti scaling`: one thread against many, and the proof that the image is the same.

use std::time::Duration;

use serde::Serialize;
use smalti_core::film::Film;
use smalti_core::render::{RayCounts, Renderer};
use smalti_core::settings::Rect;
use smalti_scheduler::{Cancel, Outcome};

use crate::args::{ScalingArgs, Threads};
use crate::exit::{Failure, Status};
use crate::frontend::{self, Mode};
use crate::job::Job;
use crate::print::{self, Messages};
use crate::record::{self, Subject};
use crate::table::{Align, table};

#[derive(Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    subject: Subject<'a>,
    simd: &'static str,
    tile: u32,
    reps: u32,
    /// Threads that the machine can run at once.
    cores: usize,
    /// Hash of the image of every run; null if they differ.
    hash: Option<&'a str>,
    same_image: bool,
    results: &'a [Row],
}

/// What is told of one number of threads. What is not a median is that of the run with the median time (of two, the
/// slower one).
#[derive(Debug, PartialEq, Serialize)]
struct Row {
    threads: usize,
    /// Median over the repetitions.
    seconds: f64,
    least_seconds: f64,
    most_seconds: f64,
    /// One thread's time over this one's.
    speed_up: Option<f64>,
    /// Speed-up over threads.
    efficiency: Option<f64>,
    /// Share of the workers' time that was spent waiting.
    idle: f64,
    /// Rays of all kinds per second.
    rays_per_second: f64,
    tile_min_seconds: f64,
    tile_median_seconds: f64,
    tile_max_seconds: f64,
    /// Column, row, width and height.
    slowest_tile: [u32; 4],
    hashes: Vec<String>,
}

/// One render.
#[derive(Clone, Debug)]
struct Run {
    elapsed: Duration,
    idle: f64,
    rays: u64,
    tiles: [Duration; 3],
    slowest: Rect,
    hash: String,
}

/// Runs the command.
pub fn run(args: &ScalingArgs) -> Result<Status, Failure> {
    let mode = Mode::of_terminal();
    let job = frontend::set_up(mode, |told| Job::load(&args.scene, &args.image, args.work.simd.simd, told))?;
    Messages { json: false }.notes(&job.notes, args.quiet);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let counts = thread_counts(args.threads.as_ref(), cores);
    let most = counts.iter().copied().max().unwrap_or(1);
    let pool = smalti_scheduler::pool(most).map_err(Failure::user)?;
    let renderer = frontend::set_up(mode, |told| pool.install(|| job.renderer(told)))?;
    let tile = job.tile(args.work.tile);
    let runs = measure(args, &renderer, tile, &counts)?;
    let rows = rows(&counts, &runs);
    let first = &rows[0].hashes[0];
    let same = rows.iter().flat_map(|row| &row.hashes).all(|hash| hash == first);
    match args.json {
        true => print::json(&report(args, &job, cores, first, same, &rows))?,
        false => print::result(&text(&job, args, &rows, same))?,
    }
    Ok(if same { Status::Done } else { Status::CheckFailed })
}

/// Ascending numbers of threads, 1 always among them: 1, 2, 4 ... and all cores unless some were typed.
fn thread_counts(typed: Option<&Threads>, cores: usize) -> Vec<usize> {
    let mut counts = vec![1];
    match typed {
        Some(Threads(list)) => counts.extend(list.iter().map(|&count| if count == 0 { cores } else { count as usize })),
        None => {
            counts.extend((1..).map(|power| 1 << power).take_while(|&count| count < cores));
            counts.push(cores);
        }
    }
    counts.sort_unstable();
    counts.dedup();
    counts
}

/// Every number of threads once, then all again: whatever slows the machine down slows all alike.
fn measure(args: &ScalingArgs, renderer: &Renderer, tile: u32, counts: &[usize]) -> Result<Vec<Vec<Run>>, Failure> {
    let mut runs = vec![Vec::new(); counts.len()];
    for rep in 1..=args.reps {
        for (&threads, runs) in counts.iter().zip(&mut runs) {
            let run = render_once(renderer, tile, threads)?;
            if !args.quiet {
                let seconds = run.elapsed.as_secs_f64();
                print::write_line(&format!("run {rep} of {}: threads {threads}, {seconds:.3} s", args.reps));
            }
            runs.push(run);
        }
    }
    Ok(runs)
}

fn render_once(renderer: &Renderer, tile: u32, threads: usize) -> Result<Run, Failure> {
    let pool = smalti_scheduler::pool(threads).map_err(Failure::user)?;
    let film = Film::new(renderer.settings().area(), tile);
    let outcome = smalti_scheduler::render(renderer, film, &pool, &Cancel::default(), None).map_err(Failure::bug)?;
    Ok(look_at(&outcome))
}

fn look_at(outcome: &Outcome) -> Run {
    let RayCounts { camera, scattered, shadow } = outcome.rays;
    let idle = outcome.timing.idle();
    let balance = outcome.timing.balance();
    Run {
        elapsed: outcome.timing.elapsed,
        idle: idle.iter().sum::<f64>() / idle.len().max(1) as f64,
        rays: camera + scattered + shadow,
        tiles: balance.map_or([Duration::ZERO; 3], |balance| [balance.min, balance.median, balance.max]),
        slowest: balance.map_or(Rect::default(), |balance| balance.slowest),
        hash: smalti_image::hash(&outcome.film.develop()),
    }
}

/// One row for each number of threads; the first is that of one thread.
fn rows(counts: &[usize], runs: &[Vec<Run>]) -> Vec<Row> {
    let single = median_seconds(&runs[0]);
    counts.iter().zip(runs).map(|(&threads, runs)| row(threads, runs, single)).collect()
}

fn row(threads: usize, runs: &[Run], single: f64) -> Row {
    let times = runs.iter().map(|run| run.elapsed.as_secs_f64());
    let seconds = median_seconds(runs);
    let middle = middle(runs);
    let [tile_min_seconds, tile_median_seconds, tile_max_seconds] = middle.tiles.map(|time| time.as_secs_f64());
    let Rect { x, y, width, height } = middle.slowest;
    Row {
        threads,
        seconds,
        least_seconds: times.clone().fold(f64::INFINITY, f64::min),
        most_seconds: times.fold(0.0, f64::max),
        speed_up: smalti_measure::speed_up(single, seconds),
        efficiency: smalti_measure::parallel_efficiency(single, seconds, threads as u32),
        idle: middle.idle,
        rays_per_second: middle.rays as f64 / seconds,
        tile_min_seconds,
        tile_median_seconds,
        tile_max_seconds,
        slowest_tile: [x, y, width, height],
        hashes: runs.iter().map(|run| run.hash.clone()).collect(),
    }
}

fn median_seconds(runs: &[Run]) -> f64 {
    let times: Vec<f64> = runs.iter().map(|run| run.elapsed.as_secs_f64()).collect();
    smalti_measure::median(&times).unwrap_or_default()
}

/// The run with the median time, the slower one of two.
fn middle(runs: &[Run]) -> &Run {
    let mut order: Vec<&Run> = runs.iter().collect();
    order.sort_by_key(|run| run.elapsed);
    order[order.len() / 2]
}

fn report<'a>(
    args: &ScalingArgs,
    job: &'a Job,
    cores: usize,
    hash: &'a str,
    same_image: bool,
    results: &'a [Row],
) -> Report<'a> {
    Report {
        subject: record::subject(job),
        simd: job.level.name(),
        tile: job.tile(args.work.tile),
        reps: args.reps,
        cores,
        hash: same_image.then_some(hash),
        same_image,
        results,
    }
}

fn text(job: &Job, args: &ScalingArgs, rows: &[Row], same: bool) -> String {
    let settings = &job.settings;
    let heading = format!(
        "{}: {} {}x{}, {} spp, {}, tile {}, median of {}\n",
        job.path.display(),
        settings.integrator.name(),
        settings.width,
        settings.height,
        settings.spp,
        job.level.name(),
        job.tile(args.work.tile),
        args.reps
    );
    heading + &times(rows) + &verdict(rows, same)
}

fn times(rows: &[Row]) -> String {
    let heading = ["threads", "seconds", "speed-up", "efficiency", "idle", "Mrays/s", "tile min / median / max ms"];
    let mut lines = vec![heading.map(String::from).to_vec()];
    lines.extend(rows.iter().map(|row| {
        let tiles = [row.tile_min_seconds, row.tile_median_seconds, row.tile_max_seconds];
        vec![
            row.threads.to_string(),
            format!("{:.3}", row.seconds),
            row.speed_up.map(|times| format!("{times:.2}")).unwrap_or_default(),
            row.efficiency.map(|share| format!("{:.1} %", 100.0 * share)).unwrap_or_default(),
            format!("{:.1} %", 100.0 * row.idle),
            format!("{:.1}", row.rays_per_second / 1e6),
            tiles.map(|seconds| format!("{:.2}", 1e3 * seconds)).join(" / "),
        ]
    }));
    table(&[Align::Right; 7], &lines)
}

fn verdict(rows: &[Row], same: bool) -> String {
    if same {
        return format!("  every run made the same image, hash {}\n", rows[0].hashes[0]);
    }
    let lines = rows.iter().map(|row| format!("  {} threads: {}\n", row.threads, row.hashes.join(" ")));
    format!("  THE IMAGES DIFFER; their hashes:\n{}", lines.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timed(millis: u64) -> Run {
        Run {
            elapsed: Duration::from_millis(millis),
            idle: 0.25,
            rays: 1000,
            tiles: [1, 2, 3].map(Duration::from_millis),
            slowest: Rect { x: 1, y: 2, width: 3, height: 4 },
            hash: "h".into(),
        }
    }

    #[test]
    fn one_thread_is_always_measured() {
        assert_eq!(thread_counts(None, 1), [1]);
        assert_eq!(thread_counts(None, 2), [1, 2]);
        assert_eq!(thread_counts(None, 12), [1, 2, 4, 8, 12]);
        assert_eq!(thread_counts(Some(&Threads(vec![4, 0, 3, 4])), 6), [1, 3, 4, 6]);
    }

    #[test]
    fn efficiency_is_speed_up_per_thread() {
        let runs = [vec![timed(900), timed(1000), timed(4000)], vec![timed(500), timed(250), timed(100)]];
        let rows = rows(&[1, 4], &runs);
        assert_eq!((rows[0].seconds, rows[0].speed_up, rows[0].efficiency), (1.0, Some(1.0), Some(1.0)));
        assert_eq!((rows[1].seconds, rows[1].speed_up, rows[1].efficiency), (0.25, Some(4.0), Some(1.0)));
        assert_eq!((rows[1].least_seconds, rows[1].most_seconds), (0.1, 0.5));
        assert_eq!((rows[1].rays_per_second, rows[1].slowest_tile), (4000.0, [1, 2, 3, 4]));
    }

    #[test]
    fn images_that_differ_are_shouted_about() {
        let mut runs = vec![vec![timed(1)], vec![timed(1)]];
        assert!(verdict(&rows(&[1, 2], &runs), true).contains("same image, hash h"));
        runs[1][0].hash = "other".into();
        assert!(verdict(&rows(&[1, 2], &runs), false).contains("2 threads: other"));
    }
}
