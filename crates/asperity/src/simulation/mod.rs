//! What is simulated: all that a march needs to know.

use std::sync::Arc;

use ndarray::Array2;

use crate::contact::{Solver, SolverOptions};
use crate::error::{Error, Result};
use crate::grid::{Boundary, Grid};
use crate::history;
use crate::kernel::{HalfSpace, Kernel};
use crate::layer::NonseparableLayers;
use crate::load::{Control, Course, Event, History, Loading, Programme, of_stage};
use crate::material::{Creep, ThermalCreep};
use crate::operator;
use crate::process::Motion;
use crate::quantities::{Column, ContactStiffness, Quantities, Quantity};
use crate::spots::Spots;
use crate::time::{Plan, SAME, TimeGrid};
use crate::traction::TractionLaw;

/// Fewer steps than this to the period of a sine miss its course.
const LEAST_PER_PERIOD: f64 = 20.0;

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
    /// What is prescribed; a [`Loading`] becomes a programme by `into()`.
    pub loading: Programme,
    /// When the state is computed.
    pub times: TimeGrid,
    /// Instants that are steps besides \[s\]. (Adaptive steps need none: see [`crate::Drive::between`].)
    pub include: Vec<f64>,
    /// How time is discretised.
    pub scheme: Scheme,
    /// How each step is solved.
    pub solver: SolverOptions,
    /// Quantities that each row has besides those of [`Row`](crate::step::Row).
    pub quantities: Quantities,
    /// How the contact moves over the bodies; `None` where it stays.
    pub motion: Option<Motion>,
    /// A traction on the surfaces besides the contact, as a function of the gap.
    pub traction: Option<Arc<dyn TractionLaw>>,
}

/// Layers on a rigid base under a periodic domain may be so many times as thick as the domain is wide: the tolerance is relative
/// to displacements that include their uniform compression.
const DEEPEST: f64 = 1000.0;

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
            loading: Loading { control: Control::Load, history: History::Step { value: 0.0 } }.into(),
            times: TimeGrid::Uniform { end: 1.0, steps: 1 },
            include: vec![],
            scheme: Scheme::default(),
            solver: SolverOptions::default(),
            quantities: Quantities::default(),
            motion: None,
            traction: None,
        }
    }

    /// The rows as far as they are known beforehand: t = 0+, the steps, the breaks and jumps of the histories, those
    /// of the temperature, the ends of the stages.
    pub fn plan(&self) -> Plan {
        let mut include = self.stops();
        include.extend(self.motion.iter().flat_map(|motion| motion.path.breaks(self.times.end())));
        include.extend(self.thermal.iter().flat_map(|body| body.clock.breaks(self.times.end())));
        self.loading.plan(&self.times, &include)
    }

    /// The instants besides those of the grid at which steps end.
    pub(crate) fn stops(&self) -> Vec<f64> {
        let mut stops = self.include.clone();
        // A travel that is too long is refused by `validate`.
        stops.extend(self.motion.iter().flat_map(|motion| motion.stops(self).unwrap_or_default()));
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

    /// Compliance of the pair at time t under a pressure held since 0 \[1/Pa\].
    pub fn compliance(&self, t: f64) -> f64 {
        self.creep.value(t) + self.thermal.iter().map(|body| body.value(0.0, t)).sum::<f64>()
    }

    /// Memory that a march takes at most \[bytes\]: its operator, solver, fields, history, and what its quantities need.
    pub fn bytes(&self) -> usize {
        let (grid, n) = (&self.grid, self.grid.len());
        let has = |wanted: bool, bytes: usize| if wanted { bytes } else { 0 };
        operator::bytes(grid, self.boundary)
            + Solver::bytes(self.solver.method, grid, self.boundary)
            // pressure and U of two rows, undeformed and remembered gap
            + 6 * 8 * n
            + history::bytes(self)
            // the gap with its dents
            + has(self.plasticity == Plasticity::Accumulate, 8 * n)
            + has(self.quantities.has(Quantity::ContactStiffness), ContactStiffness::bytes(grid, self.boundary))
            + has(self.quantities.list.iter().any(|q| q.connects()), Spots::bytes(grid))
    }

    /// The quantities of each row, with the ends of their bins.
    ///
    /// # Errors
    /// [`Error::Invalid`] as [`Quantities::columns`].
    pub fn columns(&self) -> Result<Vec<Column>> {
        self.columns_of(&self.quantities)
    }

    /// The bins of other quantities than those of the simulation.
    ///
    /// # Errors
    /// [`Error::Invalid`] as [`Quantities::columns`].
    pub fn columns_of(&self, quantities: &Quantities) -> Result<Vec<Column>> {
        let hardness = match self.hardness_of_cells() {
            Some(cells) => cells.into_iter().fold(0.0, f64::max),
            None => self.hardness,
        };
        quantities.columns(&self.grid, &self.gap, hardness)
    }

    /// Checks all that can be known before the first solve.
    ///
    /// # Errors
    /// [`Error::Invalid`], [`Error::Infeasible`].
    pub fn validate(&self) -> Result<()> {
        if self.gap.dim() != self.grid.shape() {
            let [nx, ny] = self.grid.cells();
            return Err(Error::invalid(
                "shape of the gap",
                format!("{:?}", self.gap.dim()),
                format!("that of the grid, ({nx}, {ny})"),
            ));
        }
        if !self.gap.is_standard_layout() {
            return Err(Error::invalid("memory order of the gap", "not C-order", "C-order"));
        }
        if let Some(((i, j), h)) =
            self.gap.indexed_iter().find(|(_, h)| h.is_nan() || **h == f64::NEG_INFINITY)
        {
            return Err(Error::invalid(
                format!("gap at cell ({i}, {j})"),
                h,
                "a number (infinite where the cell cannot touch)",
            ));
        }
        let touchable = self.gap.iter().filter(|h| h.is_finite()).count();
        if touchable == 0 {
            return Err(Error::invalid("gap", "infinite everywhere", "finite in one cell at least"));
        }
        if self.boundary == Boundary::Free {
            self.kernel.check(self.grid.longest_cell())?;
        }
        let widest = self.grid.longest_side();
        if let Some(depth) = self.kernel.depth()
            && self.boundary == Boundary::Periodic
            && depth > DEEPEST * widest
        {
            return Err(Error::invalid(
                "thickness of the layers on their rigid base",
                format!("{depth:e} m"),
                format!(
                    "at most {DEEPEST} times the periodic domain, {widest:e} m: no wave reaches the base, but its compression \
                     would swamp the displacements; describe the body as a half-space"
                ),
            ));
        }
        self.parts().try_for_each(Creep::validate)?;
        if self.parts().all(|creep| creep.value(f64::MAX.sqrt()) <= 0.0) {
            return Err(Error::invalid(
                "contact creep compliance",
                0,
                "greater than 0 (both bodies are rigid)",
            ));
        }
        if self.hardness.is_nan() || self.hardness <= 0.0 {
            return Err(Error::invalid("hardness", format!("{} Pa", self.hardness), "greater than 0"));
        }
        self.validate_hardness_map()?;
        self.validate_line()?;
        if self.plasticity == Plasticity::Accumulate
            && self.hardness.is_infinite()
            && self.hardness_map.is_none()
        {
            return Err(Error::invalid(
                "hardness",
                "infinite",
                "finite where flattening stays (plasticity \"accumulate\"): nothing is flattened without",
            ));
        }
        self.columns()?;
        if self.quantities.has_energy() && self.scheme == Scheme::Direct {
            let energies = self.quantities.list.iter().filter(|quantity| quantity.is_energy());
            let names: Vec<_> = energies.map(|quantity| quantity.name()).collect();
            return Err(Error::invalid(
                "scheme",
                "direct",
                format!(
                    "linear or constant where {} is asked for: the full hereditary sum knows no springs and dashpots",
                    names.join(", ")
                ),
            ));
        }
        self.validate_layers()?;
        self.loading.validate()?;
        self.times.validate()?;
        if self.is_adaptive() && self.scheme != Scheme::Linear {
            return Err(Error::invalid(
                "scheme of a run with adaptive steps",
                format!("{:?}", self.scheme).to_lowercase(),
                "linear (the error estimate belongs to it)",
            ));
        }
        self.solver.validate()?;
        if let Some(motion) = &self.motion {
            motion.validate(self)?;
        }
        self.validate_steps()?;
        self.validate_load()?;
        self.validate_jumps()
    }

    /// What goes with layers that creep differently.
    fn validate_layers(&self) -> Result<()> {
        if self.layers.is_none() {
            return Ok(());
        }
        let refused = |what: &str, value: String, expected: &str| {
            Err(Error::invalid(format!("{what} of layers that creep differently"), value, expected))
        };
        if self.scheme != Scheme::Linear {
            return refused("scheme", format!("{:?}", self.scheme).to_lowercase(), "linear");
        }
        if !self.thermal.is_empty() {
            return refused("temperature", "not constant".into(), "a constant one");
        }
        if self.motion.is_some() {
            return refused("motion", "given".into(), "none: the contact stays in its place");
        }
        let unknown = |q: &&Quantity| q.is_energy() || **q == Quantity::ContactStiffness;
        match self.quantities.list.iter().find(unknown) {
            Some(quantity) => refused("quantity", quantity.name().to_string(), "another one"),
            None => Ok(()),
        }
    }

    /// Whether displacements are known up to a constant, which the approach then has too: in a line contact on a free domain, unless
    /// all bodies lie on a rigid base.
    pub fn is_up_to_a_constant(&self) -> bool {
        self.grid.is_line() && self.boundary == Boundary::Free && self.kernel.depth().is_none()
    }

    /// Where displacements are known up to a constant.
    fn validate_line(&self) -> Result<()> {
        if !self.is_up_to_a_constant() {
            return Ok(());
        }
        if self.grid.len() < 2 {
            return Err(Error::invalid("number of cells of a free line contact", 1, "2 at least"));
        }
        for (n, stage) in self.loading.stages.iter().enumerate() {
            let event = matches!(stage.until, Some(Event::Approach(_)));
            if stage.control == Control::Approach || event {
                let (what, value) = match event {
                    true => ("event of a free line contact", "an approach"),
                    false => ("control of a free line contact", "approach"),
                };
                let error = Error::invalid(
                    what,
                    value,
                    "a load or a pressure: under a load on a line a half-space moves endlessly, so the approach is known up to a \
                     constant that depends on the domain; a periodic domain (boundary = \"periodic\") has no such limit, nor have \
                     layers on a rigid base",
                );
                return Err(if self.loading.stages.len() > 1 { of_stage(error, n) } else { error });
            }
        }
        let moves = self.motion.is_some();
        let depends = |q: &&Quantity| q.is_of_time() || **q == Quantity::DissipatedPower && moves;
        match self.quantities.list.iter().find(depends) {
            Some(quantity) => Err(Error::invalid(
                "quantity of a free line contact",
                quantity.name(),
                "one that does not depend on displacements, which are known up to a constant; a periodic domain has no such limit",
            )),
            None => Ok(()),
        }
    }

    fn validate_hardness_map(&self) -> Result<()> {
        let Some(map) = &self.hardness_map else {
            return Ok(());
        };
        if map.dim() != self.grid.shape() {
            return Err(Error::invalid(
                "shape of the hardness of the cells",
                format!("{:?}", map.dim()),
                format!("{:?}, one for each cell", self.grid.shape()),
            ));
        }
        match map.indexed_iter().find(|(_, h)| !(h.is_finite() && **h > 0.0)) {
            Some(((i, j), h)) => Err(Error::invalid(
                format!("hardness of cell ({i}, {j})"),
                format!("{h} Pa"),
                "finite and greater than 0",
            )),
            None => Ok(()),
        }
    }

    /// The cut-off that holds in each cell, where it is not the same everywhere.
    pub(crate) fn hardness_of_cells(&self) -> Option<Vec<f64>> {
        let map = self.hardness_map.as_ref()?;
        Some(map.iter().map(|hardness| hardness.min(self.hardness)).collect())
    }

    /// Sum of the cut-off over the cells that can touch \[Pa\].
    fn most(&self) -> f64 {
        let can_touch = |h: &&f64| h.is_finite();
        match self.hardness_of_cells() {
            Some(cells) => {
                self.gap.iter().zip(cells).filter(|(h, _)| can_touch(h)).map(|(_, cell)| cell).sum()
            }
            None => self.hardness * self.gap.iter().filter(can_touch).count() as f64,
        }
    }

    fn validate_load(&self) -> Result<()> {
        let end = self.times.end();
        for (n, stage) in self.loading.stages.iter().enumerate() {
            let factor = match stage.control {
                Control::Approach => continue,
                Control::Load => 1.0,
                Control::Pressure => self.grid.area(),
            };
            let lasts = stage.duration.unwrap_or(end).min(end);
            let [least, most] = match &stage.course {
                Course::Given(history) => history.range(lasts),
                Course::Hold => continue,
                Course::RampTo { value, .. } => [*value; 2],
            };
            if least < 0.0 && self.traction.is_none() {
                let (what, unit) = match stage.control {
                    Control::Pressure => ("smallest mean pressure", "Pa"),
                    _ => ("smallest load", "N"),
                };
                let error =
                    Error::invalid(what, format!("{least} {unit}"), "not negative (bodies only press)");
                return Err(if self.loading.stages.len() > 1 { of_stage(error, n) } else { error });
            }
            let max = self.most() * self.grid.cell_area();
            if most * factor > max * (1.0 + 1e-12) {
                return Err(Error::Infeasible { load: most * factor, max });
            }
        }
        Ok(())
    }

    /// Steps must follow a sine, and times of a history must be apart.
    fn validate_steps(&self) -> Result<()> {
        let end = self.times.end();
        for (n, stage) in self.loading.stages.iter().enumerate() {
            let Course::Given(history) = &stage.course else { continue };
            let breaks = history.breaks(end);
            let close = |pair: &&[f64]| pair[1] > pair[0] && pair[1] - pair[0] <= SAME * end;
            let times: Vec<f64> = std::iter::once(0.0).chain(breaks).collect();
            if let Some(pair) = times.windows(2).find(close) {
                let error = Error::invalid(
                    "times of the history",
                    format!("{} s and {} s", pair[0], pair[1]),
                    format!(
                        "at least {:e} s apart, {SAME:e} of the run: rounding joins closer ones",
                        SAME * end
                    ),
                );
                return Err(if self.loading.stages.len() > 1 { of_stage(error, n) } else { error });
            }
        }
        let mut longest = vec![0.0_f64; self.loading.stages.len()];
        for instant in self.plan().instants {
            longest[instant.stage] = longest[instant.stage].max(instant.dt);
        }
        for (n, (stage, longest)) in self.loading.stages.iter().zip(longest).enumerate() {
            let Course::Given(History::Sine { amplitude, frequency, .. }) = stage.course else { continue };
            let grid = stage.times.as_ref().unwrap_or(&self.times);
            if amplitude == 0.0 || grid.is_adaptive() || longest * frequency <= 1.001 / LEAST_PER_PERIOD {
                continue;
            }
            let lasts = stage.duration.unwrap_or(end).min(grid.end());
            let error = Error::invalid(
                "longest time step under a sine",
                format!("{longest} s"),
                format!(
                    "at most {} s, {LEAST_PER_PERIOD} steps to a period: {} uniform steps at least, or adaptive ones",
                    1.0 / (LEAST_PER_PERIOD * frequency),
                    (LEAST_PER_PERIOD * frequency * lasts).ceil(),
                ),
            );
            return Err(if self.loading.stages.len() > 1 { of_stage(error, n) } else { error });
        }
        Ok(())
    }

    /// Without instantaneous compliance nothing follows a jump.
    fn validate_jumps(&self) -> Result<()> {
        if self.instantaneous() > 0.0 {
            return Ok(());
        }
        let mut last = 0.0;
        let mut stage = 0;
        for instant in self.plan().instants {
            // What a stage starts from may be known only as the run goes; the march looks then.
            if instant.jump && instant.stage == stage && instant.value != last {
                return Err(Error::invalid(
                    format!("jump of the history at t = {} s", instant.time),
                    format!("{:e} to {:e}", last, instant.value),
                    "a ramp: the material has no instantaneous compliance, so no contact follows a jump",
                ));
            }
            (last, stage) = (instant.value, instant.stage);
        }
        Ok(())
    }
}
