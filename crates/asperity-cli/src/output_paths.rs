//! Refuses an output that would replace what the command reads, whether or not --force is given.

use std::path::{Path, PathBuf};

use crate::args::{Command, Material, Surface};
use crate::failure::Failure;

/// Refuses an output at the path of an input, or within a result that is read.
pub fn check(command: &Command) -> Result<(), Failure> {
    let (inputs, outputs) = paths(command);
    let inputs: Vec<_> = inputs.iter().filter_map(|path| path.canonicalize().ok()).collect();
    for output in outputs {
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

/// What a command reads, and what it writes by an option.
fn paths(command: &Command) -> (Vec<&Path>, Vec<&Path>) {
    fn all<'a>(paths: &[Option<&'a PathBuf>]) -> Vec<&'a Path> {
        paths.iter().flatten().map(|path| path.as_path()).collect()
    }
    let (inputs, outputs): (Vec<Option<&PathBuf>>, Vec<Option<&PathBuf>>) = match command {
        Command::Surface(Surface::Info(info)) => (vec![Some(&info.file.file)], vec![info.plot.as_ref()]),
        Command::Surface(Surface::FromProfile(from)) => {
            (vec![Some(&from.file.file)], vec![Some(&from.to.output), from.to.plot.as_ref()])
        }
        Command::Surface(Surface::Process(process)) => {
            (vec![Some(&process.file.file)], vec![Some(&process.to.output), process.to.plot.as_ref()])
        }
        Command::Surface(Surface::Convert(convert)) => {
            (vec![Some(&convert.file.file)], vec![Some(&convert.output)])
        }
        Command::Material(Material::Show(show)) => (vec![Some(&show.file)], vec![show.plot.as_ref()]),
        Command::Material(Material::Fit(fit)) => {
            (vec![Some(&fit.data), fit.shift_table.as_ref()], vec![fit.output.as_ref(), fit.plot.as_ref()])
        }
        Command::Material(Material::Export(export)) => {
            (vec![Some(&export.file)], vec![export.output.as_ref()])
        }
        Command::FitIndentation(fit) => {
            (vec![Some(&fit.record)], vec![fit.output.as_ref(), fit.plot.as_ref()])
        }
        Command::Report(report) => (vec![Some(&report.result)], vec![report.output.as_ref()]),
        Command::Plot(plot) => {
            (plot.results.iter().map(Some).collect(), vec![plot.output.as_ref(), plot.animate.as_ref()])
        }
        Command::Stress(stress) => {
            (vec![Some(&stress.result)], vec![stress.plot.as_ref(), stress.output.as_ref()])
        }
        Command::Leak(leak) => {
            (vec![leak.result.as_ref(), leak.gap.as_ref(), leak.contact.as_ref()], vec![leak.plot.as_ref()])
        }
        Command::Export(export) => (vec![Some(&export.result)], vec![export.output.as_ref()]),
        _ => (Vec::new(), Vec::new()),
    };
    (all(&inputs), all(&outputs))
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
            check(&Args::try_parse_from(["asperity".to_owned()].into_iter().chain(paths)).unwrap().command)
                .is_ok()
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
