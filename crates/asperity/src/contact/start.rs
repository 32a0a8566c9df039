//! The pressure that a solve starts from: the caller's guess made feasible, or a cold start; and the
//! rescaling of a pressure to its load.

use asperity_convolution::eights::{Eight, Mask, Work, vectorize};

use super::shift::{Mover, Shift, Trial, clip};
use super::{ContactState, Hardness, Prescribed, Problem};
use crate::error::{Error, Result};
use crate::field::{Set, SetMut, sweep};

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
        let over = sweep((&mut *p, hardness), &|(p, hardness): (&mut [f64], Hardness)| {
            vectorize(Scale { p, factor, hardness })
        });
        if over == 0.0 {
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
