//! The grid, and whether the machine can hold the problem.

use asperity::{Boundary, Grid, Scheme};

use super::Checks;
use crate::case::memory;
use crate::case::raw;

pub fn grid(checks: &mut Checks<'_, '_>, domain: &raw::Domain) -> Option<Grid> {
    let cells = domain.cells.value.map(|count| count.count());
    let size = domain.size.map(|length| length.get());
    // A count that no machine can hold is refused by `memory`, with its numbers.
    if memory::estimate(cells, 0) > memory::physical() {
        return None;
    }
    checks.core(&domain.cells.span, Grid::new(cells, size))
}

pub fn boundary(boundary: raw::Boundary) -> Boundary {
    match boundary {
        raw::Boundary::Free => Boundary::Free,
        raw::Boundary::Periodic => Boundary::Periodic,
    }
}

/// Bytes that the problem takes, whose bodies remember `fields` fields; more than the machine has are refused.
pub fn memory(checks: &mut Checks<'_, '_>, domain: &raw::Domain, fields: usize, scheme: Scheme) -> u128 {
    let cells = domain.cells.value.map(|count| count.count());
    let (needed, present) = (memory::estimate(cells, fields), memory::physical());
    if needed <= present {
        return needed;
    }
    let [nx, ny] = cells;
    let detail = match (scheme, fields) {
        (Scheme::Direct, _) => format!(" with the {fields} pressure fields that the direct scheme keeps"),
        (_, 0) => String::new(),
        _ => format!(" with {fields} retarded terms"),
    };
    let message = format!(
        "{nx} x {ny} cells{detail} need about {}, but this machine has {}",
        memory::words(needed),
        memory::words(present)
    );
    let help = match scheme {
        Scheme::Direct => "take fewer cells or steps, or scheme = \"linear\"",
        _ => "take fewer cells",
    };
    checks.fault(&domain.cells.span, message, "a problem that fits into memory", Some(help));
    needed
}
