//! Tractions on the surfaces that depend on the gap between them: adhesion, fluid pressure.
//!
//! The total traction is t = b + q with the traction b of the law and the contact pressure q >= 0, q g = 0. Given b the contact is
//! the same convex problem with another gap and load, so one loop around the unchanged contact solver serves every law:
//!
//! ```text
//! repeat:
//!     h' = h + c K b                                    one convolution
//!     q, w = contact of c K, h', load W/A - Σ b or approach w
//!     g = h' + c K q - w,   B = b(g, q),   f = B - b
//!     stop where Σ|f| <= tolerance (Σ|B| + Σ q), the largest of all passes
//!     b = extrapolation of the last passes where it lowers the residual, else a shorter plain step
//! ```
//!
//! Under a prescribed load W a pass in which Σ b alone exceeds W/A leaves no load to the contact: then the approach is searched at
//! which the tractions carry W. After convergence the state holds t and U = K t: what the bodies remember is the total traction.

mod extrapolation;
#[cfg(test)]
mod tests;

use std::sync::atomic::AtomicBool;

use crate::contact::{
    ContactState, Outcome, Prescribed, Problem, Solver, SolverOptions, Task, not_converged,
};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::operator::Operator;
use asperity_sweep::{each, sum, sums};
use extrapolation::Extrapolation;

/// Passes after which a solve is given up.
const MOST_PASSES: usize = 200;
/// The contact of a pass is solved to this share of the tolerance of the loop.
const INNER: f64 = 0.1;
/// Approaches tried for a load that the contact does not carry.
const MOST_APPROACHES: usize = 100;

/// A law of tractions, of which each run starts its own.
pub trait TractionLaw: std::fmt::Debug + Send + Sync {
    /// The tractions of a run on this grid.
    fn start(&self, grid: &Grid) -> Box<dyn SurfaceTraction>;
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

    /// The step stands: what the law remembers of it is kept.
    fn commit(&mut self) {}
}

/// The loop around the contact solver.
pub(crate) struct TractionSolver {
    law: Box<dyn SurfaceTraction>,
    /// b, K b, and B of the pass.
    bound: Vec<f64>,
    image: Vec<f64>,
    next: Vec<f64>,
    /// h', and then g.
    shifted: Vec<f64>,
    gap: Vec<f64>,
    /// The contact pressure q with K q.
    contact: ContactState,
    extrapolation: Extrapolation,
    /// The largest Σ|B| + Σ q of all passes: what a force of nothing is measured by.
    scale: f64,
}

/// One pass of the loop.
#[derive(Clone, Copy)]
struct Pass {
    outcome: Outcome,
    /// Σ|B - b| over the largest Σ|B| + Σ q of all passes.
    residual: f64,
    /// 1/2 <t, c K t> + Σ γ(g), less the work of a prescribed load.
    energy: Option<f64>,
}

impl TractionSolver {
    pub(crate) fn new(law: Box<dyn SurfaceTraction>, cells: usize) -> Self {
        let zeros = || vec![0.0; cells];
        TractionSolver {
            law,
            bound: zeros(),
            image: zeros(),
            next: zeros(),
            shifted: zeros(),
            gap: zeros(),
            contact: ContactState::new(cells),
            extrapolation: Extrapolation::default(),
            scale: 0.0,
        }
    }

    /// The step stands.
    pub(crate) fn commit(&mut self) {
        self.law.commit();
    }

    /// Solves for the total traction, which `state` holds in the end; its approach is where the search starts.
    ///
    /// # Errors
    /// [`Error::NotConverged`], and those of the contact and of the law.
    pub(crate) fn solve(&mut self, solver: &mut Solver, task: Task) -> Result<Outcome> {
        let Task { operator, problem, options, state, interrupt } = task;
        let mut run = Run { own: self, solver, operator, options, interrupt, total: Outcome::default() };
        match problem.prescribed {
            Prescribed::Approach(_) => run.solve(problem)?,
            Prescribed::Load(load) => match run.solve(problem) {
                Err(Error::Infeasible { .. }) => run.search_approach(problem, load, state.approach)?,
                solved => solved?,
            },
        }
        let total = run.total;
        for n in 0..self.bound.len() {
            state.pressure[n] = self.contact.pressure[n] + self.bound[n];
            state.unit_displacement[n] = self.contact.unit_displacement[n] + self.image[n];
        }
        state.approach = self.contact.approach;
        state.rounding = self.contact.rounding + 1.0;
        Ok(total)
    }
}

/// A solve under way.
struct Run<'a> {
    own: &'a mut TractionSolver,
    solver: &'a mut Solver,
    operator: &'a mut dyn Operator,
    options: &'a SolverOptions,
    interrupt: Option<&'a AtomicBool>,
    total: Outcome,
}

impl Run<'_> {
    /// The loop. [`Error::Infeasible`] where a prescribed load leaves none to the contact.
    fn solve(&mut self, problem: &Problem) -> Result<()> {
        self.own.extrapolation.clear();
        let mut best = f64::INFINITY;
        let mut energy = f64::INFINITY;
        for _ in 0..MOST_PASSES {
            let pass = self.pass(problem)?;
            self.total = self.total.then(pass.outcome);
            self.total.convolutions += 1;
            self.total.residual = pass.residual.max(pass.outcome.residual);
            if pass.residual <= self.options.tolerance {
                return Ok(());
            }
            let rises = pass.energy.is_some_and(|now| now > energy + 1e-6 * now.abs());
            let own = &mut *self.own;
            // Where an extrapolation raised the energy or doubled the residual it is taken back.
            own.extrapolation.step(&mut own.bound, &own.next, rises || pass.residual > 2.0 * best);
            best = best.min(pass.residual);
            energy = pass.energy.map_or(energy, |now| now.min(energy));
        }
        Err(not_converged("surface traction", self.options, &self.total))
    }

    fn pass(&mut self, problem: &Problem) -> Result<Pass> {
        let (own, c) = (&mut *self.own, problem.compliance);
        self.operator.apply_into(&own.bound, &mut own.image);
        each(&mut own.shifted, (problem.gap, &own.image[..]), |to, (h, u)| *to = h + c * u);
        let cell_area = self.operator.grid().cell_area();
        let prescribed = match problem.prescribed {
            Prescribed::Load(load) => {
                let carried = load - cell_area * sum(&own.bound);
                if carried <= 0.0 {
                    return Err(Error::Infeasible { parameter: String::new(), load: carried, max: 0.0 });
                }
                Prescribed::Load(carried)
            }
            approach => approach,
        };
        let inner = Problem { gap: &own.shifted, prescribed, ..*problem };
        let options =
            SolverOptions { tolerance: (INNER * self.options.tolerance).max(1e-14), ..*self.options };
        let (solver, state) = (&mut *self.solver, &mut own.contact);
        let outcome = solver.solve(self.operator, &inner, &options, state, self.interrupt)?;
        let w = own.contact.approach;
        let fields = (&own.shifted[..], &own.contact.unit_displacement[..]);
        each(&mut own.gap, fields, |to, (h, u)| *to = (h + c * u - w).max(0.0));
        self.own.law.bound(&self.own.gap, &self.own.contact.pressure, &mut self.own.next)?;
        let own = &*self.own;
        let fields = (
            (&own.bound[..], &own.next[..], &own.contact.pressure[..]),
            (&own.image[..], &own.contact.unit_displacement[..]),
        );
        let [change, size, work, total] = sums(fields, |((b, next, q), (kb, kq))| {
            let t = b + q;
            [(next - b).abs(), next.abs() + q, t * (kb + kq), t]
        });
        let scale = own.scale.max(size);
        let potential = own.law.energy(&own.gap);
        self.own.scale = scale;
        let of_load = if matches!(problem.prescribed, Prescribed::Load(_)) { w * total } else { 0.0 };
        Ok(Pass {
            outcome,
            residual: if change > 0.0 { change / scale } else { 0.0 },
            energy: potential.map(|potential| 0.5 * c * work + potential - of_load),
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
            Ok(cell_area * (sum(&own.bound) + sum(&own.contact.pressure)) - load)
        };
        let (mut a, mut fa) = (start, excess(self, start)?);
        let mut step = if fa > 0.0 { -1e-3 } else { 1e-3 } * scale.max(start.abs()).max(1e-12);
        // The passes are known to their tolerance.
        let small = 10.0 * self.options.tolerance * load.abs().max(cell_area * self.own.scale);
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
