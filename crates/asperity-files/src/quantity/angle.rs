//! Angles: text with its unit, "30 deg" or "0.5 rad". Of bare numbers only 0 is accepted: 45 would be taken for degrees by some and for
//! radians by others.

use std::f64::consts::PI;
use std::str::FromStr;

use super::QuantityError;
use super::scalar::{Scalar, deserialize, schema};
use crate::Code;

/// An angle \[rad\].
///
/// ```
/// use asperity_files::quantity::Angle;
/// let angle: Angle = "30 deg".parse()?;
/// assert!((angle.get() - std::f64::consts::PI / 6.0).abs() < 1e-15);
/// # Ok::<(), asperity_files::quantity::QuantityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle(f64);

const EXPECTED: &str = "an angle such as \"30 deg\" or \"0.5 rad\"";

impl Angle {
    /// The angle \[rad\].
    pub fn get(self) -> f64 {
        self.0
    }

    fn new(radians: f64) -> Result<Self, QuantityError> {
        if radians.is_finite() { Ok(Angle(radians)) } else { Err(Angle::out_of_range()) }
    }

    fn no_number(text: &str) -> QuantityError {
        let help = format!("{text:?} is not a number with one of the units deg, rad, mrad");
        QuantityError { code: Code::WrongUnit, expected: EXPECTED.into(), help: Some(help) }
    }

    /// A number without a unit.
    fn bare(number: f64) -> Result<Self, QuantityError> {
        if number == 0.0 {
            return Ok(Angle(number));
        }
        let help = format!("write the unit: \"{number} deg\" or \"{number} rad\"");
        Err(QuantityError { code: Code::WrongUnit, expected: EXPECTED.into(), help: Some(help) })
    }
}

impl FromStr for Angle {
    type Err = QuantityError;

    fn from_str(text: &str) -> Result<Self, QuantityError> {
        let text = text.trim();
        const UNITS: [(&str, f64); 4] =
            [("deg", PI / 180.0), ("\u{b0}", PI / 180.0), ("mrad", 1e-3), ("rad", 1.0)];
        let known = UNITS.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?, *factor)));
        let Some((number, factor)) = known else {
            return text.parse::<f64>().map_or_else(|_| Err(Angle::no_number(text)), Angle::bare);
        };
        let number = number.trim_end().parse::<f64>().map_err(|_| Angle::no_number(text))?;
        Angle::new(number * factor)
    }
}

impl Scalar for Angle {
    fn expected() -> String {
        EXPECTED.to_owned()
    }

    fn from_text(text: &str) -> Result<Self, QuantityError> {
        text.parse()
    }

    fn from_number(value: f64) -> Result<Self, QuantityError> {
        Angle::bare(value)
    }
}

deserialize!(Angle);

schema!(Angle, "Angle", {
    "description": "An angle: text with its unit (deg, rad, mrad), or 0.",
    "anyOf": [{ "type": "string" }, { "const": 0 }],
    "examples": ["30 deg"],
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_and_radians() {
        for (text, radians) in
            [("180 deg", PI), ("90\u{b0}", PI / 2.0), ("0.5 rad", 0.5), ("-2 rad", -2.0), ("0", 0.0)]
        {
            assert!((text.parse::<Angle>().unwrap().get() - radians).abs() < 1e-15, "{text}");
        }
        for text in ["", "deg", "3 m", "inf", "nan rad", "45", "-2"] {
            let error = text.parse::<Angle>().unwrap_err();
            assert!(error.to_string().contains("30 deg"), "{text}: {error}");
        }
    }
}
