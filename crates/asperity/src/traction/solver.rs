//! The loop around the contact solver.

use std::sync::atomic::AtomicBool;

use super::{SurfaceTraction, TractionLaw};
use crate::contact::{
    ContactState, Hardness, Outcome, Prescribed, Problem, SolverOptions, Start, Task, not_converged,
};
use crate::error::{Error, Result};
use crate::extrapolation::Extrapolation;
use crate::grid::{Boundary, Grid};
use crate::operator::Operator;
use crate::process::roll;
use crate::quantities::Quantity;
use crate::step::{Loader, Saver, saved};
use crate::time::Instant;
use crate::wear::{RecedingSolver, Recession};
use asperity_sweep::{each, is_zero, minimum, sum, sums, zeros};

/// Forces below this share of the largest one of the run are none.
const LEAST: f64 = 1e-4;
/// Passes after which a solve is given up.
const MOST_PASSES: usize = 500;
/// Passes after which the best one no longer counts.
const RECENT: usize = 5;

/// The loop around the contact solver.
pub(crate) struct TractionSolver {
    law: Box<dyn SurfaceTraction>,
    /// Of the loop and of the contact of a pass.
    tolerances: [f64; 2],
    /// The traction b and the contact pressure q of the last row, with which each attempt begins.
    last: Tractions,
    now: Tractions,
    /// Cells along x and y that the contact has moved since the last row, and the boundary that it moves over.
    moved: ([isize; 2], Boundary),
    /// K b, and B of the pass.
    image: Vec<f64>,
    next: Vec<f64>,
    /// h', and then g.
    shifted: Vec<f64>,
    gap: Vec<f64>,
    /// The cut-off of q, and the pressure of the cells in contact, where the law is displaced by contact.
    cap: Vec<f64>,
    pressing: Vec<f64>,
    extrapolation: Extrapolation,
    /// Gaps up to it are closed in the last pass \[m\]: the displacement is known to the tolerance of the loop only. 0 for laws that do not
    /// ask which cells are open.
    closed: f64,
    /// The largest Σ|B| + Σ q of all passes.
    scale: f64,
    /// Of the last solve.
    passes: usize,
    residual: f64,
    /// Σ γ(g) of the last pass \[Pa m\], where the law has it.
    potential: Option<f64>,
}

/// The parts of a total traction.
pub(super) struct Tractions {
    /// b \[Pa\].
    pub(super) bound: Vec<f64>,
    /// The contact pressure q with K q.
    pub(super) contact: ContactState,
}

impl Tractions {
    pub(super) fn none(cells: usize) -> Self {
        Tractions { bound: zeros(cells), contact: ContactState::new(cells) }
    }

    pub(super) fn copy_from(&mut self, other: &Self) {
        self.bound.copy_from_slice(&other.bound);
        self.contact.copy_from(&other.contact);
    }

    /// Those of another place, moved by these cells.
    fn move_from(&mut self, other: &Self, (shift, boundary): ([isize; 2], Boundary), grid: &Grid) {
        if shift == [0; 2] {
            return self.copy_from(other);
        }
        let move_field = |from: &[f64], to: &mut [f64]| roll(grid.shape(), boundary, shift, from, to);
        move_field(&other.bound, &mut self.bound);
        move_field(&other.contact.pressure, &mut self.contact.pressure);
        move_field(&other.contact.unit_displacement, &mut self.contact.unit_displacement);
        self.contact.approach = other.contact.approach;
        self.contact.rounding = other.contact.rounding + 1.0;
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
    /// 1/2 <t, c K t> + Σ γ(g), and the work of q on what recedes, less the work of a prescribed load.
    energy: Option<f64>,
}

impl TractionSolver {
    /// The loop of a law, where a contact alone would be solved to the tolerance `contact`.
    pub(crate) fn new(law: &dyn TractionLaw, grid: &Grid, contact: f64) -> Self {
        let (cells, started) = (grid.len(), law.start(grid));
        TractionSolver {
            pressing: if started.is_displaced() { zeros(cells) } else { vec![] },
            cap: vec![],
            law: started,
            tolerances: law.tolerances(contact).map(|tolerance| tolerance.max(1e-14)),
            last: Tractions::none(cells),
            now: Tractions::none(cells),
            moved: ([0; 2], Boundary::Free),
            image: zeros(cells),
            next: zeros(cells),
            shifted: zeros(cells),
            gap: zeros(cells),
            extrapolation: Extrapolation::default(),
            closed: 0.0,
            scale: 0.0,
            passes: 0,
            residual: 0.0,
            potential: None,
        }
    }

    /// Memory that it takes \[bytes\].
    pub(crate) fn bytes(law: &dyn TractionLaw, grid: &Grid) -> usize {
        // b, q and K q twice, K b, B, h', g, and the passes of the extrapolation: b and f of three, and of the best one.
        (6 + 4 + 8) * 8 * grid.len() + law.bytes(grid)
    }

    /// Saves what the next rows depend on.
    pub(crate) fn save<'a>(&'a self, to: &mut Saver<'a>) {
        self.save_own(to);
        let memory = self.law.memory().into_iter().enumerate();
        memory.for_each(|(n, field)| to.field(&format!("memory{n}"), field));
    }

    /// Takes back what `save` gave.
    ///
    /// # Errors
    /// Where it belongs to another simulation.
    pub(crate) fn load(&mut self, from: &Loader<'_>) -> Result<()> {
        self.load_own(from)?;
        for (n, field) in self.law.memory_mut().into_iter().enumerate() {
            from.field_into(&format!("memory{n}"), field)?;
        }
        self.now.copy_from(&self.last);
        self.press();
        Ok(())
    }

    /// The instant that is solved for.
    pub(crate) fn begin(&mut self, at: &Instant) {
        self.law.begin(at);
    }

    /// The contact has moved by these cells along x and y since the last row.
    pub(crate) fn follow(&mut self, shift: [isize; 2], boundary: Boundary) {
        self.moved = (shift, boundary);
    }

    /// The step stands.
    pub(crate) fn commit(&mut self) {
        self.law.commit();
        self.last.copy_from(&self.now);
    }

    /// The contacts of the last row and of the last attempt: their pressure q \[Pa\] and K q.
    pub(crate) fn contacts(&self) -> [&ContactState; 2] {
        [&self.last.contact, &self.now.contact]
    }

    /// The cut-off of q, where it is not that of the total pressure.
    pub(crate) fn cut_off(&self) -> Option<&[f64]> {
        (!self.cap.is_empty()).then_some(&self.cap)
    }

    /// The pressure of the cells in contact in the last attempt \[Pa\], 0 elsewhere.
    pub(crate) fn pressing(&self) -> &[f64] {
        if self.law.is_displaced() { &self.pressing } else { &self.now.contact.pressure }
    }

    /// The mean of b + q in the last row \[Pa\].
    fn mean_of_last(&self) -> f64 {
        let Tractions { bound, contact } = &self.last;
        (sum(bound) + sum(&contact.pressure)) / bound.len() as f64
    }

    /// Finds the pressure of the cells in contact: b + q, and q where the law pulls. Cells whose gap is closed are in contact.
    fn press(&mut self) {
        let Tractions { bound, contact } = &self.now;
        let (fields, closed) = ((&bound[..], &contact.pressure[..], &self.gap[..]), self.closed);
        if self.law.is_displaced() {
            each(&mut self.pressing, fields, |p, (b, q, g)| {
                let touches = q > 0.0 || closed > 0.0 && g <= closed;
                *p = if touches { q + b.max(0.0) } else { 0.0 };
            });
        }
    }

    /// Gaps up to it are closed in the last attempt \[m\].
    pub(crate) fn closed(&self) -> f64 {
        self.closed
    }

    /// The traction b of the last attempt \[Pa\]; tension is negative.
    pub(crate) fn bound(&self) -> &[f64] {
        &self.now.bound
    }

    /// A quantity of the last attempt on cells of this area \[m²\].
    pub(crate) fn quantity(&self, quantity: Quantity, cell_area: f64) -> Option<f64> {
        let of_open = || {
            let Tractions { bound, contact } = &self.now;
            sums((&bound[..], &contact.pressure[..]), |(b, q)| [if q > 0.0 { 0.0 } else { b }, b + q])
        };
        Some(match quantity {
            Quantity::FluidLoad => cell_area * of_open()[0],
            Quantity::ContactLoad => {
                let [open, all] = of_open();
                cell_area * (all - open)
            }
            Quantity::Film => f64::from(u8::from(is_zero(&self.now.contact.pressure))),
            Quantity::AdhesiveLoad => -cell_area * sum(&self.now.bound),
            Quantity::RepulsiveLoad => cell_area * sum(&self.now.contact.pressure),
            Quantity::AdhesionEnergy => cell_area * self.potential?,
            Quantity::OuterIterations => self.passes as f64,
            Quantity::AdhesionResidual | Quantity::FluidResidual => self.residual,
            other => return self.law.quantity(other),
        })
    }

    /// Solves for the total traction, which `state` holds in the end; its approach is where the search starts. The surfaces may recede
    /// under the contact pressure.
    ///
    /// # Errors
    /// [`Error::NotConverged`], after which `state` holds the last pass; [`Error::PulledOff`]; those of the contact and of the law.
    pub(crate) fn solve(
        &mut self,
        solver: &mut RecedingSolver,
        recession: &Recession,
        task: Task,
    ) -> Result<Outcome> {
        let Task { operator, problem, options, state, interrupt } = task;
        self.now.move_from(&self.last, self.moved, operator.grid());
        self.passes = 0;
        let rise = match problem.prescribed {
            Prescribed::Load(load) => load / operator.grid().area() - self.mean_of_last(),
            Prescribed::Approach(_) => 0.0,
        };
        self.law.begin_solve(problem.compliance, rise, &mut self.now.bound);
        let total = Outcome::default();
        let mut run = Run { own: self, solver, recession, operator, options, interrupt, total };
        let solved = match problem.prescribed {
            Prescribed::Approach(_) => run.solve(problem),
            Prescribed::Load(load) => match run.solve_under(problem, load) {
                // More than the hardness carries.
                Err(Error::Infeasible { load, max, parameter }) if load > max => {
                    self.now.copy_from(&self.last);
                    return Err(Error::Infeasible { load, max, parameter });
                }
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
        self.press();
        solved.map(|()| total)
    }
}

/// A solve under way.
pub(super) struct Run<'a> {
    own: &'a mut TractionSolver,
    solver: &'a mut RecedingSolver,
    recession: &'a Recession,
    pub(super) operator: &'a mut dyn Operator,
    options: &'a SolverOptions,
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
    pub(super) fn solve(&mut self, problem: &Problem) -> Result<()> {
        self.own.extrapolation.clear();
        self.own.law.begin_loop();
        // The least residual of late, and how many passes ago: it may grow while fluid advances into the contact.
        let (mut best, mut age, mut is_damped) = (f64::INFINITY, 0, false);
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
            if pass.residual <= self.tolerance() && self.own.law.is_settled() {
                return Ok(());
            }
            let rises = pass.energy.is_some_and(|now| now > energy + 1e-6 * now.abs());
            let own = &mut *self.own;
            // An extrapolation that raised the energy is taken back: of an attraction to the plain pass, which never does. Others may
            // also diverge.
            if !(rises && is_attraction && own.extrapolation.take_back(&mut own.now.bound)) {
                let failed = !is_attraction && (rises || pass.residual > 2.0 * best);
                age += 1;
                let is_best = !is_attraction && (pass.residual < best || age > RECENT);
                is_damped |= !is_attraction && age > RECENT;
                if is_best {
                    (best, age) = (pass.residual, 0);
                }
                if is_damped {
                    // Where extrapolation gains nothing any more, half steps do.
                    each(&mut own.now.bound, &own.next[..], |b, next| *b = 0.5 * (*b + next));
                } else {
                    own.extrapolation.step(&mut own.now.bound, &own.next, failed && !is_best, is_best);
                }
                let [least, most] = own.law.limits();
                each(&mut own.now.bound, &own.next[..], |b, _| *b = b.clamp(least, most));
            }
            energy = pass.energy.map_or(energy, |now| now.min(energy));
        }
        let options = SolverOptions { tolerance: self.tolerance(), ..*self.options };
        let method = if self.own.law.is_attraction() { "adhesion" } else { "surface traction" };
        Err(not_converged(method, &options, &self.total).into())
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
        let mut inner = Problem { gap: &own.shifted, prescribed, ..*problem };
        if own.law.is_displaced() && !problem.hardness.is_infinite() {
            own.cap.resize(bound.len(), 0.0);
            each(&mut own.cap, (problem.hardness, bound), |cap, (hardness, b)| *cap = hardness - b);
            inner.hardness = Hardness::Cells(&own.cap);
        }
        let options = SolverOptions { tolerance: own.tolerances[1], ..*self.options };
        let contact = &mut own.now.contact;
        let (operator, interrupt) = (&mut *self.operator, self.interrupt);
        let task = Task { operator, problem: &inner, options: &options, state: &mut *contact, interrupt };
        let outcome = self.solver.solve(Start::Pressure, self.recession, task)?;
        let w = contact.approach;
        if !self.recession.is_none() {
            self.recession.add(&contact.pressure, &mut own.shifted);
        }
        if own.law.is_displaced() {
            let fields = ((bound, &contact.pressure[..]), (&own.image[..], &contact.unit_displacement[..]));
            let [work, total] = sums(fields, |((b, q), (kb, kq))| [(b + q) * (kb + kq), b + q]);
            own.closed = if total > 0.0 { own.tolerances[0] * c * work.abs() / total } else { 0.0 };
        }
        let (fields, closed) = ((&own.shifted[..], &contact.unit_displacement[..]), own.closed);
        each(&mut own.gap, fields, |to, (h, u)| {
            let g = h + c * u - w;
            *to = if g > closed { g } else { 0.0 };
        });
        own.next.copy_from_slice(&own.now.bound);
        own.law.bound(&own.gap, &own.now.contact.pressure, &mut own.next)?;
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
        let recedes = self.recession.work(&contact.pressure);
        Ok(Pass {
            outcome,
            residual: if change > 0.0 { change / size.max(LEAST * own.scale) } else { 0.0 },
            energy: own.potential.map(|potential| 0.5 * c * work + recedes + potential - of_load),
        })
    }

    /// Σ (b + q) of the last pass \[Pa\].
    pub(super) fn carried(&self) -> f64 {
        sum(&self.own.now.bound) + sum(&self.own.now.contact.pressure)
    }

    /// Force that counts as none \[Pa\]: the passes are known to their tolerance.
    pub(super) fn small(&self) -> f64 {
        3.0 * self.tolerance() * self.own.scale
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.own.tolerances[0]
    }
}
