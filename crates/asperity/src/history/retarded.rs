//! A hereditary integral over pressures that are known at rows: F(t) = f(0) p + Σ f_j r_j with
//! r_j(t) = ∫ (1 - exp(-(t - s)/λ_j)) dp(s).
//!
//! Between two rows the pressures follow the material: under a held approach they relax by themselves, however long the step is. Their
//! course is that of the march: V = ∫ C(t - s) dp(s) is linear in time under approach control, and linear in L under load control
//! ([`super::relaxation`]). Here p takes the place of U, and V that of u. Because of λ_j dr_j/dt + r_j = p, the r_j are the retarded
//! strains of V over their compliances, so that the states q_i of V give them:
//!
//! ```text
//! r_j = Σ_i E_i τ_i/(λ_j - τ_i) q_i + (ζ/λ_j) V
//! ```
//!
//! A λ_j that C does not have is given to it with a compliance of [`SMALL`] times its own.

use std::sync::Arc;

use ndarray::Array2;

use super::relaxation::Relaxation;
use super::{Ends, History};
use crate::contact::ContactState;
use crate::error::Result;
use crate::grid::Grid;
use crate::load::{self, Control};
use crate::material::{Creep, CreepTerm};
use crate::simulation::Simulation;
use crate::step::{Course, Interval, Load};
use crate::time::Instant;
use asperity_sweep::{each, sum, zeros};

/// Share of C(∞) of a term that C does not have: it changes the course of p by as much.
const SMALL: f64 = 1e-9;
/// Retardation times that differ by less are the same.
const SAME: f64 = 1e-8;

/// F(t) of pressures that are known at rows.
pub(crate) struct Retarded {
    /// f(0), and f_j with the number of its term in C.
    instantaneous: f64,
    terms: Vec<(usize, f64)>,
    memory: Relaxation,
    /// p at the last two rows, in the place of U.
    before: ContactState,
    now: ContactState,
    rest: Vec<f64>,
    recalled: Vec<f64>,
    cell_area: f64,
}

impl Retarded {
    /// Starts without pressure on a body that yields by `contact` = C(t).
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) where C is not that of a deformable body.
    pub(crate) fn new(f: &Creep, contact: &Creep, grid: Grid) -> Result<Self> {
        let same = |a: &CreepTerm, time: f64| (a.retardation_time / time - 1.0).abs() < SAME;
        let mut creep = contact.tidy();
        let compliance =
            SMALL * creep.terms.iter().fold(creep.instantaneous, |sum, term| sum + term.compliance);
        for term in &f.terms {
            if !creep.terms.iter().any(|known| same(known, term.retardation_time)) {
                creep.terms.push(CreepTerm { compliance, ..*term });
            }
        }
        let simulation = Simulation { creep, ..Simulation::new(grid, Array2::zeros(grid.shape())) };
        let memory = Relaxation::new(&simulation)?;
        let place = |term: &CreepTerm| {
            let found = memory.retardation_times().position(|time| same(term, time));
            found.map(|j| (j, term.compliance))
        };
        Ok(Retarded {
            instantaneous: f.instantaneous,
            terms: f.terms.iter().filter_map(place).collect(),
            before: ContactState::new(grid.len()),
            now: ContactState::new(grid.len()),
            rest: zeros(grid.len()),
            recalled: zeros(grid.len()),
            cell_area: grid.cell_area(),
            memory,
        })
    }

    /// Fields of cells that it takes at most: states of all terms, V and a third V; p in both places of two rows; the gap and none.
    pub(crate) fn fields(f: &Creep, contact: &Creep) -> usize {
        contact.terms.len() + f.terms.len() + 8
    }

    /// The pressure at a row, `dt` after the last one; 0 of a jump.
    pub(crate) fn advance(&mut self, time: f64, dt: f64, control: Control, p: &[f64]) -> Result<()> {
        std::mem::swap(&mut self.before, &mut self.now);
        self.now.pressure.copy_from_slice(p);
        self.now.unit_displacement.copy_from_slice(p);
        let loads = [&self.before, &self.now].map(|state| self.cell_area * sum(&state.pressure));
        let load = match control {
            _ if !self.before.touches() && !self.now.touches() => Load::Apart,
            Control::Load | Control::Pressure => Load::Total(loads[1]),
            Control::Approach => Load::Approach,
        };
        let course = Arc::new(load::History::Step { value: 0.0 });
        let step = Interval {
            instant: Instant { time, dt, value: 0.0, jump: dt == 0.0, control, stage: 0 },
            start: time - dt,
            is_smooth: false,
            is_adaptive: false,
            held_from: 0.0,
            course: Course { history: course, start: 0.0, scale: 0.0 },
            load,
        };
        self.memory.open(&step, &self.before, &self.rest, &mut self.recalled)?;
        let ends = [&self.before, &self.now];
        self.memory.close(&Ends::unlimited(ends, loads, &self.recalled, &self.rest));
        Ok(())
    }

    /// The pressure at the last row.
    pub(crate) fn pressure(&self) -> &[f64] {
        &self.now.pressure
    }

    /// F at the last row.
    pub(crate) fn value(&self) -> Vec<f64> {
        let mut value = zeros(self.rest.len());
        self.memory.retarded(&self.terms, &self.now.unit_displacement, &mut value);
        let f = self.instantaneous;
        each(&mut value, &self.now.pressure[..], |sum, p| *sum += f * p);
        value
    }
}
