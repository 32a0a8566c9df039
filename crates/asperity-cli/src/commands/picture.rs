//! Pictures as files.

use std::path::Path;

use asperity_report::figure::{Figure, Form};

use crate::failure::Failure;

/// Writes a picture, and tells on stderr which letters it shows as boxes because its typeface lacks them.
pub fn write(figure: &Figure, path: &Path, force: bool) -> Result<(), Failure> {
    figure.write(path, force).map_err(Failure::of)?;
    if !matches!(Form::of(path), Ok(Form::Svg)) {
        tell_missing(figure);
    }
    Ok(())
}

/// Tells which letters of a picture its typeface lacks.
pub fn tell_missing(figure: &Figure) {
    /// So many letters are told.
    const MOST: usize = 20;
    let missing = figure.missing_letters();
    if missing.is_empty() {
        return;
    }
    let more = if missing.len() > MOST { " ..." } else { "" };
    let letters: String = missing.into_iter().take(MOST).collect();
    crate::talk::say!(
        "warning: the typeface of the pictures lacks {letters}{more}: they are drawn as boxes; \
         an .svg leaves them to the typefaces of the viewer"
    );
}
