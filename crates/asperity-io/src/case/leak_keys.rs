//! A leakage as the keys of `[leakage]`, and with some of them changed.

use asperity::Boundary;
use serde_json::json;

use super::{LeakageKeys, leak as checked};
use crate::leakage::{Fluid, GasKind, Leak};

impl Leak {
    /// The keys that describe it, without `times`.
    fn keys(&self) -> LeakageKeys {
        let mut keys = match self.fluid {
            None => json!({}),
            Some(Fluid::Liquid { pressure_drop, viscosity }) => {
                json!({ "pressure_drop": pressure_drop, "viscosity": viscosity })
            }
            Some(Fluid::Gas { kind, temperature, inlet, outlet, rarefaction }) => {
                let mut keys = match kind {
                    GasKind::Known(species) => json!({ "gas": species }),
                    GasKind::Other { viscosity, molar_mass } => {
                        json!({ "viscosity": viscosity, "molar_mass": molar_mass })
                    }
                };
                keys["temperature"] = json!(temperature);
                keys["inlet"] = json!(inlet);
                keys["outlet"] = json!(outlet);
                keys["rarefaction"] = json!(rarefaction);
                keys
            }
        };
        keys["direction"] = json!(self.direction);
        keys["sides"] = json!(self.sides);
        keys["smallest_gap"] = json!(self.smallest_gap);
        keys["field"] = json!(self.field);
        // A bare number of a key is one in SI, so that all of this is read.
        serde_json::from_value(keys).unwrap_or_default()
    }

    /// The same with the keys that are `given` changed; their `times` are ignored. A liquid in place of a gas, or a gas
    /// in place of a liquid, replaces all that was said of the fluid; the name of a gas replaces its viscosity and molar mass.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn changed(&self, given: LeakageKeys, boundary: Boundary) -> Result<Leak, String> {
        let drives = given.pressure_drop.is_some() || given.inlet.is_some() || given.outlet.is_some();
        let flows = given.direction.is_some() || given.sides.is_some() || given.smallest_gap.is_some();
        if self.coupling.is_some() && (drives || flows || given.of_gas().is_some()) {
            return Err("the fluid has acted on the surfaces of this result; expected the pressures, the flow and the fluid of its case; run \
                        the case again with the others"
                .into());
        }
        let mut keys = self.keys();
        let other_kind = match self.fluid {
            Some(Fluid::Liquid { .. }) => given.of_gas().is_some() || given.inlet.is_some(),
            Some(Fluid::Gas { .. }) => given.pressure_drop.is_some(),
            None => false,
        };
        if other_kind {
            keys = Leak { fluid: None, ..self.clone() }.keys();
        }
        if given.gas.is_some() {
            (keys.viscosity, keys.molar_mass) = (None, None);
        }
        if given.viscosity.is_some() || given.molar_mass.is_some() {
            keys.gas = None;
        }
        // What acts on the surfaces, and what needs the bodies, belongs to the run: of the same flow it is kept.
        macro_rules! merged {
            ($($key:ident)*) => {
                LeakageKeys { $($key: given.$key.or(keys.$key),)* ..LeakageKeys::default() }
            };
        }
        let merged = merged!(
            direction pressure_drop viscosity gas molar_mass temperature inlet outlet rarefaction sides smallest_gap field
        );
        let leak = checked(&merged, boundary)?;
        let (times, temperatures) = (self.times.clone(), self.temperatures.clone());
        let goes_on = |leak: &Leak| (leak.direction, leak.sides, leak.smallest_gap, leak.fluid);
        let same = goes_on(&leak) == goes_on(self);
        let (opening, one_way) = (same && self.opening, same && self.one_way);
        Ok(Leak { times, temperatures, opening, one_way, coupling: self.coupling.clone(), ..leak })
    }
}

#[cfg(test)]
mod tests {
    use asperity::leakage::{Rarefaction, Sides, Species};

    use super::*;
    use crate::leakage::LeakDirection;

    fn leak(fluid: Option<Fluid>) -> Leak {
        Leak {
            direction: LeakDirection::Y,
            sides: Sides::Closed,
            smallest_gap: 3e-10,
            fluid,
            field: true,
            opening: false,
            one_way: false,
            coupling: None,
            temperatures: vec![(0.0, 300.0)],
            times: Some(vec![1.0]),
        }
    }

    fn keys(text: &str) -> LeakageKeys {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn no_key_changes_nothing_and_one_key_changes_itself() {
        let gas = Fluid::Gas {
            kind: GasKind::Known(Species::Helium),
            temperature: Some(310.0),
            inlet: 3e5,
            outlet: 0.0,
            rarefaction: Rarefaction::Slip,
        };
        let other = Fluid::Gas {
            kind: GasKind::Other { viscosity: 1e-5, molar_mass: 0.044 },
            temperature: None,
            inlet: 3e5,
            outlet: 1e5,
            rarefaction: Rarefaction::Boltzmann,
        };
        let liquid = Fluid::Liquid { pressure_drop: 2e5, viscosity: 1e-3 };
        for fluid in [None, Some(gas), Some(other), Some(liquid)] {
            let earlier = leak(fluid);
            assert_eq!(earlier.changed(LeakageKeys::default(), Boundary::Periodic).unwrap(), earlier);
            let open = earlier.changed(keys(r#"{"smallest_gap": 0}"#), Boundary::Periodic).unwrap();
            assert_eq!(open, Leak { smallest_gap: 0.0, ..earlier });
        }
        let changed = leak(Some(gas)).changed(keys(r#"{"gas": "air"}"#), Boundary::Periodic).unwrap();
        let Some(Fluid::Gas { kind, inlet, rarefaction, .. }) = changed.fluid else { panic!("{changed:?}") };
        assert_eq!((kind, inlet, rarefaction), (GasKind::Known(Species::Air), 3e5, Rarefaction::Slip));
    }

    #[test]
    fn a_fluid_of_the_other_kind_replaces_the_earlier_one() {
        let liquid = leak(Some(Fluid::Liquid { pressure_drop: 2e5, viscosity: 1e-3 }));
        let missing = liquid.changed(keys(r#"{"gas": "air"}"#), Boundary::Periodic).unwrap_err();
        assert!(missing.contains("inlet"), "{missing}");
        let gas = keys(r#"{"gas": "air", "inlet": "2 bar", "outlet": "1 bar"}"#);
        let gas = liquid.changed(gas, Boundary::Periodic).unwrap();
        assert!(matches!(gas.fluid, Some(Fluid::Gas { .. })) && gas.direction == LeakDirection::Y);
        let back = gas.changed(keys(r#"{"pressure_drop": 1, "viscosity": 2}"#), Boundary::Periodic).unwrap();
        assert_eq!(back.fluid, Some(Fluid::Liquid { pressure_drop: 1.0, viscosity: 2.0 }));
    }
}
