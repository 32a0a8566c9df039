//! The state that steps carry on: both ends of the step under way and its gap; saved and taken back.

use std::sync::Arc;

use super::{Loader, Saver, StepContact, Stepper, UndeformedGap, saved};
use crate::contact::{ContactState, Prescribed};
use crate::error::Result;
use crate::history::Ends;
use crate::simulation::{Plasticity, Simulation};
use asperity_sweep::{minimum, sum};

pub(super) struct StepState {
    /// The state of the attempt, and that of the last row.
    pub(super) now: ContactState,
    pub(super) before: ContactState,
    pub(super) undeformed: UndeformedGap,
    /// h0 + g of the attempt; empty where g is 0 in every step: then the gap is h0.
    pub(super) own_gap: Vec<f64>,
    /// c of the attempt.
    pub(super) compliance: f64,
    /// Loads of the last row and of the attempt \[N\].
    pub(super) loads: [f64; 2],
    /// Length of the last row's step \[s\], and whether its bodies touched.
    pub(super) last_length: f64,
    pub(super) touched: bool,
    cell_area: f64,
}

impl StepState {
    /// `remembers` tells whether the history may leave a displacement g.
    pub(super) fn new(simulation: &Arc<Simulation>, remembers: bool) -> Self {
        let n = simulation.grid.len();
        // Flattening changes both gaps, wear by slip the next one.
        let slips = simulation.wear.is_some() && simulation.tangential.is_some();
        let own = remembers || simulation.plasticity == Plasticity::Accumulate || slips;
        StepState {
            now: ContactState::new(n),
            before: ContactState::new(n),
            undeformed: UndeformedGap::of(simulation),
            own_gap: if own { simulation.gap.iter().copied().collect() } else { vec![] },
            compliance: 0.0,
            loads: [0.0; 2],
            last_length: 0.0,
            touched: false,
            cell_area: simulation.grid.cell_area(),
        }
    }

    /// Both ends of the step of the attempt.
    pub(super) fn ends<'a>(&'a self, contact: &'a StepContact) -> Ends<'a> {
        let StepState { now, before, undeformed, .. } = self;
        let gap = self.gap();
        let (pressures, hardness) = (contact.pressures([before, now]), contact.hardness());
        let (rigid, rigid_before) = (undeformed.now(), undeformed.before());
        let (pulls, loads) = (contact.pulls(), self.loads);
        Ends { before, now, pressures, pulls, loads, gap, rigid, rigid_before, hardness }
    }

    /// The load that the attempt carries \[N\]; its own is the prescribed one, where that is a load.
    pub(super) fn meet(&mut self, prescribed: Prescribed) -> f64 {
        let carried = sum(&self.now.pressure) * self.cell_area;
        self.loads[1] = match prescribed {
            Prescribed::Load(load) => load,
            Prescribed::Approach(_) => carried,
        };
        carried
    }

    /// Approach at which the surfaces without pressure would just touch \[m\].
    pub(super) fn first_touch(&self) -> f64 {
        minimum(self.gap())
    }

    /// h0 + g of the attempt \[m\].
    pub(super) fn gap(&self) -> &[f64] {
        self.undeformed.or(&self.own_gap)
    }

    /// The attempt stands as a row, after a step of this length.
    pub(super) fn end(&mut self, length: f64, touches: bool) {
        self.loads[0] = self.loads[1];
        self.last_length = length;
        self.touched = touches;
    }
}

saved! {
    StepState {
        "approach": now.approach, before.approach;
        "rounding": now.rounding, before.rounding;
        "last": loads[0], last_length;
    }
    fields {
        "pressure": now.pressure;
        "unit_displacement": now.unit_displacement;
        "previous_pressure": before.pressure;
        "previous_unit_displacement": before.unit_displacement;
    }
}

impl Stepper {
    /// Saves the state after the last row.
    pub(crate) fn save<'a>(&'a self, to: &mut Saver<'a>) {
        self.state.save_own(to);
        to.within("history", |to| self.history.save(to));
        if let Some(traction) = &self.contact.traction {
            to.within("traction", |to| traction.save(to));
        }
        if let Some(coupled) = &self.coupled {
            to.within("coupled", |to| coupled.save_own(to));
        }
        to.value("processes", &self.processes.len());
        for process in &self.processes {
            to.within(process.name(), |to| {
                to.value("is_on", &true);
                process.save(to, &self.state.undeformed);
            });
        }
    }

    /// Takes back what [`save`](Self::save) gave.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) where it belongs to another simulation.
    pub(crate) fn load(&mut self, from: &mut Loader<'_>) -> Result<()> {
        self.state.load_own(from)?;
        if let Some(traction) = &mut self.contact.traction {
            from.within("traction", |from| traction.load(from))?;
        }
        if let Some(coupled) = &mut self.coupled {
            from.within("coupled", |from| coupled.load_own(from))?;
        }
        self.state.touched = self.touches();
        if from.get::<usize>("processes")? != self.processes.len() {
            return Err(from.foreign("other quantities or processes"));
        }
        for process in &mut self.processes {
            from.within(process.name(), |from| {
                from.get::<bool>("is_on")?;
                process.load(from, &mut self.state.undeformed)
            })?;
        }
        from.within("history", |from| self.history.load(from))
    }
}
