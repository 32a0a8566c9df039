//! One step: the elastic contact that the end of a time step is.
//!
//! Space and time separate: u(x, t) = integral C(t - s) d(Kp)(x, s). With U = Kp, a step from t_n to t_(n+1) leaves
//! u_(n+1) = c U_(n+1) + g, where the number c and the field g are known before the solve (docs/theory.md, section 5). So the step
//! is the elastic contact with compliance c and undeformed gap h0 + g, and the past costs no convolution.
//!
//! ```text
//! attempt(step):   processes move the gap h0;  history gives c and g;  guess;  solve the contact of c, h0 + g
//! accept:          history closes the step;  processes take in the row
//! ```
//!
//! An attempt can be repeated at any length until one is accepted. The stepper knows the seams only: what the bodies remember is
//! a `History`, what else goes on a `Process`, when the steps are the `Schedule`'s matter.

mod contact;
mod dense;
mod event;
mod interval;
mod quantities;
mod row;
mod schedule;
mod snapshot;
mod step_size;
mod touch;
mod undeformed;
mod warm_start;

pub use dense::Between;
pub use row::{Row, Step};
pub use snapshot::Checkpoint;

pub(crate) use interval::{Interval, Load, Piece};
pub(crate) use quantities::Recorder;
pub(crate) use row::{PERIMETER_SHARE, Recalled};
pub(crate) use schedule::{Proposal, Response, Schedule, Summary, Verdict};
pub(crate) use snapshot::{Loader, Saver};
pub(crate) use undeformed::UndeformedGap;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::contact::{ContactState, Outcome, Prescribed};
use crate::drive::Coordinate;
use crate::error::{Error, Result};
use crate::history::{self, Ends, History, Law};
use crate::load::Control;
use crate::operator::plan;
use crate::process::{self, Process, Solved};
use crate::simulation::Simulation;
use asperity_sweep::{minimum, sum};
use contact::StepContact;

pub(crate) struct Stepper {
    simulation: Arc<Simulation>,
    history: Box<dyn History>,
    contact: StepContact,
    processes: Vec<Box<dyn Process>>,
    undeformed: UndeformedGap,
    /// The state of the attempt, and that of the last row.
    now: ContactState,
    before: ContactState,
    /// h0 + g and c of the attempt.
    gap: Vec<f64>,
    compliance: f64,
    /// Loads of the last row and of the attempt \[N\].
    loads: [f64; 2],
    /// Length of the last row's step \[s\], and whether its bodies touched.
    last_length: f64,
    touched: bool,
    /// The step of the attempt; whether the history has it open, and the length of the attempt solved last.
    step: Option<Interval>,
    is_open: bool,
    tried: Option<f64>,
    outcome: Outcome,
}

impl Stepper {
    /// Plans operator, solver, history and processes.
    ///
    /// # Errors
    /// [`Error::Invalid`] where one of them cannot be planned.
    pub(crate) fn new(simulation: Arc<Simulation>) -> Result<Self> {
        let operator = plan(simulation.grid, simulation.boundary, simulation.kernel.clone())?;
        let mut history = history::of(&simulation)?;
        let n = simulation.grid.len();
        Ok(Stepper {
            processes: process::of(&simulation, &*operator, &mut *history)?,
            history,
            contact: StepContact::new(&simulation, operator),
            undeformed: UndeformedGap::of(&simulation),
            now: ContactState::new(n),
            before: ContactState::new(n),
            gap: simulation.gap.iter().copied().collect(),
            compliance: 0.0,
            loads: [0.0; 2],
            last_length: 0.0,
            touched: false,
            step: None,
            is_open: false,
            tried: None,
            outcome: Outcome::default(),
            simulation,
        })
    }

    pub(crate) fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        self.contact.interrupt = Some(flag);
    }

    /// How long the first step of a smooth piece may be \[s\].
    pub(crate) fn first_step(&mut self, piece: &Piece) -> Option<f64> {
        self.history.first_step(piece)
    }

    /// A new row: what was tried and spent for the last one is forgotten.
    pub(crate) fn begin(&mut self) {
        self.outcome = Outcome::default();
    }

    /// Solves the contact at the end of a step; can be repeated at other lengths.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the time, and the errors of the contact.
    pub(crate) fn attempt(&mut self, step: &Interval) -> Result<Summary> {
        let third = if self.is_open { None } else { self.history.third_state(step) };
        let Some(third) = third else { return self.solve(step) };
        let first = self.solve(&step.share(third.at))?;
        if self.is_apart() && third.step < third.at {
            // Nothing presses: the step has no error.
            return Ok(first);
        }
        if !self.is_apart() {
            self.history.keep_as_third(&ends(
                &self.before,
                &self.now,
                self.loads,
                &self.gap,
                &self.undeformed,
            ));
        }
        match third.step == 1.0 {
            true => self.solve(step),
            false => self.solve(&step.of_length(third.step / third.at * first.instant.dt)),
        }
    }

    fn solve(&mut self, step: &Interval) -> Result<Summary> {
        let step = self.set(step)?;
        let (step, is_turn) = self.locate_touch(step)?;
        let prescribed = step.prescribed(self.simulation.grid.area());
        let start = self.guess(&step, prescribed);
        self.step = Some(step.clone());
        let spent = self.outcome;
        match self.contact.solve(start, &self.gap, self.compliance, prescribed, &mut self.now) {
            // The work of all attempts at a row is its work.
            Ok(outcome) => {
                self.outcome = Outcome {
                    iterations: spent.iterations + outcome.iterations,
                    convolutions: spent.convolutions + outcome.convolutions,
                    ..outcome
                }
            }
            Err(Error::NotConverged(mut report)) => {
                report.time = Some(step.instant.time);
                let (iterations, residual, certificate) =
                    (report.iterations, report.residual, report.certificate);
                self.outcome = Outcome { iterations, residual, certificate, ..Outcome::default() };
                return Err(Error::NotConverged(report));
            }
            Err(error) => return Err(error),
        }
        Ok(self.summary(&step, prescribed, is_turn))
    }

    /// Opens the step, or opens it again: moves the gap, and sets compliance, gap and operator.
    fn set(&mut self, step: &Interval) -> Result<Interval> {
        for process in &mut self.processes {
            process.open(step, &mut self.undeformed)?;
        }
        let step = step.under(self.load_over(step));
        let rigid = self.undeformed.now();
        let law = match self.is_open {
            true => self.history.reopen(&step, rigid, &mut self.gap)?,
            false => {
                let law = self.history.open(&step, &self.now, rigid, &mut self.gap)?;
                std::mem::swap(&mut self.now, &mut self.before);
                (self.is_open, self.tried) = (true, None);
                law
            }
        };
        self.obey(law);
        Ok(step)
    }

    /// Opens the step under way again, under another load or at another length.
    fn reset(&mut self, step: &Interval) -> Result<()> {
        for process in &mut self.processes {
            process.open(step, &mut self.undeformed)?;
        }
        let law = self.history.reopen(step, self.undeformed.now(), &mut self.gap)?;
        self.obey(law);
        Ok(())
    }

    fn obey(&mut self, law: Law) {
        self.compliance = law.compliance;
        self.contact.take_operator(law.operator);
    }

    /// What is known of the pressure over a step.
    fn load_over(&self, step: &Interval) -> Load {
        let is_apart = self.history.recovers_in_one_step() && !self.touched && !self.contact.pulls();
        match step.prescribed(self.simulation.grid.area()) {
            Prescribed::Load(load) if is_apart && load == 0.0 => Load::Apart,
            // Where the gap moves, displacements run with it, in time, whatever the load does.
            Prescribed::Load(_) if self.shift(step).is_some() => Load::Approach,
            Prescribed::Load(load) => Load::Total(load),
            Prescribed::Approach(_) if is_apart => Load::Apart,
            Prescribed::Approach(w) if w == step.held_from => Load::Held,
            Prescribed::Approach(_) => Load::Approach,
        }
    }

    /// Whether the step under way has no pressure at either end.
    fn is_apart(&self) -> bool {
        self.step.as_ref().is_some_and(|step| step.load == Load::Apart)
    }

    /// Cells that the gap moves in a step, where it moves.
    fn shift(&self, step: &Interval) -> Option<[isize; 2]> {
        self.processes.iter().find_map(|process| process.shift(step))
    }

    fn summary(&mut self, step: &Interval, prescribed: Prescribed, is_turn: bool) -> Summary {
        let carried = sum(&self.now.pressure) * self.simulation.grid.cell_area();
        self.loads[1] = match prescribed {
            Prescribed::Load(load) => load,
            Prescribed::Approach(_) => carried,
        };
        let ends = ends(&self.before, &self.now, self.loads, &self.gap, &self.undeformed);
        self.tried = Some(step.length());
        Summary {
            instant: step.instant,
            error: self.history.error(step, &ends),
            is_turn,
            touches: self.now.touches(),
            pulls: self.contact.pulls(),
            reached: Response { approach: self.now.approach, load: carried },
            first_touch: minimum(&self.gap),
        }
    }

    /// The attempt stands: the history closes the step, the processes take in the row.
    ///
    /// # Errors
    /// Those of the processes.
    pub(crate) fn accept(&mut self) -> Result<()> {
        let Some(step) = &self.step else { return Ok(()) };
        let ends = ends(&self.before, &self.now, self.loads, &self.gap, &self.undeformed);
        self.history.close(&ends)?;
        let exchange = self.history.exchange(&ends);
        self.contact.commit();
        let (operator, hardness, interrupt) = self.contact.parts();
        let mut row = Solved {
            simulation: &self.simulation,
            step,
            before: &self.before,
            now: &self.now,
            loads: self.loads,
            gap: &mut self.gap,
            undeformed: &mut self.undeformed,
            compliance: self.compliance,
            hardness,
            operator,
            interrupt,
            exchange,
            other_work: 0.0,
            convolutions: 0,
        };
        for process in &mut self.processes {
            process.accept(&mut row)?;
        }
        self.outcome.convolutions += row.convolutions;
        self.loads[0] = self.loads[1];
        self.last_length = step.length();
        self.touched = self.now.touches();
        self.is_open = false;
        Ok(())
    }

    fn ends(&self) -> Ends<'_> {
        ends(&self.before, &self.now, self.loads, &self.gap, &self.undeformed)
    }

    /// The state as a row of no time yet.
    pub(crate) fn state(&self) -> Step<'_> {
        Step {
            index: 0,
            coordinate: Coordinate::None,
            instant: None,
            control: Control::Load,
            simulation: &self.simulation,
            hardness: self.contact.hardness(),
            state: &self.now,
            gap: &self.gap,
            compliance: self.compliance,
            outcome: self.outcome,
            recalled: Recalled::History(&*self.history),
            time_error: None,
            undeformed: Some(&self.undeformed),
            processes: &self.processes,
            recorder: None,
            friction: None,
        }
    }

    /// Saves the state after the last row.
    pub(crate) fn save<'a>(&'a self, to: &mut Saver<'a>) {
        to.field("pressure", &self.now.pressure);
        to.field("unit_displacement", &self.now.unit_displacement);
        to.field("previous_pressure", &self.before.pressure);
        to.field("previous_unit_displacement", &self.before.unit_displacement);
        to.numbers("approach", vec![self.now.approach, self.before.approach]);
        to.numbers("rounding", vec![self.now.rounding, self.before.rounding]);
        to.numbers("last", vec![self.loads[0], self.last_length]);
        to.within("history", |to| self.history.save(to));
        to.number("processes", self.processes.len() as f64);
        for process in &self.processes {
            to.within(process.name(), |to| {
                to.number("is_on", 1.0);
                process.save(to, &self.undeformed);
            });
        }
    }

    /// Takes back what [`save`](Self::save) gave.
    ///
    /// # Errors
    /// [`Error::Invalid`] where it belongs to another simulation.
    pub(crate) fn load(&mut self, from: &mut Loader<'_>) -> Result<()> {
        from.field_into("pressure", &mut self.now.pressure)?;
        from.field_into("unit_displacement", &mut self.now.unit_displacement)?;
        from.field_into("previous_pressure", &mut self.before.pressure)?;
        from.field_into("previous_unit_displacement", &mut self.before.unit_displacement)?;
        [self.now.approach, self.before.approach] = from.array("approach")?;
        [self.now.rounding, self.before.rounding] = from.array("rounding")?;
        [self.loads[0], self.last_length] = from.array("last")?;
        self.touched = self.now.touches();
        if from.number("processes")? != self.processes.len() as f64 {
            return Err(from.foreign("other quantities or processes"));
        }
        for process in &mut self.processes {
            from.within(process.name(), |from| {
                from.number("is_on")?;
                process.load(from, &mut self.undeformed)
            })?;
        }
        from.within("history", |from| self.history.load(from))
    }
}

/// Both ends of the step of an attempt.
fn ends<'a>(
    before: &'a ContactState,
    now: &'a ContactState,
    loads: [f64; 2],
    gap: &'a [f64],
    undeformed: &'a UndeformedGap,
) -> Ends<'a> {
    Ends { before, now, loads, gap, rigid: undeformed.now() }
}
