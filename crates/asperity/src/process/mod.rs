//! What changes the gap from step to step, or reads the state of each row.
//!
//! A process sees a step twice: before it is solved it may move the undeformed gap to where it is at the end of the step
//! (`Process::open`, repeatable at any length), and once the row stands it takes it in: first what can fail or be interrupted
//! (`Process::prepare`, repeatable), then the rest, all or nothing (`Process::accept`). The quantities and
//! fields that it adds to a row it declares by answering for them. Members: motion, stiffness, energies, power of
//! the load, friction, wear, flattening.

mod energy;
mod flattening;
mod load_power;
mod motion;
mod partial_slip;
mod stiffness;
mod wear;

pub use motion::{Motion, in_contact_frame};
pub(crate) use motion::{carry, cells, roll};
pub(crate) use partial_slip::SlipFields;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::contact::{ContactState, Hardness};
use crate::error::Result;
use crate::flash::Rise;
use crate::history::{Ends, Exchange, History};
use crate::operator::Operator;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::{Interval, Loader, Saver, UndeformedGap};

/// What goes on beside the contact.
pub(crate) trait Process: Send {
    /// Moves the gap to where it is at the end of the step.
    fn open(&mut self, _step: &Interval, _gap: &mut UndeformedGap) -> Result<()> {
        Ok(())
    }

    /// Cells along x and y that the gap has moved since the last row; `None` where this process does not move it in this step.
    fn shift(&self, _step: &Interval) -> Option<[isize; 2]> {
        None
    }

    /// Whether it moves the gap in this step at all.
    fn moves(&self, step: &Interval) -> bool {
        self.shift(step).is_some()
    }

    /// Whether this process displaces the surfaces normally, besides the pressure.
    fn acts_back(&self) -> bool {
        false
    }

    /// Writes the normal displacement under the pressure of an attempt, for unit compliance \[Pa m\], to this tolerance.
    ///
    /// # Errors
    /// Those of the process.
    fn act_back(&mut self, _row: &mut Solved<'_>, _tolerance: f64, _to: &mut [f64]) -> Result<()> {
        Ok(())
    }

    /// Finds what the row that was just solved needs and what can fail. Nothing that lasts changes, so it can be repeated.
    ///
    /// # Errors
    /// Those of the process.
    fn prepare(&mut self, _row: &mut Solved<'_>) -> Result<()> {
        Ok(())
    }

    /// Takes in the row, once every process has prepared it.
    fn accept(&mut self, row: &mut Solved<'_>);

    /// Estimated error of the stress that the step just solved adds because of this process, relative.
    fn error(&self, _ends: &Ends<'_>, _gap: &UndeformedGap, _compliance: f64) -> Option<f64> {
        None
    }

    /// A quantity of this process at the end of an attempt, before it is known whether the attempt stands.
    fn preview(&mut self, _quantity: Quantity, _row: &mut Solved<'_>) -> Result<Option<f64>> {
        Ok(None)
    }

    /// A quantity of the last row, where it is one of this process.
    fn quantity(&self, _quantity: Quantity) -> Option<f64> {
        None
    }

    /// The fields of the last row that friction has.
    fn slip(&self) -> Option<SlipFields<'_>> {
        None
    }

    /// The worn depths of body and counterbody after the last row \[m\], each in its own frame; empty of one that does not wear.
    fn worn(&self) -> Option<&[Vec<f64>; 2]> {
        None
    }

    /// How warm the surfaces of the last row are, where this process knows.
    fn rise(&self) -> Option<&Rise> {
        None
    }

    /// Saves what the rest of a run depends on.
    fn save<'a>(&'a self, _to: &mut Saver<'a>, _gap: &'a UndeformedGap) {}

    /// Takes back what [`save`](Self::save) gave; the gap is that of the last row afterwards.
    fn load(&mut self, _from: &mut Loader<'_>, _gap: &mut UndeformedGap) -> Result<()> {
        Ok(())
    }

    /// Work of the load since t = 0 that went into what has worn \[J\].
    fn worn_work(&self) -> f64 {
        0.0
    }

    /// What is not known of the work of the load since t = 0 \[J\].
    fn unknown_work(&self) -> f64 {
        0.0
    }

    /// The name under which it saves its state.
    fn name(&self) -> &'static str;
}

/// A row that was just solved, for the processes, one after the other.
pub(crate) struct Solved<'a> {
    pub(crate) simulation: &'a Simulation,
    pub(crate) step: &'a Interval,
    pub(crate) before: &'a ContactState,
    pub(crate) now: &'a ContactState,
    /// The contact of the row and that of the row before, without what other tractions press or pull: all of it, where none acts.
    pub(crate) contact: &'a ContactState,
    pub(crate) contact_before: &'a ContactState,
    /// The potential energy of other tractions \[J\].
    pub(crate) potential: f64,
    /// Loads of both \[N\].
    pub(crate) loads: [f64; 2],
    /// h0 + g that it was solved with, or nothing where that is h0; and h0.
    pub(crate) own_gap: &'a mut [f64],
    pub(crate) undeformed: &'a mut UndeformedGap,
    pub(crate) compliance: f64,
    /// The cut-off of the contact pressure.
    pub(crate) hardness: Hardness<'a>,
    pub(crate) operator: &'a mut dyn Operator,
    pub(crate) interrupt: Option<&'a AtomicBool>,
    /// Estimated error of the stress, relative, if the history knows it.
    pub(crate) time_error: Option<f64>,
    /// What the step did to the energy of the bodies, where account is kept of it.
    pub(crate) exchange: Option<Exchange>,
    /// Work that was done on the bodies in the step besides that of the load \[J\].
    pub(crate) other_work: f64,
    /// What is not known of it \[J\].
    pub(crate) unknown_work: f64,
    /// Work of the load in the step that went into what has worn \[J\].
    pub(crate) worn_work: f64,
    /// How far each cell has slipped in the step \[m\], where wear asks for it.
    pub(crate) slipped: Vec<f64>,
    /// Convolutions that the processes took.
    pub(crate) convolutions: usize,
}

impl Solved<'_> {
    /// h0 + g that it was solved with \[m\].
    pub(crate) fn gap(&self) -> &[f64] {
        self.undeformed.or(self.own_gap)
    }

    /// What the contact carries in the row before and in this one \[N\]: the loads, where nothing else carries or pulls.
    pub(crate) fn contact_loads(&self) -> [f64; 2] {
        let area = self.simulation.grid.cell_area();
        match self.simulation.traction {
            None => self.loads,
            Some(_) => [self.contact_before, self.contact]
                .map(|contact| area * asperity_sweep::sum(&contact.pressure)),
        }
    }
}

/// The processes that a simulation asks for, in the order in which they take in a row.
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) where one of them cannot be planned.
pub(crate) fn of(
    simulation: &Arc<Simulation>,
    operator: &dyn Operator,
    history: &mut dyn History,
) -> Result<Vec<Box<dyn Process>>> {
    fn boxed<P: Process + 'static>(process: Option<P>) -> Option<Box<dyn Process>> {
        process.map(|process| Box::new(process) as Box<dyn Process>)
    }
    let all = [
        boxed(simulation.motion.as_ref().map(|motion| motion::Moving::new(simulation, motion))),
        boxed(stiffness::Stiffness::of(simulation, operator)),
        boxed(partial_slip::PartialSlip::of(simulation)?),
        boxed(wear::Wearing::of(simulation, operator)),
        boxed(energy::Energy::of(simulation, history)),
        boxed(load_power::LoadPower::of(simulation)),
        boxed(flattening::Flattening::of(simulation)),
    ];
    Ok(all.into_iter().flatten().collect())
}
