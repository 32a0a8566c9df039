//! Several results: which of the named files they are, and what they are called: by the option --label, or by what differs between
//! their cases.

use std::path::{Path, PathBuf};

use asperity_io::compare;
use asperity_io::store::Reader;

use crate::args::Labels;
use crate::failure::{Failure, refuse};
use crate::format::counted;

/// Opens results. Of several paths, such as those of `study/*`, files and the table of a study are no results; they are left out and told.
pub fn open(paths: &[PathBuf]) -> Result<Vec<Reader>, Failure> {
    let is_other = |path: &Path| path.is_file() || asperity_io::study::is_dataset(path);
    let (others, results): (Vec<&PathBuf>, Vec<&PathBuf>) = paths.iter().partition(|path| is_other(path));
    if results.is_empty() || others.is_empty() {
        return Ok(paths.iter().map(|path| Reader::open(path)).collect::<Result<_, _>>()?);
    }
    let names: Vec<String> = others.iter().map(|path| path.display().to_string()).collect();
    crate::messages::message!("left out, as no results: {}", names.join(", "));
    Ok(results.into_iter().map(|path| Reader::open(path)).collect::<Result<_, _>>()?)
}

/// A label for each result.
pub fn of(options: &Labels, readers: &[Reader]) -> Result<Vec<String>, Failure> {
    let given = &options.label;
    if given.is_empty() {
        let paths: Vec<PathBuf> = readers.iter().map(|reader| reader.path().to_owned()).collect();
        return Ok(compare::labels(readers, &names(&paths)));
    }
    match given.len() == readers.len() {
        true => Ok(given.clone()),
        false => {
            let (labels, results) = (counted(given.len(), "label"), counted(readers.len(), "result"));
            refuse!("--label: there are {labels}, but {results}; give one for each, in their order")
        }
    }
}

/// What the results are called by their file names or, where two have the same, by their paths.
fn names(results: &[PathBuf]) -> Vec<String> {
    let short = |path: &PathBuf| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let is_twice = |name: &String| results.iter().filter(|path| short(path) == *name).count() > 1;
    let name =
        |path| Some(short(path)).filter(|name| !is_twice(name)).unwrap_or_else(|| path.display().to_string());
    results.iter().map(name).collect()
}
