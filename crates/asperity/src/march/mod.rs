//! The march through time: one elastic contact per step.
//!
//! Space and time separate: u(x, t) = integral C(t - s) d(Kp)(x, s). With U = Kp, a step from t_n to t_(n+1)
//! leaves u_(n+1) = c U_(n+1) + g, where the number c and the field g (the history) are known before the solve
//! (docs/theory.md, section 5). So the step is the elastic contact with compliance c and undeformed gap h0 + g, and
//! the past costs no convolution.

#![allow(clippy::type_complexity)] // the closures of a sweep spell out the slices that they walk

mod adaptive;
mod checkpoint;
mod constant;
mod dense;
mod dents;
mod direct;
mod energy;
mod event;
mod locate;
mod measure;
mod memory;
mod motion;
mod record;
mod simulation;
mod timeline;
mod warm_start;

pub use checkpoint::Checkpoint;
pub use dense::Between;
pub use memory::check_layers;
pub use motion::{Motion, in_contact_frame};
pub(crate) use record::{Lone, PERIMETER_SHARE};
pub use record::{Row, Step};
pub use simulation::{Plasticity, Scheme, Simulation};

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::contact::{ContactState, Hardness, Outcome, Prescribed, Problem, Solver, Start};
use crate::drive::{Axis, Coordinate, Drive};
use crate::error::{Error, Result};
use crate::load::{Control, Event};
use crate::operator::{Operator, plan};
use crate::sliding::Friction;
use crate::time::Instant;
use asperity_sweep::{minimum, sum};
use constant::Constant;
use dents::Dents;
use direct::Direct;
use event::{Enclosure, MET};
pub(crate) use measure::Meter;
use memory::{Ends, Imposed, Interval, Memory, Spectral};
use motion::{Moving, Slid};
use record::Remembered;
use timeline::{Accepted, Timeline};

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
    simulation: Simulation,
    timeline: Timeline,
    operator: Box<dyn Operator>,
    solver: Solver,
    past: Past,
    /// Rows done.
    done: usize,
    /// The row that `state` belongs to, and its instant.
    current: Option<(usize, Instant)>,
    state: ContactState,
    /// The row before.
    previous: ContactState,
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
    /// Estimated error of the last step.
    time_error: Option<f64>,
    /// The gap that moves, the forces of the last row, and what its step did along the path.
    moving: Option<Moving>,
    friction: Friction,
    slid: Slid,
    /// What the last row reached, where stages ask for it.
    reached: Reached,
    interrupt: Option<Arc<AtomicBool>>,
}

/// The undeformed gap h0 with its dents.
fn undeformed<'a>(
    simulation: &'a Simulation,
    dents: &'a Option<Dents>,
    moving: &'a Option<Moving>,
) -> &'a [f64] {
    match (dents, moving) {
        (Some(dents), _) => dents.gap(),
        (None, Some(moving)) => &moving.gap,
        (None, None) => simulation.gap.as_slice().unwrap_or_default(),
    }
}

/// The cut-off of each cell.
fn cap<'a>(simulation: &Simulation, of_cells: &'a Option<Vec<f64>>) -> Hardness<'a> {
    of_cells.as_deref().map_or(Hardness::Uniform(simulation.hardness), Hardness::Cells)
}

/// The displacement \[m\] that the displacements `u` of a contact are measured from: where they are known up to a constant, that of the
/// domain's end, x = L, on the straight line through the last two cells; else 0.
pub(crate) fn datum(simulation: &Simulation, u: &[f64]) -> f64 {
    match u {
        [.., before, last] if simulation.is_up_to_a_constant() => last + 0.5 * (last - before),
        _ => 0.0,
    }
}

/// What a row reached: a stage may end or begin with it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Reached {
    approach: f64,
    load: f64,
}

/// What the bodies remember.
enum Past {
    Memory(Box<Memory>),
    Waves(Box<Spectral>),
    Constant(Constant),
    Direct(Direct),
}

impl Past {
    /// g of the step that ended last.
    fn remembered(&self, g: &mut [f64]) {
        match self {
            Past::Memory(m) => m.remembered(g),
            Past::Waves(w) => w.remembered(g),
            Past::Constant(c) => c.remembered(g),
            Past::Direct(d) => d.remembered(g),
        }
    }
}

impl March {
    /// Checks the simulation and plans it: operator, solver, memory, instants.
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
        let timeline = Timeline::new(&simulation);
        let options = &simulation.solver;
        let operator = plan(simulation.grid, simulation.boundary, simulation.kernel.clone())?;
        let solver = Solver::new(options.method, &*operator);
        let n = simulation.grid.len();
        let past = match (simulation.scheme, &simulation.layers) {
            (Scheme::Direct, _) => Past::Direct(Direct::new(&simulation.creep, &simulation.thermal)),
            (Scheme::Constant, _) => Past::Constant(Constant::new(&simulation)),
            (Scheme::Linear, Some(layers)) => Past::Waves(Box::new(Spectral::new(&simulation, layers)?)),
            (Scheme::Linear, None) => {
                Past::Memory(Box::new(Memory::new(&simulation, simulation.is_adaptive())?))
            }
        };
        let meter = Meter::new(simulation.columns()?, &*operator, &past);
        let dents = Dents::new(&simulation);
        Ok(March {
            gap: simulation.gap.iter().copied().collect(),
            hardness: simulation.hardness_of_cells(),
            time_error: None,
            reached: Reached::default(),
            moving: simulation.motion.as_ref().map(Moving::new).transpose()?,
            friction: Friction::default(),
            slid: Slid::default(),
            lengths: vec![0.0; simulation.parts().count()],
            simulation,
            timeline,
            operator,
            solver,
            past,
            done: 0,
            current: None,
            state: ContactState::new(n),
            previous: ContactState::new(n),
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

    /// Number of rows in all, where it is known beforehand: without events and adaptive steps.
    pub fn rows_expected(&self) -> Option<usize> {
        let plan = self.simulation.plan();
        plan.exact.then_some(plan.instants.len())
    }

    /// Whether the last row is done.
    pub fn finished(&self) -> bool {
        self.timeline.finished()
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
    /// [`Error::Undetermined`], [`Error::Interrupted`]; [`Error::Missed`] where an event did not come;
    /// [`Error::Invalid`] where a stage begins with a jump that the material cannot follow.
    pub fn advance(&mut self) -> Result<Option<Step<'_>>> {
        self.set_first_step();
        let Some(mut instant) = self.timeline.propose(&self.simulation)? else {
            return Ok(None);
        };
        self.outcome = Outcome::default();
        let (mut turn, start) = match self.solve_half(instant)? {
            None => self.begin(&mut instant)?,
            Some(half) => self.lengthen(&mut instant, half)?,
        };
        self.solve(instant, start)?;
        let mut error = self.shorten_to_tolerance(&mut instant, &mut turn)?;
        let event = self.find_event(&mut instant)?;
        if event && error.is_some() {
            error = self.local_error(instant);
        }
        self.settle(instant)?;
        self.find_friction(instant);
        self.measure(instant.dt == 0.0)?;
        self.dent();
        self.time_error = error;
        self.reached = self.reached_now();
        let row = Accepted { instant, error, event, turn, reached: self.reached };
        self.timeline.accept(&self.simulation, row);
        self.done += 1;
        Ok(self.last())
    }

    /// Solves the step shorter and shorter until its error is small enough, where steps are adaptive; returns the error.
    fn shorten_to_tolerance(&mut self, instant: &mut Instant, turn: &mut bool) -> Result<Option<f64>> {
        if self.timeline.pace().is_none() {
            return Ok(self.local_error(*instant));
        }
        if instant.jump {
            return Ok(Some(0.0));
        }
        let knows_three = self.timeline.smooth() && self.knows_the_state_before();
        if !self.is_apart() && !knows_three {
            // The state just solved is the third one, of a step half as long.
            self.keep_as_third();
            *turn = self.try_again(instant, 0.5 * instant.dt)?;
        }
        loop {
            let error = self.local_error(*instant);
            let shorter = self.timeline.pace().and_then(|pace| pace.rejects(instant.dt, error?));
            let Some(dt) = shorter else { return Ok(error) };
            *turn = self.try_again(instant, dt)?;
        }
    }

    /// The first half of a step of given length, where the error of such steps is estimated and no third state is known: the error
    /// of layers that creep differently. Returns its length.
    fn solve_half(&mut self, instant: Instant) -> Result<Option<f64>> {
        let Past::Waves(waves) = &mut self.past else { return Ok(None) };
        if self.timeline.pace().is_some() || instant.jump || instant.dt == 0.0 {
            return Ok(None);
        }
        let known = self.timeline.smooth() && waves.leaves_a_third();
        if !self.timeline.smooth() {
            waves.first_step(instant.dt, None, false);
        }
        if known {
            return Ok(None);
        }
        let mut half = self.timeline.inside(&self.simulation, 0.5 * instant.dt);
        let (_, start) = self.begin(&mut half)?;
        if self.is_apart() {
            return Ok(Some(half.dt));
        }
        self.solve(half, start)?;
        self.keep_as_third();
        Ok(Some(half.dt))
    }

    /// Sets the contact of the step to `instant` after that of its part of length `tried`.
    fn lengthen(&mut self, instant: &mut Instant, tried: f64) -> Result<(bool, Start)> {
        self.reset(*instant, self.drive(*instant))?;
        let turn = self.locate(instant)?;
        Ok((turn, self.guess_again(*instant, tried)))
    }

    /// Sets the contact of the step that ends at `instant`: its compliance, its gap, its first guess. The step ends sooner where
    /// contact is made or lost in it; then the answer is true.
    fn begin(&mut self, instant: &mut Instant) -> Result<(bool, Start)> {
        self.set(*instant)?;
        let turn = self.locate(instant)?;
        let start = self.guess_moved(*instant).unwrap_or_else(|| self.guess(*instant));
        Ok((turn, start))
    }

    /// Takes in the last row, and sets the contact of the next step: its compliance and its gap.
    fn set(&mut self, instant: Instant) -> Result<()> {
        self.measure_step(instant);
        self.move_gap(instant.time)?;
        self.meter.clear();
        let drive = self.drive(instant);
        let unit = &self.state.unit_displacement;
        let rigid = undeformed(&self.simulation, &self.dents, &self.moving);
        let lengths = &self.lengths;
        self.compliance = match &mut self.past {
            Past::Memory(m) => m.begin(Interval { lengths, drive }, unit, rigid, &mut self.gap)?,
            Past::Waves(w) => {
                let scale = w.begin(Interval { lengths, drive }, &self.state.pressure, rigid, &mut self.gap);
                self.operator = w.operator();
                scale
            }
            Past::Constant(c) => c.begin(lengths, unit, rigid, &mut self.gap),
            Past::Direct(d) => d.history(instant.time, instant.dt, unit, rigid, &mut self.gap),
        };
        std::mem::swap(&mut self.state, &mut self.previous);
        Ok(())
    }

    /// Sets the contact of the step under way at another length.
    fn reset(&mut self, instant: Instant, drive: Imposed) -> Result<()> {
        self.measure_step(instant);
        self.move_gap(instant.time)?;
        let rigid = undeformed(&self.simulation, &self.dents, &self.moving);
        let lengths = &self.lengths;
        self.compliance = match &mut self.past {
            Past::Memory(m) => m.retry(Interval { lengths, drive }, rigid, &mut self.gap)?,
            Past::Waves(w) => {
                let scale = w.retry(Interval { lengths, drive }, rigid, &mut self.gap);
                self.operator = w.operator();
                scale
            }
            Past::Constant(c) => c.retry(lengths, rigid, &mut self.gap),
            Past::Direct(d) => d.retry(instant.dt, rigid, &mut self.gap),
        };
        Ok(())
    }

    /// Takes the step under way again at another length, guessed from the last row and the last trial; whether the contact is
    /// lost or made there.
    fn try_again(&mut self, instant: &mut Instant, dt: f64) -> Result<bool> {
        let tried = self.current.map_or(0.0, |(_, trial)| trial.dt);
        *instant = self.timeline.inside(&self.simulation, dt);
        self.reset(*instant, self.drive(*instant))?;
        let turn = self.locate(instant)?;
        let start = self.guess_moved(*instant).unwrap_or_else(|| self.guess_again(*instant, tried));
        self.solve(*instant, start)?;
        Ok(turn)
    }

    /// What is known of the step to `instant` before it is solved.
    fn drive(&self, instant: Instant) -> Imposed {
        let apart = match &self.past {
            Past::Memory(memory) => memory.load() == 0.0,
            Past::Waves(waves) => waves.load() == 0.0,
            Past::Constant(_) | Past::Direct(_) => false,
        };
        match self.prescribed(instant) {
            Prescribed::Load(load) if apart && load == 0.0 => Imposed::Apart,
            // Where the gap moves, displacements run with it, in time, whatever the load does.
            Prescribed::Load(_) if self.moves(instant) => Imposed::Approach,
            Prescribed::Load(load) => Imposed::Load(load),
            Prescribed::Approach(_) if apart => Imposed::Apart,
            Prescribed::Approach(w) if w == self.reached.approach => Imposed::Held,
            Prescribed::Approach(_) => Imposed::Approach,
        }
    }

    /// Pressure, U and the change of the approach at both ends of the step under way.
    fn ends(&self) -> Ends<'_> {
        Ends {
            approach: self.state.approach,
            advance: self.state.approach - self.previous.approach,
            before: (&self.previous.pressure, &self.previous.unit_displacement),
            now: (&self.state.pressure, &self.state.unit_displacement),
        }
    }

    /// Tells the memory the load of the row.
    fn settle(&mut self, instant: Instant) -> Result<()> {
        let load = match self.prescribed(instant) {
            Prescribed::Load(load) => load,
            Prescribed::Approach(_) => sum(&self.state.pressure) * self.simulation.grid.cell_area(),
        };
        match &mut self.past {
            Past::Memory(memory) => memory.settle(load),
            Past::Waves(waves) => waves.settle(load, &self.state.pressure)?,
            Past::Constant(_) | Past::Direct(_) => {}
        }
        Ok(())
    }

    /// What the solver is to meet. A load that is rounding of the largest one is none.
    fn prescribed(&self, instant: Instant) -> Prescribed {
        let none = instant.value.abs() <= 16.0 * f64::EPSILON * self.timeline.scale;
        match instant.control {
            Control::Approach => Prescribed::Approach(instant.value),
            _ if none => Prescribed::Load(0.0),
            Control::Load => Prescribed::Load(instant.value),
            Control::Pressure => Prescribed::Load(instant.value * self.simulation.grid.area()),
        }
    }

    /// Solves the contact that is set.
    fn solve(&mut self, instant: Instant, start: Start) -> Result<()> {
        self.current = Some((self.done, instant));
        let problem = Problem {
            gap: &self.gap,
            compliance: self.compliance,
            hardness: cap(&self.simulation, &self.hardness),
            prescribed: self.prescribed(instant),
        };
        let options = &self.simulation.solver;
        let interrupt = self.interrupt.as_deref();
        let before = self.outcome;
        let (operator, state) = (&mut *self.operator, &mut self.state);
        match self.solver.solve_from(start, operator, &problem, options, state, interrupt) {
            Ok(outcome) => {
                // The work of all trials of a step is its work.
                self.outcome = Outcome {
                    iterations: before.iterations + outcome.iterations,
                    convolutions: before.convolutions + outcome.convolutions,
                    ..outcome
                };
                Ok(())
            }
            Err(Error::NotConverged(mut report)) => {
                report.time = Some(instant.time);
                self.outcome = Outcome {
                    iterations: report.iterations,
                    residual: report.residual,
                    certificate: report.certificate,
                    ..Outcome::default()
                };
                Err(Error::NotConverged(report))
            }
            Err(error) => Err(error),
        }
    }

    /// Estimated error of the stress at the end of the step, where steps are adaptive or layers creep differently.
    fn local_error(&mut self, instant: Instant) -> Option<f64> {
        let rigid = undeformed(&self.simulation, &self.dents, &self.moving);
        let ends = Ends {
            approach: self.state.approach,
            advance: self.state.approach - self.previous.approach,
            before: (&self.previous.pressure, &self.previous.unit_displacement),
            now: (&self.state.pressure, &self.state.unit_displacement),
        };
        match &mut self.past {
            Past::Memory(_) if self.timeline.pace().is_none() => None,
            Past::Memory(_) | Past::Waves(_) if instant.jump => Some(0.0),
            Past::Memory(memory) => Some(memory.error(ends, &self.gap, rigid)),
            Past::Waves(waves) => Some(waves.error(ends, rigid)),
            Past::Constant(_) | Past::Direct(_) => None,
        }
    }

    fn keep_as_third(&mut self) {
        let rigid = undeformed(&self.simulation, &self.dents, &self.moving);
        match &mut self.past {
            Past::Memory(memory) => memory.keep_as_third(&self.state.unit_displacement, &self.gap, rigid),
            Past::Waves(waves) => waves.keep_as_third(&self.state.pressure),
            Past::Constant(_) | Past::Direct(_) => {}
        }
    }

    /// Whether the memory holds the state before the last row, one row after it.
    fn knows_the_state_before(&self) -> bool {
        match &self.past {
            Past::Memory(memory) => memory.has_third(),
            Past::Waves(waves) => waves.has_third(),
            Past::Constant(_) | Past::Direct(_) => false,
        }
    }

    /// Whether the step under way has no pressure at either end.
    fn is_apart(&self) -> bool {
        match &self.past {
            Past::Memory(memory) => memory.is_apart(),
            Past::Waves(waves) => waves.is_apart(),
            Past::Constant(_) | Past::Direct(_) => false,
        }
    }

    /// How long the first step of a smooth piece is: a twentieth of it at most, or as the material and the load say.
    fn set_first_step(&mut self) {
        let Some(piece) = self.timeline.piece() else { return };
        let longest = piece.length / 20.0;
        let soon = 1e-3 * longest;
        let end = piece.start + soon;
        let clocks = self.simulation.thermal.iter().map(|body| body.clock.elapsed(piece.start, end) / soon);
        let creep = &self.simulation.creep;
        let laboratory = f64::from(u8::from(!creep.terms.is_empty() || creep.fluidity > 0.0));
        let rate = clocks.fold(laboratory, f64::max);
        let load = match self.timeline.stage(&self.simulation).control {
            Control::Approach => None,
            Control::Load => Some(piece.slope(soon)),
            Control::Pressure => Some(piece.slope(soon) * self.simulation.grid.area()),
        };
        let first = match &mut self.past {
            Past::Memory(memory) => memory.first_step(longest, load, piece.after_jump, rate),
            Past::Waves(waves) => waves.first_step(longest, load, piece.after_jump),
            Past::Constant(_) | Past::Direct(_) => return,
        };
        self.timeline.restart(first);
    }

    /// Whether the event that ends the stage happens in the step under way, which is then cut there.
    fn find_event(&mut self, instant: &mut Instant) -> Result<bool> {
        let Some(event) = self.timeline.stage(&self.simulation).until else { return Ok(false) };
        // No load is no contact.
        let event =
            if matches!(event, Event::Load(0.0) | Event::Pressure(0.0)) { Event::ContactLost } else { event };
        if instant.jump && instant.dt == 0.0 && self.timeline.stage(&self.simulation).after_jump {
            return Ok(false);
        }
        let (signal, tolerance) = self.signal(event, self.reached_now(), *instant);
        if self.timeline.side == 0.0 {
            // The value must be left before it can be reached, and what never touched is not lost: from the last row on,
            // else from this one on.
            self.timeline.side = match event {
                Event::ContactLost => f64::from(u8::from(self.reached.load > 0.0)),
                _ => {
                    let (start, _) = self.signal(event, self.reached, *instant);
                    if start.abs() > tolerance { start.signum() } else { 0.0 }
                }
            };
        }
        let side = self.timeline.side;
        if side == 0.0 {
            return Ok(false);
        }
        let met = |signal: f64| match event {
            Event::ContactLost => signal <= 0.0 && -signal <= tolerance,
            _ => signal.abs() <= tolerance,
        };
        if side * signal > 0.0 && !met(signal) {
            return Ok(false);
        }
        if instant.jump || met(signal) {
            return Ok(true);
        }
        let before = match (event, instant.control) {
            // The distance between the bodies is known only of open ones.
            (Event::ContactLost, Control::Approach) => f64::NAN,
            _ => side * self.signal(event, self.reached, *instant).0,
        };
        let mut enclosure = Enclosure::new(instant.dt, before, side * signal);
        while let Some(dt) = enclosure.guess() {
            self.try_again(instant, dt)?;
            let (signal, _) = self.signal(event, self.reached_now(), *instant);
            if met(signal) {
                return Ok(true);
            }
            enclosure.narrow(instant.dt, side * signal);
        }
        if instant.dt != enclosure.far() {
            self.try_again(instant, enclosure.far())?;
        }
        Ok(true)
    }

    /// The quantity of an event less its value, and what counts as none.
    fn signal(&self, event: Event, reached: Reached, instant: Instant) -> (f64, f64) {
        let area = self.simulation.grid.area();
        let Reached { approach, load } = self.timeline.largest;
        let [deepest, heaviest] = [approach.max(reached.approach.abs()), load.max(reached.load)];
        match event {
            Event::Approach(value) => (reached.approach - value, MET * deepest.max(value.abs())),
            Event::Load(value) => (reached.load - value, MET * heaviest.max(value)),
            Event::Pressure(value) => (reached.load / area - value, MET * value.max(heaviest / area)),
            Event::ContactLost if instant.control == Control::Approach => {
                (reached.approach - minimum(&self.gap), MET * deepest)
            }
            // Under a load the bodies touch as long as there is any.
            Event::ContactLost => (reached.load, 0.0),
        }
    }

    /// Approach and load of the state, where stages ask for them.
    fn reached_now(&self) -> Reached {
        let programme = &self.simulation.loading;
        let load = if programme.stages.len() > 1 || programme.has_events() {
            sum(&self.state.pressure) * self.simulation.grid.cell_area()
        } else {
            0.0
        };
        Reached { approach: self.state.approach, load }
    }

    /// How long the step is in laboratory time and on the clock of each body.
    fn measure_step(&mut self, instant: Instant) {
        let start = self.timeline.last().map_or(instant.time, |last| last.time);
        let clocks = self.simulation.thermal.iter().map(|body| &body.clock);
        let clocked = clocks.map(|clock| clock.elapsed(start, instant.time));
        self.lengths.iter_mut().zip(std::iter::once(instant.dt).chain(clocked)).for_each(|(l, x)| *l = x);
    }

    /// The last row (after an error: the state that the failed solve reached); `None` before the first.
    pub fn last(&self) -> Option<Step<'_>> {
        let (index, instant) = self.current?;
        Some(Step {
            index,
            coordinate: Coordinate::Time(instant.time),
            instant: Some(instant),
            control: instant.control,
            simulation: &self.simulation,
            hardness: cap(&self.simulation, &self.hardness),
            state: &self.state,
            gap: &self.gap,
            compliance: self.compliance,
            outcome: self.outcome,
            remembered: Remembered::Past(&self.past),
            time_error: self.time_error,
            dents: self.dents.as_ref(),
            meter: Some(&self.meter),
            datum: self.datum(),
            friction: self.moving.as_ref().map(|_| self.friction),
        })
    }

    /// What the displacements of the state are measured from: see [`datum`].
    fn datum(&self) -> f64 {
        if !self.simulation.is_up_to_a_constant() {
            return 0.0;
        }
        let mut u = vec![0.0; self.simulation.grid.len()];
        self.past.remembered(&mut u);
        u.iter_mut().zip(&self.state.unit_displacement).for_each(|(g, unit)| *g += self.compliance * unit);
        datum(&self.simulation, &u)
    }
}

impl Drive for March {
    fn advance(&mut self) -> Result<Option<Step<'_>>> {
        March::advance(self)
    }

    fn last(&self) -> Option<Step<'_>> {
        March::last(self)
    }

    fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    fn axis(&self) -> Axis {
        Axis::Time
    }

    fn planned(&self) -> Vec<f64> {
        self.simulation.plan().instants.iter().map(|instant| instant.time).collect()
    }

    fn rows_expected(&self) -> Option<usize> {
        March::rows_expected(self)
    }

    fn done(&self) -> usize {
        self.done
    }

    fn finished(&self) -> bool {
        March::finished(self)
    }

    fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        March::interrupt_with(self, flag);
    }

    fn checkpoint(&self) -> Checkpoint<'_> {
        March::checkpoint(self)
    }

    fn between(&self, time: f64) -> Option<Between> {
        March::between(self, time)
    }

    fn view<'a>(&'a self, between: &'a Between) -> Option<Step<'a>> {
        Some(March::view(self, between))
    }
}
