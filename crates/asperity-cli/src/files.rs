//! The files that a verb reads and writes, and what is refused before it begins: an output that replaces an input, a file that
//! exists, a folder that does not exist, a figure in an unknown format.

use std::path::{Path, PathBuf};

use asperity_io::output::WriteError;
use asperity_report::figure::Form;

use crate::failure::{Failure, refuse};

/// The files of a verb.
#[derive(Default)]
pub struct Files {
    reads: Vec<PathBuf>,
    writes: Vec<PathBuf>,
    figures: Vec<PathBuf>,
    force: bool,
}

impl Files {
    /// Files that are read and may not be replaced, not even with --force.
    pub fn reads(mut self, paths: impl IntoIterator<Item: AsRef<Path>>) -> Files {
        self.reads.extend(owned(paths));
        self
    }

    /// Files that are written.
    pub fn writes(mut self, paths: impl IntoIterator<Item: AsRef<Path>>) -> Files {
        self.writes.extend(owned(paths));
        self
    }

    /// Figures that are written, in the format that the extension selects.
    pub fn draws(mut self, paths: impl IntoIterator<Item: AsRef<Path>>) -> Files {
        self.figures.extend(owned(paths));
        self
    }

    /// Whether existing files are replaced.
    pub fn force(self, force: bool) -> Files {
        Files { force, ..self }
    }

    /// Refuses what cannot be written.
    pub fn check(&self) -> Result<(), Failure> {
        for figure in &self.figures {
            Form::of(figure)?;
        }
        let inputs: Vec<_> = self.reads.iter().filter_map(|path| path.canonicalize().ok()).collect();
        for output in self.writes.iter().chain(&self.figures) {
            let place = place(output).unwrap_or_default();
            if let Some(input) = inputs.iter().find(|input| place.starts_with(input)) {
                let what = if place == *input {
                    "what it is made from"
                } else {
                    "a part of the result that is read"
                };
                refuse!(
                    "{} would replace {what}; choose another output (--force does not help here)",
                    output.display()
                );
            }
            free(output, self.force)?;
        }
        Ok(())
    }
}

fn owned(paths: impl IntoIterator<Item: AsRef<Path>>) -> impl Iterator<Item = PathBuf> {
    paths.into_iter().map(|path| path.as_ref().to_owned())
}

/// Refuses a file that exists, unless `force` is given, and one in a folder that does not exist.
fn free(path: &Path, force: bool) -> Result<(), Failure> {
    if path.exists() && !force {
        return Err(WriteError::Exists { path: path.to_owned() }.into());
    }
    match path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
        Some(folder) => {
            refuse!("cannot write {}: there is no folder {}; make it first", path.display(), folder.display())
        }
        None => Ok(()),
    }
}

/// The path without links, also of a file that does not exist yet.
fn place(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    path.canonicalize().ok().or_else(|| Some(folder.canonicalize().ok()?.join(path.file_name()?)))
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use crate::args::Args;

    #[test]
    fn outputs_at_or_within_the_input_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(at("data.csv"), "").unwrap();
        std::fs::create_dir_all(at("r.zarr/pressure")).unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(at("data.csv"), at("link.csv")).unwrap();
        let checked = |words: &[&str]| {
            let paths = words.iter().map(|word| match word.contains('.') {
                true => at(word),
                false => (*word).to_owned(),
            });
            let args = Args::try_parse_from(["asperity".to_owned()].into_iter().chain(paths)).unwrap();
            let verb = args.command.verb();
            verb.files().check().is_ok()
        };
        assert!(!checked(&["material", "fit", "data.csv", "-o", "data.csv", "--force"]));
        assert!(!checked(&["material", "fit", "data.csv", "--plot", "r.zarr/../data.csv"]));
        assert!(cfg!(windows) || !checked(&["surface", "convert", "link.csv", "data.csv", "--force"]));
        assert!(!checked(&["export", "r.zarr", "--to", "netcdf", "-o", "r.zarr/zarr.json", "--force"]));
        assert!(!checked(&["plot", "r.zarr", "pressure", "--animate", "r.zarr/pressure/a.gif"]));
        assert!(checked(&["material", "fit", "data.csv", "-o", "data.toml"]));
        assert!(checked(&["export", "r.zarr", "--to", "netcdf", "-o", "r.zarr.nc"]));
        assert!(checked(&["show", "r.zarr"]));
    }
}
