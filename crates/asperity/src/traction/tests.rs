//! The seam, proved with a linear spring between flat surfaces: b = -k g, on a layer that a uniform pressure p displaces by
//! u = κ ∫ C(t - s) dp(s).

use crate::drive::Drive;
use std::sync::Arc;

use ndarray::Array2;

use super::{SurfaceTraction, TractionLaw};
use crate::drive::March;
use crate::error::Result;
use crate::kernel::Kernel;
use crate::layer::{Base, Interface, Layer, Layered, Stack};
use crate::load::{Control, History, Loading};
use crate::material::{Creep, CreepTerm};
use crate::simulation::Simulation;
use crate::time::TimeGrid;
use crate::{Boundary, Grid, SolverOptions};

/// k \[Pa/m\].
const STIFFNESS: f64 = 3.0;
const GAP: f64 = 0.2;

#[derive(Debug)]
struct Spring;

impl TractionLaw for Spring {
    fn start(&self, _grid: &Grid) -> Box<dyn SurfaceTraction> {
        Box::new(Spring)
    }
}

impl SurfaceTraction for Spring {
    fn bound(&mut self, gap: &[f64], _contact: &[f64], out: &mut [f64]) -> Result<()> {
        out.iter_mut().zip(gap).for_each(|(b, g)| *b = -STIFFNESS * g);
        Ok(())
    }

    fn energy(&self, gap: &[f64]) -> Option<f64> {
        Some(gap.iter().map(|g| 0.5 * STIFFNESS * g * g).sum())
    }
}

fn creep() -> Creep {
    let terms = vec![CreepTerm { compliance: 1.0, retardation_time: 2.0 }];
    Creep { instantaneous: 0.5, terms, fluidity: 0.0 }
}

fn kernel() -> Layered {
    let layer = Layer { thickness: 1.0, shear: 1.0, poisson: 0.2, interface: Interface::Bonded };
    Layered::new(vec![Stack::new(vec![layer], Base::Rigid).unwrap()]).unwrap()
}

/// κ \[m\].
fn uniform() -> f64 {
    kernel().uniform().unwrap()
}

fn simulation(control: Control, value: f64) -> Simulation {
    let grid = Grid::new([8, 8], [2.0, 2.0]).unwrap();
    Simulation {
        boundary: Boundary::Periodic,
        kernel: Arc::new(kernel()),
        creep: creep(),
        loading: Loading { control, history: History::Step { value } }.into(),
        times: TimeGrid::Uniform { end: 4.0, steps: 200 },
        solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
        traction: Some(Arc::new(Spring)),
        ..Simulation::new(grid, Array2::from_elem(grid.shape(), GAP))
    }
}

/// Time, approach, mean pressure and mean gap of each row.
fn rows(simulation: Simulation) -> Vec<[f64; 4]> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        let row = step.row();
        rows.push([row.time(), row.approach, row.mean_pressure, row.mean_gap]);
    }
    rows
}

#[test]
fn a_spring_pulls_surfaces_held_apart_together_as_they_creep() {
    // g = h0 - w + κ ∫ C(t - s) dp(s) with p = -k g relaxes from (h0 - w)/(1 + a0) to (h0 - w)/(1 + a0 + a1), a = k κ c, at the rate
    // (1 + a0 + a1)/((1 + a0) λ).
    let w = -0.1;
    let creep = creep();
    let a0 = STIFFNESS * uniform() * creep.instantaneous;
    let a1 = STIFFNESS * uniform() * creep.terms[0].compliance;
    let [first, last] = [a0, a0 + a1].map(|a| (GAP - w) / (1.0 + a));
    let rate = (1.0 + a0 + a1) / (1.0 + a0) / creep.terms[0].retardation_time;
    for [t, approach, pressure, gap] in rows(simulation(Control::Approach, w)) {
        let exact = last + (first - last) * (-rate * t).exp();
        // The steps of 0.02 are of second order: 1e-4 of the change.
        assert!((gap / exact - 1.0).abs() < 1e-4, "{t}: {gap} {exact}");
        assert!((pressure / (-STIFFNESS * gap) - 1.0).abs() < 1e-7 && approach == w);
    }
}

#[test]
fn under_a_pull_the_surfaces_part_until_the_spring_holds_it() {
    // p = -k g is held, so g is too, and the approach creeps: w = h0 - g + κ C(t) p.
    let pull = -0.3;
    for [t, approach, pressure, gap] in rows(simulation(Control::Pressure, pull)) {
        assert!((pressure / pull - 1.0).abs() < 1e-7, "{t}: {pressure}");
        assert!((gap / (-pull / STIFFNESS) - 1.0).abs() < 1e-6, "{t}: {gap}");
        let exact = GAP - gap + uniform() * creep().value(t) * pull;
        assert!((approach - exact).abs() < 1e-6 * GAP, "{t}: {approach} {exact}");
    }
}

#[test]
fn a_load_of_nothing_does_not_part_surfaces_that_pull_at_each_other() {
    for [t, approach, pressure, gap] in rows(simulation(Control::Load, 0.0)) {
        // The spring closes the gap and is at rest there.
        assert!(pressure.abs() < 1e-7 && gap.abs() < 1e-7 && (approach - GAP).abs() < 1e-7, "{t}: {gap}");
    }
}

#[test]
fn closed_surfaces_are_in_contact_as_without_a_spring() {
    for control in [Control::Pressure, Control::Approach] {
        let value = if control == Control::Approach { GAP + 0.05 } else { 0.04 };
        let with = rows(simulation(control, value));
        let without = rows(Simulation { traction: None, ..simulation(control, value) });
        for (a, b) in with.iter().zip(&without) {
            let off = |n: usize| (a[n] - b[n]).abs();
            assert!(off(1) < 1e-7 * GAP && off(2) < 1e-7 && off(3) < 1e-7, "{a:?} {b:?}");
        }
    }
}
