//! Friction of a contact in motion: over the velocity of steady states, or over time.

use asperity::Boundary;
use asperity::quantities::Quantity;
use asperity::reference::{Correction, Persson, PerssonFriction};
use asperity::sliding::Direction;
use asperity::surface::Surface;
use asperity_io::store::{Reader, StoreError};

use super::evolution::times;
use super::rows::Rows;
use super::{Options, PlotError, boundary, creep, nameless};
use crate::figure::{Axis, Curves, Figure, Series, Style};

pub(super) fn friction(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let has = |name: &str| reader.scalars().iter().any(|series| series.name == name);
    if !has("friction_coefficient") {
        return Err(PlotError::Refused(format!(
            "{} has no friction: its case has no motion; give it a table [motion]",
            reader.path().display()
        )));
    }
    let x = times(reader)?;
    let rows = Rows::within(reader, options)?;
    let axis = || rows.axis(options.log);
    let grid = &reader.header().grid;
    let line = |name: &str, series: &str| -> Result<Series, StoreError> {
        Ok(Series::new(name, Style::Line, &x, reader.series(series)?))
    };
    let total = has("friction_coefficient_total");
    let theory = persson(reader)?;
    let bulk = match (total, &theory) {
        (true, _) => "loss in the bulk",
        (false, Some(_)) => "computed",
        (false, None) => "",
    };
    let mut coefficient = Curves::new("Friction", axis(), Axis::linear("friction coefficient", ""))
        .with(line(bulk, "friction_coefficient")?);
    if total {
        let [all, bulk] =
            [reader.series("friction_coefficient_total")?, reader.series("friction_coefficient")?];
        let own = all.iter().zip(&bulk).map(|(all, bulk)| all - bulk).collect::<Vec<f64>>();
        coefficient = coefficient
            .with(Series::new("of the surfaces", Style::Line, &x, own))
            .with(Series::new("in total", Style::Line, &x, all));
    }
    let largest = |name: &str| -> Result<f64, StoreError> {
        Ok(reader.series(name)?.iter().fold(0.0, |most, force| force.abs().max(most)))
    };
    let mut force = Curves::new(
        if total { "Forces of the loss in the bulk" } else { "Forces" },
        axis(),
        Axis::linear("force", grid.units("N")),
    )
    .with(line("against motion", "friction_force")?);
    if largest("side_force")? > 1e-3 * largest("friction_force")? {
        force = force.with(line("across it", "side_force")?);
    }
    let mut area = Curves::new("Contact", axis(), Axis::linear("contact over nominal area", ""))
        .with(line(if theory.is_some() { "computed" } else { "" }, "contact_fraction")?);
    if let Some(theory) = theory {
        let name = name_of_theory(reader)?;
        let curve = |of: fn(&PerssonFriction) -> f64| {
            Series::new(name, Style::Dashed, &x, theory.iter().map(of).collect::<Vec<f64>>())
        };
        coefficient = coefficient.with(curve(|at| at.friction_coefficient));
        area = area.with(curve(|at| at.contact_fraction));
    }
    let mut figure = Figure::new("").with(coefficient).with(force).with(area);
    if has("dissipated_power") {
        // Over decades of velocity the power spans decades too.
        let own = match reader.header().axis() {
            asperity::Axis::Velocity => Axis::log("power lost", grid.units("W")),
            asperity::Axis::Time | asperity::Axis::None => Axis::linear("power lost", grid.units("W")),
        };
        let power = Curves::new(if total { "Power lost in the bulk" } else { "Power" }, axis(), own);
        figure = figure.with(nameless(power, &x, reader.series("dissipated_power")?));
    }
    Ok(figure)
}

/// Persson's theory at the velocities of a sweep, from the stored gap, creep function and nominal pressure. `None` where
/// it has nothing to say: a free domain, a line, layers, no undeformed gap, or motion in time.
pub(crate) fn persson(reader: &Reader) -> Result<Option<Vec<PerssonFriction>>, StoreError> {
    let header = reader.header();
    let layered = header.setup.contains_key("layer_separable");
    let over_velocities = header.axis() == asperity::Axis::Velocity;
    if !over_velocities || header.grid.is_line() || layered || boundary(reader) != Boundary::Periodic {
        return Ok(None);
    }
    let velocities = reader.series("time")?;
    let (Some(creep), Some(pressure)) = (creep(reader), reader.series("mean_pressure")?.first().copied())
    else {
        return Ok(None);
    };
    let direction = header.setup["motion"]["direction"].as_array().map(|list| {
        let [x, y] = [0, 1].map(|n| list.get(n).and_then(serde_json::Value::as_f64).unwrap_or_default());
        Direction::Angle(y.atan2(x))
    });
    let Some(direction) = direction else { return Ok(None) };
    let theory = Surface::new(header.grid, reader.initial_gap()?).and_then(|surface| {
        let theory = Persson::of_surface(&surface, direction, &creep, pressure, Correction::YangPersson)?;
        theory.sweep(&velocities)
    });
    // A gap that the theory does not know (flat, or open for ever in places) has no curve.
    Ok(theory.ok())
}

/// The name of its curve. The theory knows neither hardness nor flash temperature.
pub(crate) fn name_of_theory(reader: &Reader) -> Result<&'static str, StoreError> {
    let is_capped = reader.series("capped_area")?.iter().any(|area| *area > 0.0);
    let is_warmed = reader.scalars().iter().any(|series| series.name == Quantity::MaterialTemperature.name());
    Ok(match (is_capped, is_warmed) {
        (false, false) => "Persson's theory",
        (true, false) => "Persson's theory, without the hardness",
        (false, true) => "Persson's theory, cold",
        (true, true) => "Persson's theory, cold, without the hardness",
    })
}
