//! `model = "creep-table"`.

use super::measured::table;
use crate::case::keys::*;

table! {
    /// A measured creep test from a text table, fitted by a generalised Kelvin series.
    CreepTable: Creep, CreepColumns, CreepUnits;
    /// What the compliances measure: uniaxial tension or shear.
    measure compliance;
    /// The text table, relative to the case file: one point per line, columns for time and compliance.
    /// Separator and decimal mark are detected; units come from the header, as in "time [s]; D [1/MPa]".
    path "creep.csv";
    examples {
        columns: { "time": 1, "compliance": "D [1/MPa]" },
        units: { "time": "min", "compliance": "1/MPa" }
    }
    /// Time since the step of stress.
    time: Time, 1, "s";
    /// Creep compliance.
    compliance: Compliance, 2, "1/MPa";
    /// Temperature of the point, if the file has several.
    temperature: Temperature, 3, "°C";
    /// Number or name of the sweep that the point belongs to.
    set: Set, 4, "-";
}
