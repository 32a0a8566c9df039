//! Elastic contacts compared with closed forms, for unit contact modulus.

use super::{Check, Checks, elastic_contact, first, held, on_grid, shape_on};
use asperity::contact::SolverOptions;
use asperity::error::Result;
use asperity::grid::{Boundary, Grid};
use asperity::load::Control;
use asperity::reference::{CappedHertz, CircularPunch, HertzEllipse, HertzSphere, SneddonCone, Westergaard};
use asperity::simulation::Simulation;
use asperity::surface::{Punch, Shape};

/// (dx/a)^2 times `factor`: the discretisation error of approach and peak pressure.
fn second_order(dx: f64, a: f64, factor: f64) -> f64 {
    factor * (dx / a).powi(2)
}

/// A fifth of the last ring of cells: the error of a counted area after the perimeter correction.
fn ring(dx: f64, a: f64) -> f64 {
    0.2 * 2.0 * dx / a
}

pub(super) fn hertz_sphere() -> Result<Vec<Check>> {
    let mut checks = Checks::new("hertz-sphere", "Hertz 1881; Johnson, Contact Mechanics, 1985, section 4.2");
    let (n, size) = (129, 2.4);
    let exact = HertzSphere::under_load(1.0, 1.0, 1.0)?;
    let (row, middle) = elastic_contact(shape_on(n, size, Shape::Sphere { radius: 1.0 })?, 1.0)?;
    let (dx, a) = (size / n as f64, exact.contact_radius);
    checks.relative("approach", row.approach, exact.approach, second_order(dx, a, 0.5));
    checks.relative("peak pressure", row.max_pressure, exact.peak_pressure, second_order(dx, a, 2.0));
    let off = 32;
    let r = off as f64 * dx;
    checks.relative(
        "pressure at r = 0.66 a",
        middle[n / 2 + off],
        exact.pressure(r),
        second_order(dx, a, 2.0),
    );
    let area = std::f64::consts::PI * a * a;
    checks.relative("contact area, corrected", row.contact_area_corrected, area, ring(dx, a));
    checks.relative("load", row.load, 1.0, 1e-12);
    Ok(checks.list)
}

pub(super) fn hertz_ellipse() -> Result<Vec<Check>> {
    let mut checks = Checks::new("hertz-ellipse", "Johnson 1985, eqs. 4.24-4.28 (elliptic integrals)");
    let (nx, ny) = (193, 131);
    let grid = Grid::new([nx, ny], [4.4, 2.0])?;
    let shape = Shape::Ellipsoid { radius_x: 4.0, radius_y: 1.0 };
    let exact = HertzEllipse::under_load([4.0, 1.0], 1.0, 1.0)?;
    let (row, _) = elastic_contact(on_grid(grid, shape)?, 1.0)?;
    let [dx, dy] = grid.spacing();
    let [a, b] = exact.semi_axes;
    let ratio = (dx / a).max(dy / b);
    checks.relative("approach", row.approach, exact.approach, ratio * ratio);
    checks.relative("peak pressure", row.max_pressure, exact.peak_pressure, 2.0 * ratio * ratio);
    let area = std::f64::consts::PI * a * b;
    checks.relative("contact area, corrected", row.contact_area_corrected, area, 0.2 * 2.0 * ratio);
    Ok(checks.list)
}

pub(super) fn cone() -> Result<Vec<Check>> {
    let mut checks = Checks::new("cone", "Sneddon 1965; Johnson 1985, section 5.2");
    let (n, size) = (160, 6.4);
    let exact = SneddonCone::under_load(0.1, 1.0, 1.0)?;
    let (row, middle) = elastic_contact(shape_on(n, size, Shape::Cone { slope: 0.1 })?, 1.0)?;
    let (dx, a) = (size / n as f64, exact.contact_radius);
    // The apex is a corner: no cell centre lies on it, first touch is at a distance of dx/sqrt 2, and the approach is of first
    // order in dx. Measured from the apex it is of second order again.
    let apex = 0.1 * dx / 2f64.sqrt();
    checks.relative("approach from the apex", row.approach + apex, exact.approach, 2.0 * (dx / a).powi(2));
    // Row n/2 lies half a cell off the axis.
    let r = ((20.5 * dx).powi(2) + (0.5 * dx).powi(2)).sqrt();
    checks.relative(
        "pressure at r = 0.33 a",
        middle[n / 2 + 20],
        exact.pressure(r),
        second_order(dx, a, 2.0),
    );
    let area = std::f64::consts::PI * a * a;
    checks.relative("contact area, corrected", row.contact_area_corrected, area, ring(dx, a));
    Ok(checks.list)
}

pub(super) fn flat_punch() -> Result<Vec<Check>> {
    let mut checks = Checks::new("flat-punch", "Boussinesq 1885; Sneddon 1965; Johnson 1985, section 3.4");
    let n = 160;
    let size = 2.4;
    let shape = Shape::FlatPunch(Punch::Circle { radius: 1.0 });
    let simulation = shape_on(n, size, shape)?;
    let dx = size / n as f64;
    // The punch on the grid consists of its cells: compare with the circle of the same area.
    let cells = simulation.gap.iter().filter(|h| h.is_finite()).count() as f64;
    let radius = (cells * dx * dx / std::f64::consts::PI).sqrt();
    let exact = CircularPunch::under_load(radius, 1.0, 1.0)?;
    let (row, middle) = elastic_contact(simulation, 1.0)?;
    // A singular edge: first order in dx.
    checks.relative("approach", row.approach, exact.approach, dx);
    let r = 0.5 * 2f64.sqrt() * dx;
    checks.relative("pressure in the middle", middle[n / 2], exact.pressure(r), dx);
    let missing = (row.contact_area / (dx * dx) - cells).abs();
    checks.absolute("cells of the punch out of contact", missing, 1e-9);
    Ok(checks.list)
}

/// Cells along a wave.
const CELLS: usize = 512;

pub(super) fn westergaard_wave() -> Result<Vec<Check>> {
    wave("westergaard-wave", Grid::new([CELLS, 4], [1.0, 4.0 / CELLS as f64])?)
}

pub(super) fn westergaard_line() -> Result<Vec<Check>> {
    wave("westergaard-line", Grid::line(CELLS, 1.0)?)
}

fn wave(case: &'static str, grid: Grid) -> Result<Vec<Check>> {
    let mut checks = Checks::new(case, "Westergaard 1939; Johnson 1985, section 13.2");
    let full = std::f64::consts::PI * 0.01;
    let dx = grid.spacing()[0];
    for share in [0.1, 0.5, 0.9] {
        let simulation = Simulation {
            boundary: Boundary::Periodic,
            loading: held(Control::Pressure, share * full),
            ..on_grid(grid, Shape::Wave { amplitude: 0.01, wavelength: [1.0, f64::INFINITY] })?
        };
        let exact = Westergaard::under_pressure(0.01, 1.0, 1.0, share * full)?;
        let (row, ..) = first(simulation)?;
        let name = |what: &str| format!("{what} at {share} p*");
        // Each end of a strip of contact is known to a cell.
        let off = (row.contact_fraction - exact.contact_fraction()).abs();
        checks.absolute(name("contact fraction"), off, 2.0 * dx);
        // No cell centre lies on the crest, and a wave of N cells resolves its square-root ends to 1/N.
        checks.relative(name("peak pressure"), row.max_pressure, exact.pressure(0.0), 2.0 * dx);
        let off = (row.mean_gap - exact.mean_gap()).abs() / 0.01;
        checks.absolute(name("mean gap over amplitude"), off, 2.0 * dx);
    }
    Ok(checks.list)
}

pub(super) fn capped_hertz() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("capped-hertz", "ring collocation of the capped paraboloid (reference::CappedHertz)");
    let (n, size) = (161, 3.2);
    let hertz = HertzSphere::under_load(1.0, 1.0, 1.0)?;
    let dx = size / n as f64;
    for share in [0.9, 0.6, 0.4] {
        let hardness = share * hertz.peak_pressure;
        let exact = CappedHertz::under_load(1.0, 1.0, hardness, 1.0)?;
        let simulation = Simulation {
            hardness,
            solver: SolverOptions { tolerance: 1e-8, ..SolverOptions::default() },
            ..shape_on(n, size, Shape::Sphere { radius: 1.0 })?
        };
        let (row, _) = elastic_contact(simulation, 1.0)?;
        let a = exact.contact_radius;
        let name = |what: &str| format!("{what} at H = {share} p0");
        checks.relative(name("approach"), row.approach, exact.approach, 2.0 * (dx / a).powi(2));
        checks.relative(
            name("contact area, corrected"),
            row.contact_area_corrected,
            exact.contact_area(),
            ring(dx, a),
        );
        let floor = 1.0 / hardness;
        checks.absolute(name("area short of W/H"), ((floor - row.contact_area) / floor).max(0.0), 1e-12);
    }
    Ok(checks.list)
}
