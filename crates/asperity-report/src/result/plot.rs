//! The figures of a result: one table of what each shows and how it is drawn.

use asperity_io::store::{FieldKind, Look, Reader};

use super::{
    Options, PlotError, distribution, evolution, fields, fluid, friction, leak, panels, profile, stress, wear,
};
use crate::figure::{Colours, Figure};

/// What a figure shows of a result, and so which options it takes.
#[derive(Clone, Copy, PartialEq)]
enum Shows {
    /// The rows.
    Rows,
    /// The rows, with numbers that are zero where nothing touches.
    Load,
    /// A stored instant.
    Instant,
    /// A map of a field at a stored instant.
    Field(FieldKind),
    /// Maps in this SI unit at a stored instant.
    Maps(&'static str),
    /// The rows, and a stored instant.
    Both,
    /// The undeformed gap.
    Undeformed,
}

/// A figure of a result.
struct Declaration {
    name: &'static str,
    shows: Shows,
}

/// Makes the enum of the figures from a table.
macro_rules! plots {
    ($($(#[$doc:meta])* $plot:ident $name:literal $shows:expr, $draw:expr;)*) => {
        /// A figure of a result.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Plot {
            $($(#[$doc])* $plot,)*
            /// Map of a field at an instant; of a line contact a curve, and a picture over x and time.
            Map(FieldKind),
        }

        impl Plot {
            const NAMED: [Plot; [$(Plot::$plot),*].len()] = [$(Plot::$plot),*];

            fn declaration(self) -> Declaration {
                match self {
                    $(Plot::$plot => Declaration { name: $name, shows: $shows },)*
                    Plot::Map(kind) => Declaration { name: kind.name(), shows: Shows::Field(kind) },
                }
            }

            /// The figure, without the result's title, and with the usual colours.
            pub(super) fn draw(self, reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
                match self {
                    $(Plot::$plot => $draw(reader, options),)*
                    Plot::Map(kind) => fields::map(reader, kind, options.at),
                }
            }
        }
    };
}

plots! {
    /// Contact area, approach, load and pressures over time.
    Evolution "evolution" Shows::Load, panels::evolution;
    /// Load over approach.
    LoadDisplacement "load-displacement" Shows::Load, evolution::load_displacement;
    /// Tangential force over tangential displacement: the loop of a contact with friction.
    TangentialLoop "tangential-loop" Shows::Load, evolution::tangential_loop;
    /// Worn volume, depth, roughness, contact and pressure over the sliding distance: the running-in curve.
    Wear "wear" Shows::Load, wear::wear;
    /// Map of the undeformed gap.
    InitialGap "initial-gap" Shows::Undeformed, fields::initial_gap;
    /// Pressure and gap along a line at an instant.
    Profile "profile" Shows::Instant, profile::profile;
    /// Distribution of the pressure and of the gap at an instant.
    Histogram "histogram" Shows::Instant, distribution::histogram;
    /// Sizes of the contact spots at an instant.
    Spots "spots" Shows::Instant, distribution::spots;
    /// Iterations, convolutions, residual and certificate of each step.
    Work "work" Shows::Rows, evolution::work;
    /// The quantities that were asked for, over time.
    Quantities "quantities" Shows::Load, panels::quantities;
    /// Sections of the stress below the surface, a map of it, and its profile over depth, at an instant.
    Stress "stress" Shows::Maps("Pa"), stress::stress;
    /// Leak rate and gaps over time, and the flow at an instant.
    Leak "leak" Shows::Both, leak::over_time;
    /// Contact, pockets and the pressure of a fluid that acts on the surfaces, at an instant.
    Fluid "fluid" Shows::Maps("Pa"), fluid::map;
    /// Friction of a contact in motion, over the velocity of steady states or over time.
    Friction "friction" Shows::Load, friction::friction;
}

impl Plot {
    /// Every plot, the maps of fields last.
    pub fn all() -> impl Iterator<Item = Plot> {
        Plot::NAMED.into_iter().chain(FieldKind::ALL.map(Plot::Map))
    }

    /// Its name on the command line: of a map that of its field, also with hyphens.
    pub fn name(self) -> &'static str {
        self.declaration().name
    }

    /// The plot of that name.
    pub fn from_name(name: &str) -> Option<Plot> {
        let is = |plot: &Plot| plot.name() == name || plot.name() == name.replace('-', "_");
        Plot::all().find(is)
    }

    /// The names of all plots, with commas between them.
    pub fn names() -> String {
        Plot::all().map(Plot::name).collect::<Vec<_>>().join(", ")
    }

    /// The field whose map it is.
    pub fn field(self) -> Option<FieldKind> {
        match self.declaration().shows {
            Shows::Field(kind) => Some(kind),
            _ => None,
        }
    }

    /// The answers that it shows, the first one by which it is called where a finding takes one back.
    pub(super) fn answers(self) -> &'static [&'static str] {
        match self {
            Plot::Evolution => &["contact_area", "max_pressure", "approach"],
            Plot::LoadDisplacement | Plot::Map(FieldKind::Displacement) => &["approach"],
            Plot::Leak => &["leak_rate"],
            Plot::Fluid => &["fluid_load"],
            Plot::Friction => &["friction_coefficient"],
            Plot::Stress => &["max_mises"],
            Plot::TangentialLoop => &["loop_energy"],
            Plot::Wear => &["wear_depth_max"],
            Plot::InitialGap | Plot::Work => &[],
            _ => &["contact_area"],
        }
    }

    /// The SI unit of the values whose colours it shows; `None` where it has no such map.
    pub fn unit(self) -> Option<&'static str> {
        match self.declaration().shows {
            Shows::Field(kind) => Some(kind.units()).filter(|unit| *unit != "1"),
            Shows::Maps(unit) => Some(unit),
            Shows::Undeformed => Some("m"),
            _ => None,
        }
    }

    /// Whether it has a map whose colours can be chosen.
    pub fn has_colours(self) -> bool {
        self.unit().is_some() || self.declaration().shows == Shows::Both
    }

    /// Whether it shows an instant.
    pub fn is_of_an_instant(self) -> bool {
        !matches!(self.declaration().shows, Shows::Rows | Shows::Load | Shows::Undeformed)
    }

    /// Whether it shows the rows over time.
    pub fn is_over_time(self) -> bool {
        matches!(self.declaration().shows, Shows::Rows | Shows::Load | Shows::Both)
    }

    /// Whether it shows the contact at an instant, and is empty where nothing touches.
    pub(super) fn shows_contact(self) -> bool {
        match self.declaration().shows {
            Shows::Field(kind) => kind.shows_contact(),
            shows => shows == Shows::Instant,
        }
    }

    /// Whether it shows numbers over the rows that are zero where nothing touches.
    pub(super) fn is_of_the_load(self) -> bool {
        self.declaration().shows == Shows::Load
    }
}

/// The colours of a field; of states their own.
pub(crate) fn colours(kind: FieldKind) -> Option<Colours> {
    match kind.look() {
        Look::Pressure => Some(Colours::Pressure),
        Look::Gap => Some(Colours::Gap),
        Look::Amount => Some(Colours::Sequential),
        Look::Signed => Some(Colours::Diverging),
        Look::Heat => Some(Colours::Heat),
        Look::States => None,
    }
}
