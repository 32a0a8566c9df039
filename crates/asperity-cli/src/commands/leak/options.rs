//! The options of a leakage as keys of `[leakage]`.

use asperity_io::case::LeakageKeys;

use crate::args::FluidOptions;
use crate::failure::Failure;
use crate::input::with_options;

/// The keys that are given.
pub fn keys(options: &FluidOptions) -> LeakageKeys {
    LeakageKeys {
        direction: options.direction,
        pressure_drop: options.pressure_drop,
        viscosity: options.viscosity,
        gas: options.gas,
        molar_mass: options.molar_mass,
        temperature: options.temperature,
        inlet: options.inlet,
        outlet: options.outlet,
        rarefaction: options.rarefaction,
        sides: options.sides,
        smallest_gap: options.smallest_gap,
        times: None,
        field: (options.field || options.no_field).then_some(options.field),
    }
}

/// What is wrong with the keys, in the words of the options.
pub fn refused(message: String) -> Failure {
    const KEYS: [&str; 10] = [
        "direction",
        "pressure_drop",
        "viscosity",
        "gas",
        "molar_mass",
        "temperature",
        "inlet",
        "outlet",
        "rarefaction",
        "sides",
    ];
    Failure::Input(with_options(&message, &KEYS))
}
