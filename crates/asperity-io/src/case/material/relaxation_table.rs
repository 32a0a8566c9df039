//! `model = "relaxation-table"`.

use asperity::material::Modulus;

use super::measured::{Fit, Source, tables};
use super::{Dependence, Law, Model};
use crate::case::keys::*;
use crate::curve::Kind;

/// A measured relaxation test from a text table, fitted by a Prony series.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelaxationTable {
    /// What the moduli measure: uniaxial tension or shear.
    modulus: Modulus,
    /// The text table or spreadsheet, relative to the case file: one point per line, columns for time and modulus. Separator
    /// and decimal mark are detected; units come from the header, as in "time [s]; E [MPa]".
    #[schemars(example = "relaxation.csv")]
    path: String,
    /// The sheet of a spreadsheet (.xls, .xlsx); the first one that names such columns if not given.
    #[schemars(example = "Exported Data")]
    sheet: Option<String>,
    /// The column of each quantity, by number from 1 or by header; taken from the header if not given.
    #[schemars(example = serde_json::json!({ "time": 1, "modulus": "E [MPa]" }))]
    columns: Option<RelaxationColumns>,
    /// Units of the columns, if the header does not name them or names wrong ones.
    #[schemars(example = serde_json::json!({ "time": "min", "modulus": "MPa" }))]
    units: Option<RelaxationUnits>,
    /// How the Prony series is fitted.
    #[schemars(example = serde_json::json!({ "max_terms": 12 }))]
    fit: Option<Fit>,
}

tables! {
    RelaxationColumns RelaxationUnits {
        /// Time since the step of strain.
        time: Time, 1, "s";
        /// Relaxation modulus.
        modulus: Modulus, 2, "MPa";
        /// Temperature of the point, if the file has several.
        temperature: Temperature, 3, "°C";
        /// Number or name of the sweep that the point belongs to.
        set: Set, 4, "-";
    }
}

impl Law for RelaxationTable {
    fn is_measured(&self) -> bool {
        true
    }

    fn fit(&self) -> Option<&Fit> {
        self.fit.as_ref()
    }

    fn model(&self, at: &Place<'_>, dependence: Dependence) -> Option<Model> {
        let columns = said(self.columns.as_ref(), self.units.as_ref(), self.sheet.clone());
        let source = Source { kind: Kind::Relaxation, measure: self.modulus, path: &self.path, columns };
        source.model(at, self.fit.as_ref(), dependence)
    }
}
