//! The grid, and whether the machine can hold the problem.

use std::ops::Range;

use asperity::{Grid, Scheme};

use super::Checks;
use crate::case::measured::Measured;
use crate::case::memory;
use crate::case::raw::{self, At};
use crate::case::words;
use crate::resources::available_memory;

/// The grid and the place of its number of cells. What the domain does not say is that of the measured surface,
/// where there is exactly one; `files` are the measured surfaces, `None` for one whose keys are wrong.
pub fn grid(
    checks: &mut Checks<'_, '_>,
    domain: &At<raw::Domain>,
    files: &[Option<&Measured>],
) -> Option<Grid> {
    let cells = domain.value.cells.as_ref().map(|at| at.value.map(|count| count.count()));
    let size = domain.value.size.as_ref().map(|at| at.value.map(|length| length.get()));
    let place = cells_place(domain);
    // A count that no machine can hold is refused by `memory`, with its numbers.
    if cells.is_some_and(|cells| memory::estimate(cells, 0) > present()) {
        return None;
    }
    if let (Some(cells), Some(size)) = (cells, size) {
        return checks.core(place, Grid::new(cells, size));
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
                    let (cells, size) = (cells.unwrap_or(of_file.cells()), size.unwrap_or(of_file.size()));
                    checks.core(place, Grid::new(cells, size))
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
    let written = domain.value.cells.as_ref().map(|at| at.value.map(|count| count.count()));
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
    let message = format!(
        "{nx} x {ny} cells{detail} need about {}, but this machine has {} available",
        memory::words(needed),
        memory::words(present)
    );
    let help = match scheme {
        Scheme::Direct => "take fewer cells or steps, or scheme = \"linear\"",
        _ => "take fewer cells",
    };
    checks.fault(cells_place(domain), message, "a problem that fits into memory", Some(help));
}
