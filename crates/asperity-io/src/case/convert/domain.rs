//! The grid, and whether the machine can hold the problem.

use std::ops::Range;

use asperity::{Grid, Scheme};

use super::{Checks, axes};
use crate::case::measured::Measured;
use crate::case::memory;
use crate::case::raw::{self, At};
use crate::case::words;
use crate::resources::available_memory;

/// The grid. What the domain does not say is that of the measured surface, where there is exactly one; `files` are the
/// measured surfaces, `None` for one whose keys are wrong.
pub fn grid(
    checks: &mut Checks<'_, '_>,
    domain: &At<raw::Domain>,
    files: &[Option<&Measured>],
) -> Option<Grid> {
    let (raw, place) = (&domain.value, cells_place(domain));
    if let (Some(cells), Some(size)) = (&raw.cells, &raw.size)
        && cells.value.is_line() != size.value.is_line()
    {
        axes::wrong_number(checks, &size.span, cells.value.is_line());
        return None;
    }
    let said = said(domain);
    let cells = raw.cells.as_ref().map(|at| at.value.map(1, |count| count.count()));
    // Of a line, the length along y that its grid has.
    let size = raw.size.as_ref().map(|at| at.value.map(1.0, |length| length.get()));
    // A count that no machine can hold is refused by `memory`, with its numbers.
    if cells.is_some_and(|cells| memory::estimate(cells, 0) > present()) {
        return None;
    }
    if let (Some(cells), Some(size)) = (cells, size) {
        return checks.core(place, grid_of(cells, size, said == Some(true)));
    }
    let missing: Vec<&str> =
        [("cells", cells.is_none()), ("size", size.is_none())].iter().filter(|k| k.1).map(|k| k.0).collect();
    match files {
        [] => {
            for key in missing {
                checks.push(|text| words::missing_key(text, &domain.span, key));
            }
            None
        }
        [one] => {
            let file = (*one)?;
            match file.prepared(cells) {
                Ok(prepared) => {
                    let of_file = prepared.surface.grid();
                    if said.is_some_and(|line| line != of_file.is_line()) {
                        axes::wrong_number(checks, given_place(domain), of_file.is_line());
                        return None;
                    }
                    let (cells, size) = (cells.unwrap_or(of_file.cells()), size.unwrap_or(of_file.size()));
                    checks.core(place, grid_of(cells, size, of_file.is_line()))
                }
                Err(reason) => {
                    checks.fault(&file.span, reason, "", None);
                    None
                }
            }
        }
        many => {
            for key in missing {
                checks.push(|text| {
                    let mut error = words::missing_key(text, &domain.span, key);
                    error.message = format!(
                        "{}: there are {} measured surfaces, so it cannot be taken from one of them; give it",
                        error.message,
                        many.len()
                    );
                    error
                });
            }
            None
        }
    }
}

/// Whether the domain says that it is a line: one value in `cells` or `size`; `None` where it gives neither.
pub fn said(domain: &At<raw::Domain>) -> Option<bool> {
    let of_cells = domain.value.cells.as_ref().map(|at| at.value.is_line());
    of_cells.or(domain.value.size.as_ref().map(|at| at.value.is_line()))
}

fn grid_of(cells: [usize; 2], size: [f64; 2], line: bool) -> asperity::Result<Grid> {
    if line { Grid::line(cells[0], size[0]) } else { Grid::new(cells, size) }
}

/// Where the domain gives its cells or its size.
fn given_place(domain: &At<raw::Domain>) -> &Range<usize> {
    domain.value.size.as_ref().map_or_else(|| cells_place(domain), |at| &at.span)
}

/// Memory that the run may take.
fn present() -> u128 {
    available_memory().into()
}

/// Where the number of cells stands, or the domain that leaves it out.
fn cells_place(domain: &At<raw::Domain>) -> &Range<usize> {
    domain.value.cells.as_ref().map_or(&domain.span, |at| &at.span)
}

/// Refuses a problem that takes more memory than the machine has; its bodies remember `fields` fields.
pub fn memory(
    checks: &mut Checks<'_, '_>,
    domain: &At<raw::Domain>,
    grid: Option<&Grid>,
    fields: usize,
    extra: usize,
    scheme: Scheme,
) {
    let written = domain.value.cells.as_ref().map(|at| at.value.map(1, |count| count.count()));
    let Some(cells) = written.or(grid.map(Grid::cells)) else { return };
    let (needed, present) = (memory::estimate(cells, fields.saturating_add(extra)), present());
    if needed <= present {
        return;
    }
    let [nx, ny] = cells;
    let detail = match (scheme, fields) {
        (Scheme::Direct, _) => format!(" with the {fields} pressure fields that the direct scheme keeps"),
        (_, 0) => String::new(),
        _ => format!(" with {fields} retarded terms"),
    };
    let count = if said(domain) == Some(true) { nx.to_string() } else { format!("{nx} x {ny}") };
    let message = format!(
        "{count} cells{detail} need about {}, but this machine has {} available",
        memory::words(needed),
        memory::words(present)
    );
    let help = match scheme {
        Scheme::Direct => "take fewer cells or steps, or scheme = \"linear\"",
        _ => "take fewer cells",
    };
    checks.fault(cells_place(domain), message, "a problem that fits into memory", Some(help));
}
