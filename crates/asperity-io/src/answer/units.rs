//! The units that a user wants answers in: leaks and times.

use std::collections::BTreeMap;

use asperity::drive::Coordinate;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Answer, SHARES};
use crate::converge::ErrorBar;
use crate::quantity::unit::{Powers, Unit};
use crate::readable::{Shown, quantity, shown};
use crate::store::Reader;

/// One atmosphere \[Pa\], at which gases are counted as volumes.
const ATMOSPHERE: f64 = 101_325.0;
/// Pa m³/s in mbar l/s.
pub const MBAR_LITRE: f64 = 10.0;
const VOLUME_RATE: Powers = [3, 0, -1, 0, 0];
const MASS_RATE: Powers = [0, 1, -1, 0, 0];
const PV_RATE: Powers = [2, 1, -3, 0, 0];
const TIME: Powers = [0, 0, 1, 0, 0];

/// What units can be chosen for, with the dimensions that each may have and an example.
const CHOICES: [(&str, &[Powers], &str); 2] = [
    ("leak", &[VOLUME_RATE, MASS_RATE, PV_RATE], "ml/min, ml/year, g/year, mbar l/s"),
    ("time", &[TIME], "s, min, h, day, year"),
];

/// How the names of answers begin that may be less than 0; the others are not.
const SIGNED: [&str; 6] = ["approach", "creep", "relaxation", "load", "friction", "loss"];

/// Why a unit cannot be chosen.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum UnitError {
    /// Nothing of that name has a unit to choose.
    #[error("\"{name}\" has no unit to choose; expected leak or time, e.g. leak=ml/year")]
    Unknown {
        /// What was named.
        name: String,
    },
    /// The text is no unit of that dimension.
    #[error("\"{unit}\" is no unit of a {name}{reason}; expected one like {examples}")]
    Unfit {
        /// What was named.
        name: String,
        /// The text.
        unit: String,
        /// Why, where more is known.
        reason: String,
        /// Units that fit.
        examples: &'static str,
    },
}

impl UnitError {
    /// What would be right.
    pub fn expected(&self) -> String {
        match self {
            UnitError::Unknown { .. } => "leak or time".into(),
            UnitError::Unfit { examples, .. } => format!("one like {examples}"),
        }
    }
}

/// Units by what they are for, as a user wrote them: `leak`, `time`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Units(BTreeMap<String, String>);

impl Units {
    /// Chooses a unit.
    ///
    /// # Errors
    /// [`UnitError`] if nothing of that name has a unit to choose, or the text is no unit of its dimension.
    pub fn choose(&mut self, name: &str, unit: &str) -> Result<(), UnitError> {
        let known = CHOICES.iter().find(|choice| choice.0 == name);
        let Some((_, dimensions, examples)) = known else {
            return Err(UnitError::Unknown { name: name.to_owned() });
        };
        let unfit = |reason: String| UnitError::Unfit {
            name: name.to_owned(),
            unit: unit.to_owned(),
            reason,
            examples,
        };
        let parsed = Unit::parse(unit).map_err(|reason| unfit(format!(": {reason}")))?;
        if !dimensions.contains(&parsed.powers) {
            return Err(unfit(String::new()));
        }
        self.0.insert(name.to_owned(), unit.to_owned());
        Ok(())
    }

    /// The units that the case of a result chose, replaced by `these`.
    pub fn of(reader: &Reader, these: &Units) -> Units {
        let chosen = reader.header().setup.get(Units::SETUP).cloned();
        let mut units: Units =
            chosen.and_then(|units| serde_json::from_value(units).ok()).unwrap_or_default();
        units.0.extend(these.0.clone());
        units
    }

    /// Their key in the setup of a result.
    pub(crate) const SETUP: &'static str = "units";

    /// The answers without the second rate of a gas: the one counted at 0 °C is shown, or the mass where its unit is chosen.
    pub fn without_second_rate<'a>(&self, answers: &'a [Answer]) -> impl Iterator<Item = &'a Answer> {
        let gas = answers.iter().any(|answer| answer.name == "leak_rate_standard");
        let hidden = if self.is_mass() { "leak_rate_standard" } else { "leak_rate" };
        answers.iter().filter(move |answer| !(gas && answer.name == hidden))
    }

    /// Whether leaks are wanted as a mass.
    fn is_mass(&self) -> bool {
        self.chosen_unit("leak").is_some_and(|(_, unit)| unit.powers == MASS_RATE)
    }

    /// What units were chosen for, with the units.
    pub fn chosen(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(name, unit)| (name.as_str(), unit.as_str()))
    }

    /// The unit chosen for `name`, as it was written.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    /// Whether none was chosen.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Where a leak can be given in the unit chosen for it; an error if its unit needs a density that is not known.
    ///
    /// # Errors
    /// [`UnitError::Unfit`].
    pub fn check(&self, answers: &[Answer]) -> Result<(), UnitError> {
        let leaks = answers.iter().filter(|answer| answer.name.starts_with("leak_rate"));
        self.check_leak(&leaks.map(|leak| leak.unit).collect::<Vec<_>>())
    }

    /// The same for leak rates in these SI units.
    ///
    /// # Errors
    /// [`UnitError::Unfit`].
    pub fn check_leak(&self, rates: &[&str]) -> Result<(), UnitError> {
        let Some(unit) = self.0.get("leak") else { return Ok(()) };
        if rates.is_empty() || rates.iter().any(|si| self.leak(1.0, si).is_some()) {
            return Ok(());
        }
        Err(UnitError::Unfit {
            name: "leak".into(),
            unit: unit.clone(),
            reason: " of a liquid, whose density is not known".into(),
            examples: "ml/min, ml/year, mm^3/s",
        })
    }

    /// A value of an answer, with the unit chosen for it or one that suits it.
    pub fn words(&self, answer: &Answer, value: f64) -> String {
        if value.is_nan() {
            return "none".into();
        }
        match answer.is_share() {
            true => format!("{} %", quantity(100.0 * value, "")),
            false => self.number(value, answer.unit),
        }
    }

    /// A value in this SI unit, with the unit chosen for it or one that suits it.
    pub fn number(&self, value: f64, unit: &str) -> String {
        match unit {
            "1" => quantity(value, ""),
            "rad" => format!("{}°", quantity(value.to_degrees(), "")),
            "s" => self.time(value),
            "m3/s" | "kg/s" | "Pa m3/s" if value == 0.0 => "none: tight".into(),
            "m3/s" | "kg/s" | "Pa m3/s" => self.leak(value, unit).unwrap_or_else(|| match unit {
                "Pa m3/s" => format!("{:.3e} mbar l/s (at 0 °C)", MBAR_LITRE * value),
                unit => format!("{value:.3e} {}", unit.replace("m3", "m³")),
            }),
            unit => quantity(value, unit),
        }
    }

    /// A leak rate: of a liquid \[m³/s\], of a gas \[kg/s\] with its `standard` rate \[Pa m³/s\], which counts it at 0 °C.
    pub fn rate(&self, leak_rate: f64, standard: Option<f64>) -> String {
        match standard {
            Some(standard) => {
                let mass = self.leak(leak_rate, "kg/s");
                mass.unwrap_or_else(|| self.number(standard, "Pa m3/s"))
            }
            None => self.number(leak_rate, "m3/s"),
        }
    }

    /// The unit for the leak rates of a liquid or a `gas`, per SI value of the volume rate \[m³/s\] or of the standard rate \[Pa m³/s\].
    pub fn shown_leak(&self, gas: bool) -> Shown {
        let (si, factor, text) =
            if gas { ("Pa m3/s", MBAR_LITRE, "mbar l/s") } else { ("m3/s", 1.0, "m³/s") };
        match self.leak_unit(si) {
            Some((chosen, _)) => chosen,
            None => Shown { factor, text: text.into() },
        }
    }

    /// An answer with its error: "42.3 % ± 0.8"; where the error is as large as the answer, what is known of it: "not determined: less
    /// than 28 h".
    pub fn plus_minus(&self, bar: &ErrorBar) -> String {
        let Some(value) = bar.value else { return "none".into() };
        if value == 0.0 && bar.error == Some(0.0) {
            return self.number(value, &bar.unit);
        }
        let shown = self.shown_for(&bar.name, &bar.unit, value.abs().max(bar.error.unwrap_or(0.0)));
        let unit = if shown.text.is_empty() { String::new() } else { format!(" {}", shown.text) };
        match bar.error {
            Some(error) if error >= value.abs() => {
                let [low, high] = [value - error, value + error].map(|end| outward(shown.factor * end));
                match SIGNED.iter().any(|name| bar.name.starts_with(name)) {
                    true => format!("not determined: between {low} and {high}{unit}"),
                    false => format!("not determined: less than {high}{unit}"),
                }
            }
            error => {
                let error = error.map_or("unknown".to_owned(), |error| rounded(bar, &shown, error));
                format!("{}{unit} ± {error}", rounded(bar, &shown, value))
            }
        }
    }

    /// The same with what the grid, the steps and the solver cause of the error, all in one unit:
    /// "42.3 % ± 0.8 (grid 0.8, time 0.1, solver 0.0)".
    pub fn with_error(&self, bar: &ErrorBar) -> String {
        let largest = bar.value.unwrap_or(0.0).abs().max(bar.error.unwrap_or(0.0));
        let shown = self.shown_for(&bar.name, &bar.unit, largest);
        if bar.value.is_none() || (bar.value, bar.error) == (Some(0.0), Some(0.0)) {
            return self.plus_minus(bar);
        }
        let part = |part: Option<f64>| part.map_or("unknown".into(), |part| rounded(bar, &shown, part));
        let [grid, time, solver] = [bar.grid, bar.time, bar.solver].map(part);
        format!("{} (grid {grid}, time {time}, solver {solver})", self.plus_minus(bar))
    }

    /// The unit that an answer is shown in, per SI value.
    fn shown_for(&self, name: &str, unit: &str, value: f64) -> Shown {
        let plain = |factor: f64, text: &str| Shown { factor, text: text.to_owned() };
        match unit {
            "1" if SHARES.contains(&name) => plain(100.0, "%"),
            "1" => plain(1.0, ""),
            "rad" => plain(1f64.to_degrees(), "°"),
            "s" => self.shown("time").unwrap_or_else(|| shown("s", value.abs())),
            "m3/s" | "Pa m3/s" => self.shown_leak(unit != "m3/s"),
            "kg/s" => self.shown("leak").filter(|_| self.is_mass()).unwrap_or(plain(1.0, "kg/s")),
            unit => shown(unit, value.abs()),
        }
    }

    /// A time in the unit chosen for times.
    pub fn time(&self, seconds: f64) -> String {
        match self.shown("time") {
            Some(Shown { factor, text }) => format!("{} {text}", quantity(seconds * factor, "")),
            None => quantity(seconds, "s"),
        }
    }

    /// Time or velocity of a row in its unit.
    pub fn coordinate(&self, of: Coordinate) -> String {
        match of {
            Coordinate::Time(seconds) => self.time(seconds),
            other => quantity(other.value(), other.axis().unit()),
        }
    }

    /// "t = 10 s", or "v = 1 mm/s" of a steady state.
    pub fn moment(&self, of: Coordinate) -> String {
        format!("{} = {}", of.axis().symbol(), self.coordinate(of))
    }

    /// The unit chosen for `name`, per SI value; `None` where none is chosen.
    pub fn shown(&self, name: &str) -> Option<Shown> {
        let (text, unit) = self.chosen_unit(name)?;
        Some(Shown { factor: 1.0 / unit.scale(), text: text.to_owned() })
    }

    fn chosen_unit(&self, name: &str) -> Option<(&str, Unit)> {
        let text = self.text(name)?;
        Some((text, Unit::parse(text).ok()?))
    }

    /// A leak in the unit chosen for leaks, where it can be given in it.
    fn leak(&self, value: f64, si: &str) -> Option<String> {
        let (Shown { factor, text }, conditions) = self.leak_unit(si)?;
        Some(format!("{} {text}{conditions}", quantity(value * factor, "")))
    }

    /// The unit chosen for leaks, per value in this SI unit, and at which conditions it counts: a gas as mass, as pressure times volume at
    /// 0 °C, or as volume at 0 °C and one atmosphere; a liquid as volume. `None` where none is chosen, or it does not fit.
    fn leak_unit(&self, si: &str) -> Option<(Shown, &'static str)> {
        let (text, unit) = self.chosen_unit("leak")?;
        let (per, conditions) = match (si, unit.powers) {
            ("m3/s", VOLUME_RATE) | ("kg/s", MASS_RATE) => (1.0, ""),
            ("Pa m3/s", PV_RATE) => (1.0, " (at 0 °C)"),
            ("Pa m3/s", VOLUME_RATE) => (ATMOSPHERE, " (at 0 °C and 1 atm)"),
            _ => return None,
        };
        Some((Shown { factor: 1.0 / (per * unit.scale()), text: text.to_owned() }, conditions))
    }
}

/// An end of an interval with two digits, rounded away from 0.
fn outward(number: f64) -> String {
    if number == 0.0 {
        return "0".into();
    }
    let digit = 10f64.powi(number.abs().log10().floor() as i32 - 1);
    let rounded = number.signum() * (number.abs() / digit * (1.0 - 1e-12)).ceil() * digit;
    let places = (-digit.log10().round()).clamp(0.0, 12.0) as usize;
    match (1e-4..1e6).contains(&rounded.abs()) {
        true => format!("{rounded:.places$}"),
        false => format!("{rounded:.1e}"),
    }
}

/// A number of an answer in the unit shown: with two digits of the error, or five of the value where the error is less.
fn rounded(bar: &ErrorBar, shown: &Shown, number: f64) -> String {
    let value = shown.factor * bar.value.unwrap_or(0.0);
    let error = bar.error.map(|error| shown.factor * error);
    let places = |number: f64, digits: f64| match number {
        0.0 => 0.0,
        number => (digits - 1.0 - number.abs().log10().floor()).clamp(0.0, 12.0),
    };
    let places = match error {
        None | Some(0.0) => places(value, 4.0),
        Some(error) if value == 0.0 => places(error, 2.0),
        Some(error) => places(error, 2.0).min(places(value, 5.0)),
    } as usize;
    let largest = value.abs().max(error.unwrap_or(0.0));
    match largest == 0.0 || (1e-4..1e6).contains(&largest) {
        true => format!("{:.places$}", number * shown.factor),
        false => format!("{:.3e}", number * shown.factor),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar(name: &str, unit: &str, value: f64, [grid, time, solver]: [f64; 3]) -> ErrorBar {
        ErrorBar {
            name: name.into(),
            value: Some(value),
            unit: unit.into(),
            error: Some((grid * grid + time * time + solver * solver).sqrt()),
            grid: Some(grid),
            time: Some(time),
            solver: Some(solver),
            at: None,
            order: None,
            note: String::new(),
        }
    }

    #[test]
    fn answers_are_rounded_to_two_digits_of_their_error() {
        let units = Units::default();
        let fraction = bar("contact_fraction", "1", 0.42263, [0.008, 0.001, 1e-6]);
        assert_eq!(units.with_error(&fraction), "42.26 % ± 0.81 (grid 0.80, time 0.10, solver 0.00)");
        let approach = bar("approach", "m", 1.021_4e-6, [9.1e-9, 0.0, 0.0]);
        assert_eq!(units.plus_minus(&approach), "1.0214 µm ± 0.0091");
        let unknown = ErrorBar { error: None, ..approach };
        assert_eq!(units.plus_minus(&unknown), "1.021 µm ± unknown");
    }

    #[test]
    fn an_answer_smaller_than_its_error_is_a_bound() {
        let units = Units::default();
        // 15 566 s + 93 600 s = 30.32 h.
        let tight = bar("tight_from", "s", 15_566.0, [0.0, 93_600.0, 0.0]);
        assert_eq!(units.plus_minus(&tight), "not determined: less than 31 h");
        assert!(
            units.with_error(&tight).ends_with("less than 31 h (grid 0, time 26, solver 0)"),
            "{}",
            units.with_error(&tight)
        );
        let leak = bar("leak_rate", "m3/s", 0.0, [2.5e-15, 0.0, 0.0]);
        assert_eq!(units.plus_minus(&leak), "not determined: less than 2.5e-15 m³/s");
        let approach = bar("approach", "m", -1e-9, [3.02e-9, 0.0, 0.0]);
        assert_eq!(units.plus_minus(&approach), "not determined: between -4.1 and 2.1 nm");
        assert_eq!(
            ["0.034", "-11", "1.0e7", "0.1"].map(|text| outward(text.parse().unwrap())),
            ["0.034", "-11", "1.0e7", "0.10"]
        );
    }

    #[test]
    fn leaks_are_shown_in_the_unit_chosen_for_them() {
        let mut units = Units::default();
        units.choose("leak", "ml/year").unwrap();
        units.choose("time", "min").unwrap();
        // 1e-12 m³/s is 1e-6 ml/s, times the seconds of a year.
        assert_eq!(units.number(1e-12, "m3/s"), "31.56 ml/year");
        // A gas counts at 0 °C and one atmosphere.
        assert_eq!(units.number(101_325.0 * 1e-12, "Pa m3/s"), "31.56 ml/year (at 0 °C and 1 atm)");
        assert_eq!(units.time(90.0), "1.5 min");
        units.choose("leak", "mbar l/s").unwrap();
        assert_eq!(units.number(1e-7, "Pa m3/s"), "1.000e-6 mbar l/s (at 0 °C)");
        // A liquid has no rate at 0 °C: SI.
        assert_eq!(units.number(1e-12, "m3/s"), "1.000e-12 m³/s");
        assert!(units.choose("leak", "mm").unwrap_err().to_string().contains("no unit of a leak"));
        assert!(units.choose("load", "N").unwrap_err().to_string().contains("leak or time"));
    }
}
