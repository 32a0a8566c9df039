//! Facts that hold to the solver's tolerance on any grid, for any surface.

use super::{Check, Checks, first, held, last, rows, step_load, under, zener};
use asperity::contact::SolverOptions;
use asperity::error::Result;
use asperity::grid::{Boundary, Grid};
use asperity::load::{Control, History, Programme};
use asperity::material::Creep;
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::time::TimeGrid;

/// Solver tolerance of this file; the checks allow for its amplification by a hundred.
const TOLERANCE: f64 = 1e-9;

/// A cut-off that caps some of the cells: the load makes 0.2 on average.
const HARDNESS: f64 = 0.6;

/// A rough sphere, on cells that are not square.
fn rough(boundary: Boundary) -> Result<Simulation> {
    let grid = Grid::new([96, 80], [1.0, 1.0])?;
    let roughness = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.3),
        longest: 0.5,
        shortest: 0.05,
        roll_off: 0.5,
        seed: 3,
    };
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 2.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[sphere, Part::SelfAffine(roughness)])?;
    let solver = SolverOptions { tolerance: TOLERANCE, ..SolverOptions::default() };
    Ok(Simulation { boundary, solver, ..Simulation::new(grid, gap) })
}

/// The elastic contact of compliance `c` under a load: its row and pressure.
fn elastic(base: &Simulation, c: f64, loading: Programme) -> Result<(Row, Vec<f64>)> {
    let simulation = Simulation { creep: Creep::elastic(c), loading, ..base.clone() };
    first(simulation).map(|(row, pressure, _)| (row, pressure))
}

fn name(boundary: Boundary) -> &'static str {
    match boundary {
        Boundary::Free => "free",
        Boundary::Periodic => "periodic",
    }
}

pub(super) fn one_elastic_solve() -> Result<Vec<Check>> {
    let mut checks = Checks::new(
        "one-elastic-solve",
        "growing uncapped contact = elastic contact of C(0) under int C dW / C(0), any rough surface",
    );
    for boundary in [Boundary::Free, Boundary::Periodic] {
        let base = rough(boundary)?;
        let ramp = History::Ramp { value: 0.3, duration: 2.0 };
        let rows = rows(Simulation {
            creep: zener(),
            loading: under(Control::Load, ramp),
            times: TimeGrid::List(vec![0.5, 2.0, 2.7, 9.0]),
            ..base.clone()
        })?;
        for row in &rows[1..] {
            let creep = zener();
            let ramped = creep.integral(row.time()) - creep.integral((row.time() - 2.0).max(0.0));
            let effective = 0.15 * ramped / creep.instantaneous;
            let (equal, _) = elastic(&base, creep.instantaneous, step_load(effective))?;
            let at = |what: &str| format!("{what} at t = {}, {}", row.time(), name(boundary));
            checks.relative(at("approach"), row.approach, equal.approach, 100.0 * TOLERANCE);
            checks.relative(at("contact area"), row.contact_area, equal.contact_area, 0.0);
        }
    }
    Ok(checks.list)
}

pub(super) fn long_time_limit() -> Result<Vec<Check>> {
    let mut checks = Checks::new(
        "long-time-limit",
        "held load, t -> infinity: the elastic contact of C(infinity), capped or not",
    );
    for boundary in [Boundary::Free, Boundary::Periodic] {
        for hardness in [f64::INFINITY, HARDNESS] {
            let base = Simulation { hardness, ..rough(boundary)? };
            let (_, relaxed) = elastic(&base, zener().long_time(), step_load(0.2))?;
            let crept = Simulation {
                creep: zener(),
                loading: step_load(0.2),
                times: TimeGrid::Logarithmic { end: 200.0, steps: 40, first: 0.01 },
                ..base
            };
            let pressure = last(crept, |step| Ok(step.pressure().iter().copied().collect::<Vec<f64>>()))?;
            let pressure = pressure.unwrap_or_default();
            let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>().sqrt();
            let difference = norm(&mut pressure.iter().zip(&relaxed).map(|(a, b)| a - b));
            let error = difference / norm(&mut relaxed.iter().copied());
            let cap = if hardness.is_finite() { "capped" } else { "uncapped" };
            let at_cap = pressure.iter().filter(|p| **p >= hardness).count();
            debug_assert!(hardness.is_infinite() || at_cap > 0, "the cap is not reached");
            // The remaining history decays within the last, longest step: exp(-dt/tau), squared in the norm.
            checks.absolute(format!("|dp|/|p|, {}, {cap}", name(boundary)), error, 1e-5);
        }
    }
    Ok(checks.list)
}

pub(super) fn duality() -> Result<Vec<Check>> {
    let mut checks = Checks::new("duality", "the approach found under a load, prescribed, carries that load");
    for boundary in [Boundary::Free, Boundary::Periodic] {
        for hardness in [f64::INFINITY, HARDNESS] {
            let base = Simulation { hardness, ..rough(boundary)? };
            let (loaded, _) = elastic(&base, 0.25, step_load(0.2))?;
            let (pressed, _) = elastic(&base, 0.25, held(Control::Approach, loaded.approach))?;
            let cap = if hardness.is_finite() { "capped" } else { "uncapped" };
            checks.relative(
                format!("load, {}, {cap}", name(boundary)),
                pressed.load,
                0.2,
                1000.0 * TOLERANCE,
            );
        }
    }
    Ok(checks.list)
}
