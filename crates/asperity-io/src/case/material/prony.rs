//! `model = "prony"`: a Prony series in one of its three forms.

use asperity::material::{Material, Modulus, Relaxation};

use super::{Dependence, Law, Model, few_terms};
use crate::Code;
use crate::case::keys::*;

/// Relaxation modulus as Prony series (generalised Maxwell, Wiechert).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prony {
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
    terms: Vec<Term>,
}

/// One relaxing term: its share of the modulus and its relaxation time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PronyTerm")]
pub struct Term {
    /// Modulus of the term, with `equilibrium`.
    #[schemars(example = "254.776 MPa")]
    modulus: Option<Pressure<Positive>>,
    /// Share of the instantaneous modulus, with `instantaneous`.
    fraction: Option<Number<Share>>,
    /// Modulus of the term over the equilibrium modulus, with `equilibrium` and without moduli.
    #[schemars(example = 2.5)]
    ratio: Option<Number<Positive>>,
    /// Relaxation time.
    #[schemars(example = "8.93 s")]
    time: Time<Positive>,
}

impl Law for Prony {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let given = at.exactly_one(&["equilibrium", "instantaneous"])?;
        let list = at.key("terms");
        few_terms(&list, self.terms.len())?;
        let wanted = match (given, self.terms.first()) {
            ("instantaneous", _) => "fraction",
            // All terms as the first one.
            (_, Some(term)) if term.ratio.is_some() => "ratio",
            _ => "modulus",
        };
        // All of them are looked at, also after one that is wrong.
        let terms: Vec<_> =
            self.terms.iter().enumerate().map(|(n, term)| term.of(&list.item(n), wanted, given)).collect();
        let terms = terms.into_iter().collect::<Option<Vec<_>>>()?;
        let relaxation = match (wanted, self.equilibrium, self.instantaneous) {
            ("ratio", Some(equilibrium), _) => Relaxation::from_equilibrium(equilibrium.get(), &terms),
            (_, Some(equilibrium), _) => Relaxation::absolute(equilibrium.get(), &terms),
            (.., instantaneous) => Relaxation::from_instantaneous(instantaneous?.get(), &terms),
        };
        Model::known(at, Material::prony(self.modulus, at.core(relaxation)?))
    }
}

impl Term {
    /// Its value in the form `wanted`, because the material gives `given`, and its time.
    fn of(&self, at: &Place<'_>, wanted: &str, given: &str) -> Option<(f64, f64)> {
        let forms = [
            ("modulus", self.modulus.map(Pressure::get)),
            ("fraction", self.fraction.map(Number::get)),
            ("ratio", self.ratio.map(Number::get)),
        ];
        let (found, strays): (Vec<_>, Vec<_>) =
            forms.iter().filter(|form| form.1.is_some()).partition(|form| form.0 == wanted);
        if let ([(_, Some(value))], []) = (found.as_slice(), strays.as_slice()) {
            return Some((*value, self.time.get()));
        }
        let strays: Vec<&str> = strays.iter().map(|form| form.0).collect();
        let not =
            if strays.is_empty() { String::new() } else { format!(" and not `{}`", strays.join("` or `")) };
        let why = match wanted {
            "ratio" => "the first term gives a ratio to `equilibrium`".to_owned(),
            _ => format!("the material gives `{given}`"),
        };
        let help = "`equilibrium` takes terms with `modulus` or `ratio` (to it), `instantaneous` takes terms with `fraction` (of it)";
        at.error(
            Code::MissingKey,
            format!("{} must have `{wanted}`{not}, because {why}", at.key),
            wanted,
            help,
        )
    }
}
