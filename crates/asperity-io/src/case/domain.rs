//! `[domain]`: the grid, and whether the machine can hold the problem.

use asperity::{Boundary, Grid};

use super::keys::*;
use super::list::wrong_number;
use super::measured::Measured;
use crate::Code;
use crate::resources::check_memory;

/// Bytes per cell of the smallest run, an elastic contact on a periodic domain: what a case needs is added up once it is read.
const BYTES_PER_CELL: u64 = 56;

/// A rectangle of equal cells; or a line of cells, with one value in `cells` and `size`: a line contact in plane strain, in which
/// nothing changes along y.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Number of cells along x and y; any numbers, also not square and not powers of two. One number for a line contact.
    /// Those of the measured surface if not given; needed without a measured surface.
    #[schemars(example = (1024, 1024), example = (1024,))]
    cells: Option<Axes<Whole<1>>>,
    /// Length of the domain along x and y; one length for a line contact. That of the measured surface if not given; needed
    /// without a measured surface.
    #[schemars(example = ("0.1 mm", "0.1 mm"), example = ("2 mm",))]
    size: Option<Axes<Length<Positive>>>,
    /// Boundary condition of the domain; "free" if not given.
    #[serde(default)]
    pub boundary: Boundary,
}

impl Domain {
    /// The grid. What the domain leaves out is taken from the measured surface, if there is exactly one; `files` are the
    /// measured surfaces, `None` for one whose keys are wrong.
    pub fn grid(&self, at: &Place<'_>, files: &[Option<&Measured>]) -> Option<Grid> {
        if let (Some(cells), Some(size)) = (&self.cells, &self.size)
            && cells.is_line() != size.is_line()
        {
            return wrong_number(&at.key("size"), cells.is_line());
        }
        let (cells, line) = (self.cells(), self.is_line());
        // Of a line, the length along y that its grid has.
        let size = self.size.map(|size| size.map(1.0, Length::get));
        // Before anything of that size is made.
        if let Some(cells) = cells {
            let bytes = cells.iter().fold(BYTES_PER_CELL, |bytes, n| bytes.saturating_mul(*n as u64));
            self.fits(at, cells, bytes, "")?;
        }
        let (cells, size, line) = match (cells, size, files) {
            (Some(cells), Some(size), _) => (cells, size, line == Some(true)),
            (_, _, [one]) => {
                let file = (*one)?;
                let prepared = at.sibling(&file.key).data(file.prepared(cells), "a surface with heights")?;
                let of_file = prepared.surface.grid();
                if line.is_some_and(|line| line != of_file.is_line()) {
                    let given = if self.size.is_some() { "size" } else { "cells" };
                    return wrong_number(&at.key(given), of_file.is_line());
                }
                (cells.unwrap_or(of_file.cells()), size.unwrap_or(of_file.size()), of_file.is_line())
            }
            (cells, size, files) => {
                let why = match files.len() {
                    0 => String::new(),
                    many => format!(
                        ": there are {many} measured surfaces, so it cannot be taken from one of them; give it"
                    ),
                };
                for (key, missing) in [("cells", cells.is_none()), ("size", size.is_none())] {
                    if missing {
                        at.missing::<()>(key, &why);
                    }
                }
                return None;
            }
        };
        let grid = if line { Grid::line(cells[0], size[0]) } else { Grid::new(cells, size) };
        self.place_of_cells(at).core(grid)
    }

    /// Whether the domain says that it is a line: one value in `cells` or `size`; `None` where it gives neither.
    pub fn is_line(&self) -> Option<bool> {
        self.cells.map(|cells| cells.is_line()).or(self.size.map(|size| size.is_line()))
    }

    fn cells(&self) -> Option<[usize; 2]> {
        self.cells.map(|cells| cells.map(1, Whole::count))
    }

    /// Where the number of cells stands, or the domain that leaves it out.
    fn place_of_cells<'c>(&self, at: &Place<'c>) -> Place<'c> {
        if self.cells.is_some() { at.key("cells") } else { at.clone() }
    }

    /// Refuses a problem on these cells that takes more memory than the machine has.
    pub fn fits(&self, at: &Place<'_>, [nx, ny]: [usize; 2], bytes: u64, or: &str) -> Option<()> {
        let count = if self.is_line() == Some(true) { nx.to_string() } else { format!("{nx} x {ny}") };
        let Err(message) = check_memory(&format!("{count} cells"), bytes) else { return Some(()) };
        let (at, help) = (self.place_of_cells(at), format!("take fewer cells{or}"));
        at.refuse(Code::TooLarge, message, "a problem that fits into memory", &help)
    }
}
