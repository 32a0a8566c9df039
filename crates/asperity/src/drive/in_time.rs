//! The march through time: one elastic contact per step.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use asperity_sweep::in_pool;

use super::{Coordinate, Drive};
use crate::error::{Error, Result, require};
use crate::load::Stage;
use crate::quantities::{Column, RowNumber};
use crate::simulation::Simulation;
use crate::step::{Checkpoint, Loader, Proposal, Recorder, Saver, Schedule, Step, Stepper, Summary};
use crate::time::Instant;

/// A simulation on its way through time.
///
/// ```
/// use asperity::{drive::March, material::Creep, surface::{Part, Shape, undeformed_gap}, *};
/// // A sphere of 10 mm on an incompressible Zener solid, 1 N held for 10 s.
/// let grid = Grid::new([64, 64], [2e-3, 2e-3])?;
/// let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
/// let gap = undeformed_gap(&grid, &[sphere])?;
/// let creep = Creep { instantaneous: 1e-8, terms: vec![asperity::material::CreepTerm { compliance: 1e-8, retardation_time: 1.0 }], fluidity: 0.0 };
/// let loading = Loading { control: Control::Load, history: History::Step { value: 1.0 } };
/// let mut march = March::new(Simulation {
///     loading: loading.into(), creep,
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
    simulation: Arc<Simulation>,
    pub(crate) schedule: Schedule,
    pub(crate) stepper: Stepper,
    recorder: Recorder,
    /// The number that the stage under way waits for.
    gauge: Gauge,
    /// Its value in the last row; `None` where the stage of that waits for none.
    awaited: Option<f64>,
    /// Rows done.
    done: usize,
    /// The row that the state belongs to: its number, its instant, its estimated error.
    row: Option<(usize, Instant, Option<f64>)>,
}

impl March {
    /// Checks the simulation and plans it: operator, solver, history, schedule.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the quantity; [`Error::Infeasible`] where the load will exceed the
    /// hardness times the area that can touch.
    pub fn new(simulation: Simulation) -> Result<Self> {
        simulation.validate()?;
        let of_motion = simulation.quantities.list.iter().find(|quantity| quantity.is_of_motion());
        if let (Some(quantity), None) = (of_motion, &simulation.motion) {
            return Err(Error::invalid("quantity of a contact that does not move", quantity, "another one"));
        }
        if simulation.flash.is_some() && simulation.motion.is_none() {
            return Err(
                Error::invalid("heat of friction", "given", "that of a contact in motion").of("flash")
            );
        }
        let simulation = Arc::new(simulation);
        Ok(March {
            schedule: Schedule::new(&simulation),
            recorder: Recorder::new(simulation.columns()?),
            stepper: Stepper::new(simulation.clone())?,
            gauge: Gauge::default(),
            awaited: None,
            done: 0,
            row: None,
            simulation,
        })
    }

    /// Goes on where a checkpoint of the same simulation was taken.
    ///
    /// # Errors
    /// As [`March::new`]; [`Error::Invalid`] where the checkpoint belongs to another simulation.
    pub fn resume(simulation: Simulation, checkpoint: &Checkpoint) -> Result<Self> {
        let mut march = March::new(simulation)?;
        let from = &mut Loader::new(checkpoint, march.simulation.grid.shape());
        from.within("schedule", |from| march.schedule.load(from))?;
        from.within("step", |from| march.stepper.load(from))?;
        march.done = checkpoint.step;
        Ok(march)
    }

    fn accept(&mut self, attempt: &Summary) -> Result<()> {
        self.row = Some((self.done, attempt.instant, None));
        self.stepper.accept()?;
        self.row = Some((self.done, attempt.instant, self.stepper.time_error()));
        self.awaited = self.schedule.awaited().map(|_| attempt.number);
        let mut recorder = std::mem::take(&mut self.recorder);
        self.last().iter().for_each(|step| step.record(&mut recorder));
        self.recorder = recorder;
        self.schedule.accept(attempt);
        self.note();
        self.done += 1;
        Ok(())
    }

    /// Tells the schedule the number that it waits for, of the last row or of the bodies before t = 0.
    fn note(&mut self) {
        if let Some(number) = self.schedule.awaited() {
            self.schedule.number = self.gauge.read(number, &self.stepper.row());
        }
    }
}

impl Drive for March {
    fn advance(&mut self) -> Result<Option<Step<'_>>> {
        if let Some(piece) = self.schedule.piece()
            && let Some(first) = self.stepper.first_step(&piece)
        {
            self.schedule.restart(first);
        }
        let mut step = match self.schedule.propose()? {
            Proposal::Try(step) => step,
            Proposal::Done(reason) => return reason.outcome(self.simulation.times.end()).map(|()| None),
        };
        if self.done == 0 {
            self.note();
        }
        self.stepper.begin();
        self.recorder.clear();
        let attempt = loop {
            self.row = Some((self.done, step.instant, None));
            let mut attempt = match in_pool(|| self.stepper.attempt(&step)) {
                Err(error @ (Error::PulledOff { .. } | Error::NotConverged(_))) => {
                    let is_known = matches!(error, Error::PulledOff { .. });
                    step = self.schedule.retreat(&step, is_known).ok_or(error)?;
                    continue;
                }
                attempt => attempt?,
            };
            if let Some(number) = self.schedule.awaited() {
                attempt.number = self.gauge.preview(number, &mut self.stepper)?;
            }
            match self.schedule.assess(&step, &attempt) {
                Some(next) => step = next,
                None => break attempt,
            }
        };
        in_pool(|| self.accept(&attempt))?;
        Ok(self.last())
    }

    fn last(&self) -> Option<Step<'_>> {
        let (index, instant, time_error) = self.row?;
        let of_stepper = self.stepper.row();
        Some(Step {
            index,
            coordinate: Coordinate::Time(instant.time),
            instant: Some(instant),
            control: instant.control,
            time_error,
            awaited: self.awaited,
            recorder: Some(&self.recorder),
            ..of_stepper
        })
    }

    fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    fn planned(&self) -> Vec<f64> {
        self.simulation.plan().instants.iter().map(|instant| instant.time).collect()
    }

    fn prescribe(&mut self, stage: Stage) -> Result<()> {
        self.simulation.validate_prescribed(&stage)?;
        let time = self.row.map_or(0.0, |(_, instant, _)| instant.time);
        let expected = "after the first row of a run, and before its last one";
        require(self.schedule.prescribe(stage), "time of what is prescribed", format!("{time} s"), expected)?;
        self.note();
        Ok(())
    }

    /// Without events, adaptive steps, and stages prescribed between rows.
    fn rows_expected(&self) -> Option<usize> {
        let plan = self.simulation.plan();
        (plan.exact && !self.schedule.is_steered()).then_some(plan.instants.len())
    }

    fn done(&self) -> usize {
        self.done
    }

    fn finished(&self) -> bool {
        self.schedule.finished()
    }

    fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        self.stepper.interrupt_with(flag);
    }

    fn checkpoint(&self) -> Checkpoint<'_> {
        let mut to = Saver::new(self.done, self.simulation.grid.shape());
        to.within("schedule", |to| self.schedule.save(to));
        to.within("step", |to| self.stepper.save(to));
        to.finish()
    }
}

/// Reads a single number of a row.
#[derive(Default)]
struct Gauge {
    /// For the quantity read last.
    recorder: Recorder,
}

impl Gauge {
    /// Of an attempt.
    fn preview(&mut self, number: RowNumber, stepper: &mut Stepper) -> Result<f64> {
        if let RowNumber::Quantity(quantity) = number
            && let Some(value) = stepper.preview(quantity)?
        {
            return Ok(value);
        }
        Ok(self.read(number, &stepper.row()))
    }

    /// Of a row that stands.
    fn read(&mut self, number: RowNumber, row: &Step<'_>) -> f64 {
        match number {
            RowNumber::Column(column) => column.of(&row.row()),
            RowNumber::Quantity(quantity) => {
                if self.recorder.of(quantity).is_none() {
                    self.recorder = Recorder::new(vec![Column { quantity, edges: vec![] }]);
                }
                row.record(&mut self.recorder);
                self.recorder.of(quantity).map_or(f64::NAN, |values| values[0])
            }
        }
    }
}
