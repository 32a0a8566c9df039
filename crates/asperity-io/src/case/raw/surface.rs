//! `[[surface]]`: the parts of the undeformed gap.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{At, Two};
use crate::case::quantity::range::{Hurst, Positive, PositiveOrInfinite};
use crate::case::quantity::{Length, Number, Whole};

/// One part of the undeformed gap; heights point out of their body, towards the other one.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(tag = "kind")]
pub enum Surface {
    /// A sphere, as the paraboloid r^2/(2 R).
    Sphere(Sphere),
    /// An ellipsoid, as the paraboloid x^2/(2 Rx) + y^2/(2 Ry).
    Ellipsoid(Ellipsoid),
    /// A cone, tip towards the other body.
    Cone(Cone),
    /// A flat punch: cells outside its face cannot touch.
    FlatPunch(At<FlatPunch>),
    /// A wave: the product of cosines along x and y.
    Wave(Wave),
    /// Gaussian roughness with a self-affine power spectrum, the same on every machine for one seed.
    SelfAffine(At<SelfAffine>),
    /// A measured topography from a file (text matrix or NPY).
    File(File),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Radius of curvature.
    #[schemars(example = "0.5 mm")]
    pub radius: Length<PositiveOrInfinite>,
    /// Position from the centre of the domain; ["0 m", "0 m"] if not given.
    #[schemars(example = ["0 mm", "0.02 mm"])]
    pub center: Option<Two<Length>>,
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
    /// Position from the centre of the domain; ["0 m", "0 m"] if not given.
    #[schemars(example = ["0 mm", "0.02 mm"])]
    pub center: Option<Two<Length>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cone {
    /// Rise per length: tan of the angle between the flank and the undeformed surface.
    #[schemars(example = 0.1)]
    pub slope: Number<Positive>,
    /// Position from the centre of the domain; ["0 m", "0 m"] if not given.
    #[schemars(example = ["0 mm", "0.02 mm"])]
    pub center: Option<Two<Length>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlatPunch {
    /// Radius of a circular face; this or `size`.
    #[schemars(example = "20 um")]
    pub radius: Option<Length<Positive>>,
    /// Sides of a rectangular face along x and y; this or `radius`.
    #[schemars(example = ["20 um", "40 um"])]
    pub size: Option<Two<Length<Positive>>>,
    /// Position from the centre of the domain; ["0 m", "0 m"] if not given.
    #[schemars(example = ["0 mm", "0.02 mm"])]
    pub center: Option<Two<Length>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Amplitude: half the height from trough to crest.
    #[schemars(example = "1 um")]
    pub amplitude: Length,
    /// Wavelength along x and y; "inf" for no variation along that axis.
    #[schemars(example = ["50 um", "inf"])]
    pub wavelength: Two<Length<PositiveOrInfinite>>,
    /// Position from the centre of the domain; ["0 m", "0 m"] if not given.
    #[schemars(example = ["0 mm", "0.02 mm"])]
    pub center: Option<Two<Length>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SelfAffine {
    /// Hurst exponent: the spectrum falls as q^(-2 (1 + hurst)).
    #[schemars(example = 0.8)]
    pub hurst: Number<Hurst>,
    /// Root mean square of the gradient; this or `rms_height`.
    #[schemars(example = 0.05)]
    pub rms_gradient: Option<Number<Positive>>,
    /// Root mean square of the height; this or `rms_gradient`.
    #[schemars(example = "0.2 um")]
    pub rms_height: Option<Length<Positive>>,
    /// Longest wavelength of the roughness.
    #[schemars(example = "50 um")]
    pub longest: At<Length<Positive>>,
    /// Shortest wavelength of the roughness; at least two cells.
    #[schemars(example = "0.8 um")]
    pub shortest: At<Length<Positive>>,
    /// Wavelength down to which the spectrum is flat; `longest` if not given.
    #[schemars(example = "50 um")]
    pub roll_off: Option<At<Length<Positive>>>,
    /// Number that picks the realisation.
    #[schemars(example = 1)]
    pub seed: Whole<0>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct File {
    /// The file, relative to the case file: a text matrix or a NPY array of heights, x along axis 0.
    #[schemars(example = "roughness.npy")]
    pub path: At<String>,
    /// Physical size along x and y, where the file holds none.
    #[schemars(example = ["0.1 mm", "0.1 mm"])]
    pub size: Option<Two<Length<Positive>>>,
    /// Unit of the heights, where the file holds none.
    #[schemars(example = &"um")]
    pub height_unit: Option<At<String>>,
    /// What is taken off the heights; "plane" if not given.
    #[serde(default)]
    pub level: Level,
    /// What is done about undefined points; "harmonic" if not given.
    #[serde(default)]
    pub fill: Fill,
    /// Whether the heights change their sign (the file shows the opposite body).
    #[serde(default)]
    #[schemars(example = false)]
    pub invert: bool,
}

/// What is taken off measured heights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Nothing.
    None,
    /// The mean.
    Mean,
    /// The least-squares plane.
    #[default]
    Plane,
    /// The least-squares polynomial of second order.
    Quadratic,
}

/// What is done about undefined points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fill {
    /// Refuse the file.
    Error,
    /// Solve Laplace's equation over the holes.
    #[default]
    Harmonic,
    /// Take the nearest defined height.
    Nearest,
}
