//! Pockets: parts of the gap that neither reservoir reaches.
//!
//! | rule | pressure of a pocket |
//! |---|---|
//! | kept | what it had when it was cut off, the mean over its cells; the reference where it was never filled |
//! | drained | the reference |
//! | sealed | that with which its fluid fills it (see `sealed`) |
//! | connected | that of a flow through contacts with the smallest gap: pockets fill and drain in the long run |
//!
//! What a pocket had is what its cells had in the last row. A pocket that gains and loses a reservoir again and again within a row, because its
//! pressure opens a throat that closes when it is gone, has lost that: then it is what it had with the reservoir.

use super::beside::Beside;
use super::sealed::{Fluid, Found, Sealed};
use crate::error::{Error, Result};

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
    /// What is in them stays in them: the pressure rises as they are pressed together.
    Sealed,
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
    pub(super) sealed: Option<Sealed>,
    /// Number of cells in pockets, and their largest pressure.
    pub(super) cells: usize,
    pub(super) largest: f64,
}

impl Contents {
    pub(super) fn new(rule: Pockets, reference: f64, smallest_gap: f64, cells: usize) -> Self {
        let last = vec![NONE; cells];
        Contents { rule, smallest_gap, reference, last, sealed: None, cells: 0, largest: 0.0 }
    }

    /// Of pockets that are sealed; before the first row the gap is full.
    pub(super) fn sealed(fluid: Fluid, reference: f64, cell_area: f64, cells: usize) -> Self {
        let sealed = Sealed::new(fluid, reference, cell_area, cells);
        let last = vec![reference; cells];
        Contents { last, sealed: Some(sealed), ..Contents::new(Pockets::Sealed, reference, 0.0, 0) }
    }

    /// A solve begins, as of [`Sealed::begin`].
    pub(super) fn begin(&mut self, beside: &Beside, compliance: f64, rise: f64, traction: &mut [f64]) {
        if let Some(sealed) = &mut self.sealed {
            sealed.begin(beside, &self.last, compliance, rise, traction);
        }
    }

    /// The gap of cells in contact, where fluid passes through them.
    pub(super) fn floor(&self) -> Option<f64> {
        (self.rule == Pockets::Connected).then_some(self.smallest_gap)
    }

    /// Writes the pressure of the pockets.
    pub(super) fn fill(&mut self, beside: &Beside, found: &Found<'_>, pressure: &mut [f64]) {
        let is_pocket = found.is_pocket;
        let pockets = || (0..is_pocket.len()).filter(|cell| is_pocket[*cell]);
        self.cells = pockets().count();
        match &mut self.sealed {
            Some(sealed) => sealed.fill(beside, &self.last, found, pressure),
            None if self.cells > 0 => self.fill_by_cells(beside, found, pressure),
            None => {}
        }
        self.largest = pockets().map(|cell| pressure[cell]).fold(0.0, f64::max);
    }

    /// From the pressures that the cells of a pocket had.
    fn fill_by_cells(&self, beside: &Beside, found: &Found<'_>, pressure: &mut [f64]) {
        let pockets = || (0..found.is_pocket.len()).filter(|cell| found.is_pocket[*cell]);
        let mut forest = beside.joined(found.is_pocket);
        // Sum and number of the pressures that the cells of a pocket had, at its root.
        let mut sums = vec![[0.0; 2]; found.is_pocket.len()];
        let had = |cell: usize| (found.vented)(cell).or(Some(self.last[cell]).filter(|p| *p != NONE));
        for (cell, p) in pockets().filter_map(|cell| Some((cell, had(cell)?))) {
            if self.rule == Pockets::Kept {
                let [sum, count] = &mut sums[forest.root(cell)];
                *sum += p;
                *count += 1.0;
            }
        }
        for cell in pockets() {
            let [sum, count] = sums[forest.root(cell)];
            pressure[cell] = if count > 0.0 { sum / count } else { self.reference };
        }
    }

    /// The step stands.
    pub(super) fn commit(&mut self, pressure: &[f64]) {
        let cells = self.last.iter_mut().zip(pressure);
        cells.for_each(|(last, p)| *last = if p.is_nan() { NONE } else { *p });
        if let Some(sealed) = &mut self.sealed {
            sealed.commit(pressure, &mut self.last);
        }
    }

    pub(super) fn memory(&self) -> Vec<&[f64]> {
        std::iter::once(&self.last[..])
            .chain(self.sealed.as_ref().map(|sealed| &sealed.contents[..]))
            .collect()
    }

    pub(super) fn memory_mut(&mut self) -> Vec<&mut [f64]> {
        std::iter::once(&mut self.last[..])
            .chain(self.sealed.as_mut().map(|sealed| &mut sealed.contents[..]))
            .collect()
    }
}
