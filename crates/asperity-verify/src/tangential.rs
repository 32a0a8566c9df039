//! Tangential loads: Cattaneo and Mindlin's sphere, the difference of two normal contacts, a glued punch that creeps.

use std::f64::consts::PI;
use std::sync::Arc;

use ndarray::Array2;

use super::{Check, Checks, first, held, shape_on, step_load, with_one_time};
use asperity::contact::SolverOptions;
use asperity::drive::{Drive, March};
use asperity::error::Result;
use asperity::grid::{Boundary, Grid};
use asperity::load::{Control, History};
use asperity::material::Creep;
use asperity::simulation::Simulation;
use asperity::surface::{Part, Punch, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::tangential::{Coupling, SlipRow, Tangential, TangentialControl};
use asperity::time::TimeGrid;

const MU: f64 = 0.3;

const PUNCH: Shape = Shape::FlatPunch(Punch::Circle { radius: 1.0 });

/// A force along x.
fn pulled(nu: f64, points: Vec<(f64, f64)>) -> Tangential {
    Tangential {
        coefficient: MU,
        coefficients: None,
        shear_limit: f64::INFINITY,
        poisson: nu,
        beta: 0.0,
        coupling: Coupling::Neglect,
        control: TangentialControl::Force,
        histories: [History::Table { points }, History::Step { value: 0.0 }],
    }
}

/// The rows, and pressure and traction along x at the end.
fn states(simulation: Simulation) -> Result<(Vec<SlipRow>, [Array2<f64>; 2])> {
    let shape = simulation.grid.shape();
    let (mut rows, mut last) = (vec![], [0; 2].map(|_| Array2::zeros(shape)));
    let mut march = March::new(simulation)?;
    while let Some(step) = march.advance()? {
        rows.extend(step.slip_row());
        last[0].assign(&step.pressure());
        step.tangential_traction_into(0, &mut last[1]);
    }
    Ok((rows, last))
}

pub(super) fn sphere() -> Result<Vec<Check>> {
    let mut checks = Checks::new("cattaneo-mindlin", "Mindlin and Deresiewicz, J. Appl. Mech. 20 (1953) 327");
    for nu in [0.0, 0.3] {
        // G = R = W = 1; up to 0.6 μW, down to its opposite, and up again.
        let (share, a) = (0.6, libm::cbrt(3.0 / 8.0 * (1.0 - nu)));
        let q = share * MU;
        let (rows, _) = states(Simulation {
            creep: Creep::elastic(0.5 * (1.0 - nu)),
            loading: step_load(1.0),
            times: TimeGrid::Uniform { end: 5.0, steps: 20 },
            tangential: Some(Arc::new(pulled(nu, vec![(0.0, 0.0), (1.0, q), (3.0, -q), (5.0, q)]))),
            ..shape_on(96, 1.7, Shape::Sphere { radius: 1.0 })?
        })?;
        let left = 1.0 - share;
        let far = 3.0 * MU / (16.0 * a) * (2.0 - nu) * (1.0 - left.powf(2.0 / 3.0));
        // a/dx = 40, and with ν > 0 the closed form neglects slip across the force.
        let tolerance = if nu == 0.0 { 1e-3 } else { 2e-3 };
        let found = rows[4].displacement[0];
        checks.relative(format!("displacement at 0.6 of the largest force, ν = {nu}"), found, far, tolerance);
        let bracket = 1.0 - left.powf(5.0 / 3.0) - 5.0 / 6.0 * share * (1.0 + left.powf(2.0 / 3.0));
        let energy = 0.9 * MU * MU / a * (2.0 - nu) * bracket;
        checks.relative(
            format!("work of friction in a loop, ν = {nu}"),
            rows[20].work - rows[4].work,
            energy,
            5e-3,
        );
    }
    Ok(checks.list)
}

pub(super) fn rough() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("tangential-rough", "Ciavarella, J. Mech. Phys. Solids 46 (1998) 1; Jäger (1995)");
    let grid = Grid::new([64, 64], [1.7, 1.7])?;
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let roughness = Part::SelfAffine(SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsHeight(0.02),
        longest: 0.8,
        shortest: 0.2,
        roll_off: 0.8,
        seed: 5,
    });
    let gap = undeformed_gap(&grid, &[sphere, roughness])?;
    let q = 0.5 * MU;
    let under = |load: f64, law: Option<Arc<Tangential>>| Simulation {
        creep: Creep::elastic(0.5),
        loading: step_load(load),
        times: TimeGrid::Uniform { end: 1.0, steps: 2 },
        tangential: law,
        solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
        ..Simulation::new(grid, gap.clone())
    };
    let law = pulled(0.0, vec![(0.0, 0.0), (1.0, q)]);
    let (_, [pressure, traction]) = states(under(1.0, Some(Arc::new(law))))?;
    let (_, [less, _]) = states(under(1.0 - q / MU, None))?;
    let expected = MU * (&pressure - &less);
    let most = expected.iter().copied().fold(0.0, f64::max);
    let error = (&traction - &expected).iter().fold(0.0f64, |most, d| most.max(d.abs())) / most;
    // The tolerance of the solver, times the stiffness of a cell against that of the contact.
    checks.absolute(
        "traction on a rough sphere, ν = 0: largest error over the largest traction",
        error,
        1e-6,
    );
    Ok(checks.list)
}

pub(super) fn punch() -> Result<Vec<Check>> {
    let mut checks = Checks::new("glued-punch", "Q (2 - ν) J(t)/(8 a), J(t) = (1 + 3 (1 - exp(-t)))/4");
    let (nu, q, end) = (0.3, 0.5, 2.0);
    let punch = shape_on(96, 2.4, PUNCH)?;
    // The counted cells are a punch of this radius, but for half a cell at its edge, where the traction is singular.
    let cells = punch.gap.iter().filter(|gap| **gap == 0.0).count();
    let radius = (cells as f64 * punch.grid.cell_area() / PI).sqrt();
    let (rows, _) = states(Simulation {
        creep: with_one_time(0.25, 0.75).scaled(0.5 * (1.0 - nu)),
        loading: step_load(1.0),
        times: TimeGrid::Uniform { end, steps: 4 },
        tangential: Some(Arc::new(Tangential { coefficient: 1e6, ..pulled(nu, vec![(0.0, q), (end, q)]) })),
        ..punch
    })?;
    for row in [0, 4] {
        let time = end * row as f64 / 4.0;
        let exact = q * (2.0 - nu) * (0.25 + 0.75 * (1.0 - libm::exp(-time))) / (8.0 * radius);
        // Half of the cells at the edge: 0.25 of a cell of 1/40 of the radius.
        checks.relative(format!("displacement at t = {time}"), rows[row].displacement[0], exact, 1e-2);
    }
    Ok(checks.list)
}

/// All cells stick, and pressure and tractions act on each other.
pub(super) fn bonded() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("bonded-contact", "Spence, Proc. R. Soc. A 305 (1968) 55; Johnson (1985), section 5.3");
    let glue = |nu: f64| Tangential {
        coefficient: 1e6,
        beta: (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)),
        coupling: Coupling::Full,
        ..pulled(nu, vec![(0.0, 0.0)])
    };
    let tolerance = SolverOptions { tolerance: 1e-9, ..SolverOptions::default() };
    // A wave in full contact that relaxes from compliance 1 to 4: in waves K is 2/q, N 2 i β/q, and the traction 1/q of that under p.
    let (nu, amplitude, size) = (0.1, 1e-3, [2.0, 1.0]);
    let grid = Grid::new([32, 16], size)?;
    let [qx, qy] = size.map(|side| 2.0 * PI / side);
    let gap = Array2::from_shape_fn(grid.shape(), |(i, j)| {
        amplitude * (1.0 - f64::cos(qx * grid.x(i)) * f64::cos(qy * grid.y(j)))
    });
    let law = glue(nu);
    let expected = 0.5 * f64::hypot(qx, qy) * amplitude / (1.0 - law.beta * law.beta);
    let simulation = |end: f64| Simulation {
        boundary: Boundary::Periodic,
        creep: with_one_time(1.0, 3.0),
        loading: step_load(0.02),
        times: TimeGrid::Uniform { end, steps: 100 },
        tangential: Some(Arc::new(law.clone())),
        solver: tolerance,
        ..Simulation::new(grid, gap.clone())
    };
    // At once nothing has crept; after 400 retardation times the transient is a rounding error.
    for (end, compliance) in [(1e-12, 1.0), (400.0, 4.0)] {
        let (_, [pressure, _]) = states(simulation(end))?;
        let found = pressure.iter().copied().fold(0.0, f64::max) - 0.5 * 0.02;
        let largest = expected / compliance * f64::cos(qx * grid.x(0)) * f64::cos(qy * grid.y(0));
        checks.relative(
            format!("wave, relaxed to 1/{compliance}: amplitude of the pressure"),
            found,
            largest,
            1e-6,
        );
    }
    // A flat punch of radius 1 on a half-space of shear modulus 1: 4 ln(3 - 4 ν)/(1 - 2 ν) times its depth, and 4/(1 - ν) without friction.
    let punch = shape_on(96, 2.4, PUNCH)?;
    for nu in [0.0, 0.3] {
        let load = |law: Option<Arc<Tangential>>| -> Result<f64> {
            let (row, ..) = first(Simulation {
                creep: Creep::elastic(0.5 * (1.0 - nu)),
                loading: held(Control::Approach, 0.01),
                tangential: law,
                solver: tolerance,
                ..punch.clone()
            })?;
            Ok(row.load)
        };
        let found = load(Some(Arc::new(glue(nu))))? / load(None)?;
        let exact = (1.0 - nu) * libm::log(3.0 - 4.0 * nu) / (1.0 - 2.0 * nu);
        // Both lack a part of a cell of 1/40 of the radius at the edge, and not quite the same one.
        checks.relative(
            format!("load on a glued punch over that without friction, ν = {nu}"),
            found,
            exact,
            3e-3,
        );
    }
    Ok(checks.list)
}
