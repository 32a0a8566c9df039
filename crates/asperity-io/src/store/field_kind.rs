//! The fields that a result may keep.

use schemars::JsonSchema;
use serde::Deserialize;

use super::layout::DataType;
use crate::choice;

/// A field on the grid that a result may keep over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FieldKind {
    /// Pressure p between the surfaces, in Pa, positive in compression; negative where they pull at each other.
    Pressure,
    /// Gap h between the deformed surfaces, in m.
    Gap,
    /// Normal displacement u, in m.
    Displacement,
    /// Contact state: 0 out of contact, 1 in contact, 2 at the hardness.
    Contact,
    /// Permanent flattening, in m: what the undeformed gap has gained; with plasticity = "accumulate".
    Flattening,
    /// Pressure of the cells in contact, in Pa, 0 or more; with adhesion, where `pressure` is less by the attraction.
    #[serde(rename = "contact_pressure")]
    ContactPressure,
    /// Attraction between the surfaces, in Pa; with adhesion.
    #[serde(rename = "adhesive_traction")]
    AdhesiveTraction,
}

impl FieldKind {
    /// Every kind.
    pub const ALL: [FieldKind; 7] = [
        FieldKind::Pressure,
        FieldKind::Gap,
        FieldKind::Displacement,
        FieldKind::Contact,
        FieldKind::Flattening,
        FieldKind::ContactPressure,
        FieldKind::AdhesiveTraction,
    ];

    /// Its name in case files and results.
    pub fn name(self) -> &'static str {
        choice::word(&self)
    }

    /// The kind of that name.
    pub fn from_name(name: &str) -> Option<FieldKind> {
        choice::parse(name)
    }

    /// Its unit; "1" where it has none.
    pub fn units(self) -> &'static str {
        match self {
            FieldKind::Pressure | FieldKind::ContactPressure | FieldKind::AdhesiveTraction => "Pa",
            FieldKind::Gap | FieldKind::Displacement | FieldKind::Flattening => "m",
            FieldKind::Contact => "1",
        }
    }

    pub(super) fn data_type(self) -> DataType {
        if self == FieldKind::Contact { DataType::UInt8 } else { DataType::Float64 }
    }

    /// Bytes per cell.
    pub(crate) fn bytes(self) -> u64 {
        self.data_type().width() as u64
    }

    /// What it is, for axes and legends.
    pub fn long_name(self) -> &'static str {
        match self {
            FieldKind::Pressure => "contact pressure",
            FieldKind::Gap => "gap between the deformed surfaces",
            FieldKind::Displacement => "normal displacement",
            FieldKind::Contact => "contact state",
            FieldKind::Flattening => "permanent flattening",
            FieldKind::ContactPressure => "pressure of the cells in contact",
            FieldKind::AdhesiveTraction => "attraction between the surfaces",
        }
    }
}

impl std::fmt::Display for FieldKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
