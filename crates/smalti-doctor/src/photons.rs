//! Light that photons bring, beside the same light by paths.
//!
//! With `auto` all other light is that of `path`, sample by sample: that paths find of the caustic map's light what photons
//! bring says that the two integrators agree. With `photon` the light of final gathers stands beside that of `auto`.

use smalti_core::film::Film;
use smalti_core::settings::{Integrator, Settings};
use smalti_measure::{CrosscheckStatement, FEWEST_FINDS, bias_statement};

use crate::finding::{Finding, Verdict};
use crate::pictures::{ALLOWED, LIMIT, Studio, means, moments, same_light};
use crate::{DoctorError, Patient};

/// What photons may lack of the picture's light: their discs reach beyond edges.
const LACKING: f64 = 0.005;

/// Compares by the films of the scene's seeds, where photons are asked.
pub fn check(
    patient: &Patient<'_>,
    (studio, films): (&Studio<'_>, &[Film]),
    tell: &mut impl FnMut(Finding),
) -> Result<(), DoctorError> {
    let Patient { world, settings, .. } = *patient;
    let Some(biases) = films.iter().map(bias_statement).collect::<Option<Vec<_>>>() else { return Ok(()) };
    let checks: Vec<CrosscheckStatement> = biases.iter().filter_map(|bias| bias.crosscheck).collect();
    tell(caustics(&checks));
    if settings.integrator == Integrator::Photon {
        let auto = Settings { integrator: Integrator::Auto, ..settings.clone() };
        let auto = means(&studio.films(world, &auto)?);
        tell(same_light(("photons", "beside auto"), (&auto, &means(films)), ALLOWED + LACKING));
    }
    Ok(())
}

/// Whether photons bring the light that paths find. Paths that find less prove nothing: they meet small lamps seldom.
fn caustics(checks: &[CrosscheckStatement]) -> Finding {
    let what = ("photons", "beside paths");
    if checks.len() < 2 || checks.iter().map(|check| check.finds).sum::<f64>() < FEWEST_FINDS {
        let says = "paths meet too little of the light that photons bring: not compared";
        return Finding::new(what, (true, Verdict::Warning), None, says);
    }
    let of = |value: fn(&CrosscheckStatement) -> f64| moments(&checks.iter().map(value).collect::<Vec<f64>>());
    let ((photons, _), (paths, _)) = (of(|check| check.by_photons), of(|check| check.by_paths));
    let (lacks, error) = of(|check| check.by_paths - check.by_photons);
    let is_sound = lacks <= LACKING || lacks <= LIMIT * error;
    let [brought, found, noise] = [photons, paths, error].map(|share| 100.0 * share);
    let says = format!("photons bring {brought:.3} % of the light, paths find {found:.3} % ± {noise:.3} % of it again");
    Finding::new(what, (is_sound, Verdict::Failed), 100.0 * lacks, says)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pictures::SEEDS;

    fn check(by_photons: f64, by_paths: f64) -> CrosscheckStatement {
        CrosscheckStatement { by_photons, by_paths, interval: None, finds: 30.0, lacking: 0.0, lacking_high: 0.0 }
    }

    #[test]
    fn light_that_photons_lack_is_found() {
        let of = |by_photons, by_paths: &dyn Fn(f64) -> f64| {
            let checks: Vec<_> = (0..SEEDS).map(|seed| check(by_photons, by_paths(seed as f64))).collect();
            caustics(&checks).verdict
        };
        assert_eq!(of(0.02, &|seed| 0.07 + 0.001 * seed), Verdict::Failed);
        // Noise, a small difference, and paths that find less.
        assert_eq!(of(0.02, &|seed| 0.02 * seed), Verdict::Sound);
        assert_eq!(of(0.070, &|seed| 0.0745 + 1e-6 * seed), Verdict::Sound);
        assert_eq!(of(0.07, &|seed| 0.02 + 0.001 * seed), Verdict::Sound);
    }

    #[test]
    fn little_light_is_not_compared() {
        let few = CrosscheckStatement { finds: 1.0, ..check(0.02, 0.07) };
        for checks in [&[few; 8][..], &[check(0.02, 0.07)], &[]] {
            let found = caustics(checks);
            assert!(found.verdict == Verdict::Sound && found.says.contains("not compared"), "{found:?}");
        }
    }
}
