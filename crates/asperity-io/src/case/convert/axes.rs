//! Lists with a value for each direction: two on a plane, one on a line of cells.

use std::ops::Range;

use super::Checks;
use crate::case::raw::{At, Axes};

/// The values along x and y; `along_y` stands for the second of a line. A list of another length is a fault.
pub fn values<A: Copy, T>(
    checks: &mut Checks<'_, '_>,
    at: &At<Axes<A>>,
    line: bool,
    along_y: T,
    convert: impl Fn(A) -> T,
) -> Option<[T; 2]> {
    if at.value.is_line() == line {
        return Some(at.value.map(along_y, convert));
    }
    wrong_number(checks, &at.span, line);
    None
}

/// A list has one value where two are expected, or two where one is.
pub fn wrong_number(checks: &mut Checks<'_, '_>, span: &Range<usize>, line: bool) {
    match line {
        true => checks.wrong(
            span,
            "a list of one value, because the domain is a line of cells",
            Some("give the value along x; a plane has two values in domain.cells and domain.size"),
        ),
        false => checks.wrong(
            span,
            "a list of two values, along x and y",
            Some("one value is for a line contact, which has one value in domain.cells and domain.size too"),
        ),
    }
}
