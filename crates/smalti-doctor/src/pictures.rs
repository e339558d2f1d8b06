//! Pictures of the scene at its extremes, beside the one of the scene as it is.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use rayon::ThreadPool;
use smalti_core::film::{Film, Image};
use smalti_core::render::{Level, Renderer};
use smalti_core::scene::World;
use smalti_core::settings::Settings;
use smalti_image::hash;
use smalti_scheduler::{Cancel, Outcome, render};

use crate::finding::{Finding, Verdict, counted};
use crate::turned::{moved, scaled, size, smallest_lamp, turned};
use crate::{DoctorError, Patient};

/// Powers of two by which lengths are multiplied: no bit may change.
const POWERS: [i32; 6] = [-40, -20, -1, 1, 20, 40];

/// Powers of ten: coordinates are rounded anew, and hardly a sample may change.
const DECADES: [i32; 4] = [-6, -3, 3, 6];

/// The scene is moved by so many times its size, as powers of ten.
const AWAY: [i32; 5] = [3, 4, 5, 6, 7];

/// Seeds of the pictures that are compared by their noise.
pub const SEEDS: u64 = 8;

/// Two-sided 1e-6 of Student's t with 7 degrees of freedom: a mean that is off by more is not off by chance.
pub const LIMIT: f64 = 14.2;

/// What the mean of the picture may change by, whatever its noise: hits at edges are rounded otherwise.
pub const ALLOWED: f64 = 1e-4;

/// Side of the square tiles of a film.
const TILE: u32 = 32;

/// Renders every variant and compares; `films` are those of the scene as it is.
pub fn check(
    patient: &Patient<'_>,
    (studio, films): (&Studio<'_>, &[Film]),
    tell: &mut impl FnMut(Finding),
) -> Result<(), DoctorError> {
    let Patient { world, settings, .. } = *patient;
    let base = studio.render(world, settings)?;
    samples(&base, tell);
    let image = base.film.develop();
    for k in POWERS {
        let (world, settings) = scaled(world, settings, power_of_two(k));
        tell(same_bits(("scale", format!("2^{k}")), &image, &studio.draw(&world, &settings)?));
    }
    for other in Level::available() {
        let drawn = Studio { level: other, ..*studio }.draw(world, settings)?;
        tell(same_bits(("simd", other.name()), &image, &drawn));
    }
    let as_it_is = means(films);
    for k in DECADES {
        let (world, settings) = scaled(world, settings, power_of_ten(k));
        tell(same_light(("scale", format!("10^{k}")), (&as_it_is, &means(&studio.films(&world, &settings)?)), ALLOWED));
    }
    // Along no axis and no edge.
    let way = DVec3::new(0.48, -0.6, 0.64);
    for k in AWAY {
        let far = moved(world, way * size(world) * power_of_ten(k));
        let found = means(&studio.films(&far, settings)?);
        tell(same_light(("moved", format!("10^{k} sizes")), (&as_it_is, &found), ALLOWED + coarseness(&far)));
    }
    for (axis, angle) in [(DVec3::Z, 0.5), (DVec3::new(0.6, 0.0, 0.8), 2.0), (way, 1.0)] {
        let turned = turned(world, DQuat::from_axis_angle(axis.normalize(), angle));
        let case = format!("{:.0}° about ({}, {}, {})", angle * 180.0 / PI, axis.x, axis.y, axis.z);
        tell(same_light(("turned", case), (&as_it_is, &means(&studio.films(&turned, settings)?)), ALLOWED));
    }
    Ok(())
}

/// Where pictures are taken.
#[derive(Clone, Copy)]
pub struct Studio<'a> {
    /// The workers.
    pub pool: &'a ThreadPool,
    /// Their SIMD level.
    pub level: Level,
}

impl Studio<'_> {
    /// A render and what came of its samples.
    pub fn render(&self, world: &World, settings: &Settings) -> Result<Outcome, DoctorError> {
        let renderer = self.pool.install(|| Renderer::new(world, settings.clone(), self.level))?;
        let film = Film::new(settings.area(), TILE);
        let outcome = render(&renderer, film, self.pool, &Cancel::default(), None);
        outcome.map_err(|panic| DoctorError::Panicked(panic.to_string()))
    }

    fn draw(&self, world: &World, settings: &Settings) -> Result<Image, DoctorError> {
        Ok(self.render(world, settings)?.film.develop())
    }

    /// The films with each seed.
    pub fn films(&self, world: &World, settings: &Settings) -> Result<Vec<Film>, DoctorError> {
        let film = |seed: u64| {
            let settings = Settings { seed: settings.seed.wrapping_add(seed), ..settings.clone() };
            Ok(self.render(world, &settings)?.film)
        };
        (0..SEEDS).map(film).collect()
    }
}

/// The mean of the picture of each film.
pub fn means(films: &[Film]) -> Vec<f64> {
    let mean = |film: &Film| {
        let image = film.develop();
        let sum: f64 = image.pixels.as_flattened().iter().map(|value| f64::from(*value)).sum();
        sum / (3 * image.pixels.len()) as f64
    };
    films.iter().map(mean).collect()
}

/// Mean of some values, at least two, and its standard error.
pub fn moments(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|each| (each - mean) * (each - mean)).sum::<f64>();
    (mean, (squares / (count * (count - 1.0))).sqrt())
}

/// What became of the samples of the picture.
fn samples(base: &Outcome, tell: &mut impl FnMut(Finding)) {
    let dropped = base.rejected.count;
    let first = base.rejected.first.first().map(|first| {
        let (x, y) = first.pixel;
        format!(
            "; the first is sample {} of pixel {x} {y}: `smalti pixel SCENE {x} {y} --sample {}`",
            first.sample, first.sample
        )
    });
    let says = match dropped {
        0 => "every sample is finite".to_owned(),
        _ => format!("{dropped} are not finite and count as 0{}", first.unwrap_or_default()),
    };
    tell(Finding::new(("samples", "dropped"), (dropped == 0, Verdict::Failed), dropped as f64, says));
    let says = match base.capped {
        0 => "every path ends by itself".to_owned(),
        capped => format!("{capped} paths were ended by the cap on bounces: light is missing"),
    };
    tell(Finding::new(("samples", "capped"), (base.capped == 0, Verdict::Warning), base.capped as f64, says));
    if let Some(error) = smalti_measure::error_statement(&base.film) {
        let pixels = error.uncertified_pixels;
        let says = match pixels {
            0 => "every pixel's noise can be judged".to_owned(),
            _ => format!("{} too uneven to be judged with so few samples", counted(pixels, "pixel")),
        };
        tell(Finding::new(("samples", "uncertified"), (true, Verdict::Warning), pixels as f64, says));
    }
}

/// Whether not a bit has changed; where the first one has.
fn same_bits(what: (&'static str, impl Into<String>), expected: &Image, found: &Image) -> Finding {
    let differs = |(a, b): (&[f32; 3], &[f32; 3])| a.map(f32::to_bits) != b.map(f32::to_bits);
    let changed = expected.pixels.iter().zip(&found.pixels).filter(|pair| differs(*pair)).count();
    let says = match expected.pixels.iter().zip(&found.pixels).position(differs) {
        None => format!("the same bits ({})", &hash(found)[..8]),
        Some(first) => {
            let (x, y) = (first as u32 % expected.width, first as u32 / expected.width);
            let (a, b) = (expected.pixels[first], found.pixels[first]);
            format!("{} changed; the first is {x} {y}: {a:?} became {b:?}", counted(changed, "pixel"))
        }
    };
    Finding::new(what, (changed == 0, Verdict::Failed), changed as f64, says)
}

/// What the light of the smallest lamp may change by because f64 is coarse where it is.
fn coarseness(world: &World) -> f64 {
    let largest = world.bounds().map_or(0.0, |(low, high)| low.abs().max(high.abs()).max_element());
    let least = smallest_lamp(world).unwrap_or_else(|| size(world));
    4.0 * largest * f64::EPSILON / least
}

/// Whether the means of pictures with the same seeds differ by no more than noise, or by so little of the brightness.
pub fn same_light(
    what: (&'static str, impl Into<String>),
    (expected, found): (&[f64], &[f64]),
    allowed: f64,
) -> Finding {
    let differences: Vec<f64> = expected.iter().zip(found).map(|(a, b)| b - a).collect();
    let (mean, error) = moments(&differences);
    let brightness = expected.iter().sum::<f64>() / expected.len() as f64;
    let is_same = mean.abs() <= allowed * brightness || mean.abs() <= LIMIT * error;
    let [change, noise] = [mean, error].map(|value| if brightness > 0.0 { 100.0 * value / brightness } else { value });
    if LIMIT * error > brightness && is_same {
        let says = format!("brightness {change:+.0} % ± {noise:.0} %: too noisy to tell");
        return Finding::new(what, (false, Verdict::Warning), change, says);
    }
    let says = match expected == found {
        true => "the same light to the last bit".to_owned(),
        false => format!("brightness {change:+.4} % ± {noise:.4} %"),
    };
    Finding::new(what, (is_same && mean.is_finite(), Verdict::Failed), change, says)
}

/// 2^k.
fn power_of_two(k: i32) -> f64 {
    f64::from_bits(((1023 + i64::from(k)) as u64) << 52)
}

/// 10^k, as exactly as f64 can hold it.
fn power_of_ten(k: i32) -> f64 {
    let power = (0..k.abs()).fold(1.0, |power, _| power * 10.0);
    if k < 0 { 1.0 / power } else { power }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_bit_is_found() {
        let image = |value: f32| Image { width: 2, height: 1, pixels: vec![[1.0; 3], [value, 0.0, 0.0]] };
        assert_eq!(same_bits(("scale", "2^1"), &image(0.5), &image(0.5)).verdict, Verdict::Sound);
        let found = same_bits(("scale", "2^1"), &image(0.5), &image(0.5f32.next_up()));
        assert_eq!((found.verdict, found.figure), (Verdict::Failed, Some(1.0)));
        assert!(found.says.contains("the first is 1 0"), "{}", found.says);
        assert_eq!(same_bits(("scale", "2^1"), &image(0.0), &image(-0.0)).verdict, Verdict::Failed);
    }

    #[test]
    fn lost_light_is_told_from_noise() {
        let seeds = |of: &dyn Fn(f64) -> f64| (0..SEEDS).map(|k| of(k as f64)).collect::<Vec<f64>>();
        let base = seeds(&|k| 1.0 + 0.01 * (k - 3.5));
        let of = |found: Vec<f64>| same_light(("turned", ""), (&base, &found), ALLOWED).verdict;
        assert_eq!(of(base.clone()), Verdict::Sound);
        assert_eq!(of(base.iter().rev().copied().collect()), Verdict::Sound);
        assert_eq!(of(base.iter().map(|mean| mean * 1.00005).collect()), Verdict::Sound);
        assert_eq!(of(base.iter().map(|mean| mean * 0.998).collect()), Verdict::Failed);
        assert_eq!(of(base.iter().map(|_| f64::NAN).collect()), Verdict::Failed);
        assert_eq!(of(seeds(&|k| if k == 3.0 { 8.0 } else { 0.0 })), Verdict::Warning);
    }
}
