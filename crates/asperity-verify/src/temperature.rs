//! Bodies whose temperature changes: reduced time compared with closed forms and the row of springs.

use super::{Check, Checks, rows, shape_on, step_load, under, zener, zener_relaxation};
use asperity::error::Result;
use asperity::load::{Control, History};
use asperity::material::{Creep, ReducedTime, Shift, ThermalCreep};
use asperity::reference::{HertzSphere, Mdr, MdrProfile, MdrTarget};
use asperity::simulation::Simulation;
use asperity::surface::Shape;
use asperity::time::TimeGrid;

/// ln a_T = -ln 8 (T - 300 K) / 10 K: eight times as fast for every ten kelvin.
fn shift() -> Shift {
    let eight = 8f64.ln();
    Shift::Table { points: vec![(290.0, eight), (300.0, 0.0), (320.0, -2.0 * eight)] }
}

/// Cold, a jump up at 0.5, a ramp from 1 to 2, held.
const TEMPERATURES: [(f64, f64); 5] = [(0.0, 290.0), (0.5, 290.0), (0.5, 300.0), (1.0, 300.0), (2.0, 310.0)];

/// Its reduced time computed by hand: 1/8 per second, then 1, then int exp(ln 8 s) ds, then 8.
fn reduced(t: f64) -> f64 {
    let eight = 8f64.ln();
    let [cold, warm, rising, hot] = [t.min(0.5), t.clamp(0.5, 1.0) - 0.5, t.clamp(1.0, 2.0) - 1.0, t - 2.0];
    cold / 8.0 + warm + (eight * rising).exp_m1() / eight + 8.0 * hot.max(0.0)
}

fn body(creep: Creep) -> Result<ThermalCreep> {
    Ok(ThermalCreep { creep, clock: ReducedTime::new(shift(), &TEMPERATURES)? })
}

pub(super) fn temperature_step_load() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("temperature-step-load", "Hertz with C(xi(t)): two bodies, one of them on its own clock");
    let (n, size) = (129, 1.8);
    // A body at constant temperature and one that warms up: C = C1(t) + C2(xi(t)).
    let simulation = Simulation {
        creep: zener().scaled(0.4),
        thermal: vec![body(zener().scaled(0.6))?],
        loading: step_load(1.0),
        times: TimeGrid::Uniform { end: 2.5, steps: 25 },
        ..shape_on(n, size, Shape::Sphere { radius: 1.0 })?
    };
    for row in rows(simulation)?.iter().filter(|row| [0.0, 0.5, 1.0, 1.5, 2.5].contains(&row.time())) {
        let compliance = 0.4 * zener().value(row.time()) + 0.6 * zener().value(reduced(row.time()));
        let exact = HertzSphere::under_load(1.0, 1.0 / compliance, 1.0)?;
        let tolerance = (size / n as f64 / exact.contact_radius).powi(2);
        checks.relative(format!("approach at t = {}", row.time()), row.approach, exact.approach, tolerance);
    }
    Ok(checks.list)
}

pub(super) fn temperature_springs() -> Result<Vec<Check>> {
    let mut checks = Checks::new(
        "temperature-springs",
        "springs of the dimensionality reduction, marched in reduced time",
    );
    let (n, size) = (97, 1.8);
    // Up, down to a third, up again while the temperature jumps and climbs.
    let points = vec![(0.0, 0.0), (0.7, 0.9), (1.3, 0.3), (1.8, 0.3), (2.5, 1.0)];
    let history = History::Table { points };
    let times = TimeGrid::Uniform { end: 2.5, steps: 250 };
    let mut springs = Mdr::new(MdrProfile::Paraboloid { radius: 1.0 }, &zener_relaxation(), 1.0, 2000)?;
    springs.step(0.0, MdrTarget::Load(0.0))?;
    let mut approaches = vec![0.0];
    let mut last = 0.0;
    for t in times.times() {
        let state = springs.step(reduced(t) - last, MdrTarget::Load(history.before(t)))?;
        approaches.push(state.approach);
        last = reduced(t);
    }
    let simulation = Simulation {
        creep: Creep::default(),
        thermal: vec![body(zener())?],
        loading: under(Control::Load, history),
        times,
        ..shape_on(n, size, Shape::Sphere { radius: 1.0 })?
    };
    let rows = rows(simulation)?;
    let scale = approaches.iter().copied().fold(0.0, f64::max);
    let error =
        rows.iter().zip(&approaches).map(|(row, w)| (row.approach - w).abs()).fold(0.0, f64::max) / scale;
    // (dx/a)^2 at the radii that matter, above 0.3, and the steps' second order.
    let dx = size / n as f64;
    checks.absolute("approach, largest difference over its peak", error, (dx / 0.3).powi(2));
    Ok(checks.list)
}
