//! `[leakage]`: the flow of a fluid through the gap.

use asperity::Boundary;
use asperity::leakage::{Rarefaction, Sides, Species};
use asperity::traction::{Action, Pockets};

use super::history::{Course, Kind};
use super::keys::*;
use super::plan::Output;
use super::stored_times::{StoredTimes, stored_times};
use crate::leakage::{Coupling, Fluid, GasKind, Leak, LeakDirection};
use crate::store::FieldKind;

/// The flow of a fluid through the gap, from the stored fields: a liquid with `viscosity` and `pressure_drop`, or `inlet` and
/// `outlet`; or a gas with `inlet`, `outlet` and `gas` (or its `viscosity` and `molar_mass`). Without a fluid only the gap is assessed.
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
    /// Absolute pressure at the inlet; of a fluid that acts on the surfaces (`coupling`) also a history, with the kinds of load.history;
    /// a ramp, a triangle and a trapezoid then begin at the pressure of the outlet.
    #[schemars(example = "3 bar")]
    #[schemars(example = serde_json::json!({ "kind": "table", "points": [["0 s", "1 bar"], ["5 s", "3 bar"]] }))]
    pub inlet: Option<Course<Pressure<Positive>>>,
    /// Absolute pressure at the outlet; 0 for vacuum.
    #[schemars(example = "1 bar")]
    pub outlet: Option<Pressure<NonNegative>>,
    /// Whether the pressure of the fluid acts on the surfaces: "one-way": it does not; "two-way": it opens the contact where it flows;
    /// "uniform": the pressure of the inlet acts everywhere, which is exact where inlet and outlet have the same pressure. "one-way"
    /// if not given.
    pub coupling: Option<CouplingKind>,
    /// The pressure that the load does not contain: that of the "outlet", or "vacuum"; with `coupling`; "outlet" if not given.
    pub reference: Option<Reference>,
    /// The pressure of pockets that neither inlet nor outlet reaches: "kept" from the time when they were cut off, "drained", "sealed":
    /// what is in them stays in them, and the pressure rises as they are pressed together, or "connected": fluid creeps into them
    /// through contacts with the gap `smallest_gap`. With coupling = "two-way"; "kept" if not given.
    pub pockets: Option<Pockets>,
    /// Bulk modulus of the liquid in pockets = "sealed"; a gas needs none.
    #[schemars(example = "2 GPa")]
    pub bulk_modulus: Option<Pressure<Positive>>,
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
    /// Whether the pressure of the inlet that opens the contact is computed at these times (`opening_pressure`); false if not given.
    #[schemars(example = true)]
    pub opening: Option<bool>,
    /// Whether the leak of a fluid that does not act on the surfaces is computed too (`leak_rate_one_way`), by a second run; with
    /// `coupling`; false if not given.
    #[schemars(example = true)]
    pub one_way: Option<bool>,
}

impl Word for Pressure<Positive> {
    const FORMS: &'static str =
        "a pressure such as \"3 bar\", or a history such as { kind = \"table\", ... }";
    const IS_QUANTITY: bool = true;
}

/// Whether the fluid acts on the surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CouplingKind {
    /// It does not.
    OneWay,
    /// The pressure of the inlet acts everywhere.
    Uniform,
    /// It acts where it flows.
    TwoWay,
}

/// What the load does not contain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reference {
    /// The pressure of the outlet.
    Outlet,
    /// Nothing.
    Vacuum,
}

/// What is wrong with keys, what was expected, and what to do.
struct Fault(String, &'static str, &'static str);

impl Fault {
    fn new(message: impl Into<String>, expected: &'static str, help: &'static str) -> Self {
        Fault(message.into(), expected, help)
    }
}

impl LeakageKeys {
    /// Whether the fluid acts on the surfaces.
    pub(super) fn acts(&self) -> bool {
        matches!(self.coupling, Some(CouplingKind::Uniform | CouplingKind::TwoWay))
    }

    /// Whether its flow and the contact are solved together.
    pub(super) fn flows_with_the_contact(&self) -> bool {
        self.coupling == Some(CouplingKind::TwoWay)
    }

    /// A key that belongs to a gas, where one is given.
    pub(super) fn of_gas(&self) -> Option<&'static str> {
        let keys = [
            ("gas", self.gas.is_some()),
            ("molar_mass", self.molar_mass.is_some()),
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
        let opens = self.opening == Some(true);
        if opens && !output.fields.contains(&FieldKind::Pressure) {
            return at.key("opening").fault(
                "the opening pressure is computed from the stored pressure, but output.fields does not name it",
                "\"pressure\" among output.fields",
                "add \"pressure\" to output.fields",
            );
        }
        let times = stored_times(&at.key("times"), self.times.as_ref(), output, end);
        let kind = Kind { unit: "Pa", presses: true };
        let help = "give the pressure as a number or a table";
        let inlet = match &self.inlet {
            Some(inlet) => Some(inlet.history(&at.key("inlet"), kind, help)?),
            None => None,
        };
        let leak = match checked(self, boundary, inlet) {
            Ok(leak) => leak,
            Err(Fault(message, expected, help)) => return at.fault(message, expected, help),
        };
        let changing = |points: &[(f64, f64)]| points.iter().any(|point| point.1 != points[0].1);
        let of_run = matches!(leak.fluid, Some(Fluid::Gas { temperature: None, .. }));
        if leak.coupling.is_some() && of_run && temperatures.is_some_and(changing) {
            return at.key("coupling").fault(
                "the rarefaction of a gas that acts on the surfaces is that of one temperature, but that of the run changes",
                "`temperature` in [leakage]",
                "give the temperature of the gas; it hardly changes where the surfaces open",
            );
        }
        Some(Leak { temperatures: temperatures.unwrap_or_default().to_vec(), times: times?, ..leak })
    }
}

/// The leakage that keys describe which stand in no case: those of a command.
///
/// # Errors
/// What is wrong, and what to do.
pub fn leak(keys: &LeakageKeys, boundary: Boundary) -> Result<Leak, String> {
    let inlet = match &keys.inlet {
        Some(Form::Word(pressure)) => Some(held(pressure.get())),
        None => None,
        Some(_) => return Err("the pressure of the inlet over time belongs to a case".into()),
    };
    if let Some(CouplingKind::Uniform | CouplingKind::TwoWay) = keys.coupling {
        return Err(
            "a fluid that acts on the surfaces belongs to a case: it is solved with the contact".into()
        );
    }
    checked(keys, boundary, inlet)
        .map_err(|Fault(message, expected, help)| format!("{message}; expected {expected}; {help}"))
}

fn held(value: f64) -> asperity::History {
    asperity::History::Step { value }
}

/// The leakage that the keys describe, at all stored times, with the pressure of its inlet over time.
fn checked(keys: &LeakageKeys, boundary: Boundary, inlet: Option<asperity::History>) -> Result<Leak, Fault> {
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
    let fluid = fluid(keys, inlet.as_ref())?;
    let is_asked = |key: Option<bool>| key == Some(true);
    if is_asked(keys.one_way) && !keys.acts() {
        return Err(Fault::new(
            "leakage has `one_way`, but the fluid does not act on the surfaces: its leak is the one-way one",
            "coupling = \"two-way\"",
            "set coupling, or leave one_way out",
        ));
    }
    if is_asked(keys.opening) && keys.coupling == Some(CouplingKind::Uniform) {
        return Err(Fault::new(
            "leakage has `opening`, but a fluid that acts everywhere opens nothing until it lifts the surfaces",
            "coupling = \"two-way\" or \"one-way\"",
            "set coupling, or leave opening out",
        ));
    }
    Ok(Leak {
        direction,
        sides,
        smallest_gap: keys.smallest_gap.map_or(0.0, |gap| gap.get()),
        coupling: coupling(keys, inlet, fluid.as_ref())?,
        fluid,
        field: keys.field.unwrap_or(false),
        opening: is_asked(keys.opening),
        one_way: is_asked(keys.one_way),
        temperatures: vec![],
        times: None,
    })
}

/// The key that is missing beside another one.
fn missing<T>(key: &str, beside: &str, help: &'static str) -> Result<T, Fault> {
    Err(Fault::new(format!("leakage needs `{key}` beside `{beside}`"), "this key", help))
}

const TWO_PRESSURES: &str = "a gas takes absolute pressures: inlet and outlet";
/// Gases have smaller viscosities \[Pa s\].
const THINNEST_LIQUID: f64 = 5e-5;

/// Inlet, its largest pressure, and outlet; `None` where neither is given.
fn pressures(
    keys: &LeakageKeys,
    inlet: Option<&asperity::History>,
    beside: &str,
) -> Result<Option<[f64; 2]>, Fault> {
    let (inlet, outlet) = match (inlet, keys.outlet) {
        (None, None) => return Ok(None),
        (Some(inlet), Some(outlet)) => (inlet.range(f64::MAX)[1], outlet.get()),
        (None, Some(_)) => return missing("inlet", beside, TWO_PRESSURES),
        (Some(_), None) => return missing("outlet", beside, TWO_PRESSURES),
    };
    if inlet < outlet || inlet == outlet && !keys.acts() {
        let message =
            format!("the pressure of the inlet, {inlet} Pa, is not above that of the outlet, {outlet} Pa");
        let help = "exchange them: a flow in the other direction is as large";
        return Err(Fault::new(message, "inlet above outlet", help));
    }
    Ok(Some([inlet, outlet]))
}

fn fluid(keys: &LeakageKeys, inlet: Option<&asperity::History>) -> Result<Option<Fluid>, Fault> {
    let of_gas = keys.of_gas();
    let ends = pressures(keys, inlet, of_gas.unwrap_or("viscosity"))?;
    if let (None, Some(viscosity), Some([inlet, outlet])) = (of_gas, keys.viscosity, ends) {
        let viscosity = viscosity.get();
        if keys.pressure_drop.is_some() {
            let message = "leakage has `pressure_drop`, and also `inlet` and `outlet`, which give it";
            return Err(Fault::new(message, "one of the two", "leave one of them out"));
        }
        if viscosity < THINNEST_LIQUID {
            let message = format!("a viscosity of {viscosity} Pa s is that of a gas");
            let help = "of a gas give `gas`, or viscosity and molar_mass; of a liquid the viscosity with its unit, \"1 mPa s\"";
            return Err(Fault::new(message, "a liquid, or what the gas is", help));
        }
        return Ok(Some(Fluid::Liquid { pressure_drop: inlet - outlet, viscosity, outlet }));
    }
    let Some(of_gas) = of_gas.or(ends.map(|_| "inlet")) else {
        return match (keys.pressure_drop, keys.viscosity) {
            (None, None) => Ok(None),
            (Some(drop), Some(viscosity)) => {
                Ok(Some(Fluid::Liquid { pressure_drop: drop.get(), viscosity: viscosity.get(), outlet: 0.0 }))
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
    let Some([inlet, outlet]) = ends else { return missing("inlet", of_gas, TWO_PRESSURES) };
    Ok(Some(Fluid::Gas {
        kind: kind_of_gas(keys)?,
        temperature: keys.temperature.map(|temperature| temperature.get()),
        inlet,
        outlet,
        rarefaction: keys.rarefaction.unwrap_or_default(),
    }))
}

/// How the fluid acts on the surfaces.
fn coupling(
    keys: &LeakageKeys,
    inlet: Option<asperity::History>,
    fluid: Option<&Fluid>,
) -> Result<Option<Coupling>, Fault> {
    let action = match keys.coupling.unwrap_or(CouplingKind::OneWay) {
        CouplingKind::OneWay => None,
        CouplingKind::Uniform => Some(Action::Everywhere),
        CouplingKind::TwoWay => Some(Action::Gaps(keys.pockets.unwrap_or_default())),
    };
    let needs = |key: &str, kind: &'static str, help| {
        Err(Fault::new(
            format!("leakage has `{key}`, but the fluid does not act on the surfaces that way"),
            kind,
            help,
        ))
    };
    if keys.pockets.is_some() && !matches!(action, Some(Action::Gaps(_))) {
        return needs("pockets", "coupling = \"two-way\"", "set coupling, or leave pockets out");
    }
    let holds_liquid =
        action == Some(Action::Gaps(Pockets::Sealed)) && matches!(fluid, Some(Fluid::Liquid { .. }));
    if keys.bulk_modulus.is_some() && !holds_liquid {
        let message = "leakage has `bulk_modulus`, that of a liquid in sealed pockets";
        let help =
            "leave bulk_modulus out, or set pockets = \"sealed\"; a gas is compressed as its pressure says";
        return Err(Fault::new(
            message,
            "a liquid, with coupling = \"two-way\" and pockets = \"sealed\"",
            help,
        ));
    }
    if keys.bulk_modulus.is_none() && holds_liquid {
        return missing(
            "bulk_modulus",
            "pockets = \"sealed\"",
            "water has bulk_modulus = \"2.2 GPa\", oil about \"1.6 GPa\"",
        );
    }
    let Some(action) = action else {
        if keys.reference.is_some() {
            return needs("reference", "coupling = \"two-way\"", "set coupling, or leave reference out");
        }
        if matches!(keys.inlet, Some(Form::Table(_))) {
            let help = "set coupling = \"two-way\", or give the pressure as a number";
            return needs("inlet", "a pressure that is held, or coupling = \"two-way\"", help);
        }
        return Ok(None);
    };
    let (inlet, outlet) = match (inlet, keys.outlet, fluid) {
        (Some(inlet), Some(outlet), _) => (from_outlet(inlet, outlet.get()), outlet.get()),
        (_, _, Some(Fluid::Liquid { pressure_drop, .. })) => (held(*pressure_drop), 0.0),
        _ => {
            return missing(
                "inlet",
                "coupling",
                "give inlet, outlet and viscosity of a liquid; or inlet, outlet and gas",
            );
        }
    };
    let reference = match keys.reference.unwrap_or(Reference::Outlet) {
        Reference::Outlet => outlet,
        Reference::Vacuum => 0.0,
    };
    let bulk_modulus = keys.bulk_modulus.as_ref().map(|modulus| modulus.get());
    Ok(Some(Coupling { action, inlet, outlet, reference, bulk_modulus }))
}

/// The pressure of the inlet over time: what would begin at 0 begins where nothing flows, at the pressure of the outlet.
fn from_outlet(inlet: asperity::History, outlet: f64) -> asperity::History {
    use asperity::History::{Ramp, Table, Trapezoid, Triangle};
    let rest = (0.0, outlet);
    let points = match inlet {
        _ if outlet == 0.0 => return inlet,
        Ramp { value, duration } => vec![rest, (duration, value)],
        Triangle { peak, rise, fall } => vec![rest, (rise, peak), (rise + fall, outlet)],
        Trapezoid { peak, rise, hold, fall } => {
            vec![rest, (rise, peak), (rise + hold, peak), (rise + hold + fall, outlet)]
        }
        other => return other,
    };
    Table { points }
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
            "of a liquid give its viscosity; of a gas gas = \"air\", \"nitrogen\", \"oxygen\", \"helium\" or \"hydrogen\"; or give both viscosity and molar_mass",
        ),
    }
}
