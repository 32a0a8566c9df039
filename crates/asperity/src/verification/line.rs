//! Line contacts compared with closed forms, for unit contact modulus.

use crate::drive::Drive;
use std::f64::consts::{FRAC_2_PI, PI};

use super::{Check, Checks, step_load};
use crate::drive::March;
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::load::{Control, History, Loading};
use crate::reference::Westergaard;
use crate::simulation::Simulation;
use crate::step::Row;
use crate::surface::{Part, Punch, Shape, undeformed_gap};

/// The first row of a line contact, its pressure and its displacement.
fn contact(simulation: Simulation) -> Result<(Row, Vec<f64>, Vec<f64>)> {
    let shape = simulation.grid.shape();
    let mut march = March::new(simulation)?;
    let Some(step) = march.advance()? else { return Ok((Row::default(), vec![], vec![])) };
    let mut displacement = ndarray::Array2::zeros(shape);
    step.displacement_into(&mut displacement);
    Ok((step.row(), step.pressure().iter().copied().collect(), displacement.into_raw_vec_and_offset().0))
}

fn shape_on(grid: Grid, shape: Shape) -> Result<Simulation> {
    let gap = undeformed_gap(&grid, &[Part::Shape { shape, center: [0.0, 0.0] }])?;
    Ok(Simulation::new(grid, gap))
}

pub(super) fn hertz() -> Result<Vec<Check>> {
    let mut checks = Checks::new("hertz-line", "Hertz 1881; Johnson 1985, section 4.2(c)");
    let (n, load) = (256, 1e-2);
    // R = E* = 1: a^2 = 4 W / pi, p0 = 2 W / (pi a).
    let a = (4.0 * load / PI).sqrt();
    let grid = Grid::line(n, 4.0 * a)?;
    let simulation =
        Simulation { loading: step_load(load), ..shape_on(grid, Shape::Cylinder { radius: 1.0 })? };
    let (row, pressure, displacement) = contact(simulation)?;
    let second_order = (grid.spacing()[0] / a).powi(2);
    checks.relative("load per length", row.load, load, 1e-12);
    checks.relative("peak pressure", row.max_pressure, FRAC_2_PI * load / a, 2.0 * second_order);
    let at = n / 2 + 32;
    let x = grid.x(at) - 2.0 * a;
    let exact = FRAC_2_PI * load / a * (1.0 - (x / a).powi(2)).sqrt();
    checks.relative("pressure at x = 0.5 a", pressure[at], exact, 2.0 * second_order);
    checks.absolute(
        "contact length, in cells",
        (row.contact_area - 2.0 * a).abs() / grid.spacing()[0],
        2.0, // a cell at each end
    );
    // u(x) - u(0) outside the contact: (2 W / pi E*) (z sqrt(z^2 - 1) - ln(z + sqrt(z^2 - 1)) - z^2), z = x/a.
    let deep = |x: f64| {
        let z = (x / a).abs();
        let root = (z * z - 1.0).max(0.0).sqrt();
        // Inside the contact the displacement follows the cylinder.
        let outside = if z > 1.0 { z * root - (z + root).ln() } else { 0.0 };
        FRAC_2_PI * load * (outside - z * z)
    };
    let cell = n - 10;
    let fallen = displacement[cell] - displacement[n / 2];
    let exact = deep(grid.x(cell) - 2.0 * a) - deep(0.0);
    checks.relative("displacement at x = 1.85 a, from the middle", fallen, exact, 4.0 * second_order);
    Ok(checks.list)
}

pub(super) fn strip_punch() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("strip-punch", "periodic flat strips: Westergaard's function of the gaps between them");
    let (n, half, load) = (512, 0.25, 1.0);
    let grid = Grid::line(n, 1.0)?;
    let punch = Punch::Rectangle { size: [2.0 * half, f64::INFINITY] };
    let simulation = Simulation {
        boundary: Boundary::Periodic,
        loading: step_load(load),
        ..shape_on(grid, Shape::FlatPunch(punch))?
    };
    let (row, pressure, displacement) = contact(simulation)?;
    // The edges, at which the pressure is infinite, are first order.
    let first_order = 1.0 / n as f64;
    let sine = |x: f64| (PI * x).sin();
    for cell in [n / 2, n / 2 + n / 8] {
        let x = grid.x(cell) - 0.5;
        let exact = load * (PI * x).cos() / (sine(half).powi(2) - sine(x).powi(2)).sqrt();
        let name = format!("pressure at x = {:.2} a", (x / half).abs());
        checks.relative(name, pressure[cell], exact, 8.0 * first_order);
    }
    // From the mean: -(2 pm l / (pi E*)) ln sin(pi a / l).
    checks.relative(
        "displacement",
        displacement[n / 2],
        -FRAC_2_PI * load * sine(half).ln(),
        6.0 * first_order,
    );
    checks.absolute("contact length", (row.contact_area - 2.0 * half).abs(), 1e-12);
    Ok(checks.list)
}

pub(super) fn westergaard() -> Result<Vec<Check>> {
    let mut checks = Checks::new("westergaard-line", "Westergaard 1939; Johnson 1985, section 13.2");
    let n = 512;
    let grid = Grid::line(n, 1.0)?;
    let full = PI * 0.01;
    for share in [0.1, 0.5, 0.9] {
        let wave = Shape::Wave { amplitude: 0.01, wavelength: [1.0, f64::INFINITY] };
        let simulation = Simulation {
            boundary: Boundary::Periodic,
            loading: Loading { control: Control::Pressure, history: History::Step { value: share * full } }
                .into(),
            ..shape_on(grid, wave)?
        };
        let exact = Westergaard::under_pressure(0.01, 1.0, 1.0, share * full)?;
        let (row, ..) = contact(simulation)?;
        let dx = 1.0 / n as f64;
        let name = |what: &str| format!("{what} at {share} p*");
        // As for the wave on a plane: each end of the contact is known to a cell.
        let off = (row.contact_fraction - exact.contact_fraction()).abs();
        checks.absolute(name("contact fraction"), off, 2.0 * dx);
        checks.relative(name("peak pressure"), row.max_pressure, exact.pressure(0.0), 2.0 * dx);
        let off = (row.mean_gap - exact.mean_gap()).abs() / 0.01;
        checks.absolute(name("mean gap over amplitude"), off, 2.0 * dx);
    }
    Ok(checks.list)
}
