//! Figures as files.

use std::io::Write;
use std::path::{Path, PathBuf};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use super::{Figure, font};

/// Points of paper per inch.
const POINTS: f64 = 72.0;

/// A form that a figure is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Scalable vector graphics, for papers and the web.
    Svg,
    /// Dots, 300 to an inch.
    Png,
}

/// Why a figure cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The ending of the path names no form that is known.
    #[error("{}: the ending says what a figure is written as: use .svg or .png", path.display())]
    Ending {
        /// The path.
        path: PathBuf,
    },
    /// There is something at the path.
    #[error("{} exists: choose another name, or allow it to be replaced", path.display())]
    Exists {
        /// The path.
        path: PathBuf,
    },
    /// The system refuses.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The path.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The drawing could not be made into dots.
    #[error("cannot draw the figure: {0}")]
    Drawing(String),
}

impl Form {
    /// The form that the ending of a path asks for.
    ///
    /// # Errors
    /// [`FigureError::Ending`] where it is neither `.svg` nor `.png`.
    pub fn of(path: &Path) -> Result<Form, FigureError> {
        match path.extension().map(|ending| ending.to_ascii_lowercase()) {
            Some(ending) if ending == "svg" => Ok(Form::Svg),
            Some(ending) if ending == "png" => Ok(Form::Png),
            _ => Err(FigureError::Ending { path: path.to_owned() }),
        }
    }
}

impl Figure {
    /// Writes the figure in the form that the ending of `path` asks for. The file appears whole or not at all.
    ///
    /// # Errors
    /// [`FigureError::Ending`] for an unknown ending; [`FigureError::Exists`] where there is a file already and
    /// `force` does not allow to replace it; [`FigureError::Io`] where the system refuses.
    pub fn write(&self, path: &Path, force: bool) -> Result<(), FigureError> {
        let data = match Form::of(path)? {
            Form::Svg => self.to_svg().into_bytes(),
            Form::Png => self.to_png(300.0)?,
        };
        let failed = |source: std::io::Error| match source.kind() {
            std::io::ErrorKind::AlreadyExists => FigureError::Exists { path: path.to_owned() },
            _ => FigureError::Io { path: path.to_owned(), source },
        };
        let directory = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut file = builder().tempfile_in(directory).map_err(failed)?;
        file.write_all(&data).map_err(failed)?;
        if force {
            file.persist(path).map_err(|error| failed(error.error))?;
        } else {
            file.persist_noclobber(path).map_err(|error| failed(error.error))?;
        }
        Ok(())
    }

    /// The figure as PNG with `dots` to an inch.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] where `dots` is not within 20 to 2400.
    pub fn to_png(&self, dots: f64) -> Result<Vec<u8>, FigureError> {
        if !(20.0..=2400.0).contains(&dots) {
            return Err(FigureError::Drawing(format!("{dots} dots per inch; expected 20 to 2400")));
        }
        let options =
            Options { fontdb: font::database(), font_family: "DejaVu Sans".into(), ..Options::default() };
        let failed = |what: &dyn std::fmt::Display| FigureError::Drawing(what.to_string());
        let tree = Tree::from_str(&self.to_svg(), &options).map_err(|error| failed(&error))?;
        let paper = self.paper();
        let scale = dots / POINTS;
        let [width, height] = paper.map(|length| (length * scale).round() as u32);
        let mut dots = Pixmap::new(width, height).ok_or_else(|| failed(&"it has no area"))?;
        // The tree measures in its own pixels; the paper in points.
        let size = tree.size();
        let transform = Transform::from_scale(width as f32 / size.width(), height as f32 / size.height());
        resvg::render(&tree, transform, &mut dots.as_mut());
        dots.encode_png().map_err(|error| failed(&error))
    }
}

/// New files get the permissions that the user's mask leaves, as other files do.
fn builder() -> tempfile::Builder<'static, 'static> {
    #[allow(unused_mut)]
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}
