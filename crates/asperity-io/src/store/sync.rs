//! Bringing files to the medium, so that a loss of power leaves them.
//!
//! A file is there after a loss of power when its contents and the entry in its directory are on the medium.

use std::collections::BTreeSet;
use std::fs::File;
use std::path::{Path, PathBuf};

use super::document::NAME;
use super::error::{Result, io};

/// Brings all that was written to the file system of `root` to the medium; `false` where the system cannot do that. A
/// thousand chunks take one commit of its journal, where one after the other they take one each.
#[cfg(target_os = "linux")]
pub(super) fn file_system(root: &Path) -> Result<bool> {
    let directory = File::open(root).map_err(io("write", root))?;
    rustix::fs::syncfs(directory).map_err(|error| io("write", root)(error.into()))?;
    Ok(true)
}

#[cfg(not(target_os = "linux"))]
pub(super) fn file_system(_: &Path) -> Result<bool> {
    Ok(false)
}

/// Brings files below `root`, and the entries of the directories down to them, to the medium.
pub(super) fn files(root: &Path, paths: &[PathBuf]) -> Result<()> {
    let mut directories = BTreeSet::new();
    for path in paths {
        let file = File::open(path).map_err(io("write", path))?;
        file.sync_data().map_err(io("write", path))?;
        directories.extend(path.ancestors().skip(1).take_while(|directory| *directory != root));
    }
    directories.into_iter().for_each(directory);
    Ok(())
}

/// Brings the documents of these arrays to the medium.
pub(super) fn documents(root: &Path, arrays: &[String]) -> Result<()> {
    files(root, &arrays.iter().map(|name| root.join(name).join(NAME)).collect::<Vec<_>>())
}

/// Brings the document of the group, the entries of its directory and its own entry to the medium.
pub(super) fn document(root: &Path) -> Result<()> {
    files(root, &[root.join(NAME)])?;
    directory(root);
    root.parent().into_iter().for_each(directory);
    Ok(())
}

/// Brings the entries of a directory to the medium, where the system can do that.
pub(super) fn directory(path: &Path) {
    // Not every system opens directories, nor synchronises them; the files themselves are safe then too.
    if let Ok(directory) = File::open(if path.as_os_str().is_empty() { Path::new(".") } else { path }) {
        let _ = directory.sync_all();
    }
}
