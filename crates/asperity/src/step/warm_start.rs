//! The warm start of a row: of the combinations of two known states, p = a p_n + f (p_n - p'), the one of least energy
//! p'(cK)p/2 + h'p among those with the load.
//!
//! p_n is the last row; p' is the row before it, or the last trial of a row that is solved again. In a creep that fades the best
//! f is less than one, and it is found for any programme and material. U = K p is linear, so all this needs no convolution, and
//! U of the guess is known. Its rounding error grows with every row that takes its U this way; a bound of it goes along with the
//! state, and where it could show, U is computed afresh. Where layers creep differently the operator is another one in each step:
//! there the two U cost a convolution each, and save several iterations.

use asperity_sweep::simd::Mask;

use super::{Interval, StepState, Stepper};
use crate::contact::{ContactState, Hardness, Prescribed, SAME_LOAD, Start};
use crate::grid::Boundary;
use crate::operator::Bed;
use crate::process::roll;
use asperity_sweep::{each, kernel, run, sum};

/// Least and largest f.
const REACH: std::ops::Range<f64> = -4.0..4.0;
/// Least and largest a that an energy may ask for.
const GROWTH: std::ops::Range<f64> = 0.25..4.0;
/// The share of the energy below which a change is none.
const NONE: f64 = 1e-20;
/// The share of the violations that the solver lets pass below which a slope is not seen: they do not all add up.
const FELT: f64 = 0.1;
/// What a may be off by where the load is the same: less than a load is met by.
const SAME: f64 = 4e-13;
/// The share of the pressure that may lie outside its bounds: the solver's step onto the bounds is small then.
const OUTSIDE: f64 = 1e-4;

/// The rounding error of U falls by this factor at least in a row where it is computed afresh.
const REFRESHED: f64 = 100.0;

/// x = p_n and d = p_n - p', their energies, works against the gap, and sums.
#[derive(Clone, Copy)]
struct Pair {
    /// x'Kx, d'Kx, d'Kd
    energy: [f64; 3],
    /// h'x, h'd
    work: [f64; 2],
    /// sum x, sum d
    sum: [f64; 2],
    /// sum |d|
    size: f64,
    /// Cells of x at the cut-off.
    capped: f64,
}

/// The guess a x + f d.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Combination {
    a: f64,
    f: f64,
}

/// What is asked of a guess.
#[derive(Clone, Copy)]
struct Wanted {
    compliance: f64,
    prescribed: Prescribed,
    cell_area: f64,
    /// The f that is linear in time.
    linear: f64,
    /// Violations that the solver lets pass \[m\], over its displacement; and as they are.
    tolerance: f64,
    rounding: f64,
}

impl Pair {
    /// The best a x + f d; x as it is where nothing can be said.
    fn best(&self, wanted: &Wanted) -> Combination {
        let best = match wanted.prescribed {
            Prescribed::Load(load) => self.with_sum(wanted, load / wanted.cell_area),
            Prescribed::Approach(w) => self.at_approach(wanted, w),
        };
        if best.a.is_finite() && best.f.is_finite() { best } else { Combination { a: 1.0, f: 0.0 } }
    }

    fn with_sum(&self, wanted: &Wanted, sum: f64) -> Combination {
        let ([xx, xd, dd], [hx, hd], [sx, sd]) = (self.energy, self.work, self.sum);
        if sx == 0.0 {
            // Only d presses.
            return Combination { a: 1.0, f: sum / sd };
        }
        if (sum / sx - 1.0).abs() > SAME && self.capped > 0.0 {
            // Cells at the cut-off take no more: the change from row to row goes on until the load is met.
            let f = (sum - sx) / sd;
            let goes_on = Combination { a: 1.0, f };
            return if REACH.contains(&f) { goes_on } else { Combination { a: sum / sx, f: 0.0 } };
        }
        // d without its share of x has no load.
        let share = sd / sx;
        let curvature = dd - share * (2.0 * xd - share * xx);
        let slope = wanted.compliance * sum / sx * (xd - share * xx) + (hd - share * hx);
        let f = self.along(wanted, curvature, slope);
        let a = (sum - f * sd) / sx;
        // Where the load stays the same, so do cells at the cut-off.
        Combination { a: if (a - 1.0).abs() <= SAME { 1.0 } else { a }, f }
    }

    fn at_approach(&self, wanted: &Wanted, w: f64) -> Combination {
        let (c, [xx, xd, dd], [hx, hd], [sx, sd]) = (wanted.compliance, self.energy, self.work, self.sum);
        let (along_x, along_d) = (hx - w * sx, hd - w * sd);
        let one_and = |f| Combination { a: 1.0, f };
        if sx == 0.0 {
            return one_and(wanted.linear);
        }
        if self.capped > 0.0 {
            return one_and(self.along(wanted, dd, c * xd + along_d));
        }
        // d without its share of x does no work on x.
        let share = xd / xx;
        let f = self.along(wanted, dd - share * xd, along_d - share * along_x);
        let slope = c * (xx + f * xd) + along_x;
        if slope.abs() <= self.noise(wanted) * sx {
            return one_and(f);
        }
        // Where x costs hardly any energy, as an even pressure on a periodic domain, this says nothing.
        let a = 1.0 - slope / (c * xx);
        if GROWTH.contains(&a) { Combination { a, f } } else { one_and(wanted.linear) }
    }

    /// The best f along a direction with that energy over the compliance, and the slope that the energy has at f = 0. The
    /// linear one where the solver would not tell them apart.
    fn along(&self, wanted: &Wanted, energy: f64, slope: f64) -> f64 {
        let curvature = wanted.compliance * energy;
        let seen = (slope + wanted.linear * curvature).abs() > self.noise(wanted) * self.size;
        if seen && energy > NONE * self.energy[0] {
            (-slope / curvature).clamp(REACH.start, REACH.end)
        } else {
            wanted.linear
        }
    }

    /// Violations that are not seen \[m\].
    fn noise(&self, wanted: &Wanted) -> f64 {
        FELT * (wanted.tolerance * wanted.compliance * self.energy[0] / self.sum[0] + wanted.rounding)
    }
}

impl Stepper {
    /// Makes the guess for the contact of `step` in `self.state.now`, which holds the row before the last one, or the last attempt at this
    /// row.
    pub(super) fn guess(&mut self, step: &Interval, prescribed: Prescribed) -> Start {
        if self.contact.pulls() {
            // The traction keeps its own start.
            self.contact.follow(self.shift(step).unwrap_or_default(), self.simulation.boundary);
            self.state.now.approach = self.state.before.approach;
            return Start::Pressure;
        }
        if let Some(start) = self.guess_shifted(step, prescribed) {
            return start;
        }
        let linear = match self.tried {
            Some(tried) => -(step.length() / tried).min(REACH.end),
            None if self.state.last_length > 0.0 => (step.length() / self.state.last_length).min(REACH.end),
            None => 0.0,
        };
        self.combine(prescribed, linear)
    }

    /// The guess where the gap moves: the last pressure, moved by whole cells. `None` where it does not move so far.
    fn guess_shifted(&mut self, step: &Interval, prescribed: Prescribed) -> Option<Start> {
        let shift = self.shift(step).filter(|shift| *shift != [0; 2] && self.state.touched)?;
        let (grid, boundary) = (&self.simulation.grid, self.simulation.boundary);
        let (from, to) = (&self.state.before, &mut self.state.now);
        roll(grid.shape(), boundary, shift, &from.pressure, &mut to.pressure);
        roll(grid.shape(), boundary, shift, &from.unit_displacement, &mut to.unit_displacement);
        let bed = self.state.undeformed.recession.bed(self.state.compliance);
        if !bed.is_none() {
            each(&mut to.unit_displacement, (&to.pressure[..], bed), |u, (p, bed)| *u += bed * p);
        }
        to.rounding = from.rounding + 1.0;
        to.approach = from.approach;
        let has_load = match prescribed {
            Prescribed::Load(load) => (sum(&to.pressure) * grid.cell_area() / load - 1.0).abs() <= SAME_LOAD,
            Prescribed::Approach(_) => true,
        };
        let is_known = boundary == Boundary::Periodic
            && has_load
            && to.is_precise(self.contact.options.tolerance)
            && self.contact.keeps_operator();
        Some(if is_known { Start::Displacement { feasible: true } } else { Start::Pressure })
    }

    /// `linear` is the f of extrapolation in time.
    fn combine(&mut self, prescribed: Prescribed, linear: f64) -> Start {
        for known in [&mut self.state.now, &mut self.state.before] {
            self.outcome.convolutions += self.contact.refresh(known);
        }
        let cell_area = self.simulation.grid.cell_area();
        let (hardness, tolerance) = (self.contact.hardness(), self.contact.options.tolerance);
        let StepState { now, before, own_gap, undeformed, compliance, .. } = &mut self.state;
        let ContactState { pressure: p, unit_displacement: u, .. } = now;
        let ContactState { pressure: p_last, unit_displacement: u_last, .. } = &*before;
        let gap = undeformed.or(own_gap);
        let bed = undeformed.recession.bed(*compliance);
        let (p, u, p_last, u_last) = (&mut p[..], &mut u[..], &p_last[..], &u_last[..]);
        let products = run(Products { p: &*p, u: &*u, p_last, u_last, gap, hardness, bed });
        let [xx, xd, dd, hx, hd, sx, sd, size, capped] = products;
        if sx == 0.0 && size == 0.0 {
            // Neither presses.
            return Start::Pressure;
        }
        let pair = Pair { energy: [xx, xd, dd], work: [hx, hd], sum: [sx, sd], size, capped };
        let combination = pair.best(&Wanted {
            compliance: *compliance,
            prescribed,
            cell_area,
            linear,
            tolerance,
            rounding: 16.0 * f64::EPSILON * before.approach.abs(),
        });
        let [total, feasible, outside, kept] =
            run(Combine { p, u, p_last, u_last, hardness, bed, combination });
        // After a row whose U was computed afresh the next one is, too: the error of the row before it is still in f.
        let refreshed = self.state.now.rounding > REFRESHED * self.state.before.rounding;
        let Combination { a, f } = combination;
        self.state.now.rounding =
            (a + f).abs() * self.state.before.rounding + f.abs() * self.state.now.rounding + 1.0;
        // The load is met but for rounding; where nothing presses, the solver starts cold.
        let has_load = match prescribed {
            Prescribed::Load(load) => (cell_area * total / load - 1.0).abs() <= SAME_LOAD,
            Prescribed::Approach(_) => feasible > 0.0,
        };
        let is_precise = self.state.now.is_precise(tolerance) && !refreshed;
        if has_load && is_precise && kept == 0.0 && outside <= OUTSIDE * feasible {
            Start::Displacement { feasible: outside == 0.0 }
        } else {
            Start::Pressure
        }
    }
}

kernel! {
    /// The numbers of [`Pair`] in their order, for x = p_last and d = p_last - p.
    struct Products<'a> {
        cells {
            p: &'a [f64], u: &'a [f64], p_last: &'a [f64], u_last: &'a [f64],
            gap: &'a [f64], hardness: Hardness<'a>, bed: Bed<'a>,
        }
    }
    fn run<V>(self) -> [f64; 9] {
        let zero = V::splat(0.0);
        let mut sums = [zero; 9];
        for n in (0..self.p.len()).step_by(8) {
            let (p, x) = (V::load(self.p, n, 0.0), V::load(self.p_last, n, 0.0));
            let d = x - p;
            let touches = zero.less(x.abs()) | zero.less(d.abs());
            if touches.bits() == 0 {
                continue;
            }
            let bed = self.bed.load::<V>(n);
            let (u, ux) = (V::load(self.u, n, 0.0) + bed * p, V::load(self.u_last, n, 0.0) + bed * x);
            // Infinite where a cell cannot touch.
            let h = V::load(self.gap, n, 0.0).only(touches);
            let capped = V::count(touches & !x.less(self.hardness.load(n)));
            let terms = [x * ux, d * ux, d * (ux - u), x * h, d * h, x, d, d.abs(), capped];
            sums = std::array::from_fn(|k| sums[k] + terms[k]);
        }
        sums.map(V::sum)
    }
}

kernel! {
    /// p = a p_last + f (p_last - p), and U likewise; yields the sum of p, of its projection onto the bounds and of what lies
    /// outside of them, and the number of cells at the cut-off that would leave it and are kept there, so that U is not theirs.
    struct Combine<'a> {
        cells {
            p: &'a mut [f64], u: &'a mut [f64], p_last: &'a [f64], u_last: &'a [f64], hardness: Hardness<'a>,
            bed: Bed<'a>,
        }
        numbers { combination: Combination }
    }
    fn run<V>(self) -> [f64; 4] {
        let Combination { a, f } = self.combination;
        let (a, f, zero) = (V::splat(a), V::splat(f), V::splat(0.0));
        let mut sums = [zero; 4];
        for n in (0..self.p.len()).step_by(8) {
            let (p, x) = (V::load(self.p, n, 0.0), V::load(self.p_last, n, 0.0));
            let bed = self.bed.load::<V>(n);
            let (u, ux) = (V::load(self.u, n, 0.0) + bed * p, V::load(self.u_last, n, 0.0) + bed * x);
            (a * ux + f * (ux - u)).store(self.u, n);
            let touches = zero.less(x.abs()) | zero.less(p.abs());
            if touches.bits() == 0 {
                continue;
            }
            let bounds = self.hardness.interval::<V>(n);
            let p = a * x + f * (x - p);
            let leaves = bounds.top.at_most(x) & p.less(bounds.top);
            let p = V::select(leaves, bounds.top, p);
            p.store(self.p, n);
            let feasible = bounds.project(p);
            let terms = [p, feasible, (p - feasible).abs(), V::count(leaves)];
            sums = std::array::from_fn(|k| sums[k] + terms[k]);
        }
        sums.map(V::sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::{Drive, March};
    use crate::grid::{Boundary, Grid};
    use crate::load::{Control, History};
    use crate::material::{Creep, CreepTerm};
    use crate::simulation::Simulation;
    use crate::step::Proposal;
    use crate::time::TimeGrid;

    /// A rough gap that creeps under a load, 120 rows of it.
    fn creep(boundary: Boundary, hardness: f64) -> March {
        let grid = Grid::new([48, 40], [1.0, 1.0]).unwrap();
        let gap = ndarray::Array2::from_shape_fn(grid.shape(), |(i, j)| {
            let (x, y) = (grid.x(i) - 0.5, grid.y(j) - 0.5);
            0.5 * (x * x + y * y) + 4e-3 * (1.0 - (41.0 * x + 0.3).cos() * (37.0 * y + 0.7).cos())
        });
        let terms = vec![CreepTerm { compliance: 1.0, retardation_time: 2.0 }];
        March::new(Simulation {
            boundary,
            hardness,
            creep: Creep { instantaneous: 1.0, terms, fluidity: 0.0 },
            loading: crate::Loading { control: Control::Load, history: History::Step { value: 0.02 } }.into(),
            times: TimeGrid::Uniform { end: 4.0, steps: 120 },
            ..Simulation::new(grid, gap)
        })
        .unwrap()
    }

    #[test]
    fn a_row_takes_no_convolution_but_those_of_its_steps_and_its_displacement_is_that_of_its_pressure() {
        for (boundary, hardness) in [(Boundary::Free, 0.25), (Boundary::Periodic, f64::INFINITY)] {
            let mut march = creep(boundary, hardness);
            let mut fresh = vec![0.0; march.simulation().grid.len()];
            let mut rows = 0;
            while let Some(step) = march.advance().unwrap() {
                let row = step.row();
                rows += usize::from(row.convolutions == row.iterations);
                let Stepper { contact, state, .. } = &mut march.stepper;
                let now = &mut state.now;
                contact.operator.apply_into(&now.pressure, &mut fresh);
                let largest = fresh.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
                let off = fresh.iter().zip(&now.unit_displacement).map(|(a, b)| (a - b).abs());
                let off = off.fold(0.0, f64::max);
                // A convolution has some roundings itself.
                let bound = 4.0 * f64::EPSILON * now.rounding;
                assert!(off <= bound * largest, "{} s: {off} {bound}", row.time());
            }
            // U is computed afresh in one row of ten or so.
            assert!(rows > 100, "{boundary:?}: {rows}");
        }
    }

    #[test]
    fn no_other_combination_of_the_load_has_less_energy() {
        for (boundary, hardness) in [(Boundary::Free, f64::INFINITY), (Boundary::Periodic, 0.25)] {
            let mut march = creep(boundary, hardness);
            for _ in 0..12 {
                march.advance().unwrap();
            }
            let March { stepper, schedule, .. } = &mut march;
            let (last, before) = (stepper.state.now.pressure.clone(), stepper.state.before.pressure.clone());
            let Proposal::Try(step) = schedule.propose().unwrap() else { panic!("more rows are planned") };
            let step = stepper.open(&step).unwrap();
            stepper.guess(&step, step.prescribed(1.0));
            let guess = stepper.state.now.pressure.clone();
            let mut energy = |beside: f64| -> f64 {
                let p: Vec<f64> =
                    (0..last.len()).map(|n| guess[n] + beside * (last[n] - before[n])).collect();
                let mut u = vec![0.0; p.len()];
                stepper.contact.operator.apply_into(&p, &mut u);
                let terms = p.iter().zip(&u).zip(stepper.state.gap());
                terms.map(|((p, u), h)| 0.5 * stepper.state.compliance * p * u + h * p).sum()
            };
            let [less, here, more] = [-0.1, 0.0, 0.1].map(&mut energy);
            // A parabola with its end here, to what differences of the energy keep.
            assert!(less > here && more > here, "{less} {here} {more}");
            assert!((less - more).abs() < 1e-3 * (less + more - 2.0 * here), "{less} {here} {more}");
            let carried = |p: &[f64]| p.iter().sum::<f64>();
            assert!((carried(&guess) / carried(&last) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_relaxing_contact_that_keeps_its_shape_takes_no_iterations() {
        // Of a cylinder's end the pressure relaxes everywhere alike.
        let grid = Grid::new([32, 32], [2.0, 2.0]).unwrap();
        let gap = ndarray::Array2::from_shape_fn(grid.shape(), |(i, j)| {
            if (grid.x(i) - 1.0).hypot(grid.y(j) - 1.0) < 0.5 { 0.0 } else { f64::INFINITY }
        });
        let terms = vec![CreepTerm { compliance: 1.0, retardation_time: 2.0 }];
        let mut march = March::new(Simulation {
            creep: Creep { instantaneous: 1.0, terms, fluidity: 0.0 },
            loading: crate::Loading { control: Control::Approach, history: History::Step { value: 0.02 } }
                .into(),
            times: TimeGrid::Uniform { end: 4.0, steps: 20 },
            ..Simulation::new(grid, gap)
        })
        .unwrap();
        let (mut iterations, mut loads) = (vec![], vec![]);
        while let Some(step) = march.advance().unwrap() {
            iterations.push(step.row().iterations);
            loads.push(step.row().load);
        }
        assert!(iterations[0] > 0 && iterations[1..].iter().all(|n| *n == 0), "{iterations:?}");
        // G(t)/G(0) = (1 + exp(-t))/2 of this solid (its relaxation time is half of its retardation time); the step of 0.2 in
        // time leaves 1e-3.
        let relaxed = 0.5 * (1.0 + (-4.0_f64).exp());
        assert!((loads[20] / loads[0] / relaxed - 1.0).abs() < 2e-3, "{}", loads[20] / loads[0]);
    }
}
