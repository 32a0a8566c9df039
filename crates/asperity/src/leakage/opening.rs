//! The open part of a gap, through which the fluid can flow.
//!
//! A cell is closed if the bodies touch there, or if the gap is not above the smallest gap that lets molecules pass (0 by
//! default). Contact is taken from the contact field, not from a gap of 0, because the gap has an error of the tolerance of the
//! solver. If the contact is not known, only the gap is used, and gaps up to its error are closed: no gap is negative, so the deepest
//! negative one tells the error; where negative gaps are deeper than an error is, they are meant (surfaces that overlap). The rounding of
//! the largest gap is an error in any case.

use ndarray::{Array2, ArrayView2};

use crate::error::{Error, Result, non_negative, require};
use crate::grid::Grid;

/// Rounding of a gap, relative to the largest one: it is the difference of a few numbers of that size.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Deeper negative gaps, relative to the largest gap, are no error.
const DEEPEST_ERROR: f64 = 1e-4;

/// The error of a gap that the gap itself tells \[m\].
fn error_of(gap: ArrayView2<'_, f64>, knows_contact: bool) -> f64 {
    let finite = gap.iter().copied().filter(|h| h.is_finite());
    let [least, most] = finite.fold([0.0_f64; 2], |[least, most], h| [least.min(h), most.max(h)]);
    let rounding = ROUNDING * most.max(-least);
    if knows_contact || -least > DEEPEST_ERROR * most { rounding } else { rounding.max(-least) }
}

/// The direction of the flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Direction {
    /// Along x.
    #[default]
    X,
    /// Along y.
    Y,
}

/// The boundary condition at the sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Sides {
    /// The gap is periodic across the flow.
    #[default]
    Periodic,
    /// No flow through the sides.
    Closed,
}

/// The open cells of a gap, turned so that the flow runs along axis 0.
#[derive(Clone, Debug)]
pub struct Opening {
    /// Cells along and across the flow.
    pub(super) cells: [usize; 2],
    /// Their lengths \[m\].
    pub(super) spacing: [f64; 2],
    /// Gap \[m\], 0 if closed; C-order, the flow along axis 0.
    pub(super) gap: Vec<f64>,
    pub(super) sides: Sides,
    pub(super) direction: Direction,
    pub(super) error: f64,
    pub(super) closed: usize,
}

impl Opening {
    /// The open cells of `gap` \[m\], shape (nx, ny): those where `contact` is 0 (everywhere without it) and the gap is above
    /// `smallest_gap` \[m\] and above its error.
    ///
    /// # Errors
    /// [`Error::Invalid`] for shapes that are not those of the grid, a gap of an open cell that is not a finite number, a
    /// negative smallest gap.
    pub fn new(
        grid: &Grid,
        gap: ArrayView2<'_, f64>,
        contact: Option<ArrayView2<'_, u8>>,
        direction: Direction,
        sides: Sides,
        smallest_gap: f64,
    ) -> Result<Opening> {
        let shape = |what: &str, (nx, ny): (usize, usize)| {
            let [mx, my] = grid.cells();
            let expected = format!("that of the grid, {mx} x {my}");
            require([nx, ny] == [mx, my], what, format!("{nx} x {ny}"), expected)
        };
        shape("shape of the gap", gap.dim())?;
        if let Some(contact) = &contact {
            shape("shape of the contact", contact.dim())?;
        }
        let smallest = non_negative("smallest gap that lets the fluid pass", smallest_gap, "m")?;
        let error = error_of(gap, contact.is_some());
        let touches = |at: (usize, usize)| contact.as_ref().is_some_and(|contact| contact[at] != 0);
        let ([nx, ny], [dx, dy]) = (grid.cells(), grid.spacing());
        let (cells, spacing) = match direction {
            Direction::X => ([nx, ny], [dx, dy]),
            Direction::Y => ([ny, nx], [dy, dx]),
        };
        let (mut open, mut closed) = (Vec::with_capacity(grid.len()), 0);
        for i in 0..cells[0] {
            for j in 0..cells[1] {
                let at = if direction == Direction::X { (i, j) } else { (j, i) };
                let h = gap[at];
                let is_rounded = !touches(at) && h > smallest && h <= error;
                closed += usize::from(is_rounded);
                open.push(if touches(at) || h <= smallest || is_rounded {
                    0.0
                } else if h.is_finite() {
                    h
                } else {
                    let what = format!("gap of cell ({}, {})", at.0, at.1);
                    let expected =
                        "finite: the flow where surfaces cannot touch (a gap without end) has no resistance";
                    let expected =
                        if h.is_nan() { "a number; fill holes of the map first" } else { expected };
                    return Err(Error::invalid(what, h, expected));
                });
            }
        }
        Ok(Opening { cells, spacing, gap: open, sides, direction, error, closed })
    }

    /// The error of the gap that the gap itself tells \[m\], and the number of cells that are closed because of it.
    pub fn closed(&self) -> (f64, usize) {
        (self.error, self.closed)
    }

    /// Length along the flow and width across it \[m\].
    pub fn size(&self) -> [f64; 2] {
        [self.cells[0] as f64 * self.spacing[0], self.cells[1] as f64 * self.spacing[1]]
    }

    /// The largest gap \[m\]; 0 if every cell is closed.
    pub fn largest(&self) -> f64 {
        self.gap.iter().fold(0.0, |most: f64, h| most.max(*h))
    }

    /// Fraction of the cells that are open.
    pub fn open_fraction(&self) -> f64 {
        self.gap.iter().filter(|h| **h > 0.0).count() as f64 / self.gap.len() as f64
    }

    /// Direction of the flow.
    pub fn direction(&self) -> Direction {
        self.direction
    }

    /// Cell (i, j) of the grid for the number of a cell.
    pub(super) fn cell(&self, number: usize) -> [usize; 2] {
        let (along, across) = (number / self.cells[1], number % self.cells[1]);
        if self.direction == Direction::X { [along, across] } else { [across, along] }
    }

    /// A field turned back to shape (nx, ny).
    pub(super) fn turned_back<T: Clone>(&self, field: &[T]) -> Array2<T> {
        let [n, m] = self.cells;
        match self.direction {
            Direction::X => Array2::from_shape_fn((n, m), |(i, j)| field[i * m + j].clone()),
            Direction::Y => Array2::from_shape_fn((m, n), |(i, j)| field[j * m + i].clone()),
        }
    }
}
