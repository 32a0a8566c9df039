//! Units of columns as programs write them, and numbers in SI.

use std::borrow::Cow;
use std::f64::consts::TAU;

use asperity::finding::celsius_meant;

use super::role::{self, Role};
use crate::quantity::range::Finite;
use crate::quantity::unit::Unit;
use crate::quantity::{Dimension, Prescribed, QuantityError, Temperature, dimension};

/// A unit of instruments with the capital letters and the words of the SI: "MPA", "Mpa" are MPa, "rad/sec" is rad/s. "mpa" may be
/// milli- or megapascal and stays.
pub(super) fn spelled(unit: &str) -> Cow<'_, str> {
    let lower = unit.to_lowercase();
    let known = match lower.as_str() {
        "pa" => "Pa",
        "hpa" => "hPa",
        "kpa" => "kPa",
        "mpa" if unit.starts_with('M') => "MPa",
        "gpa" => "GPa",
        "psi" => "psi",
        "hz" => "Hz",
        "khz" => "kHz",
        "mhz" if unit == "MHZ" => "MHz",
        "rad" | "radian" | "radians" => "rad",
        "mrad" if unit.starts_with('m') => "mrad",
        _ => {
            let Some((angle, time)) = lower.split_once('/') else { return Cow::Borrowed(unit) };
            let time = matches!(time.trim(), "s" | "sec" | "second" | "seconds");
            match angle.trim() {
                "rad" | "rads" | "radian" | "radians" if time => "rad/s",
                "mrad" if time && unit.starts_with('m') => "mrad/s",
                _ => return Cow::Borrowed(unit),
            }
        }
    };
    Cow::Borrowed(known)
}

/// A unit as programs write it in the way that it is read here.
pub(super) fn tidy(role: Role, name: &str, unit: &str) -> String {
    let unit = &*spelled(unit);
    let bare = role::bare(unit);
    let tidied = match role {
        _ if unit == "-" => "",
        Role::Temperature
            if matches!(
                bare.as_str(),
                "c" | "âc" | "oc" | "degc" | "celsius" | "degreec" | "degreesc" | "gradc" | "degcelsius"
            ) =>
        {
            "°C"
        }
        Role::Temperature if matches!(bare.as_str(), "k" | "kelvin") => "K",
        Role::Temperature if matches!(bare.as_str(), "f" | "degf" | "fahrenheit" | "degreesf" | "gradf") => {
            "°F"
        }
        Role::Frequency if matches!(bare.as_str(), "hz" | "hertz" | "cps" | "cycless" | "cyclessec") => "Hz",
        // Angular frequencies in 1/s are those in rad/s.
        Role::Frequency if matches!(unit, "1/s" | "s^-1" | "s-1") && is_angular(name) => "rad/s",
        Role::ComplexViscosity | Role::RealViscosity | Role::ImaginaryViscosity if bare == "pas" => "Pa s",
        Role::ComplexViscosity | Role::RealViscosity | Role::ImaginaryViscosity if bare == "mpas" => {
            // "mPa·s" and "MPa·s" differ by their first letter.
            if unit.starts_with('m') { "mPa s" } else { "MPa s" }
        }
        Role::Phase
            if matches!(unit, "°" | "º")
                || matches!(bare.as_str(), "deg" | "degree" | "degrees" | "grad") =>
        {
            "deg"
        }
        Role::Time => match bare.as_str() {
            "sec" | "secs" | "second" | "seconds" | "sek" | "sekunde" | "sekunden" | "secondes" => "s",
            "min" | "mins" | "minute" | "minutes" | "minuten" => "min",
            "hr" | "hrs" | "hour" | "hours" | "std" | "stunde" | "stunden" | "heure" | "heures" => "h",
            "days" | "tag" | "tage" | "jour" | "jours" => "d",
            "msec" | "millisecond" | "milliseconds" | "millisekunden" => "ms",
            _ => unit,
        },
        _ => unit,
    };
    tidied.to_owned()
}

/// Whether the name of a column says that it holds angular frequencies.
pub(super) fn is_angular(name: &str) -> bool {
    let name = role::bare(name);
    name == "w"
        || ["ang", "omega", "ω", "kreis", "winkel", "reducedang", "pulsation", "fréquenceang"]
            .iter()
            .any(|start| name.starts_with(start))
}

/// The numbers in SI, or the row and why not.
pub(super) fn convert(
    role: Role,
    unit: &str,
    numbers: Vec<f64>,
) -> Result<Vec<f64>, (Option<usize>, String)> {
    let factor = match role {
        Role::Temperature => {
            let coldest = numbers.iter().copied().fold(f64::INFINITY, f64::min);
            if unit.is_empty() && celsius_meant(coldest).is_some() {
                let why = format!("has no unit, and {coldest} is hardly a temperature in K: give °C or K");
                return Err((None, why));
            }
            let rows = numbers.iter().enumerate();
            return rows.map(|(row, value)| kelvin(*value, unit).map_err(|why| (Some(row), why))).collect();
        }
        Role::Set => Ok(1.0),
        Role::Phase => degrees(unit, &numbers),
        Role::Frequency => frequency(unit),
        Role::Deflection if unit == "V" => Ok(1.0),
        Role::Deflection if unit == "mV" => Ok(1e-3),
        _ => scale(role.si(), unit),
    };
    match factor {
        Ok(factor) => Ok(numbers.into_iter().map(|value| factor * value).collect()),
        Err(why) => Err((None, why)),
    }
}

/// Whether a deflection is measured in volts.
pub(super) fn is_voltage(unit: &str) -> bool {
    matches!(unit, "V" | "mV")
}

/// The unit in which numbers are taken that name none.
pub(super) fn taken(role: Role) -> &'static str {
    match role {
        Role::Phase => "deg", // as `degrees` has it
        _ => role.si(),
    }
}

/// A temperature \[K\], or why it is none.
pub(super) fn kelvin(value: f64, unit: &str) -> Result<f64, String> {
    Temperature::from_unit(value, unit)
        .map(Temperature::get)
        .map_err(|error| error.help.unwrap_or_else(|| format!("{value} must be {}", error.expected)))
}

/// One unit in the SI unit of its dimension.
fn scale(si: &str, unit: &str) -> Result<f64, String> {
    let one = Prescribed::Text(format!("1 {unit}"));
    dimension::resolve::<Finite>(si, &one).map_err(|error| error.help.unwrap_or(error.expected))
}

/// Radians of one unit of a phase angle, which is at most a right angle.
fn degrees(unit: &str, numbers: &[f64]) -> Result<f64, String> {
    let most = numbers.iter().copied().fold(0.0, f64::max);
    match unit {
        "deg" => Ok(std::f64::consts::PI / 180.0),
        "" if most > std::f64::consts::FRAC_PI_2 => Ok(std::f64::consts::PI / 180.0),
        "rad" => Ok(1.0),
        "mrad" => Ok(1e-3),
        "" => Err("has no unit: give deg or rad".to_owned()),
        _ => Err(format!("\"{unit}\" is not a unit of an angle (deg, rad, mrad)")),
    }
}

/// rad/s of one unit: the unit must say whether it counts cycles or radians.
fn frequency(unit: &str) -> Result<f64, String> {
    let radians = unit.contains("rad");
    if !radians && !unit.contains("Hz") {
        return Err(match unit {
            "" => "has no unit: give Hz (cycles per second) or rad/s (radians per second)".to_owned(),
            _ => format!("\"{unit}\" may mean cycles (Hz) or radians (rad/s)"),
        });
    }
    let (unit, milli) =
        unit.strip_prefix("mrad").map_or((unit.to_owned(), 1.0), |rest| (format!("rad{rest}"), 1e-3));
    let parsed = Unit::parse(&unit.replace("rad", "1"));
    match parsed {
        Ok(parsed) if parsed.powers == dimension::Frequency::POWERS => {
            Ok(if radians { milli } else { TAU } * parsed.scale())
        }
        _ => Err(format!("\"{unit}\" is not a unit of frequency (Hz, kHz, rad/s)")),
    }
}

/// "0.1 Hz" or "2 rad/s" as angular frequency \[rad/s\], greater than 0.
///
/// # Errors
/// [`QuantityError`] for another dimension, or a unit that does not tell cycles from radians.
pub fn angular_frequency(text: &str) -> Result<f64, QuantityError> {
    let expected = || QuantityError {
        code: crate::Code::WrongUnit,
        expected: "a frequency greater than 0, such as \"0.1 Hz\" or \"2 rad/s\"".to_owned(),
        help: None,
    };
    let text = text.trim();
    let digits = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E');
    let end = text.find(|c: char| !digits(c)).unwrap_or(text.len());
    let value: f64 = text[..end].parse().map_err(|_| expected())?;
    let factor =
        frequency(text[end..].trim()).map_err(|help| QuantityError { help: Some(help), ..expected() })?;
    match value.is_finite() && value > 0.0 {
        true => Ok(factor * value),
        false => Err(expected()),
    }
}
