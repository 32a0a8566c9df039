//! A fluid that opens the contact: a wave under a uniform pressure, along a channel, a strip without contact, and a sealed valley.

use std::f64::consts::PI;
use std::sync::Arc;

use ndarray::Array2;

use super::{Check, Checks, along, held, last, number};
use asperity::error::Result;
use asperity::grid::{Boundary, Grid};
use asperity::leakage::{Direction, FlowOptions, Opening, Passages, Sides, liquid};
use asperity::load::{Control, History};
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::time::TimeGrid;
use asperity::traction::{Action, FluidPressure, Pockets, TractionLaw};

/// A contact of unit compliance with this undeformed gap, and a fluid that flows along x.
fn wetted(
    grid: Grid,
    gap: Array2<f64>,
    [inlet, outlet]: [f64; 2],
    control: Control,
    value: f64,
) -> Simulation {
    let fluid = FluidPressure {
        inlet: History::Step { value: inlet },
        outlet,
        reference: 0.0,
        gas: None,
        viscosity: 1.0,
        direction: Direction::X,
        sides: Sides::Periodic,
        smallest_gap: 0.0,
        action: Action::Gaps(Pockets::default()),
        bulk_modulus: None,
    };
    Simulation {
        boundary: Boundary::Periodic,
        loading: held(control, value),
        quantities: Quantities::of(Quantity::of_fluid()),
        traction: Some(Arc::new(fluid)),
        ..Simulation::new(grid, gap)
    }
}

/// A wave (1 - cos 2πy)/π of length 1 across the flow: it closes at the pressure p* = 1.
fn wave_on(cells: [usize; 2], length: f64, pressures: [f64; 2], mean: f64) -> Result<Simulation> {
    let grid = Grid::new(cells, [length, 1.0])?;
    let gap = Array2::from_shape_fn(grid.shape(), |(_, j)| (1.0 - (2.0 * PI * grid.y(j)).cos()) / PI);
    Ok(wetted(grid, gap, pressures, Control::Pressure, mean))
}

/// The last row, its fluid load, and the transmissivity T of its gap.
fn solved(simulation: Simulation) -> Result<(Row, f64, f64)> {
    let grid = simulation.grid;
    let (mut gap, mut touches) = (Array2::zeros(grid.shape()), Array2::zeros(grid.shape()));
    let found = last(simulation, |step| {
        step.gap_into(&mut gap);
        step.contact_into(&mut touches);
        let opening =
            Opening::new(&grid, gap.view(), Some(touches.view()), Direction::X, Sides::Periodic, 0.0)?;
        let flow = liquid(&opening, &Passages::of(&opening), &FlowOptions::default())?;
        Ok((step.row(), number(step, Quantity::FluidLoad), flow.transmissivity))
    })?;
    Ok(found.unwrap_or((Row::default(), f64::NAN, f64::NAN)))
}

pub(super) fn wave() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("fluid-wave", "Westergaard, J. Appl. Mech. 6 (1939) 49, under the mean pressure p - P");
    // p = 0.6, P = 0.4 everywhere: sin²(πa) = 0.2.
    let n = 512;
    let (row, load, t) = solved(wave_on([4, n], 1.0, [0.4; 2], 0.6)?)?;
    // Each edge is known to a cell.
    checks.absolute(
        "contact fraction, difference",
        (row.contact_fraction - 0.2951672353008665).abs(),
        2.0 / n as f64,
    );
    // Cells at the edges take their share of the load and of the gap: 1e-3 of both.
    checks.relative("largest pressure", row.max_pressure, 1.2944271909999159, 1e-3);
    checks.relative("mean gap", row.mean_gap * PI, 0.47811241751317995, 1e-3);
    checks.relative("T", t * PI.powi(3), 0.45002276232803523, 2e-3);
    checks.relative("load on the fluid", load, 0.28193310587965337, 1e-2);
    Ok(checks.list)
}

pub(super) fn channel() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("fluid-channel", "local wave under p - P(x): T = ∫ T(p - P) dP / (P_in - P_out)");
    // Channels eight waves long; the formula is that of a long one, from which this length differs by up to 3 % (p = 0.3) and 6 %.
    for (mean, inlet, t, tolerance) in
        [(0.3, 0.2, 0.49847258590633386, 0.02), (0.6, 0.54, 0.30892760603024844, 0.07)]
    {
        let (_, _, found) = solved(wave_on([64, 64], 8.0, [inlet, 0.0], mean)?)?;
        checks.relative(format!("T at p = {mean}, P_in = {inlet}"), found * PI.powi(3), t, tolerance);
    }
    Ok(checks.list)
}

pub(super) fn strip() -> Result<Vec<Check>> {
    let mut checks = Checks::new("fluid-strip", "second order in ε = c L ΔP/(π² g): T = g³ (1 - π⁴ε²/30)");
    let eps: f64 = 0.02;
    let gap = 1.0 / (PI * PI * eps);
    let grid = Grid::new([256, 4], [1.0, 1.0])?;
    let flat = Array2::from_elem(grid.shape(), gap);
    let (_, load, t) = solved(wetted(grid, flat, [1.0, 0.0], Control::Approach, 0.0))?;
    // The next orders are ε⁴ with about 10, and ε³ with 0.5; cells 1e-5.
    checks.relative("T", t / gap.powi(3), 1.0 - PI.powi(4) / 30.0 * eps * eps, 2e-5);
    const ZETA: f64 = 1.2020569031595942;
    checks.relative("load on the fluid", load, 0.5 + 3.0 * ZETA / (2.0 * PI) * eps, 3e-5);
    Ok(checks.list)
}

pub(super) fn sealed() -> Result<Vec<Check>> {
    let mut checks = Checks::new(
        "fluid-sealed",
        "wave with V = 1 - m + m ln m, m = p0 - p; liquid p = B ln(V0/V), sealed at m = 0.2",
    );
    // The flow across the crests, which close the valley; B = 50, m = 0.6.
    let (n, modulus, mean) = (512, 50.0, 82.19174898459568);
    let base = wave_on([4, n], 1.0, [0.0; 2], mean)?;
    let law = base.traction.as_ref().and_then(|law| law.as_fluid()).cloned();
    let fluid = law.map(|law| FluidPressure {
        direction: Direction::Y,
        action: Action::Gaps(Pockets::Sealed),
        bulk_modulus: Some(modulus),
        ..law
    });
    let simulation = Simulation {
        loading: along(Control::Pressure, &[(0.0, 0.2), (1.0, mean)]),
        times: TimeGrid::Uniform { end: 1.0, steps: 1 },
        traction: fluid.map(|fluid| Arc::new(fluid) as Arc<dyn TractionLaw>),
        ..base
    };
    let found = last(simulation, |step| Ok((step.row(), number(step, Quantity::PocketPressureMax))))?;
    let (row, pressure) = found.unwrap_or_default();
    // The loop ends at 1e-5 of the forces; each edge is known to a cell.
    checks.relative("pressure of the liquid", pressure, 81.59174898459568, 2e-5);
    checks.relative("mean gap", row.mean_gap * PI, 0.09350462574040559, 1e-4);
    checks.absolute(
        "contact fraction, difference",
        (row.contact_fraction - 0.564094216848975).abs(),
        2.0 / n as f64,
    );
    Ok(checks.list)
}
