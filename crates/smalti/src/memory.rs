//! Memory: what a film takes, what the machine has, what this process used.

use smalti_core::film::Pixel;
use smalti_core::photon::{Kind, Photons};
use smalti_core::settings::{Integrator, Rect, Settings};

/// Bytes that a render of `area` takes at least: the film and the linear image. `None`: more than can be counted.
pub fn film_bytes(area: Rect) -> Option<u64> {
    let each = size_of::<Pixel>() + size_of::<[f32; 3]>();
    u64::from(area.width).checked_mul(u64::from(area.height))?.checked_mul(each as u64)
}

/// Bytes that the photon maps of a render may take at most while they are built.
pub fn photon_bytes(settings: &Settings) -> u64 {
    let maps: &[Kind] = match settings.integrator {
        // Its caustic photons go on, and are stored as often as those of all light.
        Integrator::Auto => &[Kind::Global],
        Integrator::Photon => &[Kind::Caustic, Kind::Global],
        Integrator::Path | Integrator::Whitted => &[],
    };
    maps.iter().map(|map| map_bytes(*map, settings.photons_of_round())).sum()
}

/// Bytes that a map of `photons` emitted ones may take at most while it is built.
pub fn map_bytes(map: Kind, photons: u32) -> u64 {
    let stored = match map {
        Kind::Caustic | Kind::Shadow => 1,
        // A photon is stored at every diffuse bounce.
        Kind::Global => 7,
    };
    u64::from(photons) * stored * 2 * Photons::BYTES
}

/// The machine's memory in bytes, where the system tells (Linux).
pub fn total_bytes() -> Option<u64> {
    kilobytes(&std::fs::read_to_string("/proc/meminfo").ok()?, "MemTotal:")
}

/// The most memory that this process held so far in bytes, where the system tells (Linux).
pub fn peak_bytes() -> Option<u64> {
    kilobytes(&std::fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// The number of a line like `VmHWM:    2340 kB`, in bytes.
fn kilobytes(text: &str, key: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
    let number: u64 = rest.split_whitespace().next()?.parse().ok()?;
    number.checked_mul(1024)
}

/// Bytes in words: `840 GB`.
pub fn in_words(bytes: u64) -> String {
    let units = ["B", "kB", "MB", "GB", "TB", "PB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 999.5 && unit + 1 < units.len() {
        value /= 1000.0;
        unit += 1;
    }
    if unit > 0 && value < 9.95 { format!("{value:.1} {}", units[unit]) } else { format!("{value:.0} {}", units[unit]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_takes_108_bytes() {
        assert_eq!(film_bytes(Rect { x: 0, y: 0, width: 10, height: 10 }), Some(10_800));
        assert_eq!(film_bytes(Rect { x: 0, y: 0, width: u32::MAX, height: u32::MAX }), None);
    }

    #[test]
    fn status_files() {
        let text = "Name:\tsmalti\nVmPeak:\t  9 kB\nVmHWM:\t    2340 kB\n";
        assert_eq!(kilobytes(text, "VmHWM:"), Some(2_396_160));
        assert_eq!(kilobytes(text, "VmRSS:"), None);
        assert_eq!(kilobytes("VmHWM: much", "VmHWM:"), None);
    }

    #[test]
    fn words() {
        let pairs = [(0, "0 B"), (999, "999 B"), (1500, "1.5 kB"), (999_600, "1.0 MB"), (84_000_000_000, "84 GB")];
        for (bytes, words) in pairs {
            assert_eq!(in_words(bytes), words);
        }
        assert_eq!(in_words(u64::MAX), "18447 PB");
    }
}
