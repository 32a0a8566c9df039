//! The sweeps of a file as isotherms, which shifts are estimated from.

use asperity::material::{Abscissa, Isotherm, Shift};

use super::error::{CurveError, Remedy, Result, fault};
use super::sweeps::SAME_TEMPERATURE;
use super::{Curves, Kind, Sweep};

/// The temperature of the shift factor that belongs to a sweep: chambers hold it to about a kelvin. A row of a `ramp` has its own, up to
/// the rounding of °C to K.
pub(super) fn snap(temperature: &mut f64, points: &[(f64, f64)], ramp: bool) {
    let same = if ramp { 1e-9 } else { SAME_TEMPERATURE };
    let nearest = points.iter().map(|point| point.0).min_by(|a, b| {
        let away = |kelvin: f64| (kelvin - *temperature).abs();
        away(*a).total_cmp(&away(*b))
    });
    if let Some(kelvin) = nearest.filter(|kelvin| (kelvin - *temperature).abs() <= same) {
        *temperature = kelvin;
    }
}

/// A fault of the isotherms, with the line of the point that it names.
pub(super) fn at_isotherm(curves: &Curves, error: &asperity::Error) -> CurveError {
    let message = error.to_string();
    let sweep = curves.sweeps.iter().find(|sweep| {
        sweep.temperature.is_some_and(|kelvin| {
            message.contains(&format!("isotherm at {} K", (100.0 * kelvin).round() / 100.0))
        })
    });
    let line = sweep.and_then(|sweep| sweep.lines.get(point(&message)?.checked_sub(1)?));
    fault(message).at(line.copied())
}

/// The sweeps as isotherms, at the temperatures of the shift factors of a table.
pub(super) fn shifted_by(curves: &Curves, shift: &Shift) -> Vec<Isotherm> {
    let mut isotherms = isotherms(curves);
    if let Shift::Table { points } = shift {
        let ramp = curves.is_ramp();
        isotherms.iter_mut().for_each(|isotherm| snap(&mut isotherm.temperature, points, ramp));
    }
    isotherms
}

/// Refuses to estimate `what` from the rows of a temperature ramp: no two of them overlap.
pub(super) fn held(curves: &Curves, what: &str) -> Result<()> {
    match curves.is_over_temperature() {
        false => Ok(()),
        true => Err(fault(format!(
            "the temperature changes from row to row, a ramp; {what} can be estimated only from sweeps over several frequencies at held \
             temperatures, which overlap"
        ))
        .remedy(Remedy::KnownShift)),
    }
}

pub(super) fn isotherms(curves: &Curves) -> Vec<Isotherm> {
    let isotherm = |sweep: &Sweep| {
        let temperature = sweep.temperature?;
        Some(Isotherm { temperature, x: sweep.x.clone(), curves: sweep.curves.clone() })
    };
    curves.sweeps.iter().filter_map(isotherm).collect()
}

pub(super) fn abscissa(kind: Kind) -> Abscissa {
    match kind {
        Kind::Dma => Abscissa::Frequency,
        Kind::Relaxation | Kind::Creep => Abscissa::Time,
    }
}

/// The number in "of point 31" or "point 31 of".
pub(super) fn point(message: &str) -> Option<usize> {
    let (_, rest) = message.split_once("point ")?;
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    digits.parse().ok()
}
