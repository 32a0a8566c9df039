//! Pockets: parts of the gap that neither reservoir reaches.
//!
//! | rule | pressure of a pocket |
//! |---|---|
//! | kept | what it had when it was cut off, the mean over its cells; the reference where it was never filled |
//! | drained | the reference |
//! | connected | that of a flow through contacts with the smallest gap: pockets fill and drain in the long run |
//!
//! What a pocket had is what its cells had in the last row.

use super::beside::{Beside, Other};
use crate::error::{Error, Result};
use crate::spots::Forest;

/// Of cells without fluid: numbers that are compared when a run is resumed.
const NONE: f64 = -1.0;

/// The pressure of pockets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Pockets {
    /// They keep the pressure that they had when they were cut off, as an enclosed gas does that is compressed little.
    #[default]
    Kept,
    /// They lose it.
    Drained,
    /// Fluid creeps into them through the contact: slow, steady states.
    Connected,
}

impl Pockets {
    pub(super) fn validate(self, smallest_gap: f64) -> Result<()> {
        if self == Pockets::Connected && smallest_gap == 0.0 {
            let expected =
                "greater than 0: the gap that contacts leave to the fluid, a few molecules, say 1 nm";
            return Err(
                Error::invalid("smallest gap of connected pockets", "0 m", expected).of("smallest_gap")
            );
        }
        Ok(())
    }
}

/// What is in the pockets.
pub(super) struct Contents {
    rule: Pockets,
    /// Gap of contacts, where fluid passes through them \[m\].
    smallest_gap: f64,
    reference: f64,
    /// Absolute pressure of the cells in the last row \[Pa\]; [`NONE`] where there was no fluid.
    last: Vec<f64>,
    /// Number of cells in pockets, and their largest pressure.
    cells: usize,
    largest: f64,
}

impl Contents {
    pub(super) fn new(rule: Pockets, reference: f64, smallest_gap: f64, cells: usize) -> Self {
        Contents { rule, smallest_gap, reference, last: vec![NONE; cells], cells: 0, largest: 0.0 }
    }

    /// The gap of cells in contact, where fluid passes through them.
    pub(super) fn floor(&self) -> Option<f64> {
        (self.rule == Pockets::Connected).then_some(self.smallest_gap)
    }

    /// Writes the pressure of the pockets.
    pub(super) fn fill(&mut self, beside: &Beside, is_pocket: &[bool], pressure: &mut [f64]) {
        let pockets = || (0..is_pocket.len()).filter(|cell| is_pocket[*cell]);
        self.cells = pockets().count();
        self.largest = 0.0;
        if self.cells == 0 {
            return;
        }
        let mut forest = Forest::new(is_pocket.len());
        for cell in pockets() {
            for (_, other) in beside.of(cell) {
                if let Other::Cell(other) = other
                    && is_pocket[other]
                {
                    forest.join(cell, other);
                }
            }
        }
        // Sum and number of the pressures that the cells of a pocket had, at its root.
        let mut sums = vec![[0.0; 2]; is_pocket.len()];
        for cell in pockets().filter(|cell| self.rule == Pockets::Kept && self.last[*cell] != NONE) {
            let [sum, count] = &mut sums[forest.root(cell)];
            *sum += self.last[cell];
            *count += 1.0;
        }
        for cell in pockets() {
            let [sum, count] = sums[forest.root(cell)];
            pressure[cell] = if count > 0.0 { sum / count } else { self.reference };
            self.largest = self.largest.max(pressure[cell]);
        }
    }

    pub(super) fn cells(&self) -> usize {
        self.cells
    }

    pub(super) fn largest(&self) -> f64 {
        self.largest
    }

    /// The step stands.
    pub(super) fn commit(&mut self, pressure: &[f64]) {
        let cells = self.last.iter_mut().zip(pressure);
        cells.for_each(|(last, p)| *last = if p.is_nan() { NONE } else { *p });
    }

    pub(super) fn memory(&self) -> Vec<&[f64]> {
        vec![&self.last]
    }

    pub(super) fn memory_mut(&mut self) -> Vec<&mut [f64]> {
        vec![&mut self.last]
    }
}
