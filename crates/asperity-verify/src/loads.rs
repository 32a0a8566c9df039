//! Loading programmes: stages, adaptive steps, cycles, pull-off.

use super::{Check, Checks, along, held, rows, shape_on, step_load, under, zener};
use asperity::cycles::cycles;
use asperity::error::Result;
use asperity::load::{Control, Course, Event, History, Programme, Stage};
use asperity::material::{Creep, CreepTerm};
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::surface::{Punch, Shape};
use asperity::time::TimeGrid;

fn sphere() -> Result<Simulation> {
    Ok(Simulation { creep: zener(), ..shape_on(64, 1.8, Shape::Sphere { radius: 1.0 })? })
}

pub(super) fn press_and_hold() -> Result<Vec<Check>> {
    // While the contact does not shrink W(t) = int E*(t - s) dL(s), where L(s) = W0 C(s) under the load W0 and is constant while
    // the approach is constant: W/W0 = 1 - exp(-t1)/2 + exp(t1 - 2 t)/2 after the switch at t1 = 1.
    let mut checks = Checks::new("press-hold", "W(t) = int E*(t - s) dL(s), Lee & Radok 1960, closed form");
    let press = Stage { duration: Some(1.0), ..Stage::new(Control::Load, History::Step { value: 0.2 }) };
    let hold = Stage::new(Control::Approach, Course::Hold);
    let steps = 100;
    let times = TimeGrid::Uniform { end: 3.0, steps };
    let rows = rows(Simulation { loading: Programme::new(vec![press, hold]), times, ..sphere()? })?;
    let exact = |t: f64| 0.2 * (1.0 - 0.5 * libm::exp(-1.0) + 0.5 * libm::exp(1.0 - 2.0 * t));
    let held = rows.iter().filter(|row| row.stage == 1);
    let error = held.map(|row| (row.load / exact(row.time()) - 1.0).abs()).fold(0.0, f64::max);
    // Exact in any steps except for the solver tolerance.
    checks.absolute("load while the approach is held, largest relative difference", error, 1e-5);
    Ok(checks.list)
}

pub(super) fn event() -> Result<Vec<Check>> {
    // Under the load W0 the approach is w(0) (C(t)/C(0))^(2/3) for a sphere; it reaches 1.2 w(0) where C(t) = 1.2^1.5 C(0). On a
    // grid the contact grows by whole cells, so it is compared with the elastic contact on the same grid, for any exponent.
    let mut checks =
        Checks::new("event", "approach of one elastic contact with C(t), at the time of the event");
    let first = rows(Simulation {
        loading: step_load(0.2),
        times: TimeGrid::Uniform { end: 1e-9, steps: 1 },
        ..sphere()?
    })?;
    let target = 1.2 * first.first().map_or(0.0, |row| row.approach);
    let press = Stage {
        until: Some(Event::Approach(target)),
        ..Stage::new(Control::Load, History::Step { value: 0.2 })
    };
    let times = TimeGrid::Uniform { end: 3.0, steps: 10 };
    let loading = Programme::new(vec![press]);
    let found = rows(Simulation { loading, times, ..sphere()? })?;
    let time = found.last().map_or(0.0, |row| row.time());
    // The load that an elastic contact of compliance C(0) needs for the target gives C(t) at the event.
    let elastic = rows(Simulation {
        loading: held(Control::Approach, target),
        creep: Creep::elastic(0.25),
        times: TimeGrid::Uniform { end: 1.0, steps: 1 },
        ..sphere()?
    })?;
    let ratio = elastic.first().map_or(0.0, |row| row.load / 0.2);
    // C(t)/C(0) = 2 - exp(-t)
    checks.relative("time of the event", time, -libm::log(2.0 - ratio), 1e-4);
    Ok(checks.list)
}

pub(super) fn pull_off() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("pull-off", "free recovery: u falls as exp(-t/lambda) where no pressure acts");
    let loading = along(Control::Load, &[(0.0, 0.0), (0.5, 0.3), (1.0, 0.0)]);
    let times = TimeGrid::Uniform { end: 3.0, steps: 30 };
    let rows = rows(Simulation { loading, times, ..sphere()? })?;
    let open: Vec<&Row> = rows.iter().filter(|row| row.time() >= 1.0).collect();
    let left = open.iter().map(|row| row.contact_area + row.load + row.max_pressure).fold(0.0, f64::max);
    checks.absolute("area, load and pressure left", left, 0.0);
    // The deepest point of the indentation of a sphere stays below its apex: it touches there first.
    let start = open.first().map_or(0.0, |row| row.mean_gap + row.approach);
    let rest = rows.first().map_or(0.0, |row| row.mean_gap + row.approach);
    let error = open.iter().map(|row| {
        let expected = (start - rest) * libm::exp(1.0 - row.time());
        (row.mean_gap + row.approach - rest - expected).abs() / (start - rest).abs()
    });
    checks.absolute("mean displacement, relative difference", error.fold(0.0, f64::max), 1e-10);
    Ok(checks.list)
}

pub(super) fn adaptive() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("adaptive-steps", "p(t)/p(0) = E*(t)/E*(0) at held approach, over eight decades");
    let term = |compliance, retardation_time| CreepTerm { compliance, retardation_time };
    let terms = vec![term(0.3, 1e-2), term(0.4, 1.0), term(0.5, 1e3)];
    let creep = Creep { instantaneous: 0.2, terms, fluidity: 0.0 };
    let tolerance = 1e-3;
    let base = Simulation {
        creep: creep.clone(),
        times: TimeGrid::Adaptive { end: 1e5, tolerance, first: 1e-3 },
        ..shape_on(32, 1.0, Shape::Sphere { radius: 1.0 })?
    };
    let relaxed = rows(Simulation { loading: held(Control::Approach, 0.03), ..base.clone() })?;
    let relaxation = creep.to_relaxation()?;
    let first = relaxed.first().map_or(0.0, |row| row.load);
    let exact = |t: f64| first * relaxation.value(t) / relaxation.value(0.0);
    let error = relaxed.iter().map(|row| (row.load / exact(row.time()) - 1.0).abs()).fold(0.0, f64::max);
    checks.absolute(
        format!("load, {} steps, largest relative difference", relaxed.len() - 1),
        error,
        tolerance,
    );
    let crept = rows(Simulation { loading: step_load(0.01), ..base })?;
    checks.absolute("number of steps under a held load, over 80", (crept.len() - 1) as f64 / 80.0, 1.0);
    Ok(checks.list)
}

pub(super) fn loss_angle() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("loss-angle", "full contact: tan(delta) = C''/C' of the material (Ferry 1980)");
    let frequency = 0.2;
    let omega = std::f64::consts::TAU * frequency;
    // C* = C0 + C1/(1 + i omega tau), tau = 1
    let storage = 0.25 + 0.25 / (1.0 + omega * omega);
    let loss = 0.25 * omega / (1.0 + omega * omega);
    let punch = Shape::FlatPunch(Punch::Circle { radius: 0.3 });
    let base = Simulation { creep: zener(), ..shape_on(32, 1.0, punch)? };
    let history = History::Sine { mean: 1.0, amplitude: 0.5, frequency };
    let loading: Programme = under(Control::Load, history);
    let found = |times: TimeGrid| -> Result<(f64, f64)> {
        let rows = rows(Simulation { loading: loading.clone(), times, ..base.clone() })?;
        let column = |value: fn(&Row) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
        let (time, load, approach) = (column(|r| r.time()), column(|r| r.load), column(|r| r.approach));
        let last = cycles(&time, &load, &approach, frequency, 0.0)?.pop();
        Ok(last.map_or((0.0, 0.0), |cycle| (cycle.loss_angle, cycle.dissipated_energy * cycle.stiffness)))
    };
    // The work of a cycle of the load's amplitude W1 is pi W1^2 sin(delta)/|K*|. The sixth cycle: e^-25 of the start.
    let delta = libm::atan2(loss, storage);
    let steps = 40;
    let (angle, energy) = found(TimeGrid::Uniform { end: 30.0, steps: 6 * steps })?;
    let phase = omega * 5.0 / steps as f64;
    // The chord of a sine is low by (omega dt)^2/12 in the mean; the loop area of chords by (omega dt)^2/6.
    checks.relative("loss angle, 40 steps to a cycle", angle, delta, phase * phase / 6.0);
    let exact = std::f64::consts::PI * 0.25 * libm::sin(delta);
    checks.relative("dissipated energy, 40 steps to a cycle", energy, exact, phase * phase / 3.0);
    let tolerance = 1e-3;
    let (angle, _) = found(TimeGrid::Adaptive { end: 30.0, tolerance, first: 0.01 })?;
    checks.relative("loss angle, adaptive steps", angle, delta, 0.02);
    Ok(checks.list)
}
