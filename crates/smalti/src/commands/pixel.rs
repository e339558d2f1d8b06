//! `smalti pixel`: one pixel looked at closely, sample by sample or bounce by bounce.

use serde::Serialize;
use smalti_core::film::{Counts, Pixel};
use smalti_core::render::{Renderer, Vertex};

use crate::args::PixelArgs;
use crate::exit::{Failure, Status};
use crate::frontend::{self, Mode};
use crate::job::Job;
use crate::print;
use crate::table::{Align, table};

/// Samples that are listed one by one.
const BRIGHTEST: usize = 8;

/// What is looked at.
#[derive(Debug, Serialize)]
struct Subject {
    scene: String,
    scene_hash: String,
    pixel: [u32; 2],
    seed: u64,
}

/// One sample, bounce by bounce.
#[derive(Serialize)]
struct SampleRecord {
    #[serde(flatten)]
    subject: Subject,
    sample: u32,
    radiance: [f32; 3],
    vertices: Vec<VertexRecord>,
}

/// A ray of a sample.
#[derive(Serialize)]
pub struct VertexRecord {
    bounce: u32,
    origin: [f64; 3],
    direction: [f64; 3],
    hit: Option<String>,
    distance: Option<f64>,
    material: Option<&'static str>,
    throughput: [f32; 3],
    radiance: [f32; 3],
}

/// All samples of a pixel.
#[derive(Debug, Serialize)]
struct PixelRecord {
    #[serde(flatten)]
    subject: Subject,
    spp: u32,
    /// The pixel's value.
    mean: [f64; 3],
    /// Standard error of the mean; null with fewer than two complete rounds.
    standard_error: Option<[f64; 3]>,
    nonfinite: u32,
    brightest: Vec<Bright>,
}

/// A sample and what it contributes.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Bright {
    sample: u32,
    radiance: [f32; 3],
    /// Its part of the sum of all samples, over the three channels; null where the sum is 0.
    share: Option<f64>,
    bounces: u32,
}

/// Runs the command.
pub fn run(args: &PixelArgs) -> Result<Status, Failure> {
    let mode = Mode::of_terminal();
    let job = frontend::set_up(mode, |told| Job::load(&args.scene, &args.image, args.simd.simd, told))?;
    check_pixel(&job, args)?;
    let renderer = frontend::set_up(mode, |told| job.renderer(told))?;
    match args.sample {
        Some(sample) => print_sample(args, sample_record(&job, &renderer, args, sample))?,
        None => print_pixel(args, pixel_record(&job, &renderer, args))?,
    }
    Ok(Status::Done)
}

fn check_pixel(job: &Job, args: &PixelArgs) -> Result<(), Failure> {
    let (width, height) = (job.settings.width, job.settings.height);
    if args.x < width && args.y < height {
        return Ok(());
    }
    Err(Failure::user(format!(
        "pixel {} {} is outside the image: columns are 0 to {}, rows 0 to {}",
        args.x,
        args.y,
        width - 1,
        height - 1
    )))
}

fn subject(job: &Job, args: &PixelArgs) -> Subject {
    Subject {
        scene: job.path.display().to_string(),
        scene_hash: job.scene_hash.clone(),
        pixel: [args.x, args.y],
        seed: job.settings.seed,
    }
}

fn sample_record(job: &Job, renderer: &Renderer, args: &PixelArgs, sample: u32) -> SampleRecord {
    let (vertices, radiance) = renderer.replay((args.x, args.y), sample);
    SampleRecord {
        subject: subject(job, args),
        sample,
        radiance,
        vertices: vertices.into_iter().map(vertex_record).collect(),
    }
}

/// The rays of a sample.
pub fn replayed(renderer: &Renderer, pixel: (u32, u32), sample: u32) -> Vec<VertexRecord> {
    renderer.replay(pixel, sample).0.into_iter().map(vertex_record).collect()
}

fn vertex_record(vertex: Vertex) -> VertexRecord {
    let Vertex { bounce, origin, direction, hit, distance, material, throughput, radiance } = vertex;
    VertexRecord {
        bounce,
        origin,
        direction,
        hit: hit.map(|what| what.to_string()),
        distance,
        material,
        throughput,
        radiance,
    }
}

fn pixel_record(job: &Job, renderer: &Renderer, args: &PixelArgs) -> PixelRecord {
    let replayed = (0..job.settings.spp).map(|sample| {
        let (vertices, radiance) = renderer.replay((args.x, args.y), sample);
        let bounces = vertices.iter().map(|vertex| vertex.bounce).max().unwrap_or(0);
        Bright { sample, radiance, share: None, bounces }
    });
    let ((pixel, counts), nonfinite, brightest) = gather(replayed);
    let deviation = |variance: [f64; 3]| variance.map(f64::sqrt);
    PixelRecord {
        subject: subject(job, args),
        spp: job.settings.spp,
        mean: pixel.mean(&counts),
        standard_error: pixel.variance_of_mean(&counts).map(deviation),
        nonfinite,
        brightest,
    }
}

/// The pixel as the film sums it up, the number of samples that were not finite, and the brightest samples.
fn gather(samples: impl Iterator<Item = Bright>) -> ((Pixel, Counts), u32, Vec<Bright>) {
    let (mut pixel, mut counts) = (Pixel::default(), Counts::default());
    let mut nonfinite = 0;
    let mut brightest: Vec<Bright> = Vec::new();
    for sample in samples {
        let finite = sample.radiance.iter().all(|value| value.is_finite());
        pixel.add(counts.batch(), 1.0, if finite { sample.radiance } else { [0.0; 3] });
        counts.add_plain();
        if finite {
            brightest.push(sample);
            brightest.sort_by(|a, b| total(b.radiance).total_cmp(&total(a.radiance)));
            brightest.truncate(BRIGHTEST);
        } else {
            nonfinite += 1;
        }
    }
    let sum: f64 = pixel.sums.as_flattened().iter().sum();
    for bright in &mut brightest {
        bright.share = (sum > 0.0).then(|| total(bright.radiance) / sum);
    }
    ((pixel, counts), nonfinite, brightest)
}

fn total(radiance: [f32; 3]) -> f64 {
    radiance.iter().map(|&value| f64::from(value)).sum()
}

fn print_sample(args: &PixelArgs, record: SampleRecord) -> Result<(), Failure> {
    if args.json {
        return print::json(&record);
    }
    let heading = format!("{}: pixel {} {}, sample {}\n", record.subject.scene, args.x, args.y, record.sample);
    let vertices = vertex_table(&record.vertices);
    print::result(&format!("{heading}{vertices}\n  radiance of the sample {}\n", triple(record.radiance)))
}

/// The rays of a sample as a table.
pub fn vertex_table(vertices: &[VertexRecord]) -> String {
    let heading = ["bounce", "hit", "material", "distance", "from", "direction", "throughput", "radiance so far"];
    let mut rows = vec![heading.map(String::from).to_vec()];
    rows.extend(vertices.iter().map(|vertex| {
        vec![
            vertex.bounce.to_string(),
            vertex.hit.clone().unwrap_or("nothing".into()),
            vertex.material.unwrap_or("").into(),
            vertex.distance.map(|metres| format!("{metres:.6}")).unwrap_or_default(),
            triple(vertex.origin),
            triple(vertex.direction),
            triple(vertex.throughput),
            triple(vertex.radiance),
        ]
    }));
    let (left, right) = (Align::Left, Align::Right);
    table(&[right, left, left, right, left, left, left, left], &rows)
}

fn print_pixel(args: &PixelArgs, record: PixelRecord) -> Result<(), Failure> {
    if args.json {
        return print::json(&record);
    }
    let mut text = format!("{}: pixel {} {}, {} samples\n", record.subject.scene, args.x, args.y, record.spp);
    text += &format!("  mean {}\n", triple(record.mean));
    if let Some(error) = record.standard_error {
        text += &format!("  standard error {}\n", triple(error));
    }
    if record.nonfinite > 0 {
        text += &format!("  {} samples were not finite and count as 0\n", record.nonfinite);
    }
    print::result(&format!("{text}\nThe brightest samples\n{}", bright_table(&record.brightest)))
}

fn bright_table(brightest: &[Bright]) -> String {
    let mut rows = vec![["sample", "share", "bounces", "radiance"].map(String::from).to_vec()];
    rows.extend(brightest.iter().map(|bright| {
        let share = bright.share.map(|share| format!("{:.1} %", 100.0 * share)).unwrap_or_default();
        vec![bright.sample.to_string(), share, bright.bounces.to_string(), triple(bright.radiance)]
    }));
    table(&[Align::Right, Align::Right, Align::Right, Align::Left], &rows)
}

/// Three numbers with six significant places.
fn triple<T: Into<f64>>(values: [T; 3]) -> String {
    values.map(|value| format!("{:>10.6}", value.into())).join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bright(sample: u32, value: f32) -> Bright {
        Bright { sample, radiance: [value; 3], share: None, bounces: 0 }
    }

    #[test]
    fn the_brightest_come_first_and_shares_add_up() {
        let ((pixel, counts), nonfinite, brightest) =
            gather([1.0, 5.0, 2.0].into_iter().zip(0..).map(|(v, s)| bright(s, v)));
        assert_eq!((pixel.mean(&counts), nonfinite), ([8.0 / 3.0; 3], 0));
        assert_eq!(brightest.iter().map(|bright| bright.sample).collect::<Vec<_>>(), [1, 2, 0]);
        assert_eq!(brightest.iter().map(|bright| bright.share.unwrap()).sum::<f64>(), 1.0);
    }

    #[test]
    fn what_is_not_finite_counts_as_black() {
        let ((pixel, counts), nonfinite, brightest) = gather([bright(0, f32::NAN), bright(1, 3.0)].into_iter());
        assert_eq!((pixel.mean(&counts), nonfinite, brightest.len()), ([1.5; 3], 1, 1));
    }

    #[test]
    fn only_some_are_listed_and_black_has_no_share() {
        let (_, _, brightest) = gather((0..100).map(|sample| bright(sample, 0.0)));
        assert_eq!(brightest.len(), BRIGHTEST);
        assert!(brightest.iter().all(|bright| bright.share.is_none()));
    }
}
