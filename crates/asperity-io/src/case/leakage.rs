//! `[leakage]`: the flow of a fluid through the gap.

use asperity::Boundary;
use asperity::leakage::{Rarefaction, Sides, Species};

use super::keys::*;
use super::plan::Output;
use super::stored_times::{StoredTimes, stored_times};
use crate::leakage::{Fluid, GasKind, Leak, LeakDirection};
use crate::store::FieldKind;

/// The flow of a fluid through the gap, from the stored fields: a liquid with `pressure_drop` and `viscosity`, or
/// a gas with `inlet`, `outlet` and `gas` (or its `viscosity` and `molar_mass`). Without a fluid only the gap is assessed.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Leakage")]
pub struct LeakageKeys {
    /// Direction of the flow; "x" if not given.
    pub direction: Option<LeakDirection>,
    /// Pressure of the liquid at the inlet less that at the outlet.
    #[schemars(example = "2 bar")]
    pub pressure_drop: Option<Pressure<Positive>>,
    /// Viscosity of the liquid, or of a gas that `gas` does not name.
    pub viscosity: Option<Viscosity<Positive>>,
    /// A gas with known viscosity and molar mass.
    pub gas: Option<Species>,
    /// Molar mass of a gas that `gas` does not name.
    #[schemars(example = "0.02896 kg/mol")]
    pub molar_mass: Option<MolarMass<Positive>>,
    /// Temperature of the gas; that of the run if not given, or 20 °C if the run has none.
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
    pub times: Option<StoredTimes>,
    /// Whether the pressure of the fluid is stored as a field; false if not given.
    #[schemars(example = true)]
    pub field: Option<bool>,
}

/// What is wrong with keys, what was expected, and what to do.
struct Fault(String, &'static str, &'static str);

impl Fault {
    fn new(message: impl Into<String>, expected: &'static str, help: &'static str) -> Self {
        Fault(message.into(), expected, help)
    }
}

impl LeakageKeys {
    /// A key that belongs to a gas, where one is given.
    pub(super) fn of_gas(&self) -> Option<&'static str> {
        let keys = [
            ("gas", self.gas.is_some()),
            ("molar_mass", self.molar_mass.is_some()),
            ("inlet", self.inlet.is_some()),
            ("outlet", self.outlet.is_some()),
            ("temperature", self.temperature.is_some()),
            ("rarefaction", self.rarefaction.is_some()),
        ];
        keys.iter().find(|key| key.1).map(|key| key.0)
    }

    /// The section, checked.
    pub(super) fn of_case(
        &self,
        at: &Place<'_>,
        boundary: Boundary,
        temperatures: Option<&[(f64, f64)]>,
        output: &Output,
        end: f64,
    ) -> Option<Leak> {
        if !output.fields.contains(&FieldKind::Gap) {
            return at.fault(
                "leakage is computed from the stored gap, but output.fields does not name it",
                "\"gap\" among output.fields",
                "add \"gap\" and \"pressure\" to output.fields",
            );
        }
        let times = stored_times(&at.key("times"), self.times.as_ref(), output, end);
        let leak = match checked(self, boundary) {
            Ok(leak) => leak,
            Err(Fault(message, expected, help)) => return at.fault(message, expected, help),
        };
        Some(Leak { temperatures: temperatures.unwrap_or_default().to_vec(), times: times?, ..leak })
    }
}

/// The leakage that keys describe which stand in no case: those of a command.
///
/// # Errors
/// What is wrong, and what to do.
pub fn leak(keys: &LeakageKeys, boundary: Boundary) -> Result<Leak, String> {
    checked(keys, boundary)
        .map_err(|Fault(message, expected, help)| format!("{message}; expected {expected}; {help}"))
}

/// The leakage that the keys describe, at all stored times.
fn checked(keys: &LeakageKeys, boundary: Boundary) -> Result<Leak, Fault> {
    let usual = if boundary == Boundary::Periodic { Sides::Periodic } else { Sides::Closed };
    let sides = keys.sides.unwrap_or(usual);
    let direction = keys.direction.unwrap_or_default();
    if direction == LeakDirection::Both && boundary == Boundary::Free {
        return Err(Fault::new(
            "direction = \"both\" asks for the conductance of a gap that repeats, but the domain is free",
            "\"x\" or \"y\"",
            "set direction to \"x\" or \"y\", or domain.boundary to \"periodic\"",
        ));
    }
    Ok(Leak {
        direction,
        sides,
        smallest_gap: keys.smallest_gap.map_or(0.0, |gap| gap.get()),
        fluid: fluid(keys)?,
        field: keys.field.unwrap_or(false),
        temperatures: vec![],
        times: None,
    })
}

/// The key that is missing beside another one.
fn missing<T>(key: &str, beside: &str, help: &'static str) -> Result<T, Fault> {
    Err(Fault::new(format!("leakage needs `{key}` beside `{beside}`"), "this key", help))
}

const TWO_PRESSURES: &str = "a gas takes absolute pressures: inlet and outlet";

fn fluid(keys: &LeakageKeys) -> Result<Option<Fluid>, Fault> {
    let Some(of_gas) = keys.of_gas() else {
        return match (keys.pressure_drop, keys.viscosity) {
            (None, None) => Ok(None),
            (Some(drop), Some(viscosity)) => {
                Ok(Some(Fluid::Liquid { pressure_drop: drop.get(), viscosity: viscosity.get() }))
            }
            (Some(_), None) => missing("viscosity", "pressure_drop", "water has viscosity = \"1 mPa s\""),
            (None, Some(_)) => {
                let help = "add pressure_drop = \"...\" for a liquid; inlet, outlet and molar_mass for a gas";
                missing("pressure_drop", "viscosity", help)
            }
        };
    };
    if keys.pressure_drop.is_some() {
        let message = format!("leakage has `pressure_drop`, of a liquid, and `{of_gas}`, of a gas");
        return Err(Fault::new(message, "one fluid", TWO_PRESSURES));
    }
    let (inlet, outlet) = match (keys.inlet, keys.outlet) {
        (Some(inlet), Some(outlet)) => (inlet.get(), outlet.get()),
        (None, _) => return missing("inlet", of_gas, TWO_PRESSURES),
        (_, None) => return missing("outlet", of_gas, TWO_PRESSURES),
    };
    if inlet <= outlet {
        let message =
            format!("the pressure of the inlet, {inlet} Pa, is not above that of the outlet, {outlet} Pa");
        let help = "exchange them: a flow in the other direction is as large";
        return Err(Fault::new(message, "inlet above outlet", help));
    }
    Ok(Some(Fluid::Gas {
        kind: kind_of_gas(keys)?,
        temperature: keys.temperature.map(|temperature| temperature.get()),
        inlet,
        outlet,
        rarefaction: keys.rarefaction.unwrap_or_default(),
    }))
}

fn kind_of_gas(keys: &LeakageKeys) -> Result<GasKind, Fault> {
    match (keys.gas, keys.viscosity, keys.molar_mass) {
        (Some(species), None, None) => Ok(GasKind::Known(species)),
        (None, Some(viscosity), Some(mass)) if mass.get() <= 1.0 => {
            Ok(GasKind::Other { viscosity: viscosity.get(), molar_mass: mass.get() })
        }
        (None, Some(_), Some(mass)) => Err(Fault::new(
            format!("the molar mass is {} kg/mol", mass.get()),
            "a molar mass of a gas, below 1 kg/mol",
            "write it with its unit: molar_mass = \"28.96 g/mol\"",
        )),
        (Some(_), ..) => Err(Fault::new(
            "leakage has `gas`, and also `viscosity` or `molar_mass`, which the gas determines",
            "`gas`, or `viscosity` and `molar_mass`",
            "leave `gas` out to give both",
        )),
        (None, ..) => missing(
            "gas",
            "inlet",
            "gas = \"air\", \"nitrogen\", \"oxygen\", \"helium\" or \"hydrogen\"; or give both viscosity and molar_mass",
        ),
    }
}
