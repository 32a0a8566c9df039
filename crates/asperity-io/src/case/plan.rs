//! What is stored of a run, and the parts of the gap as a case names them.

use std::collections::BTreeSet;
use std::path::PathBuf;

use asperity::surface::Part;

use super::measured::Measured;
pub use super::raw::Field;
use asperity::quantities::Quantities;

/// One part of the undeformed gap.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// A shape or synthetic roughness.
    Part(Part),
    /// A topography file, read when the gap is built.
    File(Measured),
}

/// What is stored, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Directory of the result.
    pub path: PathBuf,
    /// The fields that are stored.
    pub fields: BTreeSet<Field>,
    /// The rows whose fields are stored.
    pub rows: Rows,
    /// The quantities of each row; with `all_quantities` those that the case allows are added.
    pub quantities: Quantities,
    /// Whether every quantity that the case allows is wanted.
    pub all_quantities: bool,
    /// Whether the run leaves what it needs to be resumed.
    pub checkpoint: bool,
}

/// The rows of a run whose fields are stored; the first and the last always are.
#[derive(Clone, Debug, PartialEq)]
pub enum Rows {
    /// Every n-th row, counted from the first.
    Every(usize),
    /// The rows at these times \[s\].
    At(Vec<f64>),
}

/// Times that agree to this share are the same: "0.1 s" times 3 is not quite "0.3 s".
const SAME: f64 = 1e-9;

impl Rows {
    /// Whether the fields of `row` (from 0, at `time` \[s\]) are stored, in a run whose last row is `last`.
    ///
    /// ```
    /// use asperity_io::case::Rows;
    /// let stored: Vec<usize> = (0..=25).filter(|row| Rows::Every(10).holds(*row, 25, 0.0)).collect();
    /// assert_eq!(stored, [0, 10, 20, 25]);
    /// assert!(Rows::At(vec![0.3]).holds(3, 25, 0.1 * 3.0));
    /// ```
    pub fn holds(&self, row: usize, last: usize, time: f64) -> bool {
        let chosen = match self {
            Rows::Every(n) => row.is_multiple_of((*n).max(1)),
            Rows::At(times) => {
                let margin = SAME * time.abs();
                let after = times.partition_point(|t| *t < time - margin);
                times.get(after).is_some_and(|t| *t <= time + margin)
            }
        };
        chosen || row == 0 || row == last
    }
}

impl Field {
    /// Name in case files and results.
    pub fn name(self) -> &'static str {
        match self {
            Field::Pressure => "pressure",
            Field::Gap => "gap",
            Field::Displacement => "displacement",
            Field::Contact => "contact",
            Field::Flattening => "flattening",
        }
    }

    /// Bytes per cell.
    pub(super) fn bytes(self) -> u64 {
        if self == Field::Contact { 1 } else { 8 }
    }
}
