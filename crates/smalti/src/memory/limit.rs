//! How much memory there is: the least of what the machine has and what container and process may use (Linux).

use std::fmt::{self, Display, Formatter};
use std::path::Path;

use super::{cgroup, in_words, kilobytes};

/// An amount of memory that ends a process which wants more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limit {
    /// All of it, bytes.
    pub bytes: u64,
    /// What this process has of it, bytes.
    pub taken: u64,
    /// What limits it.
    pub by: By,
}

/// What limits memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum By {
    /// The machine's own memory.
    Machine,
    /// A control group, by a file of this name.
    Container(String),
    /// The process's address space or its data, by this letter of the shell's `ulimit`.
    Process(char),
    /// The numbers of this processor.
    Addresses,
}

/// Addresses that the C library reserves for the thread of the display, which is not there yet when this is asked.
const RESERVED: u64 = 64 << 20;

/// The least limit of this process as of now; what can be addressed where the system tells of none.
pub fn least() -> Limit {
    of(|path| std::fs::read_to_string(path).ok())
}

/// The least limit by the texts of files; those that are missing limit nothing.
fn of(read: impl Fn(&Path) -> Option<String>) -> Limit {
    let text = |path: &str| read(Path::new(path)).unwrap_or_default();
    let status = text("/proc/self/status");
    let taken = |key| kilobytes(&status, key).unwrap_or(0);
    let held = taken("VmRSS:");
    let machine = kilobytes(&text("/proc/meminfo"), "MemTotal:");
    let machine = machine.map(|bytes| Limit { bytes, taken: held, by: By::Machine });
    let groups = cgroup::files(&text("/proc/self/cgroup"), &text("/proc/self/mountinfo"));
    let groups = groups.iter().filter_map(|file| of_group(file, held, &read));
    let limits = text("/proc/self/limits");
    let addresses = taken("VmSize:") + RESERVED;
    let process = [("Max address space", 'v', addresses), ("Max data size", 'd', taken("VmData:"))];
    let process = process.into_iter().filter_map(|(name, letter, taken)| {
        Some(Limit { bytes: soft(&limits, name)?, taken, by: By::Process(letter) })
    });
    let addresses = Limit { bytes: isize::MAX as u64, taken: 0, by: By::Addresses };
    machine.into_iter().chain(groups).chain(process).fold(addresses, |a, b| if b.left() < a.left() { b } else { a })
}

/// The limit of a control group; `None` where there is none (`max`).
fn of_group(file: &Path, taken: u64, read: &impl Fn(&Path) -> Option<String>) -> Option<Limit> {
    let bytes = read(file)?.trim().parse().ok()?;
    let name = file.file_name()?.to_string_lossy().into_owned();
    Some(Limit { bytes, taken, by: By::Container(name) })
}

/// The first number of a line like `Max address space   409600000   unlimited   bytes`; `None` if it is no number.
fn soft(limits: &str, name: &str) -> Option<u64> {
    let rest = limits.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

impl Limit {
    /// Bytes that are left for this process.
    pub fn left(&self) -> u64 {
        self.bytes.saturating_sub(self.taken)
    }

    /// What is taken of it, where that is worth telling: more than a tenth.
    pub fn taken_in_words(&self) -> String {
        let taken = in_words(self.taken);
        if self.taken > self.bytes / 10 { format!(", {taken} of it are taken") } else { String::new() }
    }
}

/// In words: `this machine has 25 GB`, `this process may use 410 MB (ulimit -v)`.
impl Display for Limit {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let bytes = in_words(self.bytes);
        match &self.by {
            By::Machine => write!(f, "this machine has {bytes}"),
            By::Container(file) => write!(f, "this container may use {bytes} ({file})"),
            By::Process(letter) => write!(f, "this process may use {bytes} (ulimit -{letter})"),
            By::Addresses => write!(f, "this machine can address {bytes}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATUS: &str = "VmSize:\t  200 kB\nVmRSS:\t   100 kB\nVmData:\t  150 kB\n";
    const MEMINFO: &str = "MemTotal:       16000000 kB\nMemFree:  12 kB\n";
    const UNLIMITED: &str = "Limit                     Soft Limit           Hard Limit           Units     \n\
                             Max data size             unlimited            unlimited            bytes     \n\
                             Max address space         unlimited            unlimited            bytes     \n";
    const FIRST: [(&str, &str); 2] = [
        ("/proc/self/cgroup", "4:memory:/jobs/17\n0::/\n"),
        (
            "/proc/self/mountinfo",
            "35 31 0:32 / /cg/memory rw - cgroup cgroup rw,memory\n36 31 0:33 / /cg/uni rw - cgroup2 x rw\n",
        ),
    ];
    const SECOND: [(&str, &str); 2] = [
        ("/proc/self/cgroup", "0::/jobs/17\n"),
        ("/proc/self/mountinfo", "36 31 0:33 / /cg rw shared:4 - cgroup2 cgroup2 rw\n"),
    ];
    /// Without a limit the first version says this.
    const NONE: &str = "9223372036854771712\n";

    /// The least limit on a machine with these files, in words, and what is left of it.
    fn told(files: &[(&str, &str)]) -> (String, u64) {
        let common = [("/proc/self/status", STATUS), ("/proc/meminfo", MEMINFO), ("/proc/self/limits", UNLIMITED)];
        let text = |path: &Path| {
            let all = files.iter().chain(&common);
            all.into_iter().find(|file| Path::new(file.0) == path).map(|file| file.1.to_owned())
        };
        let limit = of(text);
        (limit.to_string(), limit.left())
    }

    fn with<'t>(group: [(&'t str, &'t str); 2], files: &[(&'t str, &'t str)]) -> (String, u64) {
        told(&[&group[..], files].concat())
    }

    #[test]
    fn without_limits_the_machine_is_the_limit() {
        let machine = ("this machine has 16 GB".to_owned(), 16_000_000 * 1024 - 100 * 1024);
        assert_eq!(told(&[]), machine);
        assert_eq!(with(FIRST, &[("/cg/memory/jobs/17/memory.limit_in_bytes", NONE)]), machine);
        let unlimited = [("/cg/jobs/17/memory.max", "max\n"), ("/cg/jobs/17/memory.high", "max\n")];
        assert_eq!(with(SECOND, &unlimited), machine);
        assert_eq!(with(SECOND, &[("/cg/memory.max", "99000000000\n")]), machine, "more than the machine has");
    }

    #[test]
    fn a_container_limits_by_its_group_or_one_above() {
        for group in ["/jobs/17", "/jobs", ""] {
            let first = format!("/cg/memory{group}/memory.limit_in_bytes");
            let (said, left) = with(FIRST, &[(&first, "300000000\n")]);
            assert_eq!(said, "this container may use 300 MB (memory.limit_in_bytes)", "{group}");
            assert_eq!(left, 300_000_000 - 100 * 1024);
            let second = format!("/cg{group}/memory.max");
            let (said, _) = with(SECOND, &[(&second, "300000000\n")]);
            assert_eq!(said, "this container may use 300 MB (memory.max)", "{group}");
        }
    }

    #[test]
    fn the_least_of_several_limits_counts() {
        let limits = [
            ("/cg/jobs/17/memory.max", "900000000"),
            ("/cg/jobs/17/memory.high", "800000000"),
            ("/cg/jobs/memory.max", "700000000"),
        ];
        assert_eq!(with(SECOND, &limits).0, "this container may use 700 MB (memory.max)");
        assert_eq!(with(SECOND, &limits[..2]).0, "this container may use 800 MB (memory.high)");
        // Both versions at once.
        let limits = [("/cg/memory/jobs/memory.limit_in_bytes", "600000000"), ("/cg/uni/memory.max", "500000000")];
        assert_eq!(with(FIRST, &limits).0, "this container may use 500 MB (memory.max)");
        assert_eq!(with(FIRST, &limits[..1]).0, "this container may use 600 MB (memory.limit_in_bytes)");
    }

    #[test]
    fn a_process_limits_its_addresses_and_its_data() {
        let limits = |data: &str, addresses: &str| {
            format!("Max data size {data} unlimited bytes\nMax address space {addresses} 9 bytes\n")
        };
        let told = |data, addresses| told(&[("/proc/self/limits", &limits(data, addresses))]);
        let addresses = ("this process may use 410 MB (ulimit -v)".to_owned(), 409_600_000 - 200 * 1024 - RESERVED);
        assert_eq!(told("unlimited", "409600000"), addresses);
        assert_eq!(told("unlimited", "1000").1, 0, "less than is taken");
        let data = ("this process may use 100 MB (ulimit -d)".to_owned(), 100_000_000 - 150 * 1024);
        assert_eq!(told("100000000", "409600000"), data);
    }

    #[test]
    fn what_is_taken_is_told_where_it_matters() {
        let limit = |taken| Limit { bytes: 1_000_000, taken, by: By::Machine }.taken_in_words();
        assert_eq!((limit(100_000), limit(100_001)), (String::new(), ", 100 kB of it are taken".to_owned()));
    }

    #[test]
    fn missing_and_senseless_files_limit_nothing() {
        assert_eq!(of(|_| None).by, By::Addresses);
        assert_eq!(of(|_| Some("what is this?\n".into())).by, By::Addresses);
        assert_eq!(of(|_| Some(String::new())).left(), isize::MAX as u64);
    }
}
