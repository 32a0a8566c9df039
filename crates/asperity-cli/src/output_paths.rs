//! Refuses an output that would replace what the command reads, whether or not --force is given.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::verb::Paths;

/// Refuses an output at the path of an input, or within a result that is read.
pub fn check(inputs: &Paths<'_>, outputs: &Paths<'_>) -> Result<(), Failure> {
    let inputs: Vec<_> = inputs.iter().flatten().filter_map(|path| path.canonicalize().ok()).collect();
    for output in outputs.iter().flatten() {
        let Some(place) = place(output) else { continue };
        if let Some(input) = inputs.iter().find(|input| place.starts_with(input)) {
            let what =
                if place == *input { "what it is made from" } else { "a part of the result that is read" };
            return Err(Failure::input(format!(
                "{} would replace {what}; choose another output (--force does not help here)",
                output.display()
            )));
        }
    }
    Ok(())
}

/// The path without links, of a file that may not be there yet.
fn place(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    path.canonicalize().ok().or_else(|| Some(folder.canonicalize().ok()?.join(path.file_name()?)))
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
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
            check(&verb.reads(), &verb.writes()).is_ok()
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
