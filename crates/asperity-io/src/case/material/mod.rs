//! `material`: the models of a body. Each has a file with its keys and what they make; [`laws!`] lists them.

mod burgers;
mod creep;
mod creep_table;
mod dma;
mod elastic;
mod fractional_maxwell;
mod fractional_zener;
mod kelvin_voigt;
mod maxwell;
mod measured;
mod prony;
mod relaxation_table;
mod springpot;
mod standard_linear_solid;
mod zener;

use asperity::material::{Fractional, Material as Known, Modulus, Shift as ShiftLaw, VerticalShift};

use super::keys::*;
use super::shift::{self, Shift};
use super::temperature::possible;
use crate::Code;
use crate::curve::{Fitted, ShiftRequest, VerticalRequest};
use measured::Fit;

/// The conversion between relaxation and creep finds as many roots as there are terms.
const MOST_TERMS: usize = 1000;
/// Relative error of a Prony sum in place of a fractional model, where the case gives none.
const TOLERANCE: f64 = 1e-3;

/// A linear viscoelastic material. Springs and dashpots are given by moduli, either all as Young's (`young`)
/// or all as shear moduli (`shear`); Poisson's ratio or the bulk modulus converts.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// How the times of the material depend on temperature; the given values are those at its reference. Not of an elastic
    /// material.
    #[schemars(example = serde_json::json!(
        { "model": "wlf", "c1": 8.86, "c2": "101.6 K", "reference": "20 °C" }))]
    shift: Option<Shift>,
    /// Constant temperature of this body during the run; the section [temperature] applies to all
    /// others. Not of an elastic material.
    #[schemars(example = "60 °C")]
    temperature: Option<Temperature>,
    /// First and last time for which the material is known, at its reference temperature: those of the measurement that it was fitted
    /// to. A run that needs other times gets a warning. Not of an elastic, a fractional or a measured material.
    #[schemars(example = serde_json::json!(["0.1 s", "1000 s"]))]
    window: Option<Two<Time<NonNegative>>>,
    #[schemars(flatten)]
    model: Laws,
}

/// What a model of a material makes of its keys.
trait Law {
    /// Whether it is fitted to a file, which may say how it depends on temperature.
    fn is_measured(&self) -> bool {
        false
    }

    /// How it is fitted, where it says so.
    fn fit(&self) -> Option<&Fit> {
        None
    }

    /// What is known of it, at its reference temperature.
    fn model(&self, at: &Place<'_>, dependence: Dependence) -> Option<Model>;
}

/// The models by their name in case files.
macro_rules! laws {
    ($($name:literal $law:ident($keys:ty),)*) => {
        /// A model of a material.
        #[derive(Debug, Deserialize, JsonSchema)]
        #[schemars(tag = "model")]
        enum Laws {
            $(#[serde(rename = $name)] $law(Box<$keys>),)*
        }

        impl Laws {
            fn name(&self) -> &'static str {
                match self { $(Laws::$law(_) => $name,)* }
            }

            fn law(&self) -> &dyn Law {
                match self { $(Laws::$law(law) => &**law,)* }
            }
        }
    };
}

laws! {
    "elastic" Elastic(elastic::Elastic),
    "maxwell" Maxwell(maxwell::Maxwell),
    "kelvin-voigt" KelvinVoigt(kelvin_voigt::KelvinVoigt),
    "zener" Zener(zener::Zener),
    "standard-linear-solid" StandardLinearSolid(standard_linear_solid::StandardLinearSolid),
    "burgers" Burgers(burgers::Burgers),
    "prony" Prony(prony::Prony),
    "creep" Creep(creep::Creep),
    "springpot" Springpot(springpot::Springpot),
    "fractional-maxwell" FractionalMaxwell(fractional_maxwell::FractionalMaxwell),
    "fractional-zener" FractionalZener(fractional_zener::FractionalZener),
    "relaxation-table" RelaxationTable(relaxation_table::RelaxationTable),
    "creep-table" CreepTable(creep_table::CreepTable),
    "dma" Dma(dma::Dma),
}

/// How a material asks to depend on temperature.
pub struct Dependence {
    pub shift: ShiftRequest,
    pub vertical: VerticalRequest,
}

/// What is known of a material.
pub enum Model {
    /// All.
    Known(Known),
    /// A fractional model, which becomes a Prony sum over the times of the run.
    Fractional { measure: Modulus, model: Fractional, time: f64, tolerance: f64 },
    /// A fit of measured curves from a file.
    Fitted { fitted: Box<Fitted>, file: String },
}

impl Model {
    fn known(at: &Place<'_>, material: asperity::Result<Known>) -> Option<Model> {
        at.core(material).map(Model::Known)
    }

    fn fractional(
        measure: Modulus,
        model: Fractional,
        time: f64,
        tolerance: Option<Number<Tolerance>>,
    ) -> Model {
        Model::Fractional { measure, model, time, tolerance: tolerance.map_or(TOLERANCE, Number::get) }
    }
}

/// A material as the case gives it, at its reference temperature.
pub struct Sample {
    pub model: Model,
    /// "zener", "dma", ...
    pub name: &'static str,
    /// How its times depend on temperature.
    pub shift: Option<ShiftLaw>,
    /// How its moduli do.
    pub vertical: Option<VerticalShift>,
    /// Its own constant temperature [K].
    pub temperature: Option<f64>,
    /// First and last time for which it is known, at its reference temperature \[s\]; `None`: all times, or those of its model.
    pub window: Option<[f64; 2]>,
}

impl Sample {
    /// The shortest time that it shows in a run to `end` [s]: the shortest retardation time, at the warmest; for models that
    /// hold at all times, or were measured over any, a thousandth of the run. Infinite for elastic bodies.
    pub fn shortest(&self, temperatures: Option<&[(f64, f64)]>, end: f64) -> f64 {
        let Model::Known(material) = &self.model else { return 1e-3 * end };
        let warm = match (self.temperature, temperatures) {
            (Some(own), _) => vec![own],
            (None, Some(points)) => points.iter().map(|point| point.1).collect(),
            (None, None) => vec![],
        };
        let factors = warm.iter().filter_map(|t| self.shift.as_ref()?.factor(*t).ok());
        let fastest = factors.fold(f64::INFINITY, f64::min);
        let fastest = if fastest.is_finite() && fastest > 0.0 { fastest } else { 1.0 };
        let times = material.creep().terms.iter().map(|term| fastest * term.retardation_time);
        times.fold(f64::INFINITY, f64::min)
    }
}

impl Material {
    /// The material, before the times of the run are known.
    pub fn sample(&self, at: &Place<'_>) -> Option<Sample> {
        let law = self.model.law();
        if let Laws::Elastic(_) = self.model {
            let why = "belongs to a material with times: an elastic one has no `shift`, no `temperature` and no `window`";
            at.without(&["shift", "temperature", "window"], why, "no such key", "leave it out")?;
        }
        let vertical = law.fit().and_then(|fit| fit.vertical);
        let dependence = shift::dependence(at, self.shift.as_ref(), vertical)?;
        // A spreadsheet may hold the shift of what it measures.
        if !law.is_measured() && dependence.shift == ShiftRequest::None {
            self.without_temperature(at)?;
        }
        let (shift, vertical) = match law.is_measured() {
            true => (None, None),
            false => known(at, &dependence)?,
        };
        let model = law.model(at, dependence)?;
        let (shift, vertical) = match &model {
            Model::Fitted { fitted, .. } => (fitted.shift.clone(), fitted.vertical.clone()),
            _ => (shift, vertical),
        };
        if shift.is_none() {
            self.without_temperature(at)?;
        }
        let temperature = self.temperature.map(Temperature::get);
        if let (Some(shift), Some(kelvin)) = (&shift, temperature) {
            possible(&at.key("temperature"), "its shift", shift, kelvin)?;
        }
        let window = self.window(at, &model)?;
        Some(Sample { model, name: self.model.name(), shift, vertical, temperature, window })
    }

    /// The times for which it is known, where they are given \[s\].
    fn window(&self, at: &Place<'_>, model: &Model) -> Option<Option<[f64; 2]>> {
        let Some(window) = &self.window else { return Some(None) };
        let why = match model {
            Model::Known(_) => {
                let [first, last] = window.map(Time::get);
                return at.key("window").increasing([first, last].into_iter()).map(|_| Some([first, last]));
            }
            Model::Fractional { .. } => "is that of the run for a fractional model, which holds at all times",
            Model::Fitted { .. } => "is that of the file, whose part that is fitted is `fit.window`",
        };
        at.without(&["window"], why, "no such key", "leave it out")?;
        Some(None)
    }

    fn without_temperature(&self, at: &Place<'_>) -> Option<()> {
        if self.temperature.is_none() {
            return Some(());
        }
        at.key("temperature").fault(
            "without a `shift` the material does not depend on temperature",
            "a material with a shift",
            "add shift = { model = \"wlf\", ... } to the material, or leave the temperature out",
        )
    }
}

/// The laws of a material that comes from no file, from which they might be estimated.
fn known(at: &Place<'_>, dependence: &Dependence) -> Option<(Option<ShiftLaw>, Option<VerticalShift>)> {
    let place = if at.has("shift") { at.key("shift") } else { at.clone() };
    let shift = match &dependence.shift {
        ShiftRequest::None => None,
        ShiftRequest::Given(shift) => Some(shift.clone()),
        ShiftRequest::Estimate(_) => {
            let message = "a shift can be estimated only from a file with several temperatures";
            let help = "give the constants of the shift";
            return place.fault(message, "wlf, arrhenius or table", help);
        }
    };
    if dependence.vertical == VerticalRequest::Free {
        let message = "factors of moduli can be estimated only from a file with several temperatures";
        let help = "give vertical = \"density\"";
        return place.fault(message, "\"density\", or pairs [temperature, b_T]", help);
    }
    match dependence.vertical.known(shift.as_ref().and_then(ShiftLaw::reference)) {
        Ok(vertical) => Some((shift, vertical)),
        Err(message) => place.fault(message, "a vertical shift", ""),
    }
}

/// A law whose springs are given by Young's or by shear moduli: the keys of each spring with its place in the model and examples,
/// then the other keys, and what the law makes of them.
macro_rules! springs {
    (
        $(#[$attribute:meta])*
        $law:ident [
            $($young:ident | $shear:ident: $what:literal, $young_example:literal | $shear_example:literal;)+
        ] {
            $($(#[$key_attribute:meta])* $key:ident: $type:ty,)*
        }
        model |$keys:ident, $at:ident, $measure:ident, $moduli:pat_param| $model:expr
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $law {
            $(
                #[doc = concat!("Young's modulus ", $what, "; this or `", stringify!($shear), "`.")]
                #[schemars(example = $young_example)]
                $young: Option<Pressure<Positive>>,
                #[doc = concat!("Shear modulus ", $what, "; this or `", stringify!($young), "`.")]
                #[schemars(example = $shear_example)]
                $shear: Option<Pressure<Positive>>,
            )+
            $($(#[$key_attribute])* $key: $type,)*
        }

        impl super::Law for $law {
            fn model(&self, $at: &Place<'_>, _: super::Dependence) -> Option<super::Model> {
                let $keys = self;
                let names = [$([stringify!($young), stringify!($shear)]),+];
                let ($measure, $moduli) = super::moduli($at, names, [$([$keys.$young, $keys.$shear]),+])?;
                $model
            }
        }
    };
}
use springs;

/// The moduli of the springs that have these keys: all of them Young's, or all of them shear moduli.
fn moduli<const N: usize>(
    at: &Place<'_>,
    keys: [[&str; 2]; N],
    given: [[Option<Pressure<Positive>>; 2]; N],
) -> Option<(Modulus, [f64; N])> {
    for (n, measure) in [Modulus::Young, Modulus::Shear].into_iter().enumerate() {
        let complete = given.iter().all(|pair| pair[n].is_some() && pair[1 - n].is_none());
        if complete {
            return Some((measure, given.map(|pair| pair[n].map_or(0.0, Pressure::get))));
        }
    }
    if let [[young, shear]] = keys[..] {
        return at.exactly_one(&[young, shear]).and(None);
    }
    let [young, shear] = [0, 1].map(|n| keys.map(|pair| format!("`{}`", pair[n])).join(" and "));
    let mixed = [0, 1].iter().all(|n| given.iter().any(|pair| pair[*n].is_some()));
    let code = if mixed { Code::Conflict } else { Code::MissingKey };
    at.error(code, format!("{} needs {young}, or {shear}", at.key), &format!("{young}, or {shear}"), "")
}

fn few_terms(at: &Place<'_>, terms: usize) -> Option<()> {
    if terms <= MOST_TERMS {
        return Some(());
    }
    let message = format!("the material has {terms} terms, but may have {MOST_TERMS}");
    let help = "three terms per decade of time are enough for any measured material";
    at.fault(message, "fewer terms", help)
}
