//! Viscoelastic contacts compared with solutions in time.

use super::{Check, Checks, held, on_grid, rows, shape_on, under, zener, zener_relaxation};
use asperity::contact::SolverOptions;
use asperity::drive::{Drive, March};
use asperity::error::Result;
use asperity::grid::{Boundary, Grid};
use asperity::load::{Control, History};
use asperity::material::Relaxation;
use asperity::reference::{CircularPunch, Ting, WestergaardStep};
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::surface::{Punch, Shape};
use asperity::time::TimeGrid;

fn tight() -> SolverOptions {
    SolverOptions { tolerance: 1e-8, ..SolverOptions::default() }
}

pub(super) fn ting_step() -> Result<Vec<Check>> {
    let mut checks = Checks::new("ting-step", "Lee & Radok 1960, Ting 1966 (SC17 eq. 21, corrected)");
    sphere_follows(&mut checks, &History::Step { value: 1.0 }, 4.0, &[0.0, 0.5, 1.0, 4.0])?;
    Ok(checks.list)
}

pub(super) fn ting_triangle() -> Result<Vec<Check>> {
    let mut checks = Checks::new("ting-triangle", "Ting 1966: the contact grows, then shrinks");
    let history = History::Triangle { peak: 1.0, rise: 1.0, fall: 1.0 };
    sphere_follows(&mut checks, &history, 2.0, &[0.5, 1.0, 1.25, 1.5, 1.75])?;
    Ok(checks.list)
}

/// A unit sphere under a load history to `end`, compared with Ting's solution at some times.
fn sphere_follows(checks: &mut Checks, history: &History, end: f64, instants: &[f64]) -> Result<()> {
    let (n, size) = (129, 1.8);
    let dx = size / n as f64;
    let exact = Ting::new(1.0, &zener(), history, end)?;
    let simulation = Simulation {
        creep: zener(),
        loading: under(Control::Load, history.clone()),
        times: TimeGrid::Uniform { end, steps: 80 },
        ..shape_on(n, size, Shape::Sphere { radius: 1.0 })?
    };
    let mut march = March::new(simulation)?;
    while let Some(step) = march.advance()? {
        let row = step.row();
        if !instants.iter().any(|t| (t - row.time()).abs() < 1e-9) {
            continue;
        }
        let state = exact.at(row.time())?;
        let at = |what: &str| format!("{what} at t = {}", row.time());
        // Second order in space; the 80 steps per history add 1e-4 (their order is checked separately).
        let tolerance = (dx / state.contact_radius).powi(2) + 1e-4;
        checks.relative(at("approach"), row.approach, state.approach, tolerance);
        let centre = step.pressure()[(n / 2, n / 2)];
        checks.relative(at("pressure in the middle"), centre, state.peak_pressure, 2.0 * tolerance);
        let area = std::f64::consts::PI * state.contact_radius.powi(2);
        checks.relative(
            at("contact area, corrected"),
            row.contact_area_corrected,
            area,
            0.2 * 2.0 * dx / state.contact_radius,
        );
    }
    Ok(())
}

pub(super) fn westergaard_creep() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("westergaard-creep", "Westergaard's wave on a viscoelastic body, hereditary integral");
    let n = 512;
    let pressure = 0.037_699_111_843_077_52;
    let grid = Grid::new([n, 4], [1.0, 4.0 / n as f64])?;
    let shape = Shape::Wave { amplitude: 0.01, wavelength: [1.0, f64::INFINITY] };
    let exact = WestergaardStep::under_pressure(0.01, 1.0, &zener(), pressure)?;
    let simulation = Simulation {
        boundary: Boundary::Periodic,
        creep: zener(),
        loading: held(Control::Pressure, pressure),
        times: TimeGrid::Uniform { end: 4.0, steps: 80 },
        ..on_grid(grid, shape)?
    };
    let dx = 1.0 / n as f64;
    for row in rows(simulation)?.iter().step_by(20) {
        let shape = exact.shape(row.time())?;
        let at = |what: &str| format!("{what} at t = {}", row.time());
        checks.absolute(
            at("contact fraction"),
            (row.contact_fraction - shape.contact_fraction()).abs(),
            2.0 * dx,
        );
        checks.absolute(
            at("mean gap over amplitude"),
            (row.mean_gap - shape.mean_gap()).abs() / 0.01,
            2.0 * dx,
        );
    }
    Ok(checks.list)
}

/// Error of a ratio of two loads from the solver tolerance of 1e-8.
const HELD: f64 = 1e-6;

pub(super) fn stiff_held_approach() -> Result<Vec<Check>> {
    let mut checks = Checks::new(
        "stiff-held-approach",
        "p(t)/p(0) = E*(t)/E*(0) in steps of any length: the contact set is frozen",
    );
    let one = |ratio: f64| Relaxation::absolute(1.0, &[(ratio - 1.0, 1.0)]);
    let moduli = [300.0, 280.0, 200.0, 110.0, 55.0, 27.0, 13.0, 6.5, 3.3, 1.7, 0.9, 0.5, 0.3];
    let decades = moduli.into_iter().zip(-6_i32..).map(|(e, n)| (e, libm::pow(10.0, f64::from(n))));
    let rubber = Relaxation::absolute(1.0, &decades.collect::<Vec<_>>())?;
    for (name, modulus) in [
        ("E(0)/E(inf) = 10", one(10.0)?),
        ("E(0)/E(inf) = 100", one(100.0)?),
        ("E(0)/E(inf) = 1000", one(1000.0)?),
        ("rubber of 13 terms", rubber),
    ] {
        for (steps, times) in [
            ("10 steps of 10 s", TimeGrid::Uniform { end: 100.0, steps: 10 }),
            ("25 steps by decades", TimeGrid::Logarithmic { end: 1e4, steps: 25, first: 1e-6 }),
            ("adaptive steps", TimeGrid::Adaptive { end: 1e3, tolerance: 1e-2, first: 1.0 }),
        ] {
            let rows = rows(Simulation {
                creep: modulus.to_creep()?,
                loading: held(Control::Approach, 0.04),
                times,
                solver: tight(),
                ..shape_on(33, 0.6, Shape::Sphere { radius: 1.0 })?
            })?;
            let first = rows.first().map_or(f64::NAN, |row| row.load);
            let off = |row: &Row| row.load / first / (modulus.value(row.time()) / modulus.value(0.0)) - 1.0;
            let worst = rows.iter().map(|row| off(row).abs()).fold(0.0, f64::max);
            checks.absolute(format!("load over load at t = 0, {name}, {steps}"), worst, HELD);
        }
    }
    Ok(checks.list)
}

pub(super) fn held_approach() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("held-approach", "W(t) = (4/3) E*(t) sqrt(R) delta^(3/2): the contact set is frozen");
    let n = 97;
    let size = 0.6;
    let depth = 0.04;
    let simulation = Simulation {
        creep: zener(),
        loading: held(Control::Approach, depth),
        times: TimeGrid::Uniform { end: 2.0, steps: 80 },
        solver: tight(),
        ..shape_on(n, size, Shape::Sphere { radius: 1.0 })?
    };
    let rows = rows(simulation)?;
    let modulus = zener_relaxation();
    let exact = 4.0 / 3.0 * modulus.value(0.0) * depth.powf(1.5);
    let (dx, a) = (size / n as f64, depth.sqrt());
    checks.relative("load at t = 0", rows[0].load, exact, 2.0 * (dx / a).powi(2));
    let last = &rows[rows.len() - 1];
    // Exact in any steps except for the solver tolerance.
    checks.relative(
        "load at t = 2 over load at t = 0",
        last.load / rows[0].load,
        modulus.value(2.0) / modulus.value(0.0),
        HELD,
    );
    checks.absolute(
        "change of the contact area",
        (last.contact_area / rows[0].contact_area - 1.0).abs(),
        0.0,
    );
    Ok(checks.list)
}

pub(super) fn flat_punch_history() -> Result<Vec<Check>> {
    let mut checks = Checks::new(
        "flat-punch-history",
        "delta(t) = (1/2a) integral C(t-s) dW(s): exact for any step length",
    );
    let points = vec![(0.0, 1.0), (1.0, 1.0), (2.0, 2.0), (3.0, 2.0), (3.0, 1.0)];
    let history = History::Table { points };
    let simulation = Simulation {
        creep: zener(),
        loading: under(Control::Load, history.clone()),
        times: TimeGrid::List(vec![0.5, 1.5, 2.5, 3.5, 4.0, 6.0, 10.0]),
        solver: SolverOptions { tolerance: 1e-10, ..SolverOptions::default() },
        ..shape_on(48, 2.4, Shape::FlatPunch(Punch::Circle { radius: 1.0 }))?
    };
    let rows = rows(simulation)?;
    let depth = |t: f64| CircularPunch::viscoelastic(1.0, &zener(), &history, t).map(|p| p.approach);
    // The punch on the grid differs from a circle by one factor, which is the same at all times.
    let factor = rows[0].approach / depth(0.0)?;
    for row in rows.iter().filter(|r| r.time() != 3.0) {
        checks.relative(
            format!("approach at t = {}", row.time()),
            row.approach / factor,
            depth(row.time())?,
            1e-8,
        );
    }
    Ok(checks.list)
}

pub(super) fn order_in_time() -> Result<Vec<Check>> {
    let mut checks = Checks::new("order-in-time", "twice the steps, a quarter of the error (second order)");
    // A punch with a sinusoidal approach: the contact does not change, and W = S int E*(t - s) d(delta)(s).
    let (mean, amplitude, frequency) = (0.02, 0.01, 0.4);
    let solve = |steps: usize| -> Result<[f64; 2]> {
        let history = History::Sine { mean, amplitude, frequency };
        let simulation = Simulation {
            creep: zener(),
            loading: under(Control::Approach, history),
            times: TimeGrid::Uniform { end: 1.0, steps },
            solver: SolverOptions { tolerance: 1e-11, ..SolverOptions::default() },
            ..shape_on(24, 1.0, Shape::FlatPunch(Punch::Circle { radius: 0.3 }))?
        };
        let rows = rows(simulation)?;
        Ok([rows.first(), rows.last()].map(|row| row.map_or(f64::NAN, |row| row.load)))
    };
    let omega = std::f64::consts::TAU * frequency;
    // int exp(-(1 - s)/tau) cos(omega s) ds over [0, 1], tau = 1/2
    let fading =
        (2.0 * (libm::cos(omega) - libm::exp(-2.0)) + omega * libm::sin(omega)) / (4.0 + omega * omega);
    let exact = (4.0 * mean + 2.0 * amplitude * libm::sin(omega) + 2.0 * amplitude * omega * fading
        - 2.0 * mean * (1.0 - libm::exp(-2.0)))
        / (4.0 * mean);
    let errors = [10, 20, 40].map(|n| solve(n).map(|[first, last]| (last / first / exact - 1.0).abs()));
    let [coarse, middle, fine] = errors;
    let (coarse, middle, fine) = (coarse?, middle?, fine?);
    checks.absolute("order short of 2, 10 to 20 steps", (2.0 - (coarse / middle).log2()).abs(), 0.1);
    checks.absolute("order short of 2, 20 to 40 steps", (2.0 - (middle / fine).log2()).abs(), 0.1);
    Ok(checks.list)
}
