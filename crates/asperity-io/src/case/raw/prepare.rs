//! The steps that prepare a measured surface: `process = [...]`, and the same steps as keys of a `[[surface]]`.

use asperity::surface::process::{Axis, Edge, Resampling};
use asperity::surface::{Fill, Level};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{At, Two};
use crate::case::quantity::range::{Positive, Share};
use crate::case::quantity::{Length, Number, Signed, Whole};

/// One processing step of a measured surface.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(tag = "op")]
pub enum Operation {
    /// Subtract a form, fitted by least squares to the defined points.
    Level(LevelStep),
    /// Fill the undefined points.
    Fill(FillStep),
    /// Keep a rectangle.
    Crop(At<Crop>),
    /// Resample the same rectangle to another number of cells.
    Resample(ResampleStep),
    /// Keep the wavelengths of a band; the surface is treated as periodic.
    Filter(At<Filter>),
    /// Mirror along an axis.
    Flip(FlipStep),
    /// Rotate by quarter turns from x towards y.
    Rotate(RotateStep),
    /// Change the sign of the heights.
    Invert(InvertStep),
    /// Multiply by a window that decreases to zero towards the edges.
    Window(At<Window>),
    /// Make spikes undefined.
    Outliers(Outliers),
    /// Subtract a circle from a profile, fitted by least squares.
    Circle(Circle),
}

/// A circle to subtract from a profile.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Circle {
    /// Its radius; the one that fits best if not given.
    #[schemars(example = "10 mm")]
    pub radius: Option<Length<Positive>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelStep {
    /// What is subtracted; "plane" if not given.
    pub form: Option<Level>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FillStep {
    /// How; "harmonic" if not given.
    pub method: Option<Fill>,
    /// Largest share of undefined points that is filled; 0.25 if not given.
    #[schemars(example = 0.25)]
    pub share: Option<Number<Share>>,
}

/// A rectangle to keep: `cells` (counts) or `size` (lengths) or `defined = true`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Crop {
    /// Number of cells kept along x and y; this, `size` or `defined`.
    #[schemars(example = (512, 512))]
    pub cells: Option<Two<Whole<1>>>,
    /// First cell kept along x and y, from 0; with `cells`. If not given, the middle of the surface is kept.
    #[schemars(example = (0, 0))]
    pub from: Option<Two<Whole<0>>>,
    /// Lengths kept along x and y, rounded to whole cells; this, `cells` or `defined`.
    #[schemars(example = ("0.2 mm", "0.2 mm"))]
    pub size: Option<Two<Length<Positive>>>,
    /// Corner of the part kept, from the surface's corner; with `size`. If not given, the middle is kept.
    #[schemars(example = ("0 mm", "0.1 mm"))]
    pub corner: Option<Two<Length>>,
    /// true: the smallest rectangle that holds all defined points.
    #[schemars(example = true)]
    pub defined: Option<bool>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResampleStep {
    /// How; "band-limited" if not given.
    pub method: Option<Resampling>,
    /// Number of cells along x and y; those of the domain if not given.
    #[schemars(example = (512, 512))]
    pub cells: Option<Two<Whole<1>>>,
}

/// The wavelengths that are kept; give `longest`, `shortest` or both.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Filter {
    /// Longest wavelength kept (high-pass); without it all long waves and the mean are kept.
    #[schemars(example = "80 um")]
    pub longest: Option<Length<Positive>>,
    /// Shortest wavelength kept (low-pass); without it all short waves are kept.
    #[schemars(example = "2.5 um")]
    pub shortest: Option<Length<Positive>>,
    /// How the band ends; "sharp" if not given.
    pub edge: Option<Edge>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlipStep {
    /// The axis along which the surface is mirrored.
    pub axis: Axis,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotateStep {
    /// Quarter turns from x towards y; 1 if not given, negative ones turn back.
    #[schemars(example = 1)]
    pub quarter_turns: Option<Signed>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InvertStep {}

/// A window along each axis, scaled to mean square 1.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// "hann" or "tukey"; "hann" if not given.
    #[serde(default)]
    pub shape: WindowShape,
    /// Share of the length over which Tukey's window rises and falls; 0.1 if not given.
    #[schemars(example = 0.1)]
    pub share: Option<Number<Share>>,
}

/// A window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WindowShape {
    /// (1 - cos(2 pi x/L))/2.
    #[default]
    Hann,
    /// Hann's flanks over a share of the length, flat in between.
    Tukey,
}

/// Points far from the median of their neighbourhood.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outliers {
    /// Robust standard deviations from the local median; 6 if not given.
    #[schemars(example = 6)]
    pub threshold: Option<Number<Positive>>,
    /// Cells of the neighbourhood to each side, 1 to 10; 2 if not given.
    #[schemars(example = 2)]
    pub radius: Option<Whole<1>>,
}
