//! Steady states of motion: one contact for each velocity.
//!
//! Find 0 <= p <= H with the load W and the contact conditions on g = A p + h - w, where A has the symbol K^(q) C~(q.v). A is not
//! symmetric, so there is no energy to minimise, but it is strongly monotone: the solution is unique.
//!
//! ```text
//! loop:
//!     u = A p,  w from the free cells,  r = u + h - w;  stop where the contact conditions hold
//!     q = contact of the symmetric operator M = |A|²/Re A and the gap h + u - M p        (metric step)
//!     p = q after Newton steps on its contact set, where they halve the residual; else q
//! ```
//!
//! The metric step contracts by max sin δ < 1 in the norm of M, δ = arg A^, from any start: |1 - A^/M^| = |sin δ|, and the
//! solution of a convex contact is a 1-Lipschitz function of its gap in that norm. Newton's steps make it fast
//! (docs/sliding.md).

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::influence::{Branch, influence};
use super::metric::{Metric, MetricKernel};
use super::newton::OnSet;
use super::torus::{Spectrum, Torus};
use super::{Direction, Forces, Friction, Slopes, Streaming, gap_force};
use crate::contact::{self, ContactState, Hardness, Outcome, Prescribed, Problem, Solver, SolverOptions};
use crate::convolution::Convolution;
use crate::drive::Coordinate;
use crate::error::{Error, NotConverged, Result};
use crate::grid::Boundary;
use crate::load::{Control, Course, History, Stage};
use crate::operator::Operator;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::{Recalled, Recorder, Step};

/// What moves, and how fast.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyMotion {
    /// Direction of the velocity.
    pub direction: Direction,
    /// Velocities \[m/s\], not negative; each is solved from the one before it.
    pub velocities: Vec<f64>,
    /// Slopes of the gap of the simulation.
    pub slopes: Slopes,
    /// A shear stress on the area in contact \[Pa\], for [`Friction::total`].
    pub shear_stress: Option<f64>,
}

impl SteadyMotion {
    /// Checks all that can be known before the first velocity, besides [`Simulation::validate`].
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the quantity.
    pub fn validate(&self, simulation: &Simulation) -> Result<()> {
        Streaming::new(simulation)?;
        held_load(simulation)?;
        validate(simulation, self)
    }
}

/// Newton steps after a metric step, at most, and those without progress.
const NEWTON: usize = 20;
const PATIENCE: usize = 2;
/// The residual after them, over that before the metric step, at most.
const ENOUGH: f64 = 0.7;
/// Doublings of the torus of a free domain, at most.
const DOUBLINGS: usize = 4;
/// Metric steps without Newton steps after some that were rejected, at most.
const SKIP: usize = 3;

/// A sweep over velocities.
///
/// ```
/// use asperity::{material::{Creep, CreepTerm}, sliding::{Direction, Slopes, Steady, SteadyMotion}};
/// use asperity::{Boundary, Control, Grid, History, Loading, march::Simulation, surface::{Part, Shape, undeformed_gap}};
/// // A cylinder of 10 mm rolls over a Zener solid that yields five times its instantaneous compliance in 10 ms.
/// let grid = Grid::line(128, 4e-3)?;
/// let parts = [Part::Shape { shape: Shape::Cylinder { radius: 10e-3 }, center: [0.0, 0.0] }];
/// let gap = undeformed_gap(&grid, &parts)?;
/// let creep = Creep {
///     instantaneous: 1e-8, fluidity: 0.0, terms: vec![CreepTerm { compliance: 4e-8, retardation_time: 0.01 }],
/// };
/// let slopes = Slopes::of(&grid, Boundary::Free, &parts, &gap)?;
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
    torus: Torus,
    load: f64,
    gap: Vec<f64>,
    state: ContactState,
    outcome: Outcome,
    friction: Friction,
    recorder: Recorder,
    done: usize,
    interrupt: Option<Arc<AtomicBool>>,
}

/// The operators of one velocity.
struct Operators {
    /// A over the relaxed compliance, and 1/A.
    steady: Spectrum,
    inverse: Spectrum,
    metric: Metric,
}

impl Steady {
    /// Checks the simulation and plans the transforms. Of the simulation count the grid, the body, the gap, the hardness, the
    /// solver, the material, and the load: a load or a mean pressure that is held.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the quantity; [`Error::Infeasible`] where the load exceeds what the hardness carries.
    pub fn new(simulation: Simulation, motion: SteadyMotion) -> Result<Self> {
        motion.validate(&simulation)?;
        simulation.validate()?;
        let streaming = Streaming::new(&simulation)?;
        let load = held_load(&simulation)?;
        let grid = simulation.grid;
        let lengths = match simulation.boundary {
            Boundary::Periodic => grid.cells(),
            Boundary::Free => {
                let [nx, ny] = grid.cells();
                [even_length(2 * nx), if grid.is_line() { 1 } else { even_length(2 * ny) }]
            }
        };
        let recorder = Recorder::new(simulation.columns()?);
        Ok(Steady {
            torus: Torus::new(grid.cells(), lengths),
            gap: simulation.gap.iter().copied().collect(),
            state: ContactState::new(grid.len()),
            outcome: Outcome::default(),
            friction: Friction::default(),
            done: 0,
            interrupt: None,
            simulation,
            motion,
            streaming,
            load,
            recorder,
        })
    }

    /// Stops within one iteration of the solver when `flag` becomes true.
    pub fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = Some(flag);
    }

    /// What is simulated.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// What moves.
    pub fn motion(&self) -> &SteadyMotion {
        &self.motion
    }

    /// The creep functions of the bodies that stream by.
    pub fn streaming(&self) -> &Streaming {
        &self.streaming
    }

    /// Velocities done.
    pub fn done(&self) -> usize {
        self.done
    }

    /// Goes on after `done` velocities from the pressure of the last of them \[Pa\].
    ///
    /// # Errors
    /// [`Error::Invalid`] where there are fewer velocities, or the pressure has not one number for each cell.
    pub fn resume(&mut self, done: usize, pressure: &[f64]) -> Result<()> {
        if done > self.motion.velocities.len() || pressure.len() != self.simulation.grid.len() {
            return Err(Error::invalid("checkpoint", format!("{done} velocities"), "one of this sweep"));
        }
        self.done = done;
        self.state.pressure.copy_from_slice(pressure);
        Ok(())
    }

    /// The next steady state, or `None` at the end. Its row has the velocity in place of the time.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the velocity; [`Steady::last`] then has the best state.
    /// [`Error::Interrupted`].
    pub fn advance(&mut self) -> Result<Option<Step<'_>>> {
        let Some(velocity) = self.motion.velocities.get(self.done).copied() else { return Ok(None) };
        let solved = self.solve(velocity);
        self.friction = self.forces(velocity);
        self.measure(velocity);
        self.outcome = solved?;
        self.done += 1;
        Ok(Some(self.view(velocity, self.done - 1, Some(&self.recorder))))
    }

    /// The last steady state; after an error the best one reached. `None` before the first.
    pub fn last(&self) -> Option<Step<'_>> {
        let index = self.done.max(1) - 1;
        let velocity = *self.motion.velocities.get(index)?;
        (self.state.pressure.iter().any(|p| *p > 0.0))
            .then(|| self.view(velocity, index, Some(&self.recorder)))
    }

    fn measure(&mut self, velocity: f64) {
        let mut recorder = std::mem::take(&mut self.recorder);
        self.view(velocity, self.done, None).record(&mut recorder);
        self.recorder = recorder;
    }

    fn view<'a>(&'a self, velocity: f64, index: usize, recorder: Option<&'a Recorder>) -> Step<'a> {
        Step {
            index,
            coordinate: Coordinate::Velocity(velocity),
            instant: None,
            control: Control::Load,
            simulation: &self.simulation,
            hardness: Hardness::Uniform(self.simulation.hardness),
            state: &self.state,
            gap: &self.gap,
            compliance: self.streaming.relaxed(),
            outcome: self.outcome,
            recalled: Recalled::Nothing,
            time_error: None,
            undeformed: None,
            processes: &[],
            recorder,
            friction: Some(self.friction),
        }
    }

    /// Solves for one velocity, from the pressure of the state.
    fn solve(&mut self, velocity: f64) -> Result<Outcome> {
        let Operators { steady, inverse, mut metric } = self.operators(velocity)?;
        let (grid, n) = (self.simulation.grid, self.simulation.grid.len());
        let options = self.simulation.solver;
        let gap = std::mem::take(&mut self.gap);
        let problem = Problem {
            gap: &gap,
            compliance: self.streaming.relaxed(),
            hardness: Hardness::Uniform(self.simulation.hardness),
            prescribed: Prescribed::Load(self.load),
        };
        let mut solver = Solver::new(options.method, &metric);
        let mut total = Outcome::default();
        let mut shifted = vec![0.0; n];
        let mut image = vec![0.0; n];
        let mut rejected: usize = 0;
        let mut skip = 0;
        let mut found = self.begin(&problem, &options, &mut metric, &mut total);
        if found.is_ok() {
            found = loop {
                self.torus.apply_into(&steady, &self.state.pressure, &mut self.state.unit_displacement);
                let rated = contact::assess(&problem, &grid, options.tolerance, &mut self.state);
                let outcome =
                    Outcome { iterations: total.iterations, convolutions: total.convolutions + 1, ..rated };
                total.convolutions += 1;
                self.outcome = outcome;
                tracing::debug!(
                    iterations = total.iterations,
                    residual = outcome.residual,
                    convolutions = total.convolutions,
                    rejected,
                    "steady"
                );
                if outcome.residual <= options.tolerance {
                    break Ok(outcome);
                }
                if total.iterations >= options.max_iterations {
                    break Err(not_converged(&options, &outcome, velocity));
                }
                // Metric step.
                let c = problem.compliance;
                metric.apply_into(&self.state.pressure, &mut image);
                for (cell, to) in shifted.iter_mut().enumerate() {
                    *to = gap[cell] + c * (self.state.unit_displacement[cell] - image[cell]);
                }
                let metric_options = SolverOptions {
                    tolerance: f64::max(0.1 * options.tolerance, 0.1 * outcome.residual).clamp(1e-13, 0.1),
                    ..options
                };
                let step = Problem { gap: &shifted, ..problem };
                let mut state = self.state.clone();
                let interrupt = self.interrupt.as_deref();
                match solver.solve(&mut metric, &step, &metric_options, &mut state, interrupt) {
                    Ok(done) => {
                        total.iterations += done.iterations + 1;
                        total.convolutions += done.convolutions + 1;
                    }
                    Err(Error::NotConverged(report)) => {
                        total.iterations += report.iterations + 1;
                        total.convolutions += report.iterations + 1;
                    }
                    Err(error) => break Err(error),
                }
                let before = outcome.residual;
                self.state.pressure.copy_from_slice(&state.pressure);
                if skip > 0 {
                    skip -= 1;
                    continue;
                }
                let work = [&mut shifted, &mut image];
                let newton =
                    Newton { problem: &problem, options: &options, steady: &steady, inverse: &inverse };
                match newton.improve(self, before, work, &mut total) {
                    true => rejected = 0,
                    false => {
                        self.state.pressure.copy_from_slice(&state.pressure);
                        rejected += 1;
                        skip = rejected.min(SKIP);
                    }
                }
            };
        }
        self.gap = gap;
        self.outcome =
            Outcome { iterations: total.iterations, convolutions: total.convolutions, ..self.outcome };
        found
    }

    /// Makes the pressure of the state feasible; where there is none, it is that of the contact of M.
    fn begin(
        &mut self,
        problem: &Problem,
        options: &SolverOptions,
        metric: &mut Metric,
        total: &mut Outcome,
    ) -> Result<Outcome> {
        if self.state.pressure.iter().any(|p| *p > 0.0) {
            contact::make_feasible(problem, &self.simulation.grid, &mut self.state)?;
            return Ok(Outcome::default());
        }
        let rough = SolverOptions { tolerance: options.tolerance.max(1e-3), ..*options };
        let mut solver = Solver::new(options.method, metric);
        let interrupt = self.interrupt.as_deref();
        let outcome = solver.solve(metric, problem, &rough, &mut self.state, interrupt)?;
        total.iterations += outcome.iterations;
        total.convolutions += outcome.convolutions;
        Ok(outcome)
    }

    /// A and M at a velocity, over the relaxed compliance.
    fn operators(&mut self, velocity: f64) -> Result<Operators> {
        let steady = match self.simulation.boundary {
            Boundary::Periodic => self.periodic(velocity),
            Boundary::Free => self.free(velocity)?,
        };
        let Simulation { grid, boundary, kernel, .. } = &self.simulation;
        let along = self.motion.direction.unit().map(|c| c * velocity);
        let inverse = Spectrum(
            steady
                .0
                .iter()
                .map(|a| if a.norm_sqr() > 0.0 { a.inv() } else { rustfft::num_complex::Complex64::ZERO })
                .collect(),
        );
        let metric_kernel = MetricKernel {
            elastic: kernel.clone(),
            streaming: self.streaming.clone(),
            velocity: along,
            unit: self.streaming.relaxed(),
        };
        let metric = Metric::new(*grid, *boundary, &steady, self.torus.lengths(), Arc::new(metric_kernel));
        Ok(Operators { steady, inverse, metric })
    }

    /// A on a periodic domain, from its symbol.
    fn periodic(&self, velocity: f64) -> Spectrum {
        let Simulation { grid, kernel, .. } = &self.simulation;
        let streaming = &self.streaming;
        let unit = streaming.relaxed();
        let along = self.motion.direction.unit().map(|c| c * velocity);
        let fundamental = grid.size().map(|length| std::f64::consts::TAU / length);
        let cells = grid.cells();
        self.torus.spectrum(|kx, ky| {
            if (kx, ky) == (0, 0) {
                return (kernel.uniform().unwrap_or(0.0) * streaming.at(0.0) / unit).re.into();
            }
            let q = |k: i64, axis: usize| {
                if grid.is_line() && axis == 1 { 0.0 } else { k as f64 * fundamental[axis] }
            };
            // A wave of two cells is the mean of its two directions.
            let signs = |k: i64, axis: usize| {
                if 2 * k.unsigned_abs() as usize == cells[axis] { [1, -1] } else { [1, 1] }
            };
            let mut compliance = rustfft::num_complex::Complex64::ZERO;
            for sx in signs(kx, 0) {
                for sy in signs(ky, 1) {
                    let omega = along[0] * q(sx * kx, 0) + along[1] * q(sy * ky, 1);
                    compliance += 0.25 * streaming.at(omega);
                }
            }
            compliance * kernel.symbol(q(kx, 0).abs(), q(ky, 1).abs()) / unit
        })
    }

    /// A on a free domain, on a torus that is long enough for its real part to be positive: the memory may reach far.
    fn free(&mut self, velocity: f64) -> Result<Spectrum> {
        let axis = usize::from(self.motion.direction == Direction::Y);
        let mut least = f64::NAN;
        for _ in 0..=DOUBLINGS {
            let lengths = self.torus.lengths();
            let spectrum = self.on_torus(velocity, lengths);
            least = spectrum.0.iter().fold(f64::INFINITY, |least, a| least.min(a.re));
            if least > 0.0 {
                return Ok(spectrum);
            }
            let mut longer = lengths;
            longer[axis] *= 2;
            self.torus = Torus::new(self.simulation.grid.cells(), longer);
        }
        Err(Error::invalid(
            "smallest real part of the operator of motion, over the largest",
            format!("{least:e}"),
            "greater than 0: take a larger domain",
        ))
    }

    /// A on a torus of these lengths, from its influence coefficients.
    fn on_torus(&self, velocity: f64, [mx, my]: [usize; 2]) -> Spectrum {
        let unit = self.streaming.relaxed();
        let grid = &self.simulation.grid;
        let along_y = self.motion.direction == Direction::Y;
        // Along y the coefficients are those of the turned grid along x.
        let (turned, [m, across]) = match along_y {
            false => (*grid, [mx, my]),
            true => (transposed(grid), [my, mx]),
        };
        let branches: Vec<Branch> = self
            .streaming
            .branches()
            .map(|(compliance, time)| Branch { compliance: compliance / unit, length: time * velocity })
            .collect();
        let (still, moving): (Vec<Branch>, Vec<Branch>) = branches.into_iter().partition(|b| b.length <= 0.0);
        let relaxed: f64 = still.iter().map(|b| b.compliance).sum();
        let reach = [m / 2, across / 2];
        let k = influence(&turned, reach, self.streaming.instantaneous() / unit + relaxed, &moving);
        let row = |j: usize| &k[j * (2 * reach[0] + 1)..][..2 * reach[0] + 1];
        let least =
            if grid.is_line() { row(0).iter().fold(f64::INFINITY, |least, k| least.min(*k)) } else { 0.0 };
        let mut torus = vec![0.0; mx * my];
        for j in 0..across {
            let from = row(j.min(across - j));
            for i in 0..m {
                // The place -m/2 stands for both ends: their mean keeps the real part of the spectrum positive.
                let value = match 2 * i == m {
                    true => 0.5 * (from[0] + from[m]),
                    false if 2 * i < m => from[i + m / 2],
                    false => from[i - m / 2],
                };
                torus[if along_y { j * my + i } else { i * my + j }] = value - least;
            }
        }
        Torus::new([mx, my], [mx, my]).transform(&torus)
    }

    fn forces(&mut self, velocity: f64) -> Friction {
        let grid = self.simulation.grid;
        let (direction, boundary) = (self.motion.direction, self.simulation.boundary);
        let Ok(pressure) = ndarray::ArrayView2::from_shape(grid.shape(), &self.state.pressure) else {
            return Friction::default();
        };
        let mut forces = Forces::of(&grid, boundary, pressure, &self.motion.slopes, direction);
        if self.streaming.branches().next().is_none() {
            // Bodies that remember nothing lose nothing: what the sums are is the error of the grid.
            (forces.force, forces.side) = (0.0, 0.0);
        }
        let c = self.streaming.relaxed();
        let gap = ndarray::Array2::from_shape_fn(grid.shape(), |(i, j)| {
            let n = i * grid.cells()[1] + j;
            self.gap[n] + c * self.state.unit_displacement[n]
        });
        let off = gap_force(&grid, boundary, pressure, gap.view(), direction);
        let area = grid.cell_area() * self.state.pressure.iter().filter(|p| **p > 0.0).count() as f64;
        let coefficient = if forces.load > 0.0 { forces.force / forces.load } else { 0.0 };
        // What is lost is the work of the second estimate, which is never negative.
        let second = match self.loss(velocity) {
            Some(loss) => loss,
            None if forces.force == 0.0 => 0.0,
            None => forces.force - off,
        };
        let scale = forces.force.abs().max(second.abs());
        let rounding = 1e-13 * forces.load;
        Friction {
            velocity,
            distance: 0.0,
            force: forces.force,
            side: forces.side,
            coefficient,
            uncertainty: if scale > rounding { (forces.force - second).abs() / scale } else { 0.0 },
            moment: forces.moment,
            power: second.max(0.0) * velocity,
            total: self
                .motion
                .shear_stress
                .map_or(f64::NAN, |stress| coefficient + stress * area / forces.load),
        }
    }

    /// The second estimate of friction on a periodic domain, Σ (q.s) Im A |p^|² >= 0 \[N\].
    fn loss(&mut self, velocity: f64) -> Option<f64> {
        let Simulation { grid, boundary, kernel, .. } = &self.simulation;
        if *boundary != Boundary::Periodic {
            return None;
        }
        let streaming = &self.streaming;
        let unit = self.motion.direction.unit();
        let fundamental = grid.size().map(|length| std::f64::consts::TAU / length);
        let cells = grid.cells();
        let spectrum = self.torus.spectrum(|kx, ky| {
            let alternates = |k: i64, axis: usize| 2 * k.unsigned_abs() as usize == cells[axis];
            let q = |k: i64, axis: usize| match grid.is_line() && axis == 1 || alternates(k, axis) {
                true => 0.0,
                false => k as f64 * fundamental[axis],
            };
            let along = unit[0] * q(kx, 0) + unit[1] * q(ky, 1);
            let size =
                [kx as f64 * fundamental[0], if grid.is_line() { 0.0 } else { ky as f64 * fundamental[1] }];
            let loss = if along == 0.0 {
                0.0
            } else {
                along * kernel.symbol(size[0].abs(), size[1].abs()) * streaming.at(along * velocity).im
            };
            loss.into()
        });
        let energy = self.torus.energy(&spectrum, |s, _| s.re, &self.state.pressure);
        Some(energy * self.simulation.grid.cell_area())
    }
}

/// Newton steps on the contact set of the state.
struct Newton<'a> {
    problem: &'a Problem<'a>,
    options: &'a SolverOptions,
    steady: &'a Spectrum,
    inverse: &'a Spectrum,
}

impl Newton<'_> {
    /// Takes Newton steps while they halve the residual. False where they did not bring it below half of `before`: the pressure
    /// is then to be taken back.
    fn improve(
        &self,
        steady: &mut Steady,
        before: f64,
        [first, second]: [&mut Vec<f64>; 2],
        total: &mut Outcome,
    ) -> bool {
        let grid = steady.simulation.grid;
        let c = self.problem.compliance;
        let (mut least, mut stalled) = (f64::INFINITY, 0);
        let mut best = steady.state.clone();
        for _ in 0..=NEWTON {
            let state = &mut steady.state;
            steady.torus.apply_into(self.steady, &state.pressure, &mut state.unit_displacement);
            total.convolutions += 1;
            let residual = contact::assess(self.problem, &grid, self.options.tolerance, state).residual;
            // The set may change a few times before the residual falls.
            stalled = if residual < 0.7 * least { 0 } else { stalled + 1 };
            if residual < least {
                least = residual;
                best = state.clone();
            }
            if residual <= self.options.tolerance || stalled > PATIENCE {
                break;
            }
            let hardness = self.problem.hardness;
            let overlap = |n: usize| self.problem.gap[n] + c * state.unit_displacement[n] - state.approach;
            let free = |n: &usize| {
                let (p, h) = (state.pressure[*n], hardness.at(*n));
                let touches = self.problem.gap[*n] < f64::INFINITY;
                touches && (p > 0.0 && p < h || p <= 0.0 && overlap(*n) < 0.0 || p >= h && overlap(*n) > 0.0)
            };
            let cells: Vec<usize> = (0..state.pressure.len()).filter(free).collect();
            if cells.is_empty() {
                break;
            }
            let right: Vec<f64> = cells.iter().map(|n| overlap(*n) / c).collect();
            let mut on_set = OnSet {
                torus: &mut steady.torus,
                operator: self.steady,
                inverse: self.inverse,
                cells: &cells,
                work: [&mut *first, &mut *second],
                convolutions: 0,
            };
            let change = on_set.solve(&right);
            // The preconditioner costs as much as the operator on the torus.
            total.convolutions += on_set.convolutions;
            total.iterations += 1;
            cells.iter().zip(&change).for_each(|(n, d)| state.pressure[*n] += d);
            if contact::make_feasible(self.problem, &grid, state).is_err() {
                break;
            }
        }
        steady.state = best;
        least < ENOUGH * before
    }
}

fn validate(simulation: &Simulation, motion: &SteadyMotion) -> Result<()> {
    if motion.velocities.is_empty() {
        return Err(Error::invalid("velocities", "none", "one at least"));
    }
    if let Some(v) = motion.velocities.iter().find(|v| !(v.is_finite() && **v >= 0.0)) {
        return Err(Error::invalid("velocity", format!("{v} m/s"), "finite and not negative"));
    }
    if motion.slopes.x.dim() != simulation.grid.shape() || motion.slopes.y.dim() != simulation.grid.shape() {
        return Err(Error::invalid(
            "shape of the slopes",
            format!("{:?}", motion.slopes.x.dim()),
            format!("{:?}, that of the grid", simulation.grid.shape()),
        ));
    }
    if let (Direction::Angle(angle), Boundary::Free) = (motion.direction, simulation.boundary) {
        return Err(Error::invalid(
            "direction of motion on a free domain",
            format!("{:.4} degrees", angle.to_degrees()),
            "x or y; other directions need a periodic domain",
        ));
    }
    if simulation.grid.is_line() && motion.direction != Direction::X {
        return Err(Error::invalid("direction of motion of a line contact", "not x", "x"));
    }
    if simulation.layers.is_some() {
        return Err(Error::invalid(
            "body of a steady state of motion",
            "layers that creep differently",
            "layers and bodies of one relative creep",
        ));
    }
    if simulation.boundary == Boundary::Free && !simulation.kernel.is_half_space() {
        return Err(Error::invalid(
            "body of a steady state of motion on a free domain",
            "layers",
            "a half-space, or boundary = \"periodic\"",
        ));
    }
    if simulation.hardness_map.is_some() {
        return Err(Error::invalid(
            "hardness of a steady state of motion",
            "different from cell to cell",
            "one number: the material streams by",
        ));
    }
    let refused = |q: &&Quantity| q.is_energy() || **q == Quantity::ContactStiffness;
    if let Some(quantity) = simulation.quantities.list.iter().find(refused) {
        return Err(Error::invalid(
            "quantity of a steady state of motion",
            quantity.name(),
            "one of the state of a contact; energies and stiffness belong to a run in time",
        ));
    }
    Ok(())
}

/// The load that is held \[N\].
fn held_load(simulation: &Simulation) -> Result<f64> {
    let held = match simulation.loading.stages[..] {
        [Stage { control, course: Course::Given(History::Step { value }), until: None, .. }] => {
            Some((control, value))
        }
        _ => None,
    };
    match held {
        Some((Control::Load, value)) if value > 0.0 => Ok(value),
        Some((Control::Pressure, value)) if value > 0.0 => Ok(value * simulation.grid.area()),
        _ => Err(Error::invalid(
            "load of a steady state of motion",
            "not a load or a pressure above 0 that is held",
            "control = \"load\" or \"pressure\" with history = { kind = \"step\", value = ... }",
        )),
    }
}

/// An even length of at least `minimum` that transforms fast.
fn even_length(minimum: usize) -> usize {
    2 * Convolution::good_length(minimum.div_ceil(2))
}

/// The grid with x and y exchanged.
fn transposed(grid: &crate::grid::Grid) -> crate::grid::Grid {
    let ([nx, ny], [lx, ly]) = (grid.cells(), grid.size());
    crate::grid::Grid::new([ny, nx], [ly, lx]).unwrap_or(*grid)
}

fn not_converged(options: &SolverOptions, outcome: &Outcome, velocity: f64) -> Error {
    Error::NotConverged(NotConverged {
        method: "steady motion",
        iterations: outcome.iterations,
        residual: outcome.residual,
        tolerance: options.tolerance,
        certificate: outcome.certificate,
        time: None,
        velocity: Some(velocity),
    })
}
