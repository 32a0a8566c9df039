//! What an iteration moves: the pressure and the gap that it makes, as f64 or as f32.

use asperity_convolution::Visit;
use asperity_convolution::eights::{Cell, Eight, Work, vectorize};
use asperity_convolution::lanes::{Make, Sums};

use super::{ContactState, Hardness, Problem};
use crate::field::{sweep, zeros};
use crate::operator::Operator;

/// Numbers of an iteration: those of its convolution, and those of its fields.
pub trait Scalar: Cell {
    /// Whether what a solve found must be evaluated afresh, in f64, before it is accepted.
    const ROUGH: bool;
    /// Of their rounding.
    const EPSILON: f64;
    /// u = K p of what is made, visited.
    fn apply(
        operator: &mut dyn Operator,
        make: &Make<Self>,
        u: &mut [Self],
        visit: &Visit<Self>,
    ) -> [Sums; 2];
    /// U = K p afresh, in f64; false where it is not kept.
    fn refresh(operator: &mut dyn Operator, p: &[Self], u: &mut [Self]) -> bool;
}

impl Scalar for f64 {
    const ROUGH: bool = false;
    const EPSILON: f64 = f64::EPSILON;
    fn apply(operator: &mut dyn Operator, p: &Make<f64>, u: &mut [f64], visit: &Visit<f64>) -> [Sums; 2] {
        operator.apply_made_into(p, u, visit)
    }
    fn refresh(operator: &mut dyn Operator, p: &[f64], u: &mut [f64]) -> bool {
        operator.apply_into(p, u);
        true
    }
}

/// Mixed precision: convolutions of steps in f32, where a step's error of 1e-7 is that of a small correction.
impl Scalar for f32 {
    const ROUGH: bool = true;
    const EPSILON: f64 = f32::EPSILON as f64;
    fn apply(operator: &mut dyn Operator, p: &Make<f32>, u: &mut [f32], visit: &Visit<f32>) -> [Sums; 2] {
        operator.apply_single_made_into(p, u, visit)
    }
    fn refresh(_: &mut dyn Operator, _: &[f32], _: &mut [f32]) -> bool {
        false
    }
}

/// x as a field holds it.
#[inline(always)]
pub(super) fn as_stored<P: Cell, V: Eight>(x: V) -> V {
    P::widen(P::narrow(x))
}

/// h of eight cells: infinite beyond the end, zero where there is none.
#[inline(always)]
pub(super) fn undeformed<V: Eight>(h: Option<&[f64]>, cell: usize) -> V {
    h.map_or(V::splat(0.0), |h| V::load(h, cell, f64::INFINITY))
}

/// p, and what makes its gap g = c U + h.
pub(super) struct Fields<'a, P> {
    /// p \[Pa\].
    pub pressure: &'a mut [P],
    /// U = K p; or, with c = 1 and no h, the gap itself less an approach, infinite where a cell cannot touch.
    pub displacement: &'a mut [P],
    /// h \[m\].
    pub gap: Option<&'a [f64]>,
    /// c.
    pub compliance: f64,
    /// w \[m\].
    pub approach: &'a mut f64,
}

impl<'a> Fields<'a, f64> {
    pub(super) fn of(problem: &Problem<'a>, state: &'a mut ContactState) -> Self {
        Fields {
            pressure: &mut state.pressure,
            displacement: &mut state.unit_displacement,
            gap: Some(problem.gap),
            compliance: problem.compliance,
            approach: &mut state.approach,
        }
    }
}

/// The fields of a solve in f32: 8 bytes per cell.
pub(super) struct Singles {
    pressure: Vec<f32>,
    gap: Vec<f32>,
    approach: f64,
}

impl Singles {
    pub(super) fn new(cells: usize) -> Self {
        Singles { pressure: zeros(cells), gap: zeros(cells), approach: 0.0 }
    }

    /// The state as f32, the gap less the approach `w`: what rounding leaves of it near contact is small with it.
    pub(super) fn take(&mut self, problem: &Problem, state: &ContactState, w: f64) -> Fields<'_, f32> {
        let (to_p, to_g) = (&mut self.pressure[..], &mut self.gap[..]);
        let (p, u) = (&state.pressure[..], &state.unit_displacement[..]);
        sweep((to_p, to_g, p, u, problem.gap), &|(to_p, to_g, p, u, h): (
            &mut [f32],
            &mut [f32],
            &[f64],
            &[f64],
            &[f64],
        )| {
            vectorize(Take { to_p, to_g, p, u, h, compliance: problem.compliance, w })
        });
        self.approach = 0.0;
        Fields {
            pressure: &mut self.pressure,
            displacement: &mut self.gap,
            gap: None,
            compliance: 1.0,
            approach: &mut self.approach,
        }
    }

    /// The pressure as f64, at H again where it is at H in f32; its sums below H and at H.
    pub(super) fn give(&self, problem: &Problem, state: &mut ContactState) -> [f64; 2] {
        sweep((&mut state.pressure[..], &self.pressure[..], problem.hardness), &|(to, p, hardness): (
            &mut [f64],
            &[f32],
            Hardness,
        )| {
            vectorize(Give { to, p, hardness })
        })
    }
}

struct Take<'a> {
    to_p: &'a mut [f32],
    to_g: &'a mut [f32],
    p: &'a [f64],
    u: &'a [f64],
    h: &'a [f64],
    compliance: f64,
    w: f64,
}

impl Work for Take<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: Eight>(self) {
        let (c, w) = (V::splat(self.compliance), V::splat(self.w));
        for n in (0..self.p.len()).step_by(8) {
            V::load(self.p, n, 0.0).store(self.to_p, n);
            (c * V::load(self.u, n, 0.0) + V::load(self.h, n, 0.0) - w).store(self.to_g, n);
        }
    }
}

struct Give<'a> {
    to: &'a mut [f64],
    p: &'a [f32],
    hardness: Hardness<'a>,
}

impl Work for Give<'_> {
    type Yield = [f64; 2];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 2] {
        let [mut below, mut capped] = [V::splat(0.0); 2];
        for n in (0..self.p.len()).step_by(8) {
            let (p, top): (V, V) = (V::load(self.p, n, 0.0), self.hardness.eight(n));
            let free = p.less(self.hardness.stored::<f32, V>(n));
            V::select(free, p, top).store(self.to, n);
            below = below + p.only(free);
            capped = capped + top.only(!free);
        }
        [below.sum(), capped.sum()]
    }
}
