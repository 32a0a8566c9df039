//! Quantities of each row beyond load, approach and area, computed on request.
//!
//! | quantity | unit | meaning |
//! |---|---|---|
//! | `contact_stiffness` | N/m | dW/dw of the present contact against the instantaneous compliance |
//! | `contact_spots` | | number of contact spots: patches of cells that touch and share edges |
//! | `largest_spot`, `mean_spot` | m² | area of the largest spot, mean area of a spot; 0 without contact |
//! | `contact_perimeter` | m | length of the edges between cells in and out of contact |
//! | `contact_percolation` | | 1 where contact reaches across the domain along x, 2 along y, 3 both, 0 neither |
//! | `gap_percolation` | | the same of the open cells |
//! | `rms_gap` | m | root of the mean square of the gap over the cells that can touch |
//! | `elastic_energy` | J | energy in the springs of the bodies |
//! | `dissipated_energy` | J | energy that their dashpots have turned into heat since t = 0 |
//! | `flattening_work` | J | work on the cells at the hardness |
//! | `external_work` | J | ∫ W dw since t = 0 |
//! | `plastic_volume` | m³ | volume that flattening has taken in for good |
//! | `contact_eccentricity` | m | distance of the centre of pressure from the middle of the contact |
//! | `load_power` | W | power of the load in the step |
//! | `spot_histogram` | | number of spots per class of area, by powers of two of the cell |
//! | `pressure_histogram` | 1/Pa | probability density of the pressure of the cells in contact |
//! | `gap_histogram` | 1/m | probability density of the gap of the open cells |
//! | `adhesive_load`, `repulsive_load` | N | attraction between the surfaces, and load on the cells in contact |
//! | `adhesion_energy` | J | potential energy of the attraction |
//! | `outer_iterations`, `adhesion_residual` | | passes of the loop around the contact solver, and the change in the last one |
//! | `tangential_force`, `tangential_displacement` | N, m | along x and y, two numbers per row, of a contact with a load along its surfaces |
//! | `tangential_stiffness` | N/m | change of the force over that of the displacement in the step |
//! | `stick_area`, `slip_area` | m² | area of the cells that stick, and of those at the limit of friction |
//! | `slip_work` | J | work of friction since t = 0 |
//! | `friction_iterations`, `friction_certificate` | | iterations of the tangential solver, and its certified error |
//! | `wear_volume`, `counterbody_wear_volume` | m³ | volume that wear has taken off both bodies, and off the counterbody |
//! | `wear_rate`, `wear_distance` | m³/s, m | worn volume per time, and sliding distance |
//! | `wear_cycles` | | cycles of slip, as many as the computed ones stand for |
//! | `wear_depth_max`, `worn_roughness` | m | largest worn depth, and roughness of the worn gap |
//! | `wear_error` | | share of the worn volume whose place is uncertain |
//! | `velocity`, `sliding_distance` | m/s, m | velocity of a contact in motion, and how far it has moved |
//! | `friction_force`, `side_force` | N | force against motion and across it |
//! | `friction_coefficient`, `friction_coefficient_total` | | friction force over load, of the loss in the bulk alone and with the friction of the surfaces |
//! | `friction_uncertainty` | | estimated error of the friction force, relative |
//! | `rolling_moment` | N m | moment of the pressure about the middle of the shapes |
//! | `dissipated_power` | W | power lost in the bodies |
//! | `flash_temperature_max`, `flash_temperature_mean` | K | temperature rise of the surfaces by friction: largest, and mean over the contact |
//! | `heat_share`, `heat_power` | , W | share of the heat of friction that goes into the slider, and all of it |
//! | `material_temperature` | K | temperature at which the material was taken |
//!
//! What each costs and how it is derived: docs/theory.md ("Energy and other
//! quantities of a row", "Permanent flattening"). A march takes them by
//! [`Simulation::quantities`](crate::Simulation::quantities) and gives them in [`Step::quantity`](crate::step::Step::quantity).

mod eccentricity;
mod histogram;
mod number;
mod perimeter;
mod rows;
mod stiffness;

use ndarray::Array2;

use crate::error::{Of, Result, positive, require};
use crate::grid::Grid;

pub(crate) use eccentricity::eccentricity;
pub(crate) use histogram::{densities, spot_classes};
pub use number::RowNumber;
pub use perimeter::{Edges, contact_edges};
pub use rows::{Entry, ROW_COLUMNS, RowColumn, RowFigure};
pub use stiffness::ContactStiffness;

macro_rules! quantities {
    ($($(#[$doc:meta])* $variant:ident = $name:literal [$units:literal] $long_name:literal, $kind:ident,
       ($title:literal, $label:literal, $legend:literal)
       $(, on a line [$line_units:literal] $line_name:literal ($line_title:literal, $line_label:literal))?;)*) => {
        /// A quantity that each row may have; see the table of [`self`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[cfg_attr(
            feature = "serde",
            derive(serde::Serialize, serde::Deserialize),
            serde(rename_all = "snake_case")
        )]
        #[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
        pub enum Quantity {
            $($(#[$doc])* $variant,)*
        }

        impl Quantity {
            /// Every quantity.
            pub const ALL: [Quantity; [$(Quantity::$variant),*].len()] = [$(Quantity::$variant),*];
        }

        static DECLARATIONS: [Declaration; Quantity::ALL.len()] = [$(Declaration {
            name: $name,
            units: $units,
            long_name: $long_name,
            kind: Kind::$kind,
            along_axes: [
                [concat!($name, "_x"), concat!($long_name, " along x")],
                [concat!($name, "_y"), concat!($long_name, " along y")],
            ],
            panel: Panel { title: $title, label: $label, legend: $legend },
            line: [$(Line {
                units: $line_units,
                long_name: $line_name,
                title: $line_title,
                label: $line_label,
            })?].first().copied(),
        }),*];
    };
}

// Each quantity once: what it is, name in results and case files, unit ("1": none), words for axes, kind, and the panel of figures that
// shows it (title, axis, name in the legend); on a line of cells where these differ unit, words, title and axis.
quantities! {
    /// Slope of load over approach under a small, sudden change, in N/m; about ten convolutions per row.
    ///
    /// The bodies respond with their instantaneous compliance C(0+), as at the onset of unloading; infinite where that
    /// is 0, and in the full contact of a periodic body. Cells at the hardness carry no more, unless flattening stays:
    /// then they respond elastically to unloading and count.
    ContactStiffness = "contact_stiffness" ["N/m"] "contact stiffness", Response, ("Contact stiffness", "stiffness", "");
    /// Number of contact spots.
    ///
    /// Cells that share an edge belong to one spot; on a periodic domain opposite borders are neighbours.
    ContactSpots = "contact_spots" ["1"] "contact spots", Spots, ("Contact spots", "number", "");
    /// Area of the largest contact spot, in m2; 0 without contact.
    LargestSpot = "largest_spot" ["m2"] "area of the largest contact spot", Spots, ("Areas of contact spots", "area", "largest"),
        on a line ["m"] "length of the largest contact spot" ("Lengths of contact spots", "length");
    /// Mean area of a contact spot, in m2; 0 without contact.
    MeanSpot = "mean_spot" ["m2"] "mean area of a contact spot", Spots, ("Areas of contact spots", "area", "mean"),
        on a line ["m"] "mean length of a contact spot" ("Lengths of contact spots", "length");
    /// Length of the edges between cells in and out of contact, in m.
    ///
    /// The border of a free domain does not count. A smooth contour without preferred direction is shorter by π/4
    /// (Yastrebov, Anciaux & Molinari 2017).
    ContactPerimeter = "contact_perimeter" ["m"] "counted perimeter of the contact", State, ("Perimeter of the contact", "length", ""),
        on a line ["1"] "number of ends of the contact" ("Ends of the contact", "number");
    /// Whether cells in contact that share edges reach from border to border: 1 along x, 2 along y, 3 both, 0 neither.
    ///
    /// On a periodic domain they may pass across the borders at their sides.
    ContactPercolation = "contact_percolation" ["1"] "percolation of the contact (1: x, 2: y, 3: both)", Percolation, ("Percolation", "connected along", "contact");
    /// The same of the cells out of contact: where it is 0 no fluid passes.
    GapPercolation = "gap_percolation" ["1"] "percolation of the gap (1: x, 2: y, 3: both)", Percolation, ("Percolation", "connected along", "open gap");
    /// Root mean square of the gap over the cells that can touch, in m.
    RmsGap = "rms_gap" ["m"] "rms gap", State, ("Gap", "gap", "rms");
    /// Distance of the centre of pressure from the middle of the contact area, in m: 0 where the contact bears evenly.
    ///
    /// The middle is that of the cells in contact; on a periodic domain both are means around the domain, by the phase of its
    /// longest wave.
    ContactEccentricity = "contact_eccentricity" ["m"] "distance of the centre of pressure from the middle of the contact", State, ("Eccentricity of the pressure", "distance", "");
    /// Energy stored in the springs of both bodies, in J.
    ElasticEnergy = "elastic_energy" ["J"] "elastic energy", Energy, ("Energy", "energy", "elastic");
    /// Energy that the dashpots of both bodies have turned into heat since t = 0, in J.
    DissipatedEnergy = "dissipated_energy" ["J"] "dissipated energy", Energy, ("Energy", "energy", "dissipated");
    /// Work on the cells at the hardness, hardness times overlap, in J.
    ///
    /// Given back on unloading where the cut-off is reversible, summed up where flattening stays.
    FlatteningWork = "flattening_work" ["J"] "work of flattening", Energy, ("Energy", "energy", "flattening");
    /// Volume that flattening at the hardness has taken in for good since t = 0, in m3; with plasticity = "accumulate".
    PlasticVolume = "plastic_volume" ["m3"] "permanently flattened volume", State, ("Flattened volume", "volume", ""),
        on a line ["m2"] "permanently flattened area of the section" ("Flattened area of the section", "area");
    /// Work of the load since t = 0, in J.
    ///
    /// ∫ W dw from the mean load of each step, jumps exact. It is the sum of the three energies, up to the error of the steps.
    ExternalWork = "external_work" ["J"] "external work", Energy, ("Energy", "energy", "work of the load");
    /// Power of the load in the step, mean load times change of the approach over time, in W; 0 in a jump.
    LoadPower = "load_power" ["W"] "power of the load", Response, ("Power of the load", "power", "");
    /// Number of contact spots per class of area: 1 cell, 2 to 3, 4 to 7, and so on.
    SpotHistogram = "spot_histogram" ["1"] "number of contact spots per class of area", SpotHistogram, ("", "", ""),
        on a line ["1"] "number of contact spots per class of length" ("", "");
    /// Probability density of the pressure of the cells in contact, in 1/Pa.
    PressureHistogram = "pressure_histogram" ["1/Pa"] "probability density of the contact pressure", Histogram, ("", "", "");
    /// Probability density of the gap of the open cells, in 1/m.
    GapHistogram = "gap_histogram" ["1/m"] "probability density of the open gap", Histogram, ("", "", "");
    /// Σ σ: what the attraction between the surfaces adds to the load, in N; of an adhesive contact, as the four that follow.
    AdhesiveLoad = "adhesive_load" ["N"] "adhesive load", Adhesion, ("Parts of the load", "load", "adhesive");
    /// Σ q: load on the cells in contact, in N. The load is the difference.
    RepulsiveLoad = "repulsive_load" ["N"] "repulsive load", Adhesion, ("Parts of the load", "load", "repulsive");
    /// Σ γ(g): potential energy of the attraction, 0 where the surfaces are far apart, in J.
    AdhesionEnergy = "adhesion_energy" ["J"] "adhesion energy", Adhesion, ("Energy", "energy", "adhesion");
    /// Passes of the loop around the contact solver.
    OuterIterations = "outer_iterations" ["1"] "passes of the loop over the tractions", Traction, ("Work of each row", "number", "passes over the tractions");
    /// Change of the attraction in the last of them, relative to all forces between the surfaces.
    AdhesionResidual = "adhesion_residual" ["1"] "change of the adhesion in the last pass", Adhesion, ("Error of each row", "relative error", "adhesion (last pass)");
    /// Load that the fluid carries on the open cells, in N; of a contact with a fluid that acts on it, as the ten that follow.
    FluidLoad = "fluid_load" ["N"] "load on the fluid", Fluid, ("Parts of the load", "load", "fluid");
    /// Load on the cells in contact, in N. The load is the sum.
    ContactLoad = "contact_load" ["N"] "load on the contact", Fluid, ("Parts of the load", "load", "contact");
    /// Pressure of the fluid at the inlet, in Pa.
    InletPressure = "inlet_pressure" ["Pa"] "pressure of the fluid at the inlet", Fluid, ("Pressure of the fluid", "pressure", "at the inlet");
    /// Whether the gap connects inlet and outlet: 1 or 0.
    Connected = "connected" ["1"] "whether the gap connects inlet and outlet", Fluid, ("Inlet and outlet", "connected", "");
    /// Whether the fluid carries all of the load in a film without contact: 1 or 0.
    Film = "film" ["1"] "film without contact", Fluid, ("Film without contact", "film", "");
    /// Area of the pockets, which neither inlet nor outlet reaches, in m2.
    PocketArea = "pocket_area" ["m2"] "area of the pockets", Fluid, ("Area of the pockets", "area", ""),
        on a line ["m"] "length of the pockets" ("Length of the pockets", "length");
    /// Largest pressure in a pocket, in Pa; 0 where there is none.
    PocketPressureMax = "pocket_pressure_max" ["Pa"] "largest pressure in a pocket", Fluid, ("Pressure of the fluid", "pressure", "in a pocket");
    /// Volume of sealed pockets that their liquid does not fill, in m3: at a pressure of 0 the rest is vapour.
    PocketVapour = "pocket_vapour" ["m3"] "vapour in sealed pockets", Fluid, ("Vapour in sealed pockets", "volume", ""),
        on a line ["m2"] "vapour in sealed pockets" ("Vapour in sealed pockets", "area");
    /// Cells whose access to the fluid changed again and again in the loop and was then held.
    LatchedCells = "latched_cells" ["1"] "cells whose access to the fluid was held", Fluid, ("Held cells", "number", "access to the fluid held");
    /// Spread of the conductance of the gap over the last 20 passes, relative.
    LeakSpread = "leak_spread" ["1"] "spread of the leak over the last passes", Fluid, ("Error of each row", "relative error", "leak (spread over the last passes)");
    /// Change of the fluid's tractions in the last pass, relative to all forces between the surfaces.
    FluidResidual = "fluid_residual" ["1"] "change of the fluid's tractions in the last pass", Fluid, ("Error of each row", "relative error", "fluid (last pass)");
    /// Force along the surfaces, along x and y, in N; of a contact with a tangential load, as the seven that follow.
    TangentialForce = "tangential_force" ["N"] "tangential force", TangentialVector, ("Tangential force", "force", "");
    /// Displacement of the bodies against each other along x and y since t = 0, in m.
    TangentialDisplacement = "tangential_displacement" ["m"] "tangential displacement", TangentialVector, ("Tangential displacement", "displacement", "");
    /// Change of the tangential force in the step over that of the displacement, along the displacement, in N/m; NaN where nothing moves.
    TangentialStiffness = "tangential_stiffness" ["N/m"] "tangential stiffness", Tangential, ("Tangential stiffness", "stiffness", "");
    /// Area of the cells in contact that stick, in m2.
    StickArea = "stick_area" ["m2"] "area that sticks", Tangential, ("Stick and slip", "area", "stick"),
        on a line ["m"] "length that sticks" ("Stick and slip", "length");
    /// Area of the cells in contact whose traction is at the limit of friction, in m2.
    SlipArea = "slip_area" ["m2"] "area that slips", Tangential, ("Stick and slip", "area", "slip"),
        on a line ["m"] "length that slips" ("Stick and slip", "length");
    /// Work of friction since t = 0, in J: heat in the surfaces. Of elastic bodies it grows over a closed loop by the area of the loop.
    SlipWork = "slip_work" ["J"] "work of friction", Tangential, ("Work of friction", "work", "");
    /// Iterations of the solver of the tangential tractions.
    FrictionIterations = "friction_iterations" ["1"] "iterations of the tangential solver", Tangential, ("Work of each row", "number", "iterations of the tangential solver");
    /// Certified error of the tangential tractions in the energy norm, relative.
    FrictionCertificate = "friction_certificate" ["1"] "certified error of the tangential tractions, relative", Tangential, ("Error of each row", "relative error", "tangential tractions (certificate)");
    /// Volume that wear has taken off both bodies since t = 0, in m3; of surfaces that wear, as the seven that follow.
    WearVolume = "wear_volume" ["m3"] "worn volume of both bodies", Wear, ("Worn volume", "volume", "all"),
        on a line ["m2"] "worn area of both bodies' sections" ("Worn area of the section", "area");
    /// What of it is of the counterbody, over which the contact moves, in m3.
    CounterbodyWearVolume = "counterbody_wear_volume" ["m3"] "worn volume of the counterbody", Wear, ("Worn volume", "volume", "counterbody"),
        on a line ["m2"] "worn area of the counterbody's section" ("Worn area of the section", "area");
    /// Worn volume of the step over its length, in m3/s; 0 in a jump.
    WearRate = "wear_rate" ["m3/s"] "wear rate", Wear, ("Wear rate", "volume per time", ""),
        on a line ["m2/s"] "wear rate" ("Wear rate", "area per time");
    /// Cycles since t = 0 of a load along the surfaces, as many as the computed ones stand for; NaN where it has no period.
    WearCycles = "wear_cycles" ["1"] "cycles of wear", Wear, ("Cycles", "number", "");
    /// Sliding distance since t = 0, in m; of surfaces that slide along a path or in motion.
    WearDistance = "wear_distance" ["m"] "sliding distance", Wear, ("Sliding distance", "distance", "");
    /// Largest depth that wear has taken off a body, in m.
    WearDepthMax = "wear_depth_max" ["m"] "largest worn depth", Wear, ("Largest worn depth", "depth", "");
    /// Root of the mean square of the undeformed gap about its mean, with what is worn, in m.
    WornRoughness = "worn_roughness" ["m"] "roughness of the worn gap (Sq)", Wear, ("Roughness of the gap", "Sq", "");
    /// Share of the worn volume whose place is uncertain because the pressure changes over the steps, or that is because the load does.
    WearError = "wear_error" ["1"] "estimated error of the worn depths, relative", Wear, ("Error of each row", "relative error", "worn depths");
    /// Velocity of the contact, in m/s; of a contact in motion, as all that follow.
    Velocity = "velocity" ["m/s"] "velocity", Motion, ("Velocity", "velocity", "");
    /// Distance that the contact has moved, in m.
    SlidingDistance = "sliding_distance" ["m"] "distance moved", Motion, ("Distance moved", "distance", "");
    /// Force of the bodies against motion, Σ p dh/ds, in N.
    FrictionForce = "friction_force" ["N"] "friction force", Motion, ("Friction", "force", "against motion");
    /// Force across the direction of motion, in N.
    SideForce = "side_force" ["N"] "side force", Motion, ("Friction", "force", "across it");
    /// Friction force over load.
    FrictionCoefficient = "friction_coefficient" ["1"] "friction coefficient of the loss in the bulk", Motion, ("Friction coefficient", "friction coefficient", "of the bulk");
    /// Friction coefficient with that of the surfaces: of a given shear stress on the area in contact, or of the coefficient of a flash temperature.
    FrictionCoefficientTotal = "friction_coefficient_total" ["1"] "friction coefficient with that of the surfaces", MotionOnRequest, ("Friction coefficient", "friction coefficient", "in total");
    /// Difference of the friction force from its second estimate, -Σ p du/ds, over the force.
    FrictionUncertainty = "friction_uncertainty" ["1"] "estimated error of the friction force, relative", Motion, ("Uncertainty of friction", "share of the force", "");
    /// Moment of the pressure about the middle of the shapes, in N m.
    RollingMoment = "rolling_moment" ["N m"] "rolling moment", Motion, ("Rolling moment", "moment", "");
    /// Power lost in the bodies, in W.
    DissipatedPower = "dissipated_power" ["W"] "power lost in the bodies", Motion, ("Power lost", "power", "");
    /// Largest temperature rise of the surfaces by friction, in K; of a contact in motion whose flash temperature is asked for, as all that follow.
    FlashTemperatureMax = "flash_temperature_max" ["K"] "largest flash temperature", Flash, ("Flash temperature", "temperature rise", "largest");
    /// Mean temperature rise over the contact, in K.
    FlashTemperatureMean = "flash_temperature_mean" ["K"] "mean flash temperature over the contact", Flash, ("Flash temperature", "temperature rise", "mean over the contact");
    /// Share of the heat of friction that goes into the slider.
    HeatShare = "heat_share" ["1"] "share of the heat that goes into the slider", Flash, ("Heat into the slider", "share", "");
    /// All heat of friction, in W.
    HeatPower = "heat_power" ["W"] "heat of friction", Flash, ("Heat of friction", "power", "");
    /// Temperature at which the material was taken, that of the run and the mean flash temperature, in K; with feedback.
    MaterialTemperature = "material_temperature" ["K"] "temperature of the material", FlashOnRequest, ("Temperature of the material", "temperature", "");
}

/// The declaration of a quantity.
struct Declaration {
    name: &'static str,
    units: &'static str,
    long_name: &'static str,
    kind: Kind,
    /// Names and descriptions of components along x and y.
    along_axes: [[&'static str; 2]; 2],
    panel: Panel,
    line: Option<Line>,
}

/// The unit and the description of a quantity on a line of cells.
#[derive(Clone, Copy)]
struct Line {
    units: &'static str,
    long_name: &'static str,
    title: &'static str,
    label: &'static str,
}

/// The source of a quantity.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// The state of the row.
    State,
    /// Its contact spots, its connected cells, distributions.
    Spots,
    Percolation,
    SpotHistogram,
    Histogram,
    /// The energy of the bodies, summed from row to row.
    Energy,
    /// The step or the response of the contact: known only in runs in time.
    Response,
    /// A contact with tractions that depend on the gap, with adhesion, with a fluid: every row has it.
    Traction,
    Adhesion,
    Fluid,
    /// A contact with a tangential load: every row has it; or two of it, along x and y.
    Tangential,
    TangentialVector,
    /// Surfaces that wear: every row has it.
    Wear,
    /// A contact in motion: every row has it, or only on request.
    Motion,
    MotionOnRequest,
    /// A contact whose friction warms the surfaces: every row has it, or only with feedback.
    Flash,
    FlashOnRequest,
}

/// The panel of a figure that shows a quantity; quantities with the same title share a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panel {
    /// Title of the panel.
    pub title: &'static str,
    /// Label of its axis.
    pub label: &'static str,
    /// Name of the quantity in the legend; empty if it is alone in its panel.
    pub legend: &'static str,
}

impl Quantity {
    fn declaration(self) -> &'static Declaration {
        &DECLARATIONS[self as usize]
    }

    /// The quantities of every contact, moving or not, with other tractions or without.
    pub fn at_rest() -> impl Iterator<Item = Quantity> {
        let is_special = |quantity: &Quantity| {
            quantity.is_of_motion()
                || quantity.is_of_traction()
                || quantity.is_tangential()
                || quantity.is_of_wear()
                || quantity.is_of_flash()
        };
        Quantity::ALL.into_iter().filter(move |quantity| !is_special(quantity))
    }

    /// The quantities that every row of a contact with a tangential load has.
    pub fn of_tangential() -> impl Iterator<Item = Quantity> {
        Quantity::ALL.into_iter().filter(|quantity| quantity.is_tangential())
    }

    /// The quantities that every row of surfaces that wear has.
    pub fn of_wear() -> impl Iterator<Item = Quantity> {
        Quantity::ALL.into_iter().filter(|quantity| quantity.is_of_wear())
    }

    /// The quantities that every row of an adhesive contact has.
    pub fn of_adhesion() -> impl Iterator<Item = Quantity> {
        Quantity::ALL
            .into_iter()
            .filter(|quantity| matches!(quantity.declaration().kind, Kind::Adhesion | Kind::Traction))
    }

    /// The quantities that every row of a contact with a fluid that acts on it has.
    pub fn of_fluid() -> impl Iterator<Item = Quantity> {
        Quantity::ALL
            .into_iter()
            .filter(|quantity| matches!(quantity.declaration().kind, Kind::Fluid | Kind::Traction))
    }

    /// The quantities that every row of a contact in motion has.
    pub fn of_motion() -> impl Iterator<Item = Quantity> {
        Quantity::ALL.into_iter().filter(|quantity| quantity.declaration().kind == Kind::Motion)
    }

    /// The quantities that every row of a contact has whose friction warms the surfaces.
    pub fn of_flash() -> impl Iterator<Item = Quantity> {
        Quantity::ALL.into_iter().filter(|quantity| quantity.declaration().kind == Kind::Flash)
    }

    /// Its name in case files and results.
    pub fn name(self) -> &'static str {
        self.declaration().name
    }

    /// The quantity with this name.
    pub fn from_name(name: &str) -> Option<Quantity> {
        Quantity::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// Its unit; "1" if it has none.
    pub fn units(self) -> &'static str {
        self.declaration().units
    }

    /// Its description for axes and legends.
    pub fn long_name(self) -> &'static str {
        self.declaration().long_name
    }

    /// Its unit on this grid; "1" if it has none.
    pub fn units_on(self, grid: &Grid) -> &'static str {
        match self.declaration().line.filter(|_| grid.is_line()) {
            Some(line) => line.units,
            None => grid.units(self.units()),
        }
    }

    /// Its description on this grid, for axes and legends.
    pub fn long_name_on(self, grid: &Grid) -> &'static str {
        self.declaration().line.filter(|_| grid.is_line()).map_or(self.long_name(), |line| line.long_name)
    }

    /// Names and descriptions of its components along x and y; none if its value is a number or a histogram.
    pub fn components(self) -> Option<[[&'static str; 2]; 2]> {
        (self.declaration().kind == Kind::TangentialVector).then_some(self.declaration().along_axes)
    }

    /// The panel that shows it on this grid; `None` for a histogram.
    pub fn panel_on(self, grid: &Grid) -> Option<Panel> {
        let Declaration { panel, line, .. } = *self.declaration();
        let panel = match line.filter(|_| grid.is_line()) {
            Some(Line { title, label, .. }) => Panel { title, label, ..panel },
            None => panel,
        };
        (!self.is_histogram()).then_some(panel)
    }

    /// Names of its values 0, 1, 2 ...; empty if its value is a number.
    pub fn states(self) -> &'static [&'static str] {
        match self.declaration().kind {
            Kind::Percolation => &["none", "x", "y", "x and y"],
            _ if matches!(self, Quantity::Connected | Quantity::Film) => &["no", "yes"],
            _ => &[],
        }
    }

    /// Whether it tells how the solver fared, not what it found.
    pub fn is_of_solver(self) -> bool {
        matches!(
            self,
            Quantity::OuterIterations
                | Quantity::AdhesionResidual
                | Quantity::FluidResidual
                | Quantity::LatchedCells
                | Quantity::LeakSpread
                | Quantity::FrictionIterations
                | Quantity::FrictionCertificate
                | Quantity::WearError
        )
    }

    /// Whether it has one number per bin; otherwise it has one per row.
    pub fn is_histogram(self) -> bool {
        matches!(self.declaration().kind, Kind::SpotHistogram | Kind::Histogram)
    }

    /// Whether it follows the energy of the bodies.
    pub fn is_energy(self) -> bool {
        self.declaration().kind == Kind::Energy
    }

    /// Whether it belongs to a run in time: energies, the work of a step, the response of the contact.
    pub fn is_of_time(self) -> bool {
        matches!(self.declaration().kind, Kind::Energy | Kind::Response)
    }

    /// Whether it belongs to a contact in motion.
    pub fn is_of_motion(self) -> bool {
        matches!(self.declaration().kind, Kind::Motion | Kind::MotionOnRequest)
    }

    /// Whether it belongs to surfaces that wear.
    pub fn is_of_wear(self) -> bool {
        self.declaration().kind == Kind::Wear
    }

    /// Whether it belongs to a contact whose friction warms the surfaces.
    pub fn is_of_flash(self) -> bool {
        matches!(self.declaration().kind, Kind::Flash | Kind::FlashOnRequest)
    }

    /// Whether it belongs to a contact with a tangential load.
    pub fn is_tangential(self) -> bool {
        matches!(self.declaration().kind, Kind::Tangential | Kind::TangentialVector)
    }

    /// Whether it belongs to a contact with tractions that depend on the gap.
    pub fn is_of_traction(self) -> bool {
        matches!(self.declaration().kind, Kind::Adhesion | Kind::Fluid | Kind::Traction)
    }

    /// Whether it needs the memory of [`Spots`](crate::spots::Spots), because connected cells are found.
    pub(crate) fn connects(self) -> bool {
        self.is_of_spots() || self.declaration().kind == Kind::Percolation
    }

    /// Whether it is about contact spots.
    pub(crate) fn is_of_spots(self) -> bool {
        matches!(self.declaration().kind, Kind::Spots | Kind::SpotHistogram)
    }
}

impl std::fmt::Display for Quantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// The quantities that a march takes at each row.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantities {
    /// Which, each once; default none.
    pub list: Vec<Quantity>,
    /// Bins of the histograms of pressure and gap, all of one width; default 50, at most 10 000.
    pub bins: usize,
    /// Upper end of the histogram of the pressure \[Pa\]; by default the hardness. It begins at 0.
    pub largest_pressure: Option<f64>,
    /// Upper end of the histogram of the gap \[m\]; by default the largest undeformed gap. It begins at 0.
    pub largest_gap: Option<f64>,
}

impl Default for Quantities {
    fn default() -> Self {
        Quantities { list: vec![], bins: 50, largest_pressure: None, largest_gap: None }
    }
}

/// Most bins of a histogram.
const MOST_BINS: usize = 10_000;

/// Upper ends of the histograms, as errors name them.
const PRESSURE_END: &str = "largest pressure of the histogram";
const GAP_END: &str = "largest gap of the histogram";

/// A quantity with the ends of its bins.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The quantity.
    pub quantity: Quantity,
    /// Ends of the bins, one more than there are bins, in the unit of what is counted (m², Pa, m); empty for a single
    /// number.
    pub edges: Vec<f64>,
}

impl Column {
    /// Numbers per row.
    pub fn width(&self) -> usize {
        match (self.quantity.components(), self.edges.len()) {
            (Some(components), _) => components.len(),
            (None, 0) => 1,
            (None, ends) => ends - 1,
        }
    }
}

impl Quantities {
    /// These quantities, with the default bins.
    pub fn of(list: impl IntoIterator<Item = Quantity>) -> Self {
        Quantities { list: list.into_iter().collect(), ..Quantities::default() }
    }

    /// Whether a quantity is requested.
    pub fn has(&self, quantity: Quantity) -> bool {
        self.list.contains(&quantity)
    }

    /// Whether any energy is requested.
    pub fn has_energy(&self) -> bool {
        self.list.iter().any(|quantity| quantity.is_energy())
    }

    /// Checks the list and the bins, as far as they do not depend on a gap; `capped` if there is a hardness.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a quantity is named twice, there are no bins or too many, an end is not positive, or the
    /// histogram of the pressure has no upper end.
    pub fn validate(&self, capped: bool) -> Result<()> {
        for (n, quantity) in self.list.iter().enumerate() {
            let once = !self.list[..n].contains(quantity);
            require(once, "list of quantities", format!("{quantity} twice"), "each named once")?;
        }
        let possible = (1..=MOST_BINS).contains(&self.bins);
        require(possible, "bins of the histograms", self.bins, format!("between 1 and {MOST_BINS}"))
            .of("histogram.bins")?;
        if let (true, Some(top)) = (self.has(Quantity::PressureHistogram), self.largest_pressure) {
            positive(PRESSURE_END, top, "Pa")?;
        }
        if let (true, Some(top)) = (self.has(Quantity::GapHistogram), self.largest_gap) {
            positive(GAP_END, top, "m")?;
        }
        let is_bounded = !self.has(Quantity::PressureHistogram) || self.largest_pressure.is_some() || capped;
        let expected =
            "a pressure, as the bodies have no hardness that bounds it: histogram = { pressure = \"...\" }";
        require(is_bounded, PRESSURE_END, "not given", expected).of("quantities")
    }

    /// The quantities with their bins, for an undeformed gap \[m\] and a largest hardness \[Pa\] (infinite if there is none).
    ///
    /// # Errors
    /// As [`validate`](Self::validate), and if the histogram of the gap has no upper end.
    pub fn columns(&self, grid: &Grid, gap: &Array2<f64>, hardness: f64) -> Result<Vec<Column>> {
        self.validate(hardness.is_finite())?;
        let evenly = |top: f64| (0..=self.bins).map(|k| top * k as f64 / self.bins as f64).collect();
        let edges = |quantity: &Quantity| -> Result<Vec<f64>> {
            Ok(match quantity {
                Quantity::SpotHistogram => {
                    let classes = grid.len().ilog2() as i32 + 1;
                    (0..=classes).map(|k| grid.cell_area() * libm::ldexp(1.0, k)).collect()
                }
                Quantity::PressureHistogram => evenly(self.largest_pressure.unwrap_or(hardness)),
                Quantity::GapHistogram => match self.largest_gap {
                    Some(top) => evenly(top),
                    None => {
                        let top = gap.iter().filter(|h| h.is_finite()).fold(0.0, |m: f64, h| m.max(*h));
                        let expected = "a length, as the undeformed surfaces are flat";
                        require(top > 0.0, GAP_END, "not given", expected)?;
                        evenly(top)
                    }
                },
                _ => vec![],
            })
        };
        self.list.iter().map(|quantity| Ok(Column { quantity: *quantity, edges: edges(quantity)? })).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_found_again() {
        for quantity in Quantity::ALL {
            assert_eq!(Quantity::from_name(quantity.name()), Some(quantity));
        }
        assert_eq!(Quantity::from_name("stiffness"), None);
    }

    #[test]
    fn histograms_need_ends() {
        let grid = Grid::new([5, 4], [5.0, 8.0]).unwrap();
        let flat = Array2::zeros((5, 4));
        let said = |list: &[Quantity], gap: &Array2<f64>, hardness| {
            Quantities::of(list.iter().copied()).columns(&grid, gap, hardness).unwrap_err().to_string()
        };
        assert!(said(&[Quantity::PressureHistogram], &flat, f64::INFINITY).contains("no hardness"));
        assert!(said(&[Quantity::GapHistogram], &flat, 1.0).contains("flat"));
        assert!(said(&[Quantity::RmsGap, Quantity::RmsGap], &flat, 1.0).contains("rms_gap twice"));
        let mut gap = flat;
        gap[(1, 1)] = 3.0;
        gap[(0, 1)] = f64::INFINITY;
        let list = [Quantity::SpotHistogram, Quantity::PressureHistogram, Quantity::GapHistogram];
        let columns = Quantities { bins: 2, ..Quantities::of(list) }.columns(&grid, &gap, 8.0).unwrap();
        // 20 cells of 2 m2: classes of 1, 2-3, 4-7, 8-15 and 16-31 cells.
        assert_eq!(columns[0].edges, [2.0, 4.0, 8.0, 16.0, 32.0, 64.0]);
        assert_eq!(columns[1].edges, [0.0, 4.0, 8.0]);
        assert_eq!(columns[2].edges, [0.0, 1.5, 3.0]);
    }
}
