//! `material`: the models of a body.

use asperity::material::{LongTime, Moduli, Modulus};
use schemars::JsonSchema;
use serde::Deserialize;

use super::thermal::Shift;
use super::{At, Two};
use crate::case::quantity::range::{Decades, Density, NonNegative, Order, Positive, Share, Tolerance};
use crate::case::quantity::{Compliance, Fluidity, Number, Prescribed, Pressure, Temperature, Time, Whole};
use crate::curve::VerticalWord;

/// A linear viscoelastic material. Springs and dashpots are given by moduli, either all as Young's (`young`)
/// or all as shear moduli (`shear`); Poisson's ratio or the bulk modulus converts.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(tag = "model")]
pub enum Material {
    /// A spring.
    Elastic(Elastic),
    /// Spring and dashpot in series: a fluid.
    Maxwell(Maxwell),
    /// Spring and dashpot in parallel: no instantaneous deformation.
    KelvinVoigt(KelvinVoigt),
    /// Standard linear solid: a spring in series with a Kelvin element.
    Zener(Zener),
    /// Maxwell and Kelvin elements in series.
    Burgers(Burgers),
    /// Relaxation modulus as Prony series (generalised Maxwell, Wiechert).
    Prony(Prony),
    /// Creep compliance as series (generalised Kelvin).
    Creep(Creep),
    /// A power law, between spring and dashpot: J = (t/time)^order / (modulus Gamma(1 + order)); as a Prony sum
    /// over the times of the run.
    Springpot(Springpot),
    /// Spring and springpot in series; as a Prony sum over the times of the run.
    FractionalMaxwell(FractionalMaxwell),
    /// A spring in parallel with a fractional Maxwell element; as a Prony sum over the times of the run.
    FractionalZener(FractionalZener),
    /// A measured relaxation test from a text table, fitted by a Prony series.
    RelaxationTable(RelaxationTable),
    /// A measured creep test from a text table, fitted by a generalised Kelvin series.
    CreepTable(CreepTable),
    /// Storage and loss modulus over frequency (dynamic mechanical analysis) from a text table, at one temperature
    /// or several, fitted by a Prony series.
    Dma(Box<Dma>),
}

impl Material {
    /// The keys of temperature, which all models with a time share.
    pub fn thermal(&self) -> (Option<&At<Shift>>, Option<&At<Temperature>>) {
        macro_rules! keys {
            ($($model:ident)*) => {
                match self {
                    Material::Elastic(_) => (None, None),
                    $(Material::$model(m) => (m.shift.as_ref(), m.temperature.as_ref()),)*
                }
            };
        }
        keys!(Maxwell KelvinVoigt Zener Burgers Prony Creep Springpot FractionalMaxwell FractionalZener
              RelaxationTable CreepTable Dma)
    }
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Elastic {
    /// Young's modulus; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    pub young: Option<Pressure<Positive>>,
    /// Shear modulus; this or `young`.
    #[schemars(example = "0.8 GPa")]
    pub shear: Option<Pressure<Positive>>,
}

/// Models with times: their own keys, and those of temperature.
macro_rules! models {
    ($(
        $model:ident {
            $($(#[$attribute:meta])* $key:ident: $kind:ty,)*
        }
    )*) => {$(
        #[derive(Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $model {
            $($(#[$attribute])* pub $key: $kind,)*
            /// How the times of the material depend on temperature; the given values are those at its reference.
            #[schemars(example = serde_json::json!(
                { "model": "wlf", "c1": 8.86, "c2": "101.6 K", "reference": "20 °C" }))]
            pub shift: Option<At<Shift>>,
            /// Constant temperature of this body during the run; the section [temperature] applies to all
            /// others.
            #[schemars(example = "60 °C")]
            pub temperature: Option<At<Temperature>>,
        }
    )*};
}

models! {
    Maxwell {
        /// Young's modulus of the spring; this or `shear`.
        #[schemars(example = "2.1 GPa")]
        young: Option<Pressure<Positive>>,
        /// Shear modulus of the spring; this or `young`.
        #[schemars(example = "0.8 GPa")]
        shear: Option<Pressure<Positive>>,
        /// Relaxation time: viscosity over modulus.
        #[schemars(example = "10 s")]
        relaxation_time: Time<Positive>,
    }

    KelvinVoigt {
        /// Young's modulus of the spring; this or `shear`.
        #[schemars(example = "2.1 GPa")]
        young: Option<Pressure<Positive>>,
        /// Shear modulus of the spring; this or `young`.
        #[schemars(example = "0.8 GPa")]
        shear: Option<Pressure<Positive>>,
        /// Retardation time: viscosity over modulus.
        #[schemars(example = "10 s")]
        retardation_time: Time<Positive>,
    }

    Zener {
        /// Young's modulus of the spring in series (the instantaneous modulus); this or `shear`.
        #[schemars(example = "2.1 GPa")]
        young: Option<Pressure<Positive>>,
        /// Young's modulus of the Kelvin element's spring; with `young`.
        #[schemars(example = "2.1 GPa")]
        young_kelvin: Option<Pressure<Positive>>,
        /// Shear modulus of the spring in series (the instantaneous modulus); this or `young`.
        #[schemars(example = "0.8 GPa")]
        shear: Option<Pressure<Positive>>,
        /// Shear modulus of the Kelvin element's spring; with `shear`.
        #[schemars(example = "0.8 GPa")]
        shear_kelvin: Option<Pressure<Positive>>,
        /// Retardation time of the Kelvin element.
        #[schemars(example = "10 s")]
        retardation_time: Time<Positive>,
    }

    Burgers {
        /// Young's modulus of the Maxwell element's spring; this or `shear`.
        #[schemars(example = "2.1 GPa")]
        young: Option<Pressure<Positive>>,
        /// Young's modulus of the Kelvin element's spring; with `young`.
        #[schemars(example = "2.1 GPa")]
        young_kelvin: Option<Pressure<Positive>>,
        /// Shear modulus of the Maxwell element's spring; this or `young`.
        #[schemars(example = "0.8 GPa")]
        shear: Option<Pressure<Positive>>,
        /// Shear modulus of the Kelvin element's spring; with `shear`.
        #[schemars(example = "0.8 GPa")]
        shear_kelvin: Option<Pressure<Positive>>,
        /// Relaxation time of the Maxwell element.
        #[schemars(example = "1000 s")]
        relaxation_time: Time<Positive>,
        /// Retardation time of the Kelvin element.
        #[schemars(example = "10 s")]
        retardation_time: Time<Positive>,
    }

    Prony {
        /// What the moduli measure: uniaxial tension or shear.
        modulus: Modulus,
        /// Equilibrium modulus, with absolute terms (`modulus`, `time`; 0 for a fluid) or with terms
        /// relative to it (`ratio`, `time`).
        #[schemars(example = "1973 MPa")]
        equilibrium: Option<Pressure<NonNegative>>,
        /// Instantaneous modulus, with terms relative to it (`fraction`, `time`): the g_i of finite-element codes.
        #[schemars(example = "2491.44 MPa")]
        instantaneous: Option<Pressure<Positive>>,
        /// The relaxing terms.
        #[schemars(example = serde_json::json!([{ "modulus": "254.776 MPa", "time": "8.93 s" }]))]
        terms: At<Vec<At<PronyTerm>>>,
    }

    Creep {
        /// What the compliances measure: uniaxial tension or shear.
        compliance: Modulus,
        /// Instantaneous compliance.
        #[schemars(example = "4e-4 1/MPa")]
        instantaneous: Compliance<NonNegative>,
        /// The retarded terms.
        #[schemars(example = serde_json::json!([{ "compliance": "4.47e-5 1/MPa", "time": "9.94 s" }]))]
        #[serde(default)]
        terms: Vec<CreepTerm>,
        /// Steady flow: rate of compliance after all retardation; none if not given.
        #[schemars(example = "1e-8 1/(MPa s)")]
        fluidity: Option<Fluidity<NonNegative>>,
    }

    Springpot {
        /// Young's modulus at `time`; this or `shear`.
        #[schemars(example = "3 MPa")]
        young: Option<Pressure<Positive>>,
        /// Shear modulus at `time`; this or `young`.
        #[schemars(example = "1 MPa")]
        shear: Option<Pressure<Positive>>,
        /// Time at which the compliance is 1/(modulus Gamma(1 + order)).
        #[schemars(example = "1 s")]
        time: Time<Positive>,
        /// Order of the derivative: 0 would be a spring, 1 is a dashpot.
        #[schemars(example = 0.3)]
        order: Number<Order>,
        /// Largest relative error of the Prony sum over the times of the run; 1e-3 if not given.
        #[schemars(example = 1e-3)]
        tolerance: Option<Number<Tolerance>>,
    }

    FractionalMaxwell {
        /// Young's modulus of the spring; this or `shear`.
        #[schemars(example = "3 MPa")]
        young: Option<Pressure<Positive>>,
        /// Shear modulus of the spring; this or `young`.
        #[schemars(example = "1 MPa")]
        shear: Option<Pressure<Positive>>,
        /// Relaxation time.
        #[schemars(example = "1 s")]
        time: Time<Positive>,
        /// Order of the derivative: 1 is a Maxwell element.
        #[schemars(example = 0.3)]
        order: Number<Order>,
        /// Largest relative error of the Prony sum over the times of the run; 1e-3 if not given.
        #[schemars(example = 1e-3)]
        tolerance: Option<Number<Tolerance>>,
    }

    FractionalZener {
        /// Young's modulus at equilibrium; this or `shear_equilibrium`.
        #[schemars(example = "3 MPa")]
        young_equilibrium: Option<Pressure<Positive>>,
        /// Instantaneous Young's modulus; with `young_equilibrium`.
        #[schemars(example = "3 GPa")]
        young_instantaneous: Option<Pressure<Positive>>,
        /// Shear modulus at equilibrium; this or `young_equilibrium`.
        #[schemars(example = "1 MPa")]
        shear_equilibrium: Option<Pressure<Positive>>,
        /// Instantaneous shear modulus; with `shear_equilibrium`.
        #[schemars(example = "1 GPa")]
        shear_instantaneous: Option<Pressure<Positive>>,
        /// Relaxation time.
        #[schemars(example = "1 ms")]
        time: Time<Positive>,
        /// Order of the derivative: 1 is a Zener solid.
        #[schemars(example = 0.5)]
        order: Number<Order>,
        /// Largest relative error of the Prony sum over the times of the run; 1e-3 if not given.
        #[schemars(example = 1e-3)]
        tolerance: Option<Number<Tolerance>>,
    }

    RelaxationTable {
        /// What the moduli measure: uniaxial tension or shear.
        modulus: Modulus,
        /// The text table or spreadsheet, relative to the case file: one point per line, columns for time and modulus. Separator
        /// and decimal mark are detected; units come from the header, as in "time [s]; E [MPa]".
        #[schemars(example = "relaxation.csv")]
        path: At<String>,
        /// The sheet of a spreadsheet (.xls, .xlsx); the first one that names such columns if not given.
        #[schemars(example = "Exported Data")]
        sheet: Option<String>,
        /// The column of each quantity, by number from 1 or by header; taken from the header if not given.
        #[schemars(example = serde_json::json!({ "time": 1, "modulus": "E [MPa]" }))]
        columns: Option<At<RelaxationColumns>>,
        /// Units of the columns, if the header does not name them or names wrong ones.
        #[schemars(example = serde_json::json!({ "time": "min", "modulus": "MPa" }))]
        units: Option<At<RelaxationUnits>>,
        /// How the Prony series is fitted.
        #[schemars(example = serde_json::json!({ "max_terms": 12 }))]
        fit: Option<At<Fit>>,
    }

    CreepTable {
        /// What the compliances measure: uniaxial tension or shear.
        compliance: Modulus,
        /// The text table, relative to the case file: one point per line, columns for time and compliance.
        /// Separator and decimal mark are detected; units come from the header, as in "time [s]; D [1/MPa]".
        #[schemars(example = "creep.csv")]
        path: At<String>,
        /// The sheet of a spreadsheet (.xls, .xlsx); the first one that names such columns if not given.
        #[schemars(example = "Exported Data")]
        sheet: Option<String>,
        /// The column of each quantity, by number from 1 or by header; taken from the header if not given.
        #[schemars(example = serde_json::json!({ "time": 1, "compliance": "D [1/MPa]" }))]
        columns: Option<At<CreepColumns>>,
        /// Units of the columns, if the header does not name them or names wrong ones.
        #[schemars(example = serde_json::json!({ "time": "min", "compliance": "1/MPa" }))]
        units: Option<At<CreepUnits>>,
        /// How the series is fitted.
        #[schemars(example = serde_json::json!({ "max_terms": 12 }))]
        fit: Option<At<Fit>>,
    }

    Dma {
        /// What the moduli measure: uniaxial tension or shear.
        modulus: Modulus,
        /// The text table, relative to the case file: one point per line, columns for frequency, storage modulus,
        /// loss modulus or tan delta, and temperature if there are several. Separator and decimal mark are
        /// detected; units come from the header, as in "f [Hz]; E' [MPa]; E'' [MPa]; T [°C]".
        #[schemars(example = "dma.csv")]
        path: At<String>,
        /// The sheet of a spreadsheet (.xls, .xlsx); the first one that names such columns if not given.
        #[schemars(example = "Exported Data")]
        sheet: Option<String>,
        /// The column of each quantity, by number from 1 or by header; taken from the header if not given.
        #[schemars(example = serde_json::json!({ "frequency": 1, "storage": 2, "loss": "E'' [MPa]" }))]
        columns: Option<At<DmaColumns>>,
        /// Units of the columns, if the header does not name them or names wrong ones.
        #[schemars(example = serde_json::json!({ "frequency": "rad/s", "storage": "MPa", "loss": "MPa" }))]
        units: Option<At<DmaUnits>>,
        /// How the Prony series is fitted.
        #[schemars(example = serde_json::json!({ "max_terms": 20 }))]
        fit: Option<At<Fit>>,
    }
}

/// One relaxing term: its share of the modulus and its relaxation time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PronyTerm {
    /// Modulus of the term, with `equilibrium`.
    #[schemars(example = "254.776 MPa")]
    pub modulus: Option<Pressure<Positive>>,
    /// Share of the instantaneous modulus, with `instantaneous`.
    #[schemars(example = 0.25)]
    pub fraction: Option<Number<Share>>,
    /// Modulus of the term over the equilibrium modulus, with `equilibrium` and without moduli.
    #[schemars(example = 2.5)]
    pub ratio: Option<Number<Positive>>,
    /// Relaxation time.
    #[schemars(example = "8.93 s")]
    pub time: Time<Positive>,
}

/// One retarded term: its compliance and its retardation time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CreepTerm {
    /// Compliance of the term.
    #[schemars(example = "4.47e-5 1/MPa")]
    pub compliance: Compliance<Positive>,
    /// Retardation time.
    #[schemars(example = "9.94 s")]
    pub time: Time<Positive>,
}

/// A column of a text table: its number, from 1, or its header with or without the unit.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(expecting = "the number of a column, from 1, or its header in quotes")]
pub enum Column {
    /// From 1.
    Number(u32),
    /// With or without the unit.
    Header(String),
}

/// Columns and units of the kinds of tables.
macro_rules! tables {
    ($($columns:ident $units:ident { $($(#[$attribute:meta])* $key:ident: $column:literal, $unit:literal;)* })*) => {$(
        /// The column of each quantity, by number from 1 or by header.
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $columns {
            $($(#[$attribute])* #[schemars(example = $column)] pub $key: Option<Column>,)*
        }

        /// Units of the columns.
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $units {
            $($(#[$attribute])* #[schemars(example = &$unit)] pub $key: Option<String>,)*
        }
    )*};
}

tables! {
    RelaxationColumns RelaxationUnits {
        /// Time since the step of strain.
        time: 1, "s";
        /// Relaxation modulus.
        modulus: 2, "MPa";
        /// Temperature of the point, if the file has several.
        temperature: 3, "°C";
        /// Number or name of the sweep that the point belongs to.
        set: 4, "-";
    }
    CreepColumns CreepUnits {
        /// Time since the step of stress.
        time: 1, "s";
        /// Creep compliance.
        compliance: 2, "1/MPa";
        /// Temperature of the point, if the file has several.
        temperature: 3, "°C";
        /// Number or name of the sweep that the point belongs to.
        set: 4, "-";
    }
    DmaColumns DmaUnits {
        /// Frequency, in Hz or rad/s.
        frequency: 1, "Hz";
        /// Storage modulus.
        storage: 2, "MPa";
        /// Loss modulus; this or `tan_delta`.
        loss: 3, "MPa";
        /// Loss factor E''/E'; this or `loss`.
        tan_delta: 3, "%";
        /// Phase angle; in place of `tan_delta`.
        phase: 3, "deg";
        /// Absolute value of the complex modulus; in place of `storage`, with `tan_delta` or `phase`.
        complex_modulus: 2, "MPa";
        /// Real part of the complex compliance; with `loss_compliance`, in place of the moduli.
        storage_compliance: 2, "1/MPa";
        /// Imaginary part of the complex compliance.
        loss_compliance: 3, "1/MPa";
        /// Absolute value of the complex viscosity; with `tan_delta` or `phase`, in place of the moduli.
        complex_viscosity: 2, "Pa s";
        /// Real part of the complex viscosity, loss modulus over angular frequency; with `imaginary_viscosity`.
        real_viscosity: 2, "Pa s";
        /// Imaginary part of the complex viscosity, storage modulus over angular frequency.
        imaginary_viscosity: 3, "Pa s";
        /// Temperature of the point, if the file has several.
        temperature: 4, "°C";
        /// Number or name of the sweep that the point belongs to.
        set: 5, "-";
    }
}

/// How a series is fitted to a curve.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fit {
    /// Which moduli of a dma are fitted; "both" if not given. Measured ones often contradict each other; then "storage" is
    /// usual.
    pub moduli: Option<Moduli>,
    /// Weight of a residual of the loss modulus over one of the storage modulus; 1 if not given.
    #[schemars(example = 0.3)]
    pub loss_weight: Option<Number<Positive>>,
    /// Rms misfit that is held by as few terms as possible; the data justify the number of terms if not given.
    #[schemars(example = 0.02)]
    pub misfit: Option<Number<Share>>,
    /// Largest number of terms; as many as the data justify if not given.
    #[schemars(example = 12)]
    pub max_terms: Option<Whole<1>>,
    /// Times per decade at the start of the fit; 3 if not given.
    #[schemars(example = 3)]
    pub per_decade: Option<Number<Density>>,
    /// Decades of times beyond the data on either side; 1 if not given.
    #[schemars(example = 1)]
    pub margin: Option<Number<Decades>>,
    /// Largest relative misfit, over neighbouring points, before the data are refused; 0.1 if not given.
    #[schemars(example = 0.1)]
    pub max_misfit: Option<Number<Share>>,
    /// Behaviour at times longer than the data; "free" if not given.
    pub long_time: Option<LongTime>,
    /// How the moduli of sweeps at several temperatures depend on temperature, besides their times; they do not if not given. It
    /// may stand in `shift` as well.
    pub vertical: Option<VerticalWord>,
    /// The part of the curve that is fitted: two times or, for a dma, two frequencies (after the shift, if there
    /// are several temperatures); all of it if not given.
    #[schemars(example = ("0.1 s", "1000 s"))]
    pub window: Option<Two<At<Prescribed>>>,
}
