//! What is known of the pressure over a step before it is solved.

use super::{Interval, Load, Stepper};
use crate::contact::Prescribed;

impl Stepper {
    pub(super) fn load_over(&self, step: &Interval) -> Load {
        let is_apart = self.history.recovers_in_one_step() && !self.state.touched && !self.contact.pulls();
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
    pub(super) fn is_apart(&self) -> bool {
        self.step.as_ref().is_some_and(|step| step.load == Load::Apart)
    }

    /// Cells that the gap moves in a step, where it moves.
    pub(super) fn shift(&self, step: &Interval) -> Option<[isize; 2]> {
        self.processes.iter().find_map(|process| process.shift(step))
    }

    /// Whether a process moves the gap in a step.
    pub(super) fn moves(&self, step: &Interval) -> bool {
        self.processes.iter().any(|process| process.moves(step))
    }
}
