//! Quantities as users write them: a number with its unit in text, or a bare number in SI.
//!
//! `"0.5 mm"`, `"300 MPa"`, `"10 s"`, `"1e-3 1/MPa"`, `"2 kHz"`; `0.5` is 0.5 of the SI unit. The type of a
//! key says its dimension and its range, so that a wrong unit or sign is found where it stands.
//!
//! ```
//! use asperity_files::quantity::{Length, Pressure};
//!
//! assert_eq!("0.3 mm".parse::<Length>()?.get(), 0.3e-3); // metres, to the last bit
//! assert_eq!("2 N/mm^2".parse::<Pressure>()?.get(), 2e6); // pascals
//! assert!("300 m".parse::<Pressure>().unwrap_err().to_string().contains("a length"));
//! # Ok::<(), asperity_files::quantity::QuantityError>(())
//! ```

mod angle;
mod decimal;
pub mod range;
pub mod scalar;
mod serial;
mod temperature;
pub mod unit;

use std::fmt;
use std::marker::PhantomData;
use std::str::FromStr;

use crate::Code;

pub use angle::Angle;
use decimal::Decimal;
use range::{Finite, Range};
pub use serial::{Label, Prescribed, Signed, UNIT, Whole};
pub use temperature::Temperature;
use unit::{Powers, Unit};

/// A physical dimension: its SI unit and the words of its error messages.
pub trait Dimension {
    /// Name with article ("a length").
    const NAME: &'static str;
    /// Name in the schema ("Length").
    const TITLE: &'static str;
    /// SI unit ("m"); empty for a pure number.
    const SI: &'static str;
    /// Units that users have, for messages and the schema.
    const UNITS: &'static str;
    /// How it is written.
    const EXAMPLE: &'static str;
    /// Powers of metre, kilogram, second, kelvin and mole.
    const POWERS: Powers;
}

/// A value in SI of dimension `D` inside the range `R`.
#[derive(Clone, Copy, PartialEq)]
pub struct Quantity<D, R = Finite> {
    value: f64,
    kind: PhantomData<fn() -> (D, R)>,
}

/// The dimensions that a case file knows, and their quantities: name with article, SI unit, units that users have, an example,
/// powers of metre, kilogram, second, kelvin and mole.
macro_rules! dimensions {
    ($($(#[$doc:meta])* $type:ident = $name:literal, $si:literal, $units:literal, $example:literal, $powers:expr;)*) => {
        /// The dimensions that a case file knows.
        pub mod dimension {
            use super::{Dimension, Powers, Prescribed, Quantity, QuantityError, Range};

            $(
                #[doc = concat!("The dimension of ", $name, ".")]
                #[derive(Clone, Copy, Debug, PartialEq)]
                pub struct $type;

                impl Dimension for $type {
                    const NAME: &'static str = $name;
                    const TITLE: &'static str = stringify!($type);
                    const SI: &'static str = $si;
                    const UNITS: &'static str = $units;
                    const EXAMPLE: &'static str = $example;
                    const POWERS: Powers = $powers;
                }
            )*

            /// The SI unit of the dimension with these powers, where it has one here; of several that of the one which has a unit
            /// of this text.
            pub(super) fn unit(powers: Powers, text: &str) -> Option<&'static str> {
                let plain = |unit: &str| unit.replace(['^', ' '], "");
                let known = || [$(($type::POWERS, $type::SI, $type::UNITS)),*].into_iter().filter(|known| known.0 == powers);
                let is_meant = |units: &str| units.split(',').any(|unit| plain(unit) == plain(text));
                known().find(|known| is_meant(known.1) || is_meant(known.2)).or(known().next()).map(|known| known.1)
            }

            /// The value \[SI\] of a quantity whose SI unit is `unit`; of a unit that is not known here that of a number.
            ///
            /// # Errors
            /// [`QuantityError`] for another dimension, or a text that is no quantity.
            pub fn resolve<R: Range>(unit: &str, value: &Prescribed) -> Result<f64, QuantityError> {
                $(if unit == $type::SI {
                    return value.resolve::<$type, R>().map(Quantity::get);
                })*
                value.resolve::<Number, R>().map(Quantity::get)
            }

            /// The name of the dimension with these powers, where it has one here.
            pub(super) fn name(powers: Powers) -> Option<&'static str> {
                [$(($type::POWERS, $name)),*].into_iter().find(|known| known.0 == powers).map(|known| known.1)
            }
        }

        $($(#[$doc])* pub type $type<R = Finite> = Quantity<dimension::$type, R>;)*
    };
}

dimensions! {
    /// A length \[m\].
    Length = "a length", "m", "nm, um, mm, m", "0.5 mm", [1, 0, 0, 0, 0];
    /// A pressure, modulus or hardness \[Pa\].
    Pressure = "a pressure", "Pa", "Pa, kPa, MPa, GPa, bar, N/mm^2", "300 MPa", [-1, 1, -2, 0, 0];
    /// A time \[s\].
    Time = "a time", "s", "us, ms, s, min, h, day", "10 s", [0, 0, 1, 0, 0];
    /// A force \[N\].
    Force = "a force", "N", "nN, uN, mN, N, kN", "0.5 N", [1, 1, -2, 0, 0];
    /// A force per length \[N/m\].
    ForcePerLength = "a force per length", "N/m", "N/m, N/mm, kN/m", "2 N/mm", [0, 1, -2, 0, 0];
    /// An area \[m²\].
    Area = "an area", "m2", "um^2, mm^2, m^2", "1 mm^2", [2, 0, 0, 0, 0];
    /// A volume \[m³\].
    Volume = "a volume", "m3", "um^3, mm^3, m^3", "1 mm^3", [3, 0, 0, 0, 0];
    /// A volume per time \[m³/s\].
    VolumePerTime = "a volume per time", "m3/s", "um^3/s, mm^3/s, ml/min, m^3/s", "1 mm^3/s", [3, 0, -1, 0, 0];
    /// An energy \[J\].
    Energy = "an energy", "J", "uJ, mJ, J", "1 mJ", [2, 1, -2, 0, 0];
    /// A moment \[N m\].
    Moment = "a moment", "N m", "N mm, N m", "1 N mm", [2, 1, -2, 0, 0];
    /// A power \[W\].
    Power = "a power", "W", "mW, W, kW", "1 mW", [2, 1, -3, 0, 0];
    /// A power per length \[W/m\].
    PowerPerLength = "a power per length", "W/m", "W/m, W/mm", "1 W/m", [1, 1, -3, 0, 0];
    /// A velocity \[m/s\].
    Velocity = "a velocity", "m/s", "um/s, mm/s, m/s, km/h", "10 mm/s", [1, 0, -1, 0, 0];
    /// A compliance \[1/Pa\].
    Compliance = "a compliance", "1/Pa", "1/Pa, 1/MPa, 1/GPa", "1e-3 1/MPa", [1, -1, 2, 0, 0];
    /// A frequency \[Hz\].
    Frequency = "a frequency", "Hz", "Hz, kHz, 1/s, 1/min", "2 kHz", [0, 0, -1, 0, 0];
    /// A fluidity, the inverse of a viscosity \[1/(Pa s)\].
    Fluidity = "a fluidity", "1/(Pa s)", "1/(Pa s), 1/(MPa s)", "1e-12 1/(Pa s)", [1, -1, 1, 0, 0];
    /// A viscosity \[Pa s\].
    Viscosity = "a viscosity", "Pa s", "Pa s, mPa s, MPa s", "1 mPa s", [-1, 1, -1, 0, 0];
    /// A molar mass \[kg/mol\].
    MolarMass = "a molar mass", "kg/mol", "g/mol, kg/mol", "28.96 g/mol", [0, 1, 0, 0, -1];
    /// A difference of temperatures \[K\]; a temperature itself is a [`Temperature`].
    TemperatureDifference = "a difference of temperatures", "K", "K, mK", "51.6 K", [0, 0, 0, 1, 0];
    /// An expansion per kelvin \[1/K\].
    Expansion = "an expansion per kelvin", "1/K", "1/K", "6e-4 1/K", [0, 0, 0, -1, 0];
    /// An energy per mole \[J/mol\].
    MolarEnergy = "an energy per mole", "J/mol", "J/mol, kJ/mol, kcal/mol", "120 kJ/mol", [2, 1, -2, 0, -1];
    /// An energy per area, which is a force per length \[J/m²\].
    EnergyPerArea = "an energy per area", "J/m2", "mJ/m^2, J/m^2", "50 mJ/m2", [0, 1, -2, 0, 0];
    /// A thermal conductivity \[W/(m K)\].
    Conductivity = "a thermal conductivity", "W/(m K)", "W/(m K), W/m/K, mW/(m K)", "0.3 W/(m K)", [1, 1, -3, -1, 0];
    /// A thermal diffusivity \[m²/s\].
    Diffusivity = "a thermal diffusivity", "m2/s", "m^2/s, mm^2/s, cm^2/s", "1e-7 m2/s", [2, 0, -1, 0, 0];
    /// A wear coefficient, worn volume over load and sliding distance \[m²/N\].
    WearCoefficient = "a wear coefficient", "m2/N", "m^2/N, mm^3/(N m)", "1e-15 m2/N", [1, -1, 2, 0, 0];
    /// A pure number.
    Number = "a number", "", "none, or %", "0.38", [0, 0, 0, 0, 0];
}

/// Why a text or a number is not the quantity that is wanted there.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityError {
    /// What kind of fault it is.
    pub code: Code,
    /// What is accepted, with an example ("a length such as "0.5 mm"").
    pub expected: String,
    /// What is wrong with the value, where more can be said.
    pub help: Option<String>,
}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.expected)?;
        match &self.help {
            Some(help) => write!(f, "\n{help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for QuantityError {}

/// Magnitudes that can be meant, in SI; products of four of them are finite. Times of measured master curves span 60 decades.
const MAGNITUDES: std::ops::RangeInclusive<f64> = 1e-50..=1e50;

impl<D: Dimension, R: Range> Quantity<D, R> {
    /// A value in SI.
    ///
    /// # Errors
    /// [`QuantityError`] where it is outside the range `R`, not a number, or of a magnitude that cannot be meant: below 1e-50 or above
    /// 1e50.
    pub fn new(value: f64) -> Result<Self, QuantityError> {
        if value != 0.0 && value.is_finite() && !MAGNITUDES.contains(&value.abs()) {
            let (least, most) = (MAGNITUDES.start(), MAGNITUDES.end());
            let size = if value.abs() < *least { "small" } else { "large" };
            let help = format!("no quantity of a contact is that {size}");
            let expected = format!("{} from {least:e} to {most:e} {}", D::NAME, D::SI).trim_end().to_owned();
            return Err(QuantityError { code: Code::OutOfRange, expected, help: Some(help) });
        }
        match R::contains(value) {
            true => Ok(Quantity { value, kind: PhantomData }),
            false => {
                Err(Self::error(Code::OutOfRange, value.is_nan().then(|| "nan is not a number".to_owned())))
            }
        }
    }

    /// The value in SI.
    pub fn get(self) -> f64 {
        self.value
    }

    /// "a length greater than 0, such as "0.5 mm"".
    pub fn expected() -> String {
        let range = if R::WORDS.is_empty() { String::new() } else { format!(" {},", R::WORDS) };
        let example = R::EXAMPLE.unwrap_or(D::EXAMPLE);
        match D::SI.is_empty() {
            true => format!("{}{range} such as {example}", D::NAME),
            false => format!("{}{range} such as \"{example}\"", D::NAME),
        }
    }

    fn error(code: Code, help: Option<String>) -> QuantityError {
        QuantityError { code, expected: Self::expected(), help }
    }
}

impl<D: Dimension, R: Range> fmt::Debug for Quantity<D, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.value, D::SI)
    }
}

impl<D: Dimension, R: Range> FromStr for Quantity<D, R> {
    type Err = QuantityError;

    fn from_str(text: &str) -> Result<Self, QuantityError> {
        let text = text.trim();
        let (number, rest) = Decimal::split(text).ok_or_else(|| {
            let help = match text {
                "" => "the text is empty".to_owned(),
                _ => format!("{text:?} does not begin with a number"),
            };
            Self::error(Code::WrongType, Some(help))
        })?;
        if rest.starts_with(',') {
            return Err(Self::error(Code::WrongType, Some("write the decimal point as \".\"".into())));
        }
        let wrong_unit = |reason: String| {
            let meant = D::UNITS.split(", ").find(|unit| unit.eq_ignore_ascii_case(rest.trim()));
            let help = match meant {
                Some(unit) => format!("{reason}; did you mean \"{unit}\"?"),
                None => format!("{reason}; units of {}: {}", bare(D::NAME), D::UNITS),
            };
            Self::error(Code::WrongUnit, Some(help))
        };
        let unit = Unit::parse(rest).map_err(wrong_unit)?;
        // A bare number is SI.
        if !rest.is_empty() && unit.powers != D::POWERS {
            let reason = match dimension::name(unit.powers) {
                Some(other) => format!("\"{}\" is the unit of {other}", rest.trim()),
                None => format!("\"{}\" is not a unit of {}", rest.trim(), bare(D::NAME)),
            };
            return Err(wrong_unit(reason));
        }
        let value = number.scaled(unit.exponent) * unit.numerator / unit.denominator;
        if value.is_infinite() && !number.infinite() {
            return Err(Self::error(Code::OutOfRange, Some(format!("{text} is too large a number"))));
        }
        Self::new(value)
    }
}

/// A text that is a quantity of any dimension: its value in SI, and the SI unit, empty for a pure number.
///
/// ```
/// use asperity_files::quantity::in_si;
/// assert_eq!(in_si("300 MPa"), Some((300e6, "Pa")));
/// assert_eq!(in_si("20 °C"), Some((293.15, "K")));
/// assert_eq!(in_si("7"), Some((7.0, "")));
/// assert_eq!(in_si("2 mm3/(N m)"), Some((2e-9, "m2/N")));
/// assert_eq!(in_si("steel"), None);
/// ```
pub fn in_si(text: &str) -> Option<(f64, &'static str)> {
    let (number, rest) = Decimal::split(text.trim())?;
    match Unit::parse(rest) {
        Ok(unit) => {
            let value = number.scaled(unit.exponent) * unit.numerator / unit.denominator;
            Some((value, dimension::unit(unit.powers, rest)?))
        }
        Err(_) => {
            let kelvin = text.parse::<Temperature>().map(|temperature| (temperature.get(), "K"));
            kelvin.or_else(|_| text.parse::<Angle>().map(|angle| (angle.get(), "rad"))).ok()
        }
    }
}

/// "length" of "a length".
fn bare(name: &str) -> &str {
    name.strip_prefix("a ").or(name.strip_prefix("an ")).unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::range::{Positive, PositiveOrInfinite};
    use super::*;

    fn message<D: Dimension, R: Range>(text: &str) -> String {
        text.parse::<Quantity<D, R>>().unwrap_err().to_string()
    }

    #[test]
    fn a_decimal_with_a_prefix_is_the_nearest_double() {
        for (text, value) in [
            ("0.3 mm", 0.3e-3),
            ("0.1mm", 0.1e-3),
            (".7 um", 0.7e-6),
            ("7. nm", 7e-9),
            ("1e-3 m", 1e-3),
            ("1E2 µm", 1e-4),
            ("-2.5 um", -2.5e-6),
            ("+2.5 um", 2.5e-6),
            ("0.5", 0.5),
            ("  12 Å ", 12e-10),
        ] {
            assert_eq!(text.parse::<Length>().unwrap().get(), value, "{text}");
        }
        assert_eq!("1973 MPa".parse::<Pressure>().unwrap().get(), 1973e6);
        assert_eq!("254.776 MPa".parse::<Pressure>().unwrap().get(), 254.776e6);
        assert_eq!("1e-3 1/MPa".parse::<Compliance>().unwrap().get(), 1e-9);
        assert_eq!("2/MPa".parse::<Compliance>().unwrap().get(), 2e-6);
        assert_eq!("2 kHz".parse::<Frequency>().unwrap().get(), 2e3);
        assert_eq!("6 1/min".parse::<Frequency>().unwrap().get(), 0.1);
        assert_eq!("2 h".parse::<Time>().unwrap().get(), 7200.0);
        assert_eq!("1.5 day".parse::<Time>().unwrap().get(), 129_600.0);
        assert_eq!("3e-12 1/(Pa s)".parse::<Fluidity>().unwrap().get(), 3e-12);
        assert_eq!("38 %".parse::<Number>().unwrap().get(), 0.38);
        assert_eq!("20 mN".parse::<Force>().unwrap().get(), 20e-3);
    }

    #[test]
    fn a_wrong_dimension_is_named() {
        let text = message::<dimension::Pressure, Finite>("300 m");
        assert_eq!(
            text,
            "a pressure such as \"300 MPa\"\n\"m\" is the unit of a length; \
             units of pressure: Pa, kPa, MPa, GPa, bar, N/mm^2"
        );
        let text = message::<dimension::Length, Finite>("5 mpa");
        assert!(text.contains("\"mpa\" is not a known unit; units of length: nm, um, mm, m"), "{text}");
        let text = message::<dimension::Pressure, Finite>("2 Mpa");
        assert!(text.ends_with("did you mean \"MPa\"?"), "{text}");
        let text = message::<dimension::Length, Finite>("5 m^2");
        assert!(text.contains("\"m^2\" is the unit of an area"), "{text}");
        let text = message::<dimension::Number, Finite>("5 m");
        assert!(text.starts_with("a number such as 0.38"), "{text}");
    }

    #[test]
    fn what_is_no_number_is_named() {
        for text in ["", "mm", "-", ".", "e5", "nan", "one mm"] {
            assert!(text.parse::<Length>().is_err(), "{text}");
        }
        assert!(message::<dimension::Length, Finite>("0,5 mm").contains("decimal point"));
        assert!(message::<dimension::Length, Finite>("1e999 m").contains("too large"));
        assert!(message::<dimension::Length, Finite>("1e99999999999999999999 m").contains("too large"));
        assert!(message::<dimension::Pressure, Finite>("1e305 GPa").contains("too large"));
        assert!(message::<dimension::Force, Positive>("1e300 N").contains("that large"));
        assert!(message::<dimension::Length, Positive>("1e-300 m").contains("that small"));
        assert!(Length::<Positive>::new(1e51).is_err() && Length::<Positive>::new(1e49).is_ok());
        assert_eq!("1e-99999999999999999999 m".parse::<Length>().unwrap().get(), 0.0);
    }

    #[test]
    fn infinity_only_where_it_means_something() {
        assert_eq!("inf".parse::<Length<PositiveOrInfinite>>().unwrap().get(), f64::INFINITY);
        assert_eq!("inf mm".parse::<Length<PositiveOrInfinite>>().unwrap().get(), f64::INFINITY);
        assert!("-inf".parse::<Length<PositiveOrInfinite>>().is_err());
        assert!("inf".parse::<Length>().is_err());
        assert!("inf".parse::<Length<Positive>>().is_err());
        assert!(Length::<Finite>::new(f64::NAN).is_err());
    }

    #[test]
    fn the_range_is_part_of_what_is_expected() {
        assert_eq!(
            message::<dimension::Length, Positive>("0 mm"),
            "a length greater than 0, such as \"0.5 mm\""
        );
    }
}
