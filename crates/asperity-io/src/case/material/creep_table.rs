//! `model = "creep-table"`.

use asperity::material::Modulus;

use super::measured::{Fit, Source, tables};
use super::{Dependence, Law, Model};
use crate::case::keys::*;
use crate::curve::Kind;

/// A measured creep test from a text table, fitted by a generalised Kelvin series.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CreepTable {
    /// What the compliances measure: uniaxial tension or shear.
    compliance: Modulus,
    /// The text table, relative to the case file: one point per line, columns for time and compliance.
    /// Separator and decimal mark are detected; units come from the header, as in "time [s]; D [1/MPa]".
    #[schemars(example = "creep.csv")]
    path: String,
    /// The sheet of a spreadsheet (.xls, .xlsx); the first one that names such columns if not given.
    #[schemars(example = "Exported Data")]
    sheet: Option<String>,
    /// The column of each quantity, by number from 1 or by header; taken from the header if not given.
    #[schemars(example = serde_json::json!({ "time": 1, "compliance": "D [1/MPa]" }))]
    columns: Option<CreepColumns>,
    /// Units of the columns, if the header does not name them or names wrong ones.
    #[schemars(example = serde_json::json!({ "time": "min", "compliance": "1/MPa" }))]
    units: Option<CreepUnits>,
    /// How the series is fitted.
    #[schemars(example = serde_json::json!({ "max_terms": 12 }))]
    fit: Option<Fit>,
}

tables! {
    CreepColumns CreepUnits {
        /// Time since the step of stress.
        time: Time, 1, "s";
        /// Creep compliance.
        compliance: Compliance, 2, "1/MPa";
        /// Temperature of the point, if the file has several.
        temperature: Temperature, 3, "°C";
        /// Number or name of the sweep that the point belongs to.
        set: Set, 4, "-";
    }
}

impl Law for CreepTable {
    fn is_measured(&self) -> bool {
        true
    }

    fn fit(&self) -> Option<&Fit> {
        self.fit.as_ref()
    }

    fn model(&self, at: &Place<'_>, dependence: Dependence) -> Option<Model> {
        let columns = said(self.columns.as_ref(), self.units.as_ref(), self.sheet.clone());
        let source = Source { kind: Kind::Creep, measure: self.compliance, path: &self.path, columns };
        source.model(at, self.fit.as_ref(), dependence)
    }
}
