//! Permanent flattening: the undeformed gap that changes with every row (docs/theory.md, "Permanent flattening").
//!
//! A cell at the hardness ends a row with an overlap, h < 0. That much of it was pushed aside for good: it is added to
//! the undeformed gap, h0 <- h0 - h, so that the cell ends the row just closed, h = 0, at p = H. The state stays a
//! solution of the contact conditions, now of the flattened surface.
//!
//! In motion the gap is made anew at each place of the contact. The dents are kept in the frame of the body that has them: they stay on
//! the grid, or go with the body that slides.

use std::sync::Arc;

use super::{Process, Solved, carry};
use crate::error::Result;
use crate::quantities::Quantity;
use crate::simulation::{Plasticity, Simulation};
use crate::sliding::Slopes;
use crate::step::{Interval, Loader, Saver, UndeformedGap};
use asperity_sweep::{each, each_with_sums, zeros};
use ndarray::Array2;

pub(super) struct Flattening {
    /// Σ of what was flattened, per area of a cell \[m\].
    depth: f64,
    cell_area: f64,
    /// Of a contact in motion.
    carried: Option<Carried>,
}

impl Flattening {
    /// `None` where the cut-off leaves no flattening.
    pub(super) fn of(simulation: &Arc<Simulation>) -> Option<Self> {
        let carried =
            simulation.motion.as_ref().map(|_| Carried { simulation: simulation.clone(), offset: [0.0; 2] });
        (simulation.plasticity == Plasticity::Accumulate).then(|| Flattening {
            depth: 0.0,
            cell_area: simulation.grid.cell_area(),
            carried,
        })
    }
}

/// The body of a contact in motion that is dented.
struct Carried {
    simulation: Arc<Simulation>,
    /// Cells along x and y that this body has gone.
    offset: [f64; 2],
}

impl Carried {
    /// Adds its dents to a gap that does not have them, where the body is at a time.
    fn add_to(&mut self, gap: &mut UndeformedGap, time: f64) {
        let Simulation { grid, boundary, motion, dents_move, .. } = &*self.simulation;
        let moving = motion.as_ref().filter(|_| *dents_move);
        self.offset = moving.map_or([0.0; 2], |motion| motion.cells_gone(grid, time));
        if gap.dents.is_empty() {
            return;
        }
        let on_grid = carry(grid, *boundary, self.offset, &gap.dents);
        each(gap.own_mut(), &on_grid[..], |h, dent| *h += dent);
        if moving.is_some() {
            let own = Array2::from_shape_vec(grid.shape(), on_grid).expect("one dent for each cell");
            gap.add_slopes(Slopes::of_heights(grid, *boundary, &own));
        }
    }

    /// Takes in those of a row, in the frame of the grid.
    fn take_in(&self, dents: &[f64], gap: &mut UndeformedGap) {
        let Simulation { grid, boundary, .. } = &*self.simulation;
        let own = carry(grid, *boundary, self.offset.map(|cells| -cells), dents);
        gap.dents.resize(grid.len(), 0.0);
        each(&mut gap.dents, &own[..], |to, dent| *to += dent);
    }
}

impl Process for Flattening {
    /// Gives the gap of a contact in motion its dents.
    fn open(&mut self, step: &Interval, gap: &mut UndeformedGap) -> Result<()> {
        self.carried.iter_mut().for_each(|carried| carried.add_to(gap, step.instant.time));
        Ok(())
    }

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
        if let Some(carried) = &self.carried {
            let mut dents = zeros(p.len());
            each(&mut dents, cells, |dent, (p, u, gap, most)| *dent = overlap(p, u, gap, most));
            carried.take_in(&dents, row.undeformed);
        }
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
        if !gap.dents.is_empty() {
            to.field("dents", &gap.dents);
        }
    }

    fn load(&mut self, from: &mut Loader<'_>, gap: &mut UndeformedGap) -> Result<()> {
        self.depth = from.get("depth")?;
        if self.carried.is_some() && self.depth > 0.0 {
            gap.dents = from.field("dents")?;
        }
        from.field_into("gap", gap.own_mut())
    }
}
