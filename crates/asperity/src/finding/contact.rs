//! Contacts and contact spots of a few cells.
//!
//! The width of the spots is 4 A/P, four times the contact area over its perimeter, counted in cells and edges: d for a spot of d
//! by d cells. A row contains both, because its corrected area is A minus a fraction of the perimeter. For a line contact it is
//! twice the length in contact over the number of ends.

use ndarray::ArrayView2;

use super::words::{digits, rows};
use super::worst::extend;
use super::{FEW_CONTACT_CELLS, Finding, NO_CONTACT, SPOTS_UNRESOLVED};
use crate::grid::{Boundary, Grid};
use crate::quantities::contact_edges;
use crate::step::{PERIMETER_SHARE, Row};

/// Smallest number of cells across a spot: below this, the pressure inside the spot is not resolved.
const ACROSS: f64 = 4.0;
/// Smallest number of cells of a contact: the area of 50 cells is accurate to about a tenth, like the length of 16 cells on a
/// line.
const FEWEST: f64 = 50.0;
const FEWEST_ON_LINE: f64 = 16.0;

/// A contact in cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Counted {
    /// Cells in contact.
    pub cells: f64,
    /// Edges between a cell in contact and one that is not; for a line contact, the ends of the spots.
    pub edges: f64,
    /// Whether it is a line contact.
    pub line: bool,
}

impl Counted {
    /// The contact of a row. A row of a line contact does not contain the number of ends of its spots.
    pub(super) fn of(grid: &Grid, row: &Row) -> Self {
        let cell = grid.cell_area();
        let edges = (row.contact_area - row.contact_area_corrected) / (PERIMETER_SHARE * cell);
        Counted { cells: (row.contact_area / cell).round(), edges: edges.round(), line: grid.is_line() }
    }

    pub(super) fn on_line(pressure: ArrayView2<'_, f64>) -> Self {
        let cells = pressure.iter().filter(|p| **p > 0.0).count() as f64;
        Counted { cells, edges: contact_edges(pressure, Boundary::Free).along_x as f64, line: true }
    }

    /// Mean width of the spots in cells; infinite if the contact has no edge.
    pub(super) fn width(self) -> f64 {
        if self.line { 2.0 * self.cells / self.edges } else { 4.0 * self.cells / self.edges }
    }

    /// Whether it is approximately one spot without holes: a circle of cells has edges² = 64/pi cells.
    pub(super) fn is_compact(self) -> bool {
        let round = self.edges * self.edges < 30.0 * self.cells;
        self.cells > 0.0 && if self.line { self.edges <= 2.0 } else { round }
    }

    fn fewest(self) -> f64 {
        if self.line { FEWEST_ON_LINE } else { FEWEST }
    }
}

/// The largest contact of a run, and the rows whose contact the grid does not resolve.
#[derive(Clone, Debug, Default)]
pub(super) struct Resolution {
    largest: Counted,
    narrow: Option<[usize; 2]>,
    few: Option<[usize; 2]>,
}

impl Resolution {
    pub(super) fn see(&mut self, index: usize, contact: Counted) {
        if contact.cells == 0.0 {
            return;
        }
        if contact.cells > self.largest.cells {
            self.largest = contact;
        }
        if contact.width() < ACROSS {
            extend(&mut self.narrow, index);
        }
        if contact.cells < contact.fewest() {
            extend(&mut self.few, index);
        }
    }

    /// Adds what an earlier session found of a line contact: rows with narrow spots, and the width where the contact was largest.
    pub(super) fn resume_line(&mut self, narrow: [usize; 2], width: f64) {
        self.narrow = Some(narrow);
        self.largest.edges = (2.0 * self.largest.cells / width).round();
    }

    /// Every contact begins with one cell, so the largest contact is checked.
    pub(super) fn findings(&self) -> Vec<Finding> {
        let Counted { cells, .. } = self.largest;
        let (width, fewest) = (self.largest.width(), self.largest.fewest());
        let mut found = vec![];
        if let Some(at) = self.few.filter(|_| cells < fewest) {
            found.push(few(cells, fewest, "has").at(at));
        }
        if let Some(at) = self.narrow.filter(|_| width < ACROSS) {
            found.push(narrow(width, &format!("The contact spots ({})", rows(at))).at(at));
        }
        found
    }
}

/// A run without contact.
pub(super) fn never() -> Finding {
    let text = "The bodies never touch. An approach is positive towards the body and 0 at first touch: check its sign, its size and its unit."
        .to_owned();
    Finding::warning(NO_CONTACT, 0.0, 0.0, text)
}

/// A contact of this number of cells.
fn few(cells: f64, fewest: f64, has: &str) -> Finding {
    let text = format!(
        "The largest contact {has} {} cells, less than {fewest}: area, pressure and approach are coarse. Refine the grid \
         (domain.cells), or take a smaller domain (domain.size).",
        digits(cells.round())
    );
    Finding::warning(FEW_CONTACT_CELLS, cells, fewest, text)
}

/// Spots of this width in cells; `spots` begins the sentence.
pub(super) fn narrow(width: f64, spots: &str) -> Finding {
    let text = format!(
        "{spots} are {} cells across in the mean where the contact is largest, less than {ACROSS}: largest pressure and \
         contact area depend on the grid. Refine it (domain.cells), or leave short waves out.",
        digits(width)
    );
    Finding::warning(SPOTS_UNRESOLVED, width, ACROSS, text)
}

/// The findings for a round contact of this diameter in cells, or a line contact of this length.
pub(super) fn expected(across: f64, line: bool) -> Vec<Finding> {
    let cells = if line { across } else { std::f64::consts::FRAC_PI_4 * across * across };
    let fewest = Counted { line, ..Counted::default() }.fewest();
    let mut found = vec![];
    if cells < fewest {
        found.push(few(cells, fewest, "is expected to have"));
    }
    if across < ACROSS {
        found.push(narrow(across, "Contact spots"));
    }
    found
}
