//! Shifts of materials, and the temperature of the run.

use asperity::material::{Shift, VerticalShift};

use super::sample::Sample;
use super::{Checks, history_file};
use crate::case::quantity::{Number, Prescribed, Temperature};
use crate::case::raw::{self, At, TemperatureHistory, Two};
use crate::case::words::number;
use crate::curve::{self, ShiftRequest, VerticalRequest, VerticalWord};

pub fn shift(checks: &mut Checks<'_, '_>, at: &At<raw::Shift>) -> Option<ShiftRequest> {
    let shift = match &at.value {
        raw::Shift::Wlf(wlf) => {
            Shift::Wlf { c1: wlf.c1.get(), c2: wlf.c2.get(), reference: wlf.reference.get() }
        }
        raw::Shift::Arrhenius(law) => {
            Shift::Arrhenius { activation_energy: law.energy.get(), reference: law.reference.get() }
        }
        raw::Shift::Table(table) => {
            let keys = [("points", table.points.is_some()), ("path", table.path.is_some())];
            checks.exactly_one(&at.span, &keys)?;
            let point = |Two(temperature, decades): &Two<Temperature, Number>| {
                (temperature.get(), decades.get() * std::f64::consts::LN_10)
            };
            match (&table.points, &table.path) {
                (_, Some(path)) => shift_table(checks, path)?,
                (points, None) => Shift::Table { points: points.iter().flatten().map(point).collect() },
            }
        }
        raw::Shift::Estimated(estimated) => return Some(ShiftRequest::Estimate(estimated.reference.get())),
    };
    checks.core(&at.span, shift.validate())?;
    Some(ShiftRequest::Given(shift))
}

/// How moduli depend on temperature, as the shift or the fit of a material says.
pub fn vertical(
    checks: &mut Checks<'_, '_>,
    shift: Option<&At<raw::Shift>>,
    fit: Option<&At<raw::Fit>>,
) -> Option<VerticalRequest> {
    let of_shift = shift.and_then(|at| at.value.vertical());
    let of_fit = fit.and_then(|at| at.value.vertical.map(|word| (at, raw::Vertical::Word(word))));
    let said = match (of_shift, of_fit) {
        (Some(_), Some((at, _))) => {
            let message = "has `vertical`, and so has `shift`, but one of them is enough".to_owned();
            checks.fault(&at.span, message, "one `vertical`", Some("leave one of them out"));
            return None;
        }
        (Some(vertical), None) => vertical.clone(),
        (None, Some((_, vertical))) => vertical,
        (None, None) => return Some(VerticalRequest::None),
    };
    Some(match said {
        raw::Vertical::Word(VerticalWord::Density) => VerticalRequest::Density { expansion: 0.0 },
        raw::Vertical::Word(VerticalWord::Free) => VerticalRequest::Free,
        raw::Vertical::Density(density) => VerticalRequest::Density { expansion: density.expansion.get() },
        raw::Vertical::Points(points) => {
            let point =
                |Two(kelvin, factor): &Two<Temperature, Number<_>>| (kelvin.get(), libm::log(factor.get()));
            VerticalRequest::Given(VerticalShift::Table { points: points.iter().map(point).collect() })
        }
    })
}

fn shift_table(checks: &mut Checks<'_, '_>, path: &At<String>) -> Option<Shift> {
    let file = checks.file(path)?;
    match curve::read_shift_table(&file) {
        Ok(shift) => Some(shift),
        Err(error) => {
            let expected = "a table of temperatures and shift factors";
            checks.fault(&path.span, error.to_string(), expected, None);
            None
        }
    }
}

/// The temperatures of the run as (time [s], temperature [K]), and the MD5 of a file that holds them.
pub struct Temperatures {
    pub points: Vec<(f64, f64)>,
    /// Path as written, and MD5.
    pub file: Option<(String, String)>,
}

/// The section [temperature]; the outer `None` is a fault.
pub fn temperatures(
    checks: &mut Checks<'_, '_>,
    raw: Option<&At<raw::Temperature>>,
    samples: &[Option<Sample>],
) -> Option<Option<Temperatures>> {
    let Some(at) = raw else { return Some(None) };
    let known = samples.iter().all(Option::is_some);
    let mut samples = samples.iter().flatten();
    if known && !samples.any(|sample| sample.shift.is_some() && sample.temperature.is_none()) {
        let message =
            "no body depends on it: none has a `shift` (without a `temperature` of its own)".to_owned();
        let help = "add shift = { model = \"wlf\", ... } to a material, or leave the section out";
        checks.fault(&at.span, message, "a material with a shift", Some(help));
        return None;
    }
    history(checks, &at.value.history).map(Some)
}

fn history(checks: &mut Checks<'_, '_>, at: &At<TemperatureHistory>) -> Option<Temperatures> {
    let points = match &at.value {
        TemperatureHistory::Constant(constant) => vec![(0.0, constant.value.value.get())],
        TemperatureHistory::Ramp(ramp) => {
            vec![(0.0, ramp.from.value.get()), (ramp.duration.get(), ramp.to.value.get())]
        }
        TemperatureHistory::Table(table) => table_points(checks, &table.points)?,
        TemperatureHistory::File(file) => return from_file(checks, &file.path),
    };
    Some(Temperatures { points, file: None })
}

fn table_points(
    checks: &mut Checks<'_, '_>,
    at: &At<Vec<At<raw::TemperaturePoint>>>,
) -> Option<Vec<(f64, f64)>> {
    let mut points: Vec<(f64, f64)> = Vec::with_capacity(at.value.len());
    let mut good = true;
    for point in &at.value {
        let Two(time, temperature) = &point.value;
        let time = time.get();
        let twice = points.len() >= 2 && points[points.len() - 2].0 == time;
        match points.last() {
            None if time != 0.0 => {
                good = false;
                checks.wrong(&point.span, "a point at 0 s", Some("give the temperature at the start"));
            }
            Some((before, _)) if time < *before => {
                good = false;
                let expected = format!("a point at {} s or later, as the point before it", number(*before));
                checks.wrong(&point.span, &expected, Some("list the points in order of time"));
            }
            Some(_) if twice => {
                good = false;
                let expected = "a later point: a jump has one temperature before and one after";
                checks.wrong(&point.span, expected, None);
            }
            _ => {}
        }
        points.push((time, temperature.value.get()));
    }
    if points.is_empty() {
        checks.wrong(&at.span, "a list of one point at least", None);
    }
    (good && !points.is_empty()).then_some(points)
}

fn from_file(checks: &mut Checks<'_, '_>, path: &At<String>) -> Option<Temperatures> {
    let full = checks.file(path)?;
    let kelvin = |value: &Prescribed| match value {
        Prescribed::Number(kelvin) => Temperature::from_kelvin(*kelvin),
        Prescribed::Text(text) => text.parse(),
    };
    match history_file::read(&full, |value| kelvin(value).map(Temperature::get)) {
        Ok(read) => Some(Temperatures { points: read.points, file: Some((path.value.clone(), read.digest)) }),
        Err(reason) => {
            let message = format!("{}: {reason}", full.display());
            checks.fault(&path.span, message, "a file of two columns, time and temperature", None);
            None
        }
    }
}
