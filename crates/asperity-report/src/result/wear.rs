//! The running-in curve: what wear does to the surfaces, over the sliding distance, by slip over the cycles.

use asperity::quantities::Quantity;
use asperity_io::answer::wear_course;
use asperity_io::readable::quantity;
use asperity_io::store::{Reader, StoreError};

use super::evolution::shown;
use super::rows::is_logarithmic;
use super::{Options, PlotError};
use crate::figure::{Axis, Curves, Figure, Series, Style};

/// ", after 6023 cycles" at a stored instant, for captions; empty where nothing wears.
pub(super) fn so_far(reader: &Reader, index: usize) -> Result<String, StoreError> {
    if !reader.header().wears() {
        return Ok(String::new());
    }
    let (course, _, unit) = wear_course(reader)?;
    let gone = course.get(reader.field_steps()[index]).copied().unwrap_or(f64::NAN);
    Ok(match unit {
        "1" => format!(", after {} cycles", quantity(gone, "")),
        unit => format!(", after {} of sliding", quantity(gone, unit)),
    })
}

pub(super) fn wear(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    if !reader.header().wears() {
        return Err(PlotError::Refused(format!(
            "the surfaces of {} do not wear; give its case a table [wear]",
            reader.path().display()
        )));
    }
    let grid = &reader.header().grid;
    let kept = shown(reader, options)?;
    let pick = |values: &[f64]| kept.iter().filter_map(|row| values.get(*row).copied()).collect::<Vec<f64>>();
    let (x, label, unit) = wear_course(reader)?;
    let axis = (label, if unit == "1" { "" } else { unit });
    let x = pick(&x);
    let is_log = options.log.unwrap_or(is_logarithmic(&x, asperity::Axis::Time));
    let across = || if is_log { Axis::log(axis.0, axis.1) } else { Axis::linear(axis.0, axis.1) };
    let line = |name: &str, series: &str| -> Result<Series, StoreError> {
        Ok(Series::new(name, Style::Line, &x, pick(&reader.series(series)?)))
    };
    let of = |title: &str, label: &str, unit: &'static str| {
        Curves::new(title, across(), Axis::linear(label, unit))
    };
    let quantity = |name: &str, own: Quantity| line(name, own.name());
    let on_line = grid.is_line();
    let [title, label] =
        if on_line { ["Worn area of the section", "area"] } else { ["Worn volume", "volume"] };
    let has_track =
        reader.scalars().iter().any(|series| series.name == Quantity::CounterbodyWearVolume.name());
    let mut volume = of(title, label, grid.units("m3"))
        .with(quantity(if has_track { "all" } else { "" }, Quantity::WearVolume)?);
    if has_track {
        volume = volume.with(quantity("counterbody", Quantity::CounterbodyWearVolume)?);
    }
    let depth = of("Largest worn depth", "depth", "m").with(quantity("", Quantity::WearDepthMax)?);
    let roughness = of("Roughness of the gap", "Sq", "m").with(quantity("", Quantity::WornRoughness)?);
    let area = of("Contact", "contact over nominal area", "").with(line("", "contact_fraction")?);
    let pressure = Series::new("mean over the contact", Style::Line, &x, pick(&reader.contact_pressures()?));
    let pressure = of("Pressure", "pressure", "Pa").with(line("largest", "max_pressure")?).with(pressure);
    Ok(Figure::new("").with(volume).with(depth).with(area).with(pressure).with(roughness))
}
