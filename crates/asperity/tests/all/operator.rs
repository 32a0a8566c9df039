//! Operators of bodies that are no half-spaces: the solver, its preconditioner and its start from coarser grids stand on the
//! kernel alone.

use std::f64::consts::TAU;
use std::sync::Arc;

use asperity::convolution::OnRustfft;
use asperity::kernel::{HalfSpace, Kernel};
use asperity::operator::{Backend, ConvolutionPlan, InversePlan, plan, plan_on};
use asperity::{Boundary, ContactState, Grid, Method, Prescribed, Problem, Result, Solver, SolverOptions};
use ndarray::{Array2, ArrayView2};

/// A body whose response to long waves is bounded, as that of a layer on a rigid base: (2/|q|) tanh(|q| t), 2 t for a uniform
/// pressure. Periodic domains only.
#[derive(Debug)]
struct Bounded {
    thickness: f64,
}

impl Kernel for Bounded {
    fn influence(&self, _: [f64; 2], _: [usize; 2]) -> Result<Array2<f64>> {
        unreachable!("periodic domains take the symbol")
    }

    fn symbol(&self, qx: f64, qy: f64) -> f64 {
        let q = qx.hypot(qy);
        2.0 / q * (q * self.thickness).tanh()
    }

    fn uniform(&self) -> Option<f64> {
        Some(2.0 * self.thickness)
    }
}

/// A half-space under a bed of independent springs: every cell yields by `spring` more under its own pressure.
#[derive(Debug)]
struct OnSprings {
    spring: f64,
}

impl Kernel for OnSprings {
    fn influence(&self, cell: [f64; 2], count: [usize; 2]) -> Result<Array2<f64>> {
        let mut influence = HalfSpace.influence(cell, count)?;
        influence[(0, 0)] += self.spring;
        Ok(influence)
    }

    fn symbol(&self, qx: f64, qy: f64) -> f64 {
        HalfSpace.symbol(qx, qy) + self.spring
    }
}

fn solve(
    grid: Grid,
    boundary: Boundary,
    kernel: Arc<dyn Kernel>,
    gap: &[f64],
    prescribed: Prescribed,
) -> ContactState {
    let mut operator = plan(grid, boundary, kernel).unwrap();
    let mut solver = Solver::new(Method::ProjectedCg, &*operator);
    let mut state = ContactState::new(grid.len());
    let problem = Problem { gap, compliance: 0.5, hardness: f64::INFINITY.into(), prescribed };
    let options = SolverOptions { tolerance: 1e-11, ..SolverOptions::default() };
    let outcome = solver.solve(&mut *operator, &problem, &options, &mut state, None).unwrap();
    // The preconditioner is that of this kernel: a wrong one takes hundreds.
    assert!(outcome.convolutions < 40, "{outcome:?}");
    state
}

#[test]
fn full_contact_under_an_approach_is_determined_where_a_uniform_pressure_has_a_displacement() {
    let (amplitude, thickness, approach) = (0.01, 0.1, 0.1);
    // 256 cells start from coarser grids, of the same body.
    for n in [24, 256] {
        let grid = Grid::new([n, n], [1.0, 1.0]).unwrap();
        let wave = |k: usize| (TAU * grid.x(k / n)).cos();
        let gap: Vec<f64> = (0..n * n).map(|k| amplitude * (1.0 + wave(k))).collect();
        let state = solve(
            grid,
            Boundary::Periodic,
            Arc::new(Bounded { thickness }),
            &gap,
            Prescribed::Approach(approach),
        );
        // c K p = w - h, wave by wave.
        let symbol = Bounded { thickness }.symbol(TAU, 0.0);
        let mean = (approach - amplitude) / (0.5 * 2.0 * thickness);
        for (k, p) in state.pressure.iter().enumerate() {
            let exact = mean - amplitude * wave(k) / (0.5 * symbol);
            // The tolerance of the solve, times the condition of the shortest wave, n/4.
            assert!((p - exact).abs() < 1e-8 * mean, "{n} {k}: {p} {exact}");
        }
    }
}

#[test]
fn soft_springs_under_a_half_space_take_the_whole_overlap() {
    // Springs 1e9 times softer than the half-space: p = (w - h)/(c spring) where that is positive.
    let grid = Grid::new([40, 32], [1.0, 1.0]).unwrap();
    let gap: Vec<f64> = (0..grid.len())
        .map(|k| {
            let (x, y) = (grid.x(k / 32) - 0.5, grid.y(k % 32) - 0.5);
            0.5 * (x * x + y * y)
        })
        .collect();
    let (spring, approach) = (1e9, 0.03);
    let state =
        solve(grid, Boundary::Free, Arc::new(OnSprings { spring }), &gap, Prescribed::Approach(approach));
    for (p, h) in state.pressure.iter().zip(&gap) {
        let exact = (approach - h).max(0.0) / (0.5 * spring);
        // A displacement of the half-space is 1e-9 of that of the springs.
        assert!((p - exact).abs() <= 1e-8 * approach / spring, "{p} {exact}");
    }
}

/// A second back end, in double precision on rustfft and as the definitions say it; D is 1.
#[derive(Debug)]
struct Reference;

impl Backend for Reference {
    fn plan(
        &self,
        cells: [usize; 2],
        lengths: [usize; 2],
        spectrum: ArrayView2<f64>,
    ) -> Box<dyn ConvolutionPlan> {
        Box::new(ReferencePlan(OnRustfft::new(cells, lengths, spectrum)))
    }

    fn bytes(&self, _: [usize; 2], _: [usize; 2]) -> usize {
        0
    }

    fn plan_inverse(
        &self,
        cells: [usize; 2],
        lengths: [usize; 2],
        inverse: Array2<f64>,
        screened: Array2<f64>,
    ) -> Box<dyn InversePlan> {
        let plan = |spectrum: Array2<f64>| OnRustfft::new(cells, lengths, spectrum.view());
        Box::new(ReferenceInverse { inverse: plan(inverse), screened: plan(screened) })
    }

    fn inverse_bytes(&self, _: [usize; 2], _: [usize; 2]) -> usize {
        0
    }
}

struct ReferencePlan(OnRustfft);

impl ConvolutionPlan for ReferencePlan {
    fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        self.0.apply_into(p, u);
    }

    fn apply_in_place(&mut self, x: &mut [f64]) {
        let p = x.to_vec();
        self.0.apply_into(&p, x);
    }
}

struct ReferenceInverse {
    inverse: OnRustfft,
    screened: OnRustfft,
}

fn times(plan: &mut OnRustfft, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    plan.apply_into(x, &mut y);
    y
}

impl InversePlan for ReferenceInverse {
    fn apply_into(&mut self, r: &[f32], z: &mut [f32]) {
        let r: Vec<f64> = r.iter().map(|r| f64::from(*r)).collect();
        z.iter_mut().zip(times(&mut self.inverse, &r)).for_each(|(to, z)| *to = z as f32);
    }

    fn apply_on_set_into(&mut self, r: &[f32], set: &[u8], z: &mut [f32]) {
        let ReferenceInverse { inverse, screened } = self;
        let open = |x: &[f64]| -> Vec<f64> {
            x.iter().enumerate().map(|(n, x)| if set[n / 8] >> (n % 8) & 1 == 1 { 0.0 } else { *x }).collect()
        };
        let dot = |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
        let r: Vec<f64> = r.iter().map(|r| f64::from(*r)).collect();
        let mr = times(inverse, &r);
        let b = open(&mr);
        let y = open(&times(screened, &b));
        let my = times(inverse, &y);
        let a = if dot(&b, &y) > 0.0 { dot(&b, &y) / dot(&y, &my) } else { 0.0 };
        z.iter_mut().zip(mr.iter().zip(&my)).for_each(|(z, (mr, my))| *z = (mr - a * my) as f32);
    }
}

#[test]
fn another_back_end_finds_the_same_contact() {
    // 128 cells start from coarser grids, on the same back end.
    for (cells, boundary) in [([128, 128], Boundary::Free), ([60, 50], Boundary::Periodic)] {
        let grid = Grid::new(cells, [1.0, 1.0]).unwrap();
        let gap: Vec<f64> = (0..grid.len())
            .map(|k| {
                let (x, y) = (TAU * grid.x(k / cells[1]), TAU * grid.y(k % cells[1]));
                0.01 * (2.0 - x.cos() - y.cos()) + 1e-3 * (1.0 - (7.0 * x).cos() * (9.0 * y).cos())
            })
            .collect();
        let problem = Problem {
            gap: &gap,
            compliance: 1.0,
            hardness: f64::INFINITY.into(),
            prescribed: Prescribed::Load(5e-3),
        };
        let options = SolverOptions { tolerance: 1e-9, ..SolverOptions::default() };
        let [(own, p), (other, q)] = [
            plan(grid, boundary, Arc::new(HalfSpace)),
            plan_on(Arc::new(Reference), grid, boundary, Arc::new(HalfSpace)),
        ]
        .map(|operator| {
            let mut operator = operator.unwrap();
            let mut state = ContactState::new(grid.len());
            let mut solver = Solver::new(Method::ProjectedCg, &*operator);
            (solver.solve(&mut *operator, &problem, &options, &mut state, None).unwrap(), state.pressure)
        });
        assert!(own.iterations.abs_diff(other.iterations) <= 5, "{own:?} {other:?}");
        let peak = p.iter().fold(0.0, |m: f64, p| m.max(*p));
        for (p, q) in p.iter().zip(&q) {
            // The tolerance of both solves, times the condition of the shortest wave.
            assert!((p - q).abs() < 1e-6 * peak, "{boundary:?}: {p} {q}");
        }
    }
}
