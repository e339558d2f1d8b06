//! The account of a photon map that was made visible: one record, shown as text or as JSON. Its field names are a
//! promise.

use serde::Serialize;
use smalti_core::photon::SUB_MAPS;
use smalti_image::Provenance;
use smalti_scheduler::{Outcome, Photons};

use super::picture::{Picture, Scale};
use super::request::{Lights, Request};
use crate::record::{self, PictureRecord, RunRecord, Work};
use crate::reproduce;

/// Everything that is told of a photon map. Times in seconds; what does not exist is null.
#[derive(Debug, Serialize)]
pub struct Summary {
    pub version: &'static str,
    /// The estimator: images of one are the same bit for bit, whatever the version.
    pub estimator: u32,
    pub scene: String,
    pub scene_hash: String,
    /// What is worth knowing about scene and settings and stops nothing, each a sentence.
    pub notes: Vec<String>,
    /// `caustic` or `global`.
    pub map: &'static str,
    /// `flux`, `density` or `bounces`.
    pub colour: &'static str,
    #[serde(flatten)]
    pub picture: PictureRecord,
    pub seed: u64,
    pub fresnel: &'static str,
    /// How far photons were asked to count, metres; null: by their density.
    pub radius: Option<f64>,
    pub lights: Lights,
    #[serde(flatten)]
    pub run: RunRecord,
    /// Photons of the map; of each sub-map as many.
    pub photons_emitted: u64,
    /// Photons that were sent before, to learn how far the others are to count.
    pub photons_ahead: u64,
    /// In the map; a photon of all light is stored wherever it meets a diffuse surface.
    pub photons_stored: u64,
    /// Photons that were not finite and were left out.
    pub photons_nonfinite: u64,
    pub flux: FluxRecord,
    /// How far photons count.
    pub radius_metres: Option<RadiusRecord>,
    pub photon_bytes: u64,
    /// The process's memory at its most, where the system tells.
    pub peak_bytes: Option<u64>,
    /// Of the linear image: with false colours, of the figures.
    pub hash: String,
    pub mean: [f64; 3],
    /// What false colours stand for; null without them.
    pub scale: Option<Scale>,
    /// Samples that were not finite.
    pub nonfinite: u64,
    /// `spp` or `interrupt`.
    pub stopped_by: &'static str,
    pub outputs: Vec<String>,
    /// Null after an interruption: no command gives that image.
    pub reproduce: Option<String>,
}

/// Where the light of the photons went, watts for each channel. What was emitted was stored, absorbed or escaped.
#[derive(Debug, Serialize)]
pub struct FluxRecord {
    /// For a caustic map only what was aimed at specular surfaces.
    pub emitted: [f64; 3],
    /// Where photons ended in the map; 0 for the map of all light, whose photons go on and are absorbed.
    pub stored: [f64; 3],
    pub absorbed: [f64; 3],
    /// What hit nothing.
    pub escaped: [f64; 3],
}

/// The smallest and the largest radius.
#[derive(Debug, Serialize)]
pub struct RadiusRecord {
    pub least: f64,
    pub most: f64,
}

/// The summary before anything is written; `scale` is that of the scene's frame, lengths by metre.
pub fn summary(request: &Request, work: Work, outcome: &Outcome, picture: &Picture, scale: f64) -> Summary {
    let (job, photons) = (&request.job, &outcome.photons);
    let settings = &job.settings;
    Summary {
        version: env!("CARGO_PKG_VERSION"),
        estimator: smalti_core::ESTIMATOR,
        scene: job.path.display().to_string(),
        scene_hash: job.scene_hash.clone(),
        notes: record::notes(job),
        map: request.map.name(),
        colour: request.colour.name(),
        picture: PictureRecord::new(job),
        seed: settings.seed,
        fresnel: settings.fresnel.name(),
        radius: settings.radius,
        lights: request.lights,
        run: RunRecord::new(job, work, outcome),
        photons_emitted: photons.account.photons,
        photons_ahead: photons.emitted - photons.account.photons,
        photons_stored: photons.stored,
        photons_nonfinite: photons.nonfinite,
        flux: flux(photons, scale),
        radius_metres: photons.radii.map(|radii| radii.map(|radius| f64::from(radius) / scale)).map(RadiusRecord::new),
        photon_bytes: photons.bytes,
        peak_bytes: None,
        hash: smalti_image::hash(&picture.image),
        mean: picture.image.mean(),
        scale: picture.coloured.as_ref().map(|(_, scale)| *scale),
        nonfinite: outcome.rejected.count,
        stopped_by: if outcome.interrupted { "interrupt" } else { "spp" },
        outputs: Vec::new(),
        reproduce: (!outcome.interrupted).then(|| reproduce(request)),
    }
}

impl RadiusRecord {
    fn new([least, most]: [f64; 2]) -> Self {
        Self { least, most }
    }
}

fn flux(photons: &Photons, scale: f64) -> FluxRecord {
    // Each sub-map has all the light once.
    let by = scale * scale * f64::from(SUB_MAPS);
    let watts = |flux: [f64; 3]| flux.map(|flux| flux / by);
    let account = &photons.account;
    FluxRecord {
        emitted: watts(account.emitted),
        stored: watts(account.stored),
        absorbed: watts(account.absorbed),
        escaped: watts(account.escaped),
    }
}

fn reproduce(request: &Request) -> String {
    let Request { job, map, colour, .. } = request;
    reproduce::photons_command(&job.path, &job.settings, (map.name(), colour.name()), job.camera())
}

/// What image files say of their origin: a function of the inputs, without clock and machine.
pub fn provenance(summary: &Summary) -> Provenance {
    let mut provenance = Provenance::new();
    provenance.push("version", summary.version);
    provenance.push("scene", &summary.scene);
    provenance.push("scene_hash", &summary.scene_hash);
    provenance.push("photon_map", format!("{}, {}", summary.map, summary.colour));
    provenance.push("photons_emitted", summary.photons_emitted);
    provenance.push("photons_stored", summary.photons_stored);
    provenance.push("seed", summary.seed);
    provenance.push("hash", &summary.hash);
    if let Some(scale) = &summary.scale {
        provenance.push("colours", scale);
    }
    if let Some(command) = &summary.reproduce {
        provenance.push("reproduce", command);
    }
    provenance
}
