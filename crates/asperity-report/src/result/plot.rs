//! The figures of a result: one table of what each shows and how it is drawn.

use asperity_io::store::{FieldKind, Reader};

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
    draw: fn(&Reader, &Options) -> Result<Figure, PlotError>,
}

/// Draws the map of a field.
macro_rules! map {
    ($kind:ident) => {
        |reader, options| fields::map(reader, FieldKind::$kind, options.at)
    };
}

/// Makes the enum of the figures from a table.
macro_rules! plots {
    ($($(#[$doc:meta])* $plot:ident $name:literal $shows:expr, $draw:expr;)*) => {
        /// A figure of a result.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Plot {
            $($(#[$doc])* $plot,)*
        }

        impl Plot {
            /// Every plot.
            pub const ALL: [Plot; [$(Plot::$plot),*].len()] = [$(Plot::$plot),*];

            fn declaration(self) -> Declaration {
                match self {
                    $(Plot::$plot => Declaration { name: $name, shows: $shows, draw: $draw },)*
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
    /// Map of the pressure at an instant; of a line contact a curve, and a picture over x and time. So are the other maps.
    Pressure "pressure" Shows::Field(FieldKind::Pressure), map!(Pressure);
    /// Map of the gap at an instant.
    Gap "gap" Shows::Field(FieldKind::Gap), map!(Gap);
    /// Map of the displacement at an instant.
    Displacement "displacement" Shows::Field(FieldKind::Displacement), map!(Displacement);
    /// Map of the contact area at an instant.
    Contact "contact" Shows::Field(FieldKind::Contact), map!(Contact);
    /// Map of the permanent flattening at an instant.
    Flattening "flattening" Shows::Field(FieldKind::Flattening), map!(Flattening);
    /// Map of the pressure of the cells in contact, of surfaces that adhere.
    ContactPressure "contact-pressure" Shows::Field(FieldKind::ContactPressure), map!(ContactPressure);
    /// Map of the attraction between the surfaces at an instant.
    AdhesiveTraction "adhesive-traction" Shows::Field(FieldKind::AdhesiveTraction), map!(AdhesiveTraction);
    /// Map of the tangential traction along x at an instant, of a contact with friction.
    TractionX "traction-x" Shows::Field(FieldKind::TractionX), map!(TractionX);
    /// Map of the tangential traction along y.
    TractionY "traction-y" Shows::Field(FieldKind::TractionY), map!(TractionY);
    /// Map of the slip along x since t = 0.
    SlipX "slip-x" Shows::Field(FieldKind::SlipX), map!(SlipX);
    /// Map of the slip along y since t = 0.
    SlipY "slip-y" Shows::Field(FieldKind::SlipY), map!(SlipY);
    /// Map of the path of the slip since t = 0.
    SlipPath "slip-path" Shows::Field(FieldKind::SlipPath), map!(SlipPath);
    /// Map of the energy per area that friction has turned into heat since t = 0.
    FrictionWork "friction-work" Shows::Field(FieldKind::FrictionWork), map!(FrictionWork);
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
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        self.declaration().name
    }

    /// The plot of that name.
    pub fn from_name(name: &str) -> Option<Plot> {
        Plot::ALL.into_iter().find(|plot| plot.name() == name)
    }

    /// The names of all plots, with commas between them.
    pub fn names() -> String {
        Plot::ALL.map(Plot::name).join(", ")
    }

    /// The map of a field.
    pub fn of_field(kind: FieldKind) -> Option<Plot> {
        Plot::ALL.into_iter().find(|plot| plot.field() == Some(kind))
    }

    /// The field whose map it is.
    pub fn field(self) -> Option<FieldKind> {
        match self.declaration().shows {
            Shows::Field(kind) => Some(kind),
            _ => None,
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
        matches!(
            self.declaration().shows,
            Shows::Instant
                | Shows::Field(FieldKind::Pressure | FieldKind::ContactPressure | FieldKind::Contact)
        )
    }

    /// Whether it shows numbers over the rows that are zero where nothing touches.
    pub(super) fn is_of_the_load(self) -> bool {
        self.declaration().shows == Shows::Load
    }

    /// The figure, without the result's title, and with the usual colours.
    pub(super) fn draw(self, reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
        (self.declaration().draw)(reader, options)
    }
}

/// What figures and pages call a field, and its colours; of states their own.
pub(crate) fn look(kind: FieldKind) -> (&'static str, Option<Colours>) {
    match kind {
        FieldKind::Pressure => ("pressure", Some(Colours::Pressure)),
        FieldKind::Gap => ("gap", Some(Colours::Gap)),
        FieldKind::Displacement => ("displacement", Some(Colours::Sequential)),
        FieldKind::Flattening => ("permanent flattening", Some(Colours::Sequential)),
        FieldKind::ContactPressure => ("contact pressure", Some(Colours::Pressure)),
        FieldKind::AdhesiveTraction => ("attraction", Some(Colours::Sequential)),
        FieldKind::TractionX => ("traction along x", Some(Colours::Diverging)),
        FieldKind::TractionY => ("traction along y", Some(Colours::Diverging)),
        FieldKind::SlipX => ("slip along x", Some(Colours::Diverging)),
        FieldKind::SlipY => ("slip along y", Some(Colours::Diverging)),
        FieldKind::SlipPath => ("path of the slip", Some(Colours::Heat)),
        FieldKind::FrictionWork => ("work of friction per area", Some(Colours::Heat)),
        FieldKind::Contact => ("contact", None),
    }
}
