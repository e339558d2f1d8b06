//! Memory: what a render takes, what there is for it, what this process used.

mod cgroup;
mod limit;
mod need;

#[cfg(test)]
pub use limit::By;
pub use limit::{Limit, least};
pub use need::{Need, check_mesh, map_bytes, photon_bytes, shapes, triangles};

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
