//! What is simulated: all that a march needs to know.

mod validate;

use std::sync::Arc;

use ndarray::Array2;

use crate::contact::{Solver, SolverOptions};
use crate::error::Result;
use crate::flash::{self, Flash};
use crate::grid::{Boundary, Grid};
use crate::history;
use crate::kernel::{HalfSpace, Kernel};
use crate::layer::NonseparableLayers;
use crate::load::{Control, History, Loading, Programme};
use crate::material::{Creep, ThermalCreep};
use crate::operator;
use crate::process::Motion;
use crate::quantities::{Column, ContactStiffness, Quantities, Quantity};
use crate::spots::Spots;
use crate::tangential::{self, Tangential};
use crate::time::{Plan, TimeGrid};
use crate::traction::{TractionLaw, TractionSolver};
use crate::wear::Wear;
use asperity_sweep::{maximum, minimum};

/// How the pressure varies over a time step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Scheme {
    /// Linear displacement: second order.
    ///
    /// Relaxing displacements, driven by a displacement that runs linearly over each step in time, or under load control in
    /// the integral of C dW: positive and monotone for every material and step.
    #[default]
    Linear,
    /// Constant over each step: first order, L-stable; the assumption of SC17.
    Constant,
    /// The full hereditary sum of SC17 over all steps, pressure constant in each: slow, keeps every pressure field.
    Direct,
}

/// What remains of the flattening at the hardness after unloading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Plasticity {
    /// Nothing: the pressure is cut off at the hardness, and the flattening disappears on unloading (SC17).
    #[default]
    Cap,
    /// All of it: after each row the overlap of the cells at the hardness is added to their undeformed gap. Needs a
    /// hardness.
    Accumulate,
}

/// A contact of two bodies under a history of load or approach.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The domain.
    pub grid: Grid,
    /// Free or periodic.
    pub boundary: Boundary,
    /// How the surface yields in space, for unit compliance: half-spaces, or [layers](crate::layer::response).
    pub kernel: Arc<dyn Kernel>,
    /// Layers whose waves creep differently; `kernel` and `creep` are then those of short times and short waves.
    pub layers: Option<Arc<NonseparableLayers>>,
    /// Undeformed gap h0 \[m\], shape (nx, ny), least value 0; infinite where a cell cannot touch.
    pub gap: Array2<f64>,
    /// Contact creep compliance C(t) of the pair \[1/Pa\]; without the bodies of `thermal`.
    pub creep: Creep,
    /// Bodies whose temperature changes, each on its own clock; their compliance adds to `creep`.
    pub thermal: Vec<ThermalCreep>,
    /// Cut-off of the pressure \[Pa\]; infinite for none.
    pub hardness: f64,
    /// Cut-off of the pressure in each cell \[Pa\], finite, where it is not the same everywhere; where `hardness` is less,
    /// that holds.
    pub hardness_map: Option<Array2<f64>>,
    /// What remains of the flattening at the hardness after unloading.
    pub plasticity: Plasticity,
    /// Whether dents that stay are those of the body that slides, and go with it; else they stay on the grid.
    pub dents_move: bool,
    /// What is prescribed; a [`Loading`] becomes a programme by `into()`.
    pub loading: Programme,
    /// When the state is computed.
    pub times: TimeGrid,
    /// Additional instants at which steps end \[s\].
    pub include: Vec<f64>,
    /// How time is discretised.
    pub scheme: Scheme,
    /// How each step is solved.
    pub solver: SolverOptions,
    /// Quantities that each row has in addition to those of [`Row`](crate::step::Row).
    pub quantities: Quantities,
    /// How the contact moves over the bodies; `None` where it stays.
    pub motion: Option<Motion>,
    /// A traction on the surfaces in addition to the contact pressure, as a function of the gap.
    pub traction: Option<Arc<dyn TractionLaw>>,
    /// Friction and a load along the surfaces; `None` for none.
    pub tangential: Option<Arc<Tangential>>,
    /// Wear of the surfaces; `None` for none.
    pub wear: Option<Arc<Wear>>,
    /// The heat of friction of a contact in motion; `None` where nothing warms the surfaces.
    pub flash: Option<Arc<Flash>>,
}

impl Simulation {
    /// A free half-space of unit compliance under no load for one second, to set the rest on.
    pub fn new(grid: Grid, gap: Array2<f64>) -> Self {
        Simulation {
            grid,
            boundary: Boundary::Free,
            kernel: Arc::new(HalfSpace),
            layers: None,
            gap,
            creep: Creep::elastic(1.0),
            thermal: vec![],
            hardness: f64::INFINITY,
            hardness_map: None,
            plasticity: Plasticity::default(),
            dents_move: false,
            loading: Loading { control: Control::Load, history: History::Step { value: 0.0 } }.into(),
            times: TimeGrid::Uniform { end: 1.0, steps: 1 },
            include: vec![],
            scheme: Scheme::default(),
            solver: SolverOptions::default(),
            quantities: Quantities::default(),
            motion: None,
            traction: None,
            tangential: None,
            wear: None,
            flash: None,
        }
    }

    /// The rows as far as they are known beforehand: t = 0+, the steps, the breaks and jumps of the histories, those
    /// of the temperature, the ends of the stages.
    pub fn plan(&self) -> Plan {
        self.loading.plan(&self.times, &[self.stops(), self.kinks()].concat())
    }

    /// The instants at which the temperature or the path of the motion has a kink.
    pub(crate) fn kinks(&self) -> Vec<f64> {
        let end = self.times.end();
        let of_temperature = self.thermal.iter().flat_map(|body| body.clock.breaks(end));
        of_temperature.chain(self.motion.iter().flat_map(|motion| motion.path.breaks(end))).collect()
    }

    /// The instants at which steps end in addition to those of the grid.
    pub(crate) fn stops(&self) -> Vec<f64> {
        let mut stops = self.include.clone();
        stops.extend(self.traction.iter().flat_map(|law| law.breaks(self.times.end())));
        // A travel that is too long is refused by `validate`.
        stops.extend(self.motion.iter().flat_map(|motion| motion.stops(self).unwrap_or_default()));
        stops.extend(self.tangential.iter().flat_map(|tangential| tangential.breaks(self.times.end())));
        stops.extend(self.wear.iter().flat_map(|wear| wear.breaks(self.times.end())));
        stops
    }

    /// Whether the steps of a stage are adaptive.
    pub fn is_adaptive(&self) -> bool {
        let own = self.loading.stages.iter().flat_map(|stage| &stage.times);
        self.times.is_adaptive() || own.into_iter().any(TimeGrid::is_adaptive)
    }

    /// The creep functions whose sum answers: that of laboratory time, then those of `thermal`.
    pub(crate) fn parts(&self) -> impl Iterator<Item = &Creep> {
        std::iter::once(&self.creep).chain(self.thermal.iter().map(|body| &body.creep))
    }

    /// Instantaneous compliance C(0+) of the pair \[1/Pa\].
    pub fn instantaneous(&self) -> f64 {
        self.parts().map(|creep| creep.instantaneous).sum()
    }

    /// Compliance of the pair after a long time \[1/Pa\]; where it flows, at the end of the run.
    pub fn relaxed(&self) -> f64 {
        let flows = self.parts().any(|creep| creep.fluidity > 0.0);
        if flows { self.compliance(self.times.end()) } else { self.parts().map(Creep::long_time).sum() }
    }

    /// Compliance of the pair at time t under a pressure held since 0 \[1/Pa\].
    pub fn compliance(&self, t: f64) -> f64 {
        self.creep.value(t) + self.thermal.iter().map(|body| body.value(0.0, t)).sum::<f64>()
    }

    /// Memory that a march takes at most \[bytes\]: its operator, solver, fields, history, and what its quantities need.
    pub fn bytes(&self) -> usize {
        let (grid, n) = (&self.grid, self.grid.len());
        let has = |wanted: bool, bytes: usize| if wanted { bytes } else { 0 };
        let (remembers, flattens) = (history::remembers(self), self.plasticity == Plasticity::Accumulate);
        operator::bytes(grid, self.boundary)
            + Solver::bytes(self.solver.method, grid, self.boundary)
            // pressure and U, and those of the row before; the undeformed gap, and that of the step
            + 2 * 8 * n
            + has(remembers || self.touches_again(), 2 * 8 * n)
            + 8 * n
            + has(remembers || flattens, 8 * n)
            + history::bytes(self)
            // the gap with its dents, and the dents by themselves
            + has(flattens, if self.motion.is_some() { 3 } else { 1 } * 8 * n)
            + self.traction.as_ref().map_or(0, |law| TractionSolver::bytes(&**law, grid))
            + has(self.quantities.has(Quantity::ContactStiffness), ContactStiffness::bytes(grid, self.boundary))
            + has(self.quantities.list.iter().any(|q| q.connects()), Spots::bytes(grid))
            + has(self.flash.is_some(), flash::bytes(&self.grid, self.boundary))
            + self.tangential.as_ref().map_or(0, |law| {
                tangential::bytes(grid, self.boundary, law) + 2 * history::bytes(self)
            })
            + self.wear.as_ref().map_or(0, |wear| wear.bytes(grid, self))
    }

    /// Whether more than one row may be in contact.
    fn touches_again(&self) -> bool {
        let plan = self.plan();
        let apart = |value: f64| value <= 0.0 && self.traction.is_none();
        !plan.exact || plan.instants.iter().filter(|instant| !apart(instant.value)).count() > 1
    }

    /// The quantities of each row, with the ends of their bins.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) as [`Quantities::columns`].
    pub fn columns(&self) -> Result<Vec<Column>> {
        self.columns_of(&self.quantities)
    }

    /// The bins of other quantities than those of the simulation.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) as [`Quantities::columns`].
    pub fn columns_of(&self, quantities: &Quantities) -> Result<Vec<Column>> {
        let [_, hardest] = self.hardness_range();
        quantities.columns(&self.grid, &self.gap, hardest)
    }

    /// Whether displacements are known up to a constant, which the approach then has too: in a line contact on a free domain, unless
    /// all bodies lie on a rigid base.
    pub fn is_up_to_a_constant(&self) -> bool {
        self.grid.is_line() && self.boundary == Boundary::Free && self.kernel.depth().is_none()
    }

    /// Whether bodies that move lose work: they remember what pressed them, or are ploughed.
    pub(crate) fn loses(&self) -> bool {
        self.layers.is_some()
            || self.plasticity == Plasticity::Accumulate
            || self.parts().any(Creep::remembers)
    }

    /// The least and the largest cut-off of a cell \[Pa\].
    pub(crate) fn hardness_range(&self) -> [f64; 2] {
        match self.hardness_of_cells() {
            Some(cells) => [minimum(&cells), maximum(&cells)],
            None => [self.hardness; 2],
        }
    }

    /// The undeformed gap, cell by cell: that of a valid simulation is in C-order.
    pub(crate) fn gap_cells(&self) -> &[f64] {
        self.gap.as_slice().unwrap_or_default()
    }

    /// The cut-off that holds in each cell, where it is not the same everywhere.
    pub(crate) fn hardness_of_cells(&self) -> Option<Vec<f64>> {
        let map = self.hardness_map.as_ref()?;
        Some(map.iter().map(|hardness| hardness.min(self.hardness)).collect())
    }
}
