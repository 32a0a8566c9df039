//! Permanent flattening: the undeformed gap that changes with every row (docs/theory.md, "Permanent flattening").
//!
//! A cell at the hardness ends a row with an overlap, h < 0. That much of it was pushed aside for good: it is added to
//! the undeformed gap, h0 <- h0 - h, so that the cell ends the row just closed, h = 0, at p = H. The state stays a
//! solution of the contact conditions, now of the flattened surface.

use super::{Process, Solved};
use crate::error::Result;
use crate::quantities::Quantity;
use crate::simulation::{Plasticity, Simulation};
use crate::step::{Loader, Saver, UndeformedGap};
use asperity_sweep::{each, each_with_sums};

#[derive(Default)]
pub(super) struct Flattening {
    /// Σ of what was flattened, per area of a cell \[m\].
    depth: f64,
    cell_area: f64,
}

impl Flattening {
    /// `None` where the cut-off leaves no flattening.
    pub(super) fn of(simulation: &Simulation) -> Option<Self> {
        (simulation.plasticity == Plasticity::Accumulate)
            .then(|| Flattening { depth: 0.0, cell_area: simulation.grid.cell_area() })
    }
}

impl Process for Flattening {
    /// Makes the overlap of the row a part of the undeformed gap.
    fn accept(&mut self, row: &mut Solved<'_>) {
        let (c, w) = (row.compliance, row.now.approach);
        // The undeformed gap first: it is told by the gap as it was.
        let overlap = |p: f64, u: f64, gap: f64, hardness: f64| match w - (c * u + gap) {
            overlap if p >= hardness && overlap > 0.0 => overlap,
            _ => 0.0,
        };
        let (p, u) = (&row.contact.pressure[..], &row.now.unit_displacement[..]);
        let cells = (p, u, &row.own_gap[..], row.hardness);
        let [depth] = each_with_sums(row.undeformed.own_mut(), cells, |h, (p, u, gap, most)| {
            let overlap = overlap(p, u, gap, most);
            *h += overlap;
            [overlap]
        });
        self.depth += depth;
        each(row.own_gap, (p, u, row.hardness), |gap, (p, u, most)| *gap += overlap(p, u, *gap, most));
    }

    fn quantity(&self, quantity: Quantity) -> Option<f64> {
        (quantity == Quantity::PlasticVolume).then_some(self.depth * self.cell_area)
    }

    fn name(&self) -> &'static str {
        "flattening"
    }

    /// Its state is the undeformed gap, and what it has gained.
    fn save<'a>(&'a self, to: &mut Saver<'a>, gap: &'a UndeformedGap) {
        to.field("gap", gap.now());
        to.value("depth", &self.depth);
    }

    fn load(&mut self, from: &mut Loader<'_>, gap: &mut UndeformedGap) -> Result<()> {
        self.depth = from.get("depth")?;
        from.field_into("gap", gap.own_mut())
    }
}
