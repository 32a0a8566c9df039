//! Units in text, as attributes of arrays have them.

use asperity_io::quantity::unit::Unit;
use asperity_io::readable::shown;
use pyo3::prelude::*;

use crate::error::Answer;

/// What a number in the unit `text` is times in the SI unit `wanted`; None where the two differ in dimension.
#[pyfunction]
pub fn unit_factor(text: &str, wanted: &str) -> Answer<Option<f64>> {
    let [given, wanted] = [text, wanted].map(Unit::parse);
    let (given, wanted) = (given?, wanted?);
    let scale = |unit: &Unit| (unit.exponent, unit.numerator / unit.denominator);
    let ((exponent, factor), (base, of)) = (scale(&given), scale(&wanted));
    // A power of ten is read as text, so that a micrometre is the very number 1e-6.
    let decimal: f64 = format!("1e{}", exponent - base).parse().unwrap_or(f64::NAN);
    Ok((given.powers == wanted.powers).then_some(factor / of * decimal))
}

/// Factor and text of the unit, with its prefix, that suits numbers up to `largest` in the SI unit `unit`.
#[pyfunction]
pub fn readable_unit(unit: &str, largest: f64) -> (f64, String) {
    let suited = shown(unit, largest);
    (suited.factor, suited.text)
}
