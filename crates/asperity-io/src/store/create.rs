//! A new result is built beside its path and then renamed, so that no unfinished one is ever seen.

use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use asperity::quantities::Quantity;
use ndarray::ArrayView2;

use super::checkpoint;
use super::chunks::Chunks;
use super::document::{self, Document};
use super::error::{Result, StoreError, input, io};
use super::field_kind::FieldKind;
use super::layout::{AXIS, BINS, SCALARS, coordinates};
use super::leak;
use super::leftovers;
use super::replace;
use super::stress;
use super::writer::lock;

/// Lets `build` fill a new directory, which then appears at `path`; returns its lock. A complete result that was there is kept
/// until the new one is complete.
pub(super) fn publish(
    path: &Path,
    force: bool,
    build: impl FnOnce(&Path) -> Result<()>,
) -> Result<Option<File>> {
    // Without a closing slash, which would look through a link.
    let path: &Path = &path.components().collect::<PathBuf>();
    check_name(path)?;
    leftovers::sweep(path);
    let old = vacate(path, force)?;
    let partial = make_beside(path, "partial")?;
    // Held from here on: other processes see that this one is at work.
    let built = lock(&partial).and_then(|held| {
        build(&partial)?;
        match &old {
            Some(_) => {
                let aside = put_in_place(&partial, path)?;
                leftovers::put_by(&aside, path);
            }
            None => fs::rename(&partial, path).map_err(|error| taken(path, error))?,
        }
        Ok(held)
    });
    built.map_err(|error| {
        let _ = fs::remove_dir_all(&partial);
        match error {
            // The error names the path that the user knows.
            StoreError::Io { path: file, action, source } => {
                let file = file.strip_prefix(&partial).map_or(file.clone(), |part| path.join(part));
                StoreError::Io { path: file, action, source }
            }
            other => other,
        }
    })
}

/// Exchanges a new result for the old one at `path`; returns where the old one is.
fn put_in_place(partial: &Path, path: &Path) -> Result<PathBuf> {
    // At no instant is there nothing at the path, where the system can do that.
    if replace::exchange(path, partial).is_ok() {
        return Ok(partial.to_owned());
    }
    let aside = free_name(path, "old")?;
    fs::rename(path, &aside).map_err(io("replace", path))?;
    fs::rename(partial, path).map_err(|source| {
        let _ = fs::rename(&aside, path);
        StoreError::Io { path: path.to_owned(), action: "write", source }
    })?;
    Ok(aside)
}

/// The error of a path that was free when the work began.
fn taken(path: &Path, source: std::io::Error) -> StoreError {
    if !matches!(source.kind(), ErrorKind::DirectoryNotEmpty | ErrorKind::AlreadyExists) {
        return StoreError::Io { path: path.to_owned(), action: "write", source };
    }
    match lock(path) {
        Err(busy) => busy,
        Ok(_) => StoreError::Exists { path: path.to_owned() },
    }
}

/// Longest name of a result, in bytes: file systems take 255, of which the names of its unfinished forms need 20 more.
const LONGEST_NAME: usize = 235;

/// Refuses a name that the file system would refuse later.
fn check_name(path: &Path) -> Result<()> {
    match path.file_name().map_or(0, |name| name.as_encoded_bytes().len()) {
        length if length > LONGEST_NAME => {
            let given = format!("{length} bytes long");
            Err(input("name of the result", given, format!("at most {LONGEST_NAME} bytes long")))
        }
        _ => Ok(()),
    }
}

/// Whether `path` may be written: `None` where it is free, the lock of the old result where it may be replaced.
fn vacate(path: &Path, force: bool) -> Result<Option<Option<File>>> {
    let metadata = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(io("look at", path)(error)),
        Ok(metadata) => metadata,
    };
    let foreign = |found: &str| StoreError::Foreign { path: path.to_owned(), found: found.to_owned() };
    match metadata.file_type() {
        kind if kind.is_symlink() => return Err(foreign("is a link")),
        kind if !kind.is_dir() => return Err(foreign("is a file")),
        _ if !document::is_result(path) => {
            return Err(foreign("is a directory, but not a result of asperity"));
        }
        _ if !force => return Err(StoreError::Exists { path: path.to_owned() }),
        _ => {}
    }
    for entry in fs::read_dir(path).map_err(io("read", path))? {
        let name = entry.map_err(io("read", path))?.file_name();
        if !name.to_str().is_some_and(is_part) {
            return Err(foreign(&format!("is a result that other files were put into ({})", name.display())));
        }
    }
    Ok(Some(lock(path)?))
}

/// Whether a result has an entry of that name.
pub(super) fn is_part(name: &str) -> bool {
    name == document::NAME
        || leak::owns(name)
        || name == checkpoint::DIRECTORY
        || stress::names().any(|known| known == name)
        || ["field_time", "field_step", "velocity", "field_velocity", "x", "y", "initial_gap", AXIS.name]
            .contains(&name)
        || SCALARS.iter().any(|scalar| scalar.name == name)
        || FieldKind::from_name(name).is_some()
        || Quantity::from_name(name).is_some()
        || BINS.iter().flat_map(|(_, series)| series).any(|series| series.name == name)
}

/// A new directory beside `path`.
fn make_beside(path: &Path, role: &str) -> Result<PathBuf> {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    for directory in names_beside(path, role)? {
        match fs::create_dir(&directory).map_err(|error| (error.kind(), error)) {
            Ok(()) => return Ok(directory),
            Err((ErrorKind::AlreadyExists, _)) => {}
            Err((ErrorKind::NotFound | ErrorKind::NotADirectory, error)) => {
                return Err(io("write into", parent)(error));
            }
            Err((_, error)) => return Err(io("make", path)(error)),
        }
    }
    Err(StoreError::Busy { path: path.to_owned() })
}

/// A name beside `path` that is not taken.
fn free_name(path: &Path, role: &str) -> Result<PathBuf> {
    let mut free = names_beside(path, role)?.filter(|name| fs::symlink_metadata(name).is_err());
    free.next().ok_or_else(|| StoreError::Busy { path: path.to_owned() })
}

/// Names beside `path` for what this process works on: `.NAME.ROLE-PID`, `.NAME.ROLE-PID-1`, ...
fn names_beside(path: &Path, role: &str) -> Result<impl Iterator<Item = PathBuf>> {
    if path.file_name().is_none() {
        return Err(input("path of the result", path.display(), "the path of a directory to be made"));
    }
    let (path, role) = (path.to_owned(), format!(".{role}-{}", std::process::id()));
    Ok((0..100).map(move |n| beside(&path, ".", &if n > 0 { format!("{role}-{n}") } else { role.clone() })))
}

/// The path of a file beside `path`, whose name has more before and after the name of that.
pub(super) fn beside(path: &Path, before: &str, after: &str) -> PathBuf {
    let mut name = std::ffi::OsString::from(before);
    name.push(path.file_name().unwrap_or_default());
    name.push(after);
    path.with_file_name(name)
}

/// Writes what does not change over time: the coordinates x and y, the coordinates of the histograms, and the undeformed gap.
pub(super) fn write_constants(
    root: &Path,
    document: &Document,
    initial_gap: ArrayView2<'_, f64>,
) -> Result<()> {
    let grid = &document.header.grid;
    let [nx, ny] = grid.cells();
    let lines: Vec<_> =
        document.header.quantities.iter().flat_map(|column| coordinates(column, grid)).collect();
    for spec in document.arrays() {
        let chunks = Chunks::new(root, &spec);
        let line = || lines.iter().find(|(series, _)| series.name == spec.name());
        match spec.name() {
            "x" => chunks.write_whole(&(0..nx).map(|i| grid.x(i)).collect::<Vec<_>>())?,
            "y" => chunks.write_whole(&(0..ny).map(|j| grid.y(j)).collect::<Vec<_>>())?,
            "initial_gap" => chunks.write_map(&[], initial_gap)?,
            _ => line().map_or(Ok(()), |(_, numbers)| chunks.write_whole(numbers))?,
        }
    }
    Ok(())
}
