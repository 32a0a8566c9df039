//! What changes over time.

use asperity::quantities::Quantity;
use asperity_io::store::{Reader, StoreError};

use super::{Options, nameless};
use crate::figure::{Axis, Curves, Figure, Series, Style};

pub(super) fn evolution(reader: &Reader, options: &Options) -> Result<Figure, StoreError> {
    let time = times(reader)?;
    let axis = || axis(reader, options);
    let line = |name: &str, series: &str| -> Result<Series, StoreError> {
        Ok(Series::new(name, Style::Line, time.clone(), reader.series(series)?))
    };
    let grid = &reader.header().grid;
    let mut area = match grid.is_line() {
        true => Curves::new("Contact length", axis(), Axis::linear("contact length", "m"))
            .with(line("", "contact_area")?),
        false => Curves::new("Contact area", axis(), Axis::linear("contact area", "m2"))
            .with(line("counted", "contact_area")?)
            .with(line("corrected", "contact_area_corrected")?),
    };
    if reader.series("capped_area")?.iter().any(|area| *area > 0.0) {
        area = area.with(line("at the hardness", "capped_area")?);
    }
    let approach = Curves::new("Approach", axis(), Axis::linear("approach", "m"));
    let load = Curves::new("Load", axis(), Axis::linear("load", grid.units("N")));
    let pressure = Curves::new("Pressure", axis(), Axis::linear("pressure", "Pa"))
        .with(line("mean", "mean_pressure")?)
        .with(line("largest", "max_pressure")?);
    Ok(Figure::new("")
        .with(area)
        .with(nameless(approach, &time, reader.series("approach")?))
        .with(nameless(load, &time, reader.series("load")?))
        .with(pressure))
}

/// The axis of the rows: time, or the velocities of a sweep.
fn axis(reader: &Reader, options: &Options) -> Axis {
    match (reader.header().is_sweep(), options.log_time) {
        (true, _) => velocities(reader),
        (false, true) => Axis::log("time", "s"),
        (false, false) => Axis::linear("time", "s"),
    }
}

/// Velocities over more than a decade have a logarithmic axis.
fn velocities(reader: &Reader) -> Axis {
    let found = reader.series("time").unwrap_or_default();
    match (found.first(), found.last()) {
        (Some(first), Some(last)) if *first > 0.0 && last / first > 5.0 => Axis::log("velocity", "m/s"),
        _ => Axis::linear("velocity", "m/s"),
    }
}

/// Friction of a contact in motion: over the velocity in a sweep, else over time.
pub(super) fn friction(reader: &Reader, options: &Options) -> Result<Figure, StoreError> {
    let rows = times(reader)?;
    let grid = &reader.header().grid;
    let line = |name: &str, series: &str| -> Result<Series, StoreError> {
        Ok(Series::new(name, Style::Line, rows.clone(), reader.series(series)?))
    };
    let has = |name: &str| reader.scalars().iter().any(|series| series.name == name);
    let total = has("friction_coefficient_total");
    let mut coefficient =
        Curves::new("Friction", axis(reader, options), Axis::linear("friction coefficient", ""));
    coefficient =
        coefficient.with(line(if total { "loss in the bulk" } else { "" }, "friction_coefficient")?);
    if total {
        coefficient = coefficient.with(line("with the shear stress", "friction_coefficient_total")?);
    }
    let side: f64 = reader.series("side_force")?.iter().fold(0.0, |most, force| force.abs().max(most));
    let along: f64 = reader.series("friction_force")?.iter().fold(0.0, |most, force| force.abs().max(most));
    let mut force = Curves::new("Forces", axis(reader, options), Axis::linear("force", grid.units("N")))
        .with(line("against motion", "friction_force")?);
    if side > 1e-3 * along {
        force = force.with(line("across it", "side_force")?);
    }
    let area = Curves::new("Contact", axis(reader, options), Axis::linear("contact over nominal area", ""));
    let mut figure = Figure::new("").with(coefficient).with(force).with(nameless(
        area,
        &rows,
        reader.series("contact_fraction")?,
    ));
    if has("dissipated_power") {
        // Over decades of velocity the power spans decades too.
        let own = match reader.header().is_sweep() {
            true => Axis::log("power lost", grid.units("W")),
            false => Axis::linear("power lost", grid.units("W")),
        };
        let power = Curves::new("Power", axis(reader, options), own);
        figure = figure.with(nameless(power, &rows, reader.series("dissipated_power")?));
    }
    Ok(figure)
}

/// A panel of quantities over time.
pub(crate) struct QuantityPanel {
    pub(crate) title: &'static str,
    pub(crate) label: &'static str,
    pub(crate) units: &'static str,
    /// Name in the legend and name of the series.
    pub(crate) lines: Vec<(&'static str, &'static str)>,
}

/// The quantities with one number per row that were asked for: one panel for all energies, one for the areas of spots,
/// one for each other.
pub(crate) fn quantity_panels(reader: &Reader) -> Vec<QuantityPanel> {
    let mut panels: Vec<QuantityPanel> = vec![];
    let scalars = reader.scalars();
    let line = reader.header().grid.is_line();
    for column in &reader.header().quantities {
        let quantity = column.quantity;
        let (title, label, line) = match quantity {
            _ if quantity.is_histogram() => continue,
            Quantity::ElasticEnergy => ("Energy", "energy", "elastic"),
            Quantity::DissipatedEnergy => ("Energy", "energy", "dissipated"),
            Quantity::FlatteningWork => ("Energy", "energy", "flattening"),
            Quantity::ExternalWork => ("Energy", "energy", "work of the load"),
            Quantity::LargestSpot if line => ("Lengths of contact spots", "length", "largest"),
            Quantity::MeanSpot if line => ("Lengths of contact spots", "length", "mean"),
            Quantity::LargestSpot => ("Areas of contact spots", "area", "largest"),
            Quantity::MeanSpot => ("Areas of contact spots", "area", "mean"),
            Quantity::ContactSpots => ("Contact spots", "number", ""),
            Quantity::ContactStiffness => ("Contact stiffness", "stiffness", ""),
            Quantity::ContactPerimeter if line => ("Ends of the contact", "number", ""),
            Quantity::ContactPerimeter => ("Perimeter of the contact", "length", ""),
            Quantity::ContactPercolation => ("Percolation", "1: x, 2: y, 3: both", "contact"),
            Quantity::GapPercolation => ("Percolation", "1: x, 2: y, 3: both", "gap"),
            Quantity::Velocity => ("Velocity", "velocity", ""),
            Quantity::SlidingDistance => ("Distance moved", "distance", ""),
            Quantity::FrictionForce => ("Friction", "force", "against motion"),
            Quantity::SideForce => ("Friction", "force", "across it"),
            Quantity::FrictionCoefficient => ("Friction coefficient", "friction coefficient", "of the bulk"),
            Quantity::FrictionCoefficientTotal => {
                ("Friction coefficient", "friction coefficient", "with the shear stress")
            }
            Quantity::FrictionUncertainty => ("Uncertainty of friction", "share of the force", ""),
            Quantity::RollingMoment => ("Rolling moment", "moment", ""),
            Quantity::DissipatedPower => ("Power lost", "power", ""),
            _ => ("Gap", "gap", "rms"),
        };
        let line = (line, quantity.name());
        // The mean gap, which every row has, beside the rms gap.
        let mean = (quantity == Quantity::RmsGap).then_some(("mean", "mean_gap"));
        match panels.iter_mut().find(|panel| panel.title == title) {
            Some(panel) => panel.lines.push(line),
            None => {
                let units =
                    scalars.iter().find(|series| series.name == quantity.name()).map_or("", |s| s.units);
                let units = if units == "1" { "" } else { units };
                panels.push(QuantityPanel {
                    title,
                    label,
                    units,
                    lines: std::iter::once(line).chain(mean).collect(),
                });
            }
        }
    }
    panels
}

pub(super) fn quantities(reader: &Reader, options: &Options) -> Result<Figure, StoreError> {
    let time = times(reader)?;
    let panels = quantity_panels(reader);
    if panels.is_empty() {
        return Err(reader.no_quantities());
    }
    let mut figure = Figure::new("");
    for panel in panels {
        let mut curves =
            Curves::new(panel.title, axis(reader, options), Axis::linear(panel.label, panel.units));
        for (name, series) in panel.lines {
            curves = curves.with(Series::new(name, Style::Line, time.clone(), reader.series(series)?));
        }
        figure = figure.with(curves);
    }
    Ok(figure)
}

pub(super) fn load_displacement(reader: &Reader) -> Result<Figure, StoreError> {
    times(reader)?;
    let panel =
        Curves::new("", Axis::linear("approach", "m"), Axis::linear("load", reader.header().grid.units("N")));
    Ok(Figure::new("").with(nameless(panel, &reader.series("approach")?, reader.series("load")?)))
}

pub(super) fn work(reader: &Reader) -> Result<Figure, StoreError> {
    let time = times(reader)?;
    let row: Vec<f64> = (0..time.len()).map(|row| row as f64).collect();
    let points = |name: &str, series: &str| -> Result<Series, StoreError> {
        Ok(Series::new(name, Style::Points, row.clone(), reader.series(series)?))
    };
    let counts = Curves::new("Work of each row", Axis::linear("row", ""), Axis::linear("number", ""))
        .with(points("iterations", "iterations")?)
        .with(points("convolutions", "convolutions")?);
    let errors = Curves::new("Error of each row", Axis::linear("row", ""), Axis::log("relative error", ""))
        .with(points("contact conditions (residual)", "residual")?)
        .with(points("pressure (certificate)", "certificate")?);
    Ok(Figure::new("").with(counts).with(errors))
}

/// Times of all rows; an error where there is none yet.
fn times(reader: &Reader) -> Result<Vec<f64>, StoreError> {
    let times = reader.series("time")?;
    if times.is_empty() { Err(reader.no_rows()) } else { Ok(times) }
}
