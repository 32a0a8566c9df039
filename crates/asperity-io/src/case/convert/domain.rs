//! The grid, and whether the machine can hold the problem.

use asperity::{Boundary, Grid};

use super::Checks;
use crate::case::march::Scheme;
use crate::case::memory;
use crate::case::raw;

pub fn grid(checks: &mut Checks<'_, '_>, domain: &raw::Domain) -> Option<Grid> {
    let cells = domain.cells.value.map(|count| count.count());
    let size = domain.size.map(|length| length.get());
    // A count that no machine can hold is refused by `memory`, with its numbers.
    if memory::estimate(cells, 0, 0) > memory::physical() {
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

/// Bytes that the problem takes; more than the machine has are refused.
pub fn memory(
    checks: &mut Checks<'_, '_>,
    domain: &raw::Domain,
    branches: usize,
    rows: usize,
    scheme: Scheme,
) -> u128 {
    let cells = domain.cells.value.map(|count| count.count());
    let kept = if scheme == Scheme::Direct { rows } else { 0 };
    let (needed, present) = (memory::estimate(cells, branches, kept), memory::physical());
    if needed <= present {
        return needed;
    }
    let [nx, ny] = cells;
    let detail = match (kept, branches) {
        (0, 0) => String::new(),
        (0, _) => format!(" with {branches} retarded terms"),
        _ => format!(" with {kept} pressure fields kept by the direct scheme"),
    };
    let message = format!(
        "{nx} x {ny} cells{detail} need about {}, but this machine has {}",
        memory::words(needed),
        memory::words(present)
    );
    checks.fault(&domain.cells.span, message, "a problem that fits into memory", Some("take fewer cells"));
    needed
}
