//! Files and directories that appear whole or not at all: they are written beside their path and then renamed. What stood there
//! stays until then.

use std::fs::{self, File};
use std::io::{self, BufWriter, Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::{TempDir, TempPath};

/// What fills a file: buffered, and able to go back.
pub type Output<'a> = BufWriter<&'a File>;

/// Why a file was not written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// There is a file that may not be replaced.
    #[error("{} already exists; choose another file or use --force", path.display())]
    Exists {
        /// The path.
        path: PathBuf,
    },
    /// The system refuses.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The path.
        path: PathBuf,
        /// What the system reports.
        source: Error,
    },
}

impl WriteError {
    /// The error of a file at this path.
    pub fn at(path: &Path, source: Error) -> WriteError {
        let path = path.to_owned();
        match source.kind() {
            ErrorKind::AlreadyExists => WriteError::Exists { path },
            _ => WriteError::Io { path, source },
        }
    }
}

/// Writes a file of these bytes. It appears whole or not at all.
///
/// # Errors
/// [`WriteError`]: `Exists` if there is a file already and `force` is not given.
pub fn write_all(path: &Path, force: bool, bytes: &[u8]) -> Result<(), WriteError> {
    write(path, force, |file| file.write_all(bytes)).map_err(|source| WriteError::at(path, source))
}

/// Lets `fill` write the file that then appears at `path`.
///
/// # Errors
/// As [`PartialFile::new`] and [`PartialFile::finish`], and those of `fill`.
pub fn write<E: From<Error>>(
    path: &Path,
    force: bool,
    fill: impl FnOnce(&mut Output<'_>) -> Result<(), E>,
) -> Result<(), E> {
    Ok(PartialFile::filled(path, force, fill)?.finish()?)
}

/// A file that is not finished. Dropped, it is removed.
pub struct PartialFile {
    place: TempPath,
    path: PathBuf,
    force: bool,
}

impl PartialFile {
    /// An empty file that is to appear at `path`, in place of another one only with `force`.
    ///
    /// # Errors
    /// `AlreadyExists` if a file is there that may not be replaced; `IsADirectory` and `InvalidInput` if a directory, a device or a
    /// pipe is there; those of the system.
    pub fn new(path: &Path, force: bool) -> io::Result<PartialFile> {
        PartialFile::filled(path, force, |_| Ok(()))
    }

    /// A file that `fill` has written.
    ///
    /// # Errors
    /// As [`PartialFile::new`], and those of `fill`.
    pub fn filled<E: From<Error>>(
        path: &Path,
        force: bool,
        fill: impl FnOnce(&mut Output<'_>) -> Result<(), E>,
    ) -> Result<PartialFile, E> {
        check(path, force)?;
        let file = builder(0o666).tempfile_in(folder(path))?;
        let mut output = BufWriter::with_capacity(1 << 18, file.as_file());
        fill(&mut output)?;
        output.flush()?;
        drop(output);
        // Closed, for there may be thousands of them.
        Ok(PartialFile { place: file.into_temp_path(), path: path.to_owned(), force })
    }

    /// Where it is until it is finished.
    pub fn place(&self) -> &Path {
        &self.place
    }

    /// Gives it its name.
    ///
    /// # Errors
    /// `AlreadyExists` where a file that may not be replaced has come up; those of the system.
    pub fn finish(self) -> io::Result<()> {
        if self.force {
            return Ok(self.place.persist(&self.path)?);
        }
        match self.place.persist_noclobber(&self.path) {
            // Some network file systems can neither link nor rename without replacing; nothing was there at the start.
            Err(failed) if failed.error.kind() != ErrorKind::AlreadyExists => {
                Ok(failed.path.persist(&self.path)?)
            }
            done => Ok(done?),
        }
    }
}

/// A directory that is not finished. Dropped, it is removed.
pub struct PartialDirectory {
    directory: TempDir,
    path: PathBuf,
}

impl PartialDirectory {
    /// An empty directory that is to appear at `path`, in place of one that may stand there.
    ///
    /// # Errors
    /// Those of the system.
    pub fn new(path: &Path) -> io::Result<PartialDirectory> {
        let directory = builder(0o777).tempdir_in(folder(path))?;
        Ok(PartialDirectory { directory, path: path.to_owned() })
    }

    /// Where it is until it is finished.
    pub fn place(&self) -> &Path {
        self.directory.path()
    }

    /// Gives it its name.
    ///
    /// # Errors
    /// Those of the system.
    pub fn finish(self) -> io::Result<()> {
        // The old directory is moved aside first, and goes when the new one has its name.
        let aside = builder(0o777).tempdir_in(folder(&self.path))?;
        let old = aside.path().join("old");
        let moved = match fs::rename(&self.path, &old) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            moved => moved.is_ok(),
        };
        fs::rename(self.directory.path(), &self.path).inspect_err(|_| {
            if moved {
                let _ = fs::rename(&old, &self.path);
            }
        })?;
        // Its place is empty now.
        let _ = self.directory.keep();
        Ok(())
    }
}

/// Whether a file may be made at `path`.
fn check(path: &Path, force: bool) -> io::Result<()> {
    if let Some(found) = no_file(path) {
        let kind = if path.is_dir() { ErrorKind::IsADirectory } else { ErrorKind::InvalidInput };
        return Err(Error::new(kind, format!("it {found}; choose another name")));
    }
    if path.file_name().is_none() {
        return Err(ErrorKind::InvalidFilename.into());
    }
    if !force && fs::symlink_metadata(path).is_ok() {
        return Err(Error::new(
            ErrorKind::AlreadyExists,
            "it exists already; choose another name or replace it (--force)",
        ));
    }
    Ok(())
}

/// What stands at `path` where it is no file, as the rest of a sentence. A link counts as what it leads to, so that /dev/null is
/// never replaced by a file.
pub fn no_file(path: &Path) -> Option<&'static str> {
    let found = fs::metadata(path).ok().filter(|found| !found.is_file())?;
    Some(if found.is_dir() { "is a directory" } else { "is a device or a pipe" })
}

/// The directory that `path` is in.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What makes the names of what is not finished, with the permissions that the user's mask leaves of `mode`.
fn builder(mode: u32) -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".asperity-").suffix(".partial");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    #[cfg(not(unix))]
    let _ = mode;
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(directory)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// A write that fails after it has filled the buffer, as on a full disk.
    fn fails(output: &mut Output<'_>) -> io::Result<()> {
        output.write_all(&[1; 1 << 20])?;
        Err(ErrorKind::StorageFull.into())
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a");
        assert_eq!(write(&path, false, fails).unwrap_err().kind(), ErrorKind::StorageFull);
        assert!(names(directory.path()).is_empty());
        fs::write(&path, "old").unwrap();
        assert_eq!(write(&path, true, fails).unwrap_err().kind(), ErrorKind::StorageFull);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(directory.path()), ["a"]);
    }

    #[test]
    fn a_file_is_replaced_only_with_force() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a");
        let text = |text: &'static str| move |output: &mut Output<'_>| output.write_all(text.as_bytes());
        write(&path, false, text("first")).unwrap();
        assert_eq!(write(&path, false, text("second")).unwrap_err().kind(), ErrorKind::AlreadyExists);
        assert_eq!(fs::read_to_string(&path).unwrap(), "first");
        write(&path, true, text("third")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "third");
        assert_eq!(names(directory.path()), ["a"]);
    }

    #[test]
    fn a_file_that_came_up_meanwhile_is_not_replaced() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a");
        let partial = PartialFile::new(&path, false).unwrap();
        fs::write(&path, "of another").unwrap();
        assert_eq!(partial.finish().unwrap_err().kind(), ErrorKind::AlreadyExists);
        assert_eq!(fs::read_to_string(&path).unwrap(), "of another");
        assert_eq!(names(directory.path()), ["a"]);
    }

    #[test]
    fn a_directory_takes_the_place_of_the_old_one() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a");
        for name in ["first", "second"] {
            let partial = PartialDirectory::new(&path).unwrap();
            fs::write(partial.place().join(name), name).unwrap();
            partial.finish().unwrap();
            assert_eq!(names(&path), [name]);
        }
        drop(PartialDirectory::new(&path).unwrap());
        assert_eq!(names(&path), ["second"]);
        assert_eq!(names(directory.path()), ["a"]);
    }

    #[test]
    fn a_directory_is_not_replaced_by_a_file() {
        let directory = tempfile::tempdir().unwrap();
        let refused = write(directory.path(), true, |output| output.write_all(b"x"));
        assert_eq!(refused.unwrap_err().kind(), ErrorKind::IsADirectory);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_not_replaced() {
        let directory = tempfile::tempdir().unwrap();
        let null = directory.path().join("null");
        std::os::unix::fs::symlink("/dev/null", &null).unwrap();
        let refused = write(&null, true, |output| output.write_all(b"x"));
        assert_eq!(refused.unwrap_err().kind(), ErrorKind::InvalidInput);
        assert!(null.is_symlink() && names(directory.path()) == ["null"]);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_other_files() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().unwrap();
        let mode =
            |name: &str| fs::metadata(directory.path().join(name)).unwrap().permissions().mode() & 0o777;
        fs::write(directory.path().join("file"), "").unwrap();
        fs::create_dir(directory.path().join("folder")).unwrap();
        write(&directory.path().join("new file"), false, |output| output.write_all(b"x")).unwrap();
        PartialDirectory::new(&directory.path().join("new folder")).unwrap().finish().unwrap();
        assert_eq!(mode("new file"), mode("file"));
        assert_eq!(mode("new folder"), mode("folder"));
    }
}
