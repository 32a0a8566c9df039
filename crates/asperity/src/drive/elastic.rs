//! Elastic contacts: each load or approach a row, and no time between them.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use asperity_sweep::in_pool;

use super::Drive;
use crate::contact::{ContactState, Outcome, Start};
use crate::error::{Error, Result, require};
use crate::load::{Control, History, Loading};
use crate::operator::{Operator, plan};
use crate::simulation::Simulation;
use crate::step::{Checkpoint, Recorder, Saver, Step, StepContact, prescribed};

/// Contacts of bodies that respond with their instantaneous compliance C(0+), one after the other. Of the simulation count the grid, the
/// body, the gap, the hardness and the solver.
///
/// ```
/// use asperity::{drive::Elastic, material::Creep, surface::{Part, Shape, undeformed_gap}, *};
/// // A sphere of 10 mm on an elastic body: the approach grows as W^(2/3) (Hertz).
/// let grid = Grid::new([64, 64], [2e-3, 2e-3])?;
/// let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
/// let gap = undeformed_gap(&grid, &[sphere])?;
/// let simulation = Simulation { creep: Creep::elastic(1e-8), ..Simulation::new(grid, gap) };
/// let mut contacts = Elastic::new(simulation, [(Control::Load, 1.0), (Control::Load, 2.0)])?;
/// let mut approach = vec![];
/// while let Some(step) = contacts.advance()? {
///     approach.push(step.row().approach);
/// }
/// assert!((approach[1] / approach[0] - 2f64.powf(2.0 / 3.0)).abs() < 0.01);
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct Elastic {
    simulation: Simulation,
    contact: StepContact,
    recorder: Recorder,
    /// What is prescribed in the rows to come.
    asked: VecDeque<(Control, f64)>,
    done: usize,
    /// The number of the row that the state belongs to.
    row: Option<usize>,
    control: Control,
    /// The last state; the next row is solved from its pressure.
    state: ContactState,
    outcome: Outcome,
}

impl Elastic {
    /// Plans the contacts: loads \[N\], mean pressures \[Pa\] or approaches \[m\].
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the quantity.
    pub fn new(simulation: Simulation, asked: impl IntoIterator<Item = (Control, f64)>) -> Result<Self> {
        simulation.validate()?;
        let expected = "none in elastic contacts of no time: friction is incremental";
        require(simulation.tangential.is_none(), "tangential load", "given", expected)?;
        let operator = plan(simulation.grid, simulation.boundary, simulation.kernel.clone())?;
        Ok(Elastic {
            contact: StepContact::new(&simulation, operator),
            recorder: Recorder::new(simulation.columns()?),
            asked: asked.into_iter().collect(),
            done: 0,
            row: None,
            control: Control::Load,
            state: ContactState::new(simulation.grid.len()),
            outcome: Outcome::default(),
            simulation,
        })
    }

    /// One row more, after those that are asked for; the next one is solved from the pressure `start` \[Pa\].
    pub fn ask(&mut self, control: Control, value: f64, start: &[f64]) {
        self.asked.push_back((control, value));
        self.state.pressure.copy_from_slice(start);
    }

    /// The operator of the body.
    pub fn operator(&mut self) -> &mut dyn Operator {
        &mut *self.contact.operator
    }

    /// The last state as a row.
    fn row(&self) -> Step<'_> {
        let bodies = (self.simulation.gap_cells(), self.simulation.instantaneous());
        Step {
            index: self.row.unwrap_or_default(),
            control: self.control,
            recorder: Some(&self.recorder),
            ..Step::of(&self.simulation, self.contact.hardness(), (&self.state, self.outcome), bodies)
        }
    }
}

impl Drive for Elastic {
    fn advance(&mut self) -> Result<Option<Step<'_>>> {
        let Some((control, value)) = self.asked.pop_front() else { return Ok(None) };
        self.control = control;
        self.row = Some(self.done);
        self.recorder.clear();
        self.simulation.loading = Loading { control, history: History::Step { value } }.into();
        let (gap, compliance) = (self.simulation.gap_cells(), self.simulation.instantaneous());
        let prescribed = prescribed(control, value, self.simulation.grid.area());
        let solved =
            in_pool(|| self.contact.solve(Start::Pressure, gap, compliance, prescribed, &mut self.state));
        self.outcome = match &solved {
            Ok(outcome) => *outcome,
            Err(Error::NotConverged(report)) => report.outcome(),
            Err(_) => Outcome::default(),
        };
        solved?;
        self.done += 1;
        let mut recorder = std::mem::take(&mut self.recorder);
        self.row().record(&mut recorder);
        self.recorder = recorder;
        Ok(self.last())
    }

    fn last(&self) -> Option<Step<'_>> {
        self.row.map(|_| self.row())
    }

    fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    fn planned(&self) -> Vec<f64> {
        vec![]
    }

    fn rows_expected(&self) -> Option<usize> {
        Some(self.done + self.asked.len())
    }

    fn done(&self) -> usize {
        self.done
    }

    fn finished(&self) -> bool {
        self.asked.is_empty()
    }

    fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        self.contact.interrupt = Some(flag);
    }

    fn checkpoint(&self) -> Checkpoint<'_> {
        let mut to = Saver::new(self.done, self.simulation.grid.shape());
        to.field("pressure", &self.state.pressure);
        to.finish()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;

    use ndarray::Array2;

    use super::*;
    use crate::grid::Grid;

    #[test]
    fn the_row_of_a_contact_that_failed_has_its_own_number() {
        let grid = Grid::new([16, 16], [1.0, 1.0]).unwrap();
        let gap = Array2::from_shape_fn((16, 16), |(i, j)| grid.x(i).powi(2) + grid.y(j).powi(2));
        let mut contacts =
            Elastic::new(Simulation::new(grid, gap), [(Control::Load, 0.01), (Control::Load, 0.02)]).unwrap();
        let flag = Arc::new(AtomicBool::new(false));
        contacts.interrupt_with(flag.clone());
        assert!(contacts.last().is_none());
        assert_eq!(contacts.advance().unwrap().unwrap().index(), 0);
        flag.store(true, Ordering::Relaxed);
        assert!(matches!(contacts.advance(), Err(Error::Interrupted)));
        // Its best state is that of row 1, which is not done.
        assert_eq!((contacts.last().unwrap().index(), contacts.done()), (1, 1));
        flag.store(false, Ordering::Relaxed);
        let start = vec![0.0; grid.len()];
        contacts.ask(Control::Load, 0.02, &start);
        let row = contacts.advance().unwrap().unwrap();
        assert_eq!(row.index(), 1);
        assert!((row.row().load / 0.02 - 1.0).abs() < 1e-9);
    }
}
