//! What the bodies remember: the seam between a time step and the material.
//!
//! A step from t_n to t_(n+1) leaves the displacement u_(n+1) = c U_(n+1) + g with U = K p. The number c and the field g are
//! known before the solve; how they follow from the past is the history's own matter. Members, one room each:
//!
//! - `Relaxation`: branches of the relaxation form, u linear over each step (docs/theory.md, section 5);
//! - `Spectral`: every wave of the displacement a body of its own, for layers that creep differently;
//! - `ConstantPressure`: the pressure of a step is that of its end;
//! - `HereditarySum`: the full sum over all steps before.
//!
//! `Retarded` uses the first of them for integrals over pressures that are known already.
//!
//! A step is opened, solved, opened again at other lengths where its error or an event asks for it, and closed. What came
//! before it is taken in once, when it is first opened.

#![allow(clippy::type_complexity)] // the closures of a sweep spell out the slices that they walk

mod clocks;
mod constant;
mod hereditary;
mod relaxation;
mod retarded;
mod spectral;

pub(crate) use retarded::Retarded;
pub use spectral::check_layers;

use crate::contact::{ContactState, Hardness};
use crate::error::Result;
use crate::operator::Operator;
use crate::simulation::{Scheme, Simulation};
use crate::step::{Interval, Loader, Piece, Saver};
use constant::ConstantPressure;
use hereditary::HereditarySum;
use relaxation::Relaxation;
use spectral::Spectral;

/// The memory of the bodies.
pub(crate) trait History: Send {
    /// Whether a step may leave a displacement g; else it writes no gap where that is empty.
    fn remembers(&self) -> bool {
        true
    }

    /// Takes in the state at the end of the last step and opens the next one: writes `gap` = `rigid` + g.
    fn open(&mut self, step: &Interval, last: &ContactState, rigid: &[f64], gap: &mut [f64]) -> Result<Law>;

    /// Opens the step under way again, at another length or under another load.
    fn reopen(&mut self, step: &Interval, rigid: &[f64], gap: &mut [f64]) -> Result<Law>;

    /// The step under way has this end for good.
    fn close(&mut self, _ends: &Ends<'_>) {}

    /// g of the step under way.
    fn recalled(&self, g: &mut [f64]);

    /// Whether a step without pressure at either end has a law of its own, so that any time without contact is one step.
    fn recovers_in_one_step(&self) -> bool {
        false
    }

    /// The state that has to be solved first, before the step `step` is opened, for the error of the step to be known.
    fn third_state(&self, _step: &Interval) -> Option<ThirdState> {
        None
    }

    /// Keeps the state just solved as the third one, besides both ends of the step.
    fn keep_as_third(&mut self, _ends: &Ends<'_>) {}

    /// Estimated error of the stress that the step just solved adds, relative: what adaptive steps are chosen by. `None` where it is not
    /// estimated.
    fn error(&mut self, _step: &Interval, _ends: &Ends<'_>) -> Option<f64> {
        None
    }

    /// Estimated error of the stress at the end of the step just closed, relative, with what the steps before left; `None` where it is
    /// not known.
    fn time_error(&self) -> Option<f64> {
        None
    }

    /// How long the first step of a smooth piece may be \[s\]; `None` where the history does not say.
    fn first_step(&mut self, _piece: &Piece) -> Option<f64> {
        None
    }

    /// Keeps account of the energy from now on; false where the history knows no springs and dashpots.
    fn track_energy(&mut self) -> bool {
        false
    }

    /// What the step just closed did; `None` where no account is kept.
    fn exchange(&mut self, _ends: &Ends<'_>) -> Option<Exchange> {
        None
    }

    /// Saves what the rest of a run depends on.
    fn save<'a>(&'a self, to: &mut Saver<'a>);

    /// Takes back what [`save`](Self::save) gave.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) where it belongs to another material or scheme.
    fn load(&mut self, from: &mut Loader<'_>) -> Result<()>;
}

/// The law of a step: u = compliance K p + g.
pub(crate) struct Law {
    pub(crate) compliance: f64,
    /// K, where it is that of this step alone.
    pub(crate) operator: Option<Box<dyn Operator>>,
}

impl Law {
    fn of(compliance: f64) -> Law {
        Law { compliance, operator: None }
    }
}

/// Both ends of a step that was solved, and the gap that it was solved with.
#[derive(Clone, Copy)]
pub(crate) struct Ends<'a> {
    pub(crate) before: &'a ContactState,
    pub(crate) now: &'a ContactState,
    /// Contact pressures of both \[Pa\]: all of it, where no other traction acts.
    pub(crate) pressures: [&'a [f64]; 2],
    /// Whether tractions act on open cells too.
    pub(crate) pulls: bool,
    /// Loads of both \[N\].
    pub(crate) loads: [f64; 2],
    /// h0 + g, and h0.
    pub(crate) gap: &'a [f64],
    pub(crate) rigid: &'a [f64],
    /// h0 at the start of the step.
    pub(crate) rigid_before: &'a [f64],
    pub(crate) hardness: Hardness<'a>,
}

impl<'a> Ends<'a> {
    /// Of pressures that no surface and no hardness limits: the past leaves `gap`, and `rest` is 0 everywhere.
    pub(crate) fn unlimited(
        [before, now]: [&'a ContactState; 2],
        loads: [f64; 2],
        gap: &'a [f64],
        rest: &'a [f64],
    ) -> Self {
        Ends {
            before,
            now,
            pressures: [&before.pressure, &now.pressure],
            pulls: false,
            loads,
            gap,
            rigid: rest,
            rigid_before: rest,
            hardness: Hardness::Uniform(f64::INFINITY),
        }
    }

    /// w of both \[m\].
    pub(crate) fn approaches(&self) -> [f64; 2] {
        [self.before.approach, self.now.approach]
    }

    /// How far the bodies approach \[m\].
    pub(crate) fn advance(&self) -> f64 {
        self.now.approach - self.before.approach
    }
}

/// A state solved first, as shares of the length proposed: that of the state, and that of the step after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ThirdState {
    pub(crate) at: f64,
    pub(crate) step: f64,
}

/// The state that is solved first where the last step, which was `length` long and `in_contact` or not, leaves no third one besides
/// both ends. Adaptive steps are solved at their full length first and taken at half of it, so that the next try is shorter; steps of a
/// given length the other way round.
fn third_state(step: &Interval, in_contact: bool, length: f64) -> Option<ThirdState> {
    let is_known = step.is_smooth && in_contact && (step.is_adaptive || length > 0.0);
    if step.instant.jump || step.length() == 0.0 || is_known {
        return None;
    }
    Some(match step.is_adaptive {
        true => ThirdState { at: 1.0, step: 0.5 },
        false => ThirdState { at: 0.5, step: 1.0 },
    })
}

/// What a step did to the energy of the bodies, per area of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Exchange {
    /// Stored at its end.
    pub(crate) stored: f64,
    /// Work of the pressure on the bodies, and what of it became heat.
    pub(crate) work: f64,
    pub(crate) heat: f64,
    /// The mean of the load while u ran from its start to its end \[N\].
    pub(crate) mean_load: f64,
}

/// The history that a simulation asks for.
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) where the material has none.
pub(crate) fn of(simulation: &Simulation) -> Result<Box<dyn History>> {
    Ok(match (simulation.scheme, &simulation.layers) {
        (Scheme::Direct, _) => Box::new(HereditarySum::new(&simulation.creep, &simulation.thermal)),
        (Scheme::Constant, _) => Box::new(ConstantPressure::new(simulation)),
        (Scheme::Linear, Some(layers)) => Box::new(Spectral::new(simulation, layers)?),
        (Scheme::Linear, None) => Box::new(Relaxation::new(simulation)?),
    })
}

/// Fields that relax or flow.
pub(crate) fn terms(simulation: &Simulation) -> usize {
    simulation.parts().map(|creep| creep.terms.len() + usize::from(creep.fluidity > 0.0)).sum()
}

/// Whether the history of a simulation remembers anything, see [`History::remembers`].
pub(crate) fn remembers(simulation: &Simulation) -> bool {
    simulation.scheme != Scheme::Linear || simulation.layers.is_some() || terms(simulation) > 0
}

/// Bytes that the history of a simulation takes.
pub(crate) fn bytes(simulation: &Simulation) -> usize {
    let (n, terms) = (simulation.grid.len(), terms(simulation));
    // the displacement of the history, and that of a third instant
    let fields = match simulation.scheme {
        Scheme::Direct => simulation.plan().instants.len(),
        _ if terms == 0 => 0,
        Scheme::Constant => terms + 1,
        Scheme::Linear => terms + 2,
    };
    let waves = simulation
        .layers
        .as_ref()
        .map_or(0, |layers| spectral::bytes(&simulation.grid, simulation.boundary, layers));
    8 * n * fields + waves
}
