//! `model = "relaxation-table"`.

use super::measured::table;
use crate::case::keys::*;

table! {
    /// A measured relaxation test from a text table, fitted by a Prony series.
    RelaxationTable: Relaxation, RelaxationColumns, RelaxationUnits;
    /// What the moduli measure: uniaxial tension or shear.
    measure modulus;
    /// The text table or spreadsheet, relative to the case file: one point per line, columns for time and modulus. Separator
    /// and decimal mark are detected; units come from the header, as in "time [s]; E [MPa]".
    path "relaxation.csv";
    examples {
        columns: { "time": 1, "modulus": "E [MPa]" },
        units: { "time": "min", "modulus": "MPa" }
    }
    /// Time since the step of strain.
    time: Time, 1, "s";
    /// Relaxation modulus.
    modulus: Modulus, 2, "MPa";
    /// Temperature of the point, if the file has several.
    temperature: Temperature, 3, "°C";
    /// Number or name of the sweep that the point belongs to.
    set: Set, 4, "-";
}
