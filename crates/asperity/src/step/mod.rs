//! One step: the elastic contact that the end of a time step is.
//!
//! Space and time separate: u(x, t) = integral C(t - s) d(Kp)(x, s). With U = Kp, a step from t_n to t_(n+1) leaves
//! u_(n+1) = c U_(n+1) + g, where the number c and the field g are known before the solve (docs/theory.md, section 5). So the step
//! is the elastic contact with compliance c and undeformed gap h0 + g, and the past costs no convolution.
//!
//! ```text
//! attempt(step):   processes move the gap h0;  history gives c and g;  guess;  solve the contact of c, h0 + g
//! accept:          processes prepare the row;  history closes the step;  processes take in the row
//! ```
//!
//! An attempt can be repeated at any length until one is accepted. The stepper knows the seams only: what the bodies remember is
//! a `History`, what else goes on a `Process`, when the steps are the `Schedule`'s matter.

mod contact;
mod coupled;
mod event;
mod imposed;
mod interval;
mod quantities;
mod row;
mod schedule;
mod snapshot;
mod state;
mod step_size;
mod touch;
mod undeformed;
mod warm_start;

pub use row::{Row, Step};
pub use snapshot::Checkpoint;

pub(crate) use contact::StepContact;
use coupled::Coupled;
pub(crate) use interval::{Course, Interval, Load, Piece, prescribed};
pub(crate) use quantities::Recorder;
pub(crate) use row::{EnergyBalance, PERIMETER_SHARE};
pub(crate) use schedule::{Proposal, Response, Schedule, Summary};
pub(crate) use snapshot::{Loader, Saved, Saver, saved};
pub(crate) use undeformed::UndeformedGap;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::contact::{Hardness, Outcome};
use crate::error::{Error, Result};
use crate::history::{self, History, Law, ThirdState};
use crate::operator::plan;
use crate::process::{self, Process, Solved};
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::traction::TractionSolver;
use asperity_sweep::is_zero;
use state::StepState;

pub(crate) struct Stepper {
    simulation: Arc<Simulation>,
    history: Box<dyn History>,
    contact: StepContact,
    processes: Vec<Box<dyn Process>>,
    state: StepState,
    /// What a process adds to the displacement under the pressure; `None` where none does.
    coupled: Option<Coupled>,
    /// The step of the attempt; whether the history has it open, and the length of the attempt solved last.
    step: Option<Interval>,
    is_open: bool,
    /// The state that is solved before the first attempt at the row, and whether the next attempt is the first one.
    third: Option<ThirdState>,
    is_first: bool,
    tried: Option<f64>,
    /// The work of all attempts at the row, and how good the last one is.
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
        let processes = process::of(&simulation, &*operator, &mut *history)?;
        Ok(Stepper {
            coupled: Coupled::of(&processes, simulation.grid.len()),
            processes,
            state: StepState::new(&simulation, history.remembers()),
            history,
            contact: StepContact::new(&simulation, operator),
            step: None,
            is_open: false,
            third: None,
            is_first: true,
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

    /// A new row, or one that was interrupted, from its first attempt on: what was spent before is forgotten.
    pub(crate) fn begin(&mut self) {
        self.outcome = Outcome::default();
        self.is_first = true;
    }

    /// Solves the contact at the end of a step; can be repeated at other lengths.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the time, and the errors of the contact.
    pub(crate) fn attempt(&mut self, step: &Interval) -> Result<Summary> {
        if !self.is_open {
            self.third = self.history.third_state(step);
        }
        let is_first = std::mem::take(&mut self.is_first);
        let Some(third) = self.third.filter(|_| is_first) else { return self.solve(step) };
        let first = self.solve(&step.share(third.at))?;
        if !self.is_apart() {
            self.history.keep_as_third(&self.state.ends(&self.contact));
        } else if third.step < third.at {
            // Nothing presses: the step has no error.
            return Ok(first);
        }
        match third.step == 1.0 {
            true => self.solve(step),
            false => self.solve(&step.of_length(third.step / third.at * first.instant.dt)),
        }
    }

    /// Whether the surfaces are in contact in the attempt.
    fn touches(&self) -> bool {
        let [_, now] = self.contact.pressures([&self.state.before, &self.state.now]);
        !is_zero(now)
    }

    fn solve(&mut self, step: &Interval) -> Result<Summary> {
        let step = self.open(step)?;
        let (step, is_turn) = self.locate_touch(step)?;
        let prescribed = step.prescribed(self.simulation.grid.area());
        let start = self.guess(&step, prescribed);
        self.step = Some(step.clone());
        self.contact.begin(&step.instant);
        let solved = self.solve_contact(start, prescribed);
        let outcome = solved.map_err(|error| self.failed(error.at(step.instant.time)))?;
        self.outcome = self.outcome.then(outcome);
        let StepState { undeformed, before, now, own_gap, .. } = &mut self.state;
        let [_, pressure] = self.contact.pressures([before, now]);
        undeformed.recede(pressure, own_gap);
        let carried = self.state.meet(prescribed);
        self.tried = Some(step.length());
        Ok(Summary {
            instant: step.instant,
            error: self.error(&step),
            is_turn,
            touches: self.touches(),
            pulls: self.contact.pulls(),
            reached: Response { approach: self.state.now.approach, load: carried },
            number: f64::NAN,
            first_touch: self.state.first_touch(),
        })
    }

    /// Keeps what is known of an attempt that failed.
    fn failed(&mut self, mut error: Error) -> Error {
        match &mut error {
            Error::NotConverged(report) => self.outcome = report.outcome(),
            Error::PulledOff { last, .. } => {
                let StepState { before, now, loads, .. } = &mut self.state;
                *last = (!is_zero(&before.pressure)).then_some([loads[0], before.approach]);
                // The best state is that of the last row.
                now.clone_from(before);
            }
            _ => {}
        }
        error
    }

    /// Estimated error of the stress that the step adds, relative: the largest that history and processes know.
    fn error(&mut self, step: &Interval) -> Option<f64> {
        let ends = self.state.ends(&self.contact);
        let of_history = self.history.error(step, &ends);
        let StepState { undeformed, compliance, .. } = &self.state;
        let of_processes =
            self.processes.iter().filter_map(|process| process.error(&ends, undeformed, *compliance));
        of_processes.chain(of_history).reduce(f64::max)
    }

    /// Opens the step, or opens it again: moves the gap, and sets compliance, gap and operator.
    fn open(&mut self, step: &Interval) -> Result<Interval> {
        let step = step.under(self.load_over(step));
        if self.is_open {
            self.reopen(&step)?;
            return Ok(step);
        }
        self.state.undeformed.begin(self.moves(&step));
        self.move_gap(&step)?;
        let StepState { now, before, own_gap, undeformed, .. } = &mut self.state;
        let law = self.history.open(&step, now, undeformed.now(), own_gap)?;
        std::mem::swap(now, before);
        (self.is_open, self.tried) = (true, None);
        self.obey(law);
        Ok(step)
    }

    /// Opens the step under way again, under another load or at another length.
    fn reopen(&mut self, step: &Interval) -> Result<()> {
        self.move_gap(step)?;
        let StepState { own_gap, undeformed, .. } = &mut self.state;
        let law = self.history.reopen(step, undeformed.now(), own_gap)?;
        self.obey(law);
        Ok(())
    }

    fn move_gap(&mut self, step: &Interval) -> Result<()> {
        self.processes.iter_mut().try_for_each(|process| process.open(step, &mut self.state.undeformed))
    }

    fn obey(&mut self, law: Law) {
        self.state.compliance = law.compliance;
        self.contact.take_operator(law.operator);
    }

    /// Estimated error of the stress at the last row, relative.
    pub(crate) fn time_error(&self) -> Option<f64> {
        self.history.time_error()
    }

    /// A quantity at the end of the attempt, of a process; `None` where it is one of the state.
    ///
    /// # Errors
    /// Those of the processes.
    pub(crate) fn preview(&mut self, quantity: Quantity) -> Result<Option<f64>> {
        let Some(step) = &self.step else { return Ok(None) };
        let mut row = solved(&self.simulation, step, &mut self.state, &mut self.contact);
        for process in &mut self.processes {
            if let Some(value) = process.preview(quantity, &mut row)? {
                self.outcome.convolutions += row.convolutions;
                return Ok(Some(value));
            }
        }
        Ok(None)
    }

    /// The attempt stands: the history closes the step, the processes take in the row. All or nothing: what can fail runs first, and
    /// an attempt that could not be taken in can be tried again.
    ///
    /// # Errors
    /// Those of the processes.
    pub(crate) fn accept(&mut self) -> Result<()> {
        let Some(step) = &self.step else { return Ok(()) };
        let mut row = solved(&self.simulation, step, &mut self.state, &mut self.contact);
        self.processes.iter_mut().try_for_each(|process| process.prepare(&mut row))?;
        self.outcome.convolutions += row.convolutions;
        self.history.close(&self.state.ends(&self.contact));
        let exchange = self.history.exchange(&self.state.ends(&self.contact));
        let time_error = self.history.time_error();
        let mut row = Solved {
            time_error,
            exchange,
            ..solved(&self.simulation, step, &mut self.state, &mut self.contact)
        };
        self.processes.iter_mut().for_each(|process| process.accept(&mut row));
        self.contact.commit();
        let (length, touches) = (step.length(), self.touches());
        self.state.end(length, touches);
        self.is_open = false;
        Ok(())
    }
}

/// What was solved, for the processes; what the history knows of it is not filled in.
fn solved<'a>(
    simulation: &'a Simulation,
    step: &'a Interval,
    state: &'a mut StepState,
    contact: &'a mut StepContact,
) -> Solved<'a> {
    let StepContact { operator, hardness, traction, interrupt, .. } = contact;
    let StepState { now, before, loads, own_gap, undeformed, compliance, .. } = state;
    let (now, before) = (&*now, &*before);
    let traction = traction.as_ref();
    let [contact_before, contact] = traction.map_or([before, now], TractionSolver::contacts);
    let cut_off = traction.and_then(TractionSolver::cut_off);
    let potential = traction
        .and_then(|traction| traction.quantity(Quantity::AdhesionEnergy, simulation.grid.cell_area()));
    Solved {
        simulation,
        step,
        before,
        contact,
        contact_before,
        potential: potential.unwrap_or(0.0),
        now,
        loads: *loads,
        own_gap,
        undeformed,
        compliance: *compliance,
        hardness: cut_off.map_or(hardness.lent(), Hardness::Cells),
        operator: &mut **operator,
        interrupt: interrupt.as_deref(),
        time_error: None,
        exchange: None,
        other_work: 0.0,
        unknown_work: 0.0,
        worn_work: 0.0,
        slipped: vec![],
        convolutions: 0,
    }
}

#[cfg(test)]
mod tests;
