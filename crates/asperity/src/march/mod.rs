//! The march through time: one elastic contact per step.
//!
//! Space and time separate: u(x, t) = integral C(t - s) d(Kp)(x, s). With U = Kp kept in displacement
//! space, a step from t_n to t_(n+1) leaves u_(n+1) = c U_(n+1) + g, where the number c and the field g
//! (the history) are known before the solve (theory section 4). So the step IS the elastic contact with
//! compliance c and undeformed gap h0 + g, and the past costs no convolution.

#![allow(clippy::type_complexity)] // the closures of a sweep spell out the slices that they walk

mod dents;
mod direct;
mod energy;
mod measure;
mod memory;
mod record;
mod simulation;

pub use record::{Row, Step};
pub use simulation::{Plasticity, Scheme, Simulation};

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ndarray::Array2;

use crate::contact::{ContactState, Hardness, Outcome, Prescribed, Problem, Solver};
use crate::error::{Error, Result};
use crate::field::sweep;
use crate::operator::{Operator, half_space};
use crate::time::Instant;
use dents::Dents;
use direct::Direct;
use measure::Meter;
use memory::Memory;

/// A simulation on its way.
///
/// ```
/// use asperity::{march::March, material::Creep, surface::{Part, Shape, undeformed_gap}, *};
/// # use asperity::march::{Scheme, Simulation}; use asperity::time::TimeGrid;
/// // A sphere of 10 mm on an incompressible Zener solid, 1 N held for 10 s.
/// let grid = Grid::new([64, 64], [2e-3, 2e-3])?;
/// let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
/// let gap = undeformed_gap(&grid, &[sphere])?;
/// let creep = Creep { instantaneous: 1e-8, terms: vec![asperity::material::CreepTerm { compliance: 1e-8, retardation_time: 1.0 }], fluidity: 0.0 };
/// let loading = Loading { control: Control::Load, history: History::Step { value: 1.0 } };
/// let mut march = March::new(Simulation {
///     loading, creep,
///     times: TimeGrid::Uniform { end: 10.0, steps: 10 },
///     ..Simulation::new(grid, gap)
/// })?;
/// let mut approach = vec![];
/// while let Some(step) = march.advance()? {
///     approach.push(step.row().approach);
/// }
/// // Under a held load the approach grows as C(t)^(2/3): here by 2^(2/3).
/// assert!((approach[10] / approach[0] - 2f64.powf(2.0 / 3.0)).abs() < 0.01);
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct March {
    simulation: Simulation,
    instants: Vec<Instant>,
    operator: Box<dyn Operator>,
    solver: Solver,
    past: Past,
    /// Rows done.
    done: usize,
    /// The row that `state` belongs to.
    current: Option<usize>,
    state: ContactState,
    /// Pressure and U of the row before.
    previous: Previous,
    /// h0 + g of the last step.
    gap: Vec<f64>,
    /// Cut-off of each cell, where it is not the same everywhere.
    hardness: Option<Vec<f64>>,
    /// c of the last step.
    compliance: f64,
    /// Length of the step on the clock of each part of the creep function \[s\].
    lengths: Vec<f64>,
    outcome: Outcome,
    /// The permanent flattening, where there is any.
    dents: Option<Dents>,
    meter: Meter,
    interrupt: Option<Arc<AtomicBool>>,
}

struct Previous {
    pressure: Vec<f64>,
    unit_displacement: Vec<f64>,
}

/// The cut-off of each cell.
fn cap<'a>(simulation: &Simulation, of_cells: &'a Option<Vec<f64>>) -> Hardness<'a> {
    of_cells.as_deref().map_or(Hardness::Uniform(simulation.hardness), Hardness::Cells)
}

/// What the bodies remember.
enum Past {
    Memory(Memory),
    Direct(Direct),
}

impl Past {
    /// g of the step that ended last, which began with U = `before`.
    fn remembered(&self, before: &[f64], g: &mut [f64]) {
        match self {
            Past::Memory(m) => m.remembered(before, g),
            Past::Direct(d) => d.remembered(g),
        }
    }
}

/// Everything that the rest of a march depends on; see [`March::checkpoint`].
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Rows done.
    pub step: usize,
    /// Numbers that belong to the memory.
    pub scalars: Vec<f64>,
    /// Named fields of nx x ny cells.
    pub fields: Vec<(String, Array2<f64>)>,
}

impl March {
    /// Checks the simulation and plans it: operator, solver, memory, instants.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the quantity; [`Error::Infeasible`] where the load will exceed the
    /// hardness times the area that can touch.
    pub fn new(simulation: Simulation) -> Result<Self> {
        simulation.validate()?;
        let instants = simulation.instants();
        let operator = half_space(simulation.grid, simulation.boundary);
        let options = &simulation.solver;
        let solver = Solver::with_precision(options.method, options.precision, &*operator);
        let n = simulation.grid.len();
        let past = match simulation.scheme {
            Scheme::Direct => Past::Direct(Direct::new(&simulation.creep, &simulation.thermal)),
            scheme => Past::Memory(Memory::new(simulation.parts(), scheme, n)),
        };
        let branches = if let Past::Memory(memory) = &past { memory.branches() } else { 0 };
        let meter = Meter::new(simulation.columns()?, &simulation.grid, simulation.boundary, branches);
        let dents = Dents::new(&simulation);
        Ok(March {
            gap: simulation.gap.iter().copied().collect(),
            hardness: simulation.hardness_of_cells(),
            lengths: vec![0.0; simulation.parts().count()],
            simulation,
            instants,
            operator,
            solver,
            past,
            done: 0,
            current: None,
            state: ContactState::new(n),
            previous: Previous { pressure: vec![0.0; n], unit_displacement: vec![0.0; n] },
            compliance: 0.0,
            outcome: Outcome::default(),
            dents,
            meter,
            interrupt: None,
        })
    }

    /// Stops the march, within one iteration of the solver, when `flag` becomes true.
    pub fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }

    /// Number of rows in all.
    #[allow(clippy::len_without_is_empty)] // there is always the row at 0+
    pub fn len(&self) -> usize {
        self.instants.len()
    }

    /// The rows to come and gone: time, step, prescribed value.
    pub fn instants(&self) -> &[Instant] {
        &self.instants
    }

    /// Rows done.
    pub fn done(&self) -> usize {
        self.done
    }

    /// What is simulated.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The next row, or `None` at the end.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the time; [`March::last`] then lends the best state reached.
    /// [`Error::Undetermined`], [`Error::Interrupted`].
    pub fn advance(&mut self) -> Result<Option<Step<'_>>> {
        let Some(instant) = self.instants.get(self.done).copied() else {
            return Ok(None);
        };
        self.current = Some(self.done);
        self.measure_step(instant);
        self.meter.clear();
        let unit = &self.state.unit_displacement;
        let rigid = match &self.dents {
            Some(dents) => dents.gap(),
            None => self.simulation.gap.as_slice().unwrap_or_default(),
        };
        self.compliance = match &mut self.past {
            Past::Memory(m) => {
                m.history(&self.lengths, &self.previous.unit_displacement, unit, rigid, &mut self.gap)
            }
            Past::Direct(d) => d.history(instant.time, instant.dt, unit, rigid, &mut self.gap),
        };
        self.extrapolate();
        let area = self.simulation.grid.area();
        let problem = Problem {
            gap: &self.gap,
            compliance: self.compliance,
            hardness: cap(&self.simulation, &self.hardness),
            prescribed: match self.simulation.loading.control {
                crate::load::Control::Load => Prescribed::Load(instant.value),
                crate::load::Control::Pressure => Prescribed::Load(instant.value * area),
                crate::load::Control::Approach => Prescribed::Approach(instant.value),
            },
        };
        let options = &self.simulation.solver;
        let interrupt = self.interrupt.as_deref();
        match self.solver.solve(&mut *self.operator, &problem, options, &mut self.state, interrupt) {
            Ok(outcome) => self.outcome = outcome,
            Err(Error::NotConverged(mut report)) => {
                report.time = Some(instant.time);
                self.outcome = Outcome {
                    iterations: report.iterations,
                    residual: report.residual,
                    certificate: report.certificate,
                    ..Outcome::default()
                };
                return Err(Error::NotConverged(report));
            }
            Err(error) => return Err(error),
        }
        self.measure(instant.dt == 0.0)?;
        self.dent();
        self.done += 1;
        Ok(self.last())
    }

    /// How long the step is in laboratory time and on the clock of each body.
    fn measure_step(&mut self, instant: Instant) {
        let start = match self.done.checked_sub(1) {
            Some(before) => self.instants[before].time,
            None => instant.time,
        };
        let clocks = self.simulation.thermal.iter().map(|body| &body.clock);
        let clocked = clocks.map(|clock| clock.elapsed(start, instant.time));
        self.lengths.iter_mut().zip(std::iter::once(instant.dt).chain(clocked)).for_each(|(l, x)| *l = x);
    }

    /// The last row (after an error: the state that the failed solve reached); `None` before the first.
    pub fn last(&self) -> Option<Step<'_>> {
        let index = self.current?;
        Some(Step {
            index,
            instant: self.instants[index],
            simulation: &self.simulation,
            hardness: cap(&self.simulation, &self.hardness),
            state: &self.state,
            gap: &self.gap,
            compliance: self.compliance,
            outcome: self.outcome,
            past: &self.past,
            before: &self.previous.unit_displacement,
            dents: self.dents.as_ref(),
            meter: &self.meter,
        })
    }

    /// Starts the next solve from the last two pressures, prolonged linearly in time; after a jump from
    /// the last one.
    fn extrapolate(&mut self) {
        std::mem::swap(&mut self.state.pressure, &mut self.previous.pressure);
        std::mem::swap(&mut self.state.unit_displacement, &mut self.previous.unit_displacement);
        let dt = |n: usize| self.instants.get(n).map_or(0.0, |i| i.dt);
        let now = dt(self.done);
        let before = if self.done > 0 { dt(self.done - 1) } else { 0.0 };
        let factor = if before > 0.0 { (now / before).min(4.0) } else { 0.0 };
        // state.pressure holds the row before the last one.
        sweep((&mut self.state.pressure[..], &self.previous.pressure[..]), &|(p, last): (
            &mut [f64],
            &[f64],
        )| {
            for (p, last) in p.iter_mut().zip(last) {
                // A cell at zero stays there, so that the guess spreads no pressure.
                *p = if *last > 0.0 { last + factor * (last - *p) } else { 0.0 };
            }
        });
    }

    /// Everything that the rest of the march depends on. A march resumed from it gives the same bits.
    pub fn checkpoint(&self) -> Checkpoint {
        let shape = self.simulation.grid.shape();
        let field = |name: &str, cells: &[f64]| (name.to_string(), record::to_array(shape, cells));
        let mut fields = vec![
            field("pressure", &self.state.pressure),
            field("unit_displacement", &self.state.unit_displacement),
            field("previous_pressure", &self.previous.pressure),
            field("previous_unit_displacement", &self.previous.unit_displacement),
        ];
        if let Some(dents) = &self.dents {
            fields.push(field("dented_gap", dents.gap()));
        }
        let (mut scalars, memory) = match &self.past {
            Past::Memory(m) => m.save(),
            Past::Direct(d) => d.save(),
        };
        scalars.extend(self.meter.save());
        fields.extend(memory.iter().enumerate().map(|(k, cells)| field(&format!("memory_{k}"), cells)));
        Checkpoint { step: self.done, scalars, fields }
    }

    /// Goes on where a checkpoint of the same simulation was taken.
    ///
    /// # Errors
    /// As [`March::new`]; [`Error::Invalid`] where the checkpoint belongs to another simulation.
    pub fn resume(simulation: Simulation, checkpoint: &Checkpoint) -> Result<Self> {
        let mut march = March::new(simulation)?;
        let foreign = |what: String| Error::invalid("checkpoint", what, "one of this simulation");
        if checkpoint.step > march.instants.len() {
            return Err(foreign(format!("{} rows of {}", checkpoint.step, march.instants.len())));
        }
        let mut fields = checkpoint.fields.iter();
        let mut next = |name: &str| -> Result<Vec<f64>> {
            match fields.next() {
                Some((found, cells)) if found == name && cells.dim() == march.simulation.grid.shape() => {
                    Ok(cells.iter().copied().collect())
                }
                Some((found, cells)) => Err(foreign(format!("field {found} of shape {:?}", cells.dim()))),
                None => Err(foreign(format!("without field {name}"))),
            }
        };
        march.state.pressure = next("pressure")?;
        march.state.unit_displacement = next("unit_displacement")?;
        march.previous.pressure = next("previous_pressure")?;
        march.previous.unit_displacement = next("previous_unit_displacement")?;
        let mut others = 4;
        if let Some(dents) = &mut march.dents {
            dents.restore(next("dented_gap")?);
            others += 1;
        }
        let memory = (0..checkpoint.fields.len().saturating_sub(others))
            .map(|k| next(&format!("memory_{k}")))
            .collect::<Result<Vec<_>>>()?;
        let Some(scalars) = march.meter.load(&checkpoint.scalars) else {
            return Err(foreign("one without the energies asked for".into()));
        };
        let restored = match &mut march.past {
            Past::Memory(m) => m.load(scalars, &memory),
            Past::Direct(d) => d.load(scalars, memory),
        };
        if !restored {
            return Err(foreign("a memory of another material or scheme".into()));
        }
        march.done = checkpoint.step;
        Ok(march)
    }
}
