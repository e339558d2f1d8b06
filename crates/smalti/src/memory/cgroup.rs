//! Where Linux keeps the memory limits of a process's control group, as those of a container.

use std::path::{Component, Path, PathBuf};

/// The limit of a group by the first version of control groups.
const FIRST: &[&str] = &["memory.limit_in_bytes"];

/// The limits of a group by the second version: above `memory.high` the kernel slows a process down to a halt.
const SECOND: &[&str] = &["memory.max", "memory.high"];

/// The files in which limits of the process may stand, those of its group and of all groups above it, from the texts of
/// `/proc/self/cgroup` and `/proc/self/mountinfo`. Not all of them exist.
pub fn files(cgroup: &str, mountinfo: &str) -> Vec<PathBuf> {
    mountinfo.lines().filter_map(Mount::read).flat_map(|mount| mount.files(cgroup)).collect()
}

/// A hierarchy of groups with memory limits, as a tree of folders.
struct Mount {
    /// The group that the folder is of.
    root: PathBuf,
    folder: PathBuf,
    /// Whether it is of the second version.
    unified: bool,
}

impl Mount {
    /// From a line like `35 31 0:32 / /sys/fs/cgroup/memory rw,relatime - cgroup cgroup rw,memory`; `None` where it is
    /// something else.
    fn read(line: &str) -> Option<Self> {
        let (place, kind) = line.split_once(" - ")?;
        let mut kind = kind.split(' ');
        let unified = match (kind.next()?, kind.nth(1).unwrap_or_default()) {
            ("cgroup2", _) => true,
            ("cgroup", options) if options.split(',').any(|option| option == "memory") => false,
            _ => return None,
        };
        let mut place = place.split(' ').skip(3);
        Some(Self { root: path(place.next()?), folder: path(place.next()?), unified })
    }

    fn files(&self, cgroup: &str) -> Vec<PathBuf> {
        let names = if self.unified { SECOND } else { FIRST };
        let own = self.folder.join(self.below(cgroup).unwrap_or_default());
        let groups = own.ancestors().take_while(|group| group.starts_with(&self.folder));
        groups.flat_map(|group| names.iter().map(|name| group.join(name))).collect()
    }

    /// The process's group below the folder; `None` where it cannot be seen from here, so that the folder stands for it.
    fn below(&self, cgroup: &str) -> Option<PathBuf> {
        let group = cgroup.lines().find_map(|line| self.group(line))?;
        let below = Path::new(group).strip_prefix(&self.root).ok()?;
        below.components().all(|part| matches!(part, Component::Normal(_))).then(|| below.to_owned())
    }

    /// The group of a line like `4:memory:/docker/b01d`, or `0::/docker/b01d` for the second version.
    fn group<'t>(&self, line: &'t str) -> Option<&'t str> {
        let (number, rest) = line.split_once(':')?;
        let (controllers, group) = rest.split_once(':')?;
        let is_ours = match self.unified {
            true => number == "0" && controllers.is_empty(),
            false => controllers.split(',').any(|controller| controller == "memory"),
        };
        is_ours.then_some(group)
    }
}

/// A path in which the kernel wrote blanks and the like as octal numbers: `\040`.
fn path(text: &str) -> PathBuf {
    let mut parts = text.split('\\');
    let mut path = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let code = part.get(..3).and_then(|digits| u8::from_str_radix(digits, 8).ok());
        match code {
            Some(code) => path.extend([char::from(code).to_string().as_str(), &part[3..]]),
            None => path.extend(["\\", part]),
        }
    }
    path.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIRST_MOUNT: &str = "35 31 0:32 / /sys/fs/cgroup/memory rw,relatime - cgroup cgroup rw,memory\n";
    const SECOND_MOUNT: &str = "41 31 0:38 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n";
    const OTHERS: &str = "31 23 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n\
                          32 31 0:29 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\nnonsense\n";

    fn found(cgroup: &str, mountinfo: &str) -> Vec<String> {
        files(cgroup, mountinfo).iter().map(|file| file.display().to_string()).collect()
    }

    #[test]
    fn the_first_version_has_a_hierarchy_for_memory() {
        let mountinfo = format!("{OTHERS}{FIRST_MOUNT}");
        let cgroup = "9:name=systemd:/a\n4:cpu,memory:/jobs/17\n1:cpu:/b\n";
        let expected =
            ["/jobs/17", "/jobs", ""].map(|group| format!("/sys/fs/cgroup/memory{group}/memory.limit_in_bytes"));
        assert_eq!(found(cgroup, &mountinfo), expected);
    }

    #[test]
    fn the_second_version_has_one_for_all() {
        let expected = [
            "/sys/fs/cgroup/user.slice/a.scope/memory.max",
            "/sys/fs/cgroup/user.slice/a.scope/memory.high",
            "/sys/fs/cgroup/user.slice/memory.max",
            "/sys/fs/cgroup/user.slice/memory.high",
            "/sys/fs/cgroup/memory.max",
            "/sys/fs/cgroup/memory.high",
        ];
        assert_eq!(found("0::/user.slice/a.scope\n", SECOND_MOUNT), expected);
    }

    #[test]
    fn both_versions_can_be_there_at_once() {
        let mountinfo =
            format!("{FIRST_MOUNT}{}", SECOND_MOUNT.replace("/sys/fs/cgroup rw", "/sys/fs/cgroup/unified rw"));
        let files = found("4:memory:/a\n0::/b\n", &mountinfo);
        assert_eq!(files[0], "/sys/fs/cgroup/memory/a/memory.limit_in_bytes");
        assert_eq!((files.len(), files[2].as_str()), (6, "/sys/fs/cgroup/unified/b/memory.max"));
    }

    #[test]
    fn a_container_sees_its_own_group_as_the_folder() {
        let mountinfo = FIRST_MOUNT.replace(" / /sys", " /docker/b01d /sys");
        let inside = ["/sys/fs/cgroup/memory/memory.limit_in_bytes"];
        assert_eq!(found("4:memory:/docker/b01d\n", &mountinfo), inside);
        let nested = found("4:memory:/docker/b01d/jobs\n", &mountinfo);
        assert_eq!(nested[0], "/sys/fs/cgroup/memory/jobs/memory.limit_in_bytes");
        // A group that lies elsewhere, or above what this process may see.
        for elsewhere in ["4:memory:/user/a", "4:memory:/docker/b01d/../c", "4:memory:/../c", "1:cpu:/", ""] {
            assert_eq!(found(elsewhere, &mountinfo), inside, "{elsewhere}");
        }
        assert_eq!(found("0::/../c\n", SECOND_MOUNT)[..], ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.high"]);
    }

    #[test]
    fn no_hierarchy_no_files() {
        assert!(found("4:memory:/a\n0::/b\n", OTHERS).is_empty() && found("", "").is_empty());
    }

    #[test]
    fn blanks_in_paths_are_numbers() {
        assert_eq!(path(r"/a\040b\134c"), PathBuf::from(r"/a b\c"));
        assert_eq!(path(r"/a\b"), PathBuf::from(r"/a\b"));
    }
}
