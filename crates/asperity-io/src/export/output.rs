//! Where an export goes: beside its path first, then renamed, so that it is whole or absent.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::{ExportError, Result, WriteError};

/// The file that an export writes: buffered, and able to go back.
pub(super) type Output = BufWriter<File>;

/// Lets `write` fill the file that then appears at `path`.
pub(super) fn file(
    path: &Path,
    force: bool,
    write: impl FnOnce(&mut Output) -> Result<(), WriteError>,
) -> Result<Vec<PathBuf>> {
    replace(path, force, |partial| {
        let mut output = BufWriter::with_capacity(1 << 18, File::create_new(partial)?);
        write(&mut output)?;
        Ok(output.flush()?)
    })
}

/// Lets `write` make a file at the path that it is given, which then appears at `path`.
pub(super) fn replace(
    path: &Path,
    force: bool,
    write: impl FnOnce(&Path) -> Result<(), WriteError>,
) -> Result<Vec<PathBuf>> {
    check(path, force)?;
    let partial = partial(path)?;
    let written = write(&partial).and_then(|()| Ok(fs::rename(&partial, path)?));
    written.map_err(|error| {
        let _ = fs::remove_file(&partial);
        error.at(path)
    })?;
    Ok(vec![path.to_owned()])
}

/// Whether a file may be made at `path`.
pub(super) fn check(path: &Path, force: bool) -> Result<()> {
    match fs::symlink_metadata(path) {
        Err(_) => Ok(()),
        Ok(_) => match (no_file(path), force) {
            (Some(found), _) => Err(ExportError::Foreign { path: path.to_owned(), found: found.into() }),
            (None, true) => Ok(()),
            (None, false) => Err(ExportError::Exists { path: path.to_owned() }),
        },
    }
}

/// What stands at `path` where it is no file, as the rest of a sentence. A link counts as what it leads to, so that /dev/null is
/// never replaced by a file.
pub fn no_file(path: &Path) -> Option<&'static str> {
    let found = fs::metadata(path).ok().filter(|found| !found.is_file())?;
    Some(if found.is_dir() { "is a directory" } else { "is a device or a pipe" })
}

/// A name beside `path` for what is not finished.
pub(super) fn partial(path: &Path) -> Result<PathBuf> {
    let Some(name) = path.file_name() else {
        let source = std::io::Error::from(std::io::ErrorKind::InvalidFilename);
        return Err(ExportError::Io { path: path.to_owned(), action: "write", source });
    };
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".partial-{}", std::process::id()));
    Ok(path.with_file_name(hidden))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_device_is_not_replaced() {
        let directory = tempfile::tempdir().unwrap();
        let null = directory.path().join("null");
        std::os::unix::fs::symlink("/dev/null", &null).unwrap();
        let refused = file(&null, true, |output| Ok(output.write_all(b"x")?));
        assert!(matches!(refused, Err(ExportError::Foreign { .. })) && null.is_symlink());
    }
}
