//! Bringing files to the medium, so that they survive a loss of power.
//!
//! A file survives a loss of power when its contents and the entry in its directory are on the medium.

use std::fs::File;
use std::path::Path;
use std::time::SystemTime;

use super::error::{Result, io};

/// Brings what was written to the result at `root` since an instant to the medium. Where the system can do that for a whole file
/// system, a thousand chunks take one commit of its journal instead of one each.
#[cfg(target_os = "linux")]
pub(super) fn result(root: &Path, _since: SystemTime) -> Result<()> {
    let directory = File::open(root).map_err(io("write", root))?;
    rustix::fs::syncfs(directory).map_err(|error| io("write", root)(error.into()))
}

#[cfg(not(target_os = "linux"))]
pub(super) fn result(root: &Path, since: SystemTime) -> Result<()> {
    result_by_files(root, since)
}

/// The same file by file.
#[cfg(any(test, not(target_os = "linux")))]
pub(super) fn result_by_files(root: &Path, since: SystemTime) -> Result<()> {
    files(root, since)?;
    root.parent().into_iter().for_each(directory);
    Ok(())
}

#[cfg(any(test, not(target_os = "linux")))]
fn files(path: &Path, since: SystemTime) -> Result<()> {
    for entry in std::fs::read_dir(path).map_err(io("read", path))? {
        let entry = entry.map_err(io("read", path))?;
        let (place, kind) = (entry.path(), entry.file_type().map_err(io("read", path))?);
        if kind.is_dir() {
            files(&place, since)?;
        } else if std::fs::metadata(&place).and_then(|file| file.modified()).is_ok_and(|at| at >= since) {
            file(&place)?;
        }
    }
    directory(path);
    Ok(())
}

/// Brings a file to the medium.
pub(super) fn file(path: &Path) -> Result<()> {
    // Some systems synchronise only files that are open for writing.
    File::options().write(true).open(path).and_then(|file| file.sync_data()).map_err(io("write", path))
}

/// Brings the entries of a directory to the medium, where the system can do that.
pub(super) fn directory(path: &Path) {
    // Not every system opens directories, nor synchronises them; the files themselves are safe then too.
    if let Ok(directory) = File::open(if path.as_os_str().is_empty() { Path::new(".") } else { path }) {
        let _ = directory.sync_all();
    }
}
