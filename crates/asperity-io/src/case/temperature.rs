//! `[temperature]`: the temperature of the run.

use asperity::material::Shift;
use asperity::{Error, finding};

use super::history_file;
use super::keys::*;
use crate::Code;
use crate::quantity::Temperature as Kelvin;

/// The temperature of the bodies that have a `shift`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Temperature {
    /// Absolute temperature over time, the same for both bodies.
    #[schemars(example = serde_json::json!({ "kind": "constant", "value": "60 °C" }))]
    history: TemperatureHistory,
}

/// A temperature over time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind")]
enum TemperatureHistory {
    /// The same at all times.
    Constant {
        /// The temperature.
        #[schemars(example = "60 °C")]
        value: Kelvin,
    },
    /// From one temperature to another, then held.
    Ramp {
        /// Temperature at t = 0.
        from: Kelvin,
        /// Temperature reached and held.
        #[schemars(example = "60 °C")]
        to: Kelvin,
        /// Time to reach it.
        #[schemars(example = "100 s")]
        duration: Time<Positive>,
    },
    /// Linear between points, held after the last; two points at the same time are a jump.
    Table {
        /// Pairs [time, temperature] in order of time, the first at 0; a time given twice is a jump.
        #[schemars(example = (("0 s", "20 °C"), ("100 s", "60 °C")))]
        #[schemars(length(min = 1))]
        points: Vec<Two<Time, Kelvin>>,
    },
    /// The points of a table from a file of two columns, time and temperature.
    File {
        /// The file, relative to the case file: one line per point, time and temperature separated by comma,
        /// semicolon or blanks, each with unit or in SI; `#` begins a comment, one header line may name the columns
        /// with units, as in "time [s], T [°C]".
        #[schemars(example = "temperature.csv")]
        path: String,
    },
}

impl Temperature {
    /// The temperatures of the run as (time [s], temperature [K]), where the `shifts` of the bodies of these names are defined; `unknown` where another body may depend on them.
    pub fn temperatures(
        &self,
        at: &Place<'_>,
        shifts: &[(&str, &Shift)],
        unknown: bool,
    ) -> Option<Vec<(f64, f64)>> {
        if shifts.is_empty() && !unknown {
            let message = "no body depends on it: none has a `shift` (without a `temperature` of its own)";
            let help = "add shift = { model = \"wlf\", ... } to a material, or leave the section out";
            return at.fault(message, "a material with a shift", help);
        }
        let at = at.key("history");
        let points = self.history.read(&at)?;
        for (n, (_, kelvin)) in points.iter().enumerate() {
            for (body, shift) in shifts {
                possible(&self.history.place(&at, n), &format!("the shift of {body}"), shift, *kelvin)?;
            }
        }
        Some(points)
    }
}

/// Refuses a temperature \[K\] at which a shift is not defined; `of` names the shift.
pub fn possible(at: &Place<'_>, of: &str, shift: &Shift, kelvin: f64) -> Option<()> {
    let Err(Error::Invalid { value, expected, .. }) = shift.ln_factor(kelvin) else { return Some(()) };
    let help = finding::celsius_meant(kelvin).unwrap_or_default();
    let message = format!("the temperature is {value}, but must be {expected} ({of})");
    at.refuse(Code::OutOfRange, message, &expected, &help)
}

impl TemperatureHistory {
    /// The key of a point.
    fn place<'c>(&self, at: &Place<'c>, n: usize) -> Place<'c> {
        match self {
            TemperatureHistory::Constant { .. } => at.key("value"),
            TemperatureHistory::Ramp { .. } => at.key(["from", "to"][n.min(1)]),
            TemperatureHistory::Table { .. } => at.key("points").item(n),
            TemperatureHistory::File { .. } => at.key("path"),
        }
    }

    fn read(&self, at: &Place<'_>) -> Option<Vec<(f64, f64)>> {
        match self {
            TemperatureHistory::Constant { value } => Some(vec![(0.0, value.get())]),
            TemperatureHistory::Ramp { from, to, duration } => {
                Some(vec![(0.0, from.get()), (duration.get(), to.get())])
            }
            TemperatureHistory::Table { points } => table(&at.key("points"), points),
            TemperatureHistory::File { path } => {
                let kelvin = |value: &Prescribed| match value {
                    Prescribed::Number(kelvin) => Kelvin::from_kelvin(*kelvin),
                    Prescribed::Text(text) => text.parse(),
                };
                let kelvin = |value: &Prescribed| kelvin(value).map(Kelvin::get);
                history_file::of_key(&at.key("path"), path, "temperature", kelvin)
            }
        }
    }
}

fn table(at: &Place<'_>, points: &[Two<Time, Kelvin>]) -> Option<Vec<(f64, f64)>> {
    let points: Vec<(f64, f64)> = points.iter().map(|Two(time, kelvin)| (time.get(), kelvin.get())).collect();
    if points.is_empty() {
        return at.wrong("a list of one point at least", "");
    }
    history_file::in_order(at, &points, "temperature")?;
    if let Some(n) = points.windows(3).position(|three| three[0].0 == three[2].0) {
        let expected = "a later point: a jump has one temperature before and one after";
        return at.item(n + 2).wrong(expected, "");
    }
    Some(points)
}
