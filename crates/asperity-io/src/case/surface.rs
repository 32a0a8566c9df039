//! `[[surface]]`: the parts of the undeformed gap.

use asperity::Grid;
use asperity::surface::process::{Axis, Resampling};
use asperity::surface::{Fill, Level, Part, Punch, Shape};

use super::keys::*;
use super::measured::Measured;
use super::prepare::{self, Circle, Continuation, Crop, Filter, Operation, Outliers, Window};
use super::roughness::SelfAffine;
use crate::quantity::unit::Unit;
use crate::topography::ReadOptions;

/// One part of the undeformed gap; heights point out of their body, towards the other one.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Whether the part moves with the contact (`[motion]`); true if not given.
    #[schemars(example = false)]
    pub moves: Option<bool>,
    #[schemars(flatten)]
    pub kind: Kind,
}

/// One part of the undeformed gap.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind")]
pub enum Kind {
    /// A sphere, as the paraboloid r^2/(2 R).
    Sphere {
        /// Radius of curvature.
        radius: Length<PositiveOrInfinite>,
        /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
        #[schemars(example = ("0 mm", "0.02 mm"))]
        center: Option<Axes<Length>>,
    },
    /// An ellipsoid, as the paraboloid x^2/(2 Rx) + y^2/(2 Ry).
    Ellipsoid {
        /// Radius of curvature in the x-z plane.
        radius_x: Length<PositiveOrInfinite>,
        /// Radius of curvature in the y-z plane; "inf" makes a cylinder along y.
        #[schemars(example = "2 mm")]
        radius_y: Length<PositiveOrInfinite>,
        /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
        #[schemars(example = ("0 mm", "0.02 mm"))]
        center: Option<Axes<Length>>,
    },
    /// A cylinder along y, as the parabola x^2/(2 R).
    Cylinder {
        /// Radius of curvature; "inf" for a flat.
        #[schemars(example = "10 mm")]
        radius: Length<PositiveOrInfinite>,
        /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
        #[schemars(example = ("0.02 mm",))]
        center: Option<Axes<Length>>,
    },
    /// A wedge along y, edge towards the other body.
    Wedge {
        /// Rise per length: tan of the angle between the flank and the undeformed surface.
        #[schemars(example = 0.1)]
        slope: Number<Positive>,
        /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
        #[schemars(example = ("0.02 mm",))]
        center: Option<Axes<Length>>,
    },
    /// A cone, tip towards the other body.
    Cone {
        /// Rise per length: tan of the angle between the flank and the undeformed surface.
        #[schemars(example = 0.1)]
        slope: Number<Positive>,
        /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
        #[schemars(example = ("0 mm", "0.02 mm"))]
        center: Option<Axes<Length>>,
    },
    /// A flat punch: cells outside its face cannot touch.
    FlatPunch {
        /// Radius of a circular face, or half the width on a line; this or `size`.
        #[schemars(example = "20 um")]
        radius: Option<Length<Positive>>,
        /// Sides of a rectangular face along x and y, or the width on a line; this or `radius`.
        #[schemars(example = ("20 um", "40 um"))]
        size: Option<Axes<Length<Positive>>>,
        /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
        #[schemars(example = ("0 mm", "0.02 mm"))]
        center: Option<Axes<Length>>,
    },
    /// A wave: the product of cosines along x and y.
    Wave {
        /// Amplitude: half the height from trough to crest.
        #[schemars(example = "1 um")]
        amplitude: Length,
        /// Wavelength along x and y; "inf" for no variation along that axis. On a line one value.
        #[schemars(example = ("50 um", "inf"))]
        wavelength: Axes<Length<PositiveOrInfinite>>,
        /// Position from the centre of the domain, along x and y; 0 if not given. On a line one value.
        #[schemars(example = ("0 mm", "0.02 mm"))]
        center: Option<Axes<Length>>,
    },
    /// Random roughness with a self-affine power spectrum, the same on every machine for one seed.
    SelfAffine(Box<SelfAffine>),
    /// A measured topography from a file.
    File(Box<File>),
    /// Heights that a program gives beside the case.
    #[schemars(skip)]
    Array {
        /// Name of the array: heights \[m\], minus infinity where nothing can touch.
        array: String,
        /// Whether a shape of a single body is among them: no wave, roughness or punch.
        #[serde(default)]
        single: bool,
        /// What was done to the heights, one sentence per step.
        #[serde(default)]
        history: Vec<String>,
    },
}

impl Surface {
    /// The measured surface, where the part is one; the inner `None` where its keys are wrong.
    pub fn measured(&self, at: &Place<'_>) -> Option<Option<Measured>> {
        match &self.kind {
            Kind::File(file) => Some(file.measured(at)),
            _ => None,
        }
    }

    /// A part that is no measured surface; `line` where the domain is a line of cells.
    pub fn part(&self, at: &Place<'_>, grid: Option<&Grid>, line: bool) -> Option<Part> {
        let (straight, instead) = match &self.kind {
            Kind::Sphere { .. } => ("a sphere", "cylinder"),
            Kind::Ellipsoid { .. } => ("an ellipsoid", "cylinder"),
            Kind::Cone { .. } => ("a cone", "wedge"),
            _ => ("", ""),
        };
        if line && !straight.is_empty() {
            return at.fault(
                format!("{straight} is not straight along y, but the domain is a line of cells"),
                "a cylinder, wedge, flat punch, wave, roughness or profile",
                &format!("use kind = \"{instead}\", or give domain.cells and domain.size two values"),
            );
        }
        let (shape, center) = match &self.kind {
            Kind::Sphere { radius, center } => (Shape::Sphere { radius: radius.get() }, center),
            Kind::Ellipsoid { radius_x, radius_y, center } => {
                (Shape::Ellipsoid { radius_x: radius_x.get(), radius_y: radius_y.get() }, center)
            }
            Kind::Cylinder { radius, center } => (Shape::Cylinder { radius: radius.get() }, center),
            Kind::Wedge { slope, center } => (Shape::Wedge { slope: slope.get() }, center),
            Kind::Cone { slope, center } => (Shape::Cone { slope: slope.get() }, center),
            Kind::FlatPunch { radius, size, center } => {
                at.exactly_one(&["radius", "size"])?;
                let outline = match (radius, size) {
                    (Some(radius), _) => Punch::Circle { radius: radius.get() },
                    (None, size) => {
                        let size = (*size)?.on(&at.key("size"), line, f64::INFINITY, Length::get)?;
                        Punch::Rectangle { size }
                    }
                };
                (Shape::FlatPunch(outline), center)
            }
            Kind::Wave { amplitude, wavelength, center } => {
                let wavelength = wavelength.on(&at.key("wavelength"), line, f64::INFINITY, Length::get)?;
                (Shape::Wave { amplitude: amplitude.get(), wavelength }, center)
            }
            Kind::SelfAffine(roughness) => return roughness.part(at, grid, line),
            Kind::File(_) => return None, // see `measured`
            Kind::Array { array, .. } => {
                let heights = at.key("array").array(array, grid?)?;
                return Some(Part::Heights { name: array.clone(), heights });
            }
        };
        at.core(shape.validate())?;
        let center = match center {
            None => [0.0, 0.0],
            Some(center) => center.on(&at.key("center"), line, 0.0, Length::get)?,
        };
        Some(Part::Shape { shape, center })
    }

    /// What was done to the heights that a program gives.
    pub fn history(&self) -> &[String] {
        match &self.kind {
            Kind::Array { history, .. } => history,
            _ => &[],
        }
    }

    /// Whether it is the shape of a single body: no wave, roughness or punch.
    pub fn is_single(&self) -> bool {
        use Kind::{Array, Cone, Cylinder, Ellipsoid, Sphere, Wedge};
        match self.kind {
            Sphere { .. } | Ellipsoid { .. } | Cylinder { .. } | Cone { .. } | Wedge { .. } => true,
            Array { single, .. } => single,
            _ => false,
        }
    }
}

/// A measured topography from a file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct File {
    /// The file, relative to the case file: SUR, MNT, SDF, X3P, GWY, AL3D, OPD, BCR, Nanoscope, MetroPro, PLU, IBW, NID,
    /// FRT, NetCDF, HDF5, NPY, NPZ, XYZ, CSV or a text matrix, detected from the content. On a line of cells a profile: text of two
    /// columns, position and height.
    #[schemars(example = "roughness.sur")]
    pub path: String,
    /// Channel by name or by number (from 0), if the file has several; the first one with heights if not given.
    #[schemars(example = &"Topography")]
    pub channel: Option<Label>,
    /// Physical size along x and y, if the file does not state it; of a profile its length.
    #[schemars(example = ("0.1 mm", "0.1 mm"))]
    pub size: Option<Axes<Length<Positive>>>,
    /// Unit of the heights, if the file does not state it.
    #[schemars(example = &"um")]
    pub height_unit: Option<String>,
    /// The rectangle to keep.
    #[schemars(example = serde_json::json!({ "size": ["0.2 mm", "0.2 mm"] }))]
    pub crop: Option<Crop>,
    /// The axis along which the surface is mirrored: of two measured surfaces in contact, one is seen from behind.
    pub flip: Option<Axis>,
    /// Quarter turns from x towards y.
    #[schemars(example = 1)]
    pub rotate: Option<Signed>,
    /// Whether to change the sign of the heights (a replica, or a file that shows the opposite body).
    #[schemars(example = false)]
    pub invert: Option<bool>,
    /// What is subtracted from the heights; "plane" if not given.
    pub level: Option<Level>,
    /// Spikes to remove; none if not given. They become undefined, and `fill` fills them.
    #[schemars(example = serde_json::json!({ "threshold": 6, "radius": 2 }))]
    pub outliers: Option<Outliers>,
    /// What is done with undefined points; "harmonic" if not given.
    pub fill: Option<Fill>,
    /// Largest share of undefined points that is filled; 0.25 if not given.
    pub fill_share: Option<Number<Share>>,
    /// A circle to subtract from a profile; none if not given, the one that fits best for `circle = {}`.
    #[schemars(example = serde_json::json!({ "radius": "10 mm" }))]
    pub circle: Option<Circle>,
    /// "mirror": the surface goes on beyond its border by its reflections, so that it is twice as long and wide and repeats on a
    /// periodic domain; as it is if not given.
    pub border: Option<Continuation>,
    /// The wavelengths kept; all if not given.
    #[schemars(example = serde_json::json!({ "longest": "80 um", "shortest": "2.5 um" }))]
    pub filter: Option<Filter>,
    /// A window by which the heights decrease to zero towards the edges; none if not given. It closes the passages across the border:
    /// for a leak take `border`.
    #[schemars(example = serde_json::json!({ "shape": "tukey", "share": 0.1 }))]
    pub window: Option<Window>,
    /// How the heights are resampled if the domain has another number of cells; without it they must agree.
    pub resample: Option<Resampling>,
    /// The processing steps as a list, in the order in which they are done, instead of the keys from `crop` to
    /// `resample`. Only these steps are done, without a default levelling or filling.
    #[schemars(example = serde_json::json!([{ "op": "level", "form": "plane" }, { "op": "fill", "method": "nearest" }]))]
    pub process: Option<Vec<Operation>>,
}

impl File {
    fn measured(&self, at: &Place<'_>) -> Option<Measured> {
        let path = at.key("path");
        let full = path.file(&self.path);
        let unit = match &self.height_unit {
            None => Some(None),
            Some(unit) => height_unit(&at.key("height_unit"), unit).map(Some),
        };
        let steps = prepare::steps(at, self);
        let options = ReadOptions {
            size: self.size.map(|size| size.map(1.0, Length::get)),
            height_unit: unit?,
            channel: self.channel.as_ref().map(|channel| channel.get().to_owned()),
            format: None,
        };
        let line = self.size.map(|size| size.is_line());
        Some(Measured::new(full?, path.key, options, line, steps?))
    }
}

/// Metres per unit.
fn height_unit(at: &Place<'_>, unit: &str) -> Option<f64> {
    match Unit::parse(unit) {
        Ok(parsed) if parsed.powers == dimension::Length::POWERS => {
            at.quantity(format!("1 {unit}").parse::<Length>()).map(Length::get)
        }
        _ => at.wrong("a unit of length such as \"um\"", dimension::Length::UNITS),
    }
}
