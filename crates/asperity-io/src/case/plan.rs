//! What is stored of a run, and the parts of the gap as a case names them.

use std::collections::BTreeSet;
use std::path::PathBuf;

use asperity::sliding::{Direction, MovingGap, Path, ShearStress};

use asperity::surface::Part;

use super::measured::Measured;
use crate::answer::Units;
use crate::store::FieldKind;

/// One part of the undeformed gap.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// A shape or synthetic roughness.
    Part(Part),
    /// A topography file, read when the gap is built.
    File(Measured),
    /// Heights of a program, and what was done to them.
    Given(Part, Vec<String>),
}

impl Surface {
    /// What messages call it.
    pub fn name(&self) -> String {
        match self {
            Surface::File(file) => file.path.display().to_string(),
            Surface::Part(part) | Surface::Given(part, _) => part.name().to_owned(),
        }
    }

    /// What was done to measured heights, one sentence per step; `None` for a shape, and for a file that was not read yet.
    pub fn history(&self) -> Option<Vec<String>> {
        match self {
            Surface::Part(_) => None,
            Surface::File(file) => file.history(),
            Surface::Given(_, history) => Some(history.clone()).filter(|history| !history.is_empty()),
        }
    }
}

/// How the contact moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// How far, or how fast.
    pub travel: Travel,
    /// Which way.
    pub direction: Direction,
    /// Whether each of the surfaces moves.
    pub moves: Vec<bool>,
    /// Whether it rolls over both bodies.
    pub rolls: bool,
    /// Cells that it moves in a step, at most.
    pub cells_per_step: f64,
    /// A shear stress on the area in contact.
    pub shear_stress: Option<ShearStress>,
}

impl Motion {
    /// The motion in time of this gap; `None` for steady states.
    pub(super) fn in_time(&self, gap: MovingGap) -> Option<asperity::process::Motion> {
        let Travel::Path(path) = &self.travel else { return None };
        Some(asperity::process::Motion {
            path: path.clone(),
            direction: self.direction,
            gap,
            cells_per_step: self.cells_per_step,
            shear_stress: self.shear_stress.clone(),
        })
    }
}

/// A motion in time, or steady states.
#[derive(Clone, Debug, PartialEq)]
pub enum Travel {
    /// In time.
    Path(Path),
    /// At these velocities \[m/s\], rising.
    Steady(Vec<f64>),
}

/// What is stored, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Directory of the result.
    pub path: PathBuf,
    /// The fields that are stored.
    pub fields: BTreeSet<FieldKind>,
    /// The rows whose fields are stored.
    pub rows: Rows,
    /// Whether every quantity that the case allows is wanted.
    pub all_quantities: bool,
    /// Whether the run leaves what it needs to be resumed.
    pub checkpoint: bool,
    /// Units in which answers are printed.
    pub units: Units,
}

/// The rows of a run whose fields are stored; the first and the last always are.
#[derive(Clone, Debug, PartialEq)]
pub enum Rows {
    /// Every n-th row, counted from the first.
    Every(usize),
    /// The rows at these times \[s\].
    At(Vec<f64>),
}

/// Times that differ by less than this share are equal: "0.1 s" times 3 is not quite "0.3 s".
const SAME: f64 = 1e-9;

impl Rows {
    /// Whether the fields of `row` (from 0, at `time` \[s\]) are stored; `last` where the run ends with it.
    ///
    /// ```
    /// use asperity_io::case::Rows;
    /// let stored: Vec<usize> = (0..=25).filter(|row| Rows::Every(10).holds(*row, *row == 25, 0.0)).collect();
    /// assert_eq!(stored, [0, 10, 20, 25]);
    /// assert!(Rows::At(vec![0.3]).holds(3, false, 0.1 * 3.0));
    /// ```
    pub fn holds(&self, row: usize, last: bool, time: f64) -> bool {
        let chosen = match self {
            Rows::Every(n) => row.is_multiple_of((*n).max(1)),
            Rows::At(times) => {
                let margin = SAME * time.abs();
                let after = times.partition_point(|t| *t < time - margin);
                times.get(after).is_some_and(|t| *t <= time + margin)
            }
        };
        chosen || row == 0 || last
    }
}
