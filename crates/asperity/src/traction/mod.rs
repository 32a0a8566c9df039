//! Tractions on the surfaces that depend on the gap between them: adhesion, fluid pressure.
//!
//! The total traction is t = b + q with the traction b of the law and the contact pressure q >= 0, q g = 0. Given b the contact is
//! the same convex problem with another gap and load, so one loop around the unchanged contact solver serves every law:
//!
//! ```text
//! b = that of the last row
//! repeat:
//!     h' = h + c K b                                    one convolution
//!     q, w = contact of c K, h', load W/A - Σ b or approach w
//!     g = h' + c K q - w,   B = b(g, q),   f = B - b
//!     stop where Σ|f| <= tolerance (Σ|B| + Σ q), in which a force counts as none below 1e-4 of the largest one so far
//!     b = extrapolation of the last passes where it lowers the residual, else a plain step
//! ```
//!
//! Under a prescribed load W a pass in which Σ b alone exceeds W/A leaves no load to the contact. Then the approach is searched at
//! which the tractions carry W; an attraction that falls with the gap carries none stably, so there the surfaces are pulled off. After convergence the
//! state holds t and U = K t: what the bodies remember is the total traction.
//!
//! Each attempt at a row begins with the b of the last row, not with that of the attempt before: where several equilibria
//! exist the row is on the branch that is connected with the last one.

mod adhesion;
mod extrapolation;
mod scale;
#[cfg(test)]
mod tests;

use std::sync::atomic::AtomicBool;

pub use adhesion::{Adhesion, AdhesionLaw, FINE_TRAP, LARGEST_TRAP, own_response};
pub use scale::AdhesionScale;

use crate::contact::{
    ContactState, Outcome, Prescribed, Problem, Solver, SolverOptions, Task, not_converged,
};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::operator::Operator;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::{Loader, saved};
use asperity_sweep::{each, is_zero, minimum, sum, sums, zeros};
use extrapolation::Extrapolation;

/// Forces below this share of the largest one of the run are none.
const LEAST: f64 = 1e-4;
/// Passes after which a solve is given up.
const MOST_PASSES: usize = 500;
/// The contact of a pass is solved to this share of the tolerance of the loop.
const INNER: f64 = 0.1;
/// Approaches tried for a load that the contact does not carry.
const MOST_APPROACHES: usize = 100;

/// A law of tractions, of which each run starts its own.
pub trait TractionLaw: std::fmt::Debug + Send + Sync {
    /// The tractions of a run on this grid.
    fn start(&self, grid: &Grid) -> Box<dyn SurfaceTraction>;

    /// Tolerance of the loop, where it is not that of the contact.
    fn tolerance(&self) -> Option<f64> {
        None
    }

    /// The law of adhesion, where it is one.
    fn as_adhesion(&self) -> Option<&Adhesion> {
        None
    }

    /// What can be known to be wrong before the first solve.
    ///
    /// # Errors
    /// [`Error::Invalid`], whose parameter is a key of the case.
    fn check(&self, _simulation: &Simulation) -> Result<()> {
        Ok(())
    }
}

/// Tractions on the surfaces that depend on the gap.
pub trait SurfaceTraction: Send {
    /// Writes the traction \[Pa\] that acts on each cell, or would act if it opened; tension is negative. `gap` is g >= 0 \[m\], infinite
    /// where nothing can touch, `contact` the contact pressure q \[Pa\].
    ///
    /// # Errors
    /// Those of the law.
    fn bound(&mut self, gap: &[f64], contact: &[f64], out: &mut [f64]) -> Result<()>;

    /// The potential energy of these tractions per area of a cell \[Pa m\], Σ γ(g) with b = -dγ/dg; `None` where they have none.
    /// Where it is known, no pass may raise the total energy.
    fn energy(&self, _gap: &[f64]) -> Option<f64> {
        None
    }

    /// The least and the largest traction \[Pa\].
    fn limits(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Whether γ is concave: then no plain pass raises the energy, and no surfaces that are apart hold a load in tension stably.
    fn is_attraction(&self) -> bool {
        false
    }

    /// The step stands: what the law remembers of it is kept.
    fn commit(&mut self) {}
}

/// The loop around the contact solver.
pub(crate) struct TractionSolver {
    law: Box<dyn SurfaceTraction>,
    tolerance: Option<f64>,
    /// The traction b and the contact pressure q of the last row, with which each attempt begins.
    last: Tractions,
    now: Tractions,
    /// K b, and B of the pass.
    image: Vec<f64>,
    next: Vec<f64>,
    /// h', and then g.
    shifted: Vec<f64>,
    gap: Vec<f64>,
    extrapolation: Extrapolation,
    /// The largest Σ|B| + Σ q of all passes.
    scale: f64,
    /// Of the last solve.
    passes: usize,
    residual: f64,
    /// Σ γ(g) of the last pass \[Pa m\], where the law has it.
    potential: Option<f64>,
}

/// The parts of a total traction.
struct Tractions {
    /// b \[Pa\].
    bound: Vec<f64>,
    /// The contact pressure q with K q.
    contact: ContactState,
}

impl Tractions {
    fn none(cells: usize) -> Self {
        Tractions { bound: zeros(cells), contact: ContactState::new(cells) }
    }

    fn copy_from(&mut self, other: &Self) {
        self.bound.copy_from_slice(&other.bound);
        let (to, from) = (&mut self.contact, &other.contact);
        to.pressure.copy_from_slice(&from.pressure);
        to.unit_displacement.copy_from_slice(&from.unit_displacement);
        (to.approach, to.rounding) = (from.approach, from.rounding);
    }
}

saved! {
    TractionSolver {
        "contact": last.contact.approach, last.contact.rounding;
        "scale": scale;
    }
    fields {
        "bound": last.bound;
        "contact_pressure": last.contact.pressure;
        "contact_displacement": last.contact.unit_displacement;
    }
}

/// One pass of the loop.
#[derive(Clone, Copy)]
struct Pass {
    outcome: Outcome,
    /// Σ|B - b| over Σ|B| + Σ q.
    residual: f64,
    /// 1/2 <t, c K t> + Σ γ(g), less the work of a prescribed load.
    energy: Option<f64>,
}

impl TractionSolver {
    pub(crate) fn new(law: &dyn TractionLaw, grid: &Grid) -> Self {
        let cells = grid.len();
        TractionSolver {
            law: law.start(grid),
            tolerance: law.tolerance(),
            last: Tractions::none(cells),
            now: Tractions::none(cells),
            image: zeros(cells),
            next: zeros(cells),
            shifted: zeros(cells),
            gap: zeros(cells),
            extrapolation: Extrapolation::default(),
            scale: 0.0,
            passes: 0,
            residual: 0.0,
            potential: None,
        }
    }

    /// Takes back what `save_own` gave.
    ///
    /// # Errors
    /// Where it belongs to another simulation.
    pub(crate) fn load(&mut self, from: &Loader<'_>) -> Result<()> {
        self.load_own(from)?;
        self.now.copy_from(&self.last);
        Ok(())
    }

    /// The step stands.
    pub(crate) fn commit(&mut self) {
        self.law.commit();
        self.last.copy_from(&self.now);
    }

    /// The contact pressures q of the last row and of the last attempt \[Pa\].
    pub(crate) fn contact(&self) -> [&[f64]; 2] {
        [&self.last.contact.pressure, &self.now.contact.pressure]
    }

    /// The traction b of the last attempt \[Pa\]; tension is negative.
    pub(crate) fn bound(&self) -> &[f64] {
        &self.now.bound
    }

    /// A quantity of the last attempt on cells of this area \[m²\].
    pub(crate) fn quantity(&self, quantity: Quantity, cell_area: f64) -> Option<f64> {
        Some(match quantity {
            Quantity::AdhesiveLoad => -cell_area * sum(&self.now.bound),
            Quantity::RepulsiveLoad => cell_area * sum(&self.now.contact.pressure),
            Quantity::AdhesionEnergy => cell_area * self.potential?,
            Quantity::OuterIterations => self.passes as f64,
            Quantity::AdhesionResidual => self.residual,
            _ => return None,
        })
    }

    /// Solves for the total traction, which `state` holds in the end; its approach is where the search starts.
    ///
    /// # Errors
    /// [`Error::NotConverged`], after which `state` holds the last pass; [`Error::PulledOff`]; those of the contact and of the law.
    pub(crate) fn solve(&mut self, solver: &mut Solver, task: Task) -> Result<Outcome> {
        let Task { operator, problem, options, state, interrupt } = task;
        self.now.copy_from(&self.last);
        self.passes = 0;
        let tolerance = self.tolerance.unwrap_or(options.tolerance);
        let mut run =
            Run { own: self, solver, operator, options, tolerance, interrupt, total: Outcome::default() };
        let solved = match problem.prescribed {
            Prescribed::Approach(_) => run.solve(problem),
            Prescribed::Load(load) => match run.solve_under(problem, load) {
                Err(Error::Infeasible { .. }) if run.own.law.is_attraction() => {
                    let unit = run.operator.grid().units("N");
                    self.now.copy_from(&self.last);
                    return Err(Error::PulledOff { load, unit, time: f64::NAN, last: None });
                }
                Err(Error::Infeasible { .. }) => run.search_approach(problem, load, state.approach),
                solved => solved,
            },
        };
        let total = run.total;
        if !matches!(solved, Ok(()) | Err(Error::NotConverged(_))) {
            return solved.map(|()| total);
        }
        self.residual = total.residual;
        let Tractions { bound, contact } = &self.now;
        each(&mut state.pressure, (&contact.pressure[..], &bound[..]), |t, (q, b)| *t = q + b);
        let images = (&contact.unit_displacement[..], &self.image[..]);
        each(&mut state.unit_displacement, images, |u, (kq, kb)| *u = kq + kb);
        state.approach = contact.approach;
        state.rounding = contact.rounding + 1.0;
        solved.map(|()| total)
    }
}

/// A solve under way.
struct Run<'a> {
    own: &'a mut TractionSolver,
    solver: &'a mut Solver,
    operator: &'a mut dyn Operator,
    options: &'a SolverOptions,
    tolerance: f64,
    interrupt: Option<&'a AtomicBool>,
    total: Outcome,
}

impl Run<'_> {
    /// The loop under a load. Surfaces that nothing has brought together yet are brought to first touch, where they adhere.
    fn solve_under(&mut self, problem: &Problem, load: f64) -> Result<()> {
        if load <= 0.0 && self.own.law.is_attraction() && is_zero(&self.own.last.bound) {
            let first_touch = Prescribed::Approach(minimum(problem.gap));
            self.solve(&Problem { prescribed: first_touch, ..*problem })?;
        }
        self.solve(problem)
    }

    /// The loop. [`Error::Infeasible`] where a prescribed load leaves none to the contact.
    fn solve(&mut self, problem: &Problem) -> Result<()> {
        self.own.extrapolation.clear();
        let mut best = f64::INFINITY;
        let mut energy = f64::INFINITY;
        for _ in 0..MOST_PASSES {
            self.own.passes += 1;
            let is_attraction = self.own.law.is_attraction();
            let pass = match self.pass(problem) {
                // Extrapolated too far.
                Err(Error::Infeasible { .. })
                    if is_attraction && self.own.extrapolation.take_back(&mut self.own.now.bound) =>
                {
                    continue;
                }
                pass => pass?,
            };
            self.total = self.total.then(pass.outcome);
            self.total.convolutions += 1;
            self.total.residual = pass.residual.max(pass.outcome.residual);
            if pass.residual <= self.tolerance {
                return Ok(());
            }
            let rises = pass.energy.is_some_and(|now| now > energy + 1e-6 * now.abs());
            let own = &mut *self.own;
            // An extrapolation that raised the energy is taken back: of an attraction to the plain pass, which never does. Others may
            // also diverge.
            if !(rises && is_attraction && own.extrapolation.take_back(&mut own.now.bound)) {
                let failed = !is_attraction && (rises || pass.residual > 2.0 * best);
                own.extrapolation.step(&mut own.now.bound, &own.next, failed);
                let [least, most] = own.law.limits();
                each(&mut own.now.bound, &own.next[..], |b, _| *b = b.clamp(least, most));
            }
            best = best.min(pass.residual);
            energy = pass.energy.map_or(energy, |now| now.min(energy));
        }
        let options = SolverOptions { tolerance: self.tolerance, ..*self.options };
        Err(not_converged("surface traction", &options, &self.total))
    }

    fn pass(&mut self, problem: &Problem) -> Result<Pass> {
        let (own, c) = (&mut *self.own, problem.compliance);
        let bound = &own.now.bound[..];
        self.operator.apply_into(bound, &mut own.image);
        each(&mut own.shifted, (problem.gap, &own.image[..]), |to, (h, u)| *to = h + c * u);
        let cell_area = self.operator.grid().cell_area();
        let prescribed = match problem.prescribed {
            Prescribed::Load(load) => {
                let carried = load - cell_area * sum(bound);
                if carried < 0.0 {
                    return Err(Error::Infeasible { parameter: String::new(), load: carried, max: 0.0 });
                }
                Prescribed::Load(carried)
            }
            approach => approach,
        };
        let inner = Problem { gap: &own.shifted, prescribed, ..*problem };
        let options = SolverOptions { tolerance: (INNER * self.tolerance).max(1e-14), ..*self.options };
        let (solver, contact) = (&mut *self.solver, &mut own.now.contact);
        let outcome = solver.solve(self.operator, &inner, &options, contact, self.interrupt)?;
        let w = contact.approach;
        let fields = (&own.shifted[..], &contact.unit_displacement[..]);
        each(&mut own.gap, fields, |to, (h, u)| *to = (h + c * u - w).max(0.0));
        own.law.bound(&own.gap, &contact.pressure, &mut own.next)?;
        let Tractions { bound, contact } = &own.now;
        let fields = (
            (&bound[..], &own.next[..], &contact.pressure[..]),
            (&own.image[..], &contact.unit_displacement[..]),
        );
        let [change, size, work, total] = sums(fields, |((b, next, q), (kb, kq))| {
            let t = b + q;
            [(next - b).abs(), next.abs() + q, t * (kb + kq), t]
        });
        own.scale = own.scale.max(size);
        own.potential = own.law.energy(&own.gap);
        let of_load = if matches!(problem.prescribed, Prescribed::Load(_)) { w * total } else { 0.0 };
        Ok(Pass {
            outcome,
            residual: if change > 0.0 { change / size.max(LEAST * own.scale) } else { 0.0 },
            energy: own.potential.map(|potential| 0.5 * c * work + potential - of_load),
        })
    }

    /// The approach at which the tractions carry `load`, from `start` on: enclosed by growing steps, found by the Illinois form of
    /// false position.
    fn search_approach(&mut self, problem: &Problem, load: f64, start: f64) -> Result<()> {
        let cell_area = self.operator.grid().cell_area();
        let scale = problem.gap.iter().filter(|h| h.is_finite()).fold(0.0_f64, |most, h| most.max(h.abs()));
        let excess = |run: &mut Self, w: f64| -> Result<f64> {
            run.solve(&Problem { prescribed: Prescribed::Approach(w), ..*problem })?;
            let own = &run.own;
            Ok(cell_area * (sum(&own.now.bound) + sum(&own.now.contact.pressure)) - load)
        };
        let (mut a, mut fa) = (start, excess(self, start)?);
        let mut step = if fa > 0.0 { -1e-3 } else { 1e-3 } * scale.max(start.abs()).max(1e-12);
        // The passes are known to their tolerance.
        let small = 10.0 * self.tolerance * load.abs().max(cell_area * self.own.scale);
        let (mut b, mut fb) = (a, fa);
        for _ in 0..MOST_APPROACHES {
            if fb.abs() <= small {
                return Ok(());
            }
            if fa * fb < 0.0 {
                break;
            }
            (a, fa) = (b, fb);
            b += step;
            fb = excess(self, b)?;
            step *= 2.0;
        }
        for _ in 0..MOST_APPROACHES {
            if fb.abs() <= small {
                return Ok(());
            }
            let w = b - fb * (b - a) / (fb - fa);
            let f = excess(self, w)?;
            if f * fb < 0.0 {
                (a, fa) = (b, fb)
            } else {
                fa *= 0.5
            }
            (b, fb) = (w, f);
        }
        Err(Error::invalid(
            "load",
            format!("{load:e} N"),
            "one that the tractions between the surfaces can hold: no equilibrium was found",
        ))
    }
}
