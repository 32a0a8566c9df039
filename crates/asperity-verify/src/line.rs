//! Line contacts compared with closed forms, for unit contact modulus.

use std::f64::consts::{FRAC_2_PI, PI};

use super::{Check, Checks, first, on_grid, step_load};
use asperity::error::Result;
use asperity::grid::{Boundary, Grid};
use asperity::simulation::Simulation;
use asperity::surface::{Punch, Shape};

pub(super) fn hertz() -> Result<Vec<Check>> {
    let mut checks = Checks::new("hertz-line", "Hertz 1881; Johnson 1985, section 4.2(c)");
    let (n, load) = (256, 1e-2);
    // R = E* = 1: a^2 = 4 W / pi, p0 = 2 W / (pi a).
    let a = (4.0 * load / PI).sqrt();
    let grid = Grid::line(n, 4.0 * a)?;
    let simulation =
        Simulation { loading: step_load(load), ..on_grid(grid, Shape::Cylinder { radius: 1.0 })? };
    let (row, pressure, displacement) = first(simulation)?;
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
        ..on_grid(grid, Shape::FlatPunch(punch))?
    };
    let (row, pressure, displacement) = first(simulation)?;
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
