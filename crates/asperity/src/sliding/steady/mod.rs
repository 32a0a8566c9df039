//! Steady states of motion: one contact for each velocity.
//!
//! Find 0 <= p <= H with the load W and the contact conditions on g = A p + h - w, where A has the symbol K^(q) C~(q.v). A is not
//! symmetric, so there is no energy to minimise, but it is strongly monotone: the solution is unique.
//!
//! ```text
//! for each velocity, from the pressure of the one before:
//!     A, M                                                                               (operators)
//!     loop:                                                                              (contact)
//!         u = A p,  w from the free cells,  r = u + h - w;  stop where the contact conditions hold
//!         p = contact of the symmetric operator M = |A|²/Re A and the gap h + u - M p    (metric step)
//!         p = p after Newton's steps on its contact set, where they lower the residual   (newton, gmres)
//!     where that takes too long, the same for bodies that yield a share s of C(∞) at once, s from 1/4 down to C0/C(∞),
//!     and where one of them takes too long, exchanges of cells between the contact set and the rest  (pivots)
//! ```
//!
//! The metric step contracts by max sin δ < 1 in the norm of M, δ = arg A^, from any start: |1 - A^/M^| = |sin δ|, and the
//! solution of a convex contact is a 1-Lipschitz function of its gap in that norm. Newton's steps make it fast. Continuation
//! brings them to where they converge: sin δ is far below 1 for s = 1/4, and a smaller s changes the contact only where the
//! pressure rises steeply (docs/sliding.md).

mod checks;
mod coefficients;
mod contact;
mod gmres;
mod newton;
mod operators;
mod pivots;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use asperity_sweep::in_pool;

use self::contact::SteadyContact;
use self::operators::{Operators, Stream};
use super::{ContactForces, Direction, Friction, ShearStress, Slopes, Streaming};
use crate::contact::{ContactState, Hardness, Outcome, Prescribed, Problem};
use crate::drive::{Coordinate, Drive};
use crate::error::Result;
use crate::flash::{self, Feedback, FlashSolver, Rubbing};
use crate::simulation::Simulation;
use crate::step::{Checkpoint, Loader, Recorder, Saver, Step};

/// What moves, and how fast.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyMotion {
    /// Direction of the velocity.
    pub direction: Direction,
    /// Velocities \[m/s\], not negative; each is solved from the one before it.
    pub velocities: Vec<f64>,
    /// Slopes of the gap of the simulation.
    pub slopes: Slopes,
    /// A shear stress on the area in contact, for [`Friction::total`].
    pub shear_stress: Option<ShearStress>,
}

/// A sweep over velocities.
///
/// ```
/// use asperity::{material::{Creep, CreepTerm}, sliding::{Direction, Slopes, Steady, SteadyMotion}};
/// use asperity::{Boundary, Control, Drive, Grid, History, Loading, Simulation, surface::{Part, Shape, undeformed_gap}};
/// // A cylinder of 10 mm rolls over a Zener solid that yields five times its instantaneous compliance in 10 ms.
/// let grid = Grid::line(128, 4e-3)?;
/// let parts = [Part::Shape { shape: Shape::Cylinder { radius: 10e-3 }, center: [0.0, 0.0] }];
/// let gap = undeformed_gap(&grid, &parts)?;
/// let creep = Creep {
///     instantaneous: 1e-8, fluidity: 0.0, terms: vec![CreepTerm { compliance: 4e-8, retardation_time: 0.01 }],
/// };
/// let slopes = Slopes::of(&grid, Boundary::Free, &parts)?;
/// let simulation = Simulation {
///     creep,
///     loading: Loading { control: Control::Load, history: History::Step { value: 1e3 } }.into(),
///     ..Simulation::new(grid, gap)
/// };
/// let motion = SteadyMotion { direction: Direction::X, velocities: vec![0.01, 0.1, 1.0], slopes, shear_stress: None };
/// let mut steady = Steady::new(simulation, motion)?;
/// let mut friction = vec![];
/// while let Some(step) = steady.advance()? {
///     friction.push(step.friction().expect("it moves").coefficient);
/// }
/// // Most is lost where the material relaxes while it passes the contact.
/// assert!(friction[1] > friction[0] && friction[1] > friction[2] && friction[2] > 0.0);
/// # Ok::<(), asperity::Error>(())
/// ```
pub struct Steady {
    simulation: Simulation,
    motion: SteadyMotion,
    streaming: Streaming,
    /// W \[N\].
    load: f64,
    /// The pressure of the last velocity done, from which the next is solved.
    start: Vec<f64>,
    done: usize,
    /// The last state, good or not, and the number of its velocity.
    index: usize,
    state: ContactState,
    outcome: Outcome,
    friction: Friction,
    flash: Option<FlashSolver>,
    /// Mean flash temperature of the last velocity done, from which that of the next is found \[K\].
    warmth: f64,
    recorder: Recorder,
    interrupt: Option<Arc<AtomicBool>>,
}

impl Steady {
    /// Checks the simulation. Of it count the grid, the body, the gap, the hardness, the solver, the material, and the load: a load
    /// or a mean pressure that is held.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) naming the quantity; [`Error::Infeasible`](crate::Error::Infeasible) where the load exceeds what the hardness carries.
    pub fn new(simulation: Simulation, motion: SteadyMotion) -> Result<Self> {
        motion.validate(&simulation)?;
        simulation.validate()?;
        let (cells, load) = (simulation.grid.len(), checks::held_load(&simulation)?);
        Ok(Steady {
            streaming: Streaming::new(&simulation)?,
            load,
            start: vec![0.0; cells],
            done: 0,
            index: 0,
            state: ContactState::new(cells),
            outcome: Outcome::default(),
            friction: Friction::default(),
            flash: FlashSolver::of(&simulation, motion.direction),
            warmth: 0.0,
            recorder: Recorder::new(simulation.columns()?),
            interrupt: None,
            simulation,
            motion,
        })
    }

    /// Goes on where a checkpoint of the same sweep was taken.
    ///
    /// # Errors
    /// As [`Steady::new`]; [`Error::Invalid`](crate::Error::Invalid) where the checkpoint belongs to another sweep.
    pub fn resume(simulation: Simulation, motion: SteadyMotion, checkpoint: &Checkpoint) -> Result<Self> {
        let mut steady = Steady::new(simulation, motion)?;
        let from = Loader::new(checkpoint, steady.simulation.grid.shape());
        steady.done = checkpoint.step;
        if steady.done > steady.motion.velocities.len() {
            return Err(from.foreign(format!("{} velocities", checkpoint.step)));
        }
        from.field_into("pressure", &mut steady.start)?;
        if steady.feeds_back() {
            steady.warmth = from.get("warmth")?;
        }
        steady.index = steady.done.saturating_sub(1);
        steady.state.pressure.copy_from_slice(&steady.start);
        Ok(steady)
    }

    /// What moves.
    pub fn motion(&self) -> &SteadyMotion {
        &self.motion
    }

    /// Memory that a sweep takes at most \[bytes\]: operators, solver and fields.
    pub fn bytes(simulation: &Simulation, direction: Direction) -> usize {
        // Gap and slopes; pressure and U of three states, the start and two fields of work; vectors of GMRES, were all in contact.
        let fields = 3 + 6 + 3 + gmres::FIELDS;
        Operators::bytes(simulation, direction) + 8 * simulation.grid.len() * fields
    }

    /// Whether the material sees its own temperature.
    fn feeds_back(&self) -> bool {
        self.simulation.flash.as_ref().is_some_and(|flash| flash.feedback.is_some())
    }

    /// Solves for one velocity, at the temperature that its own friction makes.
    fn solve(&mut self, velocity: f64) -> Result<f64> {
        let flash = self.simulation.flash.clone();
        let Some(feedback) = flash.as_ref().and_then(|flash| flash.feedback.as_ref()) else {
            self.solve_slowed(velocity, 1.0)?;
            return self.warm(velocity, 1.0);
        };
        let (before, mut outcome) = (self.start.clone(), Outcome::default());
        let settled = flash::settle(velocity, self.warmth, |rise| {
            let slowing = feedback.slowing(rise)?;
            let solved = self.solve_slowed(velocity, slowing);
            outcome.iterations += self.outcome.iterations;
            outcome.convolutions += self.outcome.convolutions;
            solved?;
            self.start.copy_from_slice(&self.state.pressure);
            self.warm(velocity, slowing)
        });
        self.start = before;
        let rise = settled?;
        self.outcome =
            Outcome { iterations: outcome.iterations, convolutions: outcome.convolutions, ..self.outcome };
        let other = self.another(velocity, rise, feedback);
        if let Some(flash) = &mut self.flash {
            let row = &mut flash.rise.row;
            (row.material, row.other) = (feedback.temperature + rise, other.unwrap_or(f64::NAN));
        }
        Ok(rise)
    }

    /// Another rise \[K\] than this one with which a velocity may be steady, by the shear stress on the contact as it is now.
    fn another(&self, velocity: f64, rise: f64, feedback: &Feedback) -> Option<f64> {
        let law = self.motion.shear_stress.as_ref()?;
        let flash = self.simulation.flash.as_ref()?;
        let area = self.simulation.grid.cell_area()
            * self.state.pressure.iter().filter(|p| **p > 0.0).count() as f64;
        let bulk = if flash.hysteresis { self.friction.force.max(0.0) } else { 0.0 };
        let force = |rise: f64| Some(bulk + area * law.at(velocity, feedback.slowing(rise).ok()?));
        let now = force(rise).filter(|force| *force > 0.0)?;
        flash::another(rise, |rise| Some(force(rise)? / now))
    }

    /// The mean flash temperature over the contact \[K\].
    fn warm(&mut self, velocity: f64, slowing: f64) -> Result<f64> {
        let Some(flash) = &mut self.flash else { return Ok(0.0) };
        flash.warm(Rubbing {
            velocity,
            pressure: &self.state.pressure,
            shear: self.motion.shear_stress.as_ref().map_or(0.0, |law| law.at(velocity, slowing)),
            loss: self.friction.coefficient,
        })?;
        Ok(flash.rise.row.mean)
    }

    /// Solves for one velocity, which the material sees `slowing` times.
    fn solve_slowed(&mut self, velocity: f64, slowing: f64) -> Result<()> {
        let stream = Stream {
            simulation: &self.simulation,
            streaming: &self.streaming,
            direction: self.motion.direction,
            velocity: velocity * slowing,
        };
        let problem = Problem {
            gap: self.simulation.gap_cells(),
            compliance: self.streaming.relaxed(),
            hardness: Hardness::Uniform(self.simulation.hardness),
            prescribed: Prescribed::Load(self.load),
        };
        let mut contact = SteadyContact::new(stream, problem, self.interrupt.as_deref());
        self.state.pressure.copy_from_slice(&self.start);
        let solved = contact.solve(&mut self.state);
        self.outcome = contact.spent;
        let forces = ContactForces {
            simulation: &self.simulation,
            direction: self.motion.direction,
            slopes: &self.motion.slopes,
            state: &self.state,
            pressure: &self.state.pressure,
            contact: &self.state.pressure,
            fluid_load: 0.0,
            gap: problem.gap,
            compliance: problem.compliance,
            loses: self.streaming.branches().next().is_some(),
            velocity,
            sense: 1.0,
            distance: 0.0,
            shear_stress: self.motion.shear_stress.as_ref().map(|law| law.at(velocity, slowing)),
        };
        self.friction = Friction::steady(&forces, contact.loss(&self.state.pressure));
        solved
    }

    fn row(&self) -> Step<'_> {
        let hardness = Hardness::Uniform(self.simulation.hardness);
        let bodies = (self.simulation.gap_cells(), self.streaming.relaxed());
        Step {
            index: self.index,
            coordinate: Coordinate::Velocity(self.motion.velocities[self.index]),
            recorder: Some(&self.recorder),
            friction: Some(self.friction),
            rise: self.flash.as_ref().map(|flash| &flash.rise),
            ..Step::of(&self.simulation, hardness, (&self.state, self.outcome), bodies)
        }
    }
}

impl Drive for Steady {
    fn advance(&mut self) -> Result<Option<Step<'_>>> {
        let Some(velocity) = self.motion.velocities.get(self.done).copied() else { return Ok(None) };
        self.index = self.done;
        let solved = in_pool(|| self.solve(velocity));
        let mut recorder = std::mem::take(&mut self.recorder);
        self.row().record(&mut recorder);
        self.recorder = recorder;
        self.warmth = solved?;
        self.start.copy_from_slice(&self.state.pressure);
        self.done += 1;
        Ok(self.last())
    }

    fn last(&self) -> Option<Step<'_>> {
        self.state.touches().then(|| self.row())
    }

    fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    fn planned(&self) -> Vec<f64> {
        self.motion.velocities.clone()
    }

    fn rows_expected(&self) -> Option<usize> {
        Some(self.motion.velocities.len())
    }

    fn done(&self) -> usize {
        self.done
    }

    fn finished(&self) -> bool {
        self.done == self.motion.velocities.len()
    }

    /// Stops within one iteration of the solver, or some hundred influence coefficients.
    fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }

    /// The pressure of the last velocity done, whatever became of a later one.
    fn checkpoint(&self) -> Checkpoint<'_> {
        let mut to = Saver::new(self.done, self.simulation.grid.shape());
        to.field("pressure", &self.start);
        if self.feeds_back() {
            to.value("warmth", &self.warmth);
        }
        to.finish()
    }

    fn streaming(&self) -> Option<&Streaming> {
        Some(&self.streaming)
    }
}
