//! `model = "dma"`.

use super::measured::table;
use crate::case::keys::*;

table! {
    /// Storage and loss modulus over frequency (dynamic mechanical analysis) from a text table, at one temperature
    /// or several, fitted by a Prony series.
    Dma: Dma, DmaColumns, DmaUnits;
    /// What the moduli measure: uniaxial tension or shear.
    measure modulus;
    /// The text table, relative to the case file: one point per line, columns for frequency, storage modulus,
    /// loss modulus or tan delta, and temperature if there are several. Separator and decimal mark are
    /// detected; units come from the header, as in "f [Hz]; E' [MPa]; E'' [MPa]; T [°C]".
    path "dma.csv";
    examples {
        columns: { "frequency": 1, "storage": 2, "loss": "E'' [MPa]" },
        units: { "frequency": "rad/s", "storage": "MPa", "loss": "MPa" }
    }
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
