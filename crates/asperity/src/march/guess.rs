//! What the solve of a row starts from: of the combinations of two states that are known, p = a p_n + f (p_n - p'), the one of
//! least energy p'(cK)p/2 + h'p among those with the load.
//!
//! p' is the row before the last one, p_n, or the last trial of a row that is solved again. In a creep that fades the best f
//! falls short of one, and it is found for any programme and material. U = K p is linear, so that all this needs no
//! convolution, and U of the guess is known. Its roundings grow with every row that takes its U this way; before they are
//! seen, the solver finds it afresh.

use asperity_convolution::eights::{Eight, Mask, Work, vectorize};

use super::{March, cap};
use crate::contact::{FreeGap, Hardness, MET, Prescribed, Start};
use crate::field::sweep;
use crate::time::Instant;

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
/// The share of the pressure that may lie beyond its bounds: the first iteration does not see what comes of leading it back.
const BEYOND: f64 = 1e-4;

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
    /// \[a, f\] of the best a x + f d; x as it is where nothing can be said.
    fn best(&self, wanted: &Wanted) -> [f64; 2] {
        let best = match wanted.prescribed {
            Prescribed::Load(load) => self.with_sum(wanted, load / wanted.cell_area),
            Prescribed::Approach(w) => self.at_approach(wanted, w),
        };
        if best.iter().all(|x| x.is_finite()) { best } else { [1.0, 0.0] }
    }

    fn with_sum(&self, wanted: &Wanted, sum: f64) -> [f64; 2] {
        let ([xx, xd, dd], [hx, hd], [sx, sd]) = (self.energy, self.work, self.sum);
        if sx == 0.0 {
            // Only d presses.
            return [1.0, sum / sd];
        }
        if (sum / sx - 1.0).abs() > SAME && self.capped > 0.0 {
            // Cells at the cut-off take no more: the change from row to row goes on until the load is met.
            let f = (sum - sx) / sd;
            return if REACH.contains(&f) { [1.0, f] } else { [sum / sx, 0.0] };
        }
        // d without its share of x has no load.
        let share = sd / sx;
        let curvature = dd - share * (2.0 * xd - share * xx);
        let slope = wanted.compliance * sum / sx * (xd - share * xx) + (hd - share * hx);
        let f = self.along(wanted, curvature, slope);
        let a = (sum - f * sd) / sx;
        // Where the load stays the same, so do cells at the cut-off.
        [if (a - 1.0).abs() <= SAME { 1.0 } else { a }, f]
    }

    fn at_approach(&self, wanted: &Wanted, w: f64) -> [f64; 2] {
        let (c, [xx, xd, dd], [hx, hd], [sx, sd]) = (wanted.compliance, self.energy, self.work, self.sum);
        let (along_x, along_d) = (hx - w * sx, hd - w * sd);
        if sx == 0.0 {
            return [1.0, wanted.linear];
        }
        if self.capped > 0.0 {
            return [1.0, self.along(wanted, dd, c * xd + along_d)];
        }
        // d without its share of x does no work on x.
        let share = xd / xx;
        let f = self.along(wanted, dd - share * xd, along_d - share * along_x);
        let slope = c * (xx + f * xd) + along_x;
        if slope.abs() <= self.noise(wanted) * sx {
            return [1.0, f];
        }
        // Where x costs hardly any energy, as an even pressure on a periodic domain, this says nothing.
        let a = 1.0 - slope / (c * xx);
        if GROWTH.contains(&a) { [a, f] } else { [1.0, wanted.linear] }
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

impl March {
    /// Makes the guess for the row that ends at `instant` in `self.state`, which holds the row before the last one.
    pub(super) fn guess(&mut self, instant: Instant) -> Start {
        self.roundings = self.roundings.begin();
        let before = self.timeline.last().map_or(0.0, |last| last.dt);
        self.combine(instant, if before > 0.0 { (instant.dt / before).min(REACH.end) } else { 0.0 })
    }

    /// The same where `self.state` holds the trial of a step of length `tried`.
    pub(super) fn guess_again(&mut self, instant: Instant, tried: f64) -> Start {
        self.combine(instant, -(instant.dt / tried).min(REACH.end))
    }

    fn combine(&mut self, instant: Instant, linear: f64) -> Start {
        let prescribed = self.prescribed(instant);
        let cell_area = self.simulation.grid.cell_area();
        let hardness = cap(&self.simulation, &self.hardness);
        let (state, last) = (&mut self.state, &self.previous);
        let (p, u) = (&mut state.pressure[..], &mut state.unit_displacement[..]);
        let (p_last, u_last) = (&last.pressure[..], &last.unit_displacement[..]);
        let [x0, x1, x2, h0, h1, s0, s1, size, capped] = sweep(
            (&*p, &*u, p_last, u_last, (&self.gap[..], hardness)),
            &|(p, u, p_last, u_last, (h, hardness)): (&[f64], &[f64], &[f64], &[f64], (&[f64], Hardness))| {
                vectorize(Look { p, u, p_last, u_last, h, hardness })
            },
        );
        let pair = Pair { energy: [x0, x1, x2], work: [h0, h1], sum: [s0, s1], size, capped };
        let best = pair.best(&Wanted {
            compliance: self.compliance,
            prescribed,
            cell_area,
            linear,
            tolerance: self.simulation.solver.tolerance,
            rounding: 16.0 * f64::EPSILON * state.approach.abs(),
        });
        let compliance = self.compliance;
        let [total, allowed, beyond, kept, free, gap, size] = sweep(
            ((p, u), p_last, u_last, (&self.gap[..], hardness)),
            &|((p, u), p_last, u_last, (h, hardness)): (
                (&mut [f64], &mut [f64]),
                &[f64],
                &[f64],
                (&[f64], Hardness),
            )| { vectorize(Combine { best, p, u, p_last, u_last, h, hardness, compliance }) },
        );
        self.roundings = self.roundings.combined(best);
        let tolerance = self.simulation.solver.tolerance;
        // The sum is met but for rounding; where nothing presses, the solver starts cold.
        let meets = match prescribed {
            Prescribed::Load(load) => (cell_area * total / load - 1.0).abs() <= MET,
            Prescribed::Approach(_) => allowed > 0.0,
        };
        if meets && kept == 0.0 && beyond <= BEYOND * allowed && self.roundings.are_moderate(tolerance) {
            let gap = (size > 0.0).then(|| FreeGap { mean: gap / free, size: size / free });
            Start::Known { roundings: self.roundings, beyond: beyond > 0.0, gap }
        } else {
            Start::Guess
        }
    }
}

/// The numbers of [`Pair`].
struct Look<'a> {
    p: &'a [f64],
    u: &'a [f64],
    p_last: &'a [f64],
    u_last: &'a [f64],
    h: &'a [f64],
    hardness: Hardness<'a>,
}

impl Work for Look<'_> {
    type Yield = [f64; 9];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 9] {
        let zero = V::splat(0.0);
        let mut sums = [zero; 9];
        for n in (0..self.p.len()).step_by(8) {
            let [p, x] = [self.p, self.p_last].map(|f| V::load(f, n, 0.0));
            let d = x - p;
            let touches = zero.less(x.abs()) | zero.less(d.abs());
            if touches.bits() == 0 {
                continue;
            }
            let [u, ux] = [self.u, self.u_last].map(|f| V::load(f, n, 0.0));
            // Infinite where a cell cannot touch.
            let h = V::load(self.h, n, 0.0).only(touches);
            let capped = touches & !x.less(self.hardness.eight(n));
            let terms = [x * ux, d * ux, d * (ux - u), x * h, d * h, x, d, d.abs(), V::count(capped)];
            sums = std::array::from_fn(|k| sums[k] + terms[k]);
        }
        sums.map(V::sum)
    }
}

/// p = a p_n + f (p_n - p), and U likewise; yields the sum, those of what lies within the bounds and beyond; the number of
/// cells at the cut-off that would leave it and are kept there, so that their U is another; and of the cells between the bounds
/// the number and the sums of g = c U + h and |g|.
struct Combine<'a> {
    best: [f64; 2],
    p: &'a mut [f64],
    u: &'a mut [f64],
    p_last: &'a [f64],
    u_last: &'a [f64],
    h: &'a [f64],
    hardness: Hardness<'a>,
    compliance: f64,
}

impl Work for Combine<'_> {
    type Yield = [f64; 7];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 7] {
        let ([a, f], [c, zero]) = (self.best.map(V::splat), [self.compliance, 0.0].map(V::splat));
        let mut sums = [zero; 7];
        for n in (0..self.p.len()).step_by(8) {
            let (p, x) = (V::load(self.p, n, 0.0), V::load(self.p_last, n, 0.0));
            let (u, ux) = (V::load(self.u, n, 0.0), V::load(self.u_last, n, 0.0));
            let u = a * ux + f * (ux - u);
            u.store(self.u, n);
            let touches = zero.less(x.abs()) | zero.less(p.abs());
            if touches.bits() == 0 {
                continue;
            }
            let top: V = self.hardness.eight(n);
            let p = a * x + f * (x - p);
            let leaves = !x.less(top) & p.less(top);
            let p = V::select(leaves, top, p);
            p.store(self.p, n);
            let allowed = p.clip(top);
            let free = zero.less(p) & p.less(top);
            let g = (c * u + V::load(self.h, n, f64::INFINITY)).only(free);
            let terms = [p, allowed, (p - allowed).abs(), V::count(leaves), V::count(free), g, g.abs()];
            for k in 0..terms.len() {
                sums[k] = sums[k] + terms[k];
            }
        }
        sums.map(V::sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Precision, SolverOptions};
    use crate::grid::{Boundary, Grid};
    use crate::load::{Control, History};
    use crate::march::Simulation;
    use crate::material::{Creep, CreepTerm};
    use crate::time::TimeGrid;

    /// A rough gap that creeps under a load, 120 rows of it.
    fn creep(boundary: Boundary, hardness: f64, precision: Precision) -> March {
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
            solver: SolverOptions { precision, ..SolverOptions::default() },
            ..Simulation::new(grid, gap)
        })
        .unwrap()
    }

    #[test]
    fn a_row_takes_no_convolution_but_those_of_its_steps_and_its_displacement_is_that_of_its_pressure() {
        for (boundary, hardness, precision) in [
            (Boundary::Free, 0.25, Precision::Double),
            (Boundary::Periodic, f64::INFINITY, Precision::Double),
            (Boundary::Free, 0.25, Precision::Mixed),
            (Boundary::Periodic, f64::INFINITY, Precision::Mixed),
        ] {
            let mut march = creep(boundary, hardness, precision);
            let mut fresh = vec![0.0; march.simulation.grid.len()];
            let mut rows = 0;
            while let Some(step) = march.advance().unwrap() {
                let row = step.row();
                rows += usize::from(row.convolutions == row.iterations);
                march.operator.apply_into(&march.state.pressure, &mut fresh);
                let largest = fresh.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
                let off = fresh.iter().zip(&march.state.unit_displacement).map(|(a, b)| (a - b).abs());
                let off = off.fold(0.0, f64::max);
                // A convolution is off by some roundings itself.
                let bound = 4.0 * f64::EPSILON * march.roundings.here;
                assert!(off <= bound * largest, "{} s: {off} {bound}", row.time);
            }
            // Steps in f32 have U found afresh now and then.
            let most = if precision == Precision::Mixed { 90 } else { 110 };
            assert!(rows > most, "{boundary:?}: {rows}");
            assert!(march.roundings.here > 100.0);
        }
    }

    #[test]
    fn no_other_combination_of_the_load_has_less_energy() {
        for (boundary, hardness) in [(Boundary::Free, f64::INFINITY), (Boundary::Periodic, 0.25)] {
            let mut march = creep(boundary, hardness, Precision::Double);
            for _ in 0..12 {
                march.advance().unwrap();
            }
            let (last, before) = (march.state.pressure.clone(), march.previous.pressure.clone());
            let mut instant = march.timeline.propose(&march.simulation).unwrap().unwrap();
            march.begin(&mut instant).unwrap();
            let guess = march.state.pressure.clone();
            let mut energy = |beside: f64| -> f64 {
                let p: Vec<f64> =
                    (0..last.len()).map(|n| guess[n] + beside * (last[n] - before[n])).collect();
                let mut u = vec![0.0; p.len()];
                march.operator.apply_into(&p, &mut u);
                let terms = p.iter().zip(&u).zip(&march.gap);
                terms.map(|((p, u), h)| 0.5 * march.compliance * p * u + h * p).sum()
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
