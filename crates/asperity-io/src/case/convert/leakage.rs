//! `[leakage]`: keys that belong together.

use asperity::Boundary;
use asperity::leakage::Sides;

use super::Checks;
use super::stored_times::stored_times;
use crate::case::plan::Output;
use crate::case::raw::{self, At};
use crate::leakage::{Fluid, GasKind, Leak, LeakDirection};
use crate::store::FieldKind;

/// What is wrong with the keys of a leakage: message, what was expected, what to do.
pub struct Fault(pub String, pub &'static str, pub &'static str);

/// The section, checked; `None` where it has a fault.
pub fn section(
    checks: &mut Checks<'_, '_>,
    at: &At<raw::Leakage>,
    boundary: Boundary,
    temperatures: Option<&[(f64, f64)]>,
    output: &Output,
    end: f64,
) -> Option<Leak> {
    if !output.fields.contains(&FieldKind::Gap) {
        let message =
            "leakage is computed from the stored gap, but output.fields does not name it".to_owned();
        checks.fault(
            &at.span,
            message,
            "\"gap\" among output.fields",
            Some("add \"gap\" and \"pressure\" to output.fields"),
        );
        return None;
    }
    let times = stored_times(checks, at.value.times.as_ref(), output, end);
    match leak(&at.value, boundary) {
        Ok(leak) => {
            Some(Leak { temperatures: temperatures.unwrap_or_default().to_vec(), times: times?, ..leak })
        }
        Err(Fault(message, expected, help)) => {
            checks.fault(&at.span, message, expected, Some(help));
            None
        }
    }
}

/// The leakage that the keys describe, at all stored times.
pub fn leak(raw: &raw::Leakage, boundary: Boundary) -> Result<Leak, Fault> {
    let usual = if boundary == Boundary::Periodic { Sides::Periodic } else { Sides::Closed };
    let sides = raw.sides.unwrap_or(usual);
    let direction = raw.direction.unwrap_or_default();
    if direction == LeakDirection::Both && boundary == Boundary::Free {
        return Err(Fault(
            "direction = \"both\" asks for the conductance of a gap that repeats, but the domain is free"
                .into(),
            "\"x\" or \"y\"",
            "set direction to \"x\" or \"y\", or domain.boundary to \"periodic\"",
        ));
    }
    Ok(Leak {
        direction,
        sides,
        smallest_gap: raw.smallest_gap.map_or(0.0, |gap| gap.get()),
        fluid: fluid(raw)?,
        field: raw.field.unwrap_or(false),
        temperatures: vec![],
        times: None,
    })
}

fn fluid(raw: &raw::Leakage) -> Result<Option<Fluid>, Fault> {
    let of_gas = [
        ("gas", raw.gas.is_some()),
        ("molar_mass", raw.molar_mass.is_some()),
        ("inlet", raw.inlet.is_some()),
        ("outlet", raw.outlet.is_some()),
        ("temperature", raw.temperature.is_some()),
        ("rarefaction", raw.rarefaction.is_some()),
    ];
    let gas = of_gas.iter().find(|key| key.1).map(|key| key.0);
    let missing = |key: &str, what: &str, expected, help| {
        Err(Fault(format!("leakage needs `{key}` beside {what}"), expected, help))
    };
    match (gas, raw.pressure_drop, raw.viscosity) {
        (None, None, None) => Ok(None),
        (None, Some(drop), Some(viscosity)) => {
            Ok(Some(Fluid::Liquid { pressure_drop: drop.get(), viscosity: viscosity.get() }))
        }
        (None, Some(_), None) => {
            missing("viscosity", "`pressure_drop`", "a viscosity", "water has viscosity = \"1 mPa s\"")
        }
        (None, None, Some(_)) => missing(
            "pressure_drop",
            "`viscosity`",
            "a pressure",
            "add pressure_drop = \"...\" for a liquid; inlet, outlet and molar_mass for a gas",
        ),
        (Some(key), Some(_), _) => Err(Fault(
            format!("leakage has `pressure_drop`, of a liquid, and `{key}`, of a gas"),
            "one fluid",
            "a gas takes absolute pressures: inlet and outlet",
        )),
        (Some(key), None, viscosity) => {
            let (Some(inlet), Some(outlet)) = (raw.inlet, raw.outlet) else {
                let key = format!("`{key}`");
                let other = if raw.inlet.is_none() { "inlet" } else { "outlet" };
                return missing(
                    other,
                    &key,
                    "an absolute pressure",
                    "a gas takes absolute pressures: inlet and outlet",
                );
            };
            let (inlet, outlet) = (inlet.get(), outlet.get());
            if inlet <= outlet {
                return Err(Fault(
                    format!(
                        "the pressure of the inlet, {inlet} Pa, is not above that of the outlet, {outlet} Pa"
                    ),
                    "inlet above outlet",
                    "exchange them: a flow in the other direction is as large",
                ));
            }
            let kind = match (raw.gas, viscosity, raw.molar_mass) {
                (Some(species), None, None) => GasKind::Known(species),
                (None, Some(viscosity), Some(mass)) if mass.get() <= 1.0 => {
                    GasKind::Other { viscosity: viscosity.get(), molar_mass: mass.get() }
                }
                (None, Some(_), Some(mass)) => {
                    return Err(Fault(
                        format!("the molar mass is {} kg/mol", mass.get()),
                        "a molar mass of a gas, below 1 kg/mol",
                        "write it with its unit: molar_mass = \"28.96 g/mol\"",
                    ));
                }
                (Some(_), ..) => {
                    return Err(Fault(
                        "leakage has `gas`, which tells viscosity and molar mass, and one of them besides"
                            .into(),
                        "`gas`, or `viscosity` and `molar_mass`",
                        "leave `gas` out to give both",
                    ));
                }
                (None, ..) => {
                    return missing(
                        "gas",
                        "`inlet`",
                        "\"air\", \"nitrogen\", \"oxygen\", \"helium\" or \"hydrogen\"",
                        "or give both viscosity and molar_mass",
                    );
                }
            };
            Ok(Some(Fluid::Gas {
                kind,
                temperature: raw.temperature.map(|temperature| temperature.get()),
                inlet,
                outlet,
                rarefaction: raw.rarefaction.unwrap_or_default(),
            }))
        }
    }
}
