//! The pressure that a solve starts from: the caller's guess made feasible, a cold start, or a pressure whose displacement
//! is known; and the rescaling of a pressure to its load.

use asperity_convolution::eights::{Eight, Mask, Work, vectorize};

use super::roundings::Roundings;
use super::shift::{Mover, Shift, Trial, clip};
use super::{ContactState, Hardness, Prescribed, Problem};
use crate::error::{Error, Result};
use crate::field::{Set, SetMut, sweep};

/// What a solve starts from besides `state.pressure`.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Start {
    /// Nothing: the pressure is made feasible, and its U found by a convolution.
    Guess,
    /// U = K p too, as linearity makes it from solutions. The pressure may lie `beyond` its bounds: the step of the first
    /// iteration leads it back.
    Known { roundings: Roundings, beyond: bool, gap: Option<FreeGap> },
}

/// Of the cells between the bounds the mean of g = c U + h, and of |g|, which is not zero \[m\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct FreeGap {
    pub mean: f64,
    pub size: f64,
}

/// A load is met when the sum of p misses it by this share.
pub(crate) const MET: f64 = 1e-12;

/// Makes `state.pressure` feasible: zero where nothing can touch, within \[0, H\], with the load W.
///
/// `touchable` comes back as the set of cells that can touch.
pub(super) fn make_feasible(
    problem: &Problem,
    cell_area: f64,
    state: &mut ContactState,
    touchable: &mut [u8],
) -> Result<()> {
    let hardness = problem.hardness;
    let [sum, cells] = sweep(
        (&mut state.pressure[..], problem.gap, SetMut(touchable), hardness),
        &|(p, h, SetMut(set), hardness): (&mut [f64], &[f64], SetMut, Hardness)| {
            vectorize(Clip { p, h, set, hardness })
        },
    );
    let Prescribed::Load(load) = problem.prescribed else {
        return Ok(());
    };
    let target = load / cell_area;
    if sum <= 0.0 {
        let uniform = target / cells;
        for (p, set) in state.pressure.chunks_mut(8).zip(&*touchable) {
            p.iter_mut().enumerate().for_each(|(i, p)| *p = uniform * f64::from(*set >> i & 1));
        }
        if matches!(hardness, Hardness::Uniform(_)) {
            return Ok(());
        }
        // Soft cells carry less.
        state.pressure.iter_mut().enumerate().for_each(|(n, p)| *p = clip(*p, hardness.at(n)));
    }
    set_load(&mut state.pressure, touchable, hardness, target)
        .ok_or_else(|| Error::Infeasible { load, max: problem.limits().2 * cell_area })
}

/// Scales the cells below H, up to H; how many would have gone beyond.
fn scale(p: &mut [f64], factor: f64, hardness: Hardness) -> f64 {
    sweep((p, hardness), &|(p, hardness): (&mut [f64], Hardness)| vectorize(Scale { p, factor, hardness }))
}

/// Gives a pressure within \[0, H\] the sum `target`: by scaling the cells below H, which keeps open
/// cells open; where those cannot carry it, by a shift of all cells of `set`.
pub(super) fn set_load(p: &mut [f64], set: &[u8], hardness: Hardness, target: f64) -> Option<()> {
    for _ in 0..50 {
        let [below, capped] = sweep((&*p, hardness), &|(p, hardness): (&[f64], Hardness)| {
            vectorize(BelowAndCapped { p, hardness })
        });
        let rest = target - capped;
        if below <= 0.0 || rest <= 0.0 {
            break;
        }
        let factor = rest / below;
        if scale(p, factor, hardness) == 0.0 {
            return Some(());
        }
    }
    let trial = Trial { pressure: p, direction: None, set, length: 0.0, hardness };
    let shift = trial.shift_to_sum(target, None)?;
    sweep((p, Set(set), hardness), &|(p, Set(set), hardness): (&mut [f64], Set, Hardness)| {
        vectorize(Move { p, set, shift, hardness });
    });
    Some(())
}

/// p clipped, and zero where nothing can touch: the sum and the number of cells that can.
struct Clip<'a> {
    p: &'a mut [f64],
    h: &'a [f64],
    set: &'a mut [u8],
    hardness: Hardness<'a>,
}

impl Work for Clip<'_> {
    type Yield = [f64; 2];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 2] {
        let (mut sum, mut cells) = (V::splat(0.0), V::splat(0.0));
        for (n, set) in (0..).step_by(8).zip(self.set) {
            let can_touch = V::load(self.h, n, f64::INFINITY).less(V::splat(f64::INFINITY));
            let p = V::load(self.p, n, 0.0).clip(self.hardness.eight(n)).only(can_touch);
            p.store(self.p, n);
            *set = can_touch.bits();
            sum = sum + p;
            cells = cells + V::count(can_touch);
        }
        [sum.sum(), cells.sum()]
    }
}

/// The sums below H and at it.
struct BelowAndCapped<'a> {
    p: &'a [f64],
    hardness: Hardness<'a>,
}

impl Work for BelowAndCapped<'_> {
    type Yield = [f64; 2];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 2] {
        let (mut sum, mut capped) = (V::splat(0.0), V::splat(0.0));
        for n in (0..self.p.len()).step_by(8) {
            let p = V::load(self.p, n, 0.0);
            let below = p.less(self.hardness.eight(n));
            sum = sum + p.only(below);
            capped = capped + p.only(!below);
        }
        [sum.sum(), capped.sum()]
    }
}

/// Cells below H scaled, up to H; yields how many would have gone beyond.
struct Scale<'a> {
    p: &'a mut [f64],
    factor: f64,
    hardness: Hardness<'a>,
}

impl Work for Scale<'_> {
    type Yield = f64;

    #[inline(always)]
    fn run<V: Eight>(self) -> f64 {
        let mut over = V::splat(0.0);
        for n in (0..self.p.len()).step_by(8) {
            let p = V::load(self.p, n, 0.0);
            let hardness = self.hardness.eight(n);
            let scaled = V::select(p.less(hardness), p * V::splat(self.factor), p);
            scaled.smaller(hardness).store(self.p, n);
            over = over + V::count(hardness.less(scaled));
        }
        over.sum()
    }
}

/// The cells of a set shifted, the others zero.
struct Move<'a> {
    p: &'a mut [f64],
    set: &'a [u8],
    shift: Shift,
    hardness: Hardness<'a>,
}

impl Work for Move<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: Eight>(self) {
        let mover = Mover::<V>::new(0.0, self.shift);
        for (n, set) in (0..).step_by(8).zip(self.set) {
            let p = mover.target(V::load(self.p, n, 0.0), V::splat(0.0), self.hardness.eight(n));
            p.only(V::Mask::from_bits(*set)).store(self.p, n);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Method, Outcome, Precision, Solver, SolverOptions};
    use crate::grid::{Boundary, Grid};
    use crate::operator::half_space;

    const H: f64 = 0.15;

    fn gap(grid: &Grid) -> Vec<f64> {
        let ny = grid.cells()[1];
        let height = |n: usize| {
            let (x, y) = (grid.x(n / ny) - 0.5, grid.y(n % ny) - 0.5);
            0.5 * (x * x + y * y) + 3e-3 * (1.0 - (41.0 * x).cos() * (37.0 * y + 0.7).cos())
        };
        (0..grid.len()).map(height).collect()
    }

    /// Two solutions on the way to `prescribed`, prolonged to it: p and U.
    fn prolonged(grid: &Grid, gap: &[f64], of: impl Fn(f64) -> Prescribed) -> ContactState {
        let mut operator = half_space(*grid, Boundary::Free);
        let mut solver = Solver::new(Method::ProjectedCg, &*operator);
        let mut at = |x: f64| {
            let problem = Problem { gap, compliance: 1.0, hardness: H.into(), prescribed: of(x) };
            let mut state = ContactState::new(grid.len());
            solver.solve(&mut *operator, &problem, &SolverOptions::default(), &mut state, None).unwrap();
            state
        };
        let (before, mut state) = (at(1.1), at(1.0));
        let along = |x: &mut [f64], before: &[f64]| x.iter_mut().zip(before).for_each(|(x, b)| *x += *x - b);
        along(&mut state.pressure, &before.pressure);
        along(&mut state.unit_displacement, &before.unit_displacement);
        state
    }

    #[test]
    fn a_known_start_leads_to_the_same_contact_from_beyond_its_bounds() {
        let grid = Grid::new([48, 40], [1.0, 1.0]).unwrap();
        let gap = gap(&grid);
        let programmes: [fn(f64) -> Prescribed; 2] =
            [|x| Prescribed::Load(0.03 * x), |x| Prescribed::Approach(0.04 * x)];
        for of in programmes {
            for precision in [Precision::Double, Precision::Mixed] {
                let start = prolonged(&grid, &gap, of);
                let beyond = start.pressure.iter().filter(|p| !(0.0..=H).contains(*p)).count();
                assert!(beyond > 3, "{beyond}");
                let problem = Problem { gap: &gap, compliance: 1.0, hardness: H.into(), prescribed: of(0.9) };
                let options = SolverOptions { precision, ..SolverOptions::default() };
                let mut operator = half_space(grid, Boundary::Free);
                let mut solve = |from: Start| -> (ContactState, Outcome) {
                    let mut solver = Solver::with_precision(Method::ProjectedCg, precision, &*operator);
                    let mut state = start.clone();
                    let outcome = solver
                        .solve_from(from, &mut *operator, &problem, &options, &mut state, None)
                        .unwrap();
                    (state, outcome)
                };
                let (guessed, slow) = solve(Start::Guess);
                let (known, fast) =
                    solve(Start::Known { roundings: Roundings::of_convolution(), beyond: true, gap: None });
                assert!(known.pressure.iter().all(|p| (0.0..=H).contains(p)));
                // Of U, only what steps in f32 leave in it may be found afresh.
                let afresh = usize::from(precision == Precision::Mixed);
                assert!((0..=afresh).contains(&(fast.convolutions - fast.iterations)), "{fast:?}");
                assert!((1..=1 + afresh).contains(&(slow.convolutions - slow.iterations)), "{slow:?}");
                if let Prescribed::Load(load) = problem.prescribed {
                    let found = known.pressure.iter().sum::<f64>() * grid.cell_area();
                    assert!((found / load - 1.0).abs() < 1e-12, "{found} {load}");
                }
                // Each is within its own certificate of the solution.
                let apart = known.apart(&guessed);
                assert!(apart <= fast.certificate + slow.certificate, "{apart}");
            }
        }
    }
}
