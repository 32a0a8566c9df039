//! Checks of the rows of a run, and the worst value of a quantity over them.

use super::Finding;
use super::words::rows;
use crate::simulation::Simulation;
use crate::step::{Row, Step};

/// A check of each row.
pub(super) trait Watch {
    /// Takes in a row.
    fn see(&mut self, step: &Step<'_>, row: &Row);

    /// What is wrong with the rows so far.
    fn findings(&self, simulation: &Simulation) -> Vec<Finding>;

    /// The last row of an earlier session of the run, where the next one is compared with it.
    fn recall(&mut self, _last: &Row) {}

    /// Takes over a finding of an earlier session of the run, if it comes from this check.
    fn resume(&mut self, finding: &Finding);
}

/// Adds a row to the range of rows concerned.
pub(super) fn extend(range: &mut Option<[usize; 2]>, row: usize) {
    *range = Some(range.map_or([row; 2], |[first, _]| [first, row]));
}

/// The worst of the values beyond their limits, and the range of rows that have such values.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Worst {
    pub value: f64,
    pub limit: f64,
    /// Factor by which the value exceeds the limit, or falls below it; 0 if no value is beyond its limit.
    pub excess: f64,
    /// `None` if the values belong to no run.
    pub rows: Option<[usize; 2]>,
}

impl Worst {
    /// Adds the value of a row if it is above the limit, and returns whether it is.
    pub(super) fn above(&mut self, row: impl Into<Option<usize>>, value: f64, limit: f64) -> bool {
        value > limit && self.add(row.into(), value, limit, value / limit)
    }

    /// Adds the value of a row if it is below the limit, and returns whether it is.
    pub(super) fn below(&mut self, row: impl Into<Option<usize>>, value: f64, limit: f64) -> bool {
        value < limit && self.add(row.into(), value, limit, limit / value)
    }

    fn add(&mut self, row: Option<usize>, value: f64, limit: f64, excess: f64) -> bool {
        if let Some(row) = row {
            extend(&mut self.rows, row);
        }
        if excess > self.excess {
            *self = Worst { value, limit, excess, rows: self.rows };
        }
        true
    }

    /// Takes over the finding of this code of an earlier session, and returns whether it is one.
    pub(super) fn resume(&mut self, code: &str, finding: &Finding) -> bool {
        let (value, limit) = (finding.value.unwrap_or(0.0), finding.limit.unwrap_or(1.0));
        let is_own = finding.code == code;
        if is_own {
            *self = Worst { value, limit, excess: value / limit, rows: finding.rows };
        }
        is_own
    }

    /// "rows 2 to 4"; nothing if the values belong to no run.
    pub(super) fn which_rows(&self) -> String {
        self.rows.map_or(String::new(), rows)
    }

    /// " (rows 2 to 4)"; nothing if the values belong to no run.
    pub(super) fn place(&self) -> String {
        self.rows.map_or(String::new(), |at| format!(" ({})", rows(at)))
    }

    /// The warning about the worst value, if there is one.
    pub(super) fn warning(&self, code: &'static str, text: impl FnOnce(&Self) -> String) -> Option<Finding> {
        (self.excess > 0.0).then(|| Finding::warning(code, self.value, self.limit, text(self)).at(self.rows))
    }
}
