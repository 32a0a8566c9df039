//! The fields that a result may keep: one table, which store, case, exports, figures, pages and Python read.

use asperity::flash::Partition;
use asperity::step::Step;
use asperity::{Plasticity, Simulation};
use ndarray::Array2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::layout::DataType;
use crate::choice;

/// How a field is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// In the colours of pressures, of gaps, of amounts from 0 on, of values of both signs, of heat and work.
    Pressure,
    /// See above.
    Gap,
    /// See above.
    Amount,
    /// See above.
    Signed,
    /// See above.
    Heat,
    /// As states, each with a colour of its own.
    States,
}

/// Which contacts have a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Of {
    All,
    Flattening,
    Traction,
    Adhesion,
    Friction,
    Wear,
    Flash,
}

/// A declaration of a field.
struct Declaration {
    units: &'static str,
    long_name: &'static str,
    short_name: &'static str,
    look: Look,
    of: Of,
    write: fn(&Step<'_>, &mut Array2<f64>),
}

macro_rules! fields {
    ($($(#[$doc:meta])* $kind:ident = $name:literal [$units:literal] $long_name:literal, $short_name:literal, $look:ident, $of:ident, $write:expr;)*) => {
        /// A field on the grid that a result may keep over time.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, JsonSchema)]
        pub enum FieldKind {
            $($(#[$doc])* #[serde(rename = $name)] $kind,)*
        }

        impl FieldKind {
            /// Every kind.
            pub const ALL: [FieldKind; [$(FieldKind::$kind),*].len()] = [$(FieldKind::$kind),*];

            fn declaration(self) -> Declaration {
                match self {
                    $(FieldKind::$kind => Declaration {
                        units: $units,
                        long_name: $long_name,
                        short_name: $short_name,
                        look: Look::$look,
                        of: Of::$of,
                        write: $write,
                    },)*
                }
            }
        }
    };
}

fields! {
    /// Pressure p between the surfaces, in Pa, positive in compression; negative where they pull at each other.
    Pressure = "pressure" ["Pa"] "contact pressure", "pressure", Pressure, All, |step, to| to.assign(&step.pressure());
    /// Gap h between the deformed surfaces, in m.
    Gap = "gap" ["m"] "gap between the deformed surfaces", "gap", Gap, All, |step, to| step.gap_into(to);
    /// Normal displacement u, in m.
    Displacement = "displacement" ["m"] "normal displacement", "displacement", Amount, All, |step, to| step.displacement_into(to);
    /// Contact state: 0 out of contact, 1 in contact, 2 at the hardness, 3 slipping under a tangential load.
    Contact = "contact" ["1"] "contact state", "contact", States, All, |step, to| to.assign(&step.pressure());
    /// Permanent flattening, in m: what the undeformed gap has gained; with plasticity = "accumulate".
    Flattening = "flattening" ["m"] "permanent flattening", "permanent flattening", Amount, Flattening, |step, to| step.flattening_into(to);
    /// Pressure of the cells in contact, in Pa, 0 or more; with adhesion, where `pressure` is less by the attraction.
    ContactPressure = "contact_pressure" ["Pa"] "pressure of the cells in contact", "contact pressure", Pressure, Traction,
        |step, to| to.assign(&step.contact_pressure());
    /// Attraction between the surfaces, in Pa; with adhesion.
    AdhesiveTraction = "adhesive_traction" ["Pa"] "attraction between the surfaces", "attraction", Amount, Adhesion,
        |step, to| step.adhesive_traction_into(to);
    /// Tangential traction along x, in Pa; of a contact with a tangential load, as those that follow.
    TractionX = "traction_x" ["Pa"] "tangential traction along x", "traction along x", Signed, Friction,
        |step, to| step.tangential_traction_into(0, to);
    /// Tangential traction along y, in Pa.
    TractionY = "traction_y" ["Pa"] "tangential traction along y", "traction along y", Signed, Friction,
        |step, to| step.tangential_traction_into(1, to);
    /// Slip along x since t = 0, of each cell while it was in contact, in m.
    SlipX = "slip_x" ["m"] "slip along x since t = 0", "slip along x", Signed, Friction, |step, to| step.slip_into(0, to);
    /// Slip along y since t = 0, in m.
    SlipY = "slip_y" ["m"] "slip along y since t = 0", "slip along y", Signed, Friction, |step, to| step.slip_into(1, to);
    /// Length of the path of the slip of each cell since t = 0, in m: four times the amplitude in each cycle to and fro.
    SlipPath = "slip_path" ["m"] "path of the slip since t = 0", "path of the slip", Heat, Friction, |step, to| step.slip_path_into(to);
    /// Energy per area that friction has turned into heat in each cell since t = 0, in J/m2.
    FrictionWork = "friction_work" ["J/m2"] "work of friction per area since t = 0", "work of friction per area", Heat, Friction,
        |step, to| step.friction_work_into(to);
    /// Depth that wear has taken off the body, which moves with the contact, since t = 0, in m; of surfaces that wear, as those that follow.
    WearDepth = "wear_depth" ["m"] "worn depth of the body since t = 0", "worn depth", Amount, Wear, |step, to| step.wear_depth_into(0, to);
    /// Depth that wear has taken off the counterbody since t = 0, in m; in motion in the frame of the track, not of the contact.
    CounterbodyWearDepth = "counterbody_wear_depth" ["m"] "worn depth of the counterbody since t = 0", "worn depth of the counterbody",
        Amount, Wear, |step, to| step.wear_depth_into(1, to);
    /// Gap between the undeformed surfaces as they are worn and flattened now, in m.
    UndeformedGap = "undeformed_gap" ["m"] "gap between the undeformed surfaces", "undeformed gap", Gap, Wear,
        |step, to| step.undeformed_gap_into(to);
    /// Temperature rise of the surface of the track by friction, in K; of a contact in motion whose flash temperature is asked for.
    FlashTemperature = "flash_temperature" ["K"] "flash temperature of the track", "flash temperature", Heat, Flash,
        |step, to| step.flash_temperature_into(to);
    /// The same of the surface of the slider, which carries the surfaces that move, in K.
    SliderFlashTemperature = "slider_flash_temperature" ["K"] "flash temperature of the slider", "flash temperature of the slider",
        Heat, Flash, |step, to| step.flash_temperature_of_slider_into(to);
}

impl FieldKind {
    /// Its name in case files and results.
    pub fn name(self) -> &'static str {
        choice::word(&self)
    }

    /// Cells by which this field of a row is taken into the frame of the contact; worn depths and dents are in those of their bodies already.
    pub fn shift(self, step: &Step<'_>) -> [isize; 2] {
        match self {
            FieldKind::WearDepth | FieldKind::CounterbodyWearDepth | FieldKind::Flattening => [0; 2],
            _ => step.frame_shift(),
        }
    }

    /// What it is beyond the ends of a free track, where nothing touches; NaN where that is not known.
    pub fn beyond(self) -> f64 {
        use FieldKind::{Displacement, FlashTemperature, Gap, SliderFlashTemperature, UndeformedGap};
        match self {
            Gap | Displacement | UndeformedGap | FlashTemperature | SliderFlashTemperature => f64::NAN,
            _ => 0.0,
        }
    }

    /// The kind of that name.
    pub fn from_name(name: &str) -> Option<FieldKind> {
        choice::parse(name)
    }

    /// Its unit; "1" where it has none.
    pub fn units(self) -> &'static str {
        self.declaration().units
    }

    /// What it is, for axes and legends.
    pub fn long_name(self) -> &'static str {
        self.declaration().long_name
    }

    /// What figures and pages call it.
    pub fn short_name(self) -> &'static str {
        self.declaration().short_name
    }

    /// How it is drawn.
    pub fn look(self) -> Look {
        self.declaration().look
    }

    /// Whether it shows where the surfaces touch.
    pub fn shows_contact(self) -> bool {
        self.look() == Look::Pressure || self.look() == Look::States
    }

    /// Its place on a page: pressures first, then states, then lengths; those of friction and wear last.
    pub fn place(self) -> u8 {
        let Declaration { of, units, .. } = self.declaration();
        match (of, units) {
            (Of::Friction, _) => 3,
            (Of::Wear, _) => 4,
            (Of::Flash, _) => 5,
            (_, "Pa") => 0,
            (_, "1") => 1,
            _ => 2,
        }
    }

    /// Whether its values tell which cells are in contact: those that are 0 out of contact or open beyond it.
    pub fn tells_contact(self) -> bool {
        self.shows_contact() || self == FieldKind::Gap
    }

    /// Why a run does not have it, what it may have instead, and what to do: `None` where it has it.
    pub fn lacks(self, simulation: &Simulation) -> Option<[&'static str; 2]> {
        let law = simulation.traction.as_deref();
        let pressed = "only the contact presses on the surfaces of this case";
        let press =
            "take \"pressure\", or add [adhesion], or of the contact pressure leakage.coupling = \"two-way\"";
        match self.declaration().of {
            Of::Flattening if simulation.plasticity == Plasticity::Cap => Some([
                "there is no permanent flattening with plasticity = \"cap\"",
                "set solver.plasticity = \"accumulate\"",
            ]),
            Of::Traction if law.is_none() => Some([pressed, press]),
            Of::Adhesion if law.is_none_or(|law| law.as_adhesion().is_none()) => Some([pressed, press]),
            Of::Friction if simulation.tangential.is_none() => Some([
                "there is no tangential traction and no slip in a case without [tangential]",
                "leave it out, or add [friction] and [tangential]",
            ]),
            Of::Wear if simulation.wear.is_none() => {
                Some(["nothing wears in a case without [wear]", "leave it out, or add [wear]"])
            }
            Of::Flash if simulation.flash.is_none() => {
                Some(["nothing warms the surfaces of a case without [flash]", "leave it out, or add [flash]"])
            }
            Of::Flash
                if self == FieldKind::SliderFlashTemperature
                    && simulation.flash.as_ref().is_some_and(|flash| flash.partition == Partition::Track) =>
            {
                Some([
                    "the slider takes no heat with partition = \"track\"",
                    "leave it out, or take another partition",
                ])
            }
            _ => None,
        }
    }

    /// Writes the numbers of a row; of the contact state the pressure.
    pub fn of_step(self, step: &Step<'_>, field: &mut Array2<f64>) {
        (self.declaration().write)(step, field);
    }

    pub(super) fn data_type(self) -> DataType {
        if self.look() == Look::States { DataType::UInt8 } else { DataType::Float64 }
    }

    /// Bytes per cell.
    pub(crate) fn bytes(self) -> u64 {
        self.data_type().width() as u64
    }
}

impl std::fmt::Display for FieldKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
