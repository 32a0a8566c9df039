//! How much memory and disk the machine has left: checked before the program takes what a number in a file asks for.
//!
//! Memory: the least of what the system calls available, what the limits of control groups (containers, batch systems)
//! leave, and what `ulimit -v` leaves. Disk: the free space of the file system. Where the system reports
//! neither, the limit is 64 GiB of memory.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::readable::bytes as words;

/// Memory where the system does not say how much it has.
const ASSUMED: u64 = 64 << 30;

/// Bytes of memory that the process may still take.
pub fn available_memory() -> u64 {
    available_below(Path::new("/"))
}

/// Largest resident memory of the process so far \[byte\], if the system reports it (Linux).
pub fn peak_memory_bytes() -> Option<u64> {
    kibibytes(&fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Refuses a piece of work that takes more memory than there is. `what` is the subject of the sentence, in the plural:
/// "40000 x 40000 points".
///
/// # Errors
/// A sentence with both numbers.
pub fn check_memory(what: &str, bytes: u64) -> Result<(), String> {
    let available = available_memory();
    if bytes <= available {
        return Ok(());
    }
    let [needed, available] = [bytes, available].map(|bytes| words(bytes as f64));
    Err(format!("{what} need about {needed} of memory, but this machine has {available} available"))
}

/// Free bytes of the file system that `path` is on, or would be made on; `None` where the system does not tell.
pub fn free_disk(path: &Path) -> Option<u64> {
    let path = std::path::absolute(path).ok()?;
    free(path.ancestors().find(|directory| directory.exists())?)
}

/// Opens a file that has an end: not a pipe, a device or a directory, which may block or give bytes forever.
///
/// # Errors
/// Those of the system, [`io::ErrorKind::IsADirectory`], and [`io::ErrorKind::InvalidInput`] for what else is no file.
pub fn open(path: &Path) -> io::Result<File> {
    let kind = fs::metadata(path)?.file_type();
    if kind.is_file() { File::open(path) } else { Err(no_file(kind)) }
}

/// The error of what is no file.
pub fn no_file(kind: fs::FileType) -> io::Error {
    match kind.is_dir() {
        true => io::Error::new(io::ErrorKind::IsADirectory, "it is a directory, not a file"),
        false => io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("it is {}, not a file; save it as a file first", special(kind)),
        ),
    }
}

/// The bytes of a file that has an end.
///
/// # Errors
/// As [`open`].
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The bytes of a file of at most `most`.
///
/// # Errors
/// A sentence: the file does not exist, is none, cannot be read, or is larger.
pub fn bytes(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes));
    read.map_err(|error| why(&error))?;
    match bytes.len() as u64 <= most {
        true => Ok(bytes),
        false => Err(format!("the file is larger than {} MB", most >> 20)),
    }
}

/// The text of a file of at most `most` bytes.
///
/// # Errors
/// As [`bytes`], and where it is not UTF-8.
pub fn text(path: &Path, most: u64) -> Result<String, String> {
    String::from_utf8(bytes(path, most)?).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes().iter().take(byte).filter(|b| **b == b'\n').count();
        format!("the file is not UTF-8 text (line {line}, byte {byte})")
    })
}

/// Why a file cannot be read, in a sentence.
pub fn why(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::IsADirectory | io::ErrorKind::InvalidInput => told(error),
        _ => format!("the file cannot be read: {error}"),
    }
}

/// What the system says of a file, with what to do where it does not exist.
pub fn told(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "the file does not exist; check its name and folder".to_owned(),
        _ => error.to_string(),
    }
}

#[cfg(unix)]
fn special(kind: fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "a pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn special(_: fs::FileType) -> &'static str {
    "a device"
}

#[cfg(any(target_os = "linux", target_os = "macos"))]
fn free(directory: &Path) -> Option<u64> {
    let system = rustix::fs::statvfs(directory).ok()?;
    system.f_bavail.checked_mul(system.f_frsize)
}

#[cfg(not(any(target_os = "linux", target_os = "macos")))]
fn free(_: &Path) -> Option<u64> {
    None
}

/// `root` holds the directories `proc` and `sys`.
fn available_below(root: &Path) -> u64 {
    let read = |path: &str| fs::read_to_string(root.join(path)).unwrap_or_default();
    let meminfo = read("proc/meminfo");
    let of_system =
        kibibytes(&meminfo, "MemAvailable:").or_else(|| kibibytes(&meminfo, "MemTotal:")).unwrap_or(ASSUMED);
    let of_groups = groups(&read("proc/self/cgroup")).into_iter().filter_map(|(mount, group)| {
        let mount = root.join(mount);
        // The group of a container may lie above the root that the container sees.
        let nested =
            Path::new(&group).ancestors().map(|group| mount.join(group.strip_prefix("/").unwrap_or(group)));
        nested.filter_map(|directory| left(&directory)).min()
    });
    let used = kibibytes(&read("proc/self/status"), "VmSize:").unwrap_or(0);
    let of_process = address_space(&read("proc/self/limits")).map(|limit| limit.saturating_sub(used));
    of_groups.chain(of_process).fold(of_system, u64::min)
}

/// The line "NAME  24689764 kB" of a file below /proc, in bytes.
fn kibibytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// The control groups of the process that may limit memory: mount and path of version 2 ("0::/user.slice") and of
/// version 1 ("4:memory:/docker/b7f3").
fn groups(text: &str) -> Vec<(PathBuf, String)> {
    let group = |line: &str| {
        let mut parts = line.splitn(3, ':');
        let (_, controllers, path) = (parts.next()?, parts.next()?, parts.next()?);
        let mount = match controllers {
            "" => "sys/fs/cgroup",
            _ if controllers.split(',').any(|name| name == "memory") => "sys/fs/cgroup/memory",
            _ => return None,
        };
        Some((PathBuf::from(mount), path.to_owned()))
    };
    text.lines().filter_map(group).collect()
}

/// What a control group leaves: its limit less what is in use, of which files that can be read again do not count.
fn left(group: &Path) -> Option<u64> {
    let number = |name: &str| fs::read_to_string(group.join(name)).ok()?.trim().parse::<u64>().ok();
    let limit = number("memory.max").or_else(|| number("memory.limit_in_bytes"))?;
    let used = number("memory.current").or_else(|| number("memory.usage_in_bytes")).unwrap_or(0);
    let statistics = fs::read_to_string(group.join("memory.stat")).unwrap_or_default();
    let files = ["total_inactive_file ", "inactive_file "].iter().find_map(|name| {
        statistics.lines().find_map(|line| line.strip_prefix(name))?.trim().parse::<u64>().ok()
    });
    Some(limit.saturating_sub(used.saturating_sub(files.unwrap_or(0))))
}

/// The soft limit of "Max address space" in /proc/self/limits, in bytes.
fn address_space(limits: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A system with 16 GiB available and these files.
    fn system(files: &[(&str, &str)]) -> (tempfile::TempDir, u64) {
        let root = tempfile::tempdir().unwrap();
        let meminfo = ("proc/meminfo", "MemTotal: 33554432 kB\nMemFree: 1 kB\nMemAvailable:  16777216 kB\n");
        for (path, text) in [&[meminfo], files].concat() {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let available = available_below(root.path());
        (root, available)
    }

    const GIB: u64 = 1 << 30;

    #[test]
    fn without_limits_it_is_what_the_system_calls_available() {
        assert_eq!(system(&[]).1, 16 * GIB);
        assert_eq!(available_below(Path::new("/there/is/no/such/directory")), ASSUMED);
    }

    #[test]
    fn control_groups_of_both_versions_limit_it() {
        let second = system(&[
            ("proc/self/cgroup", "0::/a/b\n"),
            ("sys/fs/cgroup/a/b/memory.max", "max\n"),
            ("sys/fs/cgroup/a/memory.max", "4294967296\n"),
            ("sys/fs/cgroup/a/memory.current", "3221225472\n"),
            ("sys/fs/cgroup/a/memory.stat", "anon 1\ninactive_file 1073741824\n"),
        ]);
        assert_eq!(second.1, 2 * GIB);
        // A container of version 1 whose own group is mounted as the root.
        let first = system(&[
            ("proc/self/cgroup", "5:cpu:/docker/1\n4:memory:/docker/1\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "1073741824\n"),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "536870912\n"),
        ]);
        assert_eq!(first.1, GIB / 2);
    }

    #[test]
    fn a_limit_of_the_address_space_counts() {
        let limits = "Limit                     Soft Limit           Hard Limit           Units\n\
                      Max address space         2147483648           unlimited            bytes\n";
        let status = "Name: asperity\nVmSize:  1048576 kB\n";
        assert_eq!(system(&[("proc/self/limits", limits), ("proc/self/status", status)]).1, GIB);
        assert_eq!(system(&[("proc/self/limits", &limits.replace("2147483648", "unlimited "))]).1, 16 * GIB);
    }

    #[test]
    fn too_much_is_refused_with_both_numbers() {
        check_memory("4 x 4 points", 1000).unwrap();
        let message = check_memory("many points", u64::MAX).unwrap_err();
        assert!(message.starts_with("many points need about 16.0 EiB of memory"), "{message}");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_path_that_is_to_be_made_is_on_the_disk_of_its_parent() {
        let directory = tempfile::tempdir().unwrap();
        assert!(free_disk(&directory.path().join("a/b/c.zarr")).is_some_and(|free| free > 0));
    }

    #[test]
    #[cfg(unix)]
    fn only_files_are_opened() {
        for (path, what) in [("/dev/zero", "a device"), ("/", "a directory")] {
            let error = open(Path::new(path)).unwrap_err().to_string();
            assert!(error.contains(what), "{error}");
        }
    }
}
