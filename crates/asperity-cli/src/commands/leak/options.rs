//! The options of a leakage as keys of `[leakage]`.

use asperity_io::case::LeakageKeys;
use asperity_io::quantity::range::{NonNegative, Positive};
use asperity_io::quantity::{Length, MolarMass, Pressure, Temperature, Viscosity};

use crate::args::FluidOptions;
use crate::failure::Failure;
use crate::input::read;

/// The keys that are given.
pub fn keys(options: &FluidOptions) -> Result<LeakageKeys, Failure> {
    let pressure = |flag: &'static str, text: &Option<String>, example: &'static str| {
        text.as_deref().map(|text| read::<Pressure<Positive>>(flag, text, example)).transpose()
    };
    let outlet = options.outlet.as_deref();
    let viscosity = options.viscosity.as_deref();
    let molar_mass = options.molar_mass.as_deref();
    let smallest = options.smallest_gap.as_deref();
    let temperature = options.temperature.as_deref();
    Ok(LeakageKeys {
        direction: options.direction,
        pressure_drop: pressure("--pressure-drop", &options.pressure_drop, "2 bar")?,
        viscosity: viscosity
            .map(|text| read::<Viscosity<Positive>>("--viscosity", text, "1 mPa s"))
            .transpose()?,
        gas: options.gas,
        molar_mass: molar_mass
            .map(|text| read::<MolarMass<Positive>>("--molar-mass", text, "44 g/mol"))
            .transpose()?,
        temperature: temperature
            .map(|text| read::<Temperature>("--temperature", text, "20 degC"))
            .transpose()?,
        inlet: pressure("--inlet", &options.inlet, "3 bar")?,
        outlet: outlet.map(|text| read::<Pressure<NonNegative>>("--outlet", text, "1 bar")).transpose()?,
        rarefaction: options.rarefaction,
        sides: options.sides,
        smallest_gap: smallest
            .map(|text| read::<Length<NonNegative>>("--smallest-gap", text, "0.3 nm"))
            .transpose()?,
        times: None,
        field: match (options.field, options.no_field) {
            (true, _) => Some(true),
            (_, true) => Some(false),
            _ => None,
        },
    })
}
