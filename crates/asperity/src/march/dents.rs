//! Permanent flattening: the undeformed gap that changes with every row (docs/theory.md, "Permanent flattening").
//!
//! A cell at the hardness ends a row with an overlap, h < 0. That much of it was pushed aside for good: it is added to
//! the undeformed gap, h0 <- h0 - h, so that the cell ends the row just closed, h = 0, at p = H. The state stays a
//! solution of the contact conditions, now of the dented surface.

use super::{March, Plasticity, Simulation, cap};
use crate::contact::Hardness;
use asperity_sweep::sweep;

/// The undeformed gap with all dents so far \[m\].
pub(super) struct Dents(Vec<f64>);

impl Dents {
    /// None yet; `None` where the cut-off leaves none.
    pub(super) fn new(simulation: &Simulation) -> Option<Self> {
        (simulation.plasticity == Plasticity::Accumulate)
            .then(|| Dents(simulation.gap.iter().copied().collect()))
    }

    pub(super) fn gap(&self) -> &[f64] {
        &self.0
    }

    pub(super) fn restore(&mut self, gap: Vec<f64>) {
        self.0 = gap;
    }
}

impl March {
    /// Makes the overlap of the row just solved a part of the undeformed gap.
    pub(super) fn dent(&mut self) {
        let Some(Dents(dented)) = &mut self.dents else { return };
        let (c, w) = (self.compliance, self.state.approach);
        let hardness = cap(&self.simulation, &self.hardness);
        sweep(
            (
                &self.state.pressure[..],
                &self.state.unit_displacement[..],
                &mut self.gap[..],
                &mut dented[..],
                hardness,
            ),
            &|(p, u, gap, dented, hardness): (&[f64], &[f64], &mut [f64], &mut [f64], Hardness)| {
                for i in 0..p.len() {
                    let overlap = w - (c * u[i] + gap[i]);
                    if p[i] >= hardness.at(i) && overlap > 0.0 {
                        gap[i] += overlap;
                        dented[i] += overlap;
                    }
                }
            },
        );
    }
}
