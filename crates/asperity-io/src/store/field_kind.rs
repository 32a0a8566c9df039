//! The fields that a result may keep.

use asperity::step::Step;
use ndarray::Array2;
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
    /// Contact state: 0 out of contact, 1 in contact, 2 at the hardness, 3 slipping under a tangential load.
    Contact,
    /// Permanent flattening, in m: what the undeformed gap has gained; with plasticity = "accumulate".
    Flattening,
    /// Pressure of the cells in contact, in Pa, 0 or more; with adhesion, where `pressure` is less by the attraction.
    #[serde(rename = "contact_pressure")]
    ContactPressure,
    /// Attraction between the surfaces, in Pa; with adhesion.
    #[serde(rename = "adhesive_traction")]
    AdhesiveTraction,
    /// Tangential traction along x, in Pa; of a contact with a tangential load, as those that follow.
    #[serde(rename = "traction_x")]
    TractionX,
    /// Tangential traction along y, in Pa.
    #[serde(rename = "traction_y")]
    TractionY,
    /// Slip along x since t = 0, of each cell while it was in contact, in m.
    #[serde(rename = "slip_x")]
    SlipX,
    /// Slip along y since t = 0, in m.
    #[serde(rename = "slip_y")]
    SlipY,
    /// Length of the path of the slip of each cell since t = 0, in m: four times the amplitude in each cycle to and fro.
    #[serde(rename = "slip_path")]
    SlipPath,
    /// Energy per area that friction has turned into heat in each cell since t = 0, in J/m2.
    #[serde(rename = "friction_work")]
    FrictionWork,
}

impl FieldKind {
    /// Every kind.
    pub const ALL: [FieldKind; 13] = [
        FieldKind::Pressure,
        FieldKind::Gap,
        FieldKind::Displacement,
        FieldKind::Contact,
        FieldKind::Flattening,
        FieldKind::ContactPressure,
        FieldKind::AdhesiveTraction,
        FieldKind::TractionX,
        FieldKind::TractionY,
        FieldKind::SlipX,
        FieldKind::SlipY,
        FieldKind::SlipPath,
        FieldKind::FrictionWork,
    ];

    /// Its name in case files and results.
    pub fn name(self) -> &'static str {
        choice::word(&self)
    }

    /// The kind of that name.
    pub fn from_name(name: &str) -> Option<FieldKind> {
        choice::parse(name)
    }

    /// Whether only a contact with friction has it.
    pub fn is_of_friction(self) -> bool {
        use FieldKind::{FrictionWork, SlipPath, SlipX, SlipY, TractionX, TractionY};
        matches!(self, TractionX | TractionY | SlipX | SlipY | SlipPath | FrictionWork)
    }

    /// Its unit; "1" where it has none.
    pub fn units(self) -> &'static str {
        match self {
            FieldKind::Pressure
            | FieldKind::ContactPressure
            | FieldKind::AdhesiveTraction
            | FieldKind::TractionX
            | FieldKind::TractionY => "Pa",
            FieldKind::Gap
            | FieldKind::Displacement
            | FieldKind::Flattening
            | FieldKind::SlipX
            | FieldKind::SlipY
            | FieldKind::SlipPath => "m",
            FieldKind::FrictionWork => "J/m2",
            FieldKind::Contact => "1",
        }
    }

    /// Writes the numbers of a row; of the contact state the pressure.
    pub fn of_step(self, step: &Step<'_>, field: &mut Array2<f64>) {
        match self {
            FieldKind::Pressure | FieldKind::Contact => field.assign(&step.pressure()),
            FieldKind::Gap => step.gap_into(field),
            FieldKind::Displacement => step.displacement_into(field),
            FieldKind::Flattening => step.flattening_into(field),
            FieldKind::ContactPressure => field.assign(&step.contact_pressure()),
            FieldKind::AdhesiveTraction => step.adhesive_traction_into(field),
            FieldKind::TractionX => step.tangential_traction_into(0, field),
            FieldKind::TractionY => step.tangential_traction_into(1, field),
            FieldKind::SlipX => step.slip_into(0, field),
            FieldKind::SlipY => step.slip_into(1, field),
            FieldKind::SlipPath => step.slip_path_into(field),
            FieldKind::FrictionWork => step.friction_work_into(field),
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
            FieldKind::TractionX => "tangential traction along x",
            FieldKind::TractionY => "tangential traction along y",
            FieldKind::SlipX => "slip along x since t = 0",
            FieldKind::SlipY => "slip along y since t = 0",
            FieldKind::SlipPath => "path of the slip since t = 0",
            FieldKind::FrictionWork => "work of friction per area since t = 0",
        }
    }
}

impl std::fmt::Display for FieldKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
