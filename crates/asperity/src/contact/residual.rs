//! How far a pressure is from the solution: the approach that fits it best, the violation of the
//! contact conditions, and the certificate.
//!
//! With r = g - w, g = cU + h, any feasible p satisfies (subtract the two variational inequalities)
//! |p - p*|_K^2 <= Gamma = sum [ p r+ + (H - p) r- ], for any w where the load is given. Without a cut-off
//! w is taken as the least g, so that r >= 0 and Gamma = sum p (g - min g). Under approach control w is given; the
//! sum of p* that then multiplies the largest r- is replaced by that of p.
//!
//! All of it comes from one sweep, taken with a guess of w: the mean of r over the free cells mends the guess.

use asperity_convolution::eights::{Eight, Mask, Work, vectorize};

use super::{ContactState, Hardness, Outcome, Prescribed, Problem};
use crate::field::{Max, Merge, Min, sweep};
use crate::grid::Grid;

/// What one sweep over p, U, h finds, with r = g - w for the guess w.
#[derive(Clone, Copy)]
pub(super) struct Rating {
    /// The guess w \[m\].
    pub w: f64,
    sums: Sums,
    /// Largest r where p = H.
    capped: Max,
    /// Least r where p = 0.
    empty: Min,
    /// Least r where p > 0, without a cut-off.
    touching: Min,
    /// Largest p.
    peak: Max,
    /// Largest violation of the contact conditions \[m\].
    largest: Max,
}

#[derive(Clone, Copy)]
struct Sums {
    /// sum of r, and number of cells, over D = {0 < p < H}.
    free: [f64; 2],
    /// sum of r, and number of cells, over S = D + {p = 0, r < 0} + {p = H, r > 0}.
    working: [f64; 2],
    /// sum p, sum p U.
    pressure: [f64; 2],
    /// Gamma for this w; without a cut-off sum p r.
    gamma: f64,
}

impl Merge for Rating {
    fn merge(self, next: Self) -> Self {
        let sums = Sums {
            free: self.sums.free.merge(next.sums.free),
            working: self.sums.working.merge(next.sums.working),
            pressure: self.sums.pressure.merge(next.sums.pressure),
            gamma: self.sums.gamma + next.sums.gamma,
        };
        Rating {
            w: self.w,
            sums,
            capped: self.capped.merge(next.capped),
            empty: self.empty.merge(next.empty),
            touching: self.touching.merge(next.touching),
            peak: self.peak.merge(next.peak),
            largest: self.largest.merge(next.largest),
        }
    }
}

/// The rating of a sweep on its way, one strand for each of eight cells.
pub(super) struct Gauge<V> {
    compliance: V,
    w: V,
    guess: f64,
    free: [V; 2],
    working: [V; 2],
    pressure: [V; 2],
    gamma: V,
    cut_off: bool,
    capped: V,
    empty: V,
    touching: V,
    peak: V,
    largest: V,
}

impl<V: Eight> Gauge<V> {
    /// Of a problem with that compliance, `cut_off` where the hardness is finite, and for a guess of w.
    #[inline(always)]
    pub(super) fn new(compliance: f64, w: f64, cut_off: bool) -> Self {
        let [zero, up, down] = [0.0, f64::INFINITY, f64::NEG_INFINITY].map(V::splat);
        Gauge {
            compliance: V::splat(compliance),
            w: V::splat(w),
            guess: w,
            free: [zero; 2],
            working: [zero; 2],
            pressure: [zero; 2],
            gamma: zero,
            cut_off,
            capped: down,
            empty: up,
            touching: up,
            peak: down,
            largest: zero,
        }
    }

    /// Takes in eight cells where they are all apart: p = 0 and r >= 0. Else returns false.
    #[inline(always)]
    pub(super) fn pass(&mut self, p: V, u: V, h: V) -> bool {
        let zero = V::splat(0.0);
        let r = self.compliance * u + h - self.w;
        let apart = (zero.less(p) | r.less(zero)).bits() == 0;
        if apart {
            self.empty = r.smaller(self.empty);
        }
        apart
    }

    /// Takes in eight cells, the last their H; returns r and S.
    #[inline(always)]
    pub(super) fn meet(&mut self, p: V, u: V, h: V, hardness: V) -> (V, V::Mask) {
        let zero = V::splat(0.0);
        let r = self.compliance * u + h - self.w;
        let touches = zero.less(p);
        let below = p.less(hardness);
        let free = touches & below;
        // |r| counts unless the cell sits at the bound that r presses it against.
        let works = free | (!touches & r.less(zero)) | (!below & zero.less(r));
        let violation = r.abs().only(works);
        self.free = [self.free[0] + r.only(free), self.free[1] + V::count(free)];
        self.working = [self.working[0] + r.only(works), self.working[1] + V::count(works)];
        let [up, down] = [f64::INFINITY, f64::NEG_INFINITY].map(V::splat);
        self.capped = V::select(below, down, r).larger(self.capped);
        self.empty = V::select(touches, up, r).smaller(self.empty);
        self.largest = violation.larger(self.largest);
        self.pressure[0] = self.pressure[0] + p;
        self.pressure[1] = self.pressure[1] + (p * u).only(touches);
        self.gamma = if self.cut_off {
            let distance = V::select(zero.less(r), p, hardness - p);
            self.gamma + (distance * violation).only(works)
        } else {
            self.touching = V::select(touches, r, up).smaller(self.touching);
            self.gamma + (p * r).only(touches)
        };
        self.peak = p.larger(self.peak);
        (r, works)
    }

    #[inline(always)]
    pub(super) fn rating(self) -> Rating {
        Rating {
            w: self.guess,
            sums: Sums {
                free: self.free.map(V::sum),
                working: self.working.map(V::sum),
                pressure: self.pressure.map(V::sum),
                gamma: self.gamma.sum(),
            },
            capped: Max(self.capped.largest()),
            empty: Min(self.empty.least()),
            touching: Min(self.touching.least()),
            peak: Max(self.peak.largest()),
            largest: Max(self.largest.largest()),
        }
    }
}

impl Rating {
    /// Rates a state with a guess of w.
    pub(super) fn of(problem: &Problem, state: &ContactState, w: f64) -> Self {
        let (compliance, cut_off) = (problem.compliance, !problem.hardness.is_infinite());
        let (p, u) = (&state.pressure[..], &state.unit_displacement[..]);
        sweep((p, u, problem.gap, problem.hardness), &|(p, u, h, hardness): (
            &[f64],
            &[f64],
            &[f64],
            Hardness,
        )| {
            vectorize(Rate { compliance, cut_off, w, p, u, h, hardness })
        })
    }

    /// The approach: given, or the mean of g over D; where D is empty, the middle of what the cells
    /// at the bounds allow.
    pub(super) fn approach(&self, prescribed: Prescribed) -> f64 {
        let (above, below) = (self.capped.0, self.empty.0);
        match prescribed {
            Prescribed::Approach(w) => w,
            Prescribed::Load(_) if !self.no_cell_is_free() => self.w + self.sums.free[0] / self.sums.free[1],
            Prescribed::Load(_) if below == f64::INFINITY => self.w + above,
            Prescribed::Load(_) if above == f64::NEG_INFINITY => self.w + below,
            Prescribed::Load(_) => self.w + 0.5 * (above + below),
        }
    }

    /// True where D = {0 < p < H} is empty.
    pub(super) fn no_cell_is_free(&self) -> bool {
        self.sums.free[1] == 0.0
    }

    /// Mean of r over the working set S; 0 where S is empty.
    pub(super) fn working_mean(&self) -> f64 {
        if self.nothing_works() { 0.0 } else { self.sums.working[0] / self.sums.working[1] }
    }

    /// Cells in S.
    pub(super) fn working_cells(&self) -> f64 {
        self.sums.working[1]
    }

    /// True where no cell may change.
    pub(super) fn nothing_works(&self) -> bool {
        self.sums.working[1] == 0.0
    }

    /// Largest violation of the contact conditions with the guess of w \[m\].
    pub(super) fn violation(&self) -> f64 {
        self.largest.0
    }

    /// sum p \[Pa\]
    pub(super) fn pressure(&self) -> f64 {
        self.sums.pressure[0]
    }

    /// The displacement that violations are measured by: (p'u)/(sum p), or the overlap before first contact.
    pub(super) fn displacement(&self, problem: &Problem) -> f64 {
        let [pressure, pu] = self.sums.pressure;
        if pressure > 0.0 { (problem.compliance * pu / pressure).max(0.0) } else { self.empty.0.abs() }
    }

    /// What rounding alone makes of g: a violation below it means nothing.
    fn rounding(&self, problem: &Problem, grid: &Grid) -> f64 {
        let [lx, ly] = grid.size();
        let peak = self.peak.0.max(0.0);
        16.0 * f64::EPSILON * (self.w.abs() + problem.compliance * peak * lx.max(ly))
    }

    /// The largest violation of the contact conditions over what violations are measured by, so that one of rounding is none
    /// for that tolerance; and the certificate.
    ///
    /// With the approach that the cells themselves give a violation is at most that with the guess and how far they lie apart.
    pub(super) fn rate(&self, problem: &Problem, grid: &Grid, tolerance: f64) -> Outcome {
        let scale = self.displacement(problem) + self.rounding(problem, grid) / tolerance;
        let apart = (self.approach(problem.prescribed) - self.w).abs();
        let violation = if self.largest.0 > 0.0 { self.largest.0 + apart } else { 0.0 };
        let residual = if violation > 0.0 { violation / scale } else { 0.0 };
        Outcome { residual, certificate: self.certificate(problem), ..Outcome::default() }
    }

    /// The bound of the error in energy.
    fn certificate(&self, problem: &Problem) -> f64 {
        let [pressure, pu] = self.sums.pressure;
        let gamma = if !problem.hardness.is_infinite() {
            self.sums.gamma
        } else {
            let pr = self.sums.gamma;
            let least = self.empty.0.min(self.touching.0);
            match problem.prescribed {
                Prescribed::Load(_) => pr - least * pressure,
                Prescribed::Approach(_) => {
                    let rise = 2.0 * (-least).max(0.0) + least.max(0.0);
                    (pr - least * pressure) + pressure * rise
                }
            }
        };
        let energy = problem.compliance * pu;
        if gamma > 0.0 && energy > 0.0 { (gamma / energy).sqrt() } else { 0.0 }
    }
}

struct Rate<'a> {
    compliance: f64,
    cut_off: bool,
    w: f64,
    p: &'a [f64],
    u: &'a [f64],
    h: &'a [f64],
    hardness: Hardness<'a>,
}

impl Work for Rate<'_> {
    type Yield = Rating;

    #[inline(always)]
    fn run<V: Eight>(self) -> Rating {
        let mut gauge = Gauge::<V>::new(self.compliance, self.w, self.cut_off);
        for n in (0..self.p.len()).step_by(8) {
            let h = V::load(self.h, n, f64::INFINITY);
            gauge.meet(V::load(self.p, n, 0.0), V::load(self.u, n, 0.0), h, self.hardness.eight(n));
        }
        gauge.rating()
    }
}
