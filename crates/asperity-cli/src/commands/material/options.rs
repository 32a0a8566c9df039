//! What is said on the command line about measured data and their fit.

use std::collections::BTreeMap;

use asperity::finding::celsius_meant;
use asperity::material::{FitOptions, Shift};
use asperity_io::curve::{
    Column, Columns, CurveError, Curves, Kind, Role, ShiftRequest, VerticalRequest, VerticalWord, Words,
    angular_frequency, read_shift_table,
};
use asperity_io::quantity::{
    Expansion, MolarEnergy, Number, Temperature, TemperatureDifference, Time, range,
};

use crate::args::{Data, Fit};
use crate::failure::{Failure, refuse};
use crate::input::read;

/// A fault of a file, with what to do in the words of the command.
pub fn refused(error: CurveError) -> Failure {
    Failure::input(error.told(Words::Command))
}

/// The measured data of a file.
pub fn curves(path: &std::path::Path, data: &Data) -> Result<Curves, Failure> {
    let kind = match data.kind {
        Some(kind) => kind,
        None => Curves::kind_of(path, data.sheet.as_deref()).map_err(refused)?,
    };
    let (sheet, segment) = (data.sheet.clone(), data.segment);
    let said = Columns { sheet, segment, ..columns(&data.column, &data.unit)? };
    Curves::read(path, kind, &said).map_err(refused)
}

pub fn options(args: &Fit) -> FitOptions {
    let default = FitOptions::default();
    FitOptions {
        per_decade: args.per_decade.unwrap_or(default.per_decade),
        margin: args.margin.unwrap_or(default.margin),
        limit: args.max_misfit.map_or(default.limit, Number::get),
        max_terms: args.max_terms.unwrap_or(default.max_terms),
        long_time: args.long_time,
        misfit: args.misfit.map(Number::get),
        moduli: args.fit,
        loss_weight: args.loss_weight.unwrap_or(default.loss_weight),
    }
}

/// The columns and units that are told.
pub fn columns(columns: &[String], units: &[String]) -> Result<Columns, Failure> {
    let column = |text: String| text.parse().map_or_else(|_| Column::Name(text), Column::Number);
    let columns = pairs("--column", columns)?.into_iter().map(|(role, text)| (role, column(text))).collect();
    Ok(Columns { columns, units: pairs("--unit", units)?, ..Columns::default() })
}

/// "frequency=1", "storage=E' [MPa]".
fn pairs(option: &str, texts: &[String]) -> Result<BTreeMap<Role, String>, Failure> {
    let pair = |text: &String| {
        let (role, value) = text.split_once('=').ok_or_else(|| {
            Failure::input(format!("{option} is \"{text}\", but must be QUANTITY=..., e.g. {option} time=1"))
        })?;
        let role = role.trim().parse::<Role>().map_err(Failure::about(option))?;
        Ok((role, value.trim().to_owned()))
    };
    let mut pairs = BTreeMap::new();
    for (role, value) in texts.iter().map(pair).collect::<Result<Vec<_>, Failure>>()? {
        if let Some(earlier) = pairs.insert(role, value) {
            let name = role.name();
            refuse!(
                "{option} is given twice for {name}, first \"{earlier}\"; give it once for each quantity"
            );
        }
    }
    Ok(pairs)
}

pub fn shift(args: &Fit) -> Result<ShiftRequest, Failure> {
    if let Some(text) = &args.wlf {
        let [c1, c2, reference] =
            split(text, "--wlf", "c1, c2 and the reference, e.g. --wlf '8.86, 101.6 K, 20 °C'")?;
        let shift = Shift::Wlf {
            c1: read::<Number<range::Positive>>("c1 of --wlf", c1)?.get(),
            c2: read::<TemperatureDifference<range::Positive>>("c2 of --wlf", c2)?.get(),
            reference: temperature("reference of --wlf", reference)?,
        };
        return Ok(ShiftRequest::Given(shift));
    }
    if let Some(text) = &args.arrhenius {
        let wanted = "the energy and the reference, e.g. --arrhenius '120 kJ/mol, 20 °C'";
        let [energy, reference] = split(text, "--arrhenius", wanted)?;
        let shift = Shift::Arrhenius {
            activation_energy: read::<MolarEnergy<range::Positive>>("energy of --arrhenius", energy)?.get(),
            reference: temperature("reference of --arrhenius", reference)?,
        };
        return Ok(ShiftRequest::Given(shift));
    }
    if let Some(path) = &args.shift_table {
        return Ok(ShiftRequest::Given(read_shift_table(path).map_err(refused)?));
    }
    match &args.estimate_shift {
        Some(text) => Ok(ShiftRequest::Estimate(temperature("--estimate-shift", text)?)),
        None => Ok(ShiftRequest::None),
    }
}

pub fn vertical(args: &Fit) -> Result<VerticalRequest, Failure> {
    match (args.vertical, args.expansion) {
        (None, None) => Ok(VerticalRequest::None),
        (Some(VerticalWord::Free), None) => Ok(VerticalRequest::Free),
        (Some(VerticalWord::Density), expansion) => {
            Ok(VerticalRequest::Density { expansion: expansion.map_or(0.0, Expansion::get) })
        }
        (_, Some(_)) => refuse!("--expansion goes with --vertical density"),
    }
}

/// "0.1 s, 100 s" or "0.1 Hz, 100 Hz" in s or rad/s.
pub fn ends(kind: Kind, text: &str) -> Result<[f64; 2], Failure> {
    let wanted = "two times or, of a dma, two frequencies, e.g. --window '0.1 s, 100 s'";
    let ends = split::<2>(text, "--window", wanted)?.map(|end| match kind {
        Kind::Dma => {
            angular_frequency(end).map_err(|error| Failure::input(format!("--window: {end} must be {error}")))
        }
        _ => read::<Time<range::Positive>>("--window", end).map(|time| time.get()),
    });
    let [first, last] = ends;
    let (first, last) = (first?, last?);
    match first < last {
        true => Ok([first, last]),
        false => refuse!("--window is \"{text}\": the second end must be greater than the first"),
    }
}

fn split<'t, const N: usize>(text: &'t str, option: &str, wanted: &str) -> Result<[&'t str; N], Failure> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    <[&str; N]>::try_from(parts)
        .map_err(|_| Failure::input(format!("{option} is \"{text}\", but must be {wanted}")))
}

/// A temperature \[K\]. A number without a unit is in kelvin; of a smaller one the unit was forgotten.
fn temperature(what: &str, text: &str) -> Result<f64, Failure> {
    let kelvin = read::<Temperature>(what, text)?.get();
    match celsius_meant(kelvin).is_some() && text.trim().parse::<f64>().is_ok() {
        true => refuse!("{what} is \"{text}\", but must have a unit: \"{text} °C\" or \"{text} K\""),
        false => Ok(kelvin),
    }
}
