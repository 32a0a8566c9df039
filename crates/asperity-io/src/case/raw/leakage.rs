//! `[leakage]`.

use asperity::leakage::{Rarefaction, Sides, Species};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{At, StoredTimes};
use crate::case::quantity::range::{NonNegative, Positive};
use crate::case::quantity::{Length, MolarMass, Pressure, Temperature, Viscosity};
use crate::leakage::LeakDirection;

/// The flow of a fluid through the gap, from the stored fields: a liquid with `pressure_drop` and `viscosity`, or
/// a gas with `inlet`, `outlet` and `gas` (or its `viscosity` and `molar_mass`). Without a fluid only the gap is assessed.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Leakage {
    /// Direction of the flow; "x" if not given.
    pub direction: Option<LeakDirection>,
    /// Pressure of the liquid at the inlet less that at the outlet.
    #[schemars(example = "2 bar")]
    pub pressure_drop: Option<Pressure<Positive>>,
    /// Viscosity of the liquid, or of a gas that `gas` does not name.
    #[schemars(example = "1 mPa s")]
    pub viscosity: Option<Viscosity<Positive>>,
    /// A gas with known viscosity and molar mass.
    pub gas: Option<Species>,
    /// Molar mass of a gas that `gas` does not name.
    #[schemars(example = "0.02896 kg/mol")]
    pub molar_mass: Option<MolarMass<Positive>>,
    /// Temperature of the gas; that of the run if not given, or 20 °C if the run has none.
    #[schemars(example = "20 °C")]
    pub temperature: Option<Temperature>,
    /// Absolute pressure of the gas at the inlet.
    #[schemars(example = "3 bar")]
    pub inlet: Option<Pressure<Positive>>,
    /// Absolute pressure of the gas at the outlet; 0 for vacuum.
    #[schemars(example = "1 bar")]
    pub outlet: Option<Pressure<NonNegative>>,
    /// How the rarefaction of the gas in narrow gaps is taken into account; "boltzmann" if not given.
    pub rarefaction: Option<Rarefaction>,
    /// What bounds the flow at the sides; "periodic" on a periodic domain and "closed" on a free one if not given.
    pub sides: Option<Sides>,
    /// Cells with a smaller gap are closed: the size of a molecule, say; 0 if not given.
    #[schemars(example = "0.3 nm")]
    pub smallest_gap: Option<Length<NonNegative>>,
    /// Times at which the leakage is computed: "fields", as the fields are stored; "all", which needs output.every = 1; or a
    /// list of times that are stored. "fields" if not given.
    #[schemars(example = &"fields", example = ("1 s", "10 s"))]
    pub times: Option<At<StoredTimes>>,
    /// Whether the pressure of the fluid is stored as a field; false if not given.
    #[schemars(example = true)]
    pub field: Option<bool>,
}
