//! What image files say of their origin. A function of the render's inputs: no clock, no machine.

use smalti_image::Provenance;

use crate::summary::Summary;

/// The part of the summary that is stored in image files.
pub fn of(summary: &Summary) -> Provenance {
    let mut provenance = Provenance::new();
    provenance.push("version", summary.version);
    provenance.push("estimator", summary.estimator);
    provenance.push("scene", &summary.scene);
    provenance.push("scene_hash", &summary.scene_hash);
    provenance.push("settings", &summary.settings);
    provenance.push("seed", summary.settings.seed);
    provenance.push("samples_least", summary.samples_least);
    provenance.push("samples_most", summary.samples_most);
    provenance.push("hash", &summary.hash);
    if let Some(error) = &summary.error {
        provenance.push("relative_error", error.relative_error);
        provenance.push("relative_error_low", error.relative_error_low);
        if let Some(high) = error.relative_error_high {
            provenance.push("relative_error_high", high);
        }
    }
    if !summary.biases.is_empty() {
        provenance.push("bias", summary.biases.join("; "));
    }
    if let Some(command) = &summary.reproduce {
        provenance.push("reproduce", command);
    }
    provenance
}
