//! Wear: the surfaces recede where they slide under pressure ([`crate::wear`]).
//!
//! ```text
//! along a path, in motion     the step is solved with the surfaces at its end: κ = k ds is known before
//! by slip                     κ = k |slip of the step| is known after it: the surfaces of the row are those before its wear, and what it
//!                             takes off follows from the contact that the worn surfaces make
//! ```

use std::borrow::Cow;
use std::sync::Arc;

use asperity_sweep::{each, sums};

use super::{Process, Solved, roll};
use crate::contact::{ContactState, Prescribed, Problem, Start, Task};
use crate::error::Result;
use crate::grid::Boundary;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::{Interval, Loader, Saver, UndeformedGap, saved};
use crate::wear::{Cycles, Depth, RecedingSolver, Recession, Sliding, Wear};

pub(super) struct Wearing {
    simulation: Arc<Simulation>,
    law: Arc<Wear>,
    sliding: Sliding,
    depth: Depth,
    /// Cells along x and y from where the body started.
    offset: [f64; 2],
    /// The same of the last row.
    offset_before: [f64; 2],
    numbers: Numbers,
    cycles: Cycles,
    /// The contact after the wear of a row, where slip decides.
    after: Option<After>,
}

/// Volumes \[m³\] of both together and of the counterbody, and of the last row's step over its length \[m³/s\]; sliding distance \[m\];
/// volumes whose place is uncertain, and that are because load or cycles change over the steps \[m³\]; work \[J\]; largest depth \[m\].
#[derive(Default)]
struct Numbers {
    volume: f64,
    counterbody: f64,
    rate: f64,
    distance: f64,
    uncertain: f64,
    of_load: f64,
    work: f64,
    deepest: f64,
}

struct After {
    solver: RecedingSolver,
    /// What the row prepared recedes by because of its slip, and the contact that the worn surfaces make.
    recession: Recession,
    state: ContactState,
    /// The gap with what other tractions displace, where there are any.
    gap: Vec<f64>,
}

saved! {
    Numbers {
        "volumes": volume, counterbody, uncertain, of_load;
        "distance": distance;
        "work": work;
    }
}

saved! {
    Wearing {
        "offset_x": offset_before[0];
        "offset_y": offset_before[1];
    }
}

impl Wearing {
    /// `None` where nothing wears.
    pub(super) fn of(simulation: &Arc<Simulation>, operator: &dyn crate::operator::Operator) -> Option<Self> {
        let law = simulation.wear.clone()?;
        let sliding = law.sliding(simulation);
        let after = (sliding == Sliding::Slip).then(|| After {
            solver: RecedingSolver::new(simulation.solver.method, operator),
            recession: Recession::default(),
            state: ContactState::new(simulation.grid.len()),
            gap: vec![],
        });
        Some(Wearing {
            depth: Depth::new(&law, simulation.grid, simulation.boundary),
            simulation: simulation.clone(),
            sliding,
            offset: [0.0; 2],
            offset_before: [0.0; 2],
            numbers: Numbers::default(),
            cycles: Cycles::of(&law, simulation),
            law,
            after,
        })
    }

    /// Cells along x and y that the body has gone at a time.
    fn offset_at(&self, time: f64) -> [f64; 2] {
        let motion = self.simulation.motion.as_ref();
        motion.map_or([0.0; 2], |motion| motion.cells_gone(&self.simulation.grid, time))
    }

    /// Finds what the surfaces of a row recede by after it because of its slip, and the pressure that takes it off.
    fn wear_by_slip(&mut self, row: &mut Solved<'_>) -> Result<()> {
        let Some(After { solver, recession, state, gap }) = &mut self.after else { return Ok(()) };
        let factor = self.law.total() * self.cycles.factor;
        let mut cells = std::mem::take(&mut row.slipped);
        each(&mut cells, factors(&self.law), |slip, map| *slip *= factor * map);
        let is_none = asperity_sweep::is_zero(&cells);
        let scale = if is_none { 0.0 } else { 1.0 };
        *recession = Recession { scale, cells: Some(cells), threshold: self.law.threshold };
        state.clone_from(row.contact);
        if !is_none {
            let mut problem = Problem {
                gap: row.undeformed.or(row.own_gap),
                compliance: row.compliance,
                hardness: row.hardness,
                prescribed: row.step.prescribed(self.simulation.grid.area()),
            };
            if self.simulation.traction.is_some() {
                // They stay as they are in the row.
                gap.resize(problem.gap.len(), 0.0);
                let displaced = (&row.now.unit_displacement[..], &row.contact.unit_displacement[..]);
                each(gap, (problem.gap, displaced), |to, (h, (all, own))| {
                    *to = h + row.compliance * (all - own)
                });
                let [others] =
                    sums((&row.now.pressure[..], &row.contact.pressure[..]), |(all, own)| [all - own]);
                problem.gap = gap;
                if let Prescribed::Load(load) = &mut problem.prescribed {
                    *load -= others * self.simulation.grid.cell_area();
                }
            }
            let options = &self.simulation.solver;
            let (operator, interrupt) = (&mut *row.operator, row.interrupt);
            let task = Task { operator, problem: &problem, options, state, interrupt };
            row.convolutions += solver.solve(Start::Pressure, recession, task)?.convolutions;
        }
        Ok(())
    }

    /// The pressure of the last row where the contact is now.
    fn before<'a>(&self, row: &Solved<'a>) -> Cow<'a, [f64]> {
        let pressure = &row.contact_before.pressure;
        let shift =
            [0, 1].map(|axis| (self.offset[axis].round() - self.offset_before[axis].round()) as isize);
        let follows = self.simulation.motion.as_ref().is_some_and(|motion| motion.gap.follows());
        if shift == [0; 2] || !follows {
            return Cow::Borrowed(pressure);
        }
        let mut moved = vec![0.0; pressure.len()];
        roll(self.simulation.grid.shape(), self.simulation.boundary, shift, pressure, &mut moved);
        Cow::Owned(moved)
    }

    /// What wear takes of the work of the load: the mean of both pressures times the depth under the first \[J\].
    fn work(&self, recession: &Recession, [after, before]: [&[f64]; 2]) -> f64 {
        let cells = (after, before, recession.per_pressure());
        let [work] = sums(cells, |(p, q, k)| [0.5 * (p + q) * crate::wear::depth(p, k, recession.threshold)]);
        work * self.simulation.grid.cell_area()
    }

    /// What is left of a wrong depth after a step: where it is too large less is worn. A wave that yields by y per pressure keeps
    /// y/(y + κ) of it; y is that of the whole contact, on a periodic domain that of its longest wave at least.
    fn damping(&self, recession: &Recession, state: &ContactState, compliance: f64) -> f64 {
        let cells = (&state.pressure[..], &state.unit_displacement[..], recession.per_pressure());
        let [yields, wears, square] = sums(cells, |(p, u, k)| [p * compliance * u, p * p * k, p * p]);
        if wears == 0.0 {
            return 1.0;
        }
        let Simulation { kernel, grid, boundary, .. } = &*self.simulation;
        let longest = match boundary {
            Boundary::Free => 0.0,
            Boundary::Periodic => {
                compliance * kernel.symbol(std::f64::consts::TAU / grid.longest_side(), 0.0)
            }
        };
        let (y, k) = ((yields / square).max(longest), wears / square);
        y / (y + k)
    }
}

/// The factor of each cell.
fn factors(law: &Wear) -> crate::operator::Bed<'_> {
    crate::operator::Bed { scale: 1.0, cells: law.map.as_ref().and_then(|map| map.as_slice()) }
}

impl Process for Wearing {
    fn moves(&self, _step: &Interval) -> bool {
        self.sliding != Sliding::Slip
    }

    /// The gap without the wear of the step, and by what it recedes in the step.
    fn open(&mut self, step: &Interval, gap: &mut UndeformedGap) -> Result<()> {
        match self.sliding {
            Sliding::Slip => return Ok(()),
            Sliding::Path => gap.go_back(),
            Sliding::Motion => {
                self.offset = self.offset_at(step.instant.time);
                let slopes = self.depth.add_to(gap.own_mut(), self.offset);
                gap.add_slopes(slopes);
            }
        }
        let scale = self.law.total() * self.law.distance(&self.simulation, step.start, step.instant.time);
        let cells = self.law.map.as_ref().map(|map| map.iter().copied().collect());
        gap.recession = Recession { scale, cells, threshold: self.law.threshold };
        Ok(())
    }

    fn prepare(&mut self, row: &mut Solved<'_>) -> Result<()> {
        self.wear_by_slip(row)
    }

    /// Takes in what the row has worn.
    fn accept(&mut self, row: &mut Solved<'_>) {
        let pressure = &row.contact.pressure[..];
        let ([volume, uncertain], damping) = if let Some(After { recession, state, .. }) = &self.after {
            recession.add(&state.pressure, row.undeformed.own_mut());
            let damping = self.damping(recession, state, row.compliance);
            row.worn_work = self.work(recession, [&state.pressure, pressure]);
            (self.depth.add(recession, &state.pressure, pressure, self.offset), damping)
        } else {
            let recession = &row.undeformed.recession;
            let before = self.before(row);
            row.worn_work = self.work(recession, [pressure, &before]);
            let damping = self.damping(recession, row.contact, row.compliance);
            (self.depth.add(recession, pressure, &before, self.offset), damping)
        };
        self.offset_before = self.offset;
        let of_cycles = self.cycles.take_in([row.step.start, row.step.instant.time], [volume, uncertain]);
        let length = row.step.length();
        let numbers = &mut self.numbers;
        numbers.volume += volume;
        numbers.work += row.worn_work;
        numbers.counterbody += volume * self.law.shares()[1];
        numbers.uncertain = damping * (numbers.uncertain + uncertain);
        let distance = self.law.distance(&self.simulation, row.step.start, row.step.instant.time);
        // The load is that at the end of the step, of the contact alone.
        let [before, now] = row.contact_loads();
        let per_load = if now > 0.0 { volume / now } else { self.law.total() * distance };
        numbers.of_load += 0.5 * per_load * (now - before).abs() + of_cycles;
        numbers.rate = if length > 0.0 { volume / length } else { 0.0 };
        numbers.distance += distance;
        numbers.deepest = self.depth.largest();
    }

    fn error(&self, ends: &crate::history::Ends<'_>, gap: &UndeformedGap, compliance: f64) -> Option<f64> {
        if self.sliding == Sliding::Motion {
            return None;
        }
        let recession = &gap.recession;
        let threshold = recession.threshold;
        let of = |p: f64, k: f64| crate::wear::depth(p, k, threshold);
        let [before, now] = ends.pressures;
        let cells = (now, before, &ends.now.unit_displacement[..], recession.per_pressure());
        let [misplaced, yields, wears] = sums(cells, |(p, before, u, k)| {
            [p * 0.5 * (of(p, k) - of(before, k)).abs(), p * compliance * u, p * of(p, k)]
        });
        // What is left of it after the step, over the displacement.
        (!recession.is_none() && yields > 0.0).then(|| misplaced / (yields + wears))
    }

    fn preview(&mut self, quantity: Quantity, row: &mut Solved<'_>) -> Result<Option<f64>> {
        if self.sliding == Sliding::Slip {
            return Ok(None);
        }
        let share = match quantity {
            Quantity::WearDistance => {
                let way = self.law.distance(&self.simulation, row.step.start, row.step.instant.time);
                return Ok(Some(self.numbers.distance + way));
            }
            Quantity::WearVolume => 1.0,
            Quantity::CounterbodyWearVolume => self.law.shares()[1],
            _ => return Ok(None),
        };
        let recession = &row.undeformed.recession;
        let cells = (&row.contact.pressure[..], recession.per_pressure());
        let [depths] = sums(cells, |(p, k)| [crate::wear::depth(p, k, recession.threshold)]);
        let before = if share == 1.0 { self.numbers.volume } else { self.numbers.counterbody };
        Ok(Some(before + share * depths * self.simulation.grid.cell_area()))
    }

    fn quantity(&self, quantity: Quantity) -> Option<f64> {
        let numbers = &self.numbers;
        Some(match quantity {
            Quantity::WearVolume => numbers.volume,
            Quantity::CounterbodyWearVolume => numbers.counterbody,
            Quantity::WearRate => numbers.rate,
            Quantity::WearDistance => numbers.distance,
            Quantity::WearCycles => self.cycles.total(),
            Quantity::WearDepthMax => numbers.deepest,
            Quantity::WearError if numbers.volume > 0.0 && self.cycles.are_alone() => 1.0,
            Quantity::WearError if numbers.volume > 0.0 => {
                ((numbers.uncertain + numbers.of_load) / numbers.volume).min(1.0)
            }
            Quantity::WearError => 0.0,
            _ => return None,
        })
    }

    fn worn_work(&self) -> f64 {
        self.numbers.work
    }

    fn worn(&self) -> Option<&[Vec<f64>; 2]> {
        Some(&self.depth.of_bodies)
    }

    fn name(&self) -> &'static str {
        "wear"
    }

    fn save<'a>(&'a self, to: &mut Saver<'a>, gap: &'a UndeformedGap) {
        self.save_own(to);
        self.numbers.save_own(to);
        self.cycles.save_own(to);
        to.field("gap", gap.now());
        for (name, field) in ["body", "counterbody"].into_iter().zip(&self.depth.of_bodies) {
            if !field.is_empty() {
                to.field(name, field);
            }
        }
    }

    fn load(&mut self, from: &mut Loader<'_>, gap: &mut UndeformedGap) -> Result<()> {
        self.load_own(from)?;
        self.offset = self.offset_before;
        self.numbers.load_own(from)?;
        self.cycles.load_own(from)?;
        from.field_into("gap", gap.own_mut())?;
        for (name, field) in ["body", "counterbody"].into_iter().zip(&mut self.depth.of_bodies) {
            if !field.is_empty() {
                from.field_into(name, field)?;
            }
        }
        Ok(())
    }
}
