//! The options of a leakage as keys of `[leakage]`.

use asperity_io::case::{Form, LeakageKeys};

use crate::args::FluidOptions;

/// The keys that are given.
pub fn keys(options: &FluidOptions) -> LeakageKeys {
    LeakageKeys {
        direction: options.direction,
        pressure_drop: options.pressure_drop,
        viscosity: options.viscosity,
        gas: options.gas,
        molar_mass: options.molar_mass,
        temperature: options.temperature,
        inlet: options.inlet.map(Form::Word),
        outlet: options.outlet,
        rarefaction: options.rarefaction,
        sides: options.sides,
        smallest_gap: options.smallest_gap,
        field: (options.field || options.no_field).then_some(options.field),
        ..LeakageKeys::default()
    }
}
