//! Figures as files.

use std::path::{Path, PathBuf};

use asperity_io::output::{self, WriteError};

use super::{Figure, Map, Pixels, dots, font, pdf, raster};

/// Points of paper per inch.
const POINTS: f64 = 72.0;

/// Most panels of a figure: in two columns they fill paper of 2.3 m, and take 0.8 GB while they are drawn as PNG.
pub(crate) const PANELS: usize = 64;
/// Most letters of a title.
const TITLE: usize = 1000;

/// A form that a figure is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Scalable vector graphics, for papers and the web.
    Svg,
    /// Dots, 300 to an inch.
    Png,
    /// Portable document (PDF), one page of the figure's size, with its typeface.
    Pdf,
}

/// Why a figure cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The ending of the path names no form that is known.
    #[error("{}: the ending says what a figure is written as: use .svg, .png or .pdf", path.display())]
    Ending {
        /// The path.
        path: PathBuf,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The panels do not fit on the paper asked for.
    #[error(
        "{:.0} mm x {:.0} mm are too small for this figure; {:.0} mm x {:.0} mm are enough",
        millimetres(asked[0]), millimetres(asked[1]), millimetres(needed[0]).ceil(), millimetres(needed[1]).ceil()
    )]
    Size {
        /// Width and height asked for \[points\].
        asked: [f64; 2],
        /// Width and height that are enough, in the same proportion \[points\].
        needed: [f64; 2],
    },
    /// The paper would grow without bound.
    #[error("the figure would have {found} panels, but may have {PANELS}; draw fewer in one figure")]
    Panels {
        /// So many it would have.
        found: usize,
    },
    /// The title would cover the figure.
    #[error("the title has {letters} letters, but may have {TITLE}; give a shorter one (--title)")]
    Title {
        /// So many it has.
        letters: usize,
    },
    /// The drawing could not be made into dots.
    #[error("cannot draw the figure: {0}")]
    Drawing(String),
}

impl Map {
    /// The values in their colours alone, with `side` cells along a side at most, as PNG.
    pub(crate) fn icon(&self, side: usize) -> Result<Vec<u8>, FigureError> {
        raster::png(&self.reduced(side).picture()).map_err(undrawn)
    }
}

impl Form {
    /// The form that the ending of a path asks for.
    ///
    /// # Errors
    /// [`FigureError::Ending`] where it is none of `.svg`, `.png` and `.pdf`.
    pub fn of(path: &Path) -> Result<Form, FigureError> {
        match path.extension().map(|ending| ending.to_ascii_lowercase()) {
            Some(ending) if ending == "svg" => Ok(Form::Svg),
            Some(ending) if ending == "png" => Ok(Form::Png),
            Some(ending) if ending == "pdf" => Ok(Form::Pdf),
            _ => Err(FigureError::Ending { path: path.to_owned() }),
        }
    }
}

impl Figure {
    /// Writes the figure in the form that the ending of `path` asks for. The file appears whole or not at all.
    ///
    /// # Errors
    /// [`FigureError::Ending`] for an unknown ending; [`FigureError::Panels`] and [`FigureError::Title`] where there are too many
    /// panels or letters; [`FigureError::Write`] where there is a file already and `force` is not given, or the system refuses.
    pub fn write(&self, path: &Path, force: bool) -> Result<(), FigureError> {
        let form = Form::of(path)?;
        self.check()?;
        let data = match form {
            Form::Svg => self.to_svg().into_bytes(),
            Form::Png => self.to_png(300.0)?,
            Form::Pdf => self.to_pdf()?,
        };
        Ok(output::write_all(path, force, &data)?)
    }

    /// Refuses what would take much time and memory to draw.
    pub(super) fn check(&self) -> Result<(), FigureError> {
        let (found, letters) = (self.panels.len(), self.title.chars().count());
        if found > PANELS {
            return Err(FigureError::Panels { found });
        }
        if letters > TITLE { Err(FigureError::Title { letters }) } else { Ok(()) }
    }

    /// The letters of its texts that its typeface lacks, each once: PNG and PDF have a box for each, and SVG leaves them to the
    /// typefaces of the viewer.
    pub fn missing_letters(&self) -> Vec<char> {
        let drawing = self.drawing();
        let mut missing = vec![];
        for c in drawing.texts().flat_map(str::chars).filter(|c| font::glyph(*c).is_none()) {
            if !missing.contains(&c) {
                missing.push(c);
            }
        }
        missing
    }

    /// The figure as PNG with `dots` to an inch.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] where `dots` is not within 20 to 2400; [`FigureError::Panels`] and [`FigureError::Title`].
    pub fn to_png(&self, dots: f64) -> Result<Vec<u8>, FigureError> {
        raster::png(&self.dots(dots)?).map_err(undrawn)
    }

    /// The figure as dots, so many to an inch.
    pub(crate) fn dots(&self, dots: f64) -> Result<Pixels, FigureError> {
        if !(20.0..=2400.0).contains(&dots) {
            return Err(FigureError::Drawing(format!("{dots} dots per inch; expected 20 to 2400")));
        }
        self.check()?;
        let scale = dots / POINTS;
        let size = self.paper().map(|length| (length * scale).round() as u32);
        dots::draw(&self.drawing(), size, scale * self.zoom).ok_or_else(|| undrawn("its paper has no area"))
    }

    /// The figure as a PDF of one page.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] where its data cannot be compressed; [`FigureError::Panels`] and [`FigureError::Title`].
    pub fn to_pdf(&self) -> Result<Vec<u8>, FigureError> {
        self.check()?;
        pdf::write(&self.drawing(), self.paper(), self.zoom, &self.title).map_err(undrawn)
    }
}

/// Points of paper in millimetres.
fn millimetres(points: f64) -> f64 {
    points * 25.4 / POINTS
}

fn undrawn(why: impl std::fmt::Display) -> FigureError {
    FigureError::Drawing(why.to_string())
}
