//! Friction under tangential loads: where the surfaces stick and where they slip, after each normal step.
//!
//! Friction is incremental. With the pressure p of the row known, the tractions |q| <= μ p of the row, and the slip of the step
//!
//! ```text
//! r = c K q + g - u_n - (d - d_n),      r = 0 where |q| < μ p,      r opposite to q where |q| = μ p
//! ```
//!
//! are those of a convex problem ([`SlipSolver`]). The bodies remember the tangential displacement u as they do the normal one, by a
//! [`History`] for each component: Poisson's ratio is constant, so C(t) is the same. Friction takes the end of a step for all of it:
//! exact as long as the slip of a cell keeps its direction and its limit, of first order in the step otherwise. A cell out of contact has
//! no traction, and comes back free of stress.
//!
//! Where pressure and tractions act on each other, g contains the displacement c N p under the pressure, and the contact of the row is solved
//! again with the normal displacement c N'q until it stays ([`Process::act_back`]).

use std::sync::Arc;

use asperity_sweep::{each, is_zero, sums, zeros};

use super::{Process, Solved};
use crate::contact::{ContactState, SAME_LOAD};
use crate::error::{Error, Result};
use crate::history::{self, Ends, History};
use crate::kernel::Cerruti;
use crate::simulation::Simulation;
use crate::step::{Interval, Load, Loader, Saver, UndeformedGap, saved};
use crate::tangential::{
    EDGE, Given, Lateral, Slip, SlipOutcome, SlipProblem, SlipRow, SlipSolver, Tangential, TangentialControl,
    Vector, inner, length, minus, plus, times,
};

/// Residuals are measured by this share of the displacement under full sliding, at least.
const SMALLEST_SCALE: f64 = 1e-6;

/// The change of the last step is taken this often, at most.
const FARTHEST: f64 = 2.0;

pub(super) struct PartialSlip {
    law: Arc<Tangential>,
    /// The component of the force that acts alone, and it in the last row \[N\].
    alone: Option<usize>,
    load: f64,
    /// What was prescribed in the last two rows.
    course: [Vector; 2],
    solver: SlipSolver,
    /// Of both components.
    memories: [Box<dyn History>; 2],
    before: [ContactState; 2],
    now: [ContactState; 2],
    /// q and K q of the row, and d - d_n of its step.
    slip: Slip,
    /// u of the row.
    displacement: Vec<Vector>,
    /// Slip of each cell since t = 0, while in contact; the length of its path, and the energy per area that friction has taken.
    slid: Vec<Vector>,
    path: Vec<f64>,
    heat: Vec<f64>,
    /// State of each cell.
    slips: Vec<bool>,
    radius: Vec<f64>,
    offset: Vec<Vector>,
    rest: Vec<f64>,
    recalled: Vec<f64>,
    numbers: SlipRow,
    /// The largest energy norm of the tractions so far, squared.
    energy: f64,
    /// What the springs hold under the tractions, per area of a cell, where account is kept of it.
    stored: Option<f64>,
    coupled: Option<Coupled>,
    found: Found,
}

/// What pressure and tractions do to each other.
struct Coupled {
    lateral: Lateral,
    /// N p of the last attempt.
    under_pressure: Vec<Vector>,
}

/// What is known of the step of the last attempt besides its fields.
#[derive(Default)]
struct Found {
    compliance: f64,
    /// Of the component of the force that acts alone, at both ends.
    loads: [f64; 2],
    outcome: SlipOutcome,
    /// Whether the histories have the step open.
    is_open: bool,
}

saved! {
    PartialSlip {
        "course": course;
        "numbers": numbers.force, numbers.displacement, numbers.work, load, energy;
        "stored": stored;
    }
    fields {
        "path": path;
        "heat": heat;
    }
}

impl PartialSlip {
    /// `None` without tangential load.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the material has no history.
    pub(super) fn of(simulation: &Simulation) -> Result<Option<Self>> {
        let Some(law) = &simulation.tangential else { return Ok(None) };
        let (grid, n) = (&simulation.grid, simulation.grid.len());
        let states = || [0; 2].map(|_| ContactState::new(n));
        let coupled = law.is_coupled().then(|| Coupled {
            lateral: Lateral::new(grid, simulation.boundary, law.beta),
            under_pressure: zeros(n),
        });
        let mut memories = [history::of(simulation)?, history::of(simulation)?];
        let tracks =
            simulation.quantities.has_energy() && memories.iter_mut().all(|memory| memory.track_energy());
        Ok(Some(PartialSlip {
            law: law.clone(),
            // A pressure that moves the surfaces along each other is no course of the force.
            alone: law.alone(simulation.times.end()).filter(|_| coupled.is_none()),
            load: 0.0,
            course: [[0.0; 2]; 2],
            solver: SlipSolver::new(grid, simulation.boundary, Cerruti { poisson: law.poisson }),
            memories,
            before: states(),
            now: states(),
            slip: Slip { traction: zeros(n), unit: zeros(n), displacement: [0.0; 2] },
            displacement: zeros(n),
            slid: zeros(n),
            path: zeros(n),
            heat: zeros(n),
            slips: vec![false; n],
            radius: zeros(n),
            offset: zeros(n),
            rest: zeros(n),
            recalled: zeros(n),
            numbers: SlipRow::default(),
            energy: 0.0,
            stored: tracks.then_some(0.0),
            coupled,
            found: Found::default(),
        }))
    }

    /// Sets the limits of the tractions; returns their sum, and the displacement under all of them, weighted by them.
    fn limit(&mut self, row: &Solved<'_>) -> [f64; 2] {
        let law = &self.law;
        let pressure = &row.contact.pressure[..];
        let cells = (pressure, 0..pressure.len());
        each(&mut self.radius, cells, |radius, (p, n)| *radius = law.limit(n, p));
        let cells = (&self.radius[..], &row.now.unit_displacement[..]);
        let c = row.compliance;
        let [most, moved] = sums(cells, |(radius, u)| [radius, radius * c * u]);
        [most, if most > 0.0 { moved.abs() / most } else { 0.0 }]
    }

    /// The step, with what is known of the traction: where one component of the force acts alone, u runs in the integral of C dQ.
    fn step(&self, step: &Interval, most: f64) -> (Interval, [f64; 2]) {
        let alone = self.alone.map(|axis| self.law.at(step.instant.time)[axis]);
        let load = if most == 0.0 && self.now.iter().all(|state| is_zero(&state.pressure)) {
            Load::Apart
        } else {
            alone.map_or(Load::Approach, Load::Total)
        };
        (step.under(load), alone.map_or([0.0; 2], |force| [self.load, force]))
    }

    /// Starts from the change of the last step, as long as the load goes on in its direction: what slips goes on slipping.
    fn extrapolate(&mut self, time: f64) {
        let [earlier, last] = self.course;
        let (change, next) = (minus(last, earlier), minus(self.law.at(time), last));
        let share = (inner(next, change) / inner(change, change)).clamp(0.0, FARTHEST);
        if share > 0.0 {
            for axis in 0..2 {
                let cells = (&self.now[axis].pressure[..], &self.before[axis].pressure[..]);
                each(&mut self.slip.traction, cells, |to, (q, before)| to[axis] = q + share * (q - before));
            }
        }
    }

    /// What is given of the step.
    ///
    /// # Errors
    /// [`Error::Sliding`] where friction does not hold the force.
    fn given(&self, row: &Solved<'_>, most: f64) -> Result<Given> {
        let time = row.step.instant.time;
        let value = self.law.at(time);
        let grid = &row.simulation.grid;
        let area = grid.cell_area();
        match self.law.control {
            TangentialControl::Displacement => {
                Ok(Given::Displacement(minus(value, self.numbers.displacement)))
            }
            TangentialControl::Force if length(value) > most * area * (1.0 + SAME_LOAD) => {
                let (force, max, unit) = (length(value), most * area, grid.units("N"));
                Err(Error::Sliding { force, max, unit, time })
            }
            TangentialControl::Force => Ok(Given::Sum(times(1.0 / area, value))),
        }
    }

    /// Where the cells are after the step: displacement, slip, work.
    fn take_in(&mut self, row: &Solved<'_>, compliance: f64) {
        let (d, area) = (self.slip.displacement, row.simulation.grid.cell_area());
        let (q, unit) = (&self.slip.traction[..], &self.slip.unit[..]);
        each(&mut self.displacement, (unit, &self.offset[..]), |to, (u, b)| {
            *to = plus(*to, plus(times(compliance, u), b));
        });
        let slip = |u: Vector, b: Vector, slips: bool| slip_of(compliance, d, (u, b, slips));
        let cells = (unit, &self.offset[..], &self.slips[..]);
        each(&mut self.slid, cells, |slid, (u, b, slips)| *slid = plus(*slid, slip(u, b, slips)));
        each(&mut self.path, cells, |path, (u, b, slips)| *path += length(slip(u, b, slips)));
        let cells = (q, unit, &self.offset[..], &self.slips[..]);
        each(&mut self.heat, cells, |heat, (q, u, b, slips)| *heat -= inner(q, slip(u, b, slips)));
        let cells = (&row.contact.pressure[..], q, unit, &self.offset[..], &self.slips[..]);
        let [x, y, work, stick, slip] = sums(cells, |(p, q, u, b, slips)| {
            let count = |is: bool| f64::from(u8::from(is));
            [q[0], q[1], -inner(q, slip(u, b, slips)), count(p > 0.0 && !slips), count(slips)]
        });
        let force = times(area, [x, y]);
        let (change, way) = (minus(force, self.numbers.force), length(d));
        self.numbers = SlipRow {
            force,
            displacement: plus(self.numbers.displacement, d),
            stick_area: stick * area,
            slip_area: slip * area,
            work: self.numbers.work + work * area,
            stiffness: if way > 0.0 { inner(change, d) / (way * way) } else { f64::NAN },
            outcome: self.numbers.outcome,
        };
    }

    /// Adds what the tractions did to the energies of the bodies, and the work of the load along the surfaces: the mean force times the
    /// way, in a jump what bodies and friction take. Sums over both components: by itself none of them is an energy.
    fn add_energies(&mut self, row: &mut Solved<'_>, before: &SlipRow) {
        let (Some(stored_before), Some(normal)) = (self.stored, &mut row.exchange) else { return };
        let (mut stored, mut work) = (0.0, 0.0);
        for axis in 0..2 {
            let ends = [&self.before[axis], &self.now[axis]];
            let ends = Ends::unlimited(ends, [0.0; 2], &self.recalled, &self.rest);
            let Some(own) = self.memories[axis].exchange(&ends) else { return };
            stored += own.stored;
            work += own.work;
        }
        normal.stored += stored;
        normal.heat += (work - (stored - stored_before)).max(0.0);
        self.stored = Some(stored);
        let now = &self.numbers;
        row.other_work += match row.step.length() > 0.0 {
            true => 0.5 * inner(plus(before.force, now.force), minus(now.displacement, before.displacement)),
            false => row.simulation.grid.cell_area() * work + now.work - before.work,
        };
    }

    /// Finds the tractions of an attempt.
    ///
    /// # Errors
    /// [`Error::Sliding`], and those of solver and history.
    fn solve(&mut self, row: &mut Solved<'_>, tolerance: f64) -> Result<()> {
        let [most, scale] = self.limit(row);
        if !self.found.is_open {
            self.extrapolate(row.step.instant.time);
        }
        let (step, loads) = self.step(row.step, most);
        let given = self.given(row, most)?;
        if let Some(Coupled { lateral, under_pressure, .. }) = &mut self.coupled {
            lateral.under_pressure(&row.now.pressure, under_pressure);
            row.convolutions += 1;
        }
        let mut compliance = 0.0;
        for axis in 0..2 {
            let (memory, last) = (&mut self.memories[axis], &self.now[axis]);
            let law = match self.found.is_open {
                true => memory.reopen(&step, &self.rest, &mut self.recalled)?,
                false => memory.open(&step, last, &self.rest, &mut self.recalled)?,
            };
            compliance = law.compliance;
            let cells = (&self.recalled[..], &self.displacement[..]);
            each(&mut self.offset, cells, |b, (g, u)| b[axis] = g - u[axis]);
        }
        self.found = Found { compliance, loads, is_open: true, ..self.found };
        if let Some(Coupled { under_pressure, .. }) = &self.coupled {
            each(&mut self.offset, &under_pressure[..], |b, u| *b = plus(*b, times(compliance, u)));
        }
        let (offset, radius, scale) = (&self.offset[..], &self.radius[..], SMALLEST_SCALE * scale);
        let problem = SlipProblem { compliance, offset, radius, given, scale, energy: self.energy };
        let limits = (tolerance, row.simulation.solver.max_iterations);
        let time = row.step.instant.time;
        let outcome = self
            .solver
            .solve(&problem, &mut self.slip, limits, row.interrupt)
            .map_err(|error| error.at(time))?;
        row.convolutions += outcome.convolutions;
        self.found.outcome = self.found.outcome.then(outcome);
        Ok(())
    }
}

/// c K q + g - u_n - (d - d_n) of a cell that slips; where it sticks, what is left of the slip is the error of the solver.
fn slip_of(compliance: f64, d: Vector, (unit, offset, slips): (Vector, Vector, bool)) -> Vector {
    if slips { minus(plus(times(compliance, unit), offset), d) } else { [0.0; 2] }
}

impl Process for PartialSlip {
    fn acts_back(&self) -> bool {
        self.coupled.is_some()
    }

    fn act_back(&mut self, row: &mut Solved<'_>, tolerance: f64, to: &mut [f64]) -> Result<()> {
        self.solve(row, tolerance)?;
        if let Some(Coupled { lateral, .. }) = &mut self.coupled {
            lateral.under_traction(&self.slip.traction, to);
            row.convolutions += 1;
        }
        Ok(())
    }

    /// Finds tractions and slip.
    fn prepare(&mut self, row: &mut Solved<'_>) -> Result<()> {
        if self.coupled.is_none() {
            self.solve(row, row.simulation.solver.tolerance)?;
        }
        let (q, radius) = (&self.slip.traction[..], &self.radius[..]);
        each(&mut self.slips, (&row.contact.pressure[..], q, radius), |slips, (p, q, radius)| {
            *slips = p > 0.0 && length(q) >= radius * (1.0 - EDGE);
        });
        if row.simulation.wear.is_some() {
            row.slipped = zeros(q.len());
            let (compliance, d) = (self.found.compliance, self.slip.displacement);
            let cells = (&self.slip.unit[..], &self.offset[..], &self.slips[..]);
            each(&mut row.slipped, cells, |slipped, (u, b, slips)| {
                *slipped = length(slip_of(compliance, d, (u, b, slips)));
            });
        }
        Ok(())
    }

    fn accept(&mut self, row: &mut Solved<'_>) {
        let before = self.numbers;
        let Found { compliance, loads, outcome, .. } = std::mem::take(&mut self.found);
        self.load = loads[1];
        self.course = [self.course[1], self.law.at(row.step.instant.time)];
        self.energy = self.energy.max(outcome.energy);
        self.numbers.outcome = outcome;
        self.take_in(row, compliance);
        std::mem::swap(&mut self.before, &mut self.now);
        for axis in 0..2 {
            let now = &mut self.now[axis];
            each(&mut now.pressure, &self.slip.traction[..], |to, q| *to = q[axis]);
            each(&mut now.unit_displacement, &self.slip.unit[..], |to, u| *to = u[axis]);
            if let Some(Coupled { under_pressure, .. }) = &self.coupled {
                each(&mut now.unit_displacement, &under_pressure[..], |to, u| *to += u[axis]);
            }
            let ends = [&self.before[axis], &self.now[axis]];
            self.memories[axis].close(&Ends::unlimited(ends, loads, &self.recalled, &self.rest));
        }
        self.add_energies(row, &before);
    }

    fn slip(&self) -> Option<SlipFields<'_>> {
        Some(SlipFields {
            traction: &self.slip.traction,
            slip: &self.slid,
            path: &self.path,
            heat: &self.heat,
            slips: &self.slips,
            numbers: self.numbers,
        })
    }

    fn name(&self) -> &'static str {
        "partial_slip"
    }

    fn save<'a>(&'a self, to: &mut Saver<'a>, _gap: &'a UndeformedGap) {
        self.save_own(to);
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let component = |field: &[Vector]| field.iter().map(|v| v[axis]).collect();
            to.within(name, |to| {
                to.field("traction", &self.now[axis].pressure);
                to.field("previous_traction", &self.before[axis].pressure);
                to.field("unit_displacement", &self.now[axis].unit_displacement);
                to.owned_field("displacement", component(&self.displacement));
                to.owned_field("slip", component(&self.slid));
                to.within("history", |to| self.memories[axis].save(to));
            });
        }
    }

    fn load(&mut self, from: &mut Loader<'_>, _gap: &mut UndeformedGap) -> Result<()> {
        self.load_own(from)?;
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let set = |field: &mut [Vector], from: &[f64]| each(field, from, |v, part| v[axis] = part);
            from.within(name, |from| {
                from.field_into("previous_traction", &mut self.before[axis].pressure)?;
                let now = &mut self.now[axis];
                from.field_into("traction", &mut now.pressure)?;
                from.field_into("unit_displacement", &mut now.unit_displacement)?;
                set(&mut self.slip.traction, &now.pressure);
                set(&mut self.slip.unit, &now.unit_displacement);
                set(&mut self.displacement, &from.field("displacement")?);
                set(&mut self.slid, &from.field("slip")?);
                from.within("history", |from| self.memories[axis].load(from))
            })?;
        }
        Ok(())
    }
}

/// What a row tells of friction.
#[derive(Clone, Copy)]
pub(crate) struct SlipFields<'a> {
    /// q \[Pa\].
    pub(crate) traction: &'a [Vector],
    /// Slip since t = 0 \[m\].
    pub(crate) slip: &'a [Vector],
    /// Length of its path \[m\], and energy per area that friction has taken \[J/m^2\].
    pub(crate) path: &'a [f64],
    pub(crate) heat: &'a [f64],
    /// Whether a cell in contact slips.
    pub(crate) slips: &'a [bool],
    pub(crate) numbers: SlipRow,
}
