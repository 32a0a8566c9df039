//! Measured surfaces of a case: from a topography file to heights on the grid.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use asperity::Grid;
use asperity::surface::{Operation, Part, Surface};

use crate::preparation::{Prepared, Step, prepare};
use crate::topography::{ReadOptions, TopographyError, read, read_profile};

/// A topography file of a case and what is done with it.
///
/// The file is read and prepared once; what comes of it is kept.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The file.
    pub path: PathBuf,
    /// Path of the key in the case that names the file.
    pub(super) key: String,
    /// Channel, physical size and unit, where the case gives them.
    pub options: ReadOptions,
    /// Whether the case gives a size, and of a profile; `None` where it gives none.
    size_of_line: Option<bool>,
    /// What is done with the heights, in order.
    pub steps: Vec<Step>,
    prepared: Arc<Mutex<Option<Kept>>>,
}

/// The surface prepared for these cells of the domain (`None`: the domain takes those of the surface).
#[derive(Debug)]
struct Kept {
    domain: Option<[usize; 2]>,
    prepared: Arc<Prepared>,
}

impl PartialEq for Measured {
    fn eq(&self, other: &Self) -> bool {
        (&self.path, &self.options, &self.steps) == (&other.path, &other.options, &other.steps)
    }
}

/// Size of the file against size of the domain: they agree to this share.
const SAME: f64 = 1e-6;

impl Measured {
    /// `size_of_line` says whether the size among the options is that of a profile.
    pub(super) fn new(
        path: PathBuf,
        key: String,
        options: ReadOptions,
        size_of_line: Option<bool>,
        steps: Vec<Step>,
    ) -> Self {
        Measured { path, key, options, size_of_line, steps, prepared: Arc::default() }
    }

    /// The heights as they are in the file, and what was done to read them.
    fn read(&self) -> Result<(Surface, Vec<String>), String> {
        let told = |error: TopographyError| error.to_string();
        let of_file = |error| format!("{}: {error}", self.path.display());
        let profile = match self.options.format {
            None => read_profile(&self.path, &self.options).map_err(told)?,
            Some(_) => None,
        };
        if let Some(line) = self.size_of_line.filter(|line| *line != profile.is_some()) {
            let (holds, wanted) =
                if line { ("a surface over a plane", "two values") } else { ("a profile", "one value") };
            return Err(format!("{} holds {holds}, so its size needs {wanted}", self.path.display()));
        }
        if let Some(profile) = profile {
            return Ok((profile.surface, profile.history));
        }
        let topography = read(&self.path, &self.options).map_err(told)?;
        let history = topography.history().map(str::to_owned).collect();
        let (nx, ny) = topography.heights.dim();
        let grid = Grid::new([nx, ny], topography.size).map_err(of_file)?;
        Ok((Surface::new(grid, topography.heights).map_err(of_file)?, history))
    }

    /// The surface after its preparation; `domain` are the cells of the domain, `None` where it takes the surface's
    /// (a step that resamples to the domain then does nothing).
    ///
    /// # Errors
    /// A sentence: the file cannot be read, or a step fails.
    pub fn prepared(&self, domain: Option<[usize; 2]>) -> Result<Arc<Prepared>, String> {
        let mut kept = self.prepared.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(Kept { domain: of, prepared }) = &*kept
            && (of.is_none() || *of == domain)
        {
            return Ok(prepared.clone());
        }
        let of_file = |error| format!("{}: {error}", self.path.display());
        let (surface, first) = self.read()?;
        // Where the domain takes the cells of this surface, they need not be changed.
        let open = |step: &&Step| matches!(step, Step::Resample { cells: None, .. });
        let steps: Vec<Step> = match domain {
            Some(_) => self.steps.clone(),
            None => self.steps.iter().filter(|step| !open(step)).cloned().collect(),
        };
        let mut prepared = prepare(surface, &steps, domain).map_err(of_file)?;
        prepared.history.splice(0..0, first);
        let prepared = Arc::new(prepared);
        *kept = Some(Kept { domain, prepared: prepared.clone() });
        Ok(prepared)
    }

    /// What was done to the surface, one sentence per step; `None` where it was not read yet.
    pub fn history(&self) -> Option<Vec<String>> {
        let kept = self.prepared.lock().unwrap_or_else(PoisonError::into_inner);
        kept.as_ref().map(|kept| kept.prepared.history.clone())
    }

    /// Whether the case continues the surface by its reflections.
    fn is_mirrored(&self) -> bool {
        self.steps.contains(&Step::Operation(Operation::Mirror))
    }

    /// Words behind a size or a number of points.
    fn with_reflections(&self) -> &'static str {
        if self.is_mirrored() { " with its reflections" } else { "" }
    }

    /// The heights as a part of the gap.
    ///
    /// # Errors
    /// A sentence: the file cannot be read, a step fails, or the surface does not fit the grid.
    pub fn part(&self, grid: &Grid) -> Result<Part, String> {
        let prepared = self.prepared(Some(grid.cells()))?;
        let name = self.path.display().to_string();
        let line = prepared.surface.grid().is_line();
        if line != grid.is_line() {
            return Err(match line {
                true => format!(
                    "{name} holds a profile, but the domain is a plane; a profile is for a line contact, with one value in \
                     domain.cells and domain.size"
                ),
                false => format!(
                    "{name} holds a surface over a plane, but the domain is a line of cells; give domain.cells and domain.size \
                     two values, or the file of a profile with two columns, position and height"
                ),
            });
        }
        let of_file = prepared.surface.grid();
        let (what, along) = if line { ("profile", 1) } else { ("surface", 2) };
        let numbers = |values: [String; 2], between: &str| values[..along].join(between);
        let (size, domain) = (of_file.size(), grid.size());
        let agree = |axis: usize| (size[axis] - domain[axis]).abs() <= SAME * domain[axis];
        if !(agree(0) && agree(1)) {
            let [own, wanted] =
                [size, domain].map(|size| numbers(size.map(|side| format!("{:e} m", digits(side))), " x "));
            let is_larger = (0..2).all(|axis| domain[axis] <= size[axis] * (1.0 + SAME));
            // Nobody knows what lies around a measured surface.
            let crop = match is_larger && !line {
                true => {
                    let [x, y] =
                        domain.map(|side| digits(if self.is_mirrored() { 0.5 * side } else { side }));
                    let mirrored =
                        if self.is_mirrored() { ", half of the domain before the reflections" } else { "" };
                    format!(", or keep a part of the surface: crop = {{ size = [{x:e}, {y:e}] }}{mirrored}")
                }
                false => String::new(),
            };
            return Err(format!(
                "{name} measures {own}{}, but the domain {wanted}; leave domain.size out to take that of the {what}{crop}",
                self.with_reflections()
            ));
        }
        if of_file.cells() != grid.cells() {
            let counts = |grid: &Grid, between: &str| numbers(grid.cells().map(|n| n.to_string()), between);
            return Err(format!(
                "{name} holds {} points{}, but the domain has {} cells; leave domain.cells out to take those of the {what}, set \
                 domain.cells = [{}], or add resample = \"bilinear\" (or \"band-limited\") to this surface",
                counts(of_file, " x "),
                self.with_reflections(),
                counts(grid, " x "),
                counts(of_file, ", "),
            ));
        }
        Ok(Part::Heights { name, heights: prepared.surface.heights().to_owned() })
    }
}

/// A length with nine digits, without what rounding has left behind them.
fn digits(length: f64) -> f64 {
    format!("{length:.8e}").parse().unwrap_or(length)
}
