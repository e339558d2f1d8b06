//! What short renders say: which settings have the least error for their cost, and what error to expect.

use serde::Serialize;
use smalti_core::film::ROUND;
use smalti_core::settings::Settings;
use smalti_scheduler::{FIRST_LOOK, MOST_SAMPLES};

use crate::args::ImageArgs;
use crate::names::QualityArg;

/// Shadow rays that are tried, besides the scene's own.
const SHADOW_RAYS: [u32; 3] = [1, 2, 4];

/// Settings that are tried.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Candidate {
    pub shadow_rays: u32,
    pub adaptive: bool,
}

impl Candidate {
    /// The scene's own settings, then those with other shadow rays, unless these were typed.
    pub fn of_shadow_rays(settings: &Settings, typed: &ImageArgs) -> Vec<Self> {
        let own = Self { shadow_rays: settings.shadow_rays, adaptive: settings.adaptive };
        let others = SHADOW_RAYS.into_iter().filter(|rays| typed.shadow_rays.is_none() && *rays != own.shadow_rays);
        std::iter::once(own).chain(others.map(|shadow_rays| Self { shadow_rays, ..own })).collect()
    }

    /// With samples where the noise is instead of evenly, or the other way round; `None` if that was typed.
    pub fn otherwise(self, typed: &ImageArgs) -> Option<Self> {
        typed.adaptive.is_none().then_some(Self { adaptive: !self.adaptive, ..self })
    }
}

/// What a short render told.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pilot {
    #[serde(flatten)]
    pub candidate: Candidate,
    /// Samples a pixel.
    pub spp: u32,
    /// Cost of a camera path in rays, that of photons included; a shadow ray counts as a quarter of another.
    pub cost: f64,
    /// Its relative error; null where its samples were not finite.
    pub relative_error: Option<f64>,
    /// Whether that is all of it: no bright light was met so seldom that there may be more.
    pub certain: bool,
}

impl Pilot {
    /// Square of the relative error of an image with one sample a pixel.
    fn noise(&self) -> Option<f64> {
        Some(self.relative_error? * self.relative_error? * f64::from(self.spp))
    }

    /// Squared error times cost: what no number of samples changes.
    pub fn inefficiency(&self) -> Option<f64> {
        Some(self.noise()? * self.cost)
    }
}

/// The pilot with the least squared error times cost; the first of equals, and of those that tell nothing.
pub fn best(pilots: &[Pilot]) -> Option<usize> {
    let value = |index: &usize| pilots[*index].inefficiency().unwrap_or(f64::INFINITY);
    (0..pilots.len()).min_by(|a, b| value(a).total_cmp(&value(b)))
}

/// What short renders came to; the first is of the settings that the scene has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    pub pilots: Vec<Pilot>,
}

impl Choice {
    /// What was chosen; `None` if there was no time for any.
    pub fn best(&self) -> Option<&Pilot> {
        best(&self.pilots).map(|best| &self.pilots[best])
    }

    /// By what factor squared error times cost is less than with the scene's own settings.
    fn gain(&self) -> Option<f64> {
        let gain = self.pilots.first()?.inefficiency()? / self.best()?.inefficiency()?;
        gain.is_finite().then_some(gain)
    }

    /// The account of the choice for a render of `most` samples a pixel at most; `by` × `by` pixels become one.
    pub fn record(self, name: QualityArg, most: Option<u32>, by: u32) -> QualityRecord {
        let noise = self.best().and_then(Pilot::noise).map(|noise| noise / f64::from(by * by));
        let spp = noise.map(|noise| samples(noise, name.error()).min(most.unwrap_or(u32::MAX)));
        QualityRecord {
            name: name.name(),
            target_error: name.error(),
            expected_error: noise.zip(spp).map(|(noise, spp)| (noise / f64::from(spp)).sqrt()),
            expected_spp: spp,
            certain: self.best().is_some_and(|best| best.certain),
            gain: self.gain(),
            pilots: self.pilots,
        }
    }
}

/// Samples a pixel that bring `noise` down to `error`; the error is not looked at before [`FIRST_LOOK`].
fn samples(noise: f64, error: f64) -> u32 {
    let samples = (noise / (error * error)).ceil().min(f64::from(MOST_SAMPLES)) as u32;
    samples.next_multiple_of(ROUND).max(FIRST_LOOK)
}

/// What `--quality` came to. The names of the fields are a promise: summaries carry them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QualityRecord {
    /// `draft`, `good` or `final`.
    pub name: &'static str,
    /// Relative error that it stands for.
    pub target_error: f64,
    /// Relative error by noise to expect of the samples below; null if no short render told one. `--time` may allow
    /// fewer.
    pub expected_error: Option<f64>,
    /// Samples a pixel that should do, or as many as `--spp` allows.
    pub expected_spp: Option<u32>,
    /// Whether the error that is to be expected can be no larger: no bright light was met so seldom by short renders.
    pub certain: bool,
    /// By what factor squared error times cost is less than with the scene's own settings.
    pub gain: Option<f64>,
    /// The short renders, the one with the scene's own settings first.
    pub pilots: Vec<Pilot>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::names::SwitchArg;

    fn pilot(shadow_rays: u32, adaptive: bool, cost: f64, relative_error: Option<f64>) -> Pilot {
        Pilot { candidate: Candidate { shadow_rays, adaptive }, spp: 64, cost, relative_error, certain: true }
    }

    /// Ten shadow rays are better, four have less error for their rays, and adaptive sampling has less still.
    fn choice() -> Choice {
        let pilots = vec![
            pilot(10, false, 60.0, Some(0.1)),
            pilot(1, false, 10.0, Some(0.3)),
            pilot(4, false, 25.0, Some(0.12)),
            pilot(4, true, 25.0, Some(0.1)),
        ];
        Choice { pilots }
    }

    #[test]
    fn the_least_squared_error_times_cost_is_chosen() {
        let choice = choice();
        assert_eq!(best(&choice.pilots), Some(3));
        assert_eq!(best(&choice.pilots[..3]), Some(2));
        assert!((choice.gain().unwrap() - 60.0 / 25.0).abs() < 1e-12);
    }

    #[test]
    fn twice_the_samples_at_the_same_cost_change_nothing() {
        let [short, long] = [(64, 0.1), (128, 0.1 / 2.0f64.sqrt())]
            .map(|(spp, error)| Pilot { spp, ..pilot(1, false, 10.0, Some(error)) }.inefficiency().unwrap());
        assert!((short / long - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_scenes_own_settings_win_where_nothing_is_better() {
        let same = [pilot(10, false, 10.0, Some(0.1)), pilot(1, false, 10.0, Some(0.1))];
        assert_eq!(best(&same), Some(0));
        assert_eq!(best(&[pilot(10, false, 1.0, None), pilot(1, false, 1.0, None)]), Some(0));
        assert_eq!(best(&[pilot(10, false, 1.0, None), pilot(1, false, 1.0, Some(9.0))]), Some(1));
        assert_eq!(Choice::default().best(), None);
    }

    #[test]
    fn what_was_typed_is_not_tried_otherwise() {
        let settings = Settings { shadow_rays: 2, ..Settings::default() };
        let tried = |typed: &ImageArgs| {
            let first = Candidate::of_shadow_rays(&settings, typed);
            (first.iter().map(|of| of.shadow_rays).collect::<Vec<_>>(), first[0].otherwise(typed).is_some())
        };
        assert_eq!(tried(&ImageArgs::default()), (vec![2, 1, 4], true));
        assert_eq!(tried(&ImageArgs { shadow_rays: Some(2), ..ImageArgs::default() }), (vec![2], true));
        assert_eq!(
            tried(&ImageArgs { adaptive: Some(SwitchArg::Off), ..ImageArgs::default() }),
            (vec![2, 1, 4], false)
        );
    }

    #[test]
    fn errors_and_samples_to_expect() {
        // One sample a pixel has an error of 0.8: 712 have 3 %, in rounds 720.
        let record = |quality, most, by| {
            let record = choice().record(quality, most, by);
            (record.expected_spp.unwrap(), (record.expected_error.unwrap() * 1e6).round())
        };
        assert_eq!(record(QualityArg::Good, None, 1), (720, 29_814.0));
        assert_eq!(record(QualityArg::Good, None, 2), (192, 28_868.0));
        assert_eq!(record(QualityArg::Draft, None, 1), (64, 100_000.0));
        assert_eq!(record(QualityArg::Final, Some(16), 1), (16, 200_000.0));
        let nothing = Choice::default().record(QualityArg::Draft, None, 1);
        assert_eq!((nothing.expected_error, nothing.expected_spp, nothing.gain), (None, None, None));
        assert!(!nothing.certain && choice().record(QualityArg::Draft, None, 1).certain);
    }
}
