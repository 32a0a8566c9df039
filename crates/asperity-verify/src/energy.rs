//! Energy, stiffness and permanent flattening, compared with closed forms and consequences of the contact conditions.

use super::{Check, Checks, along, number, shape_on, step_load, zener};
use asperity::contact::SolverOptions;
use asperity::drive::{Drive, March};
use asperity::error::Result;
use asperity::load::Control;
use asperity::material::Creep;
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::{Plasticity, Simulation};
use asperity::step::Row;
use asperity::surface::{Punch, Shape};
use asperity::time::TimeGrid;

const ENERGIES: [Quantity; 4] =
    [Quantity::ElasticEnergy, Quantity::DissipatedEnergy, Quantity::ExternalWork, Quantity::ContactStiffness];

/// Elastic energy, heat, work and stiffness of every row.
fn energies(simulation: Simulation) -> Result<Vec<(Row, [f64; 4])>> {
    let mut march = March::new(Simulation { quantities: Quantities::of(ENERGIES), ..simulation })?;
    let mut rows = vec![];
    while let Some(step) = march.advance()? {
        rows.push((step.row(), ENERGIES.map(|quantity| number(&step, quantity))));
    }
    Ok(rows)
}

pub(super) fn hertz() -> Result<Vec<Check>> {
    let mut checks =
        Checks::new("hertz-energy", "Hertz: U = (2/5) W w, dW/dw = 2 a E*; Johnson 1985, section 4.2");
    let (n, size, load) = (129, 0.5, 0.02);
    let simulation = Simulation {
        creep: Creep::elastic(0.25),
        loading: step_load(load),
        ..shape_on(n, size, Shape::Sphere { radius: 1.0 })?
    };
    let a = (0.75 * load * 0.25f64).cbrt();
    let dx = size / n as f64;
    for (row, [elastic, heat, work, stiffness]) in energies(simulation)?.into_iter().take(1) {
        checks.relative("elastic energy", elastic, 0.4 * load * a * a, (dx / a).powi(2));
        checks.relative("work of the jump", work, elastic, 1e-12);
        checks.absolute("heat over work", heat / work, 0.0);
        // A stiffness corresponds to a radius, which is known to at least a fifth of a cell.
        checks.relative("contact stiffness", stiffness, 8.0 * a, 0.2 * dx / a);
        checks.relative("load", row.load, load, 1e-12);
    }
    Ok(checks.list)
}

pub(super) fn balance() -> Result<Vec<Check>> {
    let fact = "springs and dashpots in closed form; work = stored + lost";
    let mut checks = Checks::new("energy-balance", fact);
    // A punch under a held load: stored C0 + C1 (1 - e)^2, lost C1 (1 - e^2) of <p, Kp>/2, e = exp(-t/tau).
    let punch = Simulation {
        creep: zener(),
        loading: step_load(0.1),
        times: TimeGrid::Uniform { end: 2.0, steps: 5 },
        ..shape_on(48, 1.0, Shape::FlatPunch(Punch::Circle { radius: 0.3 }))?
    };
    let rows = energies(punch)?;
    let unit = rows.first().map_or(f64::NAN, |(_, [elastic, ..])| elastic / 0.25);
    if let Some((_, [elastic, heat, work, _])) = rows.last() {
        let fade = f64::exp(-2.0);
        // The two states are solved to 1e-6, and energies are quadratic in their errors.
        checks.relative("punch: elastic energy", *elastic, unit * 0.25 * (1.0 + (1.0 - fade).powi(2)), 1e-6);
        checks.relative("punch: heat", *heat, unit * 0.25 * (1.0 - fade * fade), 1e-6);
        checks.relative("punch: work", *work, elastic + heat, 1e-6);
    }
    // A sphere pressed suddenly and then further: second order.
    let imbalance = |steps: usize| -> Result<f64> {
        let sphere = Simulation {
            creep: zener(),
            loading: along(Control::Load, &[(0.0, 0.005), (2.0, 0.02)]),
            times: TimeGrid::Uniform { end: 2.0, steps },
            ..shape_on(48, 0.5, Shape::Sphere { radius: 1.0 })?
        };
        let rows = energies(sphere)?;
        Ok(rows
            .last()
            .map_or(f64::NAN, |(_, [elastic, heat, work, _])| (work / (elastic + heat) - 1.0).abs()))
    };
    let (coarse, fine) = (imbalance(5)?, imbalance(20)?);
    checks.absolute("sphere: imbalance with 5 steps", coarse, 0.02);
    checks.absolute("sphere: the same with 20 steps over that with 5", fine / coarse, 0.125);
    Ok(checks.list)
}

pub(super) fn dents() -> Result<Vec<Check>> {
    let mut checks = Checks::new("lasting-dents", "contact conditions of the flattened surface");
    let capped = |plasticity, points: &[(f64, f64)], steps| -> Result<Simulation> {
        Ok(Simulation {
            creep: Creep::elastic(0.25),
            hardness: 0.15,
            // A small tolerance, so that equal sets are found to be equal.
            solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
            plasticity,
            loading: along(Control::Load, points),
            times: TimeGrid::Uniform { end: steps as f64, steps },
            ..shape_on(48, 0.5, Shape::Sphere { radius: 1.0 })?
        })
    };
    // Up in 4 steps, down in 4, up in 4.
    let points = [(0.0, 0.0), (4.0, 0.02), (8.0, 0.0), (12.0, 0.02)];
    let lasting = super::rows(capped(Plasticity::Accumulate, &points, 12)?)?;
    let reversible = super::rows(capped(Plasticity::Cap, &points, 12)?)?;
    let [peak, down, again, back] = [4, 6, 10, 12].map(|n| lasting.get(n).copied().unwrap_or_default());
    let [first, half] = [4, 2].map(|n| reversible.get(n).copied().unwrap_or_default());
    // Solutions are unique: far above the solver's tolerance, far below the effect of flattening.
    checks.relative(
        "approach at the peak, as with the reversible cut-off",
        peak.approach,
        first.approach,
        1e-5,
    );
    checks.relative("approach at the second peak, as at the first", back.approach, peak.approach, 1e-5);
    checks.relative("contact area at the second peak", back.contact_area, peak.contact_area, 1e-12);
    checks.relative(
        "approach at half the load, reloading and unloading",
        again.approach,
        down.approach,
        1e-5,
    );
    checks.absolute(
        "approach at half the load, first loading over reloading",
        half.approach / again.approach,
        0.97,
    );
    Ok(checks.list)
}
