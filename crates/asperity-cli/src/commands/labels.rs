//! What several results are called: by the option --label, or by what differs between their cases.

use std::path::PathBuf;

use asperity_io::compare;
use asperity_io::store::Reader;

use crate::args::Labels;
use crate::failure::Failure;
use crate::format::counted;

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
            Err(Failure::input(format!(
                "--label: there are {labels}, but {results}; give one for each, in their order"
            )))
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
