//! Magnitudes that no contact has: a unit is wrong.
//!
//! | quantity | plausible |
//! |---|---|
//! | side of the domain | 1 nm to 10 m |
//! | radius of a shape | a cell to 2 m, and to 1000 domains |
//! | rms slope of heights | 1e-6 to 5 |
//! | depth of the gap | up to 100 domains |
//! | modulus of a body | 150 Pa to 3 TPa |
//! | largest modulus of measured data | from 0.1 MPa, if they have no unit or span a glass transition |
//! | temperature of a material with a shift | 150 K to 800 K |
//! | mean pressure of a load | from 1 Pa; and an expected contact of a tenth of a cell or more |
//! | end of the run | 1 ns to 100 years |
//! | bulk modulus of a liquid | 10 MPa, with much air in it, to 100 GPa |
//!
//! Numbers outside of these give the finding `unlikely-unit`.

use super::words::si;
use super::{Finding, UNLIKELY_UNIT};
use crate::contact::Prescribed;
use crate::simulation::Simulation;

/// Sides of domains: from atoms to larger than any machine \[m\].
pub(super) const SIDES: [f64; 2] = [1e-9, 10.0];
/// Radii this large \[m\], or this many times the domain.
pub(super) const LARGEST_RADIUS: f64 = 2.0;
pub(super) const FLATTEST: f64 = 1000.0;
/// Rms slopes: the best mirrors have 1e-5, and no machined or measured surface is as steep as the other end.
pub(super) const SLOPES: [f64; 2] = [1e-6, 5.0];
/// Ratio of the depth of a gap to the width of the domain.
pub(super) const DEEPEST: f64 = 100.0;
/// Moduli of solids: from the softest gels to above diamond \[Pa\].
pub(super) const MODULI: [f64; 2] = [150.0, 3e12];
/// Largest modulus of a polymer, at short times: softer ones are gels, which have no glass transition in the range of a DMA and are
/// measured in kPa \[Pa\].
pub(super) const SOFTEST_DATA: f64 = 1e5;
/// Ratio of moduli across a glass transition.
pub(super) const TRANSITION: f64 = 100.0;
/// Temperatures of polymers \[K\]: silicone rubber, the softest in the cold, turns to glass at about 150 K, and none withstands 800 K.
pub const TEMPERATURES: [f64; 2] = [150.0, 800.0];
/// The pressure of a sheet of paper \[Pa\].
const LIGHTEST: f64 = 1.0;
/// Cells of the smallest contact that a load is meant to make.
const LEAST_CONTACT: f64 = 0.1;
/// The end of a run: from that of an impact of atoms to a century \[s\].
const ENDS: [f64; 2] = [1e-9, 3.2e9];

/// Bulk moduli of liquids: from those with much air in them to metals \[Pa\].
const BULK_MODULI: [f64; 2] = [1e7, 1e11];

/// The end of a plausible range beyond which a value lies; `None` inside.
pub(super) fn exceeded([least, most]: [f64; 2], value: f64) -> Option<f64> {
    (!(least..=most).contains(&value)).then_some(if value < least { least } else { most })
}

/// A liquid in sealed pockets that is more like a gas or a solid.
pub(super) fn unlikely_liquid(bulk_modulus: f64) -> Option<Finding> {
    let limit = exceeded(BULK_MODULI, bulk_modulus)?;
    let text = format!(
        "The bulk modulus of the liquid is {}; oils and water have about 2 GPa. Check its unit; air is described by leakage.gas.",
        si(bulk_modulus, "Pa")
    );
    Some(Finding::warning(UNLIKELY_UNIT, bulk_modulus, limit, text))
}

/// A load that is too small for a contact: its mean pressure over the periodic domain, or the number of cells of the expected contact.
pub(super) fn unlikely_load(
    simulation: &Simulation,
    largest: Prescribed,
    cells: Option<f64>,
) -> Option<Finding> {
    let Prescribed::Load(load) = largest else { return None };
    let pressure = load / simulation.grid.area();
    let periodic = simulation.boundary == crate::Boundary::Periodic;
    let (value, limit, what) = if periodic && pressure < LIGHTEST {
        (pressure, LIGHTEST, format!("the largest mean pressure is {}", si(pressure, "Pa")))
    } else if let Some(cells) = cells.filter(|cells| *cells < LEAST_CONTACT) {
        let what =
            format!("the expected contact under the largest load, {}, has {cells:.1e} cells", si(load, "N"));
        (cells, LEAST_CONTACT, what)
    } else {
        return None;
    };
    let text = format!(
        "A contact can hardly be meant that is so light: {what}. Check the unit of load or pressure (Pa, kPa, MPa; m is milli, M is \
         mega) and those of the moduli."
    );
    Some(Finding::warning(UNLIKELY_UNIT, value, limit, text))
}

/// A run that ends at a time that nobody means.
pub(super) fn unlikely_end(simulation: &Simulation) -> Option<Finding> {
    let end = simulation.times.end();
    let limit = exceeded(ENDS, end).filter(|_| end > 0.0)?;
    let [least, most] = ENDS.map(|time| si(time, "s"));
    let text = format!(
        "The run ends at {}; contacts last from {least} to {most}. Check the unit of time.end and of the history.",
        si(end, "s")
    );
    Some(Finding::warning(UNLIKELY_UNIT, end, limit, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_liquid_is_no_gas_and_no_solid() {
        assert!([1e7, 2.2e9, 2.9e10].iter().all(|liquid| unlikely_liquid(*liquid).is_none()));
        let found = unlikely_liquid(2e3).unwrap();
        assert!(found.code == UNLIKELY_UNIT && found.limit == Some(1e7));
        assert_eq!(unlikely_liquid(2e12).unwrap().limit, Some(1e11));
    }
}
