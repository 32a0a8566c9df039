//! Preparing a measured surface: steps that may depend on the surface that they meet, and the record of what was
//! done.
//!
//! An [`Operation`] is complete in itself. A [`Step`] may leave open what the surface or the case decides: a crop in
//! lengths, the middle of the surface, the cells of the domain. [`prepare`] settles that, applies the operations in
//! order, and writes down each one as it was done.

use asperity::surface::process::{self, Border, Resampling};
use asperity::surface::profile::remove_circle;
use asperity::surface::{Operation, Surface};
use asperity::{Error, Result};

use crate::resources;

/// One step of a preparation.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// As it stands.
    Operation(Operation),
    /// Subtract a circle from a profile; `None`: of the radius that fits best.
    Circle {
        /// Radius \[m\].
        radius: Option<f64>,
    },
    /// Keep a rectangle.
    Crop(Crop),
    /// Other cells over the same rectangle; `None`: those of the domain.
    Resample {
        /// Cells along x and y.
        cells: Option<[usize; 2]>,
        /// How.
        method: Resampling,
    },
}

/// A rectangle to keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crop {
    /// A number of cells; from the first cell given, or about the middle.
    Cells {
        /// Cells kept along x and y.
        cells: [usize; 2],
        /// First cell kept; `None`: the middle of the surface is kept.
        from: Option<[usize; 2]>,
    },
    /// Lengths \[m\], rounded to whole cells; from the corner given, or about the middle.
    Lengths {
        /// Lengths kept along x and y \[m\].
        size: [f64; 2],
        /// Corner of the part kept, from that of the surface \[m\]; `None`: the middle is kept.
        corner: Option<[f64; 2]>,
    },
    /// The smallest rectangle that holds every defined point.
    Defined,
}

/// A surface and what was done to it.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The surface after all steps.
    pub surface: Surface,
    /// One sentence per step, in order.
    pub history: Vec<String>,
}

/// What the sentences of a history say about the border of the surface.
pub fn border<S: AsRef<str>>(history: &[S]) -> Border {
    Border::after(history.iter().map(AsRef::as_ref))
}

/// Does all steps in order; `domain` are the cells of the domain, if there is one.
///
/// ```
/// use asperity::{Grid, surface::{Level, Operation, Surface}};
/// use asperity_io::preparation::{Crop, Step, prepare};
///
/// let grid = Grid::new([10, 8], [10e-6, 8e-6])?;
/// let tilted = ndarray::Array2::from_shape_fn((10, 8), |(i, j)| (i + 2 * j) as f64 * 1e-9);
/// let steps = [
///     Step::Crop(Crop::Lengths { size: [4e-6, 4e-6], corner: None }),
///     Step::Operation(Operation::Level(Level::Plane)),
/// ];
/// let prepared = prepare(Surface::new(grid, tilted)?, &steps, None)?;
/// assert_eq!(prepared.surface.grid().cells(), [4, 4]);
/// assert!(prepared.surface.heights().iter().all(|z| z.abs() < 1e-20));
/// assert_eq!(prepared.history[0], "crop to 4 x 4 cells from (3, 2)");
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] of the first step that fails, with its number, or of [`check_border`].
pub fn prepare(surface: Surface, steps: &[Step], domain: Option<[usize; 2]>) -> Result<Prepared> {
    check_border(steps)?;
    let mut prepared = Prepared { surface, history: Vec::with_capacity(steps.len()) };
    for (n, step) in steps.iter().enumerate() {
        let done = step.settle(&prepared.surface, domain).and_then(|operation| {
            check_memory_of(&operation, &prepared.surface)?;
            let surface = operation.apply(&prepared.surface)?;
            let sentence = sentence(&operation, &prepared.surface, &surface);
            Ok((surface, sentence))
        });
        let (surface, sentence) = done.map_err(|error| in_step(error, n + 1, steps.len()))?;
        prepared.surface = surface;
        prepared.history.push(sentence);
    }
    Ok(prepared)
}

/// Refuses steps that window a surface and continue it by its reflections: the reflections of a flat border are a dam in the middle of
/// the domain.
///
/// # Errors
/// [`Error::Invalid`] where both are among the steps.
pub fn check_border(steps: &[Step]) -> Result<()> {
    let any =
        |of: fn(&Operation) -> bool| steps.iter().any(|step| matches!(step, Step::Operation(one) if of(one)));
    if any(|step| matches!(step, Operation::Window(_))) && any(|step| matches!(step, Operation::Mirror)) {
        return Err(Error::invalid(
            "preparation of the border",
            "a window and a mirror",
            "one of the two: what is continued by its reflections matches at its border as it is",
        ));
    }
    Ok(())
}

/// Bytes per point of a larger surface: itself, its transpose, and what comes after it (statistics, the file).
const BYTES_PER_POINT: u64 = 32;

/// Refuses an operation whose result does not fit into the memory.
fn check_memory_of(operation: &Operation, surface: &Surface) -> Result<()> {
    let (what, [nx, ny]) = match operation {
        Operation::Resample { cells, .. } => ("number of cells to resample to", *cells),
        Operation::Mirror => ("number of cells with the reflections", surface.grid().cells().map(|n| 2 * n)),
        _ => return Ok(()),
    };
    let bytes = (nx as u64).saturating_mul(ny as u64).saturating_mul(BYTES_PER_POINT);
    resources::check_memory("so many points", bytes)
        .map_err(|reason| Error::invalid(what, format!("{nx} x {ny}"), format!("less: {reason}")))
}

/// The operation and, where it changes them, the numbers of undefined points, with the heights of those that are removed.
fn sentence(operation: &Operation, before: &Surface, after: &Surface) -> String {
    match operation {
        Operation::Fill { .. } => {
            format!("{operation}: {} filled", before.undefined().saturating_sub(after.undefined()))
        }
        Operation::RemoveOutliers(_) => {
            let removed = before.heights().into_iter().zip(after.heights());
            let removed: Vec<f64> =
                removed.filter(|(z, now)| now.is_nan() && !z.is_nan()).map(|(z, _)| *z).collect();
            let low = removed.iter().copied().fold(f64::INFINITY, f64::min);
            let high = removed.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            match removed.len() {
                0 => format!("{operation}: 0 removed"),
                1 => format!("{operation}: 1 removed, its height {high:.3e} m"),
                n => format!("{operation}: {n} removed, their heights {low:.3e} m to {high:.3e} m"),
            }
        }
        _ => operation.to_string(),
    }
}

fn in_step(error: Error, number: usize, of: usize) -> Error {
    match error {
        Error::Invalid { parameter, what, value, expected } if of > 1 => {
            let what = format!("step {number} of the preparation: {what}");
            Error::Invalid { parameter, what, value, expected }
        }
        other => other,
    }
}

impl Step {
    /// The operation that this step is on this surface.
    fn settle(&self, surface: &Surface, domain: Option<[usize; 2]>) -> Result<Operation> {
        match *self {
            Step::Operation(operation) => Ok(operation),
            Step::Crop(crop) => crop.settle(surface),
            // The radius is found here, so that the history says it.
            Step::Circle { radius: None } if surface.grid().is_line() => {
                let heights: Vec<f64> = surface.heights().iter().copied().collect();
                let (_, radius) = remove_circle(&heights, surface.grid().spacing()[0], None)?;
                Ok(Operation::RemoveCircle { radius: Some(radius.abs()) })
            }
            Step::Circle { radius } => Ok(Operation::RemoveCircle { radius }),
            Step::Resample { cells, method } => match cells.or(domain) {
                Some(cells) => Ok(Operation::Resample { cells, method }),
                None => Err(Error::invalid(
                    "number of cells to resample to",
                    "not given",
                    "given: as `cells` of the step or as `domain.cells` of the case",
                )),
            },
        }
    }
}

impl Crop {
    fn settle(self, surface: &Surface) -> Result<Operation> {
        let ([nx, ny], spacing) = (surface.grid().cells(), surface.grid().spacing());
        // Along a profile only the values along x count.
        let along = |y: usize, of_line: usize| if surface.grid().is_line() { of_line } else { y };
        let middle = |cells: [usize; 2]| [nx.saturating_sub(cells[0]) / 2, ny.saturating_sub(cells[1]) / 2];
        match self {
            Crop::Cells { cells: [x, y], from } => {
                let (cells, from) = ([x, along(y, 1)], from.map(|[x, y]| [x, along(y, 0)]));
                Ok(Operation::Crop { from: from.unwrap_or_else(|| middle(cells)), cells })
            }
            Crop::Lengths { size, corner } => {
                // Saturates: what does not fit is refused by the crop itself, with its numbers.
                let count = |axis: usize, length: f64| (length / spacing[axis]).round() as usize;
                let cells = [count(0, size[0]), along(count(1, size[1]), 1)];
                let Some(corner) = corner else { return Ok(Operation::Crop { from: middle(cells), cells }) };
                if let Some(length) = corner.into_iter().find(|length| *length < 0.0) {
                    return Err(Error::invalid(
                        "corner of the part to keep",
                        format!("{length:e} m"),
                        "0 m or more, from the corner of the surface",
                    ));
                }
                Ok(Operation::Crop { from: [count(0, corner[0]), along(count(1, corner[1]), 0)], cells })
            }
            Crop::Defined => match process::defined_extent(surface) {
                Some((from, cells)) => Ok(Operation::Crop { from, cells }),
                None => Err(Error::invalid("number of defined heights", 0, "1 at least, to crop to them")),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity::Grid;
    use asperity::surface::{Fill, Level};
    use ndarray::Array2;

    fn surface() -> Surface {
        let heights = Array2::from_shape_fn((10, 6), |(i, j)| (10 * i + j) as f64);
        Surface::new(Grid::new([10, 6], [10.0, 3.0]).unwrap(), heights).unwrap()
    }

    fn crop(crop: Crop) -> Result<(f64, [usize; 2])> {
        let prepared = prepare(surface(), &[Step::Crop(crop)], None)?;
        Ok((prepared.surface.heights()[[0, 0]], prepared.surface.grid().cells()))
    }

    #[test]
    fn a_crop_is_in_cells_or_lengths_from_a_corner_or_about_the_middle() {
        let cells = [4, 2];
        assert_eq!(crop(Crop::Cells { cells, from: Some([1, 3]) }).unwrap(), (13.0, cells));
        assert_eq!(crop(Crop::Cells { cells, from: None }).unwrap(), (32.0, cells));
        let size = [4.2, 0.9]; // 4.2 and 1.8 cells
        assert_eq!(crop(Crop::Lengths { size, corner: Some([1.0, 1.5]) }).unwrap(), (13.0, cells));
        assert_eq!(crop(Crop::Lengths { size, corner: None }).unwrap(), (32.0, cells));
        assert_eq!(crop(Crop::Defined).unwrap(), (0.0, [10, 6]));
    }

    #[test]
    fn along_a_profile_the_values_along_x_count() {
        let heights = Array2::from_shape_fn((10, 1), |(i, _)| i as f64);
        let profile = Surface::new(Grid::line(10, 10.0).unwrap(), heights).unwrap();
        for crop in [
            Crop::Cells { cells: [4, 4], from: Some([2, 2]) },
            Crop::Lengths { size: [4.0, 4.0], corner: Some([2.0, 2.0]) },
        ] {
            let part = prepare(profile.clone(), &[Step::Crop(crop)], None).unwrap().surface;
            assert_eq!(part.heights().iter().copied().collect::<Vec<_>>(), [2.0, 3.0, 4.0, 5.0]);
            assert!(part.grid().is_line() && part.grid().size()[0] == 4.0);
        }
    }

    #[test]
    fn more_points_than_the_memory_holds_are_refused_before_they_are_made() {
        let step = Step::Resample { cells: Some([1 << 22, 1 << 22]), method: Resampling::Bilinear };
        let error = prepare(surface(), &[step], None).unwrap_err().to_string();
        assert!(error.contains("4194304 x 4194304") && error.contains("512.0 TiB of memory"), "{error}");
    }

    #[test]
    fn crops_that_do_not_fit_are_refused() {
        for bad in [
            Crop::Cells { cells: [11, 1], from: None },
            Crop::Cells { cells: [1, 1], from: Some([10, 0]) },
            Crop::Lengths { size: [1e300, 1.0], corner: None },
            Crop::Lengths { size: [1.0, 1.0], corner: Some([-0.6, 0.0]) },
            Crop::Lengths { size: [0.1, 1.0], corner: None },
        ] {
            assert!(crop(bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn the_record_says_what_was_done_with_its_numbers() {
        let mut heights = surface().heights().to_owned();
        heights[[3, 3]] = f64::NAN;
        let holed = Surface::new(*surface().grid(), heights).unwrap();
        let steps = [
            Step::Operation(Operation::Level(Level::Mean)),
            Step::Operation(Operation::Fill { method: Fill::Nearest, largest_share: 0.25 }),
            Step::Resample { cells: None, method: Resampling::Bilinear },
        ];
        let prepared = prepare(holed.clone(), &steps, Some([5, 3])).unwrap();
        assert_eq!(
            prepared.history,
            [
                "subtract the mean (least squares)",
                "fill undefined points (nearest, at most 25 %): 1 filled",
                "resample to 5 x 3 cells (bilinear)"
            ]
        );
        assert_eq!(prepared.surface.grid().size(), [10.0, 3.0]);
        let error = prepare(holed, &steps, None).unwrap_err().to_string();
        assert!(error.contains("step 3") && error.contains("domain.cells"), "{error}");
    }
}
