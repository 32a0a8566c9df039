//! What changes over time.

use asperity_io::store::{Reader, StoreError};

use super::{Options, nameless};
use crate::figure::{Axis, Curves, Figure, Series, Style};

pub(super) fn evolution(reader: &Reader, options: &Options) -> Result<Figure, StoreError> {
    let time = times(reader)?;
    let axis = || if options.log_time { Axis::log("time", "s") } else { Axis::linear("time", "s") };
    let line = |name: &str, series: &str| -> Result<Series, StoreError> {
        Ok(Series::new(name, Style::Line, time.clone(), reader.series(series)?))
    };
    let mut area = Curves::new("Contact area", axis(), Axis::linear("contact area", "m2"))
        .with(line("counted", "contact_area")?)
        .with(line("corrected", "contact_area_corrected")?);
    if reader.series("capped_area")?.iter().any(|area| *area > 0.0) {
        area = area.with(line("at the hardness", "capped_area")?);
    }
    let approach = Curves::new("Approach", axis(), Axis::linear("approach", "m"));
    let load = Curves::new("Load", axis(), Axis::linear("load", "N"));
    let pressure = Curves::new("Pressure", axis(), Axis::linear("pressure", "Pa"))
        .with(line("mean", "mean_pressure")?)
        .with(line("largest", "max_pressure")?);
    Ok(Figure::new("")
        .with(area)
        .with(nameless(approach, &time, reader.series("approach")?))
        .with(nameless(load, &time, reader.series("load")?))
        .with(pressure))
}

pub(super) fn load_displacement(reader: &Reader) -> Result<Figure, StoreError> {
    times(reader)?;
    let panel = Curves::new("", Axis::linear("approach", "m"), Axis::linear("load", "N"));
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
