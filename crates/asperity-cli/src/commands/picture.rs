//! Pictures as files.

use std::path::Path;

use asperity_report::figure::{Figure, Form};

use crate::failure::Failure;

/// Writes a picture, and warns on stderr which letters it shows as boxes because its typeface lacks them.
pub fn write(figure: &Figure, path: &Path, force: bool) -> Result<(), Failure> {
    figure.write(path, force)?;
    if !matches!(Form::of(path), Ok(Form::Svg)) {
        warn_of_missing_letters(figure);
    }
    Ok(())
}

/// Warns which letters of a picture its typeface lacks.
pub fn warn_of_missing_letters(figure: &Figure) {
    /// So many letters are named.
    const MOST: usize = 20;
    let missing = figure.missing_letters();
    if missing.is_empty() {
        return;
    }
    let more = if missing.len() > MOST { " ..." } else { "" };
    let letters: String = missing.into_iter().take(MOST).collect();
    crate::messages::message!(
        "warning: the typeface of the pictures lacks {letters}{more}: they are drawn as boxes; \
         an .svg leaves them to the typefaces of the viewer"
    );
}
