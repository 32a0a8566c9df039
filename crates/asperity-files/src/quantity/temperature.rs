//! Temperatures: absolute, in kelvin, degrees Celsius or degrees Fahrenheit.
//!
//! 0 °C is 273.15 K, so the conversion is not a factor: "20 °C" is 293.15 K as a temperature, and no
//! difference of temperatures at all (those are in K).

use std::str::FromStr;

use super::UNIT;
use super::scalar::{Scalar, deserialize, schema};
use super::{Quantity, QuantityError, dimension};
use crate::Code;

/// An absolute temperature \[K\].
///
/// ```
/// use asperity_files::quantity::Temperature;
/// assert_eq!("20 °C".parse::<Temperature>()?.get(), 293.15);
/// assert_eq!("20 degC".parse::<Temperature>()?, "293.15 K".parse()?);
/// assert!("-300 °C".parse::<Temperature>().is_err());
/// # Ok::<(), asperity_files::quantity::QuantityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temperature(f64);

/// 0 °C in K.
const ICE: f64 = 273.15;
const EXPECTED: &str = "a temperature above 0 K such as \"20 °C\" or \"293.15 K\"";
/// How degrees Celsius are written.
const CELSIUS: [&str; 4] = ["°C", "℃", "degC", "ºC"];
/// How degrees Fahrenheit are written.
const FAHRENHEIT: [&str; 4] = ["°F", "℉", "degF", "ºF"];

impl Temperature {
    /// From kelvin.
    ///
    /// # Errors
    /// [`QuantityError`] where it is not finite and above 0 K.
    pub fn from_kelvin(kelvin: f64) -> Result<Self, QuantityError> {
        match kelvin.is_finite() && kelvin > 0.0 {
            true => Ok(Temperature(kelvin)),
            false => Err(error(Code::OutOfRange, None)),
        }
    }

    /// From a number of a unit's text, "K", "°C", "degC", "°F", "degF" or (in tables) "C".
    ///
    /// # Errors
    /// [`QuantityError`] for another unit, or a temperature that is not above 0 K.
    pub fn from_unit(value: f64, unit: &str) -> Result<Self, QuantityError> {
        let unit = unit.trim();
        match unit {
            "" | "K" => Temperature::from_kelvin(value),
            "C" => Temperature::from_kelvin(celsius(value)),
            _ if CELSIUS.contains(&unit) => Temperature::from_kelvin(celsius(value)),
            // 32 °F is 0 °C.
            _ if FAHRENHEIT.contains(&unit) => Temperature::from_kelvin(celsius((value - 32.0) / 1.8)),
            _ => Err(error(
                Code::WrongUnit,
                Some(format!("\"{unit}\" is not a unit of temperature; units: K, °C, °F")),
            )),
        }
    }

    /// In kelvin.
    pub fn get(self) -> f64 {
        self.0
    }
}

/// Kelvin of degrees Celsius, with the digits that were written: 20 °C is 293.15 K, not 293.14999999999998.
fn celsius(value: f64) -> f64 {
    let kelvin = value + ICE;
    // Two decimals more than a thermometer has: what lies below is the rounding of the sum.
    let tidy = (kelvin * 1e9).round() / 1e9;
    if (tidy - kelvin).abs() <= 1e-12 * kelvin.abs() { tidy } else { kelvin }
}

fn error(code: Code, help: Option<String>) -> QuantityError {
    QuantityError { code, expected: EXPECTED.to_owned(), help }
}

impl FromStr for Temperature {
    type Err = QuantityError;

    fn from_str(text: &str) -> Result<Self, QuantityError> {
        let text = text.trim();
        for unit in CELSIUS.into_iter().chain(FAHRENHEIT) {
            let Some(number) = text.strip_suffix(unit) else { continue };
            let wrong = |_| error(Code::WrongType, Some(format!("{number:?} is not a number")));
            let value: f64 = number.trim().parse().map_err(wrong)?;
            return Temperature::from_unit(value, unit);
        }
        if text.ends_with(['C', 'F']) {
            return Err(error(
                Code::WrongUnit,
                Some(
                    "write degrees Celsius as \"°C\" or \"degC\", Fahrenheit as \"°F\", or kelvin as \"K\""
                        .into(),
                ),
            ));
        }
        let kelvin = text.parse::<Quantity<dimension::TemperatureDifference>>();
        kelvin
            .map_err(|found| error(found.code, found.help))
            .and_then(|kelvin| Temperature::from_kelvin(kelvin.get()))
    }
}

impl Scalar for Temperature {
    fn expected() -> String {
        EXPECTED.to_owned()
    }

    fn from_text(text: &str) -> Result<Self, QuantityError> {
        text.parse()
    }

    fn from_number(kelvin: f64) -> Result<Self, QuantityError> {
        Temperature::from_kelvin(kelvin)
    }
}

deserialize!(Temperature);

schema!(Temperature, "Temperature", {
    "description": "An absolute temperature: text with its unit (K, °C, °F), or a bare number in K.",
    "anyOf": [
        { "type": "string", "pattern": r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)" },
        { "type": "number", "exclusiveMinimum": 0 }
    ],
    "examples": ["20 °C"],
    UNIT: "K",
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_shifted_and_kelvin_are_not() {
        for (text, kelvin) in [
            ("20 °C", 293.15),
            ("68 °F", 293.15),
            ("-40 degF", 233.15),
            ("20degC", 293.15),
            ("-40 ℃", 233.15),
            ("23.5 °C", 296.65),
            ("300 K", 300.0),
            ("300", 300.0),
            ("1e3 mK", 1.0),
        ] {
            assert_eq!(text.parse::<Temperature>().unwrap().get(), kelvin, "{text}");
        }
    }

    #[test]
    fn what_is_no_temperature_is_said() {
        for (text, words) in [
            ("-273.15 °C", "above 0 K"),
            ("0 K", "above 0 K"),
            ("20 C", "degC"),
            ("20 MPa", "is the unit of a pressure"),
            ("warm °C", "is not a number"),
            ("nan °C", "above 0 K"),
            ("", "empty"),
        ] {
            let message = text.parse::<Temperature>().unwrap_err().to_string();
            assert!(message.contains(words), "{text}: {message}");
        }
    }
}
