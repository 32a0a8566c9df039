//! `model = "dma"`.

use asperity::material::Modulus;

use super::measured::{Fit, Source, tables};
use super::{Dependence, Law, Model};
use crate::case::keys::*;
use crate::curve::Kind;

/// Storage and loss modulus over frequency (dynamic mechanical analysis) from a text table, at one temperature
/// or several, fitted by a Prony series.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dma {
    /// What the moduli measure: uniaxial tension or shear.
    modulus: Modulus,
    /// The text table, relative to the case file: one point per line, columns for frequency, storage modulus,
    /// loss modulus or tan delta, and temperature if there are several. Separator and decimal mark are
    /// detected; units come from the header, as in "f [Hz]; E' [MPa]; E'' [MPa]; T [°C]".
    #[schemars(example = "dma.csv")]
    path: String,
    /// The sheet of a spreadsheet (.xls, .xlsx); the first one that names such columns if not given.
    #[schemars(example = "Exported Data")]
    sheet: Option<String>,
    /// The column of each quantity, by number from 1 or by header; taken from the header if not given.
    #[schemars(example = serde_json::json!({ "frequency": 1, "storage": 2, "loss": "E'' [MPa]" }))]
    columns: Option<DmaColumns>,
    /// Units of the columns, if the header does not name them or names wrong ones.
    #[schemars(example = serde_json::json!({ "frequency": "rad/s", "storage": "MPa", "loss": "MPa" }))]
    units: Option<DmaUnits>,
    /// How the Prony series is fitted.
    #[schemars(example = serde_json::json!({ "max_terms": 20 }))]
    fit: Option<Fit>,
}

tables! {
    DmaColumns DmaUnits {
        /// Frequency, in Hz or rad/s.
        frequency: Frequency, 1, "Hz";
        /// Storage modulus.
        storage: Storage, 2, "MPa";
        /// Loss modulus; this or `tan_delta`.
        loss: Loss, 3, "MPa";
        /// Loss factor E''/E'; this or `loss`.
        tan_delta: TanDelta, 3, "%";
        /// Phase angle; in place of `tan_delta`.
        phase: Phase, 3, "deg";
        /// Absolute value of the complex modulus; in place of `storage`, with `tan_delta` or `phase`.
        complex_modulus: ComplexModulus, 2, "MPa";
        /// Real part of the complex compliance; with `loss_compliance`, in place of the moduli.
        storage_compliance: StorageCompliance, 2, "1/MPa";
        /// Imaginary part of the complex compliance.
        loss_compliance: LossCompliance, 3, "1/MPa";
        /// Absolute value of the complex viscosity; with `tan_delta` or `phase`, in place of the moduli.
        complex_viscosity: ComplexViscosity, 2, "Pa s";
        /// Real part of the complex viscosity, loss modulus over angular frequency; with `imaginary_viscosity`.
        real_viscosity: RealViscosity, 2, "Pa s";
        /// Imaginary part of the complex viscosity, storage modulus over angular frequency.
        imaginary_viscosity: ImaginaryViscosity, 3, "Pa s";
        /// Temperature of the point, if the file has several.
        temperature: Temperature, 4, "°C";
        /// Number or name of the sweep that the point belongs to.
        set: Set, 5, "-";
    }
}

impl Law for Dma {
    fn is_measured(&self) -> bool {
        true
    }

    fn fit(&self) -> Option<&Fit> {
        self.fit.as_ref()
    }

    fn model(&self, at: &Place<'_>, dependence: Dependence) -> Option<Model> {
        if let Some(DmaColumns { loss: Some(_), tan_delta: Some(_), .. }) = self.columns {
            let message = "has `loss` and `tan_delta`, but needs only one of them";
            return at.key("columns").fault(message, "one of the two", "leave one of them out");
        }
        let columns = said(self.columns.as_ref(), self.units.as_ref(), self.sheet.clone());
        let source = Source { kind: Kind::Dma, measure: self.modulus, path: &self.path, columns };
        source.model(at, self.fit.as_ref(), dependence)
    }
}
