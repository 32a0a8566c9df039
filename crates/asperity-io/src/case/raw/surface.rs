//! `[[surface]]`: the parts of the undeformed gap.

use asperity::surface::process::{Axis, Resampling};
use asperity::surface::{Fill, Level};
use schemars::JsonSchema;
use serde::Deserialize;

use super::prepare::{Circle, Crop, Filter, Operation, Outliers, Window};
use super::{At, Axes};
use crate::case::quantity::range::{Hurst, Positive, PositiveOrInfinite, Share};
use crate::case::quantity::{Angle, Label, Length, Number, Signed, Whole};

/// One part of the undeformed gap; heights point out of their body, towards the other one.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(tag = "kind")]
pub enum Surface {
    /// A sphere, as the paraboloid r^2/(2 R).
    Sphere(Sphere),
    /// An ellipsoid, as the paraboloid x^2/(2 Rx) + y^2/(2 Ry).
    Ellipsoid(Ellipsoid),
    /// A cylinder along y, as the parabola x^2/(2 R).
    Cylinder(Cylinder),
    /// A wedge along y, edge towards the other body.
    Wedge(Wedge),
    /// A cone, tip towards the other body.
    Cone(Cone),
    /// A flat punch: cells outside its face cannot touch.
    FlatPunch(At<FlatPunch>),
    /// A wave: the product of cosines along x and y.
    Wave(Wave),
    /// Random roughness with a self-affine power spectrum, the same on every machine for one seed.
    SelfAffine(Box<At<SelfAffine>>),
    /// A measured topography from a file.
    File(Box<File>),
    /// Heights that a program gives beside the case.
    #[schemars(skip)]
    Array(Array),
}

impl Surface {
    /// Whether the part moves with the contact, where that is said.
    pub fn moves(&self) -> Option<bool> {
        match self {
            Surface::Sphere(shape) => shape.moves,
            Surface::Ellipsoid(shape) => shape.moves,
            Surface::Cylinder(shape) => shape.moves,
            Surface::Wedge(shape) => shape.moves,
            Surface::Cone(shape) => shape.moves,
            Surface::FlatPunch(shape) => shape.value.moves,
            Surface::Wave(shape) => shape.moves,
            Surface::SelfAffine(surface) => surface.value.moves,
            Surface::File(file) => file.moves,
            Surface::Array(array) => array.moves,
        }
    }
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Radius of curvature.
    #[schemars(example = "0.5 mm")]
    pub radius: Length<PositiveOrInfinite>,
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
    #[schemars(example = ("0 mm", "0.02 mm"))]
    pub center: Option<At<Axes<Length>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipsoid {
    /// Radius of curvature in the x-z plane.
    #[schemars(example = "0.5 mm")]
    pub radius_x: Length<PositiveOrInfinite>,
    /// Radius of curvature in the y-z plane; "inf" makes a cylinder along y.
    #[schemars(example = "2 mm")]
    pub radius_y: Length<PositiveOrInfinite>,
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
    #[schemars(example = ("0 mm", "0.02 mm"))]
    pub center: Option<At<Axes<Length>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Radius of curvature; "inf" for a flat.
    #[schemars(example = "10 mm")]
    pub radius: Length<PositiveOrInfinite>,
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
    #[schemars(example = ("0.02 mm",))]
    pub center: Option<At<Axes<Length>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wedge {
    /// Rise per length: tan of the angle between the flank and the undeformed surface.
    #[schemars(example = 0.1)]
    pub slope: Number<Positive>,
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
    #[schemars(example = ("0.02 mm",))]
    pub center: Option<At<Axes<Length>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cone {
    /// Rise per length: tan of the angle between the flank and the undeformed surface.
    #[schemars(example = 0.1)]
    pub slope: Number<Positive>,
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
    #[schemars(example = ("0 mm", "0.02 mm"))]
    pub center: Option<At<Axes<Length>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlatPunch {
    /// Radius of a circular face, or half the width on a line; this or `size`.
    #[schemars(example = "20 um")]
    pub radius: Option<Length<Positive>>,
    /// Sides of a rectangular face along x and y, or the width on a line; this or `radius`.
    #[schemars(example = ("20 um", "40 um"))]
    pub size: Option<At<Axes<Length<Positive>>>>,
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
    #[schemars(example = ("0 mm", "0.02 mm"))]
    pub center: Option<At<Axes<Length>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Amplitude: half the height from trough to crest.
    #[schemars(example = "1 um")]
    pub amplitude: Length,
    /// Wavelength along x and y; "inf" for no variation along that axis. On a line one value.
    #[schemars(example = ("50 um", "inf"))]
    pub wavelength: At<Axes<Length<PositiveOrInfinite>>>,
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
    #[schemars(example = ("0 mm", "0.02 mm"))]
    pub center: Option<At<Axes<Length>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SelfAffine {
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// A published roughness by its name; its numbers are the defaults of the other keys.
    pub preset: Option<Preset>,
    /// Hurst exponent: the spectrum falls as q^(-2 (1 + hurst)), on a line as q^(-1 - 2 hurst). Needed without `preset`.
    #[schemars(example = 0.8)]
    pub hurst: Option<Number<Hurst>>,
    /// Root mean square of the gradient; this or `rms_height`.
    #[schemars(example = 0.05)]
    pub rms_gradient: Option<Number<Positive>>,
    /// Root mean square of the height; this or `rms_gradient`.
    #[schemars(example = "0.2 um")]
    pub rms_height: Option<Length<Positive>>,
    /// Longest wavelength of the roughness. Needed without `preset`.
    #[schemars(example = "50 um")]
    pub longest: Option<At<Length<Positive>>>,
    /// Shortest wavelength of the roughness; at least two cells. Needed without `preset`.
    #[schemars(example = "0.8 um")]
    pub shortest: Option<At<Length<Positive>>>,
    /// Wavelength down to which the spectrum is flat; `longest` if not given.
    #[schemars(example = "50 um")]
    pub roll_off: Option<At<Length<Positive>>>,
    /// The direction in which the surface was worked; the same in all directions if not given.
    #[schemars(example = serde_json::json!({ "angle": "30 deg", "ratio": 4 }))]
    pub lay: Option<At<Lay>>,
    /// How the heights are distributed; Gaussian if not given.
    #[schemars(example = serde_json::json!({ "skewness": -1, "kurtosis": 5 }))]
    pub distribution: Option<At<Distribution>>,
    /// Seed of the random numbers.
    #[schemars(example = 1)]
    pub seed: Whole<0>,
}

/// A published roughness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The Contact Mechanics Challenge (Mueser et al. 2017), 0.1 mm x 0.1 mm: hurst = 0.8, rms_gradient = 1,
    /// longest = "0.1 mm", roll_off = "20 um", shortest = "0.1 um" (which needs 2000 cells a side or more).
    ContactMechanicsChallenge,
}

/// The direction in which a surface was worked. The given wavelengths are those across it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lay {
    /// Angle of the lay from the x axis towards the y axis; 0 if not given.
    #[schemars(example = "30 deg")]
    pub angle: Option<Angle>,
    /// Length along the lay over length across it, 1 or more.
    #[schemars(example = 4)]
    pub ratio: Number<Positive>,
}

/// How the heights are distributed: `skewness` and `kurtosis`, or those of a measured surface in a file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distribution {
    /// Skewness Ssk, negative for plateaus with valleys; 0 if not given.
    #[schemars(example = -1)]
    pub skewness: Option<Number>,
    /// Kurtosis Sku; 3 (Gaussian) if not given, from about 1.9 + 1.6 skewness^2 on.
    #[schemars(example = 5)]
    pub kurtosis: Option<Number<Positive>>,
    /// A topography file whose levelled heights have the distribution wanted; instead of the other two. Its unit
    /// does not matter.
    #[schemars(example = "measured.sur")]
    pub path: Option<At<String>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Array {
    /// Name of the array: heights \[m\], minus infinity where nothing can touch.
    pub array: At<String>,
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    pub moves: Option<bool>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct File {
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    /// The file, relative to the case file: SUR, MNT, SDF, X3P, GWY, AL3D, OPD, BCR, Nanoscope, MetroPro, PLU, IBW, NID,
    /// FRT, NetCDF, HDF5, NPY, NPZ, XYZ, CSV or a text matrix, detected from the content. On a line of cells a profile: text of two
    /// columns, position and height.
    #[schemars(example = "roughness.sur")]
    pub path: At<String>,
    /// Channel by name or by number (from 0), if the file has several; the first one with heights if not given.
    #[schemars(example = &"Topography")]
    pub channel: Option<Label>,
    /// Physical size along x and y, if the file does not state it; of a profile its length.
    #[schemars(example = ("0.1 mm", "0.1 mm"))]
    pub size: Option<At<Axes<Length<Positive>>>>,
    /// Unit of the heights, if the file does not state it.
    #[schemars(example = &"um")]
    pub height_unit: Option<At<String>>,
    /// The rectangle to keep.
    #[schemars(example = serde_json::json!({ "size": ["0.2 mm", "0.2 mm"] }))]
    pub crop: Option<At<Crop>>,
    /// The axis along which the surface is mirrored: of two measured surfaces in contact, one is seen from behind.
    pub flip: Option<At<Axis>>,
    /// Quarter turns from x towards y.
    #[schemars(example = 1)]
    pub rotate: Option<At<Signed>>,
    /// Whether to change the sign of the heights (a replica, or a file that shows the opposite body).
    #[schemars(example = false)]
    pub invert: Option<At<bool>>,
    /// What is subtracted from the heights; "plane" if not given.
    pub level: Option<At<Level>>,
    /// Spikes to remove; none if not given. They become undefined, and `fill` fills them.
    #[schemars(example = serde_json::json!({ "threshold": 6, "radius": 2 }))]
    pub outliers: Option<At<Outliers>>,
    /// What is done with undefined points; "harmonic" if not given.
    pub fill: Option<At<Fill>>,
    /// Largest share of undefined points that is filled; 0.25 if not given.
    #[schemars(example = 0.25)]
    pub fill_share: Option<At<Number<Share>>>,
    /// A circle to subtract from a profile; none if not given, the one that fits best for `circle = {}`.
    #[schemars(example = serde_json::json!({ "radius": "10 mm" }))]
    pub circle: Option<At<Circle>>,
    /// The wavelengths kept; all if not given.
    #[schemars(example = serde_json::json!({ "longest": "80 um", "shortest": "2.5 um" }))]
    pub filter: Option<At<Filter>>,
    /// A window by which the heights decrease to zero towards the edges; none if not given.
    #[schemars(example = serde_json::json!({ "shape": "tukey", "share": 0.1 }))]
    pub window: Option<At<Window>>,
    /// How the heights are resampled if the domain has another number of cells; without it they must agree.
    pub resample: Option<At<Resampling>>,
    /// The processing steps as a list, in the order in which they are done, instead of the keys from `crop` to
    /// `resample`. Only these steps are done, without a default levelling or filling.
    #[schemars(example = serde_json::json!([{ "op": "level", "form": "plane" }, { "op": "fill", "method": "nearest" }]))]
    pub process: Option<At<Vec<At<Operation>>>>,
}
