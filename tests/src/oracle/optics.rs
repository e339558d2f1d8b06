//! Reflection, refraction and Fresnel's equations as a textbook prints them.

use glam::DVec3;

/// The mirrored direction.
pub fn reflected(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// The refracted direction (Snell's law), from index `n1` to index `n2`; `normal` is on the side that the ray comes
/// from. `None` with total reflection.
pub fn refracted(direction: DVec3, normal: DVec3, n1: f64, n2: f64) -> Option<DVec3> {
    let tangential = (n1 / n2) * (direction - direction.dot(normal) * normal);
    let rest = 1.0 - tangential.length_squared();
    (rest > 0.0).then(|| tangential - rest.sqrt() * normal)
}

/// Fraction of unpolarised light that is reflected, for a cosine on the side of `n1`: the mean of both polarisations.
pub fn reflectance(cosine: f64, n1: f64, n2: f64) -> f64 {
    let sine_squared = (n1 / n2) * (n1 / n2) * (1.0 - cosine * cosine);
    if sine_squared >= 1.0 {
        return 1.0;
    }
    let other = (1.0 - sine_squared).sqrt();
    let across = (n1 * cosine - n2 * other) / (n1 * cosine + n2 * other);
    let parallel = (n2 * cosine - n1 * other) / (n2 * cosine + n1 * other);
    (across * across + parallel * parallel) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_angles_of_glass() {
        assert!((reflectance(1.0, 1.0, 1.5) - 0.04).abs() < 1e-15);
        // At Brewster's angle only one polarisation is left: ½ ((n² − 1)/(n² + 1))².
        let brewster = libm::cos(libm::atan(1.5));
        let half = 1.25 / 3.25;
        assert!((reflectance(brewster, 1.0, 1.5) - half * half / 2.0).abs() < 1e-15);
        assert_eq!(reflectance(libm::cos(0.7300), 1.5, 1.0), 1.0);
        assert!(reflectance(libm::cos(0.7295), 1.5, 1.0) < 1.0);
    }

    #[test]
    fn refraction_obeys_snell_and_can_be_undone() {
        let (normal, s) = (DVec3::Z, 0.6);
        let into = refracted(DVec3::new(s, 0.0, -0.8), normal, 1.0, 1.5).unwrap();
        assert!((into.x - s / 1.5).abs() < 1e-15 && (into.length() - 1.0).abs() < 1e-15);
        let back = refracted(-into, -normal, 1.5, 1.0).unwrap();
        assert!(back.distance(DVec3::new(-s, 0.0, 0.8)) < 1e-15);
        assert_eq!(reflected(DVec3::new(s, 0.0, -0.8), normal), DVec3::new(s, 0.0, 0.8));
        assert!(refracted(DVec3::new(0.8, 0.0, -0.6), normal, 1.5, 1.0).is_none());
    }
}
