//! Removing results that were replaced, and what killed processes left.
//!
//! Only files that a result has by its own list of arrays are removed, each under the name that the store gives it.
//! Anything else stays where it is, in a directory that its user can see.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::checkpoint;
use super::create::{beside, is_part};
use super::document::{GROUP_PARTIAL, NAME, PARTIAL};
use super::header::Status;
use super::reader::Reader;
use super::writer::lock;

/// Directories of unfinished results that are younger than this may belong to a process that is about to lock them.
const YOUNG: Duration = Duration::from_secs(10);

/// Where a complete result is kept that a run at `path` replaces, until that run is complete.
fn replaced(path: &Path) -> PathBuf {
    beside(path, ".", ".replaced")
}

/// The complete result that is kept until the one at `path` is complete, where there is one.
pub(super) fn kept(path: &Path) -> Option<PathBuf> {
    Some(replaced(path)).filter(|kept| kept.is_dir())
}

/// Keeps the replaced result at `aside` until the one at `path` is complete; it is removed at once where it is not complete
/// itself, or another one is kept already.
pub(super) fn put_by(aside: &Path, path: &Path) {
    let is_complete = Reader::open(aside).is_ok_and(|reader| reader.status() == Status::Complete);
    let is_kept = is_complete && kept(path).is_none() && fs::rename(aside, replaced(path)).is_ok();
    if !is_kept {
        remove(aside, path);
    }
}

/// Removes the result that was kept until the one at `path` is complete.
pub(super) fn remove_kept(path: &Path) {
    if let Some(kept) = kept(path) {
        remove(&kept, path);
    }
}

/// Removes the files of the replaced result at `aside`. If other files are left, the directory gets a name that its user can find,
/// with a warning.
pub(super) fn remove(aside: &Path, path: &Path) {
    remove_own(aside);
    if fs::symlink_metadata(aside).is_err() {
        return;
    }
    let old = |n| if n == 0 { ".old".to_owned() } else { format!(".old-{n}") };
    let names = (0..1000).map(|n| beside(path, "", &old(n)));
    let mut free = names.filter(|name| fs::symlink_metadata(name).is_err());
    let kept = free.next().filter(|name| fs::rename(aside, name).is_ok()).unwrap_or(aside.to_owned());
    tracing::warn!(
        "the replaced result {} held files that are not its own or cannot be removed; they are kept in {}",
        path.display(),
        kept.display()
    );
}

/// Removes what killed processes left beside `path` of results under its name.
pub(super) fn sweep(path: &Path) {
    let Some(name) = path.file_name().and_then(|name| name.to_str()) else { return };
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let prefixes = ["partial", "old"].map(|role| format!(".{name}.{role}-"));
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let found = entry.file_name();
        let number = prefixes.iter().find_map(|prefix| found.to_str()?.strip_prefix(prefix.as_str()));
        if number.is_some_and(|number| number.bytes().all(|b| b.is_ascii_digit() || b == b'-')) {
            let directory = entry.path();
            let age = entry.metadata().and_then(|data| data.modified()).map(|at| at.elapsed());
            let is_old = matches!(age, Ok(Ok(age)) if age >= YOUNG);
            // A process that works on it holds its lock.
            if is_old && let Ok(Some(_held)) = lock(&directory) {
                // The process was killed after it had moved the old result and before the new one took its place.
                if found.to_str().is_some_and(|name| name.starts_with(&prefixes[1])) && !path.exists() {
                    let _ = fs::rename(&directory, path);
                    continue;
                }
                remove_own(&directory);
                if directory.exists() {
                    remove(&directory, path);
                }
            }
        }
    }
}

/// Removes what a result has of its own, and the directories that are empty then.
fn remove_own(root: &Path) {
    for entry in fs::read_dir(root).into_iter().flatten().flatten() {
        let (name, path) = (entry.file_name(), entry.path());
        let is_directory = entry.file_type().is_ok_and(|kind| kind.is_dir());
        match name.to_str() {
            Some(NAME) if !is_directory => drop(fs::remove_file(&path)),
            Some(checkpoint::DIRECTORY) if is_directory => {
                remove_files(&path, &checkpoint::FILES);
                remove_files(&path, &[NAME, PARTIAL]);
                let _ = fs::remove_dir(&path);
            }
            Some(name) if is_directory && is_part(name) => remove_array(&path),
            _ => {}
        }
    }
    let _ = fs::remove_dir(root);
}

fn remove_array(array: &Path) {
    let of_group = GROUP_PARTIAL.rsplit('/').next().unwrap_or(GROUP_PARTIAL);
    remove_files(array, &[NAME, PARTIAL, of_group]);
    remove_chunks(&array.join("c"), 0);
    let _ = fs::remove_dir(array);
}

/// Removes the chunks of an array: files whose names, and those of all directories above, are numbers.
fn remove_chunks(directory: &Path, depth: usize) {
    // No array has more dimensions.
    const DEEPEST: usize = 4;
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        let is_number =
            entry.file_name().to_str().is_some_and(|name| name.bytes().all(|b| b.is_ascii_digit()));
        match entry.file_type() {
            Ok(kind) if is_number && kind.is_file() => drop(fs::remove_file(entry.path())),
            Ok(kind) if is_number && kind.is_dir() && depth < DEEPEST => {
                remove_chunks(&entry.path(), depth + 1);
            }
            _ => {}
        }
    }
    let _ = fs::remove_dir(directory);
}

fn remove_files(directory: &Path, names: &[&str]) {
    for path in names.iter().map(|name| directory.join(name)).filter(|path: &PathBuf| path.is_file()) {
        let _ = fs::remove_file(path);
    }
}
