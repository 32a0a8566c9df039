//! `shift` of a material and `[temperature]` of the run.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{At, Two};
use crate::case::quantity::range::{NonNegative, Positive};
use crate::case::quantity::{
    Expansion, MolarEnergy, Number, Temperature as Kelvin, TemperatureDifference, Time,
};
use crate::curve::VerticalWord;

/// How all times of a material scale with temperature: by the shift factor a_T, 1 at the reference.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(tag = "model")]
pub enum Shift {
    /// Williams, Landel, Ferry: log10 a_T = -c1 (T - reference)/(c2 + T - reference).
    Wlf(Wlf),
    /// ln a_T = (energy/R) (1/T - 1/reference).
    Arrhenius(Arrhenius),
    /// A table of shift factors, with log10 a_T linear in between.
    Table(ShiftTable),
    /// Estimated from the overlap of the sweeps of a file with several temperatures.
    Estimated(Estimated),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wlf {
    /// c1, in decades (log10).
    #[schemars(example = 8.86)]
    pub c1: Number<Positive>,
    /// c2, a difference of temperatures.
    #[schemars(example = "101.6 K")]
    pub c2: TemperatureDifference<Positive>,
    /// Reference temperature, to which the given values of the material belong.
    #[schemars(example = "20 °C")]
    pub reference: Kelvin,
    /// How the moduli depend on temperature; they do not if not given.
    #[schemars(example = &"density")]
    pub vertical: Option<Vertical>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Arrhenius {
    /// Activation energy.
    #[schemars(example = "120 kJ/mol")]
    pub energy: MolarEnergy<Positive>,
    /// Reference temperature, to which the given values of the material belong.
    #[schemars(example = "20 °C")]
    pub reference: Kelvin,
    /// How the moduli depend on temperature; they do not if not given.
    #[schemars(example = &"density")]
    pub vertical: Option<Vertical>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShiftTable {
    /// Pairs [temperature, log10 a_T] in order of temperature; 0 at the reference temperature. This or `path`.
    #[schemars(example = (("0 °C", 2.5), ("20 °C", 0.0), ("60 °C", -3.0)))]
    pub points: Option<Vec<Two<Kelvin, Number>>>,
    /// A file of them, relative to the case file: a table with columns T and log_aT (or ln_aT, aT), with units in the
    /// header. This or `points`.
    #[schemars(example = "shift.csv")]
    pub path: Option<At<String>>,
    /// How the moduli depend on temperature; they do not if not given.
    #[schemars(example = &"density")]
    pub vertical: Option<Vertical>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Estimated {
    /// Reference temperature, among those of the file.
    #[schemars(example = "20 °C")]
    pub reference: Kelvin,
    /// How the moduli depend on temperature; they do not if not given.
    #[schemars(example = &"free")]
    pub vertical: Option<Vertical>,
}

/// How the moduli of a material depend on temperature, besides its times: at T they are those at the reference temperature of
/// the shift over b_T.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(
    expecting = "\"density\" (b_T = reference/T, as for a rubber), \"free\" (one factor for each sweep of a file), \
                     { expansion = \"6e-4 1/K\" }, or pairs [temperature, b_T]"
)]
pub enum Vertical {
    /// "density" or "free".
    Word(VerticalWord),
    /// As density times absolute temperature, where the density falls.
    Density(VerticalDensity),
    /// Pairs [temperature, b_T] in order of temperature; 1 at the reference, ln b_T is linear in between.
    Points(Vec<Two<Kelvin, Number<Positive>>>),
}

/// Moduli grow as density times absolute temperature: b_T = (reference/T) (1 + expansion (T - reference)).
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VerticalDensity {
    /// Relative growth of the volume per kelvin.
    #[schemars(example = "6e-4 1/K")]
    pub expansion: Expansion<NonNegative>,
}

impl Shift {
    /// How the moduli depend on temperature.
    pub fn vertical(&self) -> Option<&Vertical> {
        match self {
            Shift::Wlf(law) => law.vertical.as_ref(),
            Shift::Arrhenius(law) => law.vertical.as_ref(),
            Shift::Table(table) => table.vertical.as_ref(),
            Shift::Estimated(estimated) => estimated.vertical.as_ref(),
        }
    }
}

/// The temperature of the bodies that have a `shift`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Temperature {
    /// Absolute temperature over time, the same for both bodies.
    #[schemars(example = serde_json::json!({ "kind": "ramp", "from": "20 °C", "to": "60 °C", "duration": "100 s" }))]
    pub history: At<TemperatureHistory>,
}

/// A temperature over time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(tag = "kind")]
pub enum TemperatureHistory {
    /// The same at all times.
    Constant(Constant),
    /// From one temperature to another, then held.
    Ramp(TemperatureRamp),
    /// Linear between points, held after the last; two points at the same time are a jump.
    Table(TemperatureTable),
    /// The points of a table from a file of two columns, time and temperature.
    File(TemperatureFile),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Constant {
    /// The temperature.
    #[schemars(example = "60 °C")]
    pub value: At<Kelvin>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TemperatureRamp {
    /// Temperature at t = 0.
    #[schemars(example = "20 °C")]
    pub from: At<Kelvin>,
    /// Temperature reached and held.
    #[schemars(example = "60 °C")]
    pub to: At<Kelvin>,
    /// Time to reach it.
    #[schemars(example = "100 s")]
    pub duration: Time<Positive>,
}

/// Time and temperature.
pub type TemperaturePoint = Two<Time, At<Kelvin>>;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TemperatureTable {
    /// Pairs [time, temperature] in order of time, the first at 0; a time given twice is a jump.
    #[schemars(example = (("0 s", "20 °C"), ("100 s", "60 °C")))]
    #[schemars(length(min = 1))]
    pub points: At<Vec<At<TemperaturePoint>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TemperatureFile {
    /// The file, relative to the case file: one line per point, time and temperature separated by comma,
    /// semicolon or blanks, each with unit or in SI; `#` begins a comment, one header line may name the columns
    /// with units, as in "time [s], T [°C]".
    #[schemars(example = "temperature.csv")]
    pub path: At<String>,
}
